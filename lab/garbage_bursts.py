#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Bursts of garbage in streams of simulated vehicles: what a burst costs a minute after its end.

    lab/garbage_bursts.py OUT [--draws 139] [--base 4242] [--set learner=posterior ...]

Draw k has the seed base + k: a vehicle of random_vehicles.py at 1 to 20 Hz; garbage of 1 to 30 s
from the first row on (three draws of ten) or later, in inputs, targets, both, or one axis; as noise
of 10 to 10^6 deviations, units (times 1,000), degrees for radians, signs, an offset of 8 deviations,
a drift, or frozen values. Another model learns the rows without the burst. The last four draws are
named: a unit switched for 20 s, targets 8 deviations off in the first 12 s, 12 s of commands at 10^6
deviations, 7 s of garbage at the start.

Prints per draw R² of the later rows, a minute after the burst, without the burst and with, and
counts predictions in this minute beyond all true targets by more than a tenth of their range.
Writes OUT/bursts.json. Wants numpy and the Python module (PYTHONPATH=build/release/python).
"""
import argparse
import json
from pathlib import Path

import kelpie
import numpy as np
from random_vehicles import NAMES, TARGETS, Vehicle

KINDS = "noise", "units", "degrees", "signs", "offset", "drift", "frozen"
PLACES = "inputs", "targets", "both", "axis"
AFTER_S, MOST_RATE, LATEST_S = 60, 20, 200
NAMED = {"a unit switched": (100, 20), "8 deviations at the start": (0, 12),
         "commands at 1e6 deviations": (100, 12), "garbage at the start": (0, 7)}


def spoilt(random, kind, values, columns, mean, deviation):
    """A copy of the rows of a burst with garbage in these columns."""
    values = values.copy()
    size, slope = 10 ** random.uniform(1, 6), random.uniform(1, 10)
    ramp = np.linspace(0, 1, len(values))
    for i in columns:
        column = values[:, i]
        values[:, i] = {"noise": size * deviation[i] * random.normal(size=len(values)),
                        "units": 1000 * column, "degrees": 180 / np.pi * column,
                        "signs": -column, "offset": mean[i] + 8 * deviation[i],
                        "drift": column + slope * deviation[i] * ramp,
                        "frozen": column[0]}[kind]
    return values


def named(random, name, rows, inputs, mean, deviation):
    rows = rows.copy()
    if name == "a unit switched":
        rows[:, [0, inputs]] *= 1000
    elif name == "8 deviations at the start":
        rows[:, inputs:] = (mean + 8 * deviation)[inputs:]
    elif name == "commands at 1e6 deviations":
        rows[:, len(NAMES):inputs] = 1e6 * deviation[len(NAMES):inputs]
    else:
        rows = 1e4 * deviation * random.normal(size=rows.shape)
    return rows


def vehicle_for(random, needed_s):
    while True:
        vehicle = Vehicle(int(random.integers(1 << 30)))
        if vehicle.rate <= MOST_RATE and vehicle.rows / vehicle.rate > needed_s:
            return vehicle


def draw(seed, name):
    """Rate, rows, rows with the burst, the burst's slice, number of inputs, and a description."""
    random = np.random.default_rng(seed)
    kind = KINDS[seed % len(KINDS)]
    place = PLACES[random.integers(len(PLACES))]
    length_s = float(np.exp(random.uniform(0, np.log(30))))
    first_s = 0.0 if random.random() < .3 else float(random.uniform(5, LATEST_S))
    if name:
        first_s, length_s = NAMED[name]
    vehicle = vehicle_for(random, LATEST_S + 30 + AFTER_S + 100)
    rows = vehicle.log(changes=False)
    inputs, axis = len(NAMES) + vehicle.thrusters, random.integers(len(TARGETS))
    first = int(first_s * vehicle.rate)
    burst = slice(first, first + max(1, int(length_s * vehicle.rate)))
    mean, deviation = rows.mean(0), rows.std(0) + 1e-12
    columns = {"inputs": range(inputs), "targets": range(inputs, rows.shape[1]),
               "both": range(rows.shape[1]), "axis": (axis, inputs + axis)}[place]
    garbage = rows.copy()
    garbage[burst] = (named(random, name, rows[burst], inputs, mean, deviation) if name else
                      spoilt(random, kind, rows[burst], columns, mean, deviation))
    what = f"{name or f'{kind} in {place}'}, {length_s:.0f} s at {first_s:.0f} s"
    return vehicle.rate, rows, garbage, burst, inputs, what


def measure(seed, name, settings):
    rate, rows, garbage, burst, inputs, what = draw(seed, name)
    names = NAMES + [f"c{k}" for k in range(inputs - len(NAMES))]
    end = burst.stop + int(AFTER_S * rate)
    times = np.arange(len(rows)) / rate
    later = rows[end:end + max(int(100 * rate), 400)]
    with_burst, without = (kelpie.DynamicsModel(inputs=names, targets=TARGETS, rate=rate,
                                                **settings) for _ in range(2))

    def learn(model, source, first, last):
        model.partial_fit(source[first:last, :inputs], source[first:last, inputs:],
                          times[first:last])

    def r2(model):
        errors = later[:, inputs:] - model.predict(later[:, :inputs])
        return 1 - (errors**2).sum(0) / ((later[:, inputs:] - later[:, inputs:].mean(0))**2).sum(0)

    if burst.start > 0:
        learn(without, rows, 0, burst.start)
    learn(without, rows, burst.stop, end)
    learn(with_burst, garbage, 0, end)
    said = with_burst.decisions_["predicted"][burst.stop:]
    seen = rows[:end, inputs:]
    margin = .1 * np.ptp(seen, axis=0)
    beyond = int(((said < seen.min(0) - margin) | (said > seen.max(0) + margin)).sum())
    return {"seed": seed, "burst": what, "rate": rate, "without": r2(without).tolist(),
            "with": r2(with_burst).tolist(), "beyond": beyond}


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("out", type=Path)
    parser.add_argument("--draws", type=int, default=139)
    parser.add_argument("--base", type=int, default=4242)
    parser.add_argument("--set", nargs="*", default=[], metavar="KEY=VALUE", dest="settings")
    arguments = parser.parse_args()
    settings = dict(one.split("=", 1) for one in arguments.settings)
    names = [None] * max(0, arguments.draws - len(NAMED)) + list(NAMED)
    arguments.out.mkdir(parents=True, exist_ok=True)
    found = []
    for seed, name in enumerate(names[-arguments.draws:], arguments.base):
        one = measure(seed, name, settings)
        one["loss"] = float(np.max(np.subtract(one["without"], one["with"])))
        found.append(one)
        print(f"{seed} {one['burst']:42s} {one['rate']:5.1f} Hz  ", "  ".join(
            f"{with_burst:7.3f} ({without:.3f})"
            for with_burst, without in zip(one["with"], one["without"])),
            f"  beyond {one['beyond']}", flush=True)
    losses = np.array([one["loss"] for one in found])
    table = {"draws": len(found), "share_within_.015": float(np.mean(losses <= .015)),
             "share_within_.1": float(np.mean(losses <= .1)), "worst": float(losses.max()),
             "draws_beyond": int(sum(one["beyond"] > 0 for one in found))}
    (arguments.out / "bursts.json").write_text(json.dumps({**table, "bursts": found}, indent=1))
    print(f"{len(found)} bursts: {100 * table['share_within_.015']:.0f} % lose at most 0.015, "
          f"{100 * table['share_within_.1']:.0f} % at most 0.1, worst {table['worst']:.3f}; "
          f"{table['draws_beyond']} with predictions beyond what was seen")


if __name__ == "__main__":
    main()
