# SPDX-License-Identifier: Apache-2.0
"""kelpie.DeadReckoning, over a vehicle whose equations are known."""

import numpy as np
import pytest

import kelpie


def drive(rows, rate=4.0):
    t = np.arange(rows) / rate
    n = np.column_stack([6 + 3 * np.sin(0.11 * t), 6 + 3 * np.sin(0.07 * t), 5 * np.sin(0.05 * t)])
    nu = np.zeros((rows, 3))
    a = np.zeros((rows, 3))
    for k in range(rows):
        f = n[k] * np.abs(n[k])
        a[k] = [0.0006 * (f[0] + f[1]) - 0.2 * nu[k, 0], 0.001 * f[2] - 0.3 * nu[k, 1],
                0.001 * (f[1] - f[0]) - 0.4 * nu[k, 2]]
        if k + 1 < rows:
            nu[k + 1] = nu[k] + a[k] / rate
    return t, np.column_stack([nu, n]), a


@pytest.fixture(scope="module")
def learned():
    t, x, a = drive(1600)
    model = kelpie.DynamicsModel(buffer=100, rate=4.0, states="x0,x1,x2")
    model.fit(x[:1200], a[:1200])
    return model, t, x


def test_goes_through_an_outage_with_an_honest_deviation(learned):
    model, t, x = learned
    reckoning = kelpie.DeadReckoning(model)
    for k in range(1000, 1200):
        reckoning.update(x[k], t[k])
    assert reckoning.started and reckoning.silent_s == 0.0
    for k in range(1200, 1360):
        row = x[k].copy()
        row[:2] = np.nan
        reckoning.update(row, t[k])
    assert reckoning.silent_s == pytest.approx(40.0)
    assert reckoning.velocity == pytest.approx(x[1359, :3], abs=0.05)
    assert reckoning.covariance.shape == (3, 3)
    assert np.linalg.norm(reckoning.position) > 1.0
    assert np.all(np.linalg.eigvalsh(reckoning.position_covariance) > 0.0)


def test_a_model_may_be_a_file(learned, tmp_path):
    model, t, x = learned
    model.save(tmp_path / "model.json")
    reckoning = kelpie.DeadReckoning(tmp_path / "model.json")
    reckoning.use(str(tmp_path / "model.json"))
    reckoning.update(x[0], t[0])
    assert reckoning.started
    for none in (tmp_path / "none.json", str(tmp_path / "none.json")):
        with pytest.raises(FileNotFoundError):
            kelpie.DeadReckoning(none)
        with pytest.raises(FileNotFoundError):
            reckoning.use(none)


def test_names_what_is_wrong(learned):
    model, _, x = learned
    with pytest.raises(ValueError, match="between"):
        kelpie.DeadReckoning(model, between="splines")
    with pytest.raises(ValueError, match="practice"):
        kelpie.DeadReckoning(model, practice_s=-1.0)
    reckoning = kelpie.DeadReckoning(model)
    with pytest.raises(ValueError, match="x"):
        reckoning.update(x[0][:3], 0.0)
    with pytest.raises(ValueError, match="covariance"):
        reckoning.update(x[0], 0.0, covariance=[1.0])


def test_recognises_a_velocity_log_that_gives_zeros_or_one_value(learned):
    model, t, x = learned
    for value, name in ((np.zeros(2), "zero"), (x[1199, :2], "frozen")):
        reckoning = kelpie.DeadReckoning(model)
        for k in range(1000, 1200):
            reckoning.update(x[k], t[k])
        assert reckoning.faults == ["none"] * 3
        named = None
        for k in range(1200, 1280):
            row = x[k].copy()
            row[:2] = value
            reckoning.update(row, t[k])
            if named is None and reckoning.faults[0] == name:
                named = t[k] - t[1199]
        assert named is not None and named <= 1.0
        assert reckoning.faults == [name, name, "none"]
        assert reckoning.silent_s == pytest.approx(20.0)
        assert reckoning.velocity == pytest.approx(x[1279, :3], abs=0.05)
        reckoning.update(x[1280], t[1280])
        assert reckoning.silent_s == 0.0
        assert reckoning.step <= 3.0 + 1e-9


def test_goes_on_with_a_later_model(learned):
    model, t, x = learned
    reckoning = kelpie.DeadReckoning(model)
    for k in range(1000, 1100):
        reckoning.update(x[k], t[k])
    before = reckoning.velocity
    reckoning.use(model)
    assert reckoning.velocity == pytest.approx(before)
    other = kelpie.DynamicsModel(buffer=100, rate=4.0, states="x0,x1")
    with pytest.raises(ValueError):
        reckoning.use(other.fit(x[:1200], x[:1200, :2]))


def test_commands_go_on_as_they_are_restated(learned):
    model, t, x = learned

    def surge_after(between, commands=x[1199, 3:]):
        reckoning = kelpie.DeadReckoning(model)
        for k in range(1000, 1200):
            reckoning.update(x[k], t[k])
        row = np.concatenate([np.full(3, np.nan), commands])
        reckoning.restate(row, between)
        ahead = row.copy()
        ahead[3:5] = 9.0
        reckoning.update(ahead, t[1200])
        return reckoning.velocity[0]

    linear, held = surge_after("linear"), surge_after("held")
    assert held != pytest.approx(linear, abs=1e-4), "the step comes at the end of the interval"
    assert surge_after("held", commands=np.zeros(3)) < held, "a coasting vehicle slows down"
    reckoning = kelpie.DeadReckoning(model)
    with pytest.raises(ValueError, match="x: has 3 values"):
        reckoning.restate(x[0, :3])
    with pytest.raises(ValueError, match="between"):
        reckoning.restate(x[0], "splines")


def named(x, a, velocities):
    model = kelpie.DynamicsModel(inputs=[*velocities, "n0", "n1", "n2"], buffer=60, rate=4.0)
    return model.fit(x[:1200], a[:1200])


def test_names_of_velocities_tell_the_plane_and_the_gyro():
    t, x, a = drive(1600)
    model = named(x, a, ["u", "w", "r"])
    with pytest.raises(ValueError, match="planar: needs surge, sway and yaw rate"):
        kelpie.DeadReckoning(model, planar=True)
    reckoning = kelpie.DeadReckoning(model)
    for k in range(1000, 1200):
        reckoning.update(x[k], t[k])
    for k in range(1200, 1280):
        row = x[k].copy()
        row[:2] = 0.0
        reckoning.update(row, t[k])
    assert reckoning.faults == ["zero", "zero", "none"]
    assert reckoning.silent_s == pytest.approx(20.0)
    assert reckoning.velocity == pytest.approx(x[1279, :3], abs=0.05)
    assert reckoning.heading == 0.0 and not reckoning.position.any(), "heave is no sway"
    model = named(x, a, ["u", "v", "r"])
    reckoning = kelpie.DeadReckoning(model)
    for k in range(1000, 1200):
        reckoning.update(x[k], t[k])
    assert reckoning.heading != 0.0
