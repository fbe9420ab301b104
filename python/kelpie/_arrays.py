# SPDX-License-Identifier: Apache-2.0
"""Converts and checks arrays for the library.

The messages are worded like scikit-learn's, because its checks look for them.
"""

from __future__ import annotations

import warnings
from typing import Any, Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._contract import DataConversionWarning

Floats = NDArray[np.float64]


def floats(values: ArrayLike, name: str) -> Floats:
    """`values` as float64 in C order, copied only if they are not that already.

    Raises ValueError on complex numbers, a NaN or an infinity, TypeError on sparse matrices and
    dates, and one of the two on anything else that isn't numbers.
    """
    if hasattr(values, "toarray"):
        raise TypeError(f"Sparse data was passed as {name}, but dense data is required.")
    array = np.asarray(values)
    if array.dtype.kind == "c":
        raise ValueError(f"Complex data not supported\n{array}\n")
    if array.dtype.kind in "mM":
        raise TypeError(f"{name} holds dates or durations; numbers are required.")
    dense = np.require(array, np.float64, ["C_CONTIGUOUS", "ALIGNED"])
    if not np.isfinite(dense).all():
        problem = ("NaN" if np.isnan(dense).any()
                   else "infinity or a value too large for dtype('float64')")
        raise ValueError(f"Input {name} contains {problem}.")
    return dense


def matrix(values: ArrayLike, name: str = "X") -> Floats:
    """floats() of shape (n, columns), both at least 1. ValueError on other shapes."""
    array = floats(values, name)
    if array.ndim != 2:
        raise ValueError(
            f"Expected 2D array, got {array.ndim}D array instead. Reshape your data either using "
            "array.reshape(-1, 1) if your data has a single feature or array.reshape(1, -1) if "
            "it contains a single sample.")
    for axis, what in enumerate(("sample(s)", "feature(s)")):
        if array.shape[axis] == 0:
            raise ValueError(f"Found array with 0 {what} (shape={array.shape}) while a minimum of "
                             "1 is required.")
    return array


def targets(values: Optional[ArrayLike], rows: int, owner: str) -> Floats:
    """floats() of shape (rows,) or (rows, axes). ValueError on other shapes."""
    if values is None:
        raise ValueError(f"{owner} requires y to be passed, but the target y is None")
    array = floats(values, "y")
    if array.ndim not in (1, 2) or array.size == 0:
        raise ValueError("y should be a 1d array, or a 2d array with one column per target, got an "
                         f"array of shape {array.shape} instead.")
    require_rows(array, rows)
    return array


def one_target(array: Floats, owner: str) -> Floats:
    """targets() as shape (n,); a single column is accepted with a warning."""
    if array.ndim == 1:
        return array
    if array.shape[1] != 1:
        raise ValueError(f"y should be a 1d array, got an array of shape {array.shape} instead; "
                         f"{owner} learns one target, DynamicsModel several.")
    warnings.warn("A column-vector y was passed when a 1d array was expected. Please change the "
                  "shape of y to (n_samples,), for example using ravel().",
                  DataConversionWarning, stacklevel=4)
    return array.ravel()


def seconds_ahead(values: ArrayLike, rows: int) -> Floats:
    """One number for all or one per row as shape (rows,). ValueError on negative ones."""
    array = floats(values, "ahead_s")
    if array.ndim > 1 or (array < 0.0).any():
        raise ValueError("ahead_s: one number [s] or one per row is wanted, none below 0")
    if array.ndim == 1:
        require_rows(array, rows)
    return np.ascontiguousarray(np.broadcast_to(array, (rows,)))


def require_rows(array: Floats, rows: int) -> None:
    """Raises ValueError unless `array` has `rows` rows."""
    if array.shape[0] != rows:
        raise ValueError("Found input variables with inconsistent numbers of samples: "
                         f"{[rows, array.shape[0]]}")


def column_names(values: Any) -> Optional[list[str]]:
    """Column names of a data frame (or name of a series) if all are strings, else None."""
    if hasattr(values, "columns"):
        names = list(values.columns)
    elif hasattr(values, "name") and hasattr(values, "index"):
        names = [values.name]
    else:
        return None
    return names if names and all(isinstance(name, str) for name in names) else None


def require_same_columns(estimator: Any, values: Any, array: Floats) -> None:
    """Compares a matrix with the columns that a fitted estimator has seen: ValueError on others."""
    fitted = getattr(estimator, "feature_names_in_", None)
    compare_names(column_names(values), None if fitted is None else list(fitted),
                  type(estimator).__name__)
    require_width(estimator, array)


def require_width(estimator: Any, array: Floats) -> None:
    """Raises ValueError on another number of columns than a fitted estimator has seen."""
    if array.shape[1] != estimator.n_features_in_:
        raise ValueError(f"X has {array.shape[1]} features, but {type(estimator).__name__} is "
                         f"expecting {estimator.n_features_in_} features as input")


def compare_names(now: Optional[list[str]], fitted: Optional[list[str]], owner: str) -> None:
    """Compares column names with those of fit(): ValueError on other names or another order."""
    if now is not None and fitted is None:
        warnings.warn(f"X has feature names, but {owner} was fitted without feature names",
                      UserWarning, stacklevel=4)
    elif now is None and fitted is not None:
        warnings.warn("X does not have valid feature names, but "
                      f"{owner} was fitted with feature names", UserWarning, stacklevel=4)
    elif now is not None and now != fitted:
        raise ValueError(_other_names(now, fitted or []))


def _other_names(now: list[str], fitted: list[str]) -> str:
    lines = ["The feature names should match those that were passed during fit."]
    unexpected = sorted(set(now) - set(fitted))
    missing = sorted(set(fitted) - set(now))
    if unexpected:
        lines += ["Feature names unseen at fit time:", *(f"- {name}" for name in unexpected)]
    if missing:
        lines += ["Feature names seen at fit time, yet now missing:",
                  *(f"- {name}" for name in missing)]
    if not unexpected and not missing:
        lines.append("Feature names must be in the same order as they were in fit.")
    return "\n".join(lines) + "\n"
