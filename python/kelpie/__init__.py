# SPDX-License-Identifier: Apache-2.0
"""Learns the dynamics of an underwater vehicle on line, in bounded memory and time.

`OnlineSVR` learns one target, `DynamicsModel` several; both follow scikit-learn's contract.
"""

from ._estimators import DynamicsModel, OnlineSVR, RolloutResult, Verdict
from ._kelpie import __version__

__all__ = ["DynamicsModel", "OnlineSVR", "RolloutResult", "Verdict", "__version__"]
