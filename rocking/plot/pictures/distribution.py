"""Distributions of peak rotations with their confidence bands."""

from __future__ import annotations

from typing import Any

import xarray as xr
from matplotlib.axes import Axes

from rocking._base.errors import InvalidArgumentError
from rocking.plot.style import BLUE, GREY, axes_of


def distribution(data: xr.Dataset, ax: Axes | None = None, **style: Any) -> Axes:
    """Draw a distribution of peak rotations: its steps, its interval at each rotation and, lighter, its band.

    Parameters
    ----------
    data : xarray.Dataset
        Result of `rocking.suites.distribution` of one body; of several, `data.isel(block=0, intensity=0)`.
    ax, **style
        As of `rocking.plot`.
    """
    if "band_lower" not in data or data["probability"].dims != ("rotation",):
        raise InvalidArgumentError("data", dict(data.sizes), "the distribution of one body: data.isel(block=0, ...)")
    ax = axes_of(ax)
    x = data["rotation"].values
    chosen: dict[str, Any] = {"color": BLUE} | style
    for name, shade in (("band", 0.12), ("probability", 0.25)):
        low, high = data[f"{name}_lower"].values, data[f"{name}_upper"].values
        ax.fill_between(x, low, high, step="post", color=chosen["color"], alpha=shade, linewidth=0.0)
    ax.step(x, data["probability"].values, where="post", **chosen)
    ax.axhline(1.0 - float(data["overturned"]), color=GREY, linewidth=0.5)
    ax.set_xlabel(r"peak rotation $\theta_{\max}/\alpha$ [-]")
    ax.set_ylabel("share of the members [-]")
    ax.set_xlim(x[0], x[-1])
    ax.set_ylim(0.0, 1.0)
    return ax
