#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Searches settings by cross-validation in many processes, of this machine or of a cluster.

    PYTHONPATH=build/release/python /usr/bin/python3 examples/11_many_processes.py LOG.csv

uses two processes of this machine: workers of dask where Debian's python3-distributed is
installed, else joblib's own. On a cluster (`dask scheduler`, and `dask worker tcp://HEAD:8786` on
every machine, each with kelpie on its PYTHONPATH):

    ... examples/11_many_processes.py LOG.csv --scheduler tcp://HEAD:8786

The scores are the same wherever they are computed. A log to try it with:

    build/release/kelpie simulate scenarios/small.toml --out out/simulated_dagon.csv
"""

from __future__ import annotations

import argparse
import contextlib
import importlib.util
from collections.abc import Iterator

import kelpie  # first: it says which Python has what is needed

import joblib
import numpy as np
from sklearn.model_selection import GridSearchCV, TimeSeriesSplit

INPUTS = ["u", "v", "r", "th1", "th2", "th3"]  # m/s, m/s, rad/s, rev/s of three thrusters
TARGETS = ["udot", "vdot", "rdot"]
RATE_HZ = 4.0
GRID = {"gamma": [0.05, 0.2], "c": [1.0, 10.0]}
FOLDS = 3  # each is judged by a model of what came before it


@contextlib.contextmanager
def processes(count: int = 2, scheduler: str | None = None) -> Iterator[str]:
    """Where joblib's jobs run inside a `with`; gives its name."""
    with contextlib.ExitStack() as stack:
        if scheduler or importlib.util.find_spec("distributed"):
            from distributed import Client, LocalCluster
            where = scheduler or stack.enter_context(LocalCluster(
                n_workers=count, threads_per_worker=1, dashboard_address=None))
            stack.enter_context(Client(where))
            stack.enter_context(joblib.parallel_backend("dask"))
            yield "dask"
        else:
            stack.enter_context(joblib.parallel_backend("loky", n_jobs=count))
            yield "loky"


def search(model: kelpie.DynamicsModel, grid: dict[str, list[float]], X: np.ndarray,
           y: np.ndarray, folds: int = FOLDS) -> GridSearchCV:
    """Every combination of the grid, judged on stretches that come after what was learned."""
    return GridSearchCV(model, grid, cv=TimeSeriesSplit(folds), refit=False).fit(X, y)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("log", help="a CSV file with the columns of AUV Dagon")
    parser.add_argument("--processes", type=int, default=2, help="of this machine")
    parser.add_argument("--scheduler", help="address of a dask scheduler, instead")
    options = parser.parse_args()
    frame = kelpie.read_log(options.log)
    model = kelpie.DynamicsModel(inputs=INPUTS, targets=TARGETS, rate=RATE_HZ)
    with processes(options.processes, options.scheduler) as where:
        found = search(model, GRID, frame[INPUTS].to_numpy(), frame[TARGETS].to_numpy())
    print(f"{'gamma':>8} {'c':>8} {'R²':>8}   ({where})")
    results = found.cv_results_
    for parameters, score in zip(results["params"], results["mean_test_score"]):
        print(f"{parameters['gamma']:8g} {parameters['c']:8g} {score:8.3f}")


if __name__ == "__main__":  # dask's workers read this file, too
    main()
