"""Fragility curves of one block under a suite of records."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from rocking._base.errors import InvalidArgumentError
from rocking.plot.style import BLACK, BLUE, GREY, VERMILION, axes_of, label_of, plain_numbers

POINTS = 300  # points of a fitted curve
CURVES = {"lognormal": (VERMILION, "-"), "logistic": (BLUE, "--")}  # colour and line of each kind of fitted curve


def fragility(data: xr.Dataset, ax: Axes | None = None) -> Axes:
    """Draw the fraction of the records that reach a limit state, with intervals, and the fitted curves.

    Parameters
    ----------
    data : xarray.Dataset
        Result of `rocking.fragility` for one block and one limit state; of several, `data.isel(block=0, demand=0)`.
    ax : matplotlib.axes.Axes, optional
        Where to draw; by default in a new figure.
    """
    from rocking.suites.curve import curve_probability  # noqa: PLC0415  # scipy.special: 0.2 s, only for this picture

    if "fraction" not in data or data["fraction"].dims != ("intensity",):
        several = ", ".join(f"{name}=0" for name in ("demand", "block") if name in data.dims)
        allowed = "the fragility of one block and one limit state" + (f": data.isel({several})" if several else "")
        raise InvalidArgumentError("data", dict(data.sizes), allowed)
    ax = axes_of(ax)
    draw_fractions(ax, data)
    fine = np.geomspace(data["intensity"].values[0], data["intensity"].values[-1], POINTS)
    for model in data["model"].values.tolist():
        curve = data.sel(model=model)
        colour, line = CURVES[model]
        probability = curve_probability(
            model, fine, *(float(curve[name]) for name in ("median_intensity", "dispersion"))
        )
        ax.plot(fine, probability, line, color=colour, label=model)
    ax.set_xlabel(label_of(data["intensity"]))
    ax.set_ylabel(f"probability of {data['demand'].item()} [-]")
    ax.set_title(f"{float(data['width']):g} m x {float(data['height']):g} m", loc="right")
    ax.legend(loc="upper left", frameon=True)
    return ax


def draw_fractions(ax: Axes, data: xr.Dataset) -> None:
    """Draw the observed fractions with their intervals, and that of first exceedance, over logarithmic intensities."""
    levels, fraction = data["intensity"].values, data["fraction"].values
    ends = np.abs(np.stack([data["fraction_lower"].values, data["fraction_upper"].values]) - fraction)
    label = f"records, {100.0 * data.attrs['confidence']:g} % interval"
    ax.errorbar(
        levels, fraction, ends, label=label, fmt="o", markersize=2.5, color=BLACK, linewidth=0.5, ecolor=GREY
    )  # fmt: skip
    ax.step(
        levels, data["first_fraction"], where="post", color=GREY, linestyle=":", label="first exceedance"
    )  # fmt: skip
    plain_numbers(ax, "x")
    ax.set_xlim(levels[0], levels[-1])
    ax.set_ylim(-0.03, 1.03)
