# SPDX-License-Identifier: Apache-2.0
"""Learners of the benchmark: naive rows, kelpie, and what Debian has of others."""

from __future__ import annotations

import importlib
import importlib.util
import inspect
import sys
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any, Optional

import numpy as np

from .._estimators import DynamicsModel
from ._data import Floats, Task
from ._manifest import ManifestError

try:
    from sklearn.ensemble import ExtraTreesRegressor
    from sklearn.gaussian_process import GaussianProcessRegressor
    from sklearn.gaussian_process.kernels import RBF, ConstantKernel, WhiteKernel
    from sklearn.linear_model import SGDRegressor
    from sklearn.preprocessing import StandardScaler
    from sklearn.svm import SVR
    HAS_SKLEARN = True
except ImportError:
    HAS_SKLEARN = False


@dataclass(frozen=True)
class Entry:
    """A learner by name. `make(task)` gives a new learner, with `partial_fit` and `predict`."""

    name: str
    kind: str  # "naive", "kelpie", "other", "yours"
    make: Callable[[Task], Any]
    meaning: str
    offline: bool = False  # learns all rows at once, and answers at the end only


class Mean:
    """The mean of the targets so far."""

    def __init__(self, task: Task) -> None:
        self.sum, self.rows = np.zeros(len(task.targets)), 0

    def partial_fit(self, X: Floats, y: Floats) -> None:
        self.sum, self.rows = self.sum + y.sum(axis=0), self.rows + len(y)

    def predict(self, X: Floats) -> Floats:
        return np.tile(self.sum / max(self.rows, 1), (len(X), 1))


class LastValue:
    """The targets of the last row. In open loop the acceleration before the start is held."""

    def __init__(self, task: Task) -> None:
        self.last = np.zeros(len(task.targets))

    def partial_fit(self, X: Floats, y: Floats) -> None:
        self.last = y[-1].copy()

    def predict(self, X: Floats) -> Floats:
        return np.tile(self.last, (len(X), 1))


class VelocityHeld:
    """No acceleration. Of targets without a velocity: zero."""

    def __init__(self, task: Task) -> None:
        self.zero = np.zeros(len(task.targets))

    def partial_fit(self, X: Floats, y: Floats) -> None:
        """There is nothing to learn."""

    def predict(self, X: Floats) -> Floats:
        return np.tile(self.zero, (len(X), 1))


def physics_terms(X: Floats, states: list[int]) -> Floats:
    """Columns 1, v, v|v|, v_i v_j of the velocities and c, c|c| of the other inputs."""
    V = X[:, states]
    C = np.delete(X, states, axis=1)
    products = [V[:, i] * V[:, j] for i in range(V.shape[1]) for j in range(i + 1, V.shape[1])]
    return np.column_stack([np.ones(len(X)), V, V * np.abs(V), *products, C, C * np.abs(C)])


class LeastSquares:
    """Least squares of physics_terms(), each row's weight fading by `forget` with every later row.

    The minimum of recursive least squares with this forgetting factor, by its normal equations.
    """

    RIDGE = 1e-6  # of each term's sum of squares

    def __init__(self, task: Task, forget: float = 1.0) -> None:
        self.states, self.forget = task.states, forget
        self.A: Any = 0.0
        self.b: Any = 0.0
        self.coefficients: Any = None

    def partial_fit(self, X: Floats, y: Floats) -> None:
        F = physics_terms(X, self.states)
        weight = self.forget ** np.arange(len(X) - 1, -1, -1.0)
        fade = self.forget ** len(X)
        self.A = fade * self.A + F.T @ (weight[:, None] * F)
        self.b = fade * self.b + F.T @ (weight[:, None] * y)
        self.coefficients = None

    def predict(self, X: Floats) -> Floats:
        if self.coefficients is None:
            scale = np.sqrt(np.maximum(np.diag(self.A), 1e-300))
            A = self.A / np.outer(scale, scale)
            right = self.b / scale[:, None]
            solved = np.linalg.solve(A + self.RIDGE * np.eye(len(A)), right)
            self.coefficients = solved / scale[:, None]
        return physics_terms(X, self.states) @ self.coefficients


class Kelpie:
    """kelpie.DynamicsModel, without alignment, with its own rollouts in open loop."""

    def __init__(self, task: Task, **settings: Any) -> None:
        velocities = [task.inputs[i] for i in task.states]
        self.model = DynamicsModel(inputs=task.inputs, targets=task.targets, rate=task.rate,
                                   velocities=velocities or None, **settings)

    def partial_fit(self, X: Floats, y: Floats, t: Floats) -> None:
        self.model.partial_fit(X, y, t)

    def predict(self, X: Floats) -> Floats:
        return self.model.predict(X)

    def rollout(self, X: Floats, t: Floats) -> Optional[Floats]:
        """None where too little was learned for rollouts: predictions are integrated then."""
        try:
            return self.model.rollout(X, t).velocity
        except ValueError:
            return None


class KelpiePaper:
    """The paper's learner with the paper's settings (the preset paper)."""

    def __init__(self, task: Task, **settings: Any) -> None:
        settings = {"preset": "paper", **settings}
        if len(task.targets) == 3:  # the preset has values for surge, sway and yaw
            self.models = [Kelpie(task, **settings)]
            self.rollout = self.models[0].rollout
        else:  # those for surge, for every target
            self.models = [Kelpie(replace(task, targets=[target], states=[]), **settings)
                           for target in task.targets]

    def partial_fit(self, X: Floats, y: Floats, t: Floats) -> None:
        for model, part in zip(self.models, np.split(y, len(self.models), axis=1)):
            model.partial_fit(X, np.ascontiguousarray(part), t)

    def predict(self, X: Floats) -> Floats:
        return np.column_stack([model.predict(X) for model in self.models])


class _Scaled:
    """Base of learners that want inputs and targets of like size."""

    def __init__(self, task: Task) -> None:
        self.task = task
        self.scale: Optional[list[Floats]] = None  # mean and spread of inputs, and of targets

    def predict(self, X: Floats) -> Floats:
        if self.scale is None:
            return np.zeros((len(X), len(self.task.targets)))
        mean_X, spread_X, mean_y, spread_y = self.scale
        found = self.answer((X - mean_X) / spread_X).reshape(len(X), -1)
        return mean_y + spread_y * found

    def scaled(self, X: Floats, y: Floats) -> tuple[Floats, Floats]:
        """The rows in the scale of these rows, which predict() uses from now on."""
        self.scale = [X.mean(axis=0), _spread(X), y.mean(axis=0), _spread(y)]
        return (X - self.scale[0]) / self.scale[1], (y - self.scale[2]) / self.scale[3]

    def answer(self, X: Floats) -> Floats:
        raise NotImplementedError


def _spread(values: Floats) -> Floats:
    found = values.std(axis=0)
    return np.where(found > 1e-12, found, 1.0)


class _Window(_Scaled):
    """The last rows; fitted anew when an answer is wanted and EVERY rows came since the last fit."""

    ROWS, EVERY = 200, 1

    def __init__(self, task: Task) -> None:
        super().__init__(task)
        self.seen = self.fitted = 0
        self.model: Any = None
        self.X = np.zeros((0, len(task.inputs)))
        self.y = np.zeros((0, len(task.targets)))

    def partial_fit(self, X: Floats, y: Floats) -> None:
        self.X = np.vstack([self.X, X])[-self.ROWS:]
        self.y = np.vstack([self.y, y])[-self.ROWS:]
        self.seen += len(X)

    def predict(self, X: Floats) -> Floats:
        if self.seen and (self.model is None or self.seen - self.fitted >= self.EVERY):
            self.refit(*self.scaled(self.X, self.y))
            self.fitted = self.seen
        return super().predict(X)

    def refit(self, X: Floats, y: Floats) -> None:
        raise NotImplementedError

    def answer(self, X: Floats) -> Floats:
        return self.model.predict(X)


class GaussianProcessWindow(_Window):
    """A Gaussian process (RBF kernel, noise) of the last 200 rows, fitted to every block.

    Hyperparameters by likelihood at the first rows, at 200, and after every 1,000 rows.
    """

    def __init__(self, task: Task) -> None:
        super().__init__(task)
        self.kernel: Any = ConstantKernel() * RBF(3.0) + WhiteKernel(0.1)
        self.due = 0

    def refit(self, X: Floats, y: Floats) -> None:
        optimizer = "fmin_l_bfgs_b" if self.seen >= self.due else None
        self.model = GaussianProcessRegressor(self.kernel, random_state=self.task.seed,
                                              optimizer=optimizer)
        self.model.fit(X, y)
        if optimizer:
            self.kernel = self.model.kernel_
            self.due = self.seen + 1000 if self.seen >= self.ROWS else self.ROWS


class ForestWindow(_Window):
    """Extremely randomised trees of the last 1,000 rows, grown anew every 100 rows."""

    ROWS, EVERY = 1000, 100

    def refit(self, X: Floats, y: Floats) -> None:
        self.model = ExtraTreesRegressor(30, min_samples_leaf=3, random_state=self.task.seed)
        self.model.fit(X, y)


class LinearSgd(_Scaled):
    """A linear model by stochastic gradient descent, one per target, in a running scale."""

    def __init__(self, task: Task) -> None:
        super().__init__(task)
        self.models = [SGDRegressor(learning_rate="constant", eta0=0.01, random_state=task.seed)
                       for _ in task.targets]
        self.scalers = [StandardScaler(), StandardScaler()]

    def partial_fit(self, X: Floats, y: Floats) -> None:
        scaled = [scaler.partial_fit(values).transform(values)
                  for scaler, values in zip(self.scalers, (X, y))]
        self.scale = [part for scaler in self.scalers for part in (scaler.mean_, scaler.scale_)]
        for model, target in zip(self.models, scaled[1].T):
            model.partial_fit(scaled[0], target)

    def answer(self, X: Floats) -> Floats:
        return np.column_stack([model.predict(X) for model in self.models])


class Sosvr(_Scaled):
    """SOSVR: ε-SVR on a dictionary of 300 independent rows, fitted anew when an answer is wanted.

    A row enters where its independence from the dictionary, 1 - k K^-1 k, exceeds a threshold. From
    a full dictionary the row with the least independence, faded by age, leaves, if less than the
    newcomer's. The scale is that of the first rows.
    """

    ROWS, FIRST, THRESHOLD, FADE_S, RIDGE, GAMMA = 300, 50, 0.001, 600.0, 1e-6, 0.15

    def __init__(self, task: Task) -> None:
        super().__init__(task)
        self.X, self.y = np.zeros((0, len(task.inputs))), np.zeros((0, len(task.targets)))
        self.t, self.inverse = np.zeros(0), np.zeros((0, 0))
        self.models: list[Any] = []
        self.waiting: list[tuple[Floats, Floats, Floats]] = []  # until the scale is known

    def partial_fit(self, X: Floats, y: Floats, t: Floats) -> None:
        if self.scale is None:
            self.waiting.append((X, y, t))
            X, y, t = (np.concatenate(part) for part in zip(*self.waiting))
            if len(X) < self.FIRST:
                return
            self.scaled(X, y)
        mean_X, spread_X, mean_y, spread_y = self.scale or []
        for row in zip((X - mean_X) / spread_X, (y - mean_y) / spread_y, t):
            self._show(*row)

    def _show(self, x: Floats, y: Floats, t: float) -> None:
        k = np.exp(-self.GAMMA * ((self.X - x) ** 2).sum(axis=1))
        own = 1.0 - k @ self.inverse @ k
        kept = np.ones(len(self.X), bool)
        if own <= self.THRESHOLD:
            return
        if len(self.X) == self.ROWS:
            faded = np.exp(-0.5 * ((t - self.t) / self.FADE_S) ** 2)
            worth = faded / np.diag(self.inverse)
            if own <= worth.min():
                return
            kept[worth.argmin()] = False
        self.X, self.y = np.vstack([self.X[kept], x]), np.vstack([self.y[kept], y])
        self.t, self.models = np.append(self.t[kept], t), []
        apart = ((self.X[:, None] - self.X) ** 2).sum(axis=2)
        self.inverse = np.linalg.inv(np.exp(-self.GAMMA * apart) + self.RIDGE * np.eye(len(apart)))

    def answer(self, X: Floats) -> Floats:
        if not self.models:
            self.models = [SVR(C=10.0, gamma=self.GAMMA, epsilon=0.1, max_iter=200_000)
                           .fit(self.X, target) for target in self.y.T]
        return np.column_stack([model.predict(X) for model in self.models])


class OfflineSvr(_Scaled):
    """ε-SVR with hindsight: C and γ by cross-validation in four contiguous folds, per target."""

    offline, MOST = True, 2000

    def partial_fit(self, X: Floats, y: Floats) -> None:
        X, y = self.scaled(X, y)
        chosen = np.unique(np.linspace(0, len(X) - 1, self.MOST).astype(int))
        X, y = X[chosen], y[chosen]
        few = np.unique(np.linspace(0, len(X) - 1, 600).astype(int))
        self.models = []
        for target in y.T:
            grid = [(c, g / X.shape[1]) for c in (0.5, 3, 20) for g in (0.2, 0.6, 2.0)]
            best = min(grid, key=partial(self._loss, X[few], target[few]))
            self.models.append(self._svr(*best).fit(X, target))

    def _loss(self, X: Floats, y: Floats, values: tuple[float, float]) -> float:
        loss = 0.0
        for fold in np.array_split(np.arange(len(X)), 4):
            rest = np.delete(np.arange(len(X)), fold)
            wrong = self._svr(*values).fit(X[rest], y[rest]).predict(X[fold]) - y[fold]
            loss += float(wrong @ wrong)
        return loss

    @staticmethod
    def _svr(c: float, gamma: float) -> Any:
        return SVR(C=c, gamma=gamma, epsilon=0.1, max_iter=200_000)

    def answer(self, X: Floats) -> Floats:
        return np.column_stack([model.predict(X) for model in self.models])


class OfflineTrees(_Scaled):
    """Extremely randomised trees of all rows, with hindsight; inputs and physics_terms()."""

    offline = True

    def partial_fit(self, X: Floats, y: Floats) -> None:
        X, y = self.scaled(X, y)
        self.model = ExtraTreesRegressor(60, min_samples_leaf=3, random_state=self.task.seed)
        self.model.fit(physics_terms(X, self.task.states), y)

    def answer(self, X: Floats) -> Floats:
        return self.model.predict(physics_terms(X, self.task.states))


def _meaning(owner: Any) -> str:
    return str(owner.__doc__).split("\n", maxsplit=1)[0]


def builtin_entries() -> list[Entry]:
    """The naive rows first, which every benchmark has; scikit-learn's where it is installed."""
    naive = [Entry(name, "naive", made, _meaning(made))
             for name, made in (("mean", Mean), ("last-value", LastValue),
                                ("velocity-held", VelocityHeld))]
    naive.append(Entry("least-squares", "naive", LeastSquares,
                       "Least squares of physics terms, all rows."))
    ours = [Entry("kelpie", "kelpie", Kelpie, "kelpie with its default settings."),
            Entry("kelpie-small", "kelpie", partial(Kelpie, preset="small"),
                  "kelpie with the preset small."),
            Entry("kelpie-paper", "kelpie", KelpiePaper, _meaning(KelpiePaper))]
    others = [Entry("fifo", "other", partial(KelpiePaper, forget="fifo"),
                    "The paper's learner, which forgets the oldest row of a full buffer.")]
    others += [Entry(f"rls-{forget}", "other", partial(LeastSquares, forget=forget),
                     f"Recursive least squares of physics terms, λ {forget}.")
               for forget in (0.99, 0.999, 0.9999)]
    if HAS_SKLEARN:
        others += [Entry(name, "other", made, _meaning(made), getattr(made, "offline", False))
                   for name, made in (("sosvr", Sosvr), ("sgd", LinearSgd),
                                      ("gp-window", GaussianProcessWindow),
                                      ("forest-window", ForestWindow), ("svr", OfflineSvr),
                                      ("trees", OfflineTrees))]
    return naive + ours + others


def load_entry(place: str) -> Entry:
    """The learner at module:Class, or at file.py:Class. ManifestError where there is none."""
    wanted = "give module:Class, or file.py:Class"
    module_name, colon, name = place.rpartition(":")
    if not colon or not module_name or not name:
        raise ManifestError(f"--entry {place}: has no ':'; {wanted}")
    try:
        module = _module(module_name)
    except Exception as error:  # whatever the user's module raises
        raise ManifestError(f"--entry {place}: {module_name} cannot be imported: "
                            f"{type(error).__name__}: {error}; {wanted}") from None
    made = getattr(module, name, None)
    if not callable(made):
        there = ", ".join(sorted(one for one, value in vars(module).items()
                                 if inspect.isclass(value) and value.__module__ == module.__name__))
        raise ManifestError(f"--entry {place}: {module_name} has no class {name}; "
                            f"its classes are {there or 'none'}")
    for method in ("partial_fit", "predict"):
        if inspect.isclass(made) and not callable(getattr(made, method, None)):
            raise ManifestError(f"--entry {place}: {name} has no method {method}; partial_fit(X, y) "
                                "and predict(X) are wanted")
    return Entry(name, "yours", _maker(made), str(made.__doc__ or "").strip().split("\n")[0],
                 bool(getattr(made, "offline", False)))


def _module(name: str) -> Any:
    if not name.endswith(".py"):
        return importlib.import_module(name)
    path = Path(name)
    spec = importlib.util.spec_from_file_location(path.stem, path)
    if spec is None or spec.loader is None or not path.is_file():
        raise FileNotFoundError(f"{name} is no file")
    module = importlib.util.module_from_spec(spec)
    sys.modules[path.stem] = module
    spec.loader.exec_module(module)
    return module


def _maker(made: Any) -> Callable[[Task], Any]:
    """A class that takes `task` gets the task; others are made without arguments."""
    try:
        takes = "task" in inspect.signature(made).parameters
    except (TypeError, ValueError):
        takes = False
    return made if takes else lambda task: made()
