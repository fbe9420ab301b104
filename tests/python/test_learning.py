# SPDX-License-Identifier: Apache-2.0
"""What is learned, and what is said of it."""

import json
import pickle
import subprocess

import numpy as np
import pytest
from conftest import SMALL, SOURCE_DIR

import kelpie
from kelpie import Verdict

INPUTS = ["u", "v", "r", "th1", "th2", "th3"]
TARGETS = ["udot", "vdot", "rdot"]


@pytest.fixture(scope="module")
def learned(log):
    return kelpie.DynamicsModel(**SMALL).fit(log.X[:400], log.y[:400], log.t[:400])


def test_learns_what_the_command_learns(build_dir, tmp_path):
    command = build_dir / "kelpie"
    if not command.exists():
        pytest.skip("the command isn't built")
    csv = tmp_path / "log.csv"
    subprocess.run([command, "simulate", SOURCE_DIR / "scenarios/small.toml", "--out", csv],
                   check=True, capture_output=True)
    subprocess.run([command, "learn", csv, "--inputs", ",".join(INPUTS), "--targets",
                    ",".join(TARGETS), "--split", "tail", "--set", "buffer=60", "--set",
                    "gamma=0.1,0.2,0.3", "--align", "none", "--out", tmp_path],
                   check=True, capture_output=True)
    table = np.genfromtxt(csv, delimiter=",", names=True)
    X = np.column_stack([table[name] for name in INPUTS])
    y = np.column_stack([table[name] for name in TARGETS])
    rows = json.loads((tmp_path / "result.json").read_text())["samples_shown"]
    model = kelpie.DynamicsModel(inputs=INPUTS, targets=TARGETS, buffer=60,
                                 gamma=(0.1, 0.2, 0.3))
    model.fit(X[:rows], y[:rows], table["t"][:rows])
    model.save(tmp_path / "mine.json")
    text = json.loads((tmp_path / "model.json").read_text())
    held_out = sum(last - first + 1 for first, last in text.pop("learned")[0]["held_out"])
    assert held_out == len(X) - rows  # what only the command knows; all else is the same
    assert json.loads((tmp_path / "mine.json").read_text()) == text
    theirs = kelpie.DynamicsModel.load(tmp_path / "model.json")
    assert np.array_equal(theirs.predict(X), model.predict(X))
    assert np.array_equal(theirs.coef_, model.coef_)
    assert theirs.get_params()["gamma"] == (0.1, 0.2, 0.3)
    with pytest.raises(ValueError, match="3 targets"):
        kelpie.OnlineSVR.load(tmp_path / "model.json")


@pytest.mark.parametrize("timed", [False, True])
def test_blocks_make_no_difference(log, timed):
    whole = kelpie.DynamicsModel(**{**SMALL, "rate": 3.0})
    blocks = kelpie.DynamicsModel(**{**SMALL, "rate": 3.0})
    whole.partial_fit(log.X, log.y, log.t if timed else None)
    decisions = []
    for part in np.split(np.arange(600), [1, 2, 49, 50, 333]):
        blocks.partial_fit(log.X[part], log.y[part], log.t[part] if timed else None)
        decisions.append(blocks.decisions_)
    assert np.array_equal(whole.predict(log.X), blocks.predict(log.X))
    assert np.array_equal(whole.decisions_, np.concatenate(decisions))
    assert whole.n_samples_seen_ == blocks.n_samples_seen_ == 600


def test_a_loaded_model_learns_on_where_it_stood(log, tmp_path):
    first = kelpie.DynamicsModel(**SMALL).fit(log.X[:400], log.y[:400], log.t[:400])
    first.save(tmp_path / "model.json")
    loaded = kelpie.DynamicsModel.load(tmp_path / "model.json")
    before = loaded.predict(log.X)
    loaded.partial_fit(log.X[400:401], log.y[400:401], log.t[400:401])
    assert loaded.decisions_["had_model"].all()
    assert np.abs(loaded.decisions_["predicted"][0] - before[400]).max() < 0.02 * log.y.std()
    loaded.partial_fit(log.X[401:], log.y[401:], log.t[401:])
    assert loaded.n_samples_seen_ == 200
    fresh = kelpie.DynamicsModel(**SMALL).partial_fit(log.X[400:], log.y[400:], log.t[400:])
    assert loaded.score(log.X[:400], log.y[:400]) > fresh.score(log.X[:400], log.y[:400])
    with pytest.raises(ValueError, match="X has 3 features"):
        kelpie.DynamicsModel.load(tmp_path / "model.json").partial_fit(log.X[:, :3], log.y)


def test_a_loaded_model_keeps_its_shift(log, tmp_path):
    kelpie.DynamicsModel(**SMALL).fit(log.X[:400], log.y[:400]).save(tmp_path / "model.json")
    model = json.loads((tmp_path / "model.json").read_text())
    model["alignment"] = {"shift_s": 0.5, "rows": 2, "commands": model["inputs"][3:],
                          "actuators": []}
    (tmp_path / "model.json").write_text(json.dumps(model))
    loaded = kelpie.DynamicsModel.load(tmp_path / "model.json")
    again = pickle.loads(pickle.dumps(loaded.partial_fit(log.X[400:], log.y[400:])))
    assert again.alignment_s_ == 0.5
    again.save(tmp_path / "again.json")
    assert json.loads((tmp_path / "again.json").read_text())["alignment"] == model["alignment"]


def test_fit_forgets(log):
    model = kelpie.DynamicsModel(**SMALL).fit(log.X, -log.y)
    model.fit(log.X, log.y)
    other = kelpie.DynamicsModel(**SMALL).fit(log.X, log.y)
    assert np.array_equal(model.predict(log.X), other.predict(log.X))


def test_one_target_is_one_of_several(log, learned):
    names = {**SMALL, "targets": "vdot", "states": "none", "adapt": "none"}
    one = kelpie.OnlineSVR(**names).fit(log.X[:400], log.y[:400, 1], log.t[:400])
    assert one.predict(log.X).shape == (600,)
    both = kelpie.DynamicsModel(**{**SMALL, "states": "none", "adapt": "none"})
    both.fit(log.X[:400], log.y[:400], log.t[:400])
    assert np.array_equal(one.predict(log.X), both.predict(log.X)[:, 1])
    assert np.array_equal(one.coef_, both.coef_[1])
    assert one.terms_ == both.terms_


def test_decisions_are_one_step_ahead(log):
    model = kelpie.DynamicsModel(**SMALL).fit(log.X[:399], log.y[:399], log.t[:399])
    before = model.assess(log.X[399:400])[0]
    model.partial_fit(log.X[399:400], log.y[399:400], log.t[399:400])
    decision = model.decisions_[0]
    for here, there in (("predicted", "value"), ("lower", "lower"), ("upper", "upper")):
        assert np.allclose(decision[here], before[there], rtol=0, atol=1e-12)
    alone = kelpie.DynamicsModel(**SMALL, learner="svr").fit(log.X[:400], log.y[:400], log.t[:400])
    assert (alone.decisions_["verdict"][:50] == Verdict.HELD_BACK).all()
    # Who has waited is learned some at a time, and newer rows wait for that.
    assert (alone.decisions_["verdict"][60:] != Verdict.HELD_BACK).all()
    counts = [(alone.decisions_["verdict"][50:, i] == Verdict.EXPLAINED).sum() for i in (0, 1)]
    # The rows held back were judged as well, when the scale was known.
    assert all(status["explained"] >= n for status, n in zip(alone.status_, counts))


def test_intervals_hold_their_share(log, learned):
    tail = learned.decisions_[150:]
    y = log.y[150:400]
    inside = (tail["lower"] <= y) & (y <= tail["upper"])
    assert 0.8 < inside.mean() < 0.97
    novelty = learned.assess(np.vstack([log.X[:100], 50.0 + log.X[:1]]))["novelty"]
    assert (novelty[-1] == 1.0).all() and (novelty[:100].mean() < 0.9)


def test_disturbance_is_one_step_ahead_and_fades(log, tmp_path):
    rng = np.random.default_rng(1)
    push = np.zeros((600, 2))
    for row in range(1, 600):
        push[row] = 0.95 * push[row - 1] + 0.05 * rng.normal(size=2)
    y = log.y + push
    model = kelpie.DynamicsModel(**SMALL).fit(log.X[:400], y[:400], log.t[:400])
    told = model.assess(log.X[400:401])[0]
    assert np.array_equal(told["value"], model.predict(log.X[400:401])[0])
    later = model.assess(np.repeat(log.X[400:401], 3, axis=0), [0.0, 2.0, 1e6])
    assert np.array_equal(later["disturbance"][0], told["disturbance"])
    assert np.isfinite(told["corrected_upper"]).all()
    assert np.isinf(later["corrected_upper"][1:]).all() and (later["disturbance"][2] == 0.0).all()
    model.partial_fit(log.X[400:], y[400:], log.t[400:])
    for field in ("disturbance", "corrected_lower", "corrected_upper"):
        assert np.allclose(model.decisions_[0][field], told[field], rtol=0, atol=1e-9)
    alone = y[400:] - model.decisions_["predicted"]
    assert ((alone - model.decisions_["disturbance"]) ** 2).mean() < 0.8 * (alone ** 2).mean()
    model.save(tmp_path / "model.json")
    for either in (model, kelpie.DynamicsModel.load(tmp_path / "model.json")):
        for wrong in (-1.0, [0.0, 1.0], [[0.0]], np.nan):
            with pytest.raises(ValueError, match="ahead_s|inconsistent"):
                either.assess(log.X[:3], ahead_s=wrong)


def test_jacobian_is_the_derivative(log, learned):
    X = log.X[50:60]
    y, jacobian = learned.predict_with_jacobian(X)
    assert np.allclose(y, learned.predict(X), rtol=0, atol=1e-12)
    for column in range(4):
        step = np.zeros(4)
        step[column] = 1e-6
        slope = (learned.predict(X + step) - learned.predict(X - step)) / 2e-6
        assert np.allclose(jacobian[:, :, column], slope, rtol=1e-4, atol=1e-6)


def test_coefficients_are_the_vehicles(log):
    model = kelpie.OnlineSVR(**{**SMALL, "inputs": ["u", "v", "n1", "n2"], "targets": "udot"},
                             terms=["u", "u*|u|", "n1*|n1|"], fine=0, lambda_terms=5e3, c=0.01,
                             epsilon=0.02, learner="svr")
    model.fit(log.X, log.y[:, 0])
    found = dict(zip(model.terms_, model.coef_))
    assert list(found) == ["u", "u*|u|", "n1*|n1|"]
    assert list(found.values()) == pytest.approx([-1.0, -2.0, 0.02], rel=0.02)


def test_rollout_follows_the_vehicle(log, learned):
    stretch = slice(420, 470)
    course = learned.rollout(log.X[stretch], log.t[stretch])
    assert course.velocity.shape == course.spread.shape == (50, 2)
    assert np.array_equal(course.velocity[0], log.X[420, :2])
    assert np.abs(course.velocity - log.X[stretch, :2]).max() < 0.2
    assert (course.spread > 0).all() and not course.beyond.all()
    measured = learned.rollout(log.X[stretch], log.t[stretch], measured=[0])
    assert np.array_equal(measured.velocity[:, 0], log.X[stretch, 0])
    with pytest.raises(ValueError, match="states"):
        kelpie.DynamicsModel(buffer=50).fit(log.X, log.y).rollout(log.X, log.t)


def test_names_come_from_data_frames(log):
    pandas = pytest.importorskip("pandas")
    X = pandas.DataFrame(log.X, columns=["u", "v", "n1", "n2"])
    y = pandas.DataFrame(log.y, columns=["udot", "vdot"])
    small = {key: value for key, value in SMALL.items() if key not in ("inputs", "targets")}
    model = kelpie.DynamicsModel(**small).fit(X, y)
    assert model.inputs_ == list(model.feature_names_in_) == list(X.columns)
    assert model.targets_ == list(y.columns)
    assert "u*|u|" in "".join(model.terms_).replace(" ", "")
    assert np.array_equal(model.predict(X),
                          kelpie.DynamicsModel(**SMALL).fit(log.X, log.y).predict(log.X))
    with pytest.raises(ValueError, match="same order"):
        model.predict(X[["v", "u", "n1", "n2"]])


def test_few_rows_make_a_model(log):
    model = kelpie.DynamicsModel().fit(log.X[:40], log.y[:40])
    assert all(status["ready"] for status in model.status_)
    waiting = kelpie.DynamicsModel().partial_fit(log.X[:9], log.y[:9])
    assert np.allclose(waiting.predict(log.X[:1]), log.y[:9].mean(axis=0))
    with pytest.raises(ValueError, match="too few rows so far for a model"):
        waiting.save("nowhere.json")
    waiting.partial_fit(log.X[9:40], log.y[9:40])
    errors = waiting.predict(log.X[:40]) - log.y[:40]
    assert (errors.std(axis=0) < 0.6 * log.y[:40].std(axis=0)).all()
    assert waiting.decisions_["had_model"].all(axis=1).sum() == 30


def test_begins_with_what_is_known(log, learned, tmp_path):
    few, later = slice(0, 70), slice(300, 600)
    learned.save(tmp_path / "before.json")
    true = {"udot": {"u": -1.0, "u*|u|": -2.0, "n1*|n1|": 0.02},
            "vdot": {"v": -1.0, "v*|v|": -3.0, "n2*|n2|": 0.01}}
    without = kelpie.DynamicsModel(**SMALL).fit(log.X[few], log.y[few], log.t[few])
    for nominal in (tmp_path / "before.json", [tmp_path / "before.json"] * 2, true):
        model = kelpie.DynamicsModel(**SMALL, nominal=nominal)
        model.fit(log.X[few], log.y[few], log.t[few])
        assert model.score(log.X[later], log.y[later]) > without.score(log.X[later], log.y[later])
    for nominal, message in (({"wdot": {}}, "'wdot' is no target"),
                             ({"udot": {"w": 1.0}}, "w: not a term of this model"),
                             ({"udot": {"u": np.nan}}, "u: has to be a finite coefficient")):
        with pytest.raises(ValueError, match=message):
            kelpie.DynamicsModel(**SMALL, nominal=nominal).fit(log.X[few], log.y[few], log.t[few])
    others = {**SMALL, "targets": ["wdot", "qdot"]}
    with pytest.raises(ValueError, match="^nominal: the model has the targets udot, vdot;"):
        kelpie.DynamicsModel(**others, nominal=tmp_path / "before.json").fit(log.X[few], log.y[few])
    with pytest.raises(FileNotFoundError):
        kelpie.DynamicsModel(**SMALL, nominal="nothing.json").fit(log.X[few], log.y[few])
