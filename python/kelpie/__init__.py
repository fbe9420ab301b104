# SPDX-License-Identifier: Apache-2.0
"""Learns the dynamics of an underwater vehicle on line, in bounded memory and time.

`OnlineSVR` learns one target, `DynamicsModel` several; both follow scikit-learn's contract.
`DeadReckoning` takes velocities through outages. `Alignment` gives the rows of a log the commands that belong to them. `read_log` reads logs.
"""

from . import _python  # first: says which Python is wanted
from ._alignment import Alignment
from ._dead_reckoning import DeadReckoning
from ._estimators import DynamicsModel, OnlineSVR, RolloutResult, Verdict
from ._kelpie import __version__
from ._learner import PlausibilityWarning
from ._log import LogArrays, read_log

__all__ = ["Alignment", "DeadReckoning", "DynamicsModel", "LogArrays", "OnlineSVR",
           "PlausibilityWarning", "RolloutResult", "Verdict", "__version__", "read_log"]

del _python
