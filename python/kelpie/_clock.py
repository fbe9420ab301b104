# SPDX-License-Identifier: Apache-2.0
"""Times of samples."""

from __future__ import annotations

from typing import Optional

import numpy as np
from numpy.typing import ArrayLike

from ._arrays import Floats, floats, require_rows


class Clock:
    """Time stamps [s] of a stream that comes in blocks.

    Samples without a time follow each other at a rate. How a stream is cut into blocks does not
    change the times, to the last bit.
    """

    def __init__(self) -> None:
        self._origin = 0.0  # time of sample `_first`
        self._first = 0
        self._last = -np.inf

    def times(self, t: Optional[ArrayLike], rows: int, samples: int, rate: float) -> Floats:
        """The times of the next `rows` samples, after `samples` earlier ones.

        Raises ValueError on times that aren't finite, not of shape (rows,), or decreasing.
        """
        if t is None:
            if not (np.isfinite(rate) and rate > 0.0):
                raise ValueError(f"rate: {rate} is out of range; it has to be > 0 rows per second")
            return self._origin + np.arange(samples - self._first,
                                            samples - self._first + rows) / rate
        times = floats(t, "t")
        if times.ndim != 1:
            raise ValueError(f"t should be a 1d array, got an array of shape {times.shape} instead")
        require_rows(times, rows)
        if times[0] < self._last or (np.diff(times) < 0.0).any():
            raise ValueError("t: times [s] must not go down")
        return times

    def learned(self, times: Floats, given: bool, samples: int) -> None:
        """Notes the times of learned samples; `samples` is the total including them."""
        if times.size:
            self._last = float(times[-1])
            if given:
                self._origin, self._first = self._last, samples - 1
