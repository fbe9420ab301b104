# SPDX-License-Identifier: Apache-2.0
"""Recorded data as columns."""

from __future__ import annotations

import errno
import os
import tempfile
from collections.abc import Sequence
from contextlib import nullcontext
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import NDArray

from . import _kelpie

try:
    import pandas
except ImportError:
    pandas = None  # type: ignore[assignment]

_Path = Union[str, os.PathLike[str]]


def existing(file: _Path) -> str:
    """The path as text. FileNotFoundError where there is no such file."""
    if not os.path.exists(file):
        raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), os.fspath(file))
    return os.fspath(file)


class LogArrays(dict[str, NDArray[Any]]):
    """The columns of a log by name, each an array (rows,). Where there is no pandas.

    `attrs` is what a data frame of read_log() has under that name.
    """

    attrs: dict[str, Any]


def read_log(path: _Path, config: Optional[_Path] = None, *,
             columns: Optional[Sequence[str]] = None, clock: str = "receive",
             messages: Optional[_Path] = None, recover: bool = False, strict: bool = False,
             frame: Optional[bool] = None, pose: Optional[Sequence[str]] = None,
             inputs: Optional[Sequence[str]] = None, rate: float = 0.0, draft: bool = False) -> Any:
    """Reads a log of any kind that kelpie knows: CSV, or a recording of messages.

    Parameters
    ----------
    path : a CSV file, or a recording (.mcap, .tlog, ...: docs/reference/formats.md). Told
        apart by content.
    config : TOML file whose [log] says what to take, and how signals become rows at one rate
        (docs/howto/logs.md). Without it a CSV file is read as it is, and a recording as `kelpie
        learn` would take it (docs/howto/logs.md).
    columns : instead, columns of a recording as they were recorded, such as
        "/odom:twist.twist.linear.x": a row per message of the first one's topic.
    clock : "receive" or "header", whose times `columns` have.
    messages : folder of .msg files, for types that the recording doesn't define.
    recover : read what can be read of a damaged file; `attrs["losses"]` says what was lost.
    strict : refuse messages with a wrong checksum, which are passed over and counted otherwise.
    pose : instead, columns of a CSV file with poses, such as ["x", "y", "psi"] or ["z=altitude"]:
        rows of velocities, accelerations and commands, as of `kelpie learn --pose`.
    inputs : beside `pose`, the inputs (velocities of the pose, commands, ...). Default: the
        velocities and the commands that are known by name.
    rate : beside `pose`, rows per second. Default: as poses come, at most 10 (50 of a short log).
    draft : of a CSV file without the usual names or accelerations, the rows that `kelpie learn`
        guesses: inputs in SI units, and slopes of velocities as targets, at one rate. Recordings
        are read so by default.
    frame : True for a pandas data frame, False for a dict of arrays (LogArrays). Default: a data
        frame where pandas is installed.

    Returns the columns, numbers as float64, NaN where there is none. A column with words holds
    objects. `attrs` has `source`, `units` (of columns, where they are known), `time` (name of the
    time's column, or None), `inputs` and `targets` (as `kelpie learn` would guess them; empty where
    it can't), `losses`, `doubts` (of a CSV file, velocities that contradict its poses), `draft`
    (the configuration that was guessed, or None).
    DynamicsModel.fit() takes such a data frame as a whole.

    Raises ValueError naming file, place and what would be right; FileNotFoundError where there is no
    such file.
    """
    if clock not in ("receive", "header"):
        raise ValueError(f"clock: {clock!r} is not known; 'receive' and 'header' are")
    if recover and strict:
        raise ValueError("strict: a damaged recording is recovered or refused, not both")
    if isinstance(columns, str):
        columns = [columns]
    if columns is not None and (config is not None or not columns):
        raise ValueError("columns: names of columns are wanted, and no config beside them, which "
                         "names its own")
    if pose is not None and (config is not None or columns is not None or not pose):
        raise ValueError("pose: names of columns are wanted, and neither config nor columns beside "
                         "them")
    if pose is None and (inputs is not None or rate != 0.0):
        raise ValueError("inputs: and rate stand beside pose; a config says both otherwise")
    if draft and not (config is None and columns is None and pose is None):
        raise ValueError("draft: is guessed where neither config nor columns nor pose say what to "
                         "read")
    if frame and pandas is None:
        raise ImportError("frame: pandas isn't installed; without it there are arrays (frame=False)")
    # An empty configuration asks for a draft.
    with tempfile.NamedTemporaryFile(suffix=".toml") if draft else nullcontext() as empty:
        given = empty.name if empty is not None else "" if config is None else existing(config)
        found = _kelpie.read_log(existing(path), given, list(columns or []), clock == "header",
                                 "" if messages is None else os.fspath(messages), recover, strict,
                                 list(pose or []), list(inputs or []), rate)
    log = LogArrays(found["columns"])
    for name, words in found["words"].items():
        log[name] = _with_words(log[name], words)
    log.attrs = {"source": os.fspath(path), "units": found["units"],
                 "time": found["time"] or None, "inputs": found["inputs"],
                 "targets": found["targets"], "losses": found["losses"].splitlines(),
                 "doubts": found["doubts"], "draft": found["draft"] or None}
    if frame is False or pandas is None:
        return log
    table = pandas.DataFrame(dict(log))
    table.attrs = log.attrs
    return table


def _with_words(numbers: NDArray[np.float64], words: list[tuple[int, str]]) -> NDArray[Any]:
    cells = numbers.astype(object)
    for row, word in words:
        cells[row] = word
    return cells
