# SPDX-License-Identifier: Apache-2.0
"""Alignment of commands and accelerations."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _arrays, _frames, _kelpie
from ._arrays import Floats
from ._clock import TIMES, Clock, checked_rate, index_times, require_rate
from ._contract import BaseEstimator, NotFittedError, TransformerMixin
from ._learner import Learner
from ._parameters import ParameterAccess

_AT_ONCE = {"neutral": 0.0, "dead_band": 0.0, "astern": 1.0, "lag_s": 0.0, "rate": 0.0,
            "delay_s": 0.0}
_SECONDS = {"ms": 1e-3, "us": 1e-6, "µs": 1e-6, "ns": 1e-9, "min": 60.0, "h": 3600.0}
MOST_S = 10.0  # no shift is larger, as in the library


class Alignment(TransformerMixin, ParameterAccess, BaseEstimator):
    """Gives every row of a log the commands of its accelerations.

    In a log, commands and accelerations are shifted against each other (filters, logging), and
    rotors, shafts and rudders take time. fit() finds one shift of all commands and an actuator per
    command on the given rows; transform() takes the commands of every row from a later or earlier
    row and sends them through their actuators. Use an Alignment beside an estimator, not in a Pipeline that
    predicts single rows: transform() needs the rows of a log in their order.

    Parameters
    ----------
    shift : "auto", or the lag [s]: with 0.5, a row's accelerations belong to the commands of
        the row 0.5 s later; below 0, to earlier ones. At most 10 s. "auto" finds actuators, too.
    actuators : with a given shift: a dict for each command that doesn't act at once, with
        "command" (its name) and some of "neutral" (0), "dead_band" (0), "astern" (1), "lag_s" (0),
        "rate" (0: unlimited) and "delay_s" (0), in the unit of the command and seconds, as in
        model.json.
    rate : rows per second [Hz]. Default: as the times of fit() have them.
    states : names of the columns of X that are velocities, one for each column of y; all others
        are commands. Default: the first columns if they are velocities by their names, else those
        whose slope goes with a column of y.

    Attributes
    ----------
    shift_s_ : the lag [s]; 0 without clear evidence.
    rows_ : the lag in rows.
    rate_ : rows per second [Hz]; of() knows it where it was given or the model has a shift.
    commands_ : names of the aligned columns.
    actuators_ : a dict for each of these, with all keys of `actuators`; [] where all act at once.
    gain_ : share of the variance unexplained without alignment that the alignment explains.
    why_ : the reason, in words.
    n_features_in_, feature_names_in_ : as in scikit-learn.
    """

    _of_model = False  # whether the numbers are those of a model, not of fit()

    def __init__(self, *, shift: Union[str, float] = "auto",
                 actuators: Sequence[dict[str, Any]] = (), rate: Optional[float] = None,
                 states: Optional[Sequence[str]] = None) -> None:
        self.shift = shift
        self.actuators = actuators
        self.rate = rate
        self.states = states

    def fit(self, X: ArrayLike, y: ArrayLike, t: Optional[ArrayLike] = None) -> Alignment:
        """Finds the shift and the actuators on these rows.

        Parameters
        ----------
        X : (n, inputs), in the units of the log.
        y : (n,) or (n, targets), accelerations in the units of the log.
        t : (n,), time [s] or time stamps, never decreasing. Default: the index of a data frame
            where it tells the time, else `rate` rows per second. Rows more than three steps of
            1 / `rate` apart belong to different stretches.

        Raises ValueError without rate and times, on a NaN, an infinity, other shapes or a wrong parameter; where `shift` is
        a number, also if no column is known to be a velocity.
        """
        rows = _arrays.matrix(X)
        targets = _arrays.targets(y, len(rows), type(self).__name__)
        t = index_times(X) if t is None else t
        self.rate_ = require_rate(self.rate, "X") if t is None or self.rate is not None else (
            _measured_rate(Clock().times(t, len(rows), 0, None)))
        times = self._times(X, t, len(rows))
        self._of_model = False
        columns = _arrays.column_names(X)
        names = columns or [f"x{i}" for i in range(rows.shape[1])]
        states = "auto" if self.states is None else ",".join(self.states)
        problem = (rows, targets, times, self.rate_, names, states)
        found, self.commands_, self.actuators_, self.gain_, self.why_ = self._found(problem)
        self.rows_ = int(np.rint(found * self.rate_))
        self.shift_s_ = self.rows_ / self.rate_
        self._places = [names.index(name) for name in self.commands_]
        self._aligned(rows[:0], times[:0])  # has the checks of given actuators
        self.n_features_in_ = rows.shape[1]
        self.__dict__.pop("feature_names_in_", None)
        if columns is not None:
            self.feature_names_in_ = np.array(columns, dtype=object)
        return self

    @classmethod
    def of(cls, model: Learner, rate: Optional[float] = None) -> Alignment:
        """The shift and the actuators of a loaded model; needs no fit().

        Of a data frame transform() takes the model's inputs by name, and the times of a column t,
        time or stamp (in the unit that read_log() found), unless they are given.
        `rate` [Hz] may be left out where there are times.
        A current stays in the velocities.

        Raises NotFittedError, or ValueError on a wrong rate.
        """
        found = model._alignment()
        alignment = cls(shift=found.get("shift_s", 0.0), actuators=found.get("actuators", []),
                        rate=rate)
        alignment._of_model = True
        alignment.shift_s_, alignment.rows_ = found.get("shift_s", 0.0), found.get("rows", 0)
        alignment.commands_ = found.get("commands", [])
        alignment.actuators_ = found.get("actuators", [])
        alignment.gain_, alignment.why_ = 0.0, "as the model has it"
        if rate is None and alignment.rows_:
            rate = alignment.rows_ / alignment.shift_s_
        if rate is not None:
            alignment.rate_ = checked_rate(rate)
        names = model.inputs_
        alignment._places = [names.index(name) for name in alignment.commands_]
        alignment.n_features_in_ = len(names)
        alignment.feature_names_in_ = np.array(names, dtype=object)
        model._untold = {what: text for what, text in model._untold.items() if what != "commands"}
        return alignment

    def transform(self, X: ArrayLike, t: Optional[ArrayLike] = None) -> Floats:
        """The rows X (n, inputs) of one log in their order, with aligned commands.

        At the ends of a stretch, rows whose commands are missing get the nearest of the stretch.
        """
        if "rows_" not in vars(self):
            raise NotFittedError(f"This {type(self).__name__} instance is not fitted yet. Call "
                                 "'fit' with appropriate arguments before using this estimator.")
        if self._of_model:
            return self._as_the_model(X, t)
        rows = _arrays.matrix(X)
        _arrays.require_same_columns(self, X, rows)
        return self._aligned(rows, self._times(X, t, len(rows)))

    def _as_the_model(self, X: Any, t: Any) -> Floats:
        names = list(self.feature_names_in_)
        if _frames.is_frame(X):
            _frames.require_inputs(X, names)
            usual = [name for name in TIMES if name in X.columns and name not in names]
            if t is None and index_times(X) is None and usual:
                unit = getattr(X, "attrs", {}).get("units", {}).get(usual[0])
                t = X[usual[0]] * _SECONDS[unit] if unit in _SECONDS else X[usual[0]]
            X = X[names] if set(names) <= set(X.columns) else X
        rows = _arrays.matrix(X)
        _arrays.require_width(self, rows)
        t = index_times(X) if t is None else t
        rate: Optional[float] = getattr(self, "rate_", None)
        if t is None:
            rate = require_rate(rate, "X")
        times = Clock().times(t, len(rows), 0, rate)
        if self.rate is None and t is not None and len(rows) > 1:
            rate = _measured_rate(times)  # of this log, not of the model's
        rate = 1.0 if rate is None else rate  # of a single row
        return _kelpie.align(rows, times, rate, int(np.rint(self.shift_s_ * rate)), self._places,
                             self.actuators_)

    def fit_transform(self, X: ArrayLike, y: ArrayLike, t: Optional[ArrayLike] = None) -> Floats:
        """fit(), then transform() of the same rows."""
        return self.fit(X, y, t).transform(X, t)

    def get_feature_names_out(self, input_features: Optional[Sequence[str]] = None) -> NDArray[Any]:
        """Names of the columns, which are those of X; for set_output() and pipelines.

        Raises ValueError where `input_features` aren't the columns of fit().
        """
        if "rows_" not in vars(self):
            raise NotFittedError(f"This {type(self).__name__} instance is not fitted yet.")
        known = getattr(self, "feature_names_in_", None)
        if known is None:
            known = [f"x{i}" for i in range(self.n_features_in_)]
            if input_features is not None and len(input_features) == len(known):
                known = list(input_features)
        if input_features is not None and list(input_features) != list(known):
            raise ValueError("input_features is not equal to feature_names_in_")
        return np.asarray(known, dtype=object)

    def _more_tags(self) -> dict[str, Any]:
        return {"requires_y": True, "multioutput": True}

    def _aligned(self, rows: Floats, times: Floats) -> Floats:
        return _kelpie.align(rows, times, self.rate_, self.rows_, self._places,
                             self.actuators_)

    def _found(self, problem: tuple[Any, ...]
               ) -> tuple[float, list[str], list[dict[str, Any]], float, str]:
        if isinstance(self.shift, str):
            if self.shift != "auto":
                raise ValueError(f"shift: {self.shift!r} is not known; 'auto' or seconds are")
            if self.actuators:
                raise ValueError("actuators: go with a given shift, as in shift=0.0; 'auto' finds "
                                 "them")
            return _kelpie.find_alignment(*problem)
        if not abs(self.shift) <= MOST_S:
            raise ValueError(f"shift: {self.shift} s is out of range; {MOST_S:g} s is the most")
        commands = _kelpie.find_commands(*problem)
        if not commands:
            raise ValueError("states: no columns are known to be velocities and others commands; "
                             "name the velocities")
        return float(self.shift), commands, self._given(commands), 0.0, "as given"

    def _given(self, commands: list[str]) -> list[dict[str, Any]]:
        given = {actuator.get("command"): actuator for actuator in self.actuators}
        for name in given:
            if name not in commands:
                raise ValueError(f"actuators: {name!r} is no command; the commands are "
                                 f"{', '.join(commands)}")
        if len(given) != len(self.actuators):
            raise ValueError("actuators: a command has two")
        return [{**_AT_ONCE, **given.get(name, {}), "command": name}
                for name in commands] if given else []

    def _times(self, X: Any, t: Optional[ArrayLike], rows: int) -> Floats:
        return Clock().times(index_times(X) if t is None else t, rows, 0, self.rate_)


def _measured_rate(times: Floats) -> float:
    steps = np.diff(times)
    if not (steps > 0.0).any():
        raise ValueError("t: the times don't advance")
    return float(1.0 / np.median(steps[steps > 0.0]))
