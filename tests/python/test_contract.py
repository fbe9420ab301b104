# SPDX-License-Identifier: Apache-2.0
"""scikit-learn's contract, with it and without."""

import inspect
import subprocess
import sys

import numpy as np
import pytest
from conftest import SMALL

import kelpie
from kelpie import _kelpie, _settings

sklearn = pytest.importorskip("sklearn")


def checks_of(estimator):
    from sklearn.utils.estimator_checks import check_estimator
    return [pytest.param(made, check, id=f"{type(made).__name__}-{check.func.__name__}")
            for made, check in check_estimator(estimator, generate_only=True)]


@pytest.mark.filterwarnings("ignore::sklearn.exceptions.SkipTestWarning")
@pytest.mark.parametrize("estimator, check",
                         checks_of(kelpie.OnlineSVR()) + checks_of(kelpie.DynamicsModel()))
def test_every_check_of_scikit_learn(estimator, check):
    check(estimator)


def test_cross_validation_and_search_work(log):
    from sklearn.model_selection import GridSearchCV, KFold
    model = kelpie.DynamicsModel(**SMALL, learner="svr")  # other members have no epsilon
    search = GridSearchCV(model, {"epsilon": [0.1, 2.0]}, cv=KFold(3))
    search.fit(log.X, log.y)
    assert search.best_params_ == {"epsilon": 0.1}
    assert search.best_score_ > 0.7


def test_score_is_scikit_learns(log):
    from sklearn.metrics import r2_score
    model = kelpie.DynamicsModel(**SMALL).fit(log.X[:400], log.y[:400])
    X, y, weights = log.X[400:], log.y[400:], np.linspace(0.5, 2.0, 200)
    assert model.score(X, y) == pytest.approx(r2_score(y, model.predict(X)), abs=1e-12)
    assert model.score(X, y, weights) == pytest.approx(
        r2_score(y, model.predict(X), sample_weight=weights), abs=1e-12)


def test_parameters_are_those_of_the_library():
    names = ["inputs", "targets", "rate", "nominal"]
    for name, _, _, _ in _kelpie.setting_docs():
        names.append(_settings.parameter_name(name))
        names += [_settings.ALIASES[name]] if name in _settings.ALIASES else []
    for estimator in (kelpie.OnlineSVR(), kelpie.DynamicsModel()):
        assert list(estimator.get_params()) == names
        told = [type(estimator).__doc__.index(f"\n{name} : ") for name in names]
        assert told == sorted(told)
    groups = [group for _, _, _, group in _kelpie.setting_docs()]
    assert all(f"\n{group}:\n" in kelpie.DynamicsModel.__doc__ for group in groups)


def test_settings_with_two_names(log):
    one = kelpie.DynamicsModel(**SMALL, c=0.3, states="u,v").fit(log.X, log.y)
    other = kelpie.DynamicsModel(**SMALL, C=0.3, velocities=["u", "v"]).fit(log.X, log.y)
    assert np.array_equal(one.predict(log.X), other.predict(log.X))
    assert other._model.settings["states"] == "u,v"
    for both in ({"c": 0.3, "C": 0.3}, {"states": "u,v", "velocities": ["u", "v"]}):
        with pytest.raises(ValueError, match="is another name of"):
            kelpie.DynamicsModel(**SMALL, **both).fit(log.X, log.y)


def test_a_preset_gives_what_no_parameter_says(log):
    model = kelpie.DynamicsModel(preset="paper", gamma=(0.5, 0.25), warmup=50, buffer=100)
    model.fit(log.X, log.y)
    settings = _kelpie.preset_values("paper", 2)
    settings.update({"gamma": "0.5,0.25", "warmup": "50", "buffer": "100"})
    assert model._model.settings == settings


def test_without_scikit_learn():
    script = """
import sys
sys.modules["sklearn"] = None
import numpy as np
import kelpie
random = np.random.default_rng(1)
X = random.standard_normal((300, 2))
y = X[:, 0] - X[:, 1] ** 2
model = kelpie.OnlineSVR(gamma=0.3)
assert repr(model) == "OnlineSVR(gamma=0.3)", model
try:
    model.predict(X)
except ValueError as error:
    assert "not fitted" in str(error)
else:
    raise AssertionError("an unfitted model predicts")
assert model.fit(X, y).score(X, y) > 0.8
assert model.get_params()["gamma"] == 0.3
assert not any(name.startswith("sklearn.") for name in sys.modules)
"""
    subprocess.run([sys.executable, "-B", "-c", script], check=True)


def test_the_constructor_knows_what_was_meant():
    for estimator in (kelpie.OnlineSVR, kelpie.DynamicsModel):
        with pytest.raises(TypeError, match="Invalid parameter 'gama'.*did you mean 'gamma'"):
            estimator(gama=3)
        assert "gamma" in inspect.signature(estimator).parameters
