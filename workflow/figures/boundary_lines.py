"""Traced overturning boundaries of files as lines, and as variables of plotted data."""

from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

import numpy as np
import xarray as xr

from rocking._boundary.curves import curves_at
from rocking._datasets.cube import read_dataset
from rocking.plot.boundary_lines import Lines, outcome_lines
from workflow.figures.style import plotted


def lines_of_files(files: Sequence[Path], alphas: Sequence[float] | None = None) -> Iterator[tuple[int, float, Lines]]:
    """Index of the pulse, angle [rad] and lines of several files, one for each pulse.

    `files`: overturning boundaries, results/overturning/PULSE/eta-0.85.nc. `alphas`: slenderness angles [rad], 0 for
    the slender limit; all that the files hold by default.
    """
    for k, path in enumerate(files):
        curves = read_dataset(path)
        for alpha in np.unique(curves.alpha) if alphas is None else alphas:
            yield k, float(alpha), outcome_lines(curves_at(curves, float(alpha)))


def line_variables(lines: Iterable[tuple[int, float, Lines]]) -> dict[str, xr.Variable]:
    """Lines with the index of their pulse and their angle [rad] as variables of plotted data over `vertex`."""
    pulses, angles, found = zip(*lines, strict=True)
    sizes = [one.amplitude.size for one in found]
    gaps = {"comment": "missing between two lines"}
    texts: dict[str, tuple[str, dict[str, str]]] = {
        "amplitude": ("amplitude a_g/(g tan alpha) at which the outcome changes", gaps),
        "frequency_ratio": ("frequency ratio omega_g/p there", gaps),
        "impacts": ("impacts before overturning, -1: not counted", {}),
    }
    return {
        f"boundary_{name}": plotted("vertex", np.concatenate([getattr(one, name) for one in found]), text, **comment)
        for name, (text, comment) in texts.items()
    } | {
        "boundary_pulse": plotted("vertex", np.repeat(np.array(pulses, dtype=np.int8), sizes), "index of the pulse"),
        "boundary_alpha": plotted(
            "vertex", np.repeat(np.array(angles), sizes), "slenderness angle, 0: slender", units="rad"
        ),
    }


def lines_of(data: xr.Dataset, pulse: int, alpha: float) -> Lines:
    """The lines of one pulse, by its index, and one angle [rad] among the variables of `line_variables`."""
    here = (data.boundary_pulse.values == pulse) & (data.boundary_alpha.values == alpha)
    return Lines(*(data[f"boundary_{name}"].values[here] for name in Lines._fields))
