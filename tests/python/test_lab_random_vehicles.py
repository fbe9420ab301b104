# SPDX-License-Identifier: Apache-2.0
"""lab/random_vehicles.py: vehicles drawn at random are the same again, and change when asked to."""
import importlib.util
from pathlib import Path

import numpy as np

SOURCE = Path(__file__).parents[2] / "lab" / "random_vehicles.py"
SPEC = importlib.util.spec_from_file_location("random_vehicles", SOURCE)
random_vehicles = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(random_vehicles)


def short_vehicle(seed):
    vehicle = random_vehicles.Vehicle(seed)
    vehicle.rows = 200
    return vehicle


def test_a_seed_is_a_vehicle_and_a_drive():
    for seed in range(77000, 77008):
        log = short_vehicle(seed).log(changes=False)
        assert np.isfinite(log).all()
        assert np.array_equal(log, short_vehicle(seed).log(changes=False))
        assert not np.array_equal(log[:, :3], short_vehicle(seed + 1).log(changes=False)[:, :3])


def test_a_vehicle_changes_after_three_fifths_of_the_drive():
    for seed in range(77000, 77006):
        before, _, _ = short_vehicle(seed).simulate(changes=False)
        after, _, _ = short_vehicle(seed).simulate(changes=True)
        assert np.array_equal(before[:121], after[:121])
        assert not np.array_equal(before[121:], after[121:])
