# SPDX-License-Identifier: Apache-2.0
"""Times of samples."""

from __future__ import annotations

import datetime
import numbers
from typing import Any, Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._arrays import Floats, floats, require_rows

TIMES = ("t", "time", "stamp")  # usual names, as kelpie learn takes them
_SECOND = np.timedelta64(1, "s")


def stamps_of(t: Any) -> Optional[NDArray[Any]]:
    """`t` as datetime64 if it is time stamps (of pandas, NumPy or datetime), else None.

    Stamps with a time zone become UTC, those without one stay as they are.
    """
    if getattr(getattr(t, "dtype", None), "tz", None) is not None:
        return np.asarray(t.to_numpy(dtype="datetime64[ns]"))
    array = np.asarray(t)
    if array.dtype.kind == "O" and array.size and isinstance(array.flat[0], datetime.datetime):
        array = np.array([_utc(stamp) for stamp in array.flat]).reshape(array.shape)
    return array if array.dtype.kind == "M" else None


def _utc(stamp: Any) -> Any:
    if not isinstance(stamp, datetime.datetime):
        raise ValueError(f"t: {stamp!r} is no time stamp, and the first one is")
    if stamp.tzinfo is not None:
        stamp = stamp.astimezone(datetime.timezone.utc).replace(tzinfo=None)
    return stamp.to_datetime64() if hasattr(stamp, "to_datetime64") else np.datetime64(stamp)


def index_times(X: Any) -> Any:
    """The index of a data frame if the index tells the time, else None.

    Time stamps and durations do, and numbers [s] under a usual name of times.
    """
    index = getattr(X, "index", None)
    kind = getattr(getattr(index, "dtype", None), "kind", "O")
    return index if kind in "mM" or kind in "iuf" and index.name in TIMES else None


def checked_rate(rate: Any) -> float:
    """`rate` [rows per second]. ValueError unless it is a number > 0."""
    if isinstance(rate, bool) or not isinstance(rate, numbers.Real):
        raise ValueError(f"rate: {rate!r} is no number; rows per second are wanted, as in rate=4.0")
    if not (np.isfinite(rate) and rate > 0.0):
        raise ValueError(f"rate: {rate} is out of range; it has to be > 0 rows per second")
    return float(rate)


def require_rate(rate: Any, what: str) -> float:
    """checked_rate(), or ValueError where there is none and `what` has no times."""
    if rate is None:
        raise ValueError(f"rate: isn't known, and {what} tells no time; give rows per second, as "
                         "in rate=4.0, or times, as t=")
    return checked_rate(rate)


class Clock:
    """Times [s] of a stream that comes in blocks.

    Samples without a time follow each other at a rate. Time stamps count from the first one. How a
    stream is cut into blocks does not change the times, to the last bit.
    """

    _epoch: Any = None  # the first stamp, where times are stamps

    def __init__(self) -> None:
        self._origin = 0.0  # time of sample `_first`
        self._first = 0
        self._last = -np.inf

    def times(self, t: Optional[ArrayLike], rows: int, samples: int,
              rate: Optional[float]) -> Floats:
        """The times of the next `rows` samples, after `samples` earlier ones.

        With neither times nor a rate, samples count as 1 s each.

        Raises ValueError on times that aren't finite, not of shape (rows,), or decreasing, and on
        seconds after time stamps or the other way round.
        """
        if t is None:
            return self._origin + np.arange(samples - self._first, samples - self._first + rows) / (
                1.0 if rate is None else checked_rate(rate))
        times = floats(self.seconds(t), "t")
        if times.ndim != 1:
            raise ValueError(f"t should be a 1d array, got an array of shape {times.shape} instead")
        require_rows(times, rows)
        if times[0] < self._last or (np.diff(times) < 0.0).any():
            raise ValueError("t: times [s] must not go down")
        return times

    def seconds(self, t: Any) -> Any:
        """Time stamps as seconds since the stream's first one, durations as seconds; else `t`."""
        stamps = stamps_of(t)
        if self._last > -np.inf and (stamps is None) != (self._epoch is None):
            now, before = ("seconds", "time stamps") if stamps is None else ("time stamps", "none")
            raise ValueError(f"t: {now} can't follow rows with {before}")
        if stamps is None:
            array = np.asarray(t)
            return array / _SECOND if array.dtype.kind == "m" else t
        if np.isnat(stamps).any():
            raise ValueError("Input t contains NaT.")
        if stamps.size == 0:
            return np.zeros(stamps.shape)
        epoch = stamps.flat[0] if self._epoch is None else self._epoch
        return (stamps - epoch) / _SECOND

    def learned(self, times: Floats, t: Optional[ArrayLike], samples: int) -> None:
        """Notes the times of learned samples, given as `t`; `samples` is the total with them."""
        if not times.size:
            return
        if t is not None:
            stamps = stamps_of(t)
            if self._epoch is None and stamps is not None:
                self._epoch = stamps.flat[0]
            self._origin, self._first = float(times[-1]), samples - 1
        self._last = float(times[-1])
