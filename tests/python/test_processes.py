# SPDX-License-Identifier: Apache-2.0
"""Estimators go to other processes and back, under dask or joblib's own; studies run in parts."""

import importlib.util
import json
import subprocess
import sys

import kelpie
import numpy as np
import pytest
from conftest import SMALL, SOURCE_DIR, drive

STUDY = """
logs = "dives/{vehicle}.csv"
[[learner]]
name = "small"
preset = "small"
set = {warmup = 20, buffer = 30}
[[learner]]
name = "smaller"
preset = "small"
set = {warmup = 20, buffer = 20}
"""
TIMES = {"seconds", "update_us", "update_us_p99", "real_time_share"}


def without_times(node):
    if isinstance(node, dict):
        return {key: without_times(value) for key, value in node.items() if key not in TIMES}
    return [without_times(item) for item in node] if isinstance(node, list) else node


def test_a_study_in_parts_under_dask_is_that_of_one_process(build_dir, tmp_path):
    pytest.importorskip("distributed")
    (tmp_path / "dives").mkdir()
    for vehicle in range(2):
        log = drive(300, seed=vehicle)
        rows = np.column_stack([log.t, log.X, log.y])
        np.savetxt(tmp_path / f"dives/auv{vehicle}.csv", rows, delimiter=",", comments="",
                   header="t,u,v,n1,n2,udot,vdot")
    (tmp_path / "fleet.toml").write_text(STUDY)
    command = [build_dir / "kelpie", "study", "fleet.toml", "--out", "whole"]
    subprocess.run(command, cwd=tmp_path, check=True, capture_output=True)
    example = [sys.executable, SOURCE_DIR / "examples" / "14_study_in_parts.py", "fleet.toml",
               "--kelpie", build_dir / "kelpie", "--parts", "3", "--out", "parts"]
    done = subprocess.run(example, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert all(f"part {k}/3: done" in done.stdout for k in (1, 2, 3)), done.stdout
    assert len(list((tmp_path / "parts").glob("journal.part-*-of-3.jsonl"))) == 3
    whole, parts = (without_times(json.loads((tmp_path / out / "study.json").read_text()))
                    for out in ("whole", "parts"))
    assert parts == whole


def test_a_search_in_other_processes_finds_the_same_scores():
    spec = importlib.util.spec_from_file_location(
        "many_processes", SOURCE_DIR / "examples" / "11_many_processes.py")
    example = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(example)
    log = drive(400)
    model, grid = kelpie.DynamicsModel(**SMALL), {"gamma": [0.05, 0.5]}
    here = example.search(model, grid, log.X, log.y, folds=2).cv_results_
    with example.processes(2) as where:
        there = example.search(model, grid, log.X, log.y, folds=2).cv_results_
    assert where == ("dask" if importlib.util.find_spec("distributed") else "loky")
    for name in ("split0_test_score", "split1_test_score"):
        assert np.array_equal(there[name], here[name])
    assert here["mean_test_score"][0] != here["mean_test_score"][1]
