# SPDX-License-Identifier: Apache-2.0
"""Estimators go to other processes and back: the example under dask, or joblib's own."""

import importlib.util

import kelpie
import numpy as np
from conftest import SMALL, SOURCE_DIR, drive


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
