# SPDX-License-Identifier: Apache-2.0
"""The estimators."""

from __future__ import annotations

import enum
from collections.abc import Sequence
from typing import Any, NamedTuple, Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _arrays, _settings
from ._arrays import Floats
from ._clock import Clock, index_times, require_rate
from ._learner import Learner


class Verdict(enum.IntEnum):
    """The outcome of a sample: `decisions_["verdict"] == Verdict.ACCEPTED`."""

    ACCEPTED = 0  #: added to the buffer and learned
    EXPLAINED = 1  #: near a support vector and within the tube, eq. (9)
    DUPLICATE = 2  #: near a support vector with the same target, eq. (10)
    INVALID = 3  #: a NaN or an infinity
    HELD_BACK = 4  #: held back until the scale of the data is known, then learned
    IMPLAUSIBLE = 5  #: rejected: too far from all earlier samples
    CROWDED_OUT = 6  #: rejected: the budget was spent on earlier samples


class RolloutResult(NamedTuple):
    """Velocities of a model in open loop."""

    velocity: Floats  #: (n, targets), in the units of the log
    spread: Floats  #: (n, targets), standard deviation of the velocity
    beyond: NDArray[np.bool_]  #: (n,), whether an input is outside the range of the learned data


_ATTRIBUTES = """
Parameters
----------
inputs : names of the columns of X. Default: names of a data frame, else x0, x1, ...
    Velocities are recognised by usual names: u, v, r; surge, yaw_rate; Vx; twist.linear.x; by the
    names of a data frame's targets (udot, u_dot, du of u); or given by `velocities`.
targets : names of the columns of y. Default: names of a data frame, else y0, y1, ...
rate : rows per second [Hz] where no times are given; forgetting depends on age. Default: none, so
    that a log without times is refused (fit() says more).
nominal : what is known of the vehicle beforehand, for fit() and the first partial_fit(): a
    model.json of an earlier drive or of a like vehicle, or several, of which the mean is taken; or
    coefficients by target and term, as {{"udot": {{"u": -0.4, "u*|u|": -1.2, "1": 0.0}}}}. A term that
    is not named has 0 (docs/method/posterior.md).

Further parameters are the settings of `kelpie config`. None takes the value of the preset. With
several targets, a setting may be a list with a value for each target.

{settings}

Attributes
----------
decisions_ : structured array of y's shape, or a data frame after a data frame: the outcome of
    every row of the last fit() or partial_fit(). `predicted`, `lower`, `upper` are from before the
    row was learned: one step ahead. `disturbance` is the estimate from the model's last errors,
    `corrected_lower` and `corrected_upper` the interval around the sum. Further `verdict`
    (Verdict), `had_model`, `similarity`, `outliers`,
    `forgotten`, `released`, `iterations`, `kkt_gap`, `served`, `unserved`, `unfinished`,
    `fallbacks`, `changed` (a change of the vehicle was found), `changed_since` [s], `recalled`
    (number of the past vehicle that has returned, or 0), `withdrawn` (the last change was an
    error: the model goes back).
coef_, terms_ : the physics terms and their coefficients.
status_ : buffer, support vectors and totals of every target.
n_features_in_, feature_names_in_ : as in scikit-learn.

A pickle keeps the whole state: an unpickled estimator continues to learn, to the last bit, as if
never stopped. save() and load() keep predictions, and partial_fit() goes on from them.
"""


class OnlineSVR(Learner):
    __doc__ = ("Learns one target from a stream of rows: on-line ε-SVR in a fixed buffer.\n"
               + _ATTRIBUTES.format(settings=_settings.describe()))

    @classmethod
    def _takes_one_target(cls) -> bool:
        return True


class DynamicsModel(Learner):
    __doc__ = ("Learns several targets, such as a vehicle's accelerations, with one learner each.\n"
               + _ATTRIBUTES.format(settings=_settings.describe()))

    def rollout(self, X: ArrayLike, t: Optional[ArrayLike] = None, *,
                between: str = "linear", measured: Sequence[int] = (), step_s: float = 0.25) -> RolloutResult:
        """Integrates the learned accelerations in open loop along one stretch of a log.

        Parameters
        ----------
        X : (n, inputs). Velocities and commands of the first row, commands of later rows.
        t : (n,), time [s] or time stamps, increasing. Default: the index of a data frame where it
            tells the time, else `rate` rows per second.
        between : "linear" or "held", how commands change between rows.
        measured : numbers of velocities that are measured and taken from X, from 0.
        step_s : longest step of the integrator [s].

        Raises ValueError on a model without known velocities (`states`), or with too few
        learned steps.
        """
        if between not in ("linear", "held"):
            raise ValueError(f"between: {between!r} is not known; 'linear' and 'held' are")
        rows = self._inputs(X)
        t = index_times(X) if t is None else t
        times = (np.arange(len(rows)) / require_rate(self.rate, "X") if t is None
                 else np.atleast_1d(_arrays.floats(Clock().seconds(t), "t")))
        return RolloutResult(*self._trained().rollout(rows, times, between == "held",
                                                      list(measured), step_s))

    @classmethod
    def _takes_one_target(cls) -> bool:
        return False

    def _more_tags(self) -> dict[str, Any]:
        return {"multioutput": True}
