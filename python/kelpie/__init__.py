# SPDX-License-Identifier: Apache-2.0
"""Learns the dynamics of an underwater vehicle on line, in bounded memory and time.

`OnlineSVR` learns one target, `DynamicsModel` several; both follow scikit-learn's contract.
`DeadReckoning` takes velocities through outages. `Alignment` gives the rows of a log the commands
that belong to them. `read_log` reads logs; `report`, `compare`, `tune` and `identify` study them as
the commands of `kelpie` do. `BlockSplit` holds out blocks of time; `plot` draws.
"""

from . import _python  # first: says which Python is wanted
from . import plot
from ._alignment import Alignment
from ._authority import Allocation, Authority
from ._dead_reckoning import DeadReckoning
from ._estimators import DynamicsModel, OnlineSVR, RolloutResult, Verdict
from ._kelpie import __version__
from ._learner import PlausibilityWarning
from ._log import LogArrays, read_log
from ._splits import BlockSplit
from ._studies import StudyResult, compare, identify, report, tune

__all__ = ["Alignment", "Allocation", "Authority", "BlockSplit", "DeadReckoning", "DynamicsModel", "LogArrays", "OnlineSVR",
           "PlausibilityWarning", "RolloutResult", "StudyResult", "Verdict", "__version__",
           "compare", "identify", "plot", "read_log", "report", "tune"]

del _python
