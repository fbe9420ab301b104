# SPDX-License-Identifier: Apache-2.0
"""The protocol's tracks: what a learner is shown and asked, and how answers are scored."""

from __future__ import annotations

import inspect
import pickle
import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any, Optional

import numpy as np

from ._data import Dataset, Floats, doubled, r_squared, thinned
from ._entries import Entry

PROTOCOL = 1
BLOCK = 10  # rows of a block, at most
LOOK = 200  # rows learned between two looks of the track paper
POINTS = (50, 100, 200, 500)  # rows after which learners are asked; then as many times ten, …
AFTER_CHANGE = (50, 100, 200, 500, 1000)  # rows after the begin of a stretch
HORIZONS = (1, 10, 50, 100)  # steps in open loop
STARTS = 40  # of each horizon, at most
FIRST_ONE_STEP = 50  # rows before the first answer one step ahead that counts
LEAST = -1.0  # R² are clipped here in means
MOST_ERROR = 10.0  # errors in open loop are clipped here in means
_ALONE = 16  # rows that are asked again one by one


class EntryError(RuntimeError):
    """A learner that broke the contract: shape, an exception, or answers that need other rows."""


class Learner:
    """A learner behind the protocol: copies go in, checked numbers come out, time is counted."""

    def __init__(self, entry: Entry, data: Dataset) -> None:
        self.targets = data.y.shape[1]
        self.learned = self.predicted = 0
        self.learn_s = self.predict_s = 0.0
        self.not_finite = 0  # predictions
        self.model = self._called("the constructor", entry.make, data.task)
        try:
            self._takes_time = "t" in inspect.signature(self.model.partial_fit).parameters
        except (TypeError, ValueError):
            self._takes_time = False

    def learn(self, X: Floats, y: Floats, t: Floats) -> None:
        # Copies, since a view of the stream would show the rows to come.
        given = (X.copy(), y.copy(), t.copy()) if self._takes_time else (X.copy(), y.copy())
        start = time.process_time()
        self._called("partial_fit", self.model.partial_fit, *given)
        self.learn_s += time.process_time() - start
        self.learned += len(X)

    def predict(self, X: Floats, while_learning: bool = False) -> Floats:
        start = time.process_time()
        found = self._called("predict", self.model.predict, X.copy())
        taken = time.process_time() - start
        if while_learning:  # some learners fit when they are asked
            self.learn_s += taken
        else:
            self.predict_s += taken
            self.predicted += len(X)
        found = self._checked("predict", found, (len(X), self.targets))
        self.not_finite += int((~np.isfinite(found).all(axis=1)).sum())
        return found

    def rollout(self, X: Floats, t: Floats) -> Optional[Floats]:
        """Velocities by the learner's own rollout; None where the learner has none."""
        if not callable(getattr(self.model, "rollout", None)):
            return None
        found = self._called("rollout", self.model.rollout, X.copy(), t.copy())
        return None if found is None else self._checked("rollout", found, (len(X), self.targets))

    @staticmethod
    def _called(name: str, function: Callable[..., Any], *given: Any) -> Any:
        try:
            with np.errstate(all="ignore"):
                return function(*given)
        except Exception as error:  # whatever a learner raises
            raise EntryError(f"{name} raised {type(error).__name__}: {error}") from error

    @staticmethod
    def _checked(name: str, found: Any, shape: tuple[int, int]) -> Floats:
        found = np.asarray(found, dtype=float)
        if found.size != shape[0] * shape[1]:
            raise EntryError(f"{name} gave shape {found.shape}; {shape} is wanted")
        return found.reshape(shape)


def points(rows: int, begins: list[int]) -> list[int]:
    """Rows learned at which the learner is asked: 50, 100, 200, 500, 1000, …, those after a change,
    and the end."""
    wanted = {rows}
    step = 1
    while POINTS[0] * step <= rows:
        wanted |= {point * step for point in POINTS if point * step <= rows}
        step *= 10
    for begin, end in zip(begins, [*begins[1:], rows]):
        wanted |= {begin + after for after in AFTER_CHANGE if begin + after <= end}
    return sorted(wanted)


def paper(entry: Entry, data: Dataset) -> dict[str, Any]:
    """Track paper: each split of all rows; R² on held-out rows of the present vehicle."""
    whole = data.whole
    assert whole is not None and whole.splits is not None  # load() made them for this track
    found = []
    for name, marks in whole.splits.items():
        rows, held_out = whole.rows(marks == 0), whole.rows(marks == 1)
        ends = {int(row) for row in np.flatnonzero(np.diff(rows.stretch)) + 1} | {len(rows.t)}
        looks = sorted({*range(LOOK, len(rows.t), LOOK), *ends})
        learner = Learner(entry, whole)
        random = np.random.default_rng(whole.task.seed)
        split: dict[str, Any] = {"name": name, "looks": []}
        at = 0
        for point in [len(rows.t)] if entry.offline else looks:
            while at < point:
                end = point if entry.offline else min(point, at + BLOCK)
                learner.learn(rows.X[at:end], rows.y[at:end], rows.t[at:end])
                at = end
            vehicle = rows.vehicle[at - 1]
            chosen = random.permutation(np.flatnonzero(held_out.vehicle == vehicle))
            r2 = _r2(held_out, chosen, learner.predict(held_out.X[chosen]))
            split["looks"].append({"rows": at, "t": float(rows.t[at - 1]), "vehicle": int(vehicle),
                                   "ends": at in ends, "r2": r2})
        _refuse_neighbours(learner, held_out, chosen)
        split["final"] = clipped(split["looks"][-1]["r2"])
        found.append(split)
    return {"splits": found}


def _r2(data: Dataset, rows: Any, predicted: Floats) -> list[float]:
    return [r_squared(data.y[rows, j], predicted[:, j]) for j in range(data.y.shape[1])]


def clipped(scores: Any) -> float:
    """The mean of R², each at least LEAST; numbers that are not finite count as LEAST."""
    scores = np.asarray(scores, dtype=float)
    return float(np.mean(np.maximum(np.where(np.isfinite(scores), scores, LEAST), LEAST)))


def _questions(data: Dataset, left_out: Dataset) -> dict[int, Any]:
    """By stretch: left-out rows of the present vehicle, in an order that tells nothing."""
    random = np.random.default_rng(data.task.seed)
    present = {int(stretch): left_out.vehicle[left_out.stretch == stretch][0]
               for stretch in np.unique(left_out.stretch)}
    return {stretch: random.permutation(np.flatnonzero(left_out.vehicle == vehicle))
            for stretch, vehicle in present.items()}


def stream(entry: Entry, data: Dataset) -> tuple[Learner, dict[str, Any]]:
    """Tracks anytime and changes: the rows once, in order; R² on left-out runs on the way."""
    rows, left_out = data.rows(~data.left_out), data.rows(data.left_out)
    learner = Learner(entry, data)
    questions = _questions(data, left_out)
    begins = [int(row) for row in np.flatnonzero(np.diff(rows.stretch)) + 1]
    asked = points(len(rows.t), begins)
    found: dict[str, Any] = {"rows": [], "r2": []}
    one_step: list[tuple[int, Floats]] = []
    at = 0
    for point in [len(rows.t)] if entry.offline else asked:
        while at < point:
            end = point if entry.offline else min(point, at + BLOCK)
            if not entry.offline and at >= FIRST_ONE_STEP:
                one_step.append((at, learner.predict(rows.X[at:at + 1], True)[0]))
            learner.learn(rows.X[at:end], rows.y[at:end], rows.t[at:end])
            at = end
        chosen = questions[int(rows.stretch[at - 1])]
        found["rows"].append(at)
        found["r2"].append(_r2(left_out, chosen, learner.predict(left_out.X[chosen])))
    _refuse_neighbours(learner, left_out, questions[int(rows.stretch[-1])])
    found["final"] = clipped(found["r2"][-1])
    found["area"] = None if entry.offline else float(np.mean([clipped(r2) for r2 in found["r2"]]))
    if len(one_step) > 1:
        numbers = [at for at, _ in one_step]
        found["one_step"] = clipped(_r2(rows, numbers, np.array([value for _, value in one_step])))
    return learner, {"anytime": found, "changes": _after_changes(found, begins, asked, entry)}


def _after_changes(found: dict[str, Any], begins: list[int], asked: list[int],
                   entry: Entry) -> Optional[dict[str, Any]]:
    if not begins or entry.offline:
        return None
    at = dict(zip(asked, found["r2"]))
    by_rows = {after: [clipped(at[begin + after]) for begin in begins if begin + after in at]
               for after in AFTER_CHANGE}
    means = {after: float(np.mean(r2)) for after, r2 in by_rows.items() if r2}
    return {"after_rows": list(means), "r2": list(means.values()),
            "mean": float(np.mean(list(means.values()))) if means else None}


def _refuse_neighbours(learner: Learner, left_out: Dataset, chosen: Any) -> None:
    """Answers must be functions of their row: neighbours in time would tell the acceleration."""
    some = chosen[:_ALONE]
    together = learner.predict(left_out.X[some])
    alone = np.vstack([learner.predict(left_out.X[row:row + 1]) for row in some])
    usual = left_out.y.std(axis=0) + 1e-12
    both = np.isfinite(together) & np.isfinite(alone)
    if (np.abs(together - alone) > 1e-6 * (usual + np.abs(alone)))[both].any():
        raise EntryError("predict answers a row differently alone than among other rows; an "
                         "answer must depend on its row only")


def open_loop(entry: Entry, learner: Learner, data: Dataset) -> Optional[dict[str, Any]]:
    """Track open_loop: velocities of left-out runs of the last vehicle, h steps after a start."""
    if not data.task.states:
        return None
    rows = data.rows(data.left_out & (data.vehicle == data.vehicle[-1]))
    states = data.task.states
    velocities = rows.X[:, states]
    usual = velocities.std(axis=0) + 1e-12
    found: dict[str, Any] = {"steps": [], "error": [], "starts": []}
    for steps in HORIZONS:
        starts = _starts(rows, steps)
        if len(starts) == 0:
            continue
        ends = _ends(entry, learner, rows, starts, steps)
        with np.errstate(all="ignore"):
            wrong = np.sqrt(np.mean((ends - velocities[starts + steps]) ** 2, axis=0)) / usual
        found["steps"].append(steps)
        found["starts"].append(len(starts))
        found["error"].append(float(np.mean(np.where(np.isfinite(wrong), wrong, np.inf))))
    return found if found["steps"] else None


def _starts(rows: Dataset, steps: int) -> Any:
    """Rows, evenly over the runs, with a row before and `steps` rows after in the same run."""
    at = np.arange(1, len(rows.t) - steps)
    at = at[(rows.run[at - 1] == rows.run[at]) & (rows.run[at + steps] == rows.run[at])]
    if len(at) == 0:
        return at
    return at[np.unique(np.linspace(0, len(at) - 1, STARTS).round().astype(int))]


def _ends(entry: Entry, learner: Learner, rows: Dataset, starts: Any, steps: int) -> Floats:
    states = rows.task.states
    begin = rows.X[starts][:, states]
    after = (rows.t[starts + steps] - rows.t[starts])[:, None]
    if entry.name == "last-value":
        return begin + after * rows.y[starts - 1]
    own = []
    for start in starts:
        here = slice(start, start + steps + 1)
        velocities = learner.rollout(_without_later(rows.X[here], states), rows.t[here])
        if velocities is None:
            return integrate(learner.predict, rows, starts, steps)
        own.append(velocities[-1])
    return np.array(own)


def _without_later(X: Floats, states: list[int]) -> Floats:
    """The rows with the velocities of the first row, so that none is shown before its time."""
    X = X.copy()
    X[:, states] = X[0, states]
    return X


def integrate(predict: Callable[[Floats], Floats], rows: Dataset, starts: Any,
              steps: int) -> Floats:
    """Velocities after `steps` rows by Heun's method; other inputs come from the log."""
    states = rows.task.states
    X = rows.X[starts].copy()
    for step in range(steps):
        dt = (rows.t[starts + step + 1] - rows.t[starts + step])[:, None]
        velocity, first = X[:, states].copy(), _bounded(predict(X))
        X = rows.X[starts + step + 1].copy()
        X[:, states] = velocity + dt * first
        X[:, states] = velocity + 0.5 * dt * (first + _bounded(predict(X)))
    return X[:, states]


def _bounded(accelerations: Floats) -> Floats:
    """Finite, so that a learner is never asked about rows without numbers."""
    return np.clip(np.nan_to_num(accelerations, nan=1e6, posinf=1e6, neginf=-1e6), -1e6, 1e6)


def _final(entry: Entry, learned: Dataset, asked: Dataset) -> tuple[float, int]:
    """R² on left-out rows of the last vehicle after learning; answers that were not finite."""
    rows, left_out = learned.rows(~learned.left_out), asked.rows(asked.left_out)
    learner = Learner(entry, learned)
    size = len(rows.t) if entry.offline else BLOCK
    for at in range(0, len(rows.t), size):
        learner.learn(rows.X[at:at + size], rows.y[at:at + size], rows.t[at:at + size])
    chosen = _questions(asked, left_out)[int(asked.stretch[-1])]
    score = clipped(_r2(left_out, chosen, learner.predict(left_out.X[chosen])))
    return score, learner.not_finite


def rates(entry: Entry, data: Dataset) -> dict[str, Any]:
    """Track rates: the same drives at a fifth, a half and twice the rate."""
    made = {0.2: thinned(data, 5), 0.5: thinned(data, 2), 2.0: doubled(data)}
    scores = [_final(entry, rows, data)[0] for rows in made.values()]
    return {"times_rate": list(made), "r2": scores}


def hostile(entry: Entry, data: Dataset) -> dict[str, Any]:
    """Track hostile: spoilt rows to learn; left-out rows are sound."""
    found: dict[str, Any] = {"kinds": list(SPOILT), "r2": [], "not_finite": 0}
    for name, spoil in SPOILT.items():
        random = np.random.default_rng([data.task.seed, len(name)])
        X, y = data.X.copy(), data.y.copy()
        learned = np.flatnonzero(~data.left_out)
        rows_X, rows_y = X[learned], y[learned]
        spoil(random, rows_X, rows_y, data.task.states)
        X[learned], y[learned] = rows_X, rows_y
        score, not_finite = _final(entry, replace(data, X=X, y=y), data)
        found["r2"].append(score)
        found["not_finite"] += not_finite
    found["mean"] = float(np.mean(found["r2"]))
    return found


def _stretches(random: Any, rows: int, length: int, share: float) -> list[slice]:
    count = max(1, int(share * rows / length))
    return [slice(at, at + length) for at in random.integers(60, max(61, rows - length), count)]


def _spikes(random: Any, X: Floats, y: Floats, states: list[int]) -> None:
    """2 % of the targets are off by up to 50 standard deviations."""
    hit = random.random(y.shape) < 0.02
    y[hit] += (random.uniform(-50, 50, y.shape) * y.std(axis=0))[hit]


def _bursts(random: Any, X: Floats, y: Floats, states: list[int]) -> None:
    """5 % of the targets, in bursts of 20 rows, are off by +30 standard deviations."""
    shift = 30.0 * y.std(axis=0)
    for here in _stretches(random, len(y), 20, 0.05):
        y[here] += shift


def _stuck(random: Any, X: Floats, y: Floats, states: list[int]) -> None:
    """10 % of the rows, in stretches of 20, repeat the inputs of the stretch's first row."""
    for here in _stretches(random, len(X), 20, 0.1):
        X[here] = X[here.start]


def _dropouts(random: Any, X: Floats, y: Floats, states: list[int]) -> None:
    """10 % of the rows, in stretches of 10, are zero: inputs and targets."""
    for here in _stretches(random, len(X), 10, 0.1):
        X[here], y[here] = 0.0, 0.0


def _garbage(random: Any, X: Floats, y: Floats, states: list[int]) -> None:
    """20 rows in the midst have inputs and targets of a size of 1e6."""
    here = slice(len(X) // 2, len(X) // 2 + 20)
    X[here], y[here] = (1e6 * random.standard_normal(values[here].shape) for values in (X, y))


SPOILT = {"spikes": _spikes, "bursts": _bursts, "stuck": _stuck, "dropouts": _dropouts,
          "garbage": _garbage}


def cost(learner: Learner) -> dict[str, Any]:
    """Track cost, after stream(): time of the process per row, and the size of a pickle.

    An update is a row learned with its share, a tenth, of an answer one step ahead.
    """
    try:
        size: Optional[int] = len(pickle.dumps(learner.model))
    except Exception:  # a learner need not be able to
        size = None
    return {"update_us": 1e6 * learner.learn_s / max(learner.learned, 1),
            "predict_us": 1e6 * learner.predict_s / max(learner.predicted, 1),
            "pickle_bytes": size, "not_finite": learner.not_finite}
