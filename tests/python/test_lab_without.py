# SPDX-License-Identifier: Apache-2.0
"""lab/without.py: each place that is replaced stands in the source; the table of what is earned."""
import importlib.util
import subprocess
import sys
from pathlib import Path

WITHOUT = Path(__file__).parents[2] / "lab" / "without.py"
SPEC = importlib.util.spec_from_file_location("without", WITHOUT)
without = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(without)


def test_each_place_stands_once_in_the_source():
    done = subprocess.run([sys.executable, WITHOUT, "--check"], capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")


def test_a_place_that_is_gone_is_named(tmp_path):
    for name, text, _ in without.MECHANISMS.values():
        place = tmp_path / name
        place.parent.mkdir(exist_ok=True)
        before = place.read_text(encoding="utf-8") if place.exists() else ""
        place.write_text(before + ("" if text in before else text + "\n"), encoding="utf-8")
    assert without.misplaced(tmp_path) == []
    slope = tmp_path / without.MECHANISMS["calibration slope"][0]
    slope.write_text(slope.read_text(encoding="utf-8") * 2, encoding="utf-8")
    assert "calibration slope" in without.misplaced(tmp_path)


def test_the_table_has_what_a_mechanism_earns():
    whole = {"a": {"stream": 0.9, "end": 0.8}, "b": {"stream": 0.5, "end": 0.6, "changes": 0.4}}
    less = {"a": {"stream": 0.8, "end": 0.8}, "b": {"stream": 0.6, "end": 0.6, "changes": 0.1}}
    line = without.table({"": whole, "caution": less}).splitlines()[-1].split()
    assert line == ["caution", "+0.0000", "-0.100", "+0.100", "+0.0000", "+0.000", "+0.000",
                    "+0.3000", "+0.300", "+0.300", "–"]
