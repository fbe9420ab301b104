# SPDX-License-Identifier: Apache-2.0
"""lab/random_vehicles.py: vehicles drawn at random are the same again, and change when asked to."""
import importlib.util
import json
from pathlib import Path

import numpy as np
import pytest

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


@pytest.mark.xfail(strict=True, reason="falls short since 2.0.0: the posterior's rows that wait "
                   "reach the diagnosis, which names no cause here (docs/measured/accuracy.md)")
def test_one_of_two_thrusters_without_thrust_is_no_load(build_dir, tmp_path):
    """Both leave accelerations along one direction, a load of many times the inertia alone."""
    vehicle = random_vehicles.Vehicle(77020)
    rows = vehicle.log(changes=True)
    held = (np.arange(len(rows)) >= vehicle.first_changed) & (np.arange(len(rows)) % 500 > 450)
    random_vehicles.learn(build_dir / "kelpie", tmp_path, rows, held, vehicle)
    result = json.loads((tmp_path / "learned" / "result.json").read_text())
    named = [cause for finding in result["diagnosis"]["findings"] for cause in finding["causes"]]
    assert [(cause["kind"], cause["column"]) for cause in named] == [("thruster", "c1")], named
    assert named[0]["size"] < 0.6


@pytest.mark.parametrize("seed, rows", [(99001, 2700), (99004, 3300)])
def test_a_vehicle_that_does_not_change_is_not_believed_to_change(seed, rows, build_dir, tmp_path):
    """Calm minutes have other errors than manoeuvres; a thruster gives no less than nothing."""
    vehicle = random_vehicles.Vehicle(seed)
    log = vehicle.log(changes=False)
    held = np.arange(len(log)) * 25 // len(log) % 5 == 4
    random_vehicles.learn(build_dir / "kelpie", tmp_path, log[:rows], held[:rows], vehicle)
    result = json.loads((tmp_path / "learned" / "result.json").read_text())
    assert [axis["changes"] for axis in result["axes"]] == [[], [], []]
