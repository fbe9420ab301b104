# SPDX-License-Identifier: Apache-2.0
"""The open benchmark: learners of marine vehicles' dynamics, on line, on the same rows.

    python3 -m kelpie.benchmark fetch FOLDER --from COPIES
    python3 -m kelpie.benchmark run MANIFEST... --out FOLDER [--entry module:Class]

Any class with `partial_fit` and `predict` enters. python/kelpie/benchmark/README.md is the
protocol, whose version is PROTOCOL; a change of the protocol that changes figures raises it.
"""

from ._data import Dataset, Task
from ._entries import Entry, builtin_entries, load_entry
from ._manifest import ManifestError, read_manifest
from ._page import page
from ._runner import Limits, run
from ._tracks import PROTOCOL

__all__ = ["Dataset", "Entry", "Limits", "ManifestError", "PROTOCOL", "Task", "builtin_entries",
           "load_entry", "page", "read_manifest", "run"]
