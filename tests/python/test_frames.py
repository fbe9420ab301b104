# SPDX-License-Identifier: Apache-2.0
"""Data frames, time stamps and what else people who come from pandas and scikit-learn expect."""

import datetime
import pickle
from statistics import NormalDist

import numpy as np
import pytest
from conftest import INPUTS, SMALL, TARGETS

import kelpie
from kelpie._clock import Clock

pandas = pytest.importorskip("pandas")
PLAIN = {name: value for name, value in SMALL.items() if name not in ("inputs", "targets")}


@pytest.fixture(scope="module")
def table(log):
    return pandas.DataFrame(np.column_stack([log.t, log.y, log.X]),
                            columns=["t", *TARGETS, *INPUTS])


@pytest.fixture(scope="module")
def model(log):
    return kelpie.DynamicsModel(**SMALL).fit(log.X[:400], log.y[:400], log.t[:400])


def test_a_whole_log_is_learned_as_it_is(log, table, model):
    note = table.assign(note="dive 7")
    whole = kelpie.DynamicsModel(**PLAIN).fit(note[:400])
    assert whole.inputs_ == INPUTS and whole.targets_ == TARGETS
    assert np.array_equal(whole.predict(log_frame(log)), model.predict(log.X))
    assert np.array_equal(whole.predict(note), model.predict(log.X))
    assert whole.score(note, note[TARGETS]) == model.score(log.X, log.y)
    whole.partial_fit(note[400:])
    model = pickle.loads(pickle.dumps(model)).partial_fit(log.X[400:], log.y[400:], log.t[400:])
    assert np.array_equal(whole.predict(note), model.predict(log.X))
    with pytest.raises(ValueError, match="y to be passed"):
        kelpie.DynamicsModel(**PLAIN).fit(log.X)
    with pytest.raises(ValueError, match="derivative"):
        kelpie.DynamicsModel(**PLAIN).fit(table[["t", *INPUTS]])


def test_columns_that_tell_nothing_are_left_out_of_a_whole_log(log, table, model, tmp_path):
    idle = table.assign(n3=7.0, number=np.arange(len(table)), n1_again=table["n1"])[:400]
    idle.to_csv(tmp_path / "log.csv", index=False)
    with pytest.warns(UserWarning, match="X: n3, number, n1_again: left out, as `kelpie learn`"):
        whole = kelpie.DynamicsModel(**PLAIN).fit(idle)
    assert whole.inputs_ == kelpie.read_log(tmp_path / "log.csv").attrs["inputs"] == INPUTS
    assert np.array_equal(whole.predict(log_frame(log)), model.predict(log.X))
    every = [*INPUTS, "n3", "number", "n1_again"]
    # A block tells nothing of the blocks to come.
    assert kelpie.DynamicsModel(**PLAIN).partial_fit(idle).inputs_ == every
    assert kelpie.DynamicsModel(**PLAIN, inputs=every).fit(idle).inputs_ == every


def log_frame(log):
    return pandas.DataFrame(log.X, columns=INPUTS)


def test_rows_with_gaps_are_passed_over_in_a_whole_log(log, table):
    t = np.round(log.t, 6)  # as stamps have it
    gappy = table.assign(t=t)
    gappy.loc[gappy.index[[3, 50]], "u"] = np.nan
    gappy["unused"] = np.nan
    model = kelpie.DynamicsModel(**{**SMALL, "inputs": INPUTS}).fit(gappy)
    rest = np.delete(np.arange(600), [3, 50])
    other = kelpie.DynamicsModel(**SMALL).fit(log.X[rest], log.y[rest], t[rest])
    assert np.array_equal(model.predict(log_frame(log)), other.predict(log.X))
    stamped = gappy.assign(t=pandas.Timestamp("2026-05-01") + pandas.to_timedelta(t, unit="s"))
    for frame, none in ((gappy, np.nan), (stamped, pandas.NaT)):  # as `kelpie learn` does
        timeless = frame.copy()
        timeless["u"] = log.X[:, 0]
        timeless.loc[timeless.index[[3, 50]], "t"] = none
        model = kelpie.DynamicsModel(**{**SMALL, "inputs": INPUTS}).fit(timeless)
        assert np.array_equal(model.predict(log_frame(log)), other.predict(log.X))
    with pytest.raises(ValueError, match="t contains NaN"):
        kelpie.DynamicsModel(**SMALL).fit(table, t=np.where(log.t == log.t[3], np.nan, log.t))


def test_columns_are_taken_by_name(log, table, model):
    mixed = table[["n2", "v", "t", "u", "n1"]]
    named = kelpie.DynamicsModel(**SMALL).fit(mixed[:400], table[TARGETS][:400], t="t")
    assert np.array_equal(named.predict(mixed), model.predict(log.X))
    assert np.array_equal(named.rollout(mixed[:20], log.t[:20]).velocity,
                          model.rollout(log.X[:20], log.t[:20]).velocity)
    with pytest.raises(ValueError, match="t: there is no column 'time'"):
        kelpie.DynamicsModel(**SMALL).fit(mixed, table[TARGETS], t="time")
    with pytest.raises(ValueError, match="no data frame"):
        kelpie.DynamicsModel(**SMALL).fit(log.X, log.y, t="t")
    with pytest.raises(ValueError, match="seen at fit time, yet now missing"):
        named.predict(mixed.drop(columns="u"))


def test_a_loaded_model_takes_its_columns(log, table, model, tmp_path):
    model.save(tmp_path / "model.json")
    loaded = kelpie.DynamicsModel.load(tmp_path / "model.json")
    assert np.array_equal(loaded.predict(table), model.predict(log.X))
    loaded.partial_fit(table[400:])
    other = kelpie.DynamicsModel.load(tmp_path / "model.json")
    other.partial_fit(log.X[400:], log.y[400:], log.t[400:])
    assert np.array_equal(loaded.predict(table), other.predict(log.X))


def test_a_loaded_model_takes_no_other_column_in_place_of_its_own(log, table, model, tmp_path):
    model.save(tmp_path / "model.json")
    loaded = kelpie.DynamicsModel.load(tmp_path / "model.json")
    wrong = log_frame(log).rename(columns={"n1": "battery"})
    with pytest.raises(ValueError, match="lacks the model's inputs n1; the columns are"):
        loaded.predict(wrong)
    with pytest.raises(ValueError, match="lacks the model's inputs n1"):
        loaded.partial_fit(wrong, log.y, log.t)
    plain = pandas.DataFrame(log.X)  # no names: columns count by their places
    assert np.array_equal(loaded.predict(plain), model.predict(log.X))


def test_velocities_are_known_wherever_they_stand(log, table):
    columns = ["n1", "u", "n2", "v"]
    found = kelpie.DynamicsModel(**PLAIN).fit(table[columns], table[TARGETS])
    assert found._model.settings["states"] == "u,v"
    told = kelpie.DynamicsModel(**PLAIN, velocities=["u", "v"])
    told.fit(table[columns], table[TARGETS])
    assert np.array_equal(found.predict(table[columns]), told.predict(table[columns]))
    named = table.rename(columns={"u": "forward", "v": "right"})
    other = kelpie.DynamicsModel(**PLAIN, velocities=["forward", "right"])
    other.fit(named[["n1", "forward", "n2", "right"]], table[TARGETS])
    assert np.isfinite(other.rollout(named[["n1", "forward", "n2", "right"]][:9]).velocity).all()
    with pytest.raises(ValueError, match="forwrd.*did you mean 'forward'"):
        kelpie.DynamicsModel(**PLAIN, velocities=["forwrd", "right"]).fit(
            named[["n1", "forward", "n2", "right"]], table[TARGETS])


START = datetime.datetime(2026, 3, 1, 12)
STAMPS = {
    "index": lambda t: pandas.Timestamp(START) + pandas.to_timedelta(t, unit="s"),
    "series": lambda t: pandas.Series(STAMPS["index"](t)),
    "time zone": lambda t: STAMPS["index"](t).tz_localize("Europe/Berlin"),
    "series with time zone": lambda t: STAMPS["series"](t).dt.tz_localize("Europe/Berlin"),
    "numpy": lambda t: STAMPS["index"](t).to_numpy(),
    "microseconds": lambda t: STAMPS["numpy"](t).astype("datetime64[us]"),
    "list": lambda t: list(STAMPS["index"](t)),
    "datetime": lambda t: [START + datetime.timedelta(seconds=second) for second in t],
    "datetime with time zone": lambda t: [stamp.replace(tzinfo=datetime.timezone.utc)
                                          for stamp in STAMPS["datetime"](t)],
    "durations": lambda t: pandas.to_timedelta(t, unit="s"),
}


@pytest.mark.parametrize("kind", STAMPS)
def test_times_may_be_stamps(log, kind):
    t = np.round(log.t, 6)
    stamps = STAMPS[kind](t)
    seconds = kelpie.DynamicsModel(**SMALL).partial_fit(log.X, log.y, t)
    model = kelpie.DynamicsModel(**SMALL)
    model.partial_fit(log.X[:300], log.y[:300], stamps[:300])
    model = pickle.loads(pickle.dumps(model))
    model.partial_fit(log.X[300:], log.y[300:], stamps[300:])
    assert np.array_equal(model.predict(log.X), seconds.predict(log.X))
    assert np.array_equal(model.rollout(log.X[:20], stamps[:20]).velocity,
                          seconds.rollout(log.X[:20], t[:20]).velocity)
    whole = kelpie.Alignment(rate=10.0, shift=0.2, states=["x0", "x1"])
    assert np.array_equal(whole.fit(log.X, log.y, stamps).transform(log.X, stamps),
                          whole.fit(log.X, log.y, t).transform(log.X, t))


def test_wrong_stamps_are_refused(log):
    stamps = STAMPS["index"](log.t)
    model = kelpie.DynamicsModel(**SMALL).fit(log.X[:300], log.y[:300], stamps[:300])
    later = (log.X[300:], log.y[300:])
    for t, message in ((log.t[300:], "seconds can't follow"), (stamps[:300], "must not go down"),
                       (stamps[300:].where(log.t[300:] > 40.0), "NaT"),
                       ([*stamps[300:-1], 3.0], "3.0 is no time stamp")):
        with pytest.raises(ValueError, match=message):
            model.partial_fit(*later, t)
    model = kelpie.DynamicsModel(**SMALL).fit(log.X[:300], log.y[:300], log.t[:300])
    with pytest.raises(ValueError, match="time stamps can't follow"):
        model.partial_fit(*later, stamps[300:])
    assert model.n_samples_seen_ == 300


def test_a_clock_changes_nothing_before_rows_are_learned():
    clock = Clock()
    stamps = np.array(["2026-01-01", "2026-01-02"], "datetime64[D]")
    assert list(clock.times(stamps, 2, 0, 1.0)) == [0.0, 86400.0]
    assert list(clock.times(np.array([5.0, 6.0]), 2, 0, 1.0)) == [5.0, 6.0]


def test_stamps_in_a_whole_log(log, table, model):
    stamps = STAMPS["time zone"](log.t)
    index = table.drop(columns="t").set_index(stamps)
    column = table.drop(columns="t").assign(time=stamps)
    for frame, t in ((index, None), (column, None), (column.rename(columns={"time": "at"}), "at")):
        whole = kelpie.DynamicsModel(**PLAIN).fit(frame[:400], t=t)
        assert whole.inputs_ == INPUTS
        assert np.allclose(whole.predict(frame), model.predict(log.X), rtol=0, atol=1e-6)


def test_intervals_and_deviations(log, model):
    told = model.assess(log.X)
    value, lower, upper = model.predict(log.X, return_interval=True)
    assert np.array_equal(value, model.predict(log.X))
    assert np.array_equal(lower, told["lower"]) and np.array_equal(upper, told["upper"])
    mean, std = model.predict(log.X, return_std=True)
    assert std.shape == value.shape and np.array_equal(mean, value)
    wide = NormalDist().inv_cdf(0.95)
    assert np.allclose(mean + wide * std, upper, rtol=0, atol=1e-12)
    one = kelpie.OnlineSVR(targets="udot", **PLAIN).fit(log.X, log.y[:, 0])
    assert one.predict(log.X, return_std=True)[1].shape == (600,)
    with pytest.raises(ValueError, match="give one of them"):
        model.predict(log.X, return_std=True, return_interval=True)


def test_weights_are_refused_in_words(log):
    model = kelpie.DynamicsModel(**SMALL)
    for call in (model.fit, model.partial_fit):
        with pytest.raises(ValueError, match="sample_weight: rows of a stream have no weights"):
            call(log.X, log.y, sample_weight=np.ones(600))
        with pytest.raises(TypeError, match="no weight"):
            call(log.X, log.y, weight=1)
    model.fit(log.X, log.y, sample_weight=None)


def test_pickles_of_before_there_was_a_parameter(log, model):
    state = model.__getstate__()
    del state["C"], state["velocities"], state["_by_name"]
    old = kelpie.DynamicsModel.__new__(kelpie.DynamicsModel)
    old.__setstate__(state)
    assert old.get_params() == model.get_params()
    assert np.array_equal(old.predict(log.X), model.predict(log.X))


def test_a_log_without_time_is_refused_and_rows_are_counted_only_aloud(log, table):
    timeless = table.drop(columns="t")
    small = {name: value for name, value in PLAIN.items() if name != "rate"}
    with pytest.raises(ValueError, match="rate: isn't known.*rate=4.0"):
        kelpie.DynamicsModel(**small).fit(timeless)
    with pytest.warns(UserWarning, match="rows count as 1 s each"):
        counted = kelpie.DynamicsModel(**small).fit(timeless[INPUTS], timeless[TARGETS])
    slow = kelpie.DynamicsModel(**{**small, "rate": 1.0}).fit(timeless[INPUTS], timeless[TARGETS])
    assert np.array_equal(counted.predict(log_frame(log)), slow.predict(log_frame(log)))
    with pytest.raises(ValueError, match="rate: isn't known"):
        counted.rollout(log_frame(log)[:9])
    for rate, message in (("4 Hz", "'4 Hz' is no number.*rate=4.0"), (True, "no number"),
                          (np.inf, "out of range")):
        with pytest.raises(ValueError, match=message):
            kelpie.DynamicsModel(**{**small, "rate": rate}).fit(timeless)


@pytest.mark.parametrize("kind", ["index", "durations", "seconds"])
def test_the_index_tells_the_time_of_columns(log, table, model, kind):
    t = np.round(log.t, 6)
    index = (pandas.Index(t, name="time") if kind == "seconds"
             else pandas.Index(STAMPS[kind](t)))
    frame = table.drop(columns="t").set_index(index)
    found = kelpie.DynamicsModel(**{**PLAIN, "rate": None})
    found.partial_fit(frame[INPUTS].iloc[:200], frame[TARGETS].iloc[:200])
    found.partial_fit(frame[INPUTS].iloc[200:400], frame[TARGETS].iloc[200:400])
    told = kelpie.DynamicsModel(**SMALL).partial_fit(log.X[:400], log.y[:400], t[:400])
    assert np.array_equal(found.predict(log_frame(log)), told.predict(log.X))
    assert np.array_equal(found.rollout(frame[INPUTS].iloc[:9]).velocity,
                          told.rollout(log.X[:9], t[:9]).velocity)


def test_frames_go_in_and_come_out(log, table, model):
    frame = table.set_index(pandas.Index(range(1000, 1600)))
    found = kelpie.DynamicsModel(**SMALL)
    found.fit(frame[INPUTS][:400], frame[TARGETS][:400], log.t[:400])
    decisions = found.decisions_
    assert list(decisions.index) == list(range(1000, 1400))
    assert list(decisions["predicted"].columns) == TARGETS
    assert np.array_equal(decisions["predicted"].to_numpy(), model.decisions_["predicted"],
                          equal_nan=True)
    told = found.assess(frame[INPUTS][400:])
    assert list(told.index) == list(range(1400, 1600))
    plain = model.assess(log.X[400:])
    for name in plain.dtype.names:
        assert np.array_equal(told[name].to_numpy(), plain[name])
    one = kelpie.OnlineSVR(targets="udot", **PLAIN).fit(frame[INPUTS], frame["udot"], log.t)
    assert list(one.decisions_["verdict"].index) == list(frame.index)
    assert list(one.assess(frame[INPUTS]).columns) == list(
        kelpie.OnlineSVR(targets="udot", **PLAIN).fit(log.X, log.y[:, 0]).assess(log.X).dtype.names)
    again = pickle.loads(pickle.dumps(found))
    assert again.decisions_.equals(decisions)
    assert isinstance(model.decisions_, np.ndarray) and isinstance(model.assess(log.X), np.ndarray)


def test_a_missing_column_is_named(table):
    model = kelpie.DynamicsModel(inputs=["u", "q"], rate=10.0)
    with pytest.raises(ValueError, match="inputs: there is no column 'q'; the columns are u, v"):
        model.fit(table[INPUTS], table[TARGETS])
