"""Traced overturning boundaries as lines to draw."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from numpy.typing import NDArray

from rocking._base.arrays import Array
from rocking._model.outcome import Outcome

MAIN_IMPACTS = 1  # boundaries of overturning after at most so many impacts are drawn with the full line width [-]
DETAIL_WIDTH = 0.4  # line width of the boundaries of overturning after more impacts, as a share of the full width [-]


class Lines(NamedTuple):
    """Polylines one after the other, each followed by nan; arrays of the same shape."""

    amplitude: Array  # a = a_g/(g tan alpha) [-]
    frequency_ratio: Array  # omega [-]
    impacts: NDArray[np.int32]  # before overturning, -1 if not counted

    def at_level(self, *, detail: bool) -> Lines:
        """The lines of overturning after more than `MAIN_IMPACTS` impacts, or the others; nan elsewhere."""
        here = ((self.impacts < 0) | (self.impacts > MAIN_IMPACTS)) == detail
        return Lines(np.where(here, self.amplitude, np.nan), np.where(here, self.frequency_ratio, np.nan), self.impacts)


def outcome_lines(curves: xr.Dataset) -> Lines:
    """The curves between overturning and survival, without those between two ways of overturning."""
    between = curves["neighbour_outcome"].values < Outcome.OVERTURNED_DIRECTLY
    rows = curves["row_size"].values
    kept, ends = np.repeat(between, rows), np.cumsum(rows[between])
    impacts = np.repeat(curves["impacts"].values[between], rows[between])
    return Lines(
        np.insert(1 / curves["slenderness"].values[kept], ends, np.nan),
        np.insert(curves["frequency_ratio"].values[kept], ends, np.nan),
        np.insert(impacts, ends, curves["impacts"].values[between]),
    )


def draw_lines(ax: Axes, x: Array, y: Array, lines: Lines, *, linewidth: float, **style: Any) -> None:
    """Draw polylines, those of overturning after several impacts thinner; `x` and `y` are made of `lines`."""
    for detail, width in ((False, linewidth), (True, DETAIL_WIDTH * linewidth)):
        shown = np.isfinite(lines.at_level(detail=detail).amplitude)
        label = {"label": style["label"]} if "label" in style and not detail else {"label": "_detail"}
        ax.plot(np.where(shown, x, np.nan), np.where(shown, y, np.nan), linewidth=width, **(style | label))
