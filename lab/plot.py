#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Draws a picture of a JSON file that kelpie-lab writes: control, dead-reckoning, diagnose.

    lab/plot.py out/control/control.json [control.png]

Without a second name the picture stands beside the file. Needs python3-matplotlib.
"""
import json
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

# Okabe and Ito: colours that colour-blind readers tell apart, and line styles for paper.
COLOURS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000"]
plt.rcParams["axes.prop_cycle"] = plt.cycler(
    color=COLOURS, linestyle=["-", "--", "-.", ":", (0, (5, 1)), (0, (3, 1, 1, 1)), "-"])


def grid(count, columns=2, width=5.5, height=3.6):
    """A figure with at least `count` axes, those beyond it empty."""
    rows = max(1, -(-count // columns))
    figure, axes = plt.subplots(rows, columns, figsize=(width * columns, height * rows),
                                squeeze=False, layout="constrained")
    axes = axes.ravel().tolist()
    for spare in axes[count:]:
        spare.set_axis_off()
    return figure, axes


def finish(axes, title, x, y, log=""):
    axes.set_title(title, fontsize="medium")
    axes.set_xlabel(x)
    axes.set_ylabel(y)
    if "x" in log:
        axes.set_xscale("log")
    if "y" in log:
        axes.set_yscale("log")
    axes.grid(True, alpha=0.3)
    if axes.get_legend_handles_labels()[0]:
        axes.legend(fontsize="small")


def draw_control(data):
    figure, axes = grid(len(data["cases"]))
    for place, case in zip(axes, data["cases"]):
        for controller in case["controllers"]:
            place.plot(controller["time_s"], controller["error_m"], label=controller["name"])
        place.axvline(data["settle_s"] + data["before_s"], color="gray", linewidth=0.8)
        finish(place, f"{case['path']}, {case['mishap']} (simulation, seed {data['first_seed']})",
               "time [s]", "distance to the reference [m]")
    return figure


def draw_reckoning(data):
    figure, axes = grid(len(data["logs"]), columns=min(2, max(1, len(data["logs"]))))
    for place, log in zip(axes, data["logs"]):
        for navigator, marker in zip(log["navigators"], "osD^vx*"):
            outages = [o for o in navigator["outages"] if o["median"] is not None]
            place.plot([o["seconds"] for o in outages], [o["median"] for o in outages],
                       marker=marker, label=navigator["name"])
        simulated = " (simulation)" if log["simulated"] else ""
        source = log["source"] if simulated else Path(log["source"]).name  # "0.1 m/s" is no path
        finish(place, f"{source}{simulated}\nheld out: {log['split']}",
               "length of the outage [s]", "position error / distance, median", "xy")
        seconds = sorted({o["seconds"] for n in log["navigators"] for o in n["outages"]})
        place.set_xticks(seconds, [f"{one:g}" for one in seconds])
        place.set_xticks([], minor=True)
    return figure


def draw_diagnosis(data):
    figure, (delays, sizes, confusion, spare) = grid(4, height=5.0)
    spare.set_axis_off()
    single = [run for run in data["runs"] if run["effect"] > 0 and not run["special"]]
    for effect in (20, 40, 60, 80):
        runs = [run for run in single if run["effect"] == effect]
        named = sorted(run["named_after_s"] for run in runs if run["right"])
        delays.step(named, [100.0 * (i + 1) / len(runs) for i in range(len(named))],
                    where="post", label=f"effect {effect} %")
    finish(delays, "Single causes by strength", "time since the change [s]", "named rightly [%]")
    kinds = sorted({run["kind"] for run in single})
    for i, kind in enumerate(kinds):
        zero = 0.0 if kind in ("force", "sensor_bias") else 1.0
        runs = [run for run in single
                if run["kind"] == kind and run["right"] and run["same_place"]]
        sizes.plot([run["effect"] + 2.0 * (i - len(kinds) / 2) for run in runs],
                   [100.0 * (run["size"] - zero) / (run["truth"] - zero) for run in runs],
                   "osv^D<>"[i % 7], linestyle="none", markersize=4, label=kind)
    finish(sizes, "Sizes of the runs named rightly", "effect [%]", "size told / truth [%]")
    sizes.legend(fontsize="small", loc="center left", bbox_to_anchor=(1.0, 0.5))
    cases = list(dict.fromkeys(run["case"] for run in data["runs"]))
    words = sorted({run["said"] for run in data["runs"]})
    counts = [[sum(run["case"] == case and run["said"] == word for run in data["runs"])
               for word in words] for case in cases]
    picture = confusion.imshow(counts, aspect="auto", cmap="cividis")
    confusion.set_xticks(range(len(words)), words, rotation=90, fontsize=6)
    confusion.set_yticks(range(len(cases)), cases, fontsize=6)
    figure.colorbar(picture, ax=confusion, label="runs")
    confusion.set_title("The change (rows) and the diagnosis (columns)", fontsize="medium")
    return figure


DRAW = {"kelpie-control": draw_control, "kelpie-reckoning": draw_reckoning,
        "kelpie-diagnosis": draw_diagnosis}


def main(arguments):
    if len(arguments) not in (1, 2):
        sys.exit(__doc__)
    source = Path(arguments[0])
    try:
        data = json.loads(source.read_text(encoding="utf-8"))
        draw = DRAW[data["format"]]
    except (OSError, ValueError, KeyError, TypeError) as error:
        sys.exit(f"{source}: is no JSON file of kelpie-lab's {', '.join(DRAW)}: {error}")
    picture = Path(arguments[1]) if len(arguments) == 2 else source.with_suffix(".png")
    draw(data).savefig(picture, dpi=110)
    print(picture)


if __name__ == "__main__":
    main(sys.argv[1:])
