"""Boundary curves of several slenderness angles in one ragged data set: put together, and taken out by angle.

A file `results/overturning/PULSE/eta-0.85.nc` holds polylines one after the other, the curves of all angles, each with
its angle in alpha(curve) [rad]; 0 stands for the slender limit.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from rocking._base.arrays import Array
from rocking._model.checks import check_one_alpha
from rocking._model.outcome import Outcome

ALPHA_TOLERANCE = 1e-12
"""Two slenderness angles that differ by less are one, written in degrees and in radians [rad]."""


def join_curves(parts: Sequence[xr.Dataset]) -> xr.Dataset:
    """Join the curves of all parts in turn: ragged polylines with equal variables over `curve` or `point`."""
    curves, points = [part.drop_dims("point") for part in parts], [part.drop_dims("curve") for part in parts]
    return xr.merge([xr.concat(curves, dim="curve"), xr.concat(points, dim="point")])


def curves_at(curves: xr.Dataset, alpha: float) -> xr.Dataset:
    """Select the curves of one slenderness angle [rad], [0, pi/2), 0 for the slender limit; there may be none."""
    selected = np.abs(curves["alpha"].values - check_one_alpha(alpha)) <= ALPHA_TOLERANCE
    points = np.repeat(selected, curves["row_size"].values)
    return curves.isel(curve=np.flatnonzero(selected), point=np.flatnonzero(points))


def points_of(curves: xr.Dataset) -> dict[str, list[Any]]:
    """Return the points of curves as columns, with the number, outcome and impacts of their curve."""
    sizes = curves["row_size"].values
    columns = {
        "curve": np.repeat(np.arange(sizes.size), sizes),
        "slenderness": curves["slenderness"].values,
        "frequency_ratio": curves["frequency_ratio"].values,
        "outcome": np.repeat([Outcome(int(code)).name for code in curves["outcome"].values], sizes),
        "impacts": np.repeat(curves["impacts"].values, sizes),
    }
    return {name: values.tolist() for name, values in columns.items()}


MARGIN = 0.1  # a curve is widened by this share of a cell: a chord lies that close to its curve [-]
STEP = 0.2  # distance of points on a curve, in cells [-]


def crossed_cells(boundary: xr.Dataset, alpha: float, rows: Array, columns: Array) -> NDArray[np.bool_]:
    """Return the cells (n - 1, m - 1) of a spectrum grid that an overturning boundary crosses, or just misses.

    `boundary`: ragged curves as of `overturning_boundary`, with alpha(curve) [rad]; `alpha`: the angle [rad], 0 for the
    slender limit; `rows` (n,), `columns` (m,): slenderness and frequency_ratio.
    """
    curves = curves_at(boundary, alpha)
    row = _index(rows, curves["slenderness"].values)
    column = _index(np.log(columns), np.log(curves["frequency_ratio"].values))
    ends = np.cumsum(curves["row_size"].values)
    inner = np.ones(row.size, dtype=bool)
    inner[ends - 1] = False  # no chord from the last point of a curve
    start = np.flatnonzero(inner)
    step = np.stack([np.diff(row), np.diff(column)])[:, start]
    count = np.ceil(np.abs(step).max(axis=0) / STEP).astype(int) + 1
    chord = np.repeat(np.arange(start.size), count)
    share = (np.arange(chord.size) - np.repeat(np.cumsum(count) - count, count)) / np.repeat(count, count)
    points = np.stack([row, column])[:, start[chord]] + share * step[:, chord]
    points = np.concatenate([points, np.stack([row, column])], axis=1)
    crossed = np.zeros((rows.size - 1, columns.size - 1), dtype=bool)
    for d_row in (-MARGIN, 0.0, MARGIN):
        for d_column in (-MARGIN, 0.0, MARGIN):
            i, j = np.floor(points[0] + d_row).astype(int), np.floor(points[1] + d_column).astype(int)
            inside = (i >= 0) & (j >= 0) & (i < crossed.shape[0]) & (j < crossed.shape[1])
            crossed[i[inside], j[inside]] = True
    return crossed


def _index(axis: Array, value: Array) -> Array:
    """Return the fractional index on an axis, carried on beyond its ends as the outermost cells go."""
    cell = np.clip(np.searchsorted(axis, value, side="right") - 1, 0, axis.size - 2)
    return cell + (value - axis[cell]) / (axis[cell + 1] - axis[cell])
