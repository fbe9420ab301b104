#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Learns AUV Dagon's accelerations row by row, as it drove, and plots the progress.

    PYTHONPATH=build/release/python /usr/bin/python3 examples/06_learning_on_dagon.py [LOG.csv]

The log defaults to $KELPIE_DATA_DIR/dagon_config1.csv or ../shared/data/dagon_config1.csv or, if
neither exists, to out/simulated_dagon.csv; make that with

    build/release/kelpie simulate scenarios/small.toml --out out/simulated_dagon.csv

Editors that know cells (# %%) run it step by step.
"""

# %% Inputs, targets, and how the log is split
from __future__ import annotations

import argparse
import os
from pathlib import Path

import kelpie  # first: it says which Python has what is needed

import matplotlib.pyplot as plt
import numpy as np

INPUTS = ["u", "v", "r", "th1", "th2", "th3"]  # m/s, m/s, rad/s, rev/s of three thrusters
TARGETS = {"udot": ("surge", "m/s²"), "vdot": ("sway", "m/s²"), "rdot": ("yaw", "rad/s²")}
RATE_HZ = 4.0
BLOCK = 400  # rows; the last of every five blocks is held out, as by `kelpie learn --split blocks`
LOOK_EVERY = 200  # training rows between two scores on the held-out ones
SHOWN_S = 60.0
BLUE, ORANGE, GREEN, GREY = "#0072B2", "#D55E00", "#009E73", "#555555"
LINES = {"surge": (BLUE, "-"), "sway": (ORANGE, "--"), "yaw": (GREEN, "-.")}
TERM_LINES = [(BLUE, "-"), (ORANGE, "--"), (GREEN, "-."), ("#CC79A7", ":"), ("#000000", "-")]


def find_log(named: str | None) -> Path:
    """The given log, or the first that exists."""
    root = Path(__file__).resolve().parents[1]
    folders = [Path(os.environ.get("KELPIE_DATA_DIR", root)), root.parent / "shared" / "data"]
    places = [Path(named)] if named else [*(folder / "dagon_config1.csv" for folder in folders),
                                          root / "out" / "simulated_dagon.csv"]
    for place in places:
        if place.is_file():
            return place
    raise SystemExit(f"No log: looked for {', '.join(map(str, places))} (see the file's top).")


def read_log(file: Path) -> tuple[np.ndarray, np.ndarray]:
    """Inputs (n, 6) and targets (n, 3) in the log's units."""
    table = np.genfromtxt(file, delimiter=",", names=True)
    return tuple(np.column_stack([table[name] for name in names]) for names in (INPUTS, TARGETS))


def r_squared(truth: np.ndarray, found: np.ndarray) -> np.ndarray:
    """R² of every column."""
    spread = ((truth - truth.mean(axis=0)) ** 2).sum(axis=0)
    return 1.0 - ((truth - found) ** 2).sum(axis=0) / spread


parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
parser.add_argument("log", nargs="?")
parser.add_argument("--out", default="learning_on_dagon.png", help="the figure (PNG)")
options = parser.parse_args()

# %% The log, and its held-out rows
log_file = find_log(options.log)
X, y = read_log(log_file)
t = np.arange(len(X)) / RATE_HZ
held_out = np.arange(len(X)) // BLOCK % 5 == 4
training = np.flatnonzero(~held_out)

# %% The stream: every row is first predicted, then learned
model = kelpie.DynamicsModel(inputs=INPUTS, targets=list(TARGETS), rate=RATE_HZ)
decisions, looks = [], []
for rows in np.array_split(training, np.arange(LOOK_EVERY, len(training), LOOK_EVERY)):
    model.partial_fit(X[rows], y[rows], t[rows])
    decisions.append(model.decisions_)
    looks.append((t[rows[-1]], r_squared(y[held_out], model.predict(X[held_out])), model.coef_))
decisions = np.concatenate(decisions)
look_t, look_r2, look_coef = (np.array(column) for column in zip(*looks))

# %% The results
late = decisions["had_model"].all(axis=1)
inside = (decisions["lower"] <= y[training]) & (y[training] <= decisions["upper"])
ahead = r_squared(y[training][late], decisions["predicted"][late])
print(f"{log_file.name}: {len(X)} rows, {len(training)} learned, {held_out.sum()} held out")
print("axis   R² held out   R² one step ahead   inside the 90 % interval")
for i, (name, _) in enumerate(TARGETS.values()):
    print(f"{name:<5}  {look_r2[-1, i]:11.3f}   {ahead[i]:17.3f}   {inside[late, i].mean():22.1%}")
for i, (name, _) in enumerate(TARGETS.values()):
    changed = t[training][decisions["changed"][:, i]]
    if changed.size:
        print(f"{name}: the vehicle was found to have changed at {changed.round().tolist()} s")


# %% The figure
def draw_stream(axes: plt.Axes, i: int) -> None:
    """The last minute of the stream: measured, predicted, and the interval."""
    rows = training[t[training] > t[training[-1]] - SHOWN_S]
    shown = decisions[-len(rows):, i]
    name, unit = list(TARGETS.values())[i]
    axes.fill_between(t[rows], shown["lower"], shown["upper"], color=BLUE, alpha=0.2, lw=0,
                      label="90 % interval")
    axes.plot(t[rows], y[rows, i], color=GREY, lw=2.5, label="measured")
    axes.plot(t[rows], shown["predicted"], color=ORANGE, lw=1.2, label="predicted one step ahead")
    axes.set(xlabel="time [s]", ylabel=f"{name} acceleration [{unit}]",
             title="The last minute of the stream")
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.2), ncol=3, frameon=False)


def draw_accuracy(axes: plt.Axes) -> None:
    """R² on the held-out rows while the model learns."""
    for i, (name, _) in enumerate(TARGETS.values()):
        color, style = LINES[name]
        axes.plot(look_t, look_r2[:, i], color=color, ls=style, label=name)
    axes.set(xlabel="time [s]", ylabel="R² on held-out rows [–]",
             ylim=(min(0.0, look_r2[3:].min()), 1.0),
             title=f"{held_out.sum()} held-out rows")
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.2), ncol=3, frameon=False)


def draw_coefficients(axes: plt.Axes, i: int) -> None:
    """What some physics terms of usual size (root mean square) add to the prediction."""
    name, unit = list(TARGETS.values())[i]
    _, _, r, th1, th2, th3 = X[training].T
    terms = {"r": r, "r*|r|": r * np.abs(r), "th1*|th1|": th1 * np.abs(th1),
             "th2*|th2|": th2 * np.abs(th2), "th3*|th3|": th3 * np.abs(th3)}
    for (term, values), (color, style) in zip(terms.items(), TERM_LINES):
        effect = look_coef[:, i, model.terms_.index(term)] * np.sqrt(np.mean(values**2))
        axes.plot(look_t, effect, color=color, ls=style, label=term)
    axes.axhline(0.0, color=GREY, lw=0.5)
    axes.set(xlabel="time [s]", ylabel=f"effect on {name} [{unit}]",
             title="Physics terms: coefficient · RMS of the term")
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.2), ncol=len(terms), frameon=False)


figure, panels = plt.subplots(3, 1, figsize=(9, 12))
draw_stream(panels[0], 2)
draw_accuracy(panels[1])
draw_coefficients(panels[2], 2)
figure.suptitle(f"kelpie {kelpie.__version__} learning {log_file.name}")
figure.tight_layout(rect=(0, 0, 1, 0.99))
figure.savefig(options.out, dpi=110)
print(f"picture: {options.out}")
