"""Common settings of pictures: size, fonts, colours for colour-blind readers, labels of axes."""

from __future__ import annotations

from typing import Any

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

WIDTH = 6.7  # width of a figure in print [in]

BLACK, BLUE, VERMILION = "#000000", "#0072B2", "#D55E00"
"""Colours of Okabe and Ito (2008), distinct to colour-blind readers."""

GREY = "#6B6B6B"

STYLE: dict[str, Any] = {
    "font.size": 8,
    "axes.titlesize": 8,
    "axes.labelsize": 8,
    "legend.fontsize": 7,
    "xtick.labelsize": 7,
    "ytick.labelsize": 7,
    "axes.linewidth": 0.6,
    "lines.linewidth": 1.1,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "legend.frameon": False,
    "mathtext.fontset": "dejavusans",
    "savefig.dpi": 300,
    "svg.hashsalt": "rocking",  # equal identifiers in the file on every run
    "figure.constrained_layout.use": True,
}
"""Settings of matplotlib for the figures of the workflow and of the command line."""

UNITS = {"m s-2": "m/s$^2$", "m s-1": "m/s", "rad s-1": "rad/s", "1": "-"}
"""Units as drawn, where they are not drawn as they are written."""

LABELS = {
    "frequency_ratio": r"frequency ratio $\omega=\omega_g/p$",
    "slenderness": r"$g\,\tan\alpha/a_g$",
    "amplitude": r"amplitude $a=a_g/(g\,\tan\alpha)$",
    "restitution": r"coefficient of restitution $\eta$",
    "alpha": r"slenderness angle $\alpha$",
    "tau": r"time $\tau=p\,t$",
    "time": "time",
    "period": r"period of the pulse $T_p$",
    "peak_acceleration": r"peak ground acceleration $a_g$",
}
"""Labels of axes by the name of the variable, with the symbols of the paper."""


def shades(count: int) -> list[Any]:
    """`count` colours from dark to light of a perceptually uniform map, without its lightest part."""
    return [mpl.colormaps["viridis"](x) for x in np.linspace(0.0, 0.85, count)]


def axes_of(ax: Axes | None) -> Axes:
    """The given axes, or those of a new figure."""
    return plt.figure(layout="constrained").add_subplot() if ax is None else ax


def label_of(variable: xr.DataArray) -> str:
    """The label of the axis of a variable: its symbol if it has one, else its meaning; and its unit."""
    unit = str(variable.attrs.get("units", "1"))
    meaning = LABELS.get(str(variable.name), variable.attrs.get("long_name", variable.name))
    return f"{meaning} [{UNITS.get(unit, unit)}]"


def plain_numbers(ax: Axes, axis: str) -> None:
    """A logarithmic axis ("x" or "y") with ticks at 1, 2, 5 times powers of ten, written as plain numbers."""
    ax.set(**{f"{axis}scale": "log"})
    ticks = ax.xaxis if axis == "x" else ax.yaxis
    ticks.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    ticks.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    ticks.set_minor_formatter(NullFormatter())
