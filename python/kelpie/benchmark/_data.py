# SPDX-License-Identifier: Apache-2.0
"""Rows of a data set: runs, stretches of one vehicle, rows that are left out."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, Optional

import numpy as np
from numpy.typing import NDArray

from .._log import read_log
from .._splits import BlockSplit
from ._manifest import Source

Floats = NDArray[np.float64]
LEFT_OUT = 5  # the last of every so many runs of a stretch is left out
_MANY_RUNS = 10  # of a stretch: whole runs are dropped to shorten the stretch
_BETWEEN_FILES_S = 60.0


@dataclass(frozen=True)
class Task:
    """What a learner is told before the first row."""

    inputs: list[str]
    targets: list[str]
    states: list[int]  # for each target the input of which the target is the derivative; or empty
    rate: float  # rows per second
    seed: int


@dataclass(frozen=True)
class Dataset:
    """Rows in order of time. A stretch is a row of runs of one vehicle (configuration)."""

    source: Source
    task: Task
    X: Floats  # (n, inputs)
    y: Floats  # (n, targets)
    t: Floats  # (n,) [s], never decreasing
    run: NDArray[np.int64]  # (n,)
    stretch: NDArray[np.int64]  # (n,)
    vehicle: Floats  # (n,) the configuration, which may return in a later stretch
    left_out: NDArray[np.bool_]  # (n,) rows of runs that no learner learns
    truth: Optional[Floats] = None  # (n, targets) without noise
    splits: Optional[dict[str, NDArray[np.int64]]] = None  # of `whole`: 1 held out, 0 learned
    whole: Optional["Dataset"] = None  # all rows, for the track paper

    def rows(self, chosen: Any) -> "Dataset":
        """The chosen rows: a mask, or numbers of rows."""
        truth = None if self.truth is None else self.truth[chosen]
        return replace(self, X=self.X[chosen], y=self.y[chosen], t=self.t[chosen],
                       run=self.run[chosen], stretch=self.stretch[chosen],
                       vehicle=self.vehicle[chosen], left_out=self.left_out[chosen],
                       truth=truth)

    def describe(self) -> dict[str, Any]:
        """The data set in words and numbers, for results."""
        held = self.left_out
        found = {"name": self.source.name, "simulated": self.source.simulated,
                 "license": self.source.license, "origin": self.source.origin,
                 "conversion": self.source.conversion, "inputs": self.task.inputs,
                 "targets": self.task.targets, "rate_hz": self.task.rate,
                 "open_loop": bool(self.task.states), "tracks": self.source.tracks,
                 "rows_learned": int((~held).sum()), "rows_left_out": int(held.sum()),
                 "runs_learned": len(np.unique(self.run[~held])),
                 "runs_left_out": len(np.unique(self.run[held])),
                 "stretches": len(np.unique(self.stretch))}
        if self.truth is not None:
            found["ceiling_r2"] = [r_squared(self.y[held, j], self.truth[held, j])
                                   for j in range(self.y.shape[1])]
        return found


def r_squared(measured: Floats, predicted: Floats) -> float:
    """R²; NaN where a prediction is not finite or the measurements are constant."""
    spread = float(((measured - measured.mean()) ** 2).sum()) if len(measured) else 0.0
    with np.errstate(all="ignore"):
        wrong = float(((measured - predicted) ** 2).sum())
    return 1.0 - wrong / spread if spread > 0.0 and np.isfinite(wrong) else float("nan")


def load(source: Source, most_rows: int, seed: int) -> Dataset:
    """Reads the files, tells runs and stretches, and shortens to at most some rows to learn.

    ManifestError on a missing or changed file, and on columns that are not there.
    """
    source.check_files()
    parts = [_read(source, place) for place in range(len(source.files))]
    columns = {key: np.concatenate([part[key] for part in parts]) for key in parts[0]}
    X, y = columns["X"], columns["y"]
    usable = np.isfinite(X).all(axis=1) & np.isfinite(y).all(axis=1)
    t, run = _in_order(columns["t"], columns["run"], columns["file"])
    # Runs are told before rows with empty cells are passed over, except by silences.
    chosen = np.flatnonzero(usable)
    run = _runs_by_silence(source, t[chosen], run[chosen])
    conf = columns["conf"][chosen]
    begins = np.r_[True, conf[1:] != conf[:-1]] if len(conf) else np.zeros(0, bool)
    stretch = np.cumsum(begins) - 1
    run = np.cumsum(np.r_[True, (run[1:] != run[:-1]) | begins[1:]]) - 1 if len(run) else run
    truth = columns["truth"][chosen] if source.truth else None
    rate = source.rate or 1.0 / float(np.median(np.diff(t[chosen])))
    task = Task(source.inputs, source.targets, _states(source), rate / source.thin, seed)
    whole = Dataset(source, task, X[chosen], y[chosen], t[chosen], run, stretch, conf,
                    np.zeros(len(chosen), bool), truth)
    kept = _every(whole.run, source.thin)
    whole = whole.rows(kept)
    short = _leave_runs_out(_shortened(whole, most_rows))
    if "paper" not in source.tracks:
        return short
    splits = ({name: columns[name][chosen][kept].astype(int) for name in source.held_out}
              or _splits(whole))
    return replace(short, whole=replace(whole, splits=splits))


def _splits(data: Dataset) -> dict[str, NDArray[np.int64]]:
    """The paper's split, a fifth of the rows of each vehicle at random, and blocks of rows."""
    random = np.random.default_rng(data.task.seed)
    drawn, blocks = np.zeros(len(data.t), int), np.zeros(len(data.t), int)
    for vehicle in np.unique(data.vehicle):
        here = np.flatnonzero(data.vehicle == vehicle)
        drawn[random.permutation(here)[:len(here) // LEFT_OUT]] = 1
    try:
        (_, held_out), = BlockSplit("auto").split(data.X, groups=data.vehicle.astype(int))
    except ValueError as error:
        raise data.source.refuse("tracks", f"paper: {error}") from None
    blocks[held_out] = 1
    return {"random": drawn, "blocks": blocks}


def _read(source: Source, place: int) -> dict[str, Any]:
    path = source.paths()[place]
    try:
        log = read_log(path, source.manifest.parent / source.config if source.config else None,
                       frame=False)
    except (ValueError, OSError) as error:
        raise source.refuse("files", str(error)) from None

    def column(key: str, name: str) -> Floats:
        if name not in log:
            raise source.refuse(key, f"'{name}' is no column of {path}; its columns are "
                                + ", ".join(log))
        if log[name].dtype == object:
            raise source.refuse(key, f"column '{name}' of {path} has words; numbers are wanted")
        return log[name]

    X = np.column_stack([column("inputs", name) for name in source.inputs])
    y = np.column_stack([column("targets", name) for name in source.targets])
    rows = len(X)
    time = source.time or log.attrs["time"]
    if time is None and source.rate is None:
        raise source.refuse("time", f"{path} has no known column of the time; give time or rate")
    t = column("time", time) if time else np.arange(rows) / source.rate
    if source.pieces:
        run = np.arange(rows) * source.pieces // max(rows, 1)
    else:
        run = column("run", source.run) if source.run else np.zeros(rows)
    found = {"X": X, "y": y, "t": t, "run": run, "file": np.full(rows, place),
             "conf": (column("configuration", source.configuration) if source.configuration
                      else np.zeros(rows))}
    found |= {name: column("held_out", name) for name in source.held_out}
    if source.truth:
        found["truth"] = np.column_stack([column("truth", name) for name in source.truth])
    return found


def _in_order(t: Floats, run: Floats, file: Any) -> tuple[Floats, Any]:
    """Files one after the other in time; runs numbered through."""
    t = t.astype(float)
    for place in range(1, int(file.max()) + 1 if len(file) else 0):
        last, here = t[file < place].max(), file == place
        t[here] += last + _BETWEEN_FILES_S - t[here].min()
    begins = np.r_[True, (run[1:] != run[:-1]) | (file[1:] != file[:-1])]
    return t, np.cumsum(begins) - 1


def _runs_by_silence(source: Source, t: Floats, run: Any) -> Any:
    if len(t) == 0:
        raise source.refuse("inputs", "no row has all inputs and targets")
    back = np.flatnonzero(np.diff(t) < 0)
    if len(back):
        raise source.refuse("time", f"goes back at row {back[0] + 2}; time never decreases")
    if not source.gap:
        return run
    return np.cumsum(np.r_[True, (np.diff(t) > source.gap) | (np.diff(run) != 0)]) - 1


def _states(source: Source) -> list[int]:
    if source.states:
        if len(source.states) != len(source.targets):
            raise source.refuse("states", f"has {len(source.states)} names for "
                                f"{len(source.targets)} targets; one for each is wanted")
        for name in source.states:
            if name not in source.inputs:
                raise source.refuse("states", f"'{name}' is no input")
        return [source.inputs.index(name) for name in source.states]
    found = [next((i for i, name in enumerate(source.inputs)
                   if target in (f"{name}dot", f"{name}_dot", f"d{name}", f"d_{name}")), -1)
             for target in source.targets]
    return [] if -1 in found else found


def _every(run: Any, step: int) -> NDArray[np.int64]:
    """Every step-th row of each run."""
    first = np.searchsorted(run, run)  # runs are numbered in order
    return np.flatnonzero((np.arange(len(run)) - first) % step == 0)


def _shortened(data: Dataset, most_rows: int) -> Dataset:
    stretches = np.unique(data.stretch)
    # One run of five is left out beside the rows to learn.
    most = int(most_rows * LEFT_OUT / (LEFT_OUT - 1)) // len(stretches)
    kept = np.zeros(len(data.t), bool)
    for stretch in stretches:
        here = np.flatnonzero(data.stretch == stretch)
        runs, sizes = np.unique(data.run[here], return_counts=True)
        share = min(1.0, most / len(here))
        if len(runs) >= _MANY_RUNS:
            wanted = max(LEFT_OUT, round(share * len(runs)))
            chosen = runs[np.unique(np.linspace(0, len(runs) - 1, wanted).round().astype(int))]
            kept[here] = np.isin(data.run[here], chosen)
        else:
            for run, size in zip(runs, sizes):
                rows = here[data.run[here] == run]
                kept[rows[:max(2, int(share * size))]] = True
    return data.rows(kept)


def _leave_runs_out(data: Dataset) -> Dataset:
    left_out = np.zeros(len(data.t), bool)
    for stretch in np.unique(data.stretch):
        runs = np.unique(data.run[data.stretch == stretch])
        if len(runs) < 2:
            raise data.source.refuse(
                "files", "a stretch of one vehicle has a single run, and whole runs are left "
                "out; tell runs by run, gap or pieces")
        out = runs[LEFT_OUT - 1::LEFT_OUT] if len(runs) >= LEFT_OUT else runs[-1:]
        left_out |= np.isin(data.run, out)
    return replace(data, left_out=left_out)


def thinned(data: Dataset, step: int) -> Dataset:
    """The rows to learn at a lower rate: every step-th row of each run."""
    return replace(data.rows(_every(data.run, step)),
                   task=replace(data.task, rate=data.task.rate / step))


def doubled(data: Dataset) -> Dataset:
    """Twice the rate: a row between two rows of a run, by linear interpolation."""
    same = np.flatnonzero(data.run[1:] == data.run[:-1])
    middle = data.rows(same)

    def between(values: Floats) -> Floats:
        return 0.5 * (values[same] + values[same + 1])

    order = np.argsort(np.r_[np.arange(len(data.t)), same + 0.5], kind="stable")
    task = replace(data.task, rate=2.0 * data.task.rate)

    def merged(values: Any, added: Any) -> Any:
        return np.concatenate([values, added])[order]

    return replace(data, task=task, X=merged(data.X, between(data.X)),
                   y=merged(data.y, between(data.y)), t=merged(data.t, between(data.t)),
                   run=merged(data.run, middle.run), stretch=merged(data.stretch, middle.stretch),
                   vehicle=merged(data.vehicle, middle.vehicle),
                   left_out=merged(data.left_out, middle.left_out), truth=None)
