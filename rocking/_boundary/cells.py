"""Which cells of a grid the traced boundaries cross."""

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from rocking._base.arrays import Array
from rocking._boundary.curves import curves_at

MARGIN = 0.1  # a curve is widened by this share of a cell: a chord lies that close to its curve [-]
STEP = 0.2  # distance of points on a curve, in cells [-]


def crossed_cells(boundary: xr.Dataset, alpha: float, rows: Array, columns: Array) -> NDArray[np.bool_]:
    """Cells (n - 1, m - 1) of a spectrum grid that an overturning boundary crosses, or just misses.

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
    """Fractional index on an axis, carried on beyond its ends as the outermost cells go."""
    cell = np.clip(np.searchsorted(axis, value, side="right") - 1, 0, axis.size - 2)
    return cell + (value - axis[cell]) / (axis[cell + 1] - axis[cell])
