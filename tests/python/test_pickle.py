# SPDX-License-Identifier: Apache-2.0
"""A learner that was put away goes on as if it had never stopped."""

import copy
import pickle

import numpy as np
import pytest
from conftest import SMALL

import kelpie


@pytest.mark.parametrize("rows", [20, 50, 300])
def test_goes_on_to_the_last_bit(log, rows):
    whole = kelpie.DynamicsModel(**{**SMALL, "rate": 3.0}).partial_fit(log.X[:rows], log.y[:rows])
    put_away = pickle.loads(pickle.dumps(whole))
    whole.partial_fit(log.X[rows:], log.y[rows:])
    put_away.partial_fit(log.X[rows:], log.y[rows:])
    assert np.array_equal(whole.decisions_, put_away.decisions_)
    assert np.array_equal(whole.assess(log.X), put_away.assess(log.X))
    assert whole.status_ == put_away.status_
    assert pickle.dumps(whole._model) == pickle.dumps(put_away._model)
    assert put_away.get_params() == whole.get_params()


def test_a_copy_is_on_its_own(log):
    model = kelpie.OnlineSVR(**{**SMALL, "targets": "udot"})
    model.fit(log.X[:300], log.y[:300, 0])
    expected = model.predict(log.X)
    copy.deepcopy(model).partial_fit(log.X[300:], log.y[300:, 0])
    assert np.array_equal(model.predict(log.X), expected)


def test_a_read_model_pickles(log, tmp_path):
    model = kelpie.DynamicsModel(**SMALL).fit(log.X, log.y)
    model.save(tmp_path / "model.json")
    read = pickle.loads(pickle.dumps(kelpie.DynamicsModel.load(tmp_path / "model.json")))
    assert np.array_equal(read.predict(log.X), model.predict(log.X))


def test_an_unfitted_one_pickles():
    again = pickle.loads(pickle.dumps(kelpie.OnlineSVR(gamma=0.3)))
    assert again.gamma == 0.3 and not again.__sklearn_is_fitted__()


def test_cut_pickles_are_refused(log):
    whole = pickle.dumps(kelpie.DynamicsModel(**SMALL).fit(log.X, log.y))
    for size in range(0, len(whole), len(whole) // 23):
        with pytest.raises((EOFError, pickle.UnpicklingError, ValueError)):
            pickle.loads(whole[:size])


def test_damaged_states_are_refused(log):
    state = kelpie.DynamicsModel(**SMALL).fit(log.X, log.y)._model.__getstate__()
    names, blob = state[:-1], state[-1]
    random = np.random.default_rng(2)
    for place in random.integers(0, len(blob), 40):
        damaged = bytearray(blob)
        damaged[place] ^= 1 << random.integers(0, 8)
        with pytest.raises(ValueError, match="state of a kelpie model"):
            resume((*names, bytes(damaged)))
    for wrong in ((*names, blob[:-5]), (*names, b""), names, (), (*names, blob, 1)):
        with pytest.raises(ValueError, match="state of a kelpie model"):
            resume(wrong)
    with pytest.raises(ValueError, match="buffer"):
        resume((*names[:2], {**names[2], "buffer": "121"}, *state[3:]))
    with pytest.raises(RuntimeError):
        resume((1, 2, 3, 4, 5, 6))


def resume(state):
    model = kelpie._kelpie.LiveModel.__new__(kelpie._kelpie.LiveModel)
    model.__setstate__(state)
    return model


def test_another_version_is_refused(log):
    model = kelpie.OnlineSVR(**{**SMALL, "targets": "udot"}).fit(log.X, log.y[:, 0])
    with pytest.raises(ValueError, match="format 9"):
        kelpie.OnlineSVR().__setstate__({**model.__getstate__(), "_state_format": 9})
    *names, blob = model._model.__getstate__()
    newer = blob[:12] + b"\x09\0\0\0" + blob[16:]
    with pytest.raises(ValueError, match="version 9"):
        resume((*names, newer))
