# SPDX-License-Identifier: Apache-2.0
"""Manifests: TOML files that name data sets, their columns, runs, origin and licence."""

from __future__ import annotations

import difflib
import hashlib
import re
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Any, Optional

try:
    import tomllib
except ImportError as error:  # Python before 3.11
    raise ImportError("kelpie.benchmark: needs Python 3.11 or newer, which reads TOML") from error

TRACKS = ("anytime", "open_loop", "changes", "rates", "hostile", "cost", "paper")
USUAL_TRACKS = TRACKS[:-1]  # where a data set names none


class ManifestError(ValueError):
    """A manifest, a data file or an entry that cannot be used; the message names the place."""


@dataclass(frozen=True)
class Source:
    """A table [[data]] of a manifest. The keys of [log] have the meaning of docs/howto/logs.md."""

    name: str
    files: list[str]  # beside the manifest; each file begins a run
    targets: list[str]
    inputs: list[str]
    states: list[str] = field(default_factory=list)  # velocity of each target; else by names
    config: Optional[str] = None  # file with [log], for recordings of messages
    time: Optional[str] = None  # column [s]
    rate: Optional[float] = None  # rows per second; else the median step of the time
    run: Optional[str] = None  # column whose changes begin runs
    gap: Optional[float] = None  # a silence [s] that begins a run
    pieces: Optional[int] = None  # equal parts into which each file is cut
    configuration: Optional[str] = None  # column that says which vehicle drives
    truth: list[str] = field(default_factory=list)  # columns of targets without noise
    held_out: list[str] = field(default_factory=list)  # columns of splits: 1 held out, 0 learned
    thin: int = 1  # every so many-th row of a run is taken
    tracks: list[str] = field(default_factory=lambda: list(USUAL_TRACKS))
    simulated: bool = False
    license: str = ""
    origin: str = ""
    conversion: str = ""  # how the files were made of the origin's files
    sha256: list[str] = field(default_factory=list)  # of the files, in their order
    manifest: Path = Path()
    line: int = 0  # of the table in the manifest

    def paths(self) -> list[Path]:
        return [self.manifest.parent / name for name in self.files]

    def refuse(self, key: str, message: str) -> ManifestError:
        """The error of a key of this table, with file, line and field."""
        lines = self.manifest.read_text(encoding="utf-8").splitlines()
        line = next((i for i in range(self.line, len(lines))
                     if re.match(rf"\s*{key}\s*=", lines[i])), self.line - 1) + 1
        if any(lines[i].startswith("[[") for i in range(self.line, min(line, len(lines)))):
            line = self.line  # the key stands in a later table
        return ManifestError(f"{self.manifest}:{line}: {key} of '{self.name}': {message}")

    def check_files(self) -> None:
        """Refuses missing files, and files with another checksum than `sha256`."""
        if self.sha256 and len(self.sha256) != len(self.files):
            raise self.refuse("sha256", f"has {len(self.sha256)} checksums for "
                              f"{len(self.files)} files; one for each is wanted")
        for path, wanted in zip(self.paths(), self.sha256 or [""] * len(self.files)):
            if not path.is_file():
                raise self.refuse("files", f"{path} is not there; see `fetch`, or name the "
                                  "file's path seen from the manifest")
            if wanted and wanted != checksum(path):
                raise self.refuse("sha256", f"{path} has SHA-256 {checksum(path)}; wanted is "
                                  f"{wanted}")


def checksum(path: Path) -> str:
    """The SHA-256 of a file, in hexadecimal digits."""
    return hashlib.sha256(path.read_bytes()).hexdigest()


_KINDS = {"name": str, "files": list, "targets": list, "inputs": list, "states": list,
          "config": str, "time": str, "rate": float, "run": str, "gap": float, "pieces": int,
          "configuration": str, "truth": list, "held_out": list, "thin": int, "tracks": list,
          "simulated": bool,
          "license": str, "origin": str, "conversion": str, "sha256": list}
_REQUIRED = ("name", "files", "targets", "inputs")
_NAMES = {list: "a list of texts", str: "a text", float: "a number above 0",
          int: "a whole number above 0", bool: "true or false"}


def read_manifest(path: Path) -> list[Source]:
    """The data sets of a manifest. ManifestError with file, line and key on a mistake."""
    path = Path(path)
    if not path.is_file():
        raise ManifestError(f"{path}: is no file; a manifest in TOML is wanted")
    text = path.read_text(encoding="utf-8")
    try:
        tables = tomllib.loads(text).get("data")
    except tomllib.TOMLDecodeError as error:
        place = re.search(r"line (\d+)", str(error))
        raise ManifestError(f"{path}:{place[1] if place else 1}: is not TOML: {error}") from None
    if not isinstance(tables, list) or not tables:
        raise ManifestError(f"{path}:1: has no table [[data]]; one for each data set is wanted")
    lines = [i for i, line in enumerate(text.splitlines(), 1)
             if re.match(r"\s*\[\[\s*data\s*\]\]", line)]
    if len(lines) != len(tables):
        raise ManifestError(f"{path}:1: has to write each data set as a table [[data]]")
    sources = [_source(path, line, table) for line, table in zip(lines, tables)]
    names = [source.name for source in sources]
    for i, source in enumerate(sources):
        if source.name in names[:i]:
            raise source.refuse("name", "names two data sets; names are wanted once")
    return sources


def _source(path: Path, line: int, table: dict[str, Any]) -> Source:
    name = table.get("name")
    shell = Source(str(name or "?"), [], [], [], manifest=path, line=line)
    for key, value in table.items():
        if key not in _KINDS:
            near = difflib.get_close_matches(key, _KINDS, 1)
            hint = f"did you mean '{near[0]}'?" if near else "the keys are " + ", ".join(_KINDS)
            raise shell.refuse(key, f"is not known; {hint}")
        if not _fits(_KINDS[key], value):
            raise shell.refuse(key, f"{_NAMES[_KINDS[key]]} is wanted, not {value!r}")
    for key in _REQUIRED:
        if not table.get(key):
            raise shell.refuse(key, "is missing")
    for track in table.get("tracks", []):
        if track not in TRACKS:
            raise shell.refuse("tracks", f"'{track}' is no track; the tracks are "
                               + ", ".join(TRACKS))
    cuts = [key for key in ("run", "gap", "pieces") if key in table]
    if len(cuts) > 1:
        raise shell.refuse(cuts[1], f"stands beside {cuts[0]}; one way to tell runs is wanted")
    known = {one.name for one in fields(Source)}
    return Source(**{key: value for key, value in table.items() if key in known},
                  manifest=path, line=line)


def _fits(kind: type, value: Any) -> bool:
    if kind is list:
        return isinstance(value, list) and all(isinstance(part, str) for part in value)
    if kind is float:
        return isinstance(value, (int, float)) and not isinstance(value, bool) and value > 0
    if kind is int:
        return isinstance(value, int) and not isinstance(value, bool) and value > 0
    return isinstance(value, kind)
