# SPDX-License-Identifier: Apache-2.0
"""Velocities for a navigator during outages of the velocity log."""

from __future__ import annotations

import os
from typing import Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _arrays, _kelpie
from ._estimators import DynamicsModel
from ._log import existing

_Model = Union[DynamicsModel, str, "os.PathLike[str]"]


class DeadReckoning:
    """Filters measured velocities, and predicts velocities during outages.

    Parameters
    ----------
    model : a fitted DynamicsModel, or the path of a model.json. The model is copied.
    planar : the first three velocities are surge, sway and yaw rate: estimates position, heading
        and current too. Default: by their names; three velocities without usual names are.
    current : standard deviation of the current at the start [m/s]; 0: no current.
    practice_s : duration of outages simulated while velocities are measured [s]; 0: none.
    between : "linear" or "held", how commands change between samples.
    step_s : longest step of the integrator [s].
    checks : recognises repeated values and exact zeros of the velocity log (faults).

    Roll, pitch and yaw rate are a gyro's, by their names; the velocity log measures the others.
    """

    def __init__(self, model: _Model, *, planar: Optional[bool] = None, current: float = 0.1,
                 practice_s: float = 20.0, between: str = "linear", step_s: float = 0.25,
                 checks: bool = True) -> None:
        self._reckoning = _kelpie.DeadReckoning(self._trained(model), planar, current, practice_s,
                                                self._is_held(between), step_s, checks)

    @staticmethod
    def _is_held(between: str) -> bool:
        if between not in ("linear", "held"):
            raise ValueError(f"between: {between!r} is not known; 'linear' and 'held' are")
        return between == "held"

    @staticmethod
    def _trained(model: _Model) -> _kelpie.TrainedModel:
        if isinstance(model, (str, os.PathLike)):
            return _kelpie.TrainedModel.read(existing(model))
        return model._trained()

    def use(self, model: _Model) -> None:
        """Goes on with another model of the same inputs; estimate and current stay."""
        self._reckoning.use(self._trained(model))

    def restate(self, x: ArrayLike, between: str = "linear") -> None:
        """After use(), where the model has its commands in other units: the last row had the
        commands of `x` (NaN: unknown; velocities are not looked at). Commands go on as `between`
        says."""
        self._reckoning.restate(np.ravel(np.asarray(x, dtype=np.float64)), self._is_held(between))

    def update(self, x: ArrayLike, t: float, covariance: Optional[ArrayLike] = None) -> None:
        """Advances to the time t [s] with one row of inputs; NaN: velocity not measured.

        Commands are taken as given, without the model's actuators and shift.

        `covariance` of the measured velocities, over all states; default: the model's noise.
        """
        given = [] if covariance is None else np.ravel(_arrays.floats(covariance, "covariance"))
        self._reckoning.update(np.ravel(np.asarray(x, dtype=np.float64)), float(t),
                               np.asarray(given, dtype=np.float64))

    def measured_heading(self, heading: float, deviation: float) -> None:
        """Adds a measured heading with its standard deviation [rad]."""
        self._reckoning.measured_heading(heading, deviation)

    @property
    def started(self) -> bool:
        """Whether there was a sample with all velocities."""
        return self._reckoning.started

    @property
    def faults(self) -> list[str]:
        """Why a velocity of the last row doesn't count as measured: "none" (measured), "missing",
        "repeated", "zero", "frozen" or "implausible", (states,)."""
        return self._reckoning.faults

    @property
    def step(self) -> float:
        """Largest change of a velocity by the last measurement, in standard deviations before."""
        return self._reckoning.step

    @property
    def silent_s(self) -> float:
        """Time since the velocity log measured a velocity [s]."""
        return self._reckoning.silent_s

    @property
    def velocity(self) -> NDArray[np.float64]:
        """Velocities over ground, (states,)."""
        return self._reckoning.velocity

    @property
    def covariance(self) -> NDArray[np.float64]:
        """Covariance of the velocities' errors, (states, states)."""
        return self._reckoning.covariance

    @property
    def position(self) -> NDArray[np.float64]:
        """Way since the start of the outage, in the frame of heading 0 [m], (2,); 0 with planar
        off."""
        return np.array(self._reckoning.position)

    @property
    def position_covariance(self) -> NDArray[np.float64]:
        """Covariance of the position's error [m²], (2, 2)."""
        return np.reshape(self._reckoning.position_covariance, (2, 2))

    @property
    def heading(self) -> float:
        """Heading [rad]; 0 with planar off."""
        return self._reckoning.heading

    @property
    def current(self) -> NDArray[np.float64]:
        """Current of the water, in the frame of heading 0 [m/s], (2,)."""
        return np.array(self._reckoning.current)

    @property
    def noise_factor(self) -> float:
        """Factor on the variance of the model's errors one step ahead."""
        return self._reckoning.noise_factor
