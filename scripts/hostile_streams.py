#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""R² one step ahead, with default settings, on streams made to be hard (docs/accuracy.md).

Usage, from the checkout, after a release build: /usr/bin/python3 scripts/hostile_streams.py [ROWS]
ROWS: identical rows before motion begins (default: a million).
"""

import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "build/release/python"))
import kelpie  # noqa: E402

SAMPLES = 6000
WINDOW = 1000


def motion(inputs, seed):
    """Slow oscillations, three frequencies in each input."""
    random = np.random.default_rng(seed)
    t = np.arange(SAMPLES) * 0.1
    waves = [zip(random.uniform(0.05, 0.8, 3), random.uniform(0.0, 6.0, 3)) for _ in range(inputs)]
    return np.column_stack([sum(np.sin(w * t + p) for w, p in wave) for wave in waves])


def r_squared(truth, predicted):
    spread = ((truth - truth.mean()) ** 2).sum()
    return 1.0 - ((truth - predicted) ** 2).sum() / spread if spread > 0.0 else np.nan


def streams(rows):
    random = np.random.default_rng(1)
    X = motion(4, 3)
    y = X[:, 0] - 0.5 * X[:, 1] * abs(X[:, 1]) + 0.3 * X[:, 2] * X[:, 3]
    yield "noise alone as target", X, random.normal(size=SAMPLES)
    struck = y + 0.05 * random.normal(size=SAMPLES)
    half = random.random(SAMPLES) < 0.5
    struck[half] = 10.0 * random.normal(size=half.sum())
    yield "half of the targets outliers", X, struck
    wide = motion(64, 5)[:4000]
    yield "64 inputs, linear target", wide, wide @ random.normal(size=64)
    yield "64 equal inputs", np.repeat(X[:4000, :1], 64, axis=1), X[:4000, 0]
    growing = X[:3000] * np.exp(np.arange(3000) / 300.0)[:, None]
    yield "inputs growing exponentially", growing, growing[:, 0] - 0.5 * growing[:, 1]
    rest = 1e-3 * random.normal(size=(600, 4))
    yield ("rest, then motion", np.vstack([rest, X]),
           np.concatenate([1e-3 * random.normal(size=600), y]))
    yield (f"{rows:,} identical rows, then motion",
           np.vstack([np.full((rows, 4), 0.1), X]), np.concatenate([np.full(rows, 0.2), y]))


def main():
    rows = int(sys.argv[1]) if len(sys.argv) > 1 else 1_000_000
    print(f"{'stream':40s} {'all':>8s} {'worst ' + str(WINDOW):>12s}")
    for name, X, y in streams(rows):
        decisions = kelpie.OnlineSVR(rate=10.0).partial_fit(X, y).decisions_
        had, said = decisions["had_model"], decisions["predicted"]
        worst = np.inf
        for begin in range(0, len(y) - WINDOW + 1, WINDOW // 4):
            window = slice(begin, begin + WINDOW)
            if had[window].sum() >= WINDOW // 2:
                r2 = r_squared(y[window][had[window]], said[window][had[window]])
                worst = np.fmin(worst, r2)
        print(f"{name:40s} {r_squared(y[had], said[had]):8.3f} {worst:12.3f}", flush=True)


if __name__ == "__main__":
    main()
