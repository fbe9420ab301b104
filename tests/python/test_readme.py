# SPDX-License-Identifier: Apache-2.0
"""The README's figures are those of `./run.sh`, and its lines of Python print what it shows."""

import json
import os
import re
import subprocess
import sys

import numpy as np
import pytest
from conftest import SOURCE_DIR

README = (SOURCE_DIR / "README.md").read_text(encoding="utf-8")
SPLITS = {"blocks": "blocks of 400 rows", "random": "20 % at random"}


@pytest.fixture
def command(build_dir):
    if not (build_dir / "kelpie").exists():
        pytest.skip("the command isn't built")
    return build_dir / "kelpie"


def figures(beginning):
    """R² of surge, sway and yaw of the README's row that begins so."""
    row, = re.findall(rf"^\| {re.escape(beginning)}[^|]*((?:\| [0-9.]+ ){{3}})\|", README, re.M)
    return row.strip("| ").split(" | ")


def dagon():
    for folder in (os.environ.get("KELPIE_DATA_DIR", ""), SOURCE_DIR.parent / "shared" / "data"):
        log = SOURCE_DIR / folder / "dagon_config1.csv"
        if str(folder) and log.exists():
            return log
    pytest.skip("dagon_config1.csv is not there (KELPIE_DATA_DIR)")


@pytest.fixture(scope="module")
def learned(build_dir, tmp_path_factory):
    """Folders by split: what run.sh wrote, if by this build; else the blocks, learned here."""
    command, log = build_dir / "kelpie", dagon()
    if not command.exists():
        pytest.skip("the command isn't built")
    folders = {}
    for split in SPLITS:
        folder = SOURCE_DIR / "out" / split
        result = folder / "result.json"
        if result.exists() and result.stat().st_mtime > command.stat().st_mtime:
            folders[split] = folder
        elif split == "blocks":
            folders[split] = tmp_path_factory.mktemp(split)
            subprocess.run([command, "learn", log, "--rate", "4", "--split", split, "--out",
                            folders[split]], check=True, capture_output=True)
    return folders


@pytest.mark.parametrize("split", SPLITS)
def test_the_table_has_the_figures_that_run_sh_wrote(learned, split):
    if split not in learned:
        pytest.skip("./run.sh was not run with this build")
    written = learned[split] / "result.json"
    result = json.loads(written.read_text(encoding="utf-8"))
    if result["dataset"]["rows"] != 11567:
        pytest.skip("./run.sh learned another log")
    # Another processor's vector instructions may round the last digit otherwise.
    ours = [axis["r2"]["final"] for axis in result["axes"]]
    assert ours == pytest.approx([float(r2) for r2 in figures(SPLITS[split])], abs=0.0015)
    if split == "blocks":
        least_squares = [axis["yardsticks"]["least_squares"] for axis in result["axes"]]
        theirs = [axis["r2_final"] for axis in least_squares]
        assert theirs == pytest.approx([float(r2) for r2 in figures("… recursive")], abs=0.0015)


def test_ten_seconds_ahead_the_learned_model_beats_holding_the_velocity(learned, command, tmp_path):
    subprocess.run([command, "rollout", dagon(), "--rate", "4", "--split", "blocks", "--horizons",
                    "10", "--model", learned["blocks"] / "model.json", "--out", tmp_path],
                   check=True, capture_output=True)
    result = json.loads((tmp_path / "result.json").read_text(encoding="utf-8"))
    r2 = {score["name"]: score["horizons"][0]["r2"] for score in result["scores"]}
    assert all(np.array(r2["kelpie"]) > [0.95, 0.89, 0.94])
    assert r2["velocity held"][0] < 0.0


def test_the_lines_of_python_print_what_the_page_shows(command, tmp_path):
    pytest.importorskip("pandas")
    lines, shown = re.search(r"```python\n(.*?)```\n\n```\n(.*?)```", README, re.S).groups()
    subprocess.run([command, "simulate", SOURCE_DIR / "scenarios/small.toml", "--out", "log.csv"],
                   check=True, capture_output=True, cwd=tmp_path)
    run = subprocess.run([sys.executable, "-B", "-c", lines], check=True, text=True,
                         stdout=subprocess.PIPE, cwd=tmp_path)
    number = r"-?[0-9]+\.[0-9]+"
    assert re.sub(number, "", run.stdout) == re.sub(number, "", shown)
    numbers = [[float(n) for n in re.findall(number, text)] for text in (run.stdout, shown)]
    assert numbers[0] == pytest.approx(numbers[1], abs=0.0015)
