# SPDX-License-Identifier: Apache-2.0
"""The command python3 -m kelpie.benchmark."""

from __future__ import annotations

import argparse
import json
import math
import os
import resource
import sys
import time
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, Optional

from ._entries import Entry, builtin_entries, load_entry
from ._fetch import PUBLIC, fetch
from ._manifest import TRACKS, ManifestError, read_manifest
from ._page import page, table
from ._runner import Limits, run


def main(arguments: Optional[Sequence[str]] = None) -> int:
    """0 success, 1 a failure or an entry that failed, 2 bad input."""
    options = _parser().parse_args(arguments)
    try:
        return int(options.command(options))
    except ManifestError as error:
        print(f"kelpie.benchmark: {error}", file=sys.stderr)
        return 2
    except OSError as error:
        print(f"kelpie.benchmark: {error}", file=sys.stderr)
        return 1


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="python3 -m kelpie.benchmark",
        description="Learners of marine vehicles' dynamics, on line, on the same rows "
                    "(python/kelpie/benchmark/README.md).")
    commands = parser.add_subparsers(required=True, metavar="run | fetch | page | entries")
    one = commands.add_parser("run", help="measure entries on the data sets of manifests")
    one.add_argument("manifest", nargs="+", type=Path, help="TOML files with tables [[data]]")
    one.add_argument("--out", type=Path, required=True, metavar="FOLDER",
                     help="folder for benchmark.json and index.html")
    one.add_argument("--entry", action="append", default=[], metavar="MODULE:CLASS",
                     help="a learner of yours, or FILE.py:CLASS; more than once for several")
    one.add_argument("--only", metavar="NAMES",
                     help="built-in entries, separated by commas; naive rows always take part; "
                          "'none' for naive rows alone")
    one.add_argument("--data", metavar="NAMES", help="data sets, separated by commas")
    one.add_argument("--tracks", metavar="NAMES",
                     help="of those of each data set, separated by commas; else all")
    one.add_argument("--rows", type=_whole, default=Limits.rows,
                     help="rows to learn of each data set, at most (%(default)s)")
    one.add_argument("--seed", type=int, default=Limits.seed, help="(%(default)s)")
    one.add_argument("--jobs", type=_whole, default=Limits.jobs,
                     help="processes at a time; times are comparable with 1 (%(default)s)")
    one.add_argument("--minutes", type=float, default=Limits.minutes,
                     help="of one entry on one data set, at most (%(default)s)")
    one.set_defaults(command=_run)
    two = commands.add_parser("fetch", help="copy the public data sets into a folder, checked")
    two.add_argument("folder", type=Path)
    two.add_argument("--from", dest="source", metavar="FOLDER|URL",
                     help="where copies are: a folder, which is searched, or the address of one; "
                          "else the origins, where a conversion is written")
    two.set_defaults(command=_fetch)
    draw = commands.add_parser("page", help="draw the page of a benchmark.json again")
    draw.add_argument("results", type=Path)
    draw.add_argument("--out", type=Path, required=True, metavar="FILE.html")
    draw.set_defaults(command=_draw)
    three = commands.add_parser("entries", help="list the built-in entries")
    three.set_defaults(command=_list)
    return parser


def _whole(text: str) -> int:
    number = int(text)
    if number < 1:
        raise argparse.ArgumentTypeError(f"{text}: a whole number above 0 is wanted")
    return number


def _run(options: argparse.Namespace) -> int:
    sources = [source for path in options.manifest for source in read_manifest(path)]
    names = [source.name for source in sources]
    for name in {name for name in names if names.count(name) > 1}:
        raise ManifestError(f"{options.manifest[-1]}: '{name}' stands in two manifests")
    if options.data:
        wanted = _chosen("--data", options.data, names)
        sources = [source for source in sources if source.name in wanted]
    if options.tracks:
        tracks = _chosen("--tracks", options.tracks, TRACKS)
        sources = [replace(source, tracks=[track for track in source.tracks if track in tracks])
                   for source in sources]
    entries = _entries(options.only, options.entry)
    options.out.mkdir(parents=True, exist_ok=True)
    start = time.monotonic()
    limits = Limits(options.rows, options.seed, options.jobs, options.minutes)
    results = run(sources, entries, limits, lambda text: print(text, file=sys.stderr, flush=True))
    results["command"] = _command(options)
    results["seconds"] = round(time.monotonic() - start, 1)
    results["computing_seconds"] = round(sum(resource.getrusage(who)[0] + resource.getrusage(who)[1]
                                             for who in (resource.RUSAGE_SELF,
                                                         resource.RUSAGE_CHILDREN)), 1)
    results = _for_json(results)
    _write(options.out / "benchmark.json",
           json.dumps(results, ensure_ascii=False, separators=(",", ":"), allow_nan=False) + "\n")
    _write(options.out / "index.html", page(results))
    print(table(results))
    print(f"page:    {options.out / 'index.html'}\nnumbers: {options.out / 'benchmark.json'}")
    failed = [result for result in results["results"] if "failed" in result]
    for result in failed:
        print(f"kelpie.benchmark: {result['entry']} on {result['data']}: {result['failed']}",
              file=sys.stderr)
    return 1 if failed else 0


def _command(options: argparse.Namespace) -> str:
    words = ["python3 -m kelpie.benchmark run", *(path.name for path in options.manifest)]
    words += [f"--entry {place}" for place in options.entry]
    words += [f"--{name} {getattr(options, name)}" for name in ("only", "data", "tracks")
              if getattr(options, name)]
    words += [f"--{name} {getattr(options, name)}" for name in ("rows", "seed", "jobs")
              if getattr(options, name) != getattr(Limits, name)]
    return " ".join(words)


def _entries(only: Optional[str], places: Sequence[str]) -> list[Entry]:
    entries = builtin_entries()
    if only:
        names = [entry.name for entry in entries if entry.kind != "naive"]
        wanted = [] if only == "none" else _chosen("--only", only, names)
        entries = [one for one in entries if one.kind == "naive" or one.name in wanted]
    for place in places:
        loaded = load_entry(place)
        if loaded.name in [entry.name for entry in entries]:
            raise ManifestError(f"--entry {place}: there is an entry of the name {loaded.name}; "
                                "another name for the class is wanted")
        entries.append(loaded)
    return entries


def _chosen(option: str, text: str, known: Sequence[str]) -> list[str]:
    names = text.split(",")
    for name in names:
        if name not in known:
            raise ManifestError(f"{option}: '{name}' is not known; there are " + ", ".join(known))
    return names


def _for_json(value: Any) -> Any:
    """Six digits of each number; numbers that are not finite become null, which JSON has."""
    if isinstance(value, dict):
        return {str(key): _for_json(part) for key, part in value.items()}
    if isinstance(value, (list, tuple)):
        return [_for_json(part) for part in value]
    if isinstance(value, float):
        return float(f"{value:.6g}") if math.isfinite(value) else None
    return value


def _write(path: Path, text: str) -> None:
    draft = path.with_name(f".{path.name}.{os.getpid()}")
    draft.write_text(text, encoding="utf-8")
    os.replace(draft, path)


def _fetch(options: argparse.Namespace) -> int:
    whole = True
    for line, is_there in fetch(options.folder, options.source):
        print(line, file=sys.stdout if is_there else sys.stderr)
        whole = whole and is_there
    print(f"manifest: {options.folder / PUBLIC.name}")
    return 0 if whole else 1


def _draw(options: argparse.Namespace) -> int:
    try:
        results = json.loads(options.results.read_text(encoding="utf-8"))
        if results.get("format") != "kelpie-benchmark":
            raise ValueError("its format is not kelpie-benchmark")
    except (ValueError, AttributeError) as error:
        raise ManifestError(f"{options.results}: is no benchmark.json: {error}") from None
    _write(options.out, page(results))
    return 0


def _list(options: argparse.Namespace) -> int:
    for entry in builtin_entries():
        print(f"{entry.name:15s} {entry.kind:7s} {entry.meaning}"
              + (" Off line." if entry.offline else ""))
    return 0


if __name__ == "__main__":
    sys.exit(main())
