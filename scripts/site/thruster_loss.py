#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Draws docs/images/thruster_loss.gif: a simulated vehicle loses two fifths of a thruster.

A real run of the learner over scenarios/diagnosis.toml, row by row: what was predicted of the surge
acceleration before each row was learned, its 90 % interval, and the finding at that moment.
Needs the Python module, matplotlib and Pillow:

    PYTHONPATH=build/release/python python3 scripts/site/thruster_loss.py build/release/kelpie
"""

import io
import subprocess
import sys
import tempfile
from pathlib import Path

import kelpie
import matplotlib
import numpy as np
from PIL import Image

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402  after the choice of the canvas

ROOT = Path(__file__).resolve().parents[2]
CHANGE_S, FIRST_S, LAST_S, WINDOW_S = 1500.0, 1490.0, 1545.0, 25.0
INPUTS, TARGETS = ["u", "v", "r", "th1", "th2", "th3"], ["udot", "vdot", "rdot"]


def run(command):
    """Time, measured, predicted, ends of the interval and finding of each row shown."""
    with tempfile.TemporaryDirectory() as folder:
        log = Path(folder) / "dive.csv"
        subprocess.run([command, "simulate", ROOT / "scenarios/diagnosis.toml", "--out", log],
                       check=True, capture_output=True)
        rows = kelpie.read_log(log)
    X, y, t = rows[INPUTS].to_numpy(), rows[TARGETS].to_numpy(), rows["t"].to_numpy()
    model = kelpie.DynamicsModel(inputs=INPUTS, targets=TARGETS)
    begin = int(np.searchsorted(t, FIRST_S - WINDOW_S))
    model.partial_fit(X[:begin], y[:begin], t[:begin])
    told = []
    for i in range(begin, int(np.searchsorted(t, LAST_S))):
        model.partial_fit(X[i:i + 1], y[i:i + 1], t[i:i + 1])
        row = model.decisions_[0]
        findings = model.diagnosis_["findings"]
        told.append((t[i], y[i, 0], row["predicted"][0], row["lower"][0], row["upper"][0],
                     findings[-1]["text"] if findings else "no change of the vehicle"))
    return told


def picture(told, now):
    """The window that ends at row `now`."""
    most = 1.15 * max(abs(row[1]) for row in told)
    end = told[now][0]
    shown = [row for row in told[:now + 1] if row[0] > end - WINDOW_S]
    time, measured, predicted, lower, upper = (np.array(column) for column in list(zip(*shown))[:5])
    figure, axes = pyplot.subplots(figsize=(7.0, 3.3), dpi=80)
    axes.fill_between(time, lower, upper, color="#cde3f0", label="90 % interval")
    axes.plot(time, measured, color="#444444", lw=2.5, label="measured")
    axes.plot(time, predicted, color="#cc5500", lw=1.5, label="predicted one step ahead")
    if end > CHANGE_S > end - WINDOW_S:
        axes.axvline(CHANGE_S, color="#777777", ls=":")
        axes.text(CHANGE_S, 0.95 * most, " th2 loses 40 %", va="top", fontsize=9)
    axes.set(xlim=(end - WINDOW_S, end), ylim=(-most, most), xlabel="time [s]",
             ylabel="surge acceleration [m/s²]")
    axes.set_title(told[now][5], loc="left", fontsize=10)
    figure.legend(loc="lower right", ncols=3, fontsize=8, frameon=False)
    figure.tight_layout(rect=(0, 0.04, 1, 1))
    data = io.BytesIO()
    figure.savefig(data)
    pyplot.close(figure)
    return Image.open(data).convert("RGB")


def main(command):
    told = run(command)
    first = next(i for i, row in enumerate(told) if row[0] >= FIRST_S)
    frames = [picture(told, now) for now in range(first, len(told), 4)]
    colours = frames[len(frames) // 2].quantize(16, dither=Image.Dither.NONE)
    frames = [frame.quantize(palette=colours, dither=Image.Dither.NONE) for frame in frames]
    target = ROOT / "docs/images/thruster_loss.gif"
    frames[0].save(target, save_all=True, append_images=frames[1:], duration=160, loop=0,
                   optimize=True)
    for text in dict.fromkeys(row[5] for row in told):
        print(next(row[0] for row in told if row[5] == text), text)
    print(f"{target}: {len(frames)} pictures, {target.stat().st_size / 1000:.0f} kB")


if __name__ == "__main__":
    main(sys.argv[1])
