"""Traced overturning boundaries as lines to draw."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
import xarray as xr

from rocking.boundary.curves import curves_at
from rocking.datasets.cube import read_dataset
from rocking.model.response import Outcome
from workflow.figures.style import plotted


class Lines(NamedTuple):
    """Polylines one after the other, each followed by nan; arrays of the same shape."""

    amplitude: np.ndarray  # a = a_g/(g tan alpha) [-]
    frequency_ratio: np.ndarray  # omega [-]


def outcome_lines(curves: xr.Dataset) -> Lines:
    """The curves between overturning and survival, without those between two ways of overturning."""
    between = curves.neighbour_outcome.values < Outcome.OVERTURNED_DIRECTLY
    rows = curves.row_size.values
    kept, ends = np.repeat(between, rows), np.cumsum(rows[between])
    return Lines(
        np.insert(1 / curves.slenderness.values[kept], ends, np.nan),
        np.insert(curves.frequency_ratio.values[kept], ends, np.nan),
    )


def line_variables(files: Sequence[Path], alphas: Sequence[float] | None = None) -> dict[str, xr.Variable]:
    """The lines of several files, one for each pulse, as variables of plotted data over `vertex`.

    Parameters
    ----------
    files : sequence of paths
        Overturning boundaries, results/overturning/PULSE/eta-0.85.nc.
    alphas : sequence, optional
        Slenderness angles [rad], 0 for the slender limit; all that the files hold by default.
    """
    lines, pulse, angle = [], [], []
    for k, path in enumerate(files):
        curves = read_dataset(path)
        for alpha in np.unique(curves.alpha) if alphas is None else alphas:
            lines.append(outcome_lines(curves_at(curves, float(alpha))))
            pulse.append(np.full(lines[-1].amplitude.size, k, dtype=np.int8))
            angle.append(np.full(lines[-1].amplitude.size, alpha))
    names = ("amplitude a_g/(g tan alpha) at which the outcome changes", "frequency ratio omega_g/p there")
    amplitude, omega = (
        plotted("vertex", np.concatenate(parts), name, comment="missing between two lines")
        for parts, name in zip(zip(*lines, strict=True), names, strict=True)
    )
    return {
        "boundary_amplitude": amplitude,
        "boundary_frequency_ratio": omega,
        "boundary_pulse": plotted("vertex", np.concatenate(pulse), "index of the pulse"),
        "boundary_alpha": plotted("vertex", np.concatenate(angle), "slenderness angle, 0: slender", units="rad"),
    }


def lines_of(data: xr.Dataset, pulse: int, alpha: float) -> Lines:
    """The lines of one pulse, by its index, and one angle [rad] among the variables of `line_variables`."""
    here = (data.boundary_pulse.values == pulse) & (data.boundary_alpha.values == alpha)
    return Lines(data.boundary_amplitude.values[here], data.boundary_frequency_ratio.values[here])
