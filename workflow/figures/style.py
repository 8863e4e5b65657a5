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
from rocking.plot.style import STYLE

mpl.rcParams.update(STYLE)


def panel_letters(axes: Sequence[Axes]) -> None:
    """(a), (b), ... above the top left corner of each panel."""
    for letter, ax in zip(ascii_lowercase, axes, strict=False):
        ax.set_title(f"({letter})", loc="left", fontweight="bold")


def plotted(dims: str | Sequence[str], values: ArrayLike, long_name: str, **attributes: Any) -> xr.Variable:
    """A variable of plotted data; dimensionless unless `units` is given."""
    return xr.Variable(dims, np.asarray(values), {**MODEL_RESULT, "long_name": long_name, **attributes})
