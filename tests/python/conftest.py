# SPDX-License-Identifier: Apache-2.0
"""What the Python tests share."""

import os
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest

SOURCE_DIR = Path(__file__).resolve().parents[2]


class Drive(NamedTuple):
    """A log: inputs (n, 4), targets (n, 2), times (n,) [s]."""

    X: np.ndarray
    y: np.ndarray
    t: np.ndarray


def drive(rows: int, seed: int = 1) -> Drive:
    """A vehicle with two velocities and two thrusters at 10 Hz."""
    random = np.random.default_rng(seed)
    X, y = np.zeros((rows, 4)), np.zeros((rows, 2))
    velocity, phase, slow = np.zeros(2), 0.0, 1.0
    for i in range(rows):
        phase += random.uniform(0.02, 0.1)
        slow += random.uniform(0.01, 0.07)
        thrust = np.array([np.sin(phase), np.cos(slow)]) * 10.0
        change = (np.array([0.02, 0.01]) * thrust * np.abs(thrust)
                  - np.array([2.0, 3.0]) * velocity * np.abs(velocity) - velocity)
        X[i] = [*velocity, *thrust]
        y[i] = change + 0.01 * random.standard_normal(2)
        velocity = velocity + 0.1 * change
    return Drive(X, y, 0.1 * np.arange(rows))


INPUTS = ["u", "v", "n1", "n2"]
TARGETS = ["udot", "vdot"]
SMALL = {"inputs": INPUTS, "targets": TARGETS, "rate": 10.0, "buffer": 120, "anchors": 30}


@pytest.fixture(scope="session")
def log() -> Drive:
    return drive(600)


@pytest.fixture(scope="session")
def build_dir() -> Path:
    """The folder kelpie was built in."""
    return Path(os.environ["KELPIE_BUILD_DIR"])
