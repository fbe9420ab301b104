# SPDX-License-Identifier: Apache-2.0
"""Every entry on every data set, each pair in a process of its own."""

from __future__ import annotations

import gc
import multiprocessing
import platform
import sys
import time
import warnings
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Optional

import numpy as np

from .._kelpie import __version__
from . import _tracks
from ._data import Dataset, load
from ._entries import HAS_SKLEARN, Entry
from ._manifest import Source

try:
    from threadpoolctl import threadpool_limits
except ImportError:
    threadpool_limits = None


@dataclass(frozen=True)
class Limits:
    """The size of a benchmark."""

    rows: int = 3000  # to learn, of each data set
    seed: int = 1
    jobs: int = 1  # processes at a time
    minutes: float = 30.0  # of one entry on one data set


def run(sources: Sequence[Source], entries: Sequence[Entry], limits: Limits = Limits(),
        say: Callable[[str], None] = lambda text: None) -> dict[str, Any]:
    """The results of all tracks, as benchmark.json has them. ManifestError on bad data.

    An entry that fails on a data set has `failed` with the reason, and no figures there. Equal
    limits give equal figures, but for those of the track cost.
    """
    loaded = [load(source, limits.rows, limits.seed) for source in sources]
    pairs = [(entry, data) for data in loaded for entry in entries]
    with ThreadPoolExecutor(limits.jobs) as pool:
        results = list(pool.map(lambda pair: _watched(*pair, limits, say), pairs))
    return {"format": "kelpie-benchmark", "version": 1, "protocol": _tracks.PROTOCOL,
            "kelpie": __version__, "limits": asdict(limits), "machine": _machine(),
            "spoilt": {name: str(spoil.__doc__) for name, spoil in _tracks.SPOILT.items()},
            "data": [data.describe() for data in loaded],
            "entries": [{"name": entry.name, "kind": entry.kind, "meaning": entry.meaning,
                         "offline": entry.offline} for entry in entries],
            "results": results}


def _machine() -> dict[str, Any]:
    found = {"python": platform.python_version(), "numpy": np.__version__,
             "system": platform.machine()}
    if HAS_SKLEARN:
        found["scikit-learn"] = sys.modules["sklearn"].__version__
    return found


def _watched(entry: Entry, data: Dataset, limits: Limits,
             say: Callable[[str], None]) -> dict[str, Any]:
    start = time.monotonic()
    found = _in_a_process(entry, data, limits.minutes)
    result = {"entry": entry.name, "data": data.source.name, **found}
    score = (f"failed: {found['failed']}" if "failed" in found
             else f"R² {found['anytime']['final']:.3f}")
    say(f"{data.source.name:20s} {entry.name:16s} {time.monotonic() - start:6.1f} s  {score}")
    return result


def _in_a_process(entry: Entry, data: Dataset, minutes: float) -> dict[str, Any]:
    # A fork, so that the child's growth of memory is the learner's, and the modules are there.
    context = multiprocessing.get_context("fork")
    ours, theirs = context.Pipe(duplex=False)
    child = context.Process(target=_send, args=(theirs, entry, data))
    child.start()
    theirs.close()
    try:
        if not ours.poll(60.0 * minutes):
            return {"failed": f"took more than {minutes:g} minutes"}
        return ours.recv()  # type: ignore[no-any-return]
    except EOFError:
        child.join()
        return {"failed": f"its process ended with code {child.exitcode}"}
    finally:
        child.kill()
        child.join()


def _send(pipe: Any, entry: Entry, data: Dataset) -> None:
    warnings.simplefilter("ignore")  # of learners, which would fill the terminal
    if threadpool_limits is not None:
        threadpool_limits(1)
    try:
        pipe.send(measure(entry, data))
    except _tracks.EntryError as error:
        pipe.send({"failed": str(error)})
    pipe.close()


def measure(entry: Entry, data: Dataset) -> dict[str, Any]:
    """All tracks of the data set, for one entry, in this process."""
    wanted = data.source.tracks
    gc.collect()
    before = _resident_bytes()
    learner, found = _tracks.stream(entry, data)
    grown = _resident_bytes()
    found = {name: value for name, value in found.items() if name in wanted or name == "anytime"}
    if "cost" in wanted:
        found["cost"] = _tracks.cost(learner)
        if before is not None and grown is not None:
            found["cost"]["resident_bytes"] = max(0, grown - before)
    if "open_loop" in wanted:
        found["open_loop"] = _tracks.open_loop(entry, learner, data)
    if "rates" in wanted:
        found["rates"] = _tracks.rates(entry, data)
    if "hostile" in wanted:
        found["hostile"] = _tracks.hostile(entry, data)
    if "paper" in wanted:
        found["paper"] = _tracks.paper(entry, data)
    return {name: value for name, value in found.items() if value is not None}


def _resident_bytes() -> Optional[int]:
    try:
        text = Path("/proc/self/status").read_text(encoding="utf-8")
    except OSError:
        return None
    line = next((line for line in text.splitlines() if line.startswith("VmRSS:")), None)
    return None if line is None else 1024 * int(line.split()[1])
