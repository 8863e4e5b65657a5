"""Four-point Lagrange interpolation on a regular grid of slenderness and frequency ratio: the pure kernels.

Rows are slenderness, spaced uniformly; columns are frequency_ratio, spaced uniformly in its logarithm. Cell (i, j)
lies between the nodes (i, j) and (i + 1, j + 1). Its stencil is the 4 x 4 nodes around it, shifted inwards at the edges
of the grid. The peak rotation is smooth only inside one fate, one count of impacts and one lobe, so a cell may be
interpolated only where its whole stencil shares the three (`smooth_cells`).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rocking.errors import InvalidArgumentError
from rocking.response import Outcome

STENCIL = 4
"""Nodes of a stencil in one direction: the interpolant is exact for cubics."""

_BLOCK = 1 << 14  # points handled at once, so that their 16 weights and 16 values stay in the cache


def uniform_index(axis: NDArray[np.float64], value: ArrayLike) -> NDArray[np.float64]:
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


def log_index(axis: NDArray[np.float64], value: ArrayLike) -> NDArray[np.float64]:
    """Fractional index of `value` > 0 on an axis uniformly spaced in the logarithm; nan outside the axis."""
    value = np.asarray(value, dtype=np.float64)
    inside = (value >= axis[0]) & (value <= axis[-1])
    log = np.log(np.where(inside, value, axis[0]))
    position = (log - np.log(axis[0])) / np.log(axis[-1] / axis[0]) * (axis.size - 1)
    return np.where(inside, np.clip(position, 0.0, axis.size - 1), np.nan)


def cell_index(position: NDArray[np.float64], nodes: int) -> NDArray[np.intp]:
    """Cell along one axis of `nodes` nodes that holds a fractional index in [0, nodes - 1]; the last node ends it."""
    return np.minimum(position.astype(np.intp), nodes - 2)


def stencil_start(cell: NDArray[np.intp], nodes: int) -> NDArray[np.intp]:
    """First node of the stencil of a cell: one before the cell, shifted inwards at either edge of the grid."""
    if nodes < STENCIL:
        raise InvalidArgumentError("nodes", nodes, f"an axis of at least {STENCIL} nodes")
    return np.clip(cell - 1, 0, nodes - STENCIL)


def lagrange_weights(local: ArrayLike) -> NDArray[np.float64]:
    """Weights of the nodes 0, 1, 2, 3 for a point at `local` in [0, 3]; shape (..., 4), they add up to 1.

    Lagrange's basis polynomials l_k(t) = prod over m != k of (t - m)/(k - m).
    """
    t0 = np.asarray(local, dtype=np.float64)
    t1, t2, t3 = t0 - 1.0, t0 - 2.0, t0 - 3.0
    return np.stack([-t1 * t2 * t3 / 6.0, t0 * t2 * t3 / 2.0, -t0 * t1 * t3 / 2.0, t0 * t1 * t2 / 6.0], axis=-1)


def lagrange4(
    values: NDArray[np.float64], row: NDArray[np.float64], column: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Interpolate `values` at fractional indices, four-point Lagrange in either direction.

    Parameters
    ----------
    values : float array, shape (n, m), n and m >= 4
        Node values; nan at a node of the stencil makes the answer nan.
    row, column : float arrays of one shape
        Fractional indices, in [0, n - 1] and [0, m - 1] (`uniform_index`, `log_index`).

    Returns
    -------
    float array of the shape of `row`.
    """
    n, m = values.shape
    flat = np.ascontiguousarray(values).reshape(-1)
    offsets = (m * np.arange(STENCIL)[:, None] + np.arange(STENCIL)).reshape(-1)
    rows, columns = np.ravel(row), np.ravel(column)
    result = np.empty(rows.size)
    for begin in range(0, rows.size, _BLOCK):
        part = slice(begin, begin + _BLOCK)
        first_row = stencil_start(cell_index(rows[part], n), n)
        first_column = stencil_start(cell_index(columns[part], m), m)
        row_weights = lagrange_weights(rows[part] - first_row)
        column_weights = lagrange_weights(columns[part] - first_column)
        nodes = flat[(first_row * m + first_column)[:, None] + offsets].reshape(-1, STENCIL, STENCIL)
        result[part] = np.einsum("pk,pkl,pl->p", row_weights, nodes, column_weights)
    return result.reshape(np.shape(row))


def uniform_cells(*labels: NDArray[np.integer]) -> NDArray[np.bool_]:
    """Cells on whose whole stencil every label has one value.

    Parameters
    ----------
    *labels : integer arrays, shape (..., n, m), n and m >= 4

    Returns
    -------
    bool array, shape (..., n - 1, m - 1)
    """
    n, m = labels[0].shape[-2:]
    row = stencil_start(np.arange(n - 1), n)[:, None]
    column = stencil_start(np.arange(m - 1), m)
    uniform = np.ones((*labels[0].shape[:-2], n - 3, m - 3), dtype=np.bool_)
    for label in labels:
        same_row = label[..., :, 1:] == label[..., :, :-1]
        same_column = label[..., 1:, :] == label[..., :-1, :]
        # 16 nodes are equal if each of the 4 rows is constant and so is their first column
        constant_rows = same_row[..., :, :-2] & same_row[..., :, 1:-1] & same_row[..., :, 2:]
        for k in range(STENCIL):
            uniform &= constant_rows[..., k : n - 3 + k, :]
        for k in range(STENCIL - 1):
            uniform &= same_column[..., k : n - 3 + k, : m - 3]
    return np.asarray(uniform[..., row, column])


def smooth_cells(
    outcome: NDArray[np.integer], impacts: NDArray[np.integer], peak_mode: NDArray[np.integer]
) -> NDArray[np.bool_]:
    """Cells that may be interpolated: all 16 nodes SAFE, with equal counts of impacts and the peak in the same lobe.

    Parameters
    ----------
    outcome, impacts, peak_mode : integer arrays, shape (..., n, m), n and m >= 4
        As in `rocking.Response`.

    Returns
    -------
    bool array, shape (..., n - 1, m - 1)
    """
    safe = outcome[..., :-1, :-1] == Outcome.SAFE
    return np.asarray(uniform_cells(outcome, impacts, peak_mode) & safe)
