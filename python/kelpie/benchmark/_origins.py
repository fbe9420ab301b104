# SPDX-License-Identifier: Apache-2.0
"""Files of the benchmark made of their origins' files."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ._manifest import ManifestError

_GITHUB = "https://raw.githubusercontent.com"


@dataclass(frozen=True)
class Origin:
    """Where a file of public.toml comes from, and how."""

    address: str
    sha256: str
    convert: Callable[[Path], str]  # the text of the converted file

    @property
    def name(self) -> str:
        return self.address.rsplit("/", maxsplit=1)[-1]


def _fish(file: Path) -> str:
    """Every tenth sample; accelerations by a filter of Savitzky and Golay (9 samples, degree 2)."""
    try:
        from scipy.io import loadmat
        from scipy.signal import savgol_filter
    except ImportError:
        raise ManifestError(f"{file}: scipy is wanted to convert the file (Debian's "
                            "python3-scipy)") from None
    recorded = loadmat(file)
    at = np.arange(0, len(recorded["x_int_list"]), 10)  # 200 Hz become 20 Hz
    begins = np.r_[0, recorded["Lengths"].ravel()[1:] - 1]
    run = np.searchsorted(begins, at, side="right") - 1
    t = (at - begins[run]) / 200.0
    names = {"x": "x_int_list", "y": "y_int_list", "psi": "psi_int_list", "v1": "v1_int_list",
             "v2": "v2_int_list", "omega": "omega_int_list", "omega_a": "omega_a_list",
             "u1": "u1_list", "u2": "u2_list"}
    columns = {"run": run, "t": t}
    columns |= {name: recorded[key].ravel()[at] for name, key in names.items()}
    numbers = np.unique(run)
    for name in ("v1", "v2", "omega"):
        rounded = np.array([float(f"{value:.6g}") for value in columns[name]])
        columns[f"{name}dot"] = np.concatenate(
            [savgol_filter(rounded[run == one], 9, 2, deriv=1, delta=0.05) for one in numbers])
    columns["time"] = _in_a_row(t, run)
    lines = [",".join(columns)]
    lines += [",".join(f"{value:.6g}" for value in row) for row in zip(*columns.values())]
    return "\n".join(lines) + "\n"


def _in_a_row(t: np.ndarray, run: np.ndarray) -> np.ndarray:
    """The times of runs one after the other, 3 s apart."""
    time, end = np.empty(len(t)), 0.0
    for number in np.unique(run):
        here = run == number
        time[here] = end + t[here] - (t[here][0] if number else 0.0)
        end = time[here][-1] + 3.0
    return time


ORIGINS = {"fish_20hz.csv": Origin(
    f"{_GITHUB}/giorgosmamakoukas/DerivativeBasedKoopman/5ab87f2588019bb43157edbaeb21af38e4ce07d5"
    "/Koopman_RoboticFish/InterpolatedData_200Hz.mat",
    "6797f7984183e23117abffb64f269efdfe6fddfa4b2ae3070ab4ad765da32ee8", _fish)}
