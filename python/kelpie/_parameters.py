# SPDX-License-Identifier: Apache-2.0
"""The parameters of the estimators."""

from __future__ import annotations

import difflib
import functools
import inspect
import os
from collections.abc import Mapping, Sequence
from typing import Any, Optional, TypeVar, Union

from ._contract import BaseEstimator, RegressorMixin

Number = Union[float, Sequence[float], None]
Word = Union[str, Sequence[str], None]
File = Union[str, "os.PathLike[str]"]
Nominal = Union[File, Sequence[File], Mapping[str, Mapping[str, float]], None]
Self = TypeVar("Self", bound="ParameterAccess")


def _with_known_names(constructor: Any) -> Any:
    """The constructor, which tells the nearest parameter where there is none of a name."""
    known = [name for name in inspect.signature(constructor).parameters if name != "self"]

    @functools.wraps(constructor)
    def checked(self: Any, *none: Any, **given: Any) -> None:
        for name in given:
            if name not in known:
                raise TypeError(_unknown(name, type(self).__name__, known))
        constructor(self, *none, **given)

    return checked


def _unknown(name: str, owner: str, known: list[str]) -> str:
    near = difflib.get_close_matches(name, known, 1)
    hint = f" (did you mean '{near[0]}'?)" if near else ""
    return f"Invalid parameter {name!r} for {owner}{hint}; the parameters are {', '.join(known)}"


class ParameterAccess:
    """Parameters by name, those of the constructor, as scikit-learn requires."""

    @classmethod
    def _parameter_names(cls) -> list[str]:
        return [name for name in inspect.signature(cls.__init__).parameters if name != "self"]

    def get_params(self, deep: bool = True) -> dict[str, Any]:
        """All parameters of the constructor by name."""
        return {name: getattr(self, name) for name in self._parameter_names()}

    def set_params(self: Self, **params: Any) -> Self:
        """Sets parameters for the next fit(). ValueError on an unknown name."""
        known = self._parameter_names()
        for name in params:
            if name not in known:
                raise ValueError(_unknown(name, type(self).__name__, known))
        for name, value in params.items():
            setattr(self, name, value)
        return self


class Parameters(ParameterAccess, RegressorMixin, BaseEstimator):
    """A constructor that keeps its arguments, as scikit-learn requires.

    The settings are listed by name so that editors know them, in the groups of `kelpie config`; a
    test compares them with the library's.
    """

    @_with_known_names
    def __init__(
        self,
        *,
        inputs: Optional[Sequence[str]] = None,
        targets: Word = None,
        rate: Optional[float] = None,
        nominal: Nominal = None,
        # Essential
        preset: str = "default",
        learner: Optional[str] = None,
        terms: Word = None,
        states: Word = None,
        velocities: Word = None,
        coverage: Optional[float] = None,
        outlier: Word = None,
        buffer: Number = None,
        adapt: Word = None,
        memory: Optional[int] = None,
        # Scale
        scaling: Optional[str] = None,
        warmup: Optional[int] = None,
        # Kernel
        gamma: Number = None,
        fine: Number = None,
        lambda_terms: Number = None,
        # Learner
        epsilon: Number = None,
        c: Number = None,
        C: Number = None,
        xi: Number = None,
        a: Number = None,
        b: Number = None,
        outlier_factor: Number = None,
        # Buffer
        forget: Word = None,
        k: Number = None,
        bandwidth: Number = None,
        anchors: Number = None,
        # Solver
        solver: Word = None,
        storage: Word = None,
        ridge: Number = None,
        tolerance: Number = None,
        max_iterations: Number = None,
    ) -> None:
        given = locals()
        for name in self._parameter_names():
            setattr(self, name, given[name])
