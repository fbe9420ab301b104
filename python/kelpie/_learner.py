# SPDX-License-Identifier: Apache-2.0
"""The common base of both estimators."""

from __future__ import annotations

import json
import os
import warnings
from collections.abc import Mapping
from statistics import NormalDist
from typing import Any, Optional, TypeVar, Union, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _arrays, _frames, _kelpie, _settings
from ._arrays import Floats
from ._clock import Clock, require_rate
from ._contract import NotFittedError
from ._log import existing
from ._parameters import Parameters, Word

Self = TypeVar("Self", bound="Learner")

_STATE_FORMAT = 4  # of pickles


class PlausibilityWarning(UserWarning):
    """Rows of a log that cannot be right: units, signs, rates, clocks."""


class Learner(Parameters):
    """Base of OnlineSVR and DynamicsModel."""

    _model: Union[_kelpie.LiveModel, _kelpie.TrainedModel]  # there once fitted
    _notes: Optional[tuple[dict[str, str], str]] = None  # units and doubt of the model.json before
    # What the model.json did to rows before the model saw them, until the warning.
    _untold: Mapping[str, str] = {}
    _clock: Clock
    _flat: bool  # whether y is of shape (n,)
    _by_name = False  # whether columns of data frames are chosen by the names of the inputs

    def fit(self: Self, X: ArrayLike, y: Optional[ArrayLike] = None,
            t: Union[ArrayLike, str, None] = None, **unknown: Any) -> Self:
        """Starts a new model and learns the rows in their order.

        Parameters
        ----------
        X : (n, inputs), in the units of the log. float64 in C order isn't copied. With `inputs`,
            columns of a data frame are selected by name.
        y : (n,) or, for DynamicsModel, (n, targets), in the units of the log. May be omitted where
            X is a data frame of a whole log: missing inputs, targets and time are guessed as in
            `kelpie learn`, with a warning of columns left out for their values (constants, counters
            of rows, copies of another), and rows with a missing number are skipped.
        t : (n,), time [s] or time stamps, never decreasing; or the name of a column of X. Default:
            the index of a data frame where it tells the time, else `rate` rows per second, from 0
            on. Where neither is known, a whole log is refused, a data frame X is learned with a
            warning, and an array without one, at 1 row per second.

        Where the names of inputs and targets tell which target is the derivative of which input
        (udot of u), PlausibilityWarning names units, signs, rates and clocks that cannot be right.

        Rows have no weights: `sample_weight` is rejected (score() accepts weights).

        Without `warmup`, the warm-up is at most n, so that few rows give a model too. Raises
        ValueError on a NaN, an infinity, other shapes or a wrong setting. Ctrl-C stops between two
        rows; earlier rows stay learned. On the log of AUV Dagon a row takes 0.2 ms per
        target in the mean (docs/howto/python.md).
        """
        given = self._given(X, y, t, unknown, (self.inputs, self.targets), by_values=True)
        rows, targets = self._checked(given.X, given.y)
        model = self._start(given, rows, targets, most_warmup=max(2, rows.shape[0]))
        self._warn_of_mistakes(model, given, rows, targets)
        self._learn(model, rows, targets, given)
        model.learn_held_back()
        return self

    def partial_fit(self: Self, X: ArrayLike, y: Optional[ArrayLike] = None,
                    t: Union[ArrayLike, str, None] = None, **unknown: Any) -> Self:
        """Continues learning with further rows; the first call starts a model.

        Parameters and errors as in fit(), but of a whole log names alone tell the inputs. The size
        of blocks changes nothing, to the last bit.
        `decisions_` has the outcome of each row. After load(), learning continues from the loaded
        model: first predictions are equal; intervals, disturbance, past models and totals start
        anew (a pickle keeps them).
        """
        if not self.__sklearn_is_fitted__():
            given = self._given(X, y, t, unknown, (self.inputs, self.targets))
            rows, targets = self._checked(given.X, given.y)
            model = self._start(given, rows, targets, most_warmup=None)
            return self._learn(model, rows, targets, given)
        names = (self._model.inputs, self._model.targets) if self._by_name else (None, None)
        self._require_inputs(X)
        given = self._given(X, y, t, unknown, names)
        seen = self._as_seen(given.X) if given.by_name else given.X
        rows, targets = self._checked(seen, given.y)
        _arrays.require_same_columns(self, seen, rows)
        self._tell_alignment(stacklevel=3)
        if isinstance(self._model, _kelpie.TrainedModel):
            start = self._clock.times(given.t, len(rows), 0, self.rate)[0]
            if isinstance(self._model, _kelpie.SavedModel):
                self._notes = (self._model.units, self._model.doubt)
            self._model = _kelpie.LiveModel.resume_from(self._model, start)
        return self._learn(self._model, rows, targets, given)

    @overload
    def predict(self, X: ArrayLike) -> Floats: ...

    @overload
    def predict(self, X: ArrayLike, return_std: bool = False,
                return_interval: bool = False) -> Any: ...

    def predict(self, X: ArrayLike, return_std: bool = False,
                return_interval: bool = False) -> Any:
        """Predictions of the rows X (n, inputs), of the shape and in the units of y.

        Before a model is in service, the mean of the targets so far. X is taken as given: a
        model.json with an alignment or a current warns once (Alignment.of(), `kelpie predict`).

        With `return_interval`, a tuple with the ends of the interval, which holds the next sample
        with the share `coverage` (assess() tells more). With `return_std`, a tuple with the
        standard deviation of a normal error with the same interval; real errors have longer tails,
        so prefer the interval. Both are infinite until enough errors are known.
        """
        if not (return_std or return_interval):
            return self._shaped(self._fitted().predict(self._inputs(X)))
        if return_std and return_interval:
            raise ValueError("return_std, return_interval: give one of them")
        told = self._assessed(X, 0.0)
        value, lower, upper = (np.ascontiguousarray(told[name])
                               for name in ("value", "lower", "upper"))
        if return_interval:
            return value, lower, upper
        coverage = float(self._fitted().settings["coverage"])
        return value, (upper - lower) / (2.0 * NormalDist().inv_cdf(0.5 + 0.5 * coverage))

    def assess(self, X: ArrayLike, ahead_s: ArrayLike = 0.0) -> Any:
        """predict() with interval, novelty and disturbance.

        Parameters
        ----------
        X : (n, inputs).
        ahead_s : time from the last learned row to the rows of X [s], one number or (n,).
            Default: each row is the next row.

        Returns a structured array of y's shape, or a data frame for a data frame X (with several
        targets, of columns ("value", "udot"), so that assess(X)["value"] has a column per target):
        `value`; `lower` and `upper`, which hold the next
        sample with the share `coverage` (infinite until enough errors are known); `novelty`, the
        share of the buffer's samples in a denser place, 0 to 1; `disturbance`, to be added to
        `value`, estimated from recent errors and fading with `ahead_s`; `corrected_lower` and
        `corrected_upper`, the interval around the sum (infinite for rows after the next).
        A model from model.json has the intervals and novelty of the saved model, a disturbance of
        0, and an infinite interval around the sum.
        """
        return _frames.like(self._assessed(X, ahead_s), _frames.index_of(X), self.targets_)

    def _assessed(self, X: ArrayLike, ahead_s: ArrayLike) -> NDArray[np.void]:
        model = self._fitted()
        rows = self._inputs(X)
        ahead = _arrays.seconds_ahead(ahead_s, len(rows))
        if isinstance(model, _kelpie.TrainedModel):
            return self._shaped(model.assess(rows))
        return self._shaped(model.assess(rows, ahead))

    def predict_with_jacobian(self, X: ArrayLike) -> tuple[Floats, Floats]:
        """predict(), and its exact derivatives by the inputs, in the units of the log.

        The second array has shape (n, inputs); for several targets (n, targets, inputs).
        """
        y, jacobian = self._fitted().predict_with_jacobian(self._inputs(X))
        return self._shaped(y), jacobian[:, 0, :] if self._flat else jacobian

    def score(self, X: ArrayLike, y: ArrayLike,
              sample_weight: Optional[ArrayLike] = None) -> float:
        """R² of predict(X), averaged over targets. 1 is perfect, 0 no better than y's mean."""
        found = self.predict(X)
        truth = _arrays.targets(y, len(found), type(self).__name__)
        if truth.size != found.size:
            raise ValueError(f"y is of shape {truth.shape}, predictions are of {found.shape}")
        truth = truth.reshape(found.shape)
        weights = np.ones(len(found)) if sample_weight is None else np.asarray(sample_weight)
        weights = weights.reshape(-1, *[1] * (found.ndim - 1))
        wrong = (weights * (found - truth) ** 2).sum(axis=0)
        spread = (weights * (truth - np.average(truth, axis=0, weights=weights.ravel())) ** 2)
        total = spread.sum(axis=0)
        perfect = np.where(wrong == 0.0, 1.0, 0.0)
        r2 = np.where(total > 0.0, 1.0 - wrong / np.where(total > 0.0, total, 1.0), perfect)
        return float(np.mean(r2))

    def save(self, file: Union[str, os.PathLike[str]]) -> None:
        """Writes the model as model.json, for load(), `kelpie predict`, `kelpie export`.

        The file is written whole or not at all. After load(), partial_fit() can continue from the
        file; a pickle holds the whole state. Raises ValueError before a model is in service,
        RuntimeError on a failure to write.
        """
        self._trained().write(os.fspath(file))

    @classmethod
    def load(cls: type[Self], file: Union[str, os.PathLike[str]]) -> Self:
        """Reads a model.json; predictions equal those of the saved model.

        Alignment.of() gives the rows of a log the alignment that `kelpie learn` found.

        Raises ValueError naming file and key if the file is not a valid model.json,
        FileNotFoundError if there is none.
        """
        model = _kelpie.TrainedModel.read(existing(file))
        if cls._takes_one_target() and len(model.targets) != 1:
            raise ValueError(f"{file}: is a model of {len(model.targets)} targets; "
                             f"{cls.__name__} has one, DynamicsModel several")
        loaded = cls(inputs=model.inputs, targets=model.targets,
                     **_settings.parameters(model.settings, len(model.targets)))
        loaded._adopt(model, flat=loaded._takes_one_target())
        loaded._by_name = True
        loaded._untold = _effects(loaded._alignment())
        return loaded

    @property
    def decisions_(self) -> Any:
        """The outcome of every row of the last fit() or partial_fit(), for each target.

        A structured array of y's shape; after a data frame X a data frame of its index (with
        several targets, of columns ("predicted", "udot")).
        """
        self._fitted()
        if "_decisions" not in vars(self):
            raise AttributeError("a model read from model.json has no decisions")
        return _frames.like(self._decisions, self._index, self.targets_)

    @property
    def terms_(self) -> list[str]:
        """The physics terms, as formulas over the inputs."""
        return self._fitted().terms

    @property
    def coef_(self) -> Floats:
        """The terms' coefficients: y's unit per unit of the term; NaN before there is a model.

        Shape (terms,); for several targets (targets, terms).
        """
        found = self._fitted().coefficients()
        return found[0] if self._flat else found

    @property
    def status_(self) -> list[dict[str, Any]]:
        """For each target: buffer, support vectors, KKT gap, and totals since the start."""
        model = self._fitted()
        if not isinstance(model, _kelpie.LiveModel):
            raise AttributeError("a model read from model.json has no status")
        return model.status()

    @property
    def diagnosis_(self) -> Optional[dict[str, Any]]:
        """Changes of the vehicle: `findings`, each with `text`, and `health` of the thrusters.

        None without known velocities (docs/howto/diagnosis.md).
        """
        model = self._fitted()
        if not isinstance(model, _kelpie.LiveModel):
            raise AttributeError("a model read from model.json has no diagnosis")
        return model.diagnosis()

    @property
    def inputs_(self) -> list[str]:
        """Names of the inputs."""
        return self._fitted().inputs

    @property
    def targets_(self) -> list[str]:
        """Names of the targets."""
        return self._fitted().targets

    @property
    def alignment_s_(self) -> float:
        """The lag of commands in the alignment of a loaded model [s]; 0 without a lag.

        Alignment.of() aligns rows of a log by lag and actuators before predict().
        """
        return self._fitted().alignment_s

    @property
    def actuators_(self) -> list[dict[str, Any]]:
        """The actuators in the alignment of a loaded model, as in Alignment; [] without."""
        return self._fitted().actuators

    @property
    def n_samples_seen_(self) -> int:
        """Rows since the start, learned or rejected."""
        model = self._fitted()
        if not isinstance(model, _kelpie.LiveModel):
            raise AttributeError("a model read from model.json doesn't know its samples")
        return model.samples

    def __sklearn_is_fitted__(self) -> bool:
        return "_model" in vars(self)

    def __getstate__(self) -> dict[str, Any]:
        return {**vars(self), "_state_format": _STATE_FORMAT}

    def __setstate__(self, state: dict[str, Any]) -> None:
        state = dict(state)
        found = state.pop("_state_format", None)
        if found != _STATE_FORMAT:
            raise ValueError(f"this pickle of kelpie is of format {found}; this version reads "
                             f"format {_STATE_FORMAT}")
        for name, value in type(self)().get_params().items():
            state.setdefault(name, value)  # of before there was such a parameter
        self.__dict__.update(state)

    @classmethod
    def _takes_one_target(cls) -> bool:
        raise NotImplementedError

    def _fitted(self) -> Union[_kelpie.LiveModel, _kelpie.TrainedModel]:
        if not self.__sklearn_is_fitted__():
            raise NotFittedError(f"This {type(self).__name__} instance is not fitted yet. Call "
                                 "'fit' with appropriate arguments before using this estimator.")
        return self._model

    def _trained(self) -> _kelpie.TrainedModel:
        model = self._fitted()
        if isinstance(model, _kelpie.TrainedModel):
            return model
        trained = model.trained()
        return trained.noted(*self._notes) if self._notes else trained

    def _alignment(self) -> dict[str, Any]:
        """The alignment under the keys of model.json; empty without."""
        found: dict[str, Any] = json.loads(self._trained().json()).get("alignment") or {}
        return found

    def _tell_alignment(self, stacklevel: int) -> None:
        texts, self._untold = list(self._untold.values()), {}
        for text in texts:
            warnings.warn(text, UserWarning, stacklevel=stacklevel)

    def _adopt(self, model: Union[_kelpie.LiveModel, _kelpie.TrainedModel], flat: bool) -> None:
        self._model = model
        self._notes = None
        self._untold = {}
        self._flat = flat
        self._clock = Clock()
        self.n_features_in_ = len(model.inputs)

    def _given(self, X: Any, y: Any, t: Any, unknown: dict[str, Any],
               names: tuple[Any, Any], by_values: bool = False) -> _frames.Given:
        weights = unknown.pop("sample_weight", None)
        if unknown:
            raise TypeError(f"fit() and partial_fit() take X, y and t, no {', '.join(unknown)}")
        if weights is not None:
            raise ValueError("sample_weight: rows of a stream have no weights; their age and place "
                             "decide what counts. Leave rows out instead (score() takes weights)")
        given = _frames.taken(X, y, t, *names, by_values)
        if given.t is None and self.rate is None and _frames.is_frame(X):
            if y is None:
                require_rate(None, "this log")
            warnings.warn("rate: isn't known, and X tells no time: rows count as 1 s each. Give "
                          "rate= (rows per second) or t=", UserWarning, stacklevel=3)
        return given

    def _as_seen(self, X: Any) -> Any:
        # Rows without names have none to compare.
        return X if "feature_names_in_" in vars(self) or not _frames.is_frame(X) else X.to_numpy()

    def _checked(self, X: ArrayLike, y: ArrayLike) -> tuple[Floats, Floats]:
        rows = _arrays.matrix(X)
        targets = _arrays.targets(y, len(rows), type(self).__name__)
        if self._takes_one_target():
            targets = _arrays.one_target(targets, type(self).__name__)
        return rows, targets

    def _start(self, given: _frames.Given, rows: Floats, targets: Floats,
               most_warmup: Optional[int]) -> _kelpie.LiveModel:
        columns = _arrays.column_names(given.X)
        inputs = self.inputs if self.inputs is not None else columns
        width = 1 if targets.ndim == 1 else targets.shape[1]
        names = self.targets if self.targets is not None else _arrays.column_names(given.y)
        texts = _settings.texts(self.get_params())
        if columns is not None and "states" not in texts:
            texts.update(_frames.states(inputs, names))
        if most_warmup is not None and self.warmup is None:
            usual = int(_kelpie.preset_values(self.preset, width)["warmup"])
            texts["warmup"] = str(min(usual, most_warmup))
        model = _kelpie.LiveModel(_names(inputs, "inputs", "x", rows.shape[1]),
                                  _names(names, "targets", "y", width), texts)
        self._begin_with_nominal(model)
        self._adopt(model, flat=targets.ndim == 1)
        self._by_name = given.by_name
        self.__dict__.pop("feature_names_in_", None)
        if columns is not None:
            self.feature_names_in_ = np.array(columns, dtype=object)
        return model

    def _begin_with_nominal(self, model: _kelpie.LiveModel) -> None:
        if isinstance(self.nominal, Mapping):
            for target, coefficients in self.nominal.items():
                model.set_nominal(target, dict(coefficients))
        elif self.nominal is not None:
            files = ([self.nominal] if isinstance(self.nominal, (str, os.PathLike))
                     else self.nominal)
            model.set_nominal_models([_kelpie.TrainedModel.read(existing(file)) for file in files])

    def _warn_of_mistakes(self, model: _kelpie.LiveModel, given: _frames.Given, rows: Floats,
                          targets: Floats) -> None:
        times = self._clock.times(given.t, len(rows), 0, self.rate)
        for what in _kelpie.log_mistakes(model.inputs, model.targets, rows, targets, times,
                                         given.t is not None, model.settings["states"]):
            warnings.warn(f"{what}. Convert the columns, or set `rate`, before fit()",
                          PlausibilityWarning, stacklevel=3)

    def _learn(self: Self, model: _kelpie.LiveModel, rows: Floats, targets: Floats,
               given: _frames.Given) -> Self:
        before = model.samples
        times = self._clock.times(given.t, len(rows), before, self.rate)
        try:
            decisions = model.update(rows, targets, times)
        finally:
            self._clock.learned(times[:model.samples - before], given.t, model.samples)
        self._decisions = self._shaped(decisions)
        self._index = _frames.index_of(given.X)
        return self

    def _require_inputs(self, X: Any) -> None:
        # After a fit with names, require_same_columns() tells other names.
        if self._by_name and "feature_names_in_" not in vars(self):
            _frames.require_inputs(X, self._fitted().inputs)

    def _inputs(self, X: ArrayLike) -> Floats:
        self._require_inputs(X)
        chosen = _frames.inputs_of(X, self._fitted().inputs) if self._by_name else None
        X = X if chosen is None else self._as_seen(chosen)
        rows = _arrays.matrix(X)
        _arrays.require_same_columns(self, X, rows)
        self._tell_alignment(stacklevel=4)
        return rows

    def _shaped(self, values: NDArray[Any]) -> NDArray[Any]:
        return values[:, 0] if self._flat else values


def _names(given: Word, what: str, letter: str, count: int) -> list[str]:
    if given is None:
        return [f"{letter}{i}" for i in range(count)]
    names = [given] if isinstance(given, str) else [str(name) for name in given]
    if len(names) != count:
        raise ValueError(f"{what}: {len(names)} names for {count} columns")
    return names


def _effects(alignment: Mapping[str, Any]) -> dict[str, str]:
    """What an alignment did to the rows that the model saw, as warnings."""
    found = {}
    ways = [f"{alignment['shift_s']:g} s later"] if alignment.get("rows") else []
    ways += ["through their actuators"] if alignment.get("actuators") else []
    if ways:
        found["commands"] = (
            f"X: the model learned commands ({', '.join(alignment['commands'])}) "
            f"{' and '.join(ways)}, and X is taken as given. "
            "kelpie.Alignment.of(model).transform(log) gives aligned rows")
    if alignment.get("current"):
        water = alignment["current"]
        found["current"] = (
            f"X: the model learned {water['surge']} and {water['sway']} through the water, in a "
            "current, and X is taken as given. `kelpie predict` and `kelpie rollout` know the "
            "current")
    return found
