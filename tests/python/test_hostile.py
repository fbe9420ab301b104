# SPDX-License-Identifier: Apache-2.0
"""Whatever is passed in, an exception comes out and the model is as before."""

import numpy as np
import pytest
from conftest import SMALL

import kelpie
from kelpie import _kelpie


@pytest.fixture(scope="module")
def model(log):
    return kelpie.DynamicsModel(**SMALL).fit(log.X, log.y, log.t)


LAYOUTS = {
    "fortran": np.asfortranarray,
    "strided": lambda X: np.repeat(X, 2, axis=0)[::2],
    "reversed": lambda X: X[::-1].copy()[::-1],
    "big endian": lambda X: X.astype(">f8"),
    "objects": lambda X: X.astype(object),
    "list": lambda X: X.tolist(),
    "misaligned": lambda X: misaligned(X),
}


def misaligned(X):
    raw = np.empty(X.nbytes + 1, np.uint8)[1:]
    raw[:] = np.frombuffer(X.tobytes(), np.uint8)
    return raw.view(np.float64).reshape(X.shape)


@pytest.mark.parametrize("layout", LAYOUTS)
def test_any_layout_gives_the_same(log, model, layout):
    change = LAYOUTS[layout]
    other = kelpie.DynamicsModel(**SMALL).fit(change(log.X), change(log.y), log.t)
    assert np.array_equal(other.predict(change(log.X)), model.predict(log.X))


BAD_X = {
    "nan": lambda X: np.where(X == X[1, 1], np.nan, X),
    "inf": lambda X: np.where(X == X[1, 1], np.inf, X),
    "no rows": lambda X: X[:0],
    "no columns": lambda X: X[:, :0],
    "one dimension": lambda X: X[:, 0],
    "three dimensions": lambda X: X[:, :, None],
    "a number": lambda X: 1.0,
    "words": lambda X: np.full(X.shape, "word"),
    "dicts": lambda X: np.full(X.shape, {}, dtype=object),
    "ragged": lambda X: [[1.0, 2.0], [3.0]],
    "complex": lambda X: X + 1j,
    "dates": lambda X: np.full(X.shape, np.datetime64("2020-01-01")),
    "nothing": lambda X: None,
    "too few columns": lambda X: X[:, :3],
    "too many columns": lambda X: np.hstack([X, X]),
}


@pytest.mark.filterwarnings("ignore::numpy.VisibleDeprecationWarning")
@pytest.mark.parametrize("bad", BAD_X)
def test_bad_inputs_are_refused(log, model, bad):
    X = BAD_X[bad](log.X)
    calls = [lambda: model.predict(X), lambda: model.assess(X), lambda: model.rollout(X),
             lambda: model.predict_with_jacobian(X), lambda: model.partial_fit(X, log.y)]
    for call in calls:
        with pytest.raises((ValueError, TypeError)):
            call()
    assert model.n_samples_seen_ == 600


@pytest.mark.parametrize("y", [None, 1.0, [], np.zeros(5), np.zeros((600, 3)), np.zeros(600),
                               np.full((600, 2), np.nan), np.zeros((600, 2, 1)), "y"])
def test_bad_targets_are_refused(log, model, y):
    for call in (model.partial_fit, model.score):
        with pytest.raises((ValueError, TypeError)):
            call(log.X, y)
    assert model.n_samples_seen_ == 600


@pytest.mark.parametrize("t", [np.arange(600.0)[::-1], np.zeros(600), np.zeros(3), np.nan,
                               np.full(600, np.inf), np.full((600, 1), 1e6)])
def test_bad_times_are_refused(log, model, t):
    with pytest.raises(ValueError):
        model.partial_fit(log.X, log.y, t)
    assert model.n_samples_seen_ == 600


@pytest.mark.parametrize("setting, message", [
    ({"gamma": -1.0}, "gamma: -1 is out of range; it has to be more than 0"),
    ({"gamma": (1.0, 2.0, 3.0)}, "gamma: 3 values for 2 targets"),
    ({"buffer": 10.5}, "whole number"),
    ({"buffer": True}, "buffer: True"),
    ({"buffer": object()}, "neither a number nor a text"),
    ({"solver": "pth"}, "path"),
    ({"preset": "papr"}, "paper"),
    ({"terms": "u*w"}, "w"),
    ({"inputs": ["u"]}, "1 names for 4 columns"),
    ({"rate": 0.0}, "rate: 0.0 is out of range"),
    ({"epsilon": float("nan")}, "epsilon"),
])
def test_wrong_settings_are_named(log, setting, message):
    with pytest.raises(ValueError, match=message.replace("(", "\\(")):
        kelpie.DynamicsModel(**{**SMALL, **setting}).fit(log.X, log.y)


def test_an_unknown_parameter_has_a_suggestion():
    with pytest.raises(ValueError, match="did you mean 'gamma'"):
        kelpie.OnlineSVR().set_params(gama=1.0)


def test_extreme_numbers_do_no_harm(log):
    X = log.X.copy()
    X[300:] *= 1e300
    model = kelpie.DynamicsModel(**SMALL).fit(X, log.y * 1e150)
    model.predict(X), model.assess(X), model.predict_with_jacobian(X)


def test_files_that_are_no_models(log, model, tmp_path):
    model.save(tmp_path / "model.json")
    sound = (tmp_path / "model.json").read_text()
    for text in ("", "{}", "[", '{"format": "kelpie-model", "version": 99}',
                 '{"more": ' + 100_000 * "[" + 100_000 * "]" + "," + sound[1:]):
        (tmp_path / "bad.json").write_text(text)
        with pytest.raises(ValueError, match="bad.json"):
            kelpie.DynamicsModel.load(tmp_path / "bad.json")
    with pytest.raises(FileNotFoundError):
        kelpie.DynamicsModel.load(tmp_path / "none.json")
    with pytest.raises(RuntimeError, match="missing"):
        model.save(tmp_path / "missing" / "model.json")


def test_a_rollout_has_to_go_on(log, model):
    for t in (np.zeros(600), np.arange(600.0)[::-1], np.arange(5.0), 0.0, np.arange(600) * 1e9):
        with pytest.raises(ValueError):
            model.rollout(log.X, t)
    for wrong in ({"step_s": 0.0}, {"measured": [2]}, {"between": "?"}):
        with pytest.raises(ValueError):
            model.rollout(log.X, **wrong)


def test_the_module_itself_refuses(log, model):
    live = model._model
    for wrong in (log.X.astype(np.float32), np.asfortranarray(log.X), log.X[:, ::2], "X", None):
        with pytest.raises(TypeError):
            live.predict(wrong)
    for wrong in (log.X[:, :3].copy(), log.X[0], misaligned(log.X)):
        with pytest.raises(ValueError):
            live.predict(wrong)
    with pytest.raises(ValueError):
        live.update(log.X, log.y[:5].copy(), log.t)
    assert live.predict(np.empty((0, 4))).shape == (0, 2)
    for call in (live.predict, lambda X: live.assess(X, np.zeros(len(X))),
                     live.predict_with_jacobian):
        call(np.full((1, 4), np.nan))
    before = live.samples
    decided = live.update(np.full((1, 4), np.nan), np.zeros((1, 2)), np.array([1e6]))
    assert (decided["verdict"] == kelpie.Verdict.INVALID).all() and live.samples == before + 1
    with pytest.raises(ValueError, match="inputs"):
        _kelpie.LiveModel([], ["y"], {})
