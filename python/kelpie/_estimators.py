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
from ._learner import Learner


class Verdict(enum.IntEnum):
    """What was said of a sample: `decisions_["verdict"] == Verdict.ACCEPTED`."""

    ACCEPTED = 0  #: taken into the buffer and learned
    EXPLAINED = 1  #: near a support vector and within the tube, eq. (9)
    DUPLICATE = 2  #: near a support vector with the same target, eq. (10)
    INVALID = 3  #: a NaN or an infinity
    HELD_BACK = 4  #: kept aside until the scale of the data is known; learned then
    CROWDED_OUT = 5  #: the budget went on earlier samples


class RolloutResult(NamedTuple):
    """A model in open loop."""

    velocity: Floats  #: (n, targets), in the units of the log
    spread: Floats  #: (n, targets), standard deviation of the velocity
    beyond: NDArray[np.bool_]  #: (n,), whether some input is outside the range seen in learning


_ATTRIBUTES = """
Parameters
----------
inputs : names of the columns of X. Default: those of a data frame, else x0, x1, ...
    With u, v, w, p, q, r first, physics terms are found by themselves (`terms`).
targets : names of the columns of y. Default: those of a data frame, else y0, y1, ...
rate : rows per second [Hz] where no times are given; what is forgotten depends on age.

All others are the settings of `kelpie config`. None leaves a setting to the preset; with several
targets, one may be a list with a value for each.

{settings}

Attributes
----------
decisions_ : structured array of y's shape, what happened to every row of the last fit() or
    partial_fit(). `predicted`, `lower`, `upper` are from before the row was learned: one step
    ahead. Then `verdict` (Verdict), `had_model`, `similarity`, `outliers`, `forgotten`,
    `released`, `iterations`, `kkt_gap`, `served`, `unserved`, `unfinished`, `fallbacks`,
    `changed` (the vehicle was found to have changed), `changed_since` [s], `recalled` (number of
    the past model taken up again, or 0).
coef_, terms_ : the physics terms and their coefficients.
status_ : buffer, support vectors and totals of every target.
n_features_in_, feature_names_in_ : as in scikit-learn.

Pickling keeps everything: an estimator that comes back learns on, to the last bit, as if it had
never stopped. save() and load() keep what predicting needs.
"""


class OnlineSVR(Learner):
    __doc__ = ("Learns one target from a stream of rows: on-line ε-SVR in a fixed buffer.\n"
               + _ATTRIBUTES.format(settings=_settings.describe()))

    @classmethod
    def _takes_one_target(cls) -> bool:
        return True


class DynamicsModel(Learner):
    __doc__ = ("Learns several targets, as the accelerations of a vehicle, one learner each.\n"
               + _ATTRIBUTES.format(settings=_settings.describe()))

    def rollout(self, X: ArrayLike, t: Optional[ArrayLike] = None, *,
                between: str = "linear", measured: Sequence[int] = (), fade_s: float = 3.0,
                step_s: float = 0.25) -> RolloutResult:
        """Integrates the learned accelerations in open loop along one stretch of a log.

        Parameters
        ----------
        X : (n, inputs). Of the first row everything is used, of the others the commands.
        t : (n,), time [s], going up. Default: `rate` rows per second.
        between : "linear" or "held", how commands go from row to row.
        measured : velocities that are taken from X all along, counted from 0.
        fade_s : how long the learned model is believed beyond its steady part [s].
        step_s : longest step of the integrator [s].

        Raises ValueError on a model that doesn't know which inputs are velocities (`states`), or
        has learned from fewer than 200 steps.
        """
        if between not in ("linear", "held"):
            raise ValueError(f"between: {between!r} is not known; 'linear' and 'held' are")
        rows = self._inputs(X)
        times = (np.arange(len(rows)) / self.rate if t is None
                 else np.atleast_1d(_arrays.floats(t, "t")))
        return RolloutResult(*self._trained().rollout(rows, times, between == "held",
                                                      list(measured), fade_s, step_s))

    @classmethod
    def _takes_one_target(cls) -> bool:
        return False

    def _more_tags(self) -> dict[str, Any]:
        return {"multioutput": True}
