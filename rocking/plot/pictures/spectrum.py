"""Rocking spectra: peak rotation against frequency ratio or period."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from rocking._base.errors import InvalidArgumentError
from rocking._model.outcome import Outcome
from rocking.plot.style import BLUE, GREY, axes_of, label_of, plain_numbers

OVERTURNED_COLOUR = "#E0E0E0"
"""Shade of the ranges in which a block overturns."""


def spectrum(data: xr.Dataset, ax: Axes | None = None, **style: Any) -> Axes:
    """Draw a spectrum; the ranges in which the block overturns are shaded, and the curve is interrupted there.

    Parameters
    ----------
    data : xarray.Dataset
        Of one dimension: result of `rocking.Block.spectrum`, `rocking.Response.to_xarray()`, or one line of a spectrum
        cube. Rotation in radians is drawn in degrees, otherwise max |theta|/alpha.
    ax, **style
        As of `rocking.plot`.
    """
    if not isinstance(data, xr.Dataset):
        raise InvalidArgumentError("data", data, "a data set; of a response: to_xarray()")
    if "outcome" not in data or data["outcome"].ndim != 1:
        raise InvalidArgumentError("data", dict(data.sizes), "outcome and peak rotation along one dimension")
    ax = axes_of(ax)
    x = data[str(data["outcome"].dims[0])]
    order = np.argsort(x.values)
    at = x.values[order]
    in_degrees = "rotation" in data
    peak = np.degrees(data["rotation"].values) if in_degrees else data["peak_rotation"].values
    _curve(ax, at, peak[order], {"color": BLUE} | style)
    if in_degrees:
        ax.set_ylabel("peak rotation [deg]")
    else:
        ax.axhline(1.0, color=GREY, linewidth=0.5)
        ax.set_ylabel(r"peak rotation $\theta_{\max}/\alpha$ [-]")
    shade_overturned(ax, at, data["outcome"].values[order] >= Outcome.OVERTURNED_DIRECTLY)
    ax.set_xlim(at[0], at[-1])
    ax.set_ylim(bottom=0.0)
    if x.name == "period":
        plain_numbers(ax, "x")
    ax.set_xlabel(label_of(x))
    return ax


def _curve(ax: Axes, x: np.ndarray[Any, Any], y: np.ndarray[Any, Any], style: dict[str, Any]) -> None:
    """A line, interrupted where `y` is nan; a dot at a point between two interruptions, where there is no line."""
    (line,) = ax.plot(x, y, **style)
    known = np.pad(np.isfinite(y), 1)
    alone = known[1:-1] & ~known[:-2] & ~known[2:]
    if alone.any():
        ax.plot(x[alone], y[alone], color=line.get_color(), marker=".", linestyle="none")


def shade_overturned(ax: Axes, x: np.ndarray[Any, Any], overturned: np.ndarray[Any, Any]) -> None:
    """Shade the ranges of ascending `x` in which the block overturns."""
    shown = ax.get_legend_handles_labels()[1]
    label = "overturns" if overturned.any() and "overturns" not in shown else None
    ax.fill_between(
        x, 0.0, 1.0, where=overturned, transform=ax.get_xaxis_transform(), color=OVERTURNED_COLOUR, linewidth=0.0,
        zorder=0, label=label,
    )  # fmt: skip
