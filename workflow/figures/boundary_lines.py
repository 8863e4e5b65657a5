"""Traced overturning boundaries as lines to draw."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from rocking.boundary.curves import curves_at
from rocking.datasets.cube import read_dataset
from rocking.model.response import Outcome
from workflow.figures.style import plotted

MAIN_IMPACTS = 1
"""Boundaries of overturning after at most so many impacts are drawn with the full line width [-]."""

DETAIL_WIDTH = 0.4
"""Line width of the boundaries of overturning after more impacts, as a share of the full width [-]."""


class Lines(NamedTuple):
    """Polylines one after the other, each followed by nan; arrays of the same shape."""

    amplitude: np.ndarray  # a = a_g/(g tan alpha) [-]
    frequency_ratio: np.ndarray  # omega [-]
    impacts: np.ndarray  # before overturning, -1 if not counted

    def at_level(self, *, detail: bool) -> Lines:
        """The lines of overturning after more than `MAIN_IMPACTS` impacts, or the others; nan elsewhere."""
        here = ((self.impacts < 0) | (self.impacts > MAIN_IMPACTS)) == detail
        return Lines(*(np.where(here, value, np.nan) for value in self[:2]), self.impacts)


def outcome_lines(curves: xr.Dataset) -> Lines:
    """The curves between overturning and survival, without those between two ways of overturning."""
    between = curves.neighbour_outcome.values < Outcome.OVERTURNED_DIRECTLY
    rows = curves.row_size.values
    kept, ends = np.repeat(between, rows), np.cumsum(rows[between])
    impacts = np.repeat(curves.impacts.values[between], rows[between])
    return Lines(
        np.insert(1 / curves.slenderness.values[kept], ends, np.nan),
        np.insert(curves.frequency_ratio.values[kept], ends, np.nan),
        np.insert(impacts, ends, curves.impacts.values[between]),
    )


def lines_of_files(files: Sequence[Path], alphas: Sequence[float] | None = None) -> Iterator[tuple[int, float, Lines]]:
    """Index of the pulse, angle [rad] and lines of several files, one for each pulse.

    Parameters
    ----------
    files : sequence of paths
        Overturning boundaries, results/overturning/PULSE/eta-0.85.nc.
    alphas : sequence, optional
        Slenderness angles [rad], 0 for the slender limit; all that the files hold by default.
    """
    for k, path in enumerate(files):
        curves = read_dataset(path)
        for alpha in np.unique(curves.alpha) if alphas is None else alphas:
            yield k, float(alpha), outcome_lines(curves_at(curves, float(alpha)))


def line_variables(lines: Iterable[tuple[int, float, Lines]]) -> dict[str, xr.Variable]:
    """Lines with the index of their pulse and their angle [rad] as variables of plotted data over `vertex`."""
    pulses, angles, found = zip(*lines, strict=True)
    sizes = [one.amplitude.size for one in found]
    comment = {"comment": "missing between two lines"}
    return {
        "boundary_amplitude": plotted(
            "vertex",
            np.concatenate([one.amplitude for one in found]),
            "amplitude a_g/(g tan alpha) at which the outcome changes",
            **comment,
        ),
        "boundary_frequency_ratio": plotted(
            "vertex",
            np.concatenate([one.frequency_ratio for one in found]),
            "frequency ratio omega_g/p there",
            **comment,
        ),
        "boundary_impacts": plotted(
            "vertex", np.concatenate([one.impacts for one in found]), "impacts before overturning, -1: not counted"
        ),
        "boundary_pulse": plotted("vertex", np.repeat(np.array(pulses, dtype=np.int8), sizes), "index of the pulse"),
        "boundary_alpha": plotted(
            "vertex", np.repeat(np.array(angles), sizes), "slenderness angle, 0: slender", units="rad"
        ),
    }


def lines_of(data: xr.Dataset, pulse: int, alpha: float) -> Lines:
    """The lines of one pulse, by its index, and one angle [rad] among the variables of `line_variables`."""
    here = (data.boundary_pulse.values == pulse) & (data.boundary_alpha.values == alpha)
    return Lines(*(data[f"boundary_{name}"].values[here] for name in Lines._fields))


def draw_lines(ax: Axes, x: np.ndarray, y: np.ndarray, lines: Lines, *, linewidth: float, **style: Any) -> None:
    """Draw polylines, those of overturning after several impacts thinner; `x` and `y` are made of `lines`."""
    for detail, width in ((False, linewidth), (True, DETAIL_WIDTH * linewidth)):
        shown = np.isfinite(lines.at_level(detail=detail).amplitude)
        label = {"label": style["label"]} if "label" in style and not detail else {"label": "_detail"}
        ax.plot(np.where(shown, x, np.nan), np.where(shown, y, np.nan), linewidth=width, **(style | label))
