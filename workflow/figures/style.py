"""Common settings of the figures: size, fonts, colours for colour-blind readers, and variables of plotted data."""

from __future__ import annotations

from collections.abc import Sequence
from string import ascii_lowercase
from typing import Any

import matplotlib as mpl
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from numpy.typing import ArrayLike

from rocking.datasets.cube import MODEL_RESULT

WIDTH = 6.7
"""Width of a figure in print [in]."""

BLACK, BLUE, VERMILION = "#000000", "#0072B2", "#D55E00"
"""Colours of Okabe and Ito (2008), distinct to colour-blind readers."""

GREY = "#6B6B6B"

mpl.rcParams.update({
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
})  # fmt: skip


def shades(count: int) -> list[Any]:
    """`count` colours from dark to light of a perceptually uniform map, without its lightest part."""
    return [mpl.colormaps["viridis"](x) for x in np.linspace(0.0, 0.85, count)]


def panel_letters(axes: Sequence[Axes]) -> None:
    """(a), (b), ... above the top left corner of each panel."""
    for letter, ax in zip(ascii_lowercase, axes, strict=False):
        ax.set_title(f"({letter})", loc="left", fontweight="bold")


def plotted(dims: str | Sequence[str], values: ArrayLike, long_name: str, **attributes: Any) -> xr.Variable:
    """A variable of plotted data; dimensionless unless `units` is given."""
    return xr.Variable(dims, np.asarray(values), {**MODEL_RESULT, "long_name": long_name, **attributes})
