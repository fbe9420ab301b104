# SPDX-License-Identifier: Apache-2.0
"""The README's figures are those of `./run.sh`, and its lines of Python print what it shows."""

import json
import os
import re
import subprocess
import sys

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


@pytest.mark.parametrize("split", SPLITS)
def test_the_table_has_the_figures_that_run_sh_wrote(command, split, tmp_path):
    log, written = dagon(), SOURCE_DIR / "out" / split / "result.json"
    is_new = written.exists() and written.stat().st_mtime > command.stat().st_mtime
    if not is_new and split != "blocks":
        pytest.skip("./run.sh was not run with this build")
    if not is_new:  # the line of run.sh, for one of the splits
        subprocess.run([command, "learn", log, "--rate", "4", "--split", split, "--out", tmp_path],
                       check=True, capture_output=True)
        written = tmp_path / "result.json"
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
