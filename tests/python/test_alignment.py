# SPDX-License-Identifier: Apache-2.0
"""The transformer that shifts commands."""

import json
import pickle

import numpy as np
import pytest
from conftest import INPUTS, drive

import kelpie


def late(rows, shift):
    """A log whose commands stand `shift` rows late."""
    log = drive(rows + 20)
    X = log.X[10:-10].copy()
    X[:, 2:] = log.X[10 - shift:len(log.X) - 10 - shift, 2:]
    return X, log.y[10:-10], log.t[10:-10]


@pytest.mark.parametrize("shift", [-4, 0, 5])
@pytest.mark.parametrize("options", [{"states": ["x0", "x1"]}, {}])
def test_finds_the_shift_and_takes_the_commands_from_there(shift, options):
    X, y, t = late(1500, shift)
    alignment = kelpie.Alignment(rate=10.0, **options).fit(X, y)
    assert alignment.rows_ == shift
    assert alignment.shift_s_ == pytest.approx(shift / 10)
    assert alignment.commands_ == ["x2", "x3"]
    right, _, _ = late(1500, 0)
    inner = slice(10, -10)
    np.testing.assert_array_equal(alignment.transform(X)[inner], right[inner])
    np.testing.assert_array_equal(kelpie.Alignment(rate=10.0).fit_transform(X, y, t),
                                  alignment.transform(X))


def test_a_given_shift_stays_within_stretches():
    X, y, t = late(60, 0)
    t = t + np.where(np.arange(60) >= 30, 100.0, 0.0)
    alignment = kelpie.Alignment(shift=0.2, rate=10.0, states=["x0", "x1"]).fit(X, y, t)
    shifted = alignment.transform(X, t)
    from_row = [min(i + 2, 29 if i < 30 else 59) for i in range(60)]
    np.testing.assert_array_equal(shifted[:, 2:], X[from_row, 2:])
    np.testing.assert_array_equal(shifted[:, :2], X[:, :2])


def test_a_pickle_and_a_clone_do_the_same():
    X, y, _ = late(1500, 3)
    alignment = kelpie.Alignment(rate=10.0).fit(X, y)
    again = pickle.loads(pickle.dumps(alignment))
    np.testing.assert_array_equal(again.transform(X), alignment.transform(X))
    base = pytest.importorskip("sklearn.base")
    assert base.clone(alignment).fit(X, y).rows_ == 3


def test_data_frames_name_the_states():
    pandas = pytest.importorskip("pandas")
    X, y, _ = late(1500, 3)
    frame = pandas.DataFrame(X, columns=INPUTS)
    alignment = kelpie.Alignment(rate=10.0).fit(frame, y)
    assert alignment.commands_ == ["n1", "n2"] and alignment.rows_ == 3
    with pytest.raises(ValueError, match="feature names"):
        alignment.transform(frame.rename(columns={"n1": "m1"}))


def test_too_few_rows_give_none_and_say_why():
    X, y, _ = late(50, 3)
    alignment = kelpie.Alignment(rate=10.0, states=["x0", "x1"]).fit(X, y)
    assert alignment.rows_ == 0 and "too few" in alignment.why_


@pytest.mark.parametrize("options", [{"shift": "soon"}, {"shift": 11.0}, {"shift": np.nan},
                                     {"rate": 0.0}, {"rate": np.nan}, {"states": ["x0"]},
                                     {"states": ["x0", "depth"]}])
def test_hostile_parameters(options):
    X, y, _ = late(60, 0)
    with pytest.raises(ValueError):
        kelpie.Alignment(**{"rate": 10.0, **options}).fit(X, y)


def test_hostile_rows():
    X, y, t = late(60, 0)
    alignment = kelpie.Alignment(rate=10.0, states=["x0", "x1"])
    with pytest.raises(ValueError, match="not fitted"):
        alignment.transform(X)
    with pytest.raises(ValueError, match="NaN"):
        alignment.fit(np.where(X == X[3, 2], np.nan, X), y)
    with pytest.raises(ValueError, match="inconsistent"):
        alignment.fit(X, y[:-1])
    with pytest.raises(ValueError, match="must not go down"):
        alignment.fit(X, y, t[::-1])
    with pytest.raises(ValueError, match="features"):
        alignment.fit(X, y).transform(X[:, :3])


def test_a_loaded_model_tells_its_shift(tmp_path):
    X, y, t = late(400, 0)
    model = kelpie.DynamicsModel(inputs=INPUTS, rate=10.0, warmup=50, buffer=100).fit(X, y, t)
    assert model.alignment_s_ == 0.0
    model.save(tmp_path / "model.json")
    text = (tmp_path / "model.json").read_text().replace(
        '"alignment": null', '"alignment": {"shift_s": 0.3, "rows": 3, "commands": ["n1", "n2"]}')
    (tmp_path / "model.json").write_text(text)
    assert kelpie.DynamicsModel.load(tmp_path / "model.json").alignment_s_ == 0.3


def sluggish(rows, lag_s=0.8):
    """A log whose rotors take time: what was sent, the rotors as they are, and the targets."""
    log = drive(rows)
    sent = log.X.copy()
    share = np.exp(-0.1 / lag_s)
    sent[1:, 2:] = (log.X[1:, 2:] - share * log.X[:-1, 2:]) / (1 - share)
    return sent, log.X, log.y


def test_finds_actuators_and_sends_commands_through_them():
    X, rotors, y = sluggish(1500)
    alignment = kelpie.Alignment(rate=10.0).fit(X, y)
    assert [actuator["command"] for actuator in alignment.actuators_] == ["x2", "x3"]
    for actuator in alignment.actuators_:
        assert actuator["lag_s"] == pytest.approx(0.8, rel=0.3)
    aligned = alignment.transform(X)
    for column in (2, 3):
        missed = np.std(aligned[50:, column] - rotors[50:, column])
        assert missed < 0.3 * np.std(X[50:, column] - rotors[50:, column])
    again = pickle.loads(pickle.dumps(alignment))
    np.testing.assert_array_equal(again.transform(X), aligned)
    given = kelpie.Alignment(shift=alignment.shift_s_, actuators=alignment.actuators_,
                             rate=10.0).fit(X, y)
    np.testing.assert_array_equal(given.transform(X), aligned)
    assert given.actuators_ == alignment.actuators_


def test_given_actuators_act_as_their_numbers_say():
    X, _, y = sluggish(60)
    X[:, 3] = np.where(np.arange(60) >= 30, 1700.0, 1500.0)
    t = 0.1 * np.arange(60)
    states = ["x0", "x1"]
    alignment = kelpie.Alignment(
        shift=0.0, rate=10.0, states=states,
        actuators=[{"command": "x3", "neutral": 1500, "lag_s": 0.5}]).fit(X, y, t)
    aligned = alignment.transform(X, t)
    np.testing.assert_array_equal(aligned[:, :3], X[:, :3])
    np.testing.assert_array_equal(aligned[:30, 3], 0.0)
    steps = np.arange(1, 31) * 0.1  # the command rises within the first of these
    expected = 200.0 * (1 - np.exp(-(steps - 0.05) / 0.5))
    np.testing.assert_allclose(aligned[30:, 3], expected, atol=2.0)
    assert alignment.actuators_[0] == {"command": "x2", "neutral": 0.0, "dead_band": 0.0,
                                       "astern": 1.0, "lag_s": 0.0, "rate": 0.0, "delay_s": 0.0}


@pytest.mark.parametrize("actuators, said", [
    ([{"command": "x2", "lag_s": -1.0}], "lag_s: has to be 0 s or more"),
    ([{"command": "x2", "lag_s": np.nan}], "lag_s: has to be finite"),
    ([{"command": "x2", "lags": 1.0}], "have no 'lags'"),
    ([{"command": "x0"}], "'x0' is no command; the commands are x2, x3"),
    ([{"lag_s": 1.0}], "None is no command"),
    ([{"command": "x2"}, {"command": "x2"}], "a command has two"),
    ([{"command": "x2", "delay_s": 11.0}], "from 0 to 10 s")])
def test_hostile_actuators(actuators, said):
    X, y, _ = late(60, 0)
    with pytest.raises(ValueError, match=said):
        kelpie.Alignment(shift=0.0, actuators=actuators, rate=10.0,
                         states=["x0", "x1"]).fit(X, y)
    with pytest.raises(ValueError, match="go with a given shift"):
        kelpie.Alignment(actuators=actuators, rate=10.0, states=["x0", "x1"]).fit(X, y)


def test_a_loaded_model_keeps_its_actuators(tmp_path):
    X, y, t = late(400, 0)
    model = kelpie.DynamicsModel(inputs=INPUTS, rate=10.0, warmup=50, buffer=100).fit(X, y, t)
    assert model.actuators_ == []
    model.save(tmp_path / "model.json")
    saved = json.loads((tmp_path / "model.json").read_text())
    saved["alignment"] = {"shift_s": 0.0, "rows": 0, "commands": ["n1", "n2"], "actuators": [
        {"command": name, "neutral": 0.0, "dead_band": 0.0, "astern": 1.0, "lag_s": 0.4,
         "rate": 0.0, "delay_s": 0.0} for name in ("n1", "n2")]}
    (tmp_path / "model.json").write_text(json.dumps(saved))
    loaded = kelpie.DynamicsModel.load(tmp_path / "model.json")
    assert loaded.actuators_ == saved["alignment"]["actuators"]
    again = pickle.loads(pickle.dumps(loaded.partial_fit(X, y, t + 100.0)))
    assert again.actuators_ == loaded.actuators_
    again.save(tmp_path / "again.json")
    assert json.loads((tmp_path / "again.json").read_text())["alignment"] == saved["alignment"]
    alignment = kelpie.Alignment(shift=loaded.alignment_s_, actuators=loaded.actuators_,
                                 rate=10.0, states=["x0", "x1"])
    with pytest.raises(ValueError, match="'n1' is no command"):
        alignment.fit(X, y)


def test_data_frames_come_out_where_they_are_wanted():
    pandas = pytest.importorskip("pandas")
    pytest.importorskip("sklearn")
    X, y, t = late(1500, 3)
    frame = pandas.DataFrame(X, columns=INPUTS)
    alignment = kelpie.Alignment(rate=10.0).set_output(transform="pandas")
    aligned = alignment.fit_transform(frame, y)
    assert list(aligned.columns) == INPUTS == list(alignment.get_feature_names_out())
    plain = kelpie.Alignment(rate=10.0).fit_transform(frame, y)
    assert isinstance(plain, np.ndarray) and np.array_equal(aligned.to_numpy(), plain)
    assert list(kelpie.Alignment(rate=10.0).fit(X, y).get_feature_names_out()) == [
        "x0", "x1", "x2", "x3"]
    with pytest.raises(ValueError, match="rate: isn't known"):
        kelpie.Alignment().fit(X, y)
    timed = kelpie.Alignment().fit(X, y, t)
    assert timed.rate_ == pytest.approx(10.0) and timed.rows_ == 3
