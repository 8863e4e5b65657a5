"""A measured free rocking, the body fitted to it, and what is left."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from rocking.extension import BLUE, GREY, VERMILION, InvalidArgumentError, axes_of, label_of


def plot_free_rocking(data: xr.Dataset, ax: Axes | None = None, **style: Any) -> Axes:
    """Draw the measured and the fitted rotation, the impacts, and the residual around zero, all in degrees.

    Parameters
    ----------
    data : xarray.Dataset
        Result of `rocking_assessment.identify_free_rocking`.
    ax, **style
        As of `rocking.plot`; the fitted line.
    """
    if not {"rotation", "fitted", "residual", "impact_time"} <= data.keys():
        raise InvalidArgumentError(
            "data", sorted(map(str, data)), "a result of rocking_assessment.identify_free_rocking"
        )
    ax = axes_of(ax)
    time, impacts = data["time"], data["impact_time"].values
    at_rest = np.degrees(float(data["offset"]) + float(data["drift"]) * (impacts - impacts[0]))
    ax.plot(time, np.degrees(data["rotation"]), ".", color=GREY, markersize=3, label="measured")
    ax.plot(time, np.degrees(data["fitted"]), **({"color": BLUE} | style), label="fitted")
    ax.plot(impacts, at_rest, "o", color=VERMILION, markersize=2.5, label="impact")
    ax.plot(time, np.degrees(data["residual"]), color=VERMILION, linewidth=0.6, label="residual")
    ax.set(xlabel=label_of(time), ylabel=r"rotation $\theta$ [deg]", xlim=(float(time[0]), float(time[-1])))
    ax.legend()
    return ax
