# SPDX-License-Identifier: Apache-2.0
"""The example runs, and finds what it should."""

import re
import subprocess
import sys

import pytest
from conftest import SOURCE_DIR

FIGURES = SOURCE_DIR / "examples" / "09_figures_for_papers.py"
EXAMPLE = SOURCE_DIR / "examples" / "06_learning_on_dagon.py"


def test_the_example_learns_a_small_log(build_dir, tmp_path):
    pytest.importorskip("matplotlib")
    command = build_dir / "kelpie"
    if not command.exists():
        pytest.skip("the command isn't built")
    log, picture = tmp_path / "log.csv", tmp_path / "picture.png"
    subprocess.run([command, "simulate", SOURCE_DIR / "scenarios/small.toml", "--out", log],
                   check=True, capture_output=True)
    run = subprocess.run([sys.executable, "-B", EXAMPLE, log, "--out", picture], check=True,
                         text=True, stdout=subprocess.PIPE)
    assert "3000 rows, 2600 learned, 400 held out" in run.stdout
    found = re.findall(r"^(surge|sway|yaw) +([0-9.]+) +([0-9.]+) +([0-9.]+)%$", run.stdout, re.M)
    assert [name for name, *_ in found] == ["surge", "sway", "yaw"]
    for _, held_out, ahead, inside in found:
        assert float(held_out) > 0.9 and float(ahead) > 0.9
        assert 85.0 < float(inside) < 95.0
    assert picture.read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"


def test_without_a_log_it_says_where_it_looked(tmp_path):
    run = subprocess.run([sys.executable, "-B", EXAMPLE, tmp_path / "none.csv"], text=True,
                         capture_output=True)
    assert run.returncode == 1 and "none.csv" in run.stderr


def test_every_figure_of_a_page_is_drawn_for_a_paper(build_dir, tmp_path):
    pytest.importorskip("matplotlib")
    command = build_dir / "kelpie"
    if not command.exists():
        pytest.skip("the command isn't built")
    log, out = tmp_path / "log.csv", tmp_path / "learn"
    subprocess.run([command, "simulate", SOURCE_DIR / "scenarios/small.toml", "--out", log],
                   check=True, capture_output=True)
    subprocess.run([command, "learn", log, "--targets", "udot", "--set", "learner=svr", "--out", out],
                   check=True, capture_output=True)
    run = subprocess.run([sys.executable, "-B", FIGURES, out / "report.html", "--format", "svg",
                          "--out", tmp_path / "figures"], check=True, text=True,
                         stdout=subprocess.PIPE)
    files = run.stdout.split()
    page = (out / "report.html").read_text(encoding="utf-8")
    assert len(files) == page.count('<figure class="chart">') > 10
    first = (tmp_path / "figures" / files[0]).read_text(encoding="utf-8")
    assert first.count("<path") > 5 and first.startswith("<?xml")
