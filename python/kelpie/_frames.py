# SPDX-License-Identifier: Apache-2.0
"""What of a data frame is what: inputs, targets, time, velocities."""

from __future__ import annotations

import re
import warnings
from collections.abc import Sequence
from typing import Any, NamedTuple, Optional

import numpy as np

from . import _kelpie
from ._clock import TIMES, index_times, stamps_of

_NUMBERS = "biuf"  # kinds of dtypes


class Given(NamedTuple):
    """What a call has been given, columns chosen."""

    X: Any
    y: Any
    t: Any
    by_name: bool  # whether columns were chosen by name


def is_frame(values: Any) -> bool:
    """Whether these are columns with names, as in pandas."""
    return hasattr(values, "columns") and hasattr(values, "dtypes")


def taken(X: Any, y: Any, t: Any, inputs: Any, targets: Any, by_values: bool = False) -> Given:
    """X, y and t of a call. Of a data frame the columns that are named, or those guessed where y is
    left out; with `by_values` as `kelpie learn` guesses, without constants, counters and columns
    that equal another. Raises ValueError on a name that no column has.
    """
    if not is_frame(X):
        if isinstance(t, str):
            raise ValueError(f"t: '{t}' would be a column of X, which is no data frame")
        return Given(X, y, t, False)
    if y is None:
        return _whole_log(X, t, inputs, targets, by_values)
    stamps, rest = index_times(X) if t is None else t, X
    if isinstance(t, str):
        _require(X, [t], "t")
        stamps = X[t]
        if inputs is None:
            rest = X.drop(columns=[t])
    if inputs is not None and len(inputs) != rest.shape[1]:
        _require(rest, inputs, "inputs")
    chosen = inputs_of(rest, inputs)
    return Given(rest if chosen is None else chosen, y, stamps, chosen is not None)


def inputs_of(X: Any, inputs: Optional[Sequence[str]]) -> Any:
    """The columns `inputs` of a data frame; None where it isn't one or doesn't have them all."""
    if inputs is None or not is_frame(X) or not set(inputs) <= set(X.columns):
        return None
    return X[list(inputs)]


def require_inputs(X: Any, inputs: Sequence[str]) -> None:
    """Raises ValueError on a data frame with names for columns that lacks an input."""
    if is_frame(X) and all(isinstance(name, str) for name in X.columns):
        missing = [name for name in inputs if name not in X.columns]
        if missing:
            raise ValueError(f"X: lacks the model's inputs {', '.join(missing)}; the columns are "
                             f"{', '.join(X.columns)}")


def index_of(X: Any) -> Any:
    """The index of a data frame of pandas, else None."""
    return X.index if is_frame(X) and type(X).__module__.startswith("pandas") else None


def like(values: Any, index: Any, targets: Sequence[str]) -> Any:
    """A structured array (n,) or (n, targets) as a data frame with `index`, where there is one."""
    if index is None:
        return values
    import pandas
    if values.ndim == 1:
        return pandas.DataFrame({name: values[name] for name in values.dtype.names}, index=index)
    return pandas.DataFrame({(name, target): values[name][:, k] for name in values.dtype.names
                             for k, target in enumerate(targets)}, index=index)


def states(inputs: Sequence[str], targets: Any) -> dict[str, str]:
    """The setting `states` where the targets are named after inputs that aren't the first ones.

    udot, u_dot and du are of u. Of the first ones the library knows by itself.
    """
    names = [targets] if isinstance(targets, str) else list(targets or [])
    found = [name for target in names
             for name in _kelpie.differentiated(str(target)) if name in inputs]
    if not names or len(set(found)) != len(names) or found == list(inputs)[:len(names)]:
        return {}
    return {"states": ",".join(found)}


def _require(X: Any, names: Sequence[str], what: str) -> None:
    for name in names:
        if name not in X.columns:
            raise ValueError(f"{what}: there is no column '{name}'; the columns are "
                             f"{', '.join(str(column) for column in X.columns)}")


def _whole_log(X: Any, t: Any, inputs: Any, targets: Any, by_values: bool) -> Given:
    names = [str(name) for name, kind in zip(X.columns, X.dtypes) if _kind(kind) in _NUMBERS]
    targets = [targets] if isinstance(targets, str) else targets
    given = (names + _stamp_names(X), list(inputs or []), list(targets or []))
    ins, outs, time = _guessed(*given, np.empty((0, len(names))))
    if by_values:
        told, by_names = list(map(str, X.columns)), ins + outs
        ins, outs, time = _guessed(*given, _numbers(X, names))
        left = sorted(set(by_names) - set(ins + outs), key=told.index)
        if left:
            warnings.warn(f"X: {', '.join(left)}: left out, as `kelpie learn` does: constant, a "
                          "counter of rows, or equal to another column. inputs= keeps them",
                          UserWarning, stacklevel=5)
    _require(X, ins, "inputs")
    _require(X, outs, "targets")
    is_of_frame = t is None or isinstance(t, str)
    if isinstance(t, str):
        time, t = t, None
        _require(X, [time], "t")
    if t is None and time:
        t = X[time]
        ins = [name for name in ins if name != time or inputs]
    elif t is None:
        t = index_times(X)
    whole = np.isfinite(X[ins + outs].to_numpy(dtype=float)).all(axis=1)
    if is_of_frame and t is not None:
        whole &= _known(t)
    y = X[outs[0]] if len(outs) == 1 else X[outs]
    return Given(X[ins][whole], y[whole], None if t is None else _rows(t, whole), True)


def _numbers(X: Any, names: list[str]) -> Any:
    return np.ascontiguousarray(X[names].to_numpy(dtype=float))


def _guessed(names: list[str], inputs: list[str], targets: list[str],
             values: Any) -> tuple[list[str], list[str], str]:
    try:
        return _kelpie.guess_roles(names, inputs, targets, values)
    except ValueError as error:
        text = re.sub(r"--(\w+)", r"\1=", str(error).replace("columns: ", "X: ", 1))
        if "targets=" in text:
            text += ("; of a CSV file without accelerations, read_log(file, draft=True) gives "
                     "slopes of velocities, as `kelpie learn` takes them")
        raise ValueError(text) from None


def _stamp_names(X: Any) -> list[str]:
    return [name for name, kind in zip(X.columns, X.dtypes) if _kind(kind) == "M" and name in TIMES]


def _kind(dtype: Any) -> str:
    return str(getattr(dtype, "kind", "O"))


def _known(t: Any) -> Any:
    times = np.asarray(t) if stamps_of(t) is None else stamps_of(t)
    return ~np.isnat(times) if times.dtype.kind in "mM" else np.isfinite(times.astype(float))


def _rows(t: Any, whole: Any) -> Any:
    stamps = stamps_of(t)
    return (np.asarray(t) if stamps is None else stamps)[whole]
