# SPDX-License-Identifier: Apache-2.0
"""Learns the dynamics of an underwater vehicle on line, in bounded memory and time.

`OnlineSVR` learns one target, `DynamicsModel` several; both follow scikit-learn's contract.
`Alignment` gives the rows of a log the commands that belong to them.
"""

from ._alignment import Alignment
from ._estimators import DynamicsModel, OnlineSVR, RolloutResult, Verdict
from ._kelpie import __version__

__all__ = ["Alignment", "DynamicsModel", "OnlineSVR", "RolloutResult", "Verdict", "__version__"]
