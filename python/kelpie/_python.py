# SPDX-License-Identifier: Apache-2.0
"""Whether this is the Python that kelpie was built for, and has what kelpie needs."""

import importlib.util
import sys
from pathlib import Path

_FOLDER = Path(__file__).parent


def _built_for() -> str:
    built = sorted(file.name.split(".")[1] for file in _FOLDER.glob("_kelpie.*.so"))
    return f" kelpie was built for {', '.join(built)}." if built else ""


def _require(name: str, what: str) -> None:
    if importlib.util.find_spec(name) is None:
        raise ImportError(
            f"kelpie: {what}, and this Python, {sys.executable} {sys.version.split()[0]}, has "
            f"none.{_built_for()} Where kelpie was built with Debian's Python, run "
            "/usr/bin/python3.", name=name)


_require("numpy", "needs numpy")
_require("kelpie._kelpie", "needs its module for this Python")
