# SPDX-License-Identifier: Apache-2.0
"""kelpie-lab reproduce --entry: a learner of one's own in every table of the reproduction."""
import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import SOURCE_DIR

pytest.importorskip("sklearn", reason="scikit-learn (Debian: python3-sklearn) is not installed")

README = SOURCE_DIR / "python/kelpie/benchmark/README.md"
SCENARIO = f"""vehicle = '{SOURCE_DIR}/vehicles/dagon.toml'
rate_hz = 1.0
[[configurations]]
name = 'a'
[[phases]]
configuration = 'a'
duration_s = 8100.0
"""


@pytest.fixture
def reproduce(build_dir, tmp_path):
    """The laboratory in a folder with a short scenario; python3 is the tests' Python."""
    program = build_dir / "kelpie-lab"
    if not program.exists():
        pytest.skip("kelpie-lab is not built")
    (tmp_path / "scenarios").mkdir()
    (tmp_path / "scenarios/tiny.toml").write_text(SCENARIO)
    (tmp_path / "bin").mkdir()
    (tmp_path / "bin/python3").symlink_to(sys.executable)
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path)),
                   "PATH": f"{tmp_path / 'bin'}{os.pathsep}{os.environ['PATH']}"}
    environment.pop("KELPIE_DATA_DIR", None)

    def run(*words):
        return subprocess.run([program, "reproduce", "--quick", "--scenario", "tiny", "--out",
                               "out", *words], cwd=tmp_path, env=environment, text=True,
                              capture_output=True, check=False)
    return run


def test_sgd_regressor_enters_by_the_lines_of_the_page(reproduce, tmp_path):
    lines, = re.findall(r"```python\n(.*?)```", README.read_text(encoding="utf-8"), re.S)
    (tmp_path / "my_learner.py").write_text(lines)
    done = reproduce("--entry", "my_learner.py:Sgd")
    assert done.returncode == 0, done.stderr
    document = json.loads((tmp_path / "out/reproduction.json").read_text())
    assert document["command"].endswith("--entry my_learner.py:Sgd")
    for study in document["streams"]:
        row, = [row for row in study["rows"] if row["kind"] == "entry"]
        assert row["name"] == "Sgd"
        assert len(row["ends"]) == 1 and len(row["ends"][0]) == len(study["stages"])
        assert all(-1.0 < r2 < 1.0 for r2 in row["ends"][0][0])  # a linear model is weak here
        # The rows are those of every other row of the table.
        assert row["samples"] == study["rows"][0]["samples"]
        assert row["time_s"] == study["rows"][0]["time_s"]
        assert all(len(curve["r2"]) == len(row["samples"]) for curve in row["curves"])
    for page in ("reproduction.html", "reproduction.md"):
        assert "Sgd" in Path(tmp_path / "out" / page).read_text(encoding="utf-8")


@pytest.mark.parametrize("place,code,message", [
    ("none.py:Learner", 2, "none.py is no file"),
    ("broken.py:Broken", 1, "partial_fit raised KeyError: 'u'"),
])
def test_a_bad_entry_is_refused_before_the_long_work(reproduce, tmp_path, place, code, message):
    (tmp_path / "broken.py").write_text(
        "class Broken:\n    def partial_fit(self, X, y): raise KeyError('u')\n"
        "    def predict(self, X): return X\n")
    done = reproduce("--entry", place)
    assert done.returncode == code, done.stderr
    assert "--entry" in done.stderr and message in done.stderr
    assert not (tmp_path / "out").exists()
