# SPDX-License-Identifier: Apache-2.0
"""What the thrusters of a vehicle can still do, and commands for wanted accelerations."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Mapping, Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _arrays, _kelpie
from ._estimators import DynamicsModel


@dataclass(frozen=True)
class Allocation:
    """Commands for wanted accelerations."""

    commands: dict[str, float]
    reached: NDArray[np.float64]  #: accelerations, (targets,)
    missing: float  #: the largest part that isn't reached, of the nominal range


class Authority:
    """The effectiveness of the thrusters as a fitted model knows it now (docs/howto/diagnosis.md).

    Parameters
    ----------
    model : a fitted DynamicsModel with known velocities, some minutes of driving or more.
    ranges : least and greatest command of each thruster, by name; 0 is at rest.
    """

    def __init__(self, model: DynamicsModel, ranges: Mapping[str, tuple[float, float]]) -> None:
        fitted = model._fitted()
        if not isinstance(fitted, _kelpie.LiveModel):
            raise ValueError("model: one that was read from model.json has no diagnosis")
        self._thrusters = list(ranges)
        self._inputs, self._targets = fitted.inputs, fitted.targets
        self._authority = fitted.authority(
            [(name, float(least), float(most)) for name, (least, most) in ranges.items()])

    def allocate(self, wanted: ArrayLike) -> Allocation:
        """Commands for accelerations (targets,), at rest."""
        given = np.ravel(_arrays.floats(wanted, "wanted")).tolist()
        commands, reached, missing = self._authority.allocate(given)
        return Allocation(dict(zip(self._thrusters, commands)), np.array(reached), missing)

    @property
    def ahead(self) -> NDArray[np.float64]:
        """Accelerations at full ahead, a column per thruster, (targets, thrusters)."""
        return self._authority.ahead

    @property
    def astern(self) -> NDArray[np.float64]:
        """Accelerations at full astern, (targets, thrusters)."""
        return self._authority.astern

    @property
    def ahead_width(self) -> NDArray[np.float64]:
        """Half widths of the 90 % intervals of `ahead`."""
        return self._authority.ahead_width

    @property
    def astern_width(self) -> NDArray[np.float64]:
        """Half widths of the 90 % intervals of `astern`."""
        return self._authority.astern_width

    @property
    def shares(self) -> dict[str, float]:
        """Share of its nominal thrust that each thruster gives."""
        return dict(zip(self._thrusters, self._authority.shares))

    @property
    def axes(self) -> dict[str, dict[str, float]]:
        """For each target the greatest accelerations: `most`, `least`, `nominal_most`,
        `nominal_least`, `alone_most`, `alone_least` (other axes held at 0), and the share `left`."""
        return dict(zip(self._targets, self._authority.axes))

    @property
    def singular_values(self) -> NDArray[np.float64]:
        """Of the matrix over the nominal range of each target, greatest first."""
        return np.array(self._authority.singular_values)

    @property
    def lost_target(self) -> Optional[str]:
        """The target that is hardly under control any more, or None."""
        place = self._authority.lost_axis
        return self._targets[place] if place < len(self._targets) else None

    @property
    def held_current(self) -> float:
        """Fastest water from ahead in which the vehicle holds its place; NaN without surge."""
        return self._authority.held_current

    def __str__(self) -> str:
        return self._authority.text(self._inputs, self._targets)
