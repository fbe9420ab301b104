# SPDX-License-Identifier: Apache-2.0
"""The commands learn, compare, tune and identify as functions."""

from __future__ import annotations

import csv
import json
import os
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple, Optional, Union

import numpy as np

from . import _kelpie, _settings
from ._clock import TIMES, Clock, index_times
from ._estimators import DynamicsModel
from ._log import existing

Log = Union[str, "os.PathLike[str]", Any]  # a file, or columns by name


class _Files(NamedTuple):
    """What a command writes."""

    numbers: str
    page: str


_FILES = {"learn": _Files("result.json", "report.html"),
          "compare": _Files("compare.json", "compare.html"),
          "tune": _Files("tune.json", "tune.html"),
          "identify": _Files("parameters.yaml", "identify.html")}

_OPTIONS = """
    Parameters
    ----------
    log : a file (CSV, or a recording: docs/reference/formats.md), or columns by name: a data frame,
        read_log(). A list has several logs of the same columns.
    settings : parameters of DynamicsModel, such as {{"buffer": 500}}.
    out : folder for the command's files, which are otherwise kept in the result alone.
    options : all other options of `kelpie {command}`, by name: rate=4.0, split="tail",
        inputs=["u", "v", "th1"], units={{"u": "m/s"}}, config="vehicle.toml", accept="implausible".
        `kelpie {command} --help` lists them.

    Returns a StudyResult with the numbers of {numbers} ({page}).

    Raises ValueError as the command says it, FileNotFoundError without such a log.
"""


class StudyResult(dict[str, Any]):
    """The numbers of a study, under the keys of the file that the command writes."""

    text: str  #: what the command says: the verdict, tables, warnings
    page: str  #: the page with figures, as HTML
    model: Optional[DynamicsModel] = None  #: of report(): the learned model

    @property
    def table(self) -> Any:
        """The main numbers as a data frame of pandas.

        Of report() and compare() R² by axis and model; of tune() the chosen settings by axis; of
        identify() the parameters.
        """
        import pandas
        rows = _rows(self)
        return pandas.DataFrame(rows).set_index(list(rows[0])[:-_VALUES[self["format"]]])

    def __repr__(self) -> str:
        return self.text

    def _repr_html_(self) -> str:
        return self.table._repr_html_()  # type: ignore[no-any-return]


def report(log: Log, *, settings: Optional[Mapping[str, Any]] = None,
           out: Union[str, os.PathLike[str], None] = None, **options: Any) -> StudyResult:
    return _study("learn", log, settings, out, options)


def compare(log: Log, *, settings: Optional[Mapping[str, Any]] = None,
            out: Union[str, os.PathLike[str], None] = None, **options: Any) -> StudyResult:
    return _study("compare", log, settings, out, options)


def tune(log: Log, *, settings: Optional[Mapping[str, Any]] = None,
         out: Union[str, os.PathLike[str], None] = None, **options: Any) -> StudyResult:
    return _study("tune", log, settings, out, options)


def identify(log: Log, *, settings: Optional[Mapping[str, Any]] = None,
             out: Union[str, os.PathLike[str], None] = None, **options: Any) -> StudyResult:
    return _study("identify", log, settings, out, options)


def _describe(function: Any, command: str, first: str, page: str) -> None:
    numbers = _FILES[command].numbers
    options = _OPTIONS.format(command=command, numbers=numbers, page=page)
    function.__doc__ = f"{first}\n{options}    "


_describe(report, "learn", "Learns a log as `kelpie learn` does, and judges what was learned.",
          "docs/reference/files.md")
_describe(compare, "compare", "Learns a log with kelpie and with simpler models.",
          "docs/howto/studies.md")
_describe(tune, "tune", "Searches the settings that learn one or more logs best.",
          "docs/howto/studies.md")
_describe(identify, "identify", "Estimates masses, drags and thrusts of a vehicle from a log.",
          "docs/howto/identify.md")

_VALUES = {"kelpie-result": 3, "kelpie-compare": 3, "kelpie-tune": 1, "kelpie-parameters": 6}


def _study(command: str, log: Log, settings: Optional[Mapping[str, Any]],
           out: Union[str, os.PathLike[str], None], options: dict[str, Any]) -> StudyResult:
    with tempfile.TemporaryDirectory(prefix="kelpie-") as temporary:
        folder = Path(temporary)
        logs = log if isinstance(log, (list, tuple)) else [log]
        files, names = zip(*(_file(one, folder / f"kelpie-frame-{place}.csv", options)
                             for place, one in enumerate(logs)))
        into = folder / "out" if out is None else Path(out)
        words = [command, *files, *_words(options), "--out", str(into)]
        for assignment in _settings.assignments(settings or {}):
            words += ["--set", assignment]

        def named(text: str) -> str:
            for file, name in zip(files, names):
                text = text.replace(file, name)
                if Path(file).parent == folder:  # texts may have the name of the file alone
                    text = text.replace(Path(file).name, Path(name).name)
            return text

        try:
            said = _kelpie.run_command(words)
        except ValueError as error:
            raise ValueError(named(str(error))) from None
        except RuntimeError as error:
            if str(error).startswith("interrupted"):
                raise KeyboardInterrupt from None
            raise
        written = _FILES[command]
        text = named((into / written.numbers).read_text(encoding="utf-8"))
        is_json = written.numbers.endswith(".json")
        result = StudyResult(json.loads(text) if is_json else _kelpie.parse_yaml(text))
        if result.get("interrupted"):  # part of the log: files of `out` stay
            raise KeyboardInterrupt
        said = named(said)
        if out is None:  # lines about files that are gone
            said = "\n".join(line for line in said.split("\n") if str(into) not in line)
        result.text = said
        result.page = named((into / written.page).read_text(encoding="utf-8"))
        if command == "learn" and (into / "model.json").exists():
            result.model = DynamicsModel.load(into / "model.json")
        return result


def _words(options: dict[str, Any]) -> list[str]:
    words = []
    for name, value in options.items():
        if value is None or value is False:
            continue
        option = "--" + name.replace("_", "-")
        if isinstance(value, Mapping):
            value = [f"{key}={part}" for key, part in value.items()]
        for part in value if isinstance(value, (list, tuple)) else [value]:
            words.append(option)
            if part is not True:
                words.append(os.fspath(part) if isinstance(part, os.PathLike) else str(part))
    return words


def _file(log: Log, file: Path, options: dict[str, Any]) -> tuple[str, str]:
    """The log as a file, and its name for messages."""
    if isinstance(log, (str, os.PathLike)):
        path = existing(log)
        return path, path
    columns = {str(name): np.asarray(log[name]) for name in log}
    clock = index_times(log)
    if clock is not None and not {"time", "rate"} & options.keys() and not (
            set(TIMES) & columns.keys()):
        columns = {"t": Clock().seconds(clock), **columns}
    with open(file, "w", newline="", encoding="utf-8") as opened:
        writer = csv.writer(opened)
        writer.writerow(columns)
        writer.writerows(zip(*(_cells(values) for values in columns.values())))
    source = (getattr(log, "attrs", None) or {}).get("source")
    return str(file), os.fspath(source) if source else "the data frame"


def _cells(values: Any) -> Sequence[Any]:
    if values.dtype.kind == "M":
        texts = np.datetime_as_string(values, timezone="UTC").astype(object)
        texts[np.isnat(values)] = ""
        return texts.tolist()  # type: ignore[no-any-return]
    # NA of pandas equals nothing, not even itself.
    return ["" if type(value).__name__ in ("NAType", "NaTType") else value
            for value in values.tolist()]


def _rows(result: StudyResult) -> list[dict[str, Any]]:
    kind = result["format"]
    if kind == "kelpie-compare":
        return [_scores(axis, contender["name"], axis["r2"], axis["prequential_r2"])
                for contender in result["contenders"] for axis in contender["axes"]]
    if kind == "kelpie-result":
        rows = []
        for axis in result["axes"]:
            rows.append(_scores(axis, "kelpie", axis["r2"], axis["prequential_r2"]))
            for name, found in axis["yardsticks"].items():
                scores = {"final": found.get("r2_final"), "mean": found.get("r2_mean")}
                rows.append(_scores(axis, name, scores, found.get("prequential_r2")))
        return rows
    if kind == "kelpie-tune":
        return [{"setting": name, "axis": axis["name"], "value": value}
                for name, text in result["tuned"].items()
                for axis, value in zip(result["axes"], _by_axis(text, len(result["axes"])))]
    return [{"parameter": name, "unit": found["unit"], "state": found["state"],
             "value": found.get("value"), "error": found.get("error"),
             "low90": found.get("interval90", [None] * 2)[0],
             "high90": found.get("interval90", [None] * 2)[1]}
            for name, found in result["parameters"].items()]


def _by_axis(text: str, axes: int) -> list[str]:
    parts = text.split(",")
    return parts if len(parts) == axes else [text] * axes


def _scores(axis: dict[str, Any], model: str, r2: dict[str, Any], ahead: Any) -> dict[str, Any]:
    return {"axis": axis["name"], "model": model, "r2_final": r2["final"], "r2_mean": r2["mean"],
            "r2_one_ahead": ahead}
