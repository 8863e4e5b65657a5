"""Boundary curves of several slenderness angles in one ragged data set: put together, and taken out by angle.

A file `results/overturning/PULSE/eta-0.85.nc` holds polylines one after the other, the curves of all angles, each with
its angle in alpha(curve) [rad]; 0 stands for the slender limit.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from rocking._model.checks import check_one_alpha
from rocking._model.outcome import Outcome

ALPHA_TOLERANCE = 1e-12
"""Two slenderness angles that differ by less are one, written in degrees and in radians [rad]."""


def join_curves(parts: Sequence[xr.Dataset]) -> xr.Dataset:
    """The curves of all parts in turn: ragged polylines with equal variables over `curve` or `point`."""
    curves, points = ([part.drop_dims(other) for part in parts] for other in ("point", "curve"))
    return xr.merge([xr.concat(curves, dim="curve"), xr.concat(points, dim="point")])


def curves_at(curves: xr.Dataset, alpha: float) -> xr.Dataset:
    """The curves of one slenderness angle [rad], [0, pi/2), 0 for the slender limit; of size 0 if there are none."""
    wanted = np.abs(curves["alpha"].values - check_one_alpha(alpha)) <= ALPHA_TOLERANCE
    points = np.repeat(wanted, curves["row_size"].values)
    return curves.isel(curve=np.flatnonzero(wanted), point=np.flatnonzero(points))


def points_of(curves: xr.Dataset) -> dict[str, list[Any]]:
    """The points of curves as columns, with the number, outcome and impacts of their curve."""
    sizes = curves["row_size"].values
    columns = {
        "curve": np.repeat(np.arange(sizes.size), sizes),
        "slenderness": curves["slenderness"].values,
        "frequency_ratio": curves["frequency_ratio"].values,
        "outcome": np.repeat([Outcome(int(code)).name for code in curves["outcome"].values], sizes),
        "impacts": np.repeat(curves["impacts"].values, sizes),
    }
    return {name: values.tolist() for name, values in columns.items()}
