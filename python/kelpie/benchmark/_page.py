# SPDX-License-Identifier: Apache-2.0
"""The results as a static page, and as a table for a terminal."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from html import escape
from typing import Any, Optional

import numpy as np

from ._tracks import HORIZONS, LEAST, MOST_ERROR

_SHOWN = ("kelpie", "least-squares", "rls-0.999", "gp-window", "forest-window", "sgd")  # curves


class Column:
    """A figure of every entry on every data set of a track, and its mean over data sets."""

    def __init__(self, name: str, track: str, value: Callable[[dict[str, Any]], Any],
                 worst: float = LEAST, digits: int = 3, short: str = "", mean: bool = True) -> None:
        self.name, self.track, self.value = name, track, value
        self.worst, self.digits, self.short = worst, digits, short or name
        self.over: Callable[[Any], Any] = np.mean if mean else np.median
        self.is_error = worst > 0

    def cells(self, results: dict[str, Any]) -> dict[tuple[str, str], float]:
        """By entry and data set; entries that failed have the worst where others have a figure."""
        found, failed = {}, []
        for result in results["results"]:
            pair = (result["entry"], result["data"])
            if "failed" in result:
                failed.append(pair)
            elif (value := self._figure(result)) is not None:
                found[pair] = min(value, self.worst) if self.is_error else max(value, self.worst)
        asked = {data for _, data in found}
        worst = {pair: self.worst for pair in failed if pair[1] in asked}
        return found | (worst if math.isfinite(self.worst) else {})

    def _figure(self, result: dict[str, Any]) -> Optional[float]:
        found = result.get(self.track)
        value = None if found is None else self.value(found)
        if value is None and self.track == "open_loop" and found is not None:
            # A number that was not finite is null in JSON.
            return None if _step(found, self.name) is None else self.worst
        return value

    def text(self, value: Optional[float]) -> str:
        if value is None:
            return "–"
        if self.is_error and value >= self.worst and math.isfinite(self.worst):
            return f"≥ {self.worst:g}"
        text = f"{value:,.{self.digits}f}"
        return text.lstrip("-") if float(text.replace(",", "")) == 0.0 else text.replace("-", "−")


def _step(found: dict[str, Any], name: str) -> Optional[int]:
    steps = int(name.split()[0])
    return found["steps"].index(steps) if steps in found["steps"] else None


def _error(name: str) -> Callable[[dict[str, Any]], Any]:
    def value(found: dict[str, Any]) -> Any:
        place = _step(found, name)
        return None if place is None else found["error"][place]
    return value


def columns() -> list[Column]:
    """The figures of the page, in its order."""
    steps = [f"{h} step{'s' if h > 1 else ''}: error" for h in HORIZONS]
    return [
        Column("R² at the end", "anytime", lambda found: found["final"], short="end"),
        Column("R², mean over the stream", "anytime", lambda found: found["area"], short="stream"),
        Column("R² one step ahead", "anytime", lambda found: found.get("one_step"),
               short="one step"),
        Column("R² after changes", "changes", lambda found: found["mean"], short="changes"),
        *[Column(name, "open_loop", _error(name), MOST_ERROR, short=f"h={h}")
          for name, h in zip(steps, HORIZONS)],
        Column("R² at other rates", "rates", lambda found: float(np.mean(found["r2"])),
               short="rates"),
        Column("R² after hostile rows", "hostile", lambda found: found["mean"], short="hostile"),
        Column("R² at the end, the paper's splits", "paper",
               lambda found: float(np.mean([split["final"] for split in found["splits"]])),
               short="paper"),
        Column("µs per update", "cost", lambda found: found["update_us"], math.inf, 0,
               short="µs", mean=False),
        Column("MB in memory", "cost", lambda found: _megabytes(found), math.inf, 1, short="MB",
               mean=False)]


def _megabytes(found: dict[str, Any]) -> Optional[float]:
    size = found.get("resident_bytes")
    return None if size is None else size / 1e6


def summary(results: dict[str, Any]) -> list[tuple[dict[str, Any], list[Optional[float]]]]:
    """A row per entry: for each of columns() the mean (cost: median) over data sets. Best first."""
    rows: list[tuple[dict[str, Any], list[Optional[float]]]] = [
        (entry, []) for entry in results["entries"]]
    for column in columns():
        cells = column.cells(results)
        for entry, means in rows:
            values = [value for (name, _), value in cells.items() if name == entry["name"]]
            means.append(float(column.over(values)) if values else None)
    return sorted(rows, key=lambda row: -(LEAST if row[1][0] is None else row[1][0]))


def _best(column: Column, values: Sequence[Optional[float]]) -> Optional[str]:
    """The text of the best value, as shown; None of the columns of cost."""
    known = [value for value in values if value is not None]
    if not known or column.track == "cost":
        return None
    return column.text(min(known) if column.is_error else max(known))


def table(results: dict[str, Any]) -> str:
    """The summary for a terminal."""
    names = ["entry", *(column.short for column in columns())]
    lines = [[entry["name"], *(column.text(value) for column, value in zip(columns(), means))]
             for entry, means in summary(results)]
    widths = [max(len(line[i]) for line in [names, *lines]) for i in range(len(names))]
    return "\n".join("  ".join(cell.ljust(width) if i == 0 else cell.rjust(width)
                               for i, (cell, width) in enumerate(zip(line, widths)))
                     for line in [names, *lines])


_STYLE = """
:root { color-scheme: light dark; --paper: #fff; --ink: #1c2126; --faint: #5a646e; --edge: #d5dade;
  --s0: #0055a4; --s1: #ce4008; --s2: #0a8369; --s3: #b202ab; --s4: #5a4300; --s5: #5a646e;
  --s6: #1c2126; }
@media (prefers-color-scheme: dark) { :root { --paper: #15191d; --ink: #e6e9ec; --faint: #a3adb6;
  --edge: #39424a; --s0: #3d9bff; --s1: #f6651a; --s2: #33f09b; --s3: #dc62a0; --s4: #fede4a;
  --s5: #a3adb6; --s6: #e6e9ec; } }
* { box-sizing: border-box; }
body { margin: 0 auto; padding: 1rem 1rem 3rem; max-width: 80rem; background: var(--paper);
  color: var(--ink); font: 1rem/1.5 system-ui, "Segoe UI", Arial, sans-serif; }
h1 { font-size: 1.6rem; line-height: 1.25; margin: 0 0 .5rem; }
h2 { font-size: 1.2rem; margin: 2rem 0 .4rem; padding-top: .6rem; border-top: 1px solid var(--edge); }
h3 { font-size: 1rem; margin: .8rem 0 .2rem; }
p { margin: .3rem 0 .7rem; max-width: 46rem; overflow-wrap: anywhere; }
a { color: var(--s0); } code { font-size: .875rem; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; font-size: .875rem; font-variant-numeric: tabular-nums; }
th, td { padding: .25rem .6rem; text-align: right; border-bottom: 1px solid var(--edge); }
th { vertical-align: bottom; } td, th:first-child { white-space: nowrap; }
th:first-child, td:first-child { text-align: left; padding-left: 0; position: sticky; left: 0;
  background: var(--paper); }
td.left, th.left { text-align: left; white-space: normal; min-width: 11rem; }
tr.naive td { color: var(--faint); } tr.yours td:first-child { color: var(--s1); }
b { font-weight: 700; }
.panels { display: grid; gap: 1rem 1.5rem;
  grid-template-columns: repeat(auto-fill, minmax(min(100%, 19rem), 1fr)); }
figure { margin: 0; min-width: 0; } svg { width: 100%; height: auto; display: block; }
svg text { fill: var(--faint); font-size: 11px; } figcaption { font-size: .875rem; }
.legend { display: flex; flex-wrap: wrap; gap: .1rem 1.2rem; font-size: .875rem; margin: .4rem 0; }
.legend svg { display: inline-block; width: 30px; height: 10px; margin-right: .3rem; }
"""
_DASHES = ("", "7 3", "2 2", "8 2 2 2", "5 2", "1 3", "")


def page(results: dict[str, Any]) -> str:
    """A page without other files: tables of all tracks, curves, data and licences."""
    parts = [_head(results), _summary_section(results), _stream_section(results)]
    parts += [_track_section(results, *one) for one in (
        ("end", "At the end", "R² on the runs left out, after one pass over all others."),
        ("stream", "Over the stream", "The mean of R² on the runs left out, asked while the stream "
         "is learned. Off-line entries have none."),
        ("one step", "One step ahead", "R² of the next row before it is learned, of every tenth "
         "row to learn."),
        ("changes", "After changes", "The mean of R² on runs of the present vehicle that are left "
         "out, 50, 100, 200, 500 and 1,000 rows after each change.")) ]
    parts += [_track_section(results, f"h={h}", f"Open loop, {h} step{'s' if h > 1 else ''}",
                             "Error of the velocities in standard deviations; less is better.")
              for h in HORIZONS]
    parts += [_track_section(results, *one) for one in (
        ("rates", "Other rates", "R² on the runs left out, unchanged, after learning the same "
         "drives at a fifth, a half and twice the rate."),
        ("hostile", "Hostile rows", "R² on sound runs left out, after learning spoilt rows: "
         + "; ".join(f"{name}: {_sentence(text)}" for name, text in results["spoilt"].items())
         + "."),
        ("paper", "The paper's protocol", "R² at the end on held-out rows of the present vehicle, "
         "mean of the splits: rows at random, whose neighbours in time leak, and blocks."),
        ("µs", "Cost of an update", "Processor time per row in µs, with a tenth of an answer one "
         "step ahead."),
        ("MB", "Memory", "Growth of the process in MB while the stream is learned."))]
    parts += [_data_section(results), _entries_section(results), _failures(results),
              "</body></html>\n"]
    return "\n".join(parts)


def _sentence(text: str) -> str:
    return escape(text.rstrip("."))


def _head(results: dict[str, Any]) -> str:
    data = results["data"]
    simulated = sum(one["simulated"] for one in data)
    kinds = f", {simulated} of them simulated" if simulated else ", all of real vehicles"
    machine = ", ".join(f"{name} {value}" for name, value in results["machine"].items())
    command = results.get("command")
    made = f"<p><code>{escape(command)}</code></p>" if command else ""
    took = results.get("computing_seconds")
    took = f" Computed in {took / 60:.1f} minutes of one core." if took else ""
    return f"""<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>Learners of vehicle dynamics: the open benchmark</title><style>{_STYLE}</style></head><body>
<h1>Learners of vehicle dynamics: the open benchmark</h1>
<p>{len(results["entries"])} learners, {len(data)} data sets{kinds}.
Protocol {results["protocol"]}, kelpie
{escape(results["kelpie"])}, seed {results["limits"]["seed"]}, at most
{results["limits"]["rows"]:,} rows to learn of each data set. Whole runs are left out. The protocol
stands in python/kelpie/benchmark/README.md.</p>
{made}<p>{escape(machine)}.{took}</p>"""


def _rows(rows: list[tuple[dict[str, Any], list[str]]]) -> str:
    return "\n".join(f'<tr class="{entry["kind"]}"><td>{escape(entry["name"])}</td>'
                     + "".join(f"<td>{cell}</td>" for cell in cells) + "</tr>"
                     for entry, cells in rows)


def _marked(column: Column, value: Optional[float], best: Optional[str]) -> str:
    text = column.text(value)
    return f"<b>{text}</b>" if text == best else text


def _summary_section(results: dict[str, Any]) -> str:
    rows = summary(results)
    best = [_best(column, [means[i] for _, means in rows]) for i, column in enumerate(columns())]
    body = [(entry, [_marked(*one) for one in zip(columns(), means, best)])
            for entry, means in rows]
    head = "".join(f"<th>{escape(column.name)}</th>" for column in columns())
    return f"""<h2>All data sets</h2>
<p>Means over the data sets of each track; cost: medians. R²: 1 is perfect, 0 is no better than the
mean; each counts at least −{-LEAST:g}. Errors after 1 to 100 steps: of velocities in open loop,
in standard deviations, less is better, each counts at most {MOST_ERROR:g}. Best figures are bold. Off-line
entries see all rows before they answer.</p>
<div class="scroll"><table><tr><th>entry</th>{head}</tr>
{_rows(body)}</table></div>"""


def _track_section(results: dict[str, Any], short: str, title: str, meaning: str) -> str:
    column = next(one for one in columns() if one.short == short)
    cells = column.cells(results)
    data = [one["name"] for one in results["data"] if one["name"] in {name for _, name in cells}]
    if not data:
        return ""
    best = {name: _best(column, [value for (_, of), value in cells.items() if of == name])
            for name in data}
    body = [(entry, [_marked(column, cells.get((entry["name"], name)), best[name]) for name in data])
            for entry, _ in summary(results)]
    head = "".join(f"<th>{escape(name)}</th>" for name in data)
    return f"""<h2>{title}</h2><p>{meaning}</p>
<div class="scroll"><table><tr><th>entry</th>{head}</tr>
{_rows(body)}</table></div>"""


def _stream_section(results: dict[str, Any]) -> str:
    online = {entry["name"]: entry["kind"] for entry in results["entries"] if not entry["offline"]}
    yours = [name for name, kind in online.items() if kind == "yours"]
    shown = [*[name for name in _SHOWN if name in online], *yours][:len(_DASHES)]
    if not shown:
        return ""
    pairs = {(one["entry"], one["data"]): one for one in results["results"]}
    legend = "".join(f'<span><svg viewBox="0 0 30 10"><path d="M0 5H30" {_stroke(i)}/></svg>'
                     f"{escape(name)}</span>" for i, name in enumerate(shown))
    figures = "".join(
        f"<figure><figcaption>{escape(data['name'])}</figcaption>"
        + _curves([pairs[name, data["name"]] for name in shown]) + "</figure>"
        for data in results["data"])
    return f"""<h2>R² while the stream is learned</h2>
<p>On runs of the present vehicle that are left out, over rows learned. Curves run along the
lower edge where R² is below −0.2.</p><div class="legend">{legend}</div><div class="panels">{figures}</div>"""


def _stroke(i: int) -> str:
    dash = f' stroke-dasharray="{_DASHES[i]}"' if _DASHES[i] else ""
    return f'fill="none" stroke="var(--s{i})" stroke-width="2"{dash}'


def _curves(results: list[dict[str, Any]]) -> str:
    width, height, left, bottom, least = 320, 190, 34, 22, -0.2
    known = [result["anytime"] for result in results if "failed" not in result]
    if not known:
        return "<p>failed</p>"
    first, last = known[0]["rows"][0], max(max(one["rows"][-1] for one in known), 2)
    span = math.log(max(last / first, 1.01))

    def x(rows: float) -> float:
        return left + (width - left - 8) * math.log(rows / first) / span

    def y(r2: float) -> float:
        return 6 + (height - bottom - 6) * (1.0 - max(r2, least)) / (1.0 - least)

    parts = [f'<path d="M{left} {y(r2):.1f}H{width - 8}" stroke="var(--edge)"/>'
             f'<text x="{left - 4}" y="{y(r2) + 4:.1f}" text-anchor="end">{r2:g}</text>'
             for r2 in (0, 0.5, 1)]
    ticks = [step * 10 ** power for power in range(1, 7) for step in (1, 3)
             if first <= step * 10 ** power <= last]
    parts += [f'<text x="{x(rows):.1f}" y="{height - 6}" text-anchor="middle">{rows:,}</text>'
              for rows in ticks]
    for i, result in enumerate(results):
        if "failed" in result:
            continue
        points = [(x(rows), y(_mean(r2))) for rows, r2 in zip(result["anytime"]["rows"],
                                                             result["anytime"]["r2"])]
        line = "L".join(f"{a:.1f} {b:.1f}" for a, b in points)
        parts.append(f'<path d="M{line}" {_stroke(i)}/>')
    return (f'<svg viewBox="0 0 {width} {height}" role="img" aria-label="R² over rows learned">'
            + "".join(parts) + "</svg>")


def _mean(r2: list[Optional[float]]) -> float:
    return float(np.mean([LEAST if value is None else max(value, LEAST) for value in r2]))


def _data_section(results: dict[str, Any]) -> str:
    rows = []
    for data in results["data"]:
        origin = escape(data["origin"])
        if origin.startswith("https://"):
            origin = f'<a href="{origin}">{origin}</a>'
        ceiling = data.get("ceiling_r2")
        rows.append("<tr>" + "".join(f"<td>{cell}</td>" for cell in (
            escape(data["name"]), f"{data['rate_hz']:.3g}", f"{data['rows_learned']:,}",
            f"{data['rows_left_out']:,}", data["runs_learned"], data["runs_left_out"],
            data["stretches"] - 1, "–" if ceiling is None else f"{_mean(ceiling):.3f}"))
            + f'<td class="left">{escape(", ".join(data["inputs"]))} → '
              f'{escape(", ".join(data["targets"]))}</td>'
              f'<td class="left">{escape(data["license"])}</td><td class="left">{origin}'
              f"<br>{escape(data['conversion'])}</td></tr>")
    return f"""<h2>Data</h2><p>Ceiling: R² of the truth of the simulation against measured
accelerations of the runs left out.</p><div class="scroll"><table><tr><th>data</th><th>rows/s</th>
<th>rows to learn</th><th>rows left out</th><th>runs to learn</th><th>runs left out</th>
<th>changes</th><th>ceiling</th><th class="left">inputs → targets</th><th class="left">licence</th>
<th class="left">origin and conversion</th></tr>
{"".join(rows)}</table></div>"""


def _entries_section(results: dict[str, Any]) -> str:
    rows = "".join(f"<tr><td>{escape(entry['name'])}</td><td class=\"left\">"
                   f"{escape(entry['meaning'])}{' Off line.' if entry['offline'] else ''}</td></tr>"
                   for entry in results["entries"])
    return f'<h2>Entries</h2><div class="scroll"><table>{rows}</table></div>'


def _failures(results: dict[str, Any]) -> str:
    rows = "".join(f"<tr><td>{escape(one['entry'])}</td><td>{escape(one['data'])}</td>"
                   f"<td class=\"left\">{escape(one['failed'])}</td></tr>"
                   for one in results["results"] if "failed" in one)
    return f'<h2>Failed</h2><div class="scroll"><table>{rows}</table></div>' if rows else ""
