# SPDX-License-Identifier: Apache-2.0
"""kelpie.Authority, over a vehicle whose thrusters are known."""

import numpy as np
import pytest

import kelpie

THRUST = np.array([[0.02, 0.02, 0.0], [0.0, 0.0, 0.03], [-0.02, 0.02, 0.01]])


def drive(rows, shares, start=None, rate=4.0, seed=1):
    """Rows of u, v, r and three thrusters with n|n|, and their accelerations."""
    random = np.random.default_rng(seed)
    nu = np.zeros(3) if start is None else np.array(start)
    phase = random.uniform(0.0, 6.0, 3)
    x, y = np.zeros((rows, 6)), np.zeros((rows, 3))
    for k in range(rows):
        phase += (0.2 + 0.13 * np.arange(3) + 0.1 * random.uniform(size=3)) / rate
        n = 4.0 * np.sin(phase)
        a = THRUST @ (shares * n * np.abs(n)) - 0.2 * nu - nu * np.abs(nu)
        x[k, :3], x[k, 3:], y[k] = nu, n, a + 0.01 * random.normal(size=3)
        nu = nu + a / rate
    return x, y


@pytest.fixture(scope="module")
def damaged():
    x, y = drive(2400, np.ones(3))
    later, a = drive(280, np.array([0.5, 1.0, 1.0]), x[-1, :3], seed=2)
    model = kelpie.DynamicsModel(buffer=100, rate=4.0, states="x0,x1,x2")
    model.fit(np.vstack([x, later]), np.vstack([y, a]))
    return model


RANGES = {f"x{k}": (-4.0, 4.0) for k in (3, 4, 5)}


def test_knows_what_a_damaged_thruster_leaves(damaged):
    authority = kelpie.Authority(damaged, RANGES)
    assert authority.shares["x3"] == pytest.approx(0.5, abs=0.05)
    assert authority.shares["x4"] == pytest.approx(1.0, abs=0.05)
    left = [axis["left"] for axis in authority.axes.values()]
    assert left == pytest.approx([0.75, 1.0, 0.8], abs=0.05)
    assert authority.ahead == pytest.approx(16.0 * THRUST * [0.5, 1.0, 1.0], abs=0.02)
    assert np.all(authority.ahead_width > 0.0) and authority.lost_target is None
    assert "of its thrust" in str(authority)


def test_allocation_is_that_of_scipy(damaged):
    """Box-constrained least squares by another program."""
    optimize = pytest.importorskip("scipy.optimize")
    authority = kelpie.Authority(damaged, RANGES)
    scale = np.array([max(axis["nominal_most"], -axis["nominal_least"])
                      for axis in authority.axes.values()])
    columns = np.hstack([authority.ahead, authority.astern]) / scale[:, None]
    ridge = np.vstack([columns, 1e-3 * np.eye(6)])
    for wanted in np.random.default_rng(3).uniform(-0.8, 0.8, (50, 3)):
        allocation = authority.allocate(wanted)
        best = optimize.lsq_linear(ridge, np.concatenate([wanted / scale, np.zeros(6)]), (0.0, 1.0),
                                   tol=1e-12)
        reached = (columns @ best.x) * scale
        # Another program may use a thruster ahead and astern at a time; kelpie does not.
        cost = np.linalg.norm((wanted - allocation.reached) / scale)
        assert cost == pytest.approx(np.linalg.norm((wanted - reached) / scale), abs=0.02)


def test_names_what_is_wrong(damaged):
    with pytest.raises(ValueError, match="no input"):
        kelpie.Authority(damaged, {"x9": (-1.0, 1.0)})
    with pytest.raises(ValueError, match="no thruster"):
        kelpie.Authority(damaged, {"x0": (-1.0, 1.0)})
    with pytest.raises(ValueError, match="ranges: have to name a thruster or more"):
        kelpie.Authority(damaged, {})
    with pytest.raises(ValueError, match="wanted"):
        kelpie.Authority(damaged, RANGES).allocate([0.1])
