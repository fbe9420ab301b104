# SPDX-License-Identifier: Apache-2.0
"""Draws the figures of a page of kelpie's with Matplotlib, for papers and slides.

    /usr/bin/python3 examples/09_figures_for_papers.py out/learn/report.html --out figures --format pdf

prints, and writes to `figures/`, a file per figure: 01_udot_every_sample_as_measured_and_as.pdf and
so on. --only 1,4 draws some of them, --from and --to a part of the x axis. The numbers are those of
the page (src/tools/chart/README.md): every sample, which result.json doesn't hold.
Wants Matplotlib and NumPy (Debian: python3-matplotlib).
"""

import argparse
import base64
import html.parser
import json
import re
import zlib
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

COLOURS = ["#0055a4", "#ce4008", "#0a8369", "#b202ab", "#5a4300", "#1d4a56", "#1c2126"]
DASHES = ["-", "--", ":", "-.", (0, (5, 2, 1, 2, 1, 2)), (0, (12, 5)), (0, (4, 4))]
MARKERS = ["o", "x", "s", "^", "D", "+", "v"]


class Descriptions(html.parser.HTMLParser):
    """The figures' descriptions in a page."""

    def __init__(self) -> None:
        super().__init__()
        self.found: list[dict] = []
        self.inside = False

    def handle_starttag(self, tag, attrs) -> None:
        self.inside = tag == "script" and ("type", "application/json") in attrs

    def handle_endtag(self, tag) -> None:
        self.inside = False

    def handle_data(self, data) -> None:
        if self.inside:
            self.found.append(json.loads(data))


def columns_of(figure: dict) -> list[np.ndarray]:
    """The numbers: steps from one to the next, all lowest bytes first, compressed."""
    packed = np.frombuffer(zlib.decompress(base64.b64decode(figure["data"])), dtype=np.uint8)
    columns, at = [], 0
    for column in figure["columns"]:
        n, width = column["n"], column["width"]
        planes = packed[at:at + n * width].reshape(width, n).astype(np.uint64)
        at += n * width
        steps = sum(plane << np.uint64(8 * place) for place, plane in enumerate(planes))
        last = 2 ** (8 * width) - 1
        codes = np.cumsum(steps) % np.uint64(last + 1)
        values = column["low"] + (column["high"] - column["low"]) * codes / (last - 1)
        columns.append(np.where(codes == last, np.nan, values))
    return columns


def draw(figure: dict, shown: tuple) -> plt.Figure:
    drawing, axes = plt.subplots(figsize=(5, 4) if figure.get("square") else (7, 2.6),
                                 layout="constrained")
    columns = columns_of(figure)
    for series in figure["series"]:
        x, y = columns[series["x"]], columns[series["y"]]
        style = series["style"] % len(COLOURS)
        name = series["name"] or None
        if series["kind"] == "band":
            half = columns[series["half"]]
            axes.fill_between(x, y - half, y + half, color=COLOURS[style], alpha=0.24, lw=0,
                              label=name)
        elif series["kind"] == "bars":
            edges = np.diff(np.log(x) if figure["x"]["log"] else x)
            step = edges.min() if len(edges) else 0.1
            width = x * 2 * np.sinh(step / 2) if figure["x"]["log"] else step
            axes.bar(x, y, width=0.96 * width, color=COLOURS[style], label=name)
        elif series["kind"] == "points":
            axes.plot(x, y, "." if series.get("small") else MARKERS[style],
                      ms=2 if series.get("small") else 4, mfc="none", color=COLOURS[style],
                      label=name)
        else:
            axes.plot(x, y, linestyle=DASHES[style], color=COLOURS[style], lw=1, label=name)
    for mark in figure["marks"]:
        axes.axvline(mark["x"], color=COLOURS[6], lw=0.7, ls="--")
        axes.annotate(mark["name"], (mark["x"], 1), xycoords=("data", "axes fraction"),
                      fontsize=6, ha="center", va="bottom")
    for x0, y0, x1, y1 in figure["guides"]:
        axes.plot([x0, x1], [y0, y1], "--", color=COLOURS[6], lw=0.7)
    for axis, of in (("x", figure["x"]), ("y", figure["y"])):
        axes.set(**{f"{axis}label": of["label"], f"{axis}scale": "log" if of["log"] else "linear"})
        if of["log"]:
            getattr(axes, f"{axis}axis").set_major_formatter(lambda value, _: f"{value:g}")
        if "range" in of:
            axes.set(**{f"{axis}lim": of["range"]})
    if "names" in figure["x"]:
        axes.set_xticks(range(len(figure["x"]["names"])), figure["x"]["names"])
    axes.set_xlim(*shown)
    axes.grid(alpha=0.3)
    axes.legend(fontsize=7, loc="upper left", bbox_to_anchor=(1, 1), frameon=False)
    return drawing


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("page", type=Path)
    arguments.add_argument("--out", type=Path, default=Path("figures"))
    arguments.add_argument("--format", choices=["pdf", "svg", "png"], default="pdf")
    arguments.add_argument("--only", help="numbers of figures, as in 1,4")
    arguments.add_argument("--from", type=float, dest="first", help="least x")
    arguments.add_argument("--to", type=float, dest="last", help="greatest x")
    options = arguments.parse_args()
    page = Descriptions()
    page.feed(options.page.read_text(encoding="utf-8"))
    wanted = {int(number) for number in options.only.split(",")} if options.only else None
    plt.rcParams["text.parse_math"] = False  # names of a log aren't formulas
    options.out.mkdir(parents=True, exist_ok=True)
    for number, figure in enumerate(page.found, 1):
        if wanted is None or number in wanted:
            words = re.findall(r"[A-Za-z0-9]+", figure["label"])[:8]
            file = options.out / f"{number:02}_{'_'.join(words).lower()[:60]}.{options.format}"
            drawing = draw(figure, (options.first, options.last))
            drawing.savefig(file, dpi=200)
            plt.close(drawing)
            print(file)


if __name__ == "__main__":
    main()
