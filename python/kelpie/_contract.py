# SPDX-License-Identifier: Apache-2.0
"""Base classes from scikit-learn if it is installed, else substitutes."""

from __future__ import annotations

from typing import Any

try:
    from sklearn.base import BaseEstimator, RegressorMixin, TransformerMixin
    from sklearn.exceptions import DataConversionWarning, NotFittedError
except ImportError:

    class RegressorMixin:  # type: ignore[no-redef]
        """A regressor."""

    class TransformerMixin:  # type: ignore[no-redef]
        """A transformer."""

    class BaseEstimator:  # type: ignore[no-redef]
        """An estimator whose repr() is the call that constructs it."""

        def __repr__(self) -> str:
            given: dict[str, Any] = self.get_params()  # type: ignore[attr-defined]
            default = type(self)().get_params()  # type: ignore[attr-defined]
            parts = [f"{name}={value!r}" for name, value in given.items()
                     if repr(value) != repr(default[name])]
            return f"{type(self).__name__}({', '.join(parts)})"

    class NotFittedError(ValueError, AttributeError):  # type: ignore[no-redef]
        """The estimator has to be fitted first."""

    class DataConversionWarning(UserWarning):  # type: ignore[no-redef]
        """Data were converted to the required shape."""


__all__ = ["BaseEstimator", "DataConversionWarning", "NotFittedError", "RegressorMixin",
           "TransformerMixin"]
