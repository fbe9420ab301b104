# SPDX-License-Identifier: Apache-2.0
"""lab/plot.py draws every JSON file of kelpie-lab (here: small ones by hand), and refuses others."""
import json
import subprocess
import sys
from pathlib import Path

import pytest

pytest.importorskip("matplotlib")
PLOT = Path(__file__).parents[2] / "lab" / "plot.py"


def solver(name):
    return {"name": name, "update_us": [50.0, 60.0, None, 55.0]}


RUN = {"case": "thruster th1", "kind": "thruster", "effect": 20, "special": False, "seed": 1,
       "said": "thruster th1", "right": True, "same_place": True,
       "named_after_s": 12.0, "truth": 0.8, "size": 0.79}
FILES = {
    "control": {"format": "kelpie-control", "first_seed": 1, "settle_s": 1.0, "before_s": 1.0,
                "cases": [{"path": "circle", "mishap": "none", "controllers": [
                    {"name": "PID", "time_s": [0.0, 1.0, 2.0], "error_m": [0.1, 0.2, None]}]}]},
    "reckoning": {"format": "kelpie-reckoning", "logs": [
        {"source": "log.csv", "simulated": False, "split": "tail", "navigators": [
            {"name": "kelpie", "outages": [{"seconds": 10.0, "median": 0.01},
                                           {"seconds": 400.0, "median": None}]}]}]},
    "diagnosis": {"format": "kelpie-diagnosis",
                  "runs": [RUN, {**RUN, "effect": 40, "said": "nothing", "right": False}]},
}


def plot(*arguments):
    return subprocess.run([sys.executable, PLOT, *arguments], capture_output=True, text=True,
                          check=False)


@pytest.mark.parametrize("name", FILES)
def test_draws(name, tmp_path):
    source = tmp_path / f"{name}.json"
    source.write_text(json.dumps(FILES[name]))
    result = plot(source)
    assert (result.returncode, result.stderr) == (0, "")
    assert source.with_suffix(".png").read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"


def test_refuses_other_files(tmp_path):
    source = tmp_path / "model.json"
    source.write_text('{"format": "kelpie-model"}')
    result = plot(source)
    assert result.returncode == 1
    assert "is no JSON file of kelpie-lab" in result.stderr
    assert plot(tmp_path / "none.json").returncode == 1
