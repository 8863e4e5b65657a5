"""Settings of matplotlib for the figures, letters of panels, and variables of plotted data."""

from collections.abc import Sequence
from string import ascii_lowercase
from typing import Any

import matplotlib as mpl
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from numpy.typing import ArrayLike

from rocking._datasets.cube import MODEL_RESULT
from rocking.plot.style import GREY, STYLE

mpl.rcParams.update(STYLE)


def panel_letters(axes: Sequence[Axes]) -> None:
    """(a), (b), ... above the top left corner of each panel."""
    for letter, ax in zip(ascii_lowercase, axes, strict=False):
        ax.set_title(f"({letter})", loc="left", fontweight="bold")


def frame_detail(ax: Axes, detail: Axes, name: str = "") -> None:
    """Mark on `ax` the window that `detail` shows, in a box of the colour of its frame, with its name beside it."""
    box = ax.indicate_inset_zoom(detail, edgecolor=GREY, linewidth=0.8, alpha=1.0)
    for line in box.connectors or ():
        line.set_visible(False)  # they would cross the curves
    detail.spines[:].set(visible=True, color=GREY, linewidth=0.8)
    if name:
        corner = (detail.get_xlim()[1], detail.get_ylim()[0])
        ax.annotate(name, corner, xytext=(3, 1), textcoords="offset points", fontsize=7, color=GREY)


def plotted(dims: str | Sequence[str], values: ArrayLike, long_name: str, **attributes: Any) -> xr.Variable:
    """A variable of plotted data; dimensionless unless `units` is given."""
    return xr.Variable(dims, np.asarray(values), {**MODEL_RESULT, "long_name": long_name, **attributes})
