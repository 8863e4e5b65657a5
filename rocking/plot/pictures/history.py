"""Rotation and ground acceleration of one block against time."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from rocking._base.errors import InvalidArgumentError
from rocking._model.outcome import Outcome
from rocking.plot.style import BLUE, GREY, VERMILION, axes_of, label_of

SMALL = 0.1
"""Share of alpha below which the axis of the rotation does not reach alpha [-]: the curve would be a straight line."""


def history(data: xr.Dataset, ax: Axes | None = None, **style: Any) -> Axes:
    """Draw the rotation against time, with the impacts and the angle alpha; the title says the outcome.

    Parameters
    ----------
    data : xarray.Dataset
        Result of `rocking.time_history`, or of `history` of a block or body. Rotation in
        radians is drawn in degrees.
    ax, **style
        As of `rocking.plot`.
    """
    x = _time(data)
    ax = axes_of(ax)
    rotation = data["rotation"]
    in_degrees = rotation.attrs["units"] == "rad"
    scale, alpha = (180.0 / math.pi, math.degrees(data.attrs["alpha"])) if in_degrees else (1.0, 1.0)
    of_left = scale * data.attrs.get("alpha_left", alpha / scale)
    _mark_pulse(ax, data)
    for limit in (-of_left, alpha):
        ax.axhline(limit, color=GREY, linewidth=0.7, linestyle=(0, (4, 2)))
    ax.axhline(0.0, color=GREY, linewidth=0.5)
    ax.plot(x, scale * rotation.values, **({"color": BLUE} | style))
    impacts = data["impact_time"].values
    shown = impacts[impacts <= x.values[-1]]
    ax.plot(shown, np.zeros(shown.size), "o", color=VERMILION, markersize=2.5, label="impact")
    ax.set_ylabel(r"rotation $\theta$ [deg]" if in_degrees else r"rotation $\theta/\alpha$ [-]")
    largest = float(abs(scale * rotation).max())
    if 0.0 < largest < SMALL * min(of_left, alpha):
        ax.set_ylim(-1.2 * largest, 1.2 * largest)
        ax.set_title(rf"$\alpha$ = {alpha:.3g}{' deg' if in_degrees else ''}", loc="left", color=GREY)
    else:
        ax.annotate(
            r"$\alpha$", (1.0, alpha), xycoords=("axes fraction", "data"), xytext=(2, 0), textcoords="offset points",
            va="center", color=GREY,
        )  # fmt: skip
    ax.set_xlim(0.0, float(x.values[-1]) or None)  # one sample has no length
    ax.set_xlabel(label_of(x))
    ax.set_title(Outcome[data.attrs["outcome"]].sentence, loc="right")
    return ax


def ground_acceleration(data: xr.Dataset, ax: Axes | None = None, **style: Any) -> Axes:
    """Draw the ground acceleration of a time history; dashed lines at the smallest value that starts rocking.

    Parameters
    ----------
    data : xarray.Dataset
        As for `history`.
    ax, **style
        As of `rocking.plot`.
    """
    x = _time(data)
    ax = axes_of(ax)
    ground = data["ground_acceleration"]
    in_si = ground.attrs["units"] != "1"
    strength = data.attrs["peak_acceleration"] if in_si else 1.0
    resisted = data.attrs["slenderness"] if in_si else 1.0
    for uplift in (-resisted, data.attrs.get("slenderness_left", resisted)):
        ax.axhline(strength * uplift, color=GREY, linewidth=0.7, linestyle=(0, (4, 2)))
    ax.axhline(0.0, color=GREY, linewidth=0.5)
    ax.plot(x, ground.values, **({"color": "black"} | style))
    ax.set_xlim(0.0, float(x.values[-1]) or None)  # one sample has no length
    ax.set_xlabel(label_of(x))
    ax.set_ylabel("ground\nacceleration" + (" [m/s$^2$]" if in_si else "\n" + r"over $g\,\tan\alpha$ [-]"))
    return ax


def _time(data: xr.Dataset) -> xr.DataArray:
    """Time in seconds where it is known, else tau = p t."""
    if "rotation" not in data or "impact_time" not in data:
        raise InvalidArgumentError("data", sorted(map(str, data)), "a time history")
    return data["time"] if "time" in data.coords else data["tau"]


def _mark_pulse(ax: Axes, data: xr.Dataset) -> None:
    """Shade the time of the pulse; a recorded motion is longer than what is of interest."""
    if "pulse" in data.attrs:
        ax.axvspan(0.0, float(data.attrs["pulse_end"]), color="#F0F0F0", zorder=0)
