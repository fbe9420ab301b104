# SPDX-License-Identifier: Apache-2.0
"""The transformer that shifts commands."""

import json
import pickle
import warnings

import numpy as np
import pytest
from conftest import INPUTS, drive

import kelpie
from kelpie import _kelpie


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


@pytest.mark.parametrize("rows", [2**31 - 1, -2**31, 1_000_001])
def test_a_shift_of_the_module_has_bounds(rows):
    with pytest.raises(ValueError, match="rows: have to be within"):
        _kelpie.align(np.zeros((5, 2)), np.arange(5.0), 1.0, rows, [1], [])


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


def with_alignment(file, model, alignment):
    """Saves the model with an alignment, as `kelpie learn` does."""
    model.save(file)
    saved = json.loads(file.read_text())
    saved["alignment"] = alignment
    file.write_text(json.dumps(saved))
    return file


LAGGING = {"shift_s": 0.0, "rows": 0, "commands": ["n1", "n2"], "actuators": [
    {"command": name, "neutral": 0.0, "dead_band": 0.0, "astern": 1.0, "lag_s": 0.8,
     "rate": 0.0, "delay_s": 0.0} for name in ("n1", "n2")]}
SHIFTED = {"shift_s": 0.3, "rows": 3, "commands": ["n1", "n2"]}


@pytest.fixture(scope="module")
def learned():
    """A model of rotors, with the commands that were sent."""
    sent, rotors, y = sluggish(1500)
    model = kelpie.DynamicsModel(inputs=INPUTS, rate=10.0, warmup=50, buffer=100).fit(rotors, y)
    return model, sent, y


@pytest.mark.parametrize("alignment, words", [(LAGGING, "through their actuators"),
                                              (SHIFTED, "0.3 s later")])
def test_a_loaded_model_that_had_aligned_rows_says_so_once(learned, tmp_path, alignment, words):
    model, X, y = learned
    file = with_alignment(tmp_path / "model.json", model, alignment)
    for use in (lambda m: m.predict(X), lambda m: m.assess(X), lambda m: m.score(X, y),
                lambda m: m.predict_with_jacobian(X), lambda m: m.rollout(X[:5]),
                lambda m: m.partial_fit(X[:5], y[:5])):
        loaded = kelpie.DynamicsModel.load(file).set_params(rate=10.0)
        with pytest.warns(UserWarning, match=rf"commands \(n1, n2\) {words}.*Alignment\.of\(model"):
            use(loaded)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            use(loaded)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        model.predict(X)
        told = kelpie.DynamicsModel.load(file)
        kelpie.Alignment.of(told)
        assert np.array_equal(told.predict(X), model.predict(X))


def test_a_loaded_model_with_a_current_says_who_knows_it(learned, tmp_path):
    model, X, _ = learned
    water = {"heading": "psi", "unit_rad": 1.0, "surge": "u", "sway": "v", "yaw_rate": "n1",
             "targets": [0, 1], "times_s": [0.0], "velocity_m_s": [[0.3, -0.2]]}
    file = with_alignment(tmp_path / "model.json", model,
                          {"shift_s": 0.0, "rows": 0, "commands": ["n1", "n2"], "current": water})
    loaded = kelpie.DynamicsModel.load(file)
    kelpie.Alignment.of(loaded)
    with pytest.warns(UserWarning, match="u and v through the water.*`kelpie predict`") as told:
        loaded.predict(X)
    assert len(told) == 1


@pytest.mark.parametrize("found", [LAGGING, SHIFTED])
def test_the_alignment_of_a_loaded_model(learned, tmp_path, found):
    pandas = pytest.importorskip("pandas")
    model, X, y = learned
    loaded = kelpie.DynamicsModel.load(with_alignment(tmp_path / "model.json", model, found))
    given = kelpie.Alignment(shift=found["shift_s"], actuators=found.get("actuators", []),
                             rate=10.0).fit(pandas.DataFrame(X, columns=INPUTS), y)
    right = given.transform(pandas.DataFrame(X, columns=INPUTS))
    assert not np.array_equal(right, X)
    t = 0.1 * np.arange(len(X))
    log = pandas.DataFrame(X[:, ::-1], columns=INPUTS[::-1]).assign(depth=1.0, t=t)
    alignment = kelpie.Alignment.of(loaded)
    assert alignment.commands_ == ["n1", "n2"] and alignment.shift_s_ == found["shift_s"]
    np.testing.assert_allclose(alignment.transform(log), right, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(alignment.transform(X, t), right, rtol=1e-9, atol=1e-9)
    log.rename(columns={"t": "t [ms]"}).assign(**{"t [ms]": 1000.0 * t}).to_csv(
        tmp_path / "log.csv", index=False)
    np.testing.assert_allclose(alignment.transform(kelpie.read_log(tmp_path / "log.csv")), right,
                               rtol=1e-6, atol=1e-6)
    np.testing.assert_array_equal(kelpie.Alignment.of(loaded, rate=10.0).transform(X), right)
    np.testing.assert_array_equal(pickle.loads(pickle.dumps(alignment)).transform(log),
                                  alignment.transform(log))
    if found is LAGGING:
        assert loaded.score(alignment.transform(log), y) > 0.9 > loaded.score(X, y) + 0.05
    else:  # half as many rows per second: half as many rows later
        slow = kelpie.Alignment.of(loaded).transform(X[::2], 0.25 * np.arange(len(X) // 2))
        np.testing.assert_array_equal(slow[:-1, 2:], X[::2][1:, 2:])
    with pytest.raises(ValueError, match="lacks the model's inputs n2"):
        alignment.transform(log.drop(columns="n2"))
    with pytest.raises(ValueError, match="features"):
        alignment.transform(X[:, :3], t)
    assert np.array_equal(kelpie.Alignment.of(model).transform(X, t), X)


def test_the_alignment_of_a_model_wants_times_for_actuators(learned, tmp_path):
    model, X, _ = learned
    loaded = kelpie.DynamicsModel.load(with_alignment(tmp_path / "model.json", model, LAGGING))
    with pytest.raises(ValueError, match="rate: isn't known"):
        kelpie.Alignment.of(loaded).transform(X)
    with pytest.raises(ValueError, match="rate: 0.0 is out of range"):
        kelpie.Alignment.of(loaded, rate=0.0)
    with pytest.raises(ValueError, match="not fitted"):
        kelpie.Alignment.of(kelpie.DynamicsModel())
