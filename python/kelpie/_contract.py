# SPDX-License-Identifier: Apache-2.0
"""What scikit-learn's classes give an estimator, where it is installed; kelpie works without."""

from __future__ import annotations

from typing import Any

try:
    from sklearn.base import BaseEstimator, RegressorMixin
    from sklearn.exceptions import DataConversionWarning, NotFittedError
except ImportError:

    class RegressorMixin:  # type: ignore[no-redef]
        """A regressor."""

    class BaseEstimator:  # type: ignore[no-redef]
        """An estimator that prints as the call that makes it."""

        def __repr__(self) -> str:
            given: dict[str, Any] = self.get_params()  # type: ignore[attr-defined]
            default = type(self)().get_params()  # type: ignore[attr-defined]
            parts = [f"{name}={value!r}" for name, value in given.items()
                     if repr(value) != repr(default[name])]
            return f"{type(self).__name__}({', '.join(parts)})"

    class NotFittedError(ValueError, AttributeError):  # type: ignore[no-redef]
        """Asked for something that is known only after fitting."""

    class DataConversionWarning(UserWarning):  # type: ignore[no-redef]
        """Data were given in another shape than was meant."""


__all__ = ["BaseEstimator", "DataConversionWarning", "NotFittedError", "RegressorMixin"]
