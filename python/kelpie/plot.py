# SPDX-License-Identifier: Apache-2.0
"""Figures of matplotlib, which is imported when one is drawn.

Every function draws into `axes`, or into new ones, and returns them.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import ArrayLike

_COLORS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#000000", "#E69F00", "#56B4E9")
_MARKERS = "osD^vPX"
_DASHES = ("-", "--", "-.", ":", (0, (5, 1)), (0, (3, 1, 1, 1)))
_LEAST_R2 = -0.2  # the axis ends here, as on the page of `kelpie compare`
_MOST_R2 = 1.05  # 1 is perfect; the margin of values far below would reach far above


def predictions(model: Any, y: ArrayLike, t: Optional[ArrayLike] = None, *,
                target: Union[int, str] = 0, axes: Any = None) -> Any:
    """Measured values of the last block that was learned, with predictions one step ahead.

    Parameters
    ----------
    model : after fit() or partial_fit().
    y : (n,) or (n, targets), as given there.
    t : (n,), time [s]. Default: numbers of the rows.
    target : name or number of a column of y.
    """
    name = model.targets_[target] if isinstance(target, int) else target
    if name not in model.targets_:
        raise ValueError(f"target: there is no '{name}'; the targets are "
                         f"{', '.join(model.targets_)}")
    place = model.targets_.index(name)
    decisions = model._decisions if model._decisions.ndim == 1 else model._decisions[:, place]
    measured = np.asarray(y).reshape(len(decisions), -1)[:, place]
    x = np.arange(len(decisions)) if t is None else np.asarray(t)
    axes = _axes(axes)
    axes.fill_between(x, decisions["lower"], decisions["upper"], color=_COLORS[0], alpha=0.2, lw=0,
                      label="interval")
    axes.plot(x, measured, color="#555555", lw=2.0, label="measured")
    axes.plot(x, decisions["predicted"], color=_COLORS[1], lw=1.2, label="predicted one step ahead")
    axes.set(xlabel="row" if t is None else "time [s]", ylabel=name)
    axes.legend(frameon=False)
    return axes


def learning(result: Mapping[str, Any], *, target: Union[int, str] = 0, axes: Any = None) -> Any:
    """R² on held-out rows while a log is learned: of report(), or of all models of compare()."""
    axes = _axes(axes)
    models = result.get("contenders") or [{"name": "kelpie", "axes": result["axes"]}]
    name = _targets(result)[target] if isinstance(target, int) else target
    for place, model in enumerate(models):
        validation = next(axis for axis in model["axes"] if axis["name"] == name)["validation"]
        r2 = np.array([np.nan if value is None else value for value in validation["r2"]])
        axes.plot(validation["samples"], r2, color=_COLORS[place % len(_COLORS)],
                  ls=_DASHES[place % len(_DASHES)], label=_label(model, r2))
    axes.set(xlabel="samples learned", ylabel=f"R² of {name} on held-out rows")
    low, high = axes.get_ylim()
    axes.set_ylim(max(_LEAST_R2, low), min(high, _MOST_R2))
    axes.legend(frameon=False)
    return axes


def comparison(result: Mapping[str, Any], *, axes: Any = None) -> Any:
    """R² of compare() on held-out rows at the end, a place per target, a marker per model."""
    axes = _axes(axes)
    names = _targets(result)
    for place, model in enumerate(result["contenders"]):
        r2 = [np.nan if axis["r2"]["final"] is None else axis["r2"]["final"]
              for axis in model["axes"]]
        axes.plot(r2, np.arange(len(names)), ls="", marker=_MARKERS[place % len(_MARKERS)],
                  color=_COLORS[place % len(_COLORS)], label=_label(model, r2))
    axes.set(yticks=np.arange(len(names)), yticklabels=names, xlabel="R² on held-out rows",
             ylim=(len(names) - 0.5, -0.5))
    low, high = axes.get_xlim()
    axes.set_xlim(max(_LEAST_R2, low), min(high, _MOST_R2))
    axes.legend(frameon=False)
    return axes


def _targets(result: Mapping[str, Any]) -> list[str]:
    """Names of the targets of report() or compare()."""
    holder = result["contenders"][0] if "contenders" in result else result
    return [axis["name"] for axis in holder["axes"]]


def _axes(axes: Any) -> Any:
    if axes is not None:
        return axes
    from matplotlib import pyplot
    return pyplot.subplots()[1]


def _label(model: Mapping[str, Any], r2: ArrayLike) -> str:
    """No entry in the legend where nothing is drawn, as of the last value on held-out rows."""
    return str(model["name"]) if np.isfinite(r2).any() else "_"
