# SPDX-License-Identifier: Apache-2.0
"""The transformer that shifts commands."""

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
