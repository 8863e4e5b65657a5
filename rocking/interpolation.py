"""Interpolation of a cube: where a value lies on the axes, which nodes serve a cell, and with which weights.

Rows are slenderness, spaced uniformly; columns are frequency_ratio, spaced uniformly in its logarithm. Cell (i, j)
lies between the nodes (i, j) and (i + 1, j + 1). It is interpolated from 4 x 4 nodes that hold it: those around it if
all of them may serve, else a block shifted by one to a side, so that cells next to a boundary keep the full order.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rocking.errors import InvalidArgumentError

STENCIL = 4
"""Nodes of a stencil in one direction: the interpolant is exact for cubics."""

SHIFTS = ((1, 1), (1, 0), (1, 2), (0, 1), (2, 1), (0, 0), (0, 2), (2, 0), (2, 2))
"""Rows and columns by which a stencil may start before its cell, the best first."""

Array = NDArray[np.float64]


def uniform_index(axis: Array, value: ArrayLike) -> Array:
    """Fractional index of `value` on a uniformly spaced ascending axis; nan outside the axis.

    Parameters
    ----------
    axis : float array, shape (n,), n >= 4
    value : array_like, any shape
        In the unit of the axis.
    """
    value = np.asarray(value, dtype=np.float64)
    inside = (value >= axis[0]) & (value <= axis[-1])  # by value: rounding of the index must not lose the end nodes
    position = (np.where(inside, value, axis[0]) - axis[0]) / (axis[-1] - axis[0]) * (axis.size - 1)
    return np.where(inside, np.clip(position, 0.0, axis.size - 1), np.nan)


def log_index(axis: Array, value: ArrayLike) -> Array:
    """Fractional index of `value` > 0 on an axis uniformly spaced in the logarithm; nan outside the axis."""
    value = np.asarray(value, dtype=np.float64)
    inside = (value >= axis[0]) & (value <= axis[-1])
    log = np.log(np.where(inside, value, axis[0]))
    position = (log - np.log(axis[0])) / np.log(axis[-1] / axis[0]) * (axis.size - 1)
    return np.where(inside, np.clip(position, 0.0, axis.size - 1), np.nan)


def cell_index(position: Array, nodes: int) -> NDArray[np.intp]:
    """Cell along one axis of `nodes` nodes that holds a fractional index in [0, nodes - 1]; the last node ends it."""
    return np.minimum(position.astype(np.intp), nodes - 2)


def lagrange_weights(local: ArrayLike) -> Array:
    """Weights of the nodes 0, 1, 2, 3 for a point at `local` in [0, 3]; shape (..., 4), they add up to 1.

    Lagrange's basis polynomials l_k(t) = prod over m != k of (t - m)/(k - m).
    """
    t0 = np.asarray(local, dtype=np.float64)
    t1, t2, t3 = t0 - 1.0, t0 - 2.0, t0 - 3.0
    return np.stack([-t1 * t2 * t3 / 6.0, t0 * t2 * t3 / 2.0, -t0 * t1 * t3 / 2.0, t0 * t1 * t2 / 6.0], axis=-1)


def level_weights(levels: Array, value: ArrayLike) -> tuple[NDArray[np.intp], NDArray[np.intp], Array]:
    """How to interpolate between unevenly spaced levels: the gap, the first level that serves, and the weights.

    Parameters
    ----------
    levels : float array, shape (k,)
        Ascending.
    value : array_like, any shape
        Within the levels.

    Returns
    -------
    gap : int array
        Level just below the value; -1 where it lies on a level.
    first : int array
        The first of the levels that serve: the four around the gap, fewer if there are no more; the level itself.
    weights : float array, shape (..., 4)
        Of `first` and those after it; 1, 0, 0, 0 on a level.
    """
    value = np.asarray(value, dtype=np.float64)
    above = np.searchsorted(levels, value, side="left")
    exact = levels[np.minimum(above, levels.size - 1)] == value
    count = min(STENCIL, levels.size)
    first = np.where(exact, above, np.clip(above - count // 2, 0, levels.size - count))
    weights = np.zeros((*value.shape, STENCIL))
    weights[exact, 0] = 1.0
    between = ~exact
    if between.any():
        x = value[between]
        nodes = levels[first[between][:, None] + np.arange(count)]
        for k in range(count):
            others = [m for m in range(count) if m != k]
            basis = [(x - nodes[:, m]) / (nodes[:, k] - nodes[:, m]) for m in others]
            weights[between, k] = np.prod(basis, axis=0)
    return np.where(exact, -1, above - 1), first, weights


def stencils(serves: NDArray[np.bool_]) -> NDArray[np.int8]:
    """For each cell the first of `SHIFTS` whose 4 x 4 nodes all serve, -1 if there is none.

    Parameters
    ----------
    serves : bool array, shape (n, m), n and m >= 4
        Nodes that may be used.

    Returns
    -------
    int8 array, shape (n - 1, m - 1)
    """
    n, m = serves.shape
    if min(n, m) < STENCIL:
        raise InvalidArgumentError("nodes", (n, m), f"axes of at least {STENCIL} nodes")
    rows = serves[:, :-3] & serves[:, 1:-2] & serves[:, 2:-1] & serves[:, 3:]
    whole = rows[:-3] & rows[1:-2] & rows[2:-1] & rows[3:]
    i, j = np.arange(n - 1)[:, None], np.arange(m - 1)
    found = np.full((n - 1, m - 1), -1, dtype=np.int8)
    for code in reversed(range(len(SHIFTS))):
        row, column = i - SHIFTS[code][0], j - SHIFTS[code][1]
        inside = (row >= 0) & (row < n - 3) & (column >= 0) & (column < m - 3)
        fits = inside & whole[np.clip(row, 0, n - 4), np.clip(column, 0, m - 4)]
        found[fits] = code
    return found


def interpolate(
    values: Array, cells: tuple[NDArray[np.intp], ...], codes: NDArray[np.int8], at: tuple[float, float]
) -> Array:
    """Interpolate at one place within each of several cells.

    Parameters
    ----------
    values : float array, shape (n, m)
        Node values.
    cells : two int arrays, shape (cells,)
        Row and column of each cell.
    codes : int8 array, shape (cells,)
        Stencil of each, as of `stencils`.
    at : two floats in [0, 1]
        Row and column of the place within the cell.
    """
    shifts = np.array(SHIFTS)[codes]
    row, column = cells[0] - shifts[:, 0], cells[1] - shifts[:, 1]
    by_row, by_column = lagrange_weights(at[0] + shifts[:, 0]), lagrange_weights(at[1] + shifts[:, 1])
    total = np.zeros(row.size)
    for p in range(STENCIL):
        for q in range(STENCIL):
            total += by_row[:, p] * by_column[:, q] * values[row + p, column + q]
    return total
