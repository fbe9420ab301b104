# SPDX-License-Identifier: Apache-2.0
"""What a model says of its vehicle."""

import numpy as np

import kelpie


def drive(samples: int, weak_from: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A vehicle with surge and yaw, whose second thruster gets weak."""
    random = np.random.default_rng(1)
    rows, targets = [], []
    u = r = 0.0
    t = 0.25 * np.arange(samples)
    n = np.stack([6 * np.sin(0.21 * t) + 3 * np.sin(0.5 * t),
                  6 * np.cos(0.13 * t) + 3 * np.sin(0.37 * t)], axis=1)
    for row in range(samples):
        thrust = n[row] * np.abs(n[row]) * [1.0, 0.5 if row >= weak_from else 1.0]
        udot = 0.004 * thrust.sum() - 0.4 * u - 0.6 * u * abs(u)
        rdot = 0.005 * (thrust[0] - thrust[1]) - 0.5 * r - 0.5 * r * abs(r)
        rows.append([u, r, *n[row]])
        targets.append([udot, rdot] + 1e-3 * random.normal(size=2))
        u, r = u + 0.25 * udot, r + 0.25 * rdot
    return np.array(rows), np.array(targets), t


def test_the_weak_thruster_is_named():
    x, y, t = drive(2240, 2000)
    model = kelpie.DynamicsModel(inputs=["u", "r", "port", "starboard"], targets=["ud", "rd"],
                                 learner="svr", buffer=100)
    model.fit(x, y, t=t)
    found = model.diagnosis_
    assert [cause["column"] for cause in found["health"]] in ([], ["port", "starboard"])
    assert len(found["findings"]) == 1
    finding = found["findings"][0]
    assert finding["state"] == "named"
    assert abs(finding["since_s"] - 500.0) < 10.0
    assert finding["causes"][0]["column"] == "starboard"
    assert finding["causes"][0]["lower"] < 0.51 and finding["causes"][0]["upper"] > 0.49
    assert finding["causes"][0]["before"] == 1.0
    assert finding["text"].startswith("starboard gives")


def test_without_velocities_there_is_none():
    random = np.random.default_rng(2)
    model = kelpie.DynamicsModel(inputs=["a", "b"], targets=["c"])
    model.fit(random.normal(size=(60, 2)), random.normal(size=(60, 1)))
    assert model.diagnosis_ is None
