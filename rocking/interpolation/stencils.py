"""Interpolation of a cube: which nodes serve a cell, and with which weights.

Rows are slenderness, columns the logarithm of frequency_ratio; both may be spaced unevenly. Cell (i, j) lies between
the nodes (i, j) and (i + 1, j + 1). It is interpolated from 4 x 4 nodes that hold it: those around it, or a block
shifted by one to a side, so that cells next to a boundary keep the full order. So it is with the levels of restitution
and of slenderness angle, which lie farther apart: there three or two serve where four do not.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rocking._numba.compilation import FloatArray, contiguous_array, entry, kernel
from rocking.errors import InvalidArgumentError

STENCIL_SIZE = 4
"""Nodes of a stencil in one direction: the interpolant is exact for cubics."""

STENCIL_SHIFTS = ((1, 1), (1, 0), (1, 2), (0, 1), (2, 1), (0, 0), (0, 2), (2, 0), (2, 2))
"""Rows and columns by which a stencil may start before its cell, the best first."""

SQUARED, OVERTURNS, NO_STENCIL = 9, 18, -1
"""Values of `stencil`: from 9 on (1 - peak)^2 is interpolated; all overturn alike; not interpolated."""

SLICE_STENCILS = ((4, 1), (4, 2), (4, 0), (3, 1), (3, 0), (2, 0))
"""How many levels may serve the gap between two, and how many of them lie below the lower of these; the best first."""

Array = NDArray[np.float64]

_ROW_SHIFT, _COLUMN_SHIFT = np.array(STENCIL_SHIFTS).T.copy()


class Mesh(NamedTuple):
    """The nodes of a cube: what its cells are interpolated over.

    Attributes
    ----------
    rows, columns : float arrays (n,), (m,)
        slenderness and the logarithm of frequency_ratio, ascending.
    row_products, column_products : float arrays (n - 3, 4), (m - 3, 4)
        Denominators of the weights of the four nodes from each on.
    """

    rows: Array
    columns: Array
    row_products: Array
    column_products: Array

    @classmethod
    def of(cls, slenderness: Array, frequency_ratio: Array) -> Mesh:
        """From the axes of a cube.

        Raises
        ------
        InvalidArgumentError
            If an axis has fewer than four nodes.
        """
        shape = slenderness.size, frequency_ratio.size
        if min(shape) < STENCIL_SIZE:
            raise InvalidArgumentError("nodes", shape, f"axes of at least {STENCIL_SIZE} nodes")
        logs = np.log(frequency_ratio)
        return cls(contiguous_array(slenderness), logs, _node_products(slenderness), _node_products(logs))

    def within(self, cells: tuple[NDArray[np.intp], ...], place: tuple[float, float]) -> tuple[Array, Array]:
        """Row and column coordinates of a place in [0, 1]^2 within each of several cells."""
        (i, j), (up, along) = cells, place
        return (
            self.rows[i] + up * (self.rows[i + 1] - self.rows[i]),
            self.columns[j] + along * (self.columns[j + 1] - self.columns[j]),
        )


def _node_products(axis: Array) -> Array:
    """Products of (x_k - x_m), m != k, for the four nodes from each on."""
    nodes = [axis[k : axis.size - 3 + k] for k in range(STENCIL_SIZE)]
    return np.stack(
        [np.prod([nodes[k] - nodes[m] for m in range(STENCIL_SIZE) if m != k], axis=0) for k in range(STENCIL_SIZE)],
        axis=-1,
    )


def cell_index(axis: Array, value: ArrayLike) -> NDArray[np.intp]:
    """Cell along an ascending axis that holds each value; the last node ends the last cell, -1 is outside."""
    value = np.asarray(value, dtype=np.float64)
    inside = (value >= axis[0]) & (value <= axis[-1])
    return np.where(inside, np.minimum(np.searchsorted(axis, value, side="right") - 1, axis.size - 2), -1)


@kernel
def lagrange_weights(axis: FloatArray, products: FloatArray, first: int, x: float) -> tuple[float, float, float, float]:
    """Lagrange's weights at x of the four nodes of an axis from `first` on."""
    d0, d1, d2, d3 = x - axis[first], x - axis[first + 1], x - axis[first + 2], x - axis[first + 3]
    below = products[first]
    return d1 * d2 * d3 / below[0], d0 * d2 * d3 / below[1], d0 * d1 * d3 / below[2], d0 * d1 * d2 / below[3]


@kernel
def interpolate_in_cell(
    values: FloatArray, i: int, j: int, shift: int, squared: bool, x: float, y: float, mesh: Mesh
) -> float:
    """Interpolated within cell (i, j), at the coordinates x and y: node values, or (1 - value)^2 if `squared`."""
    row, column = i - _ROW_SHIFT[shift], j - _COLUMN_SHIFT[shift]
    by_row = lagrange_weights(mesh.rows, mesh.row_products, row, x)
    by_column = lagrange_weights(mesh.columns, mesh.column_products, column, y)
    total = 0.0
    for p in range(4):
        along = 0.0
        for q in range(4):
            value = values[row + p, column + q]
            along += by_column[q] * ((1.0 - value) * (1.0 - value) if squared else value)
        total += by_row[p] * along
    return total


def slice_index(levels: Array, value: ArrayLike) -> tuple[NDArray[np.intp], NDArray[np.bool_]]:
    """The level at or below each value, -1 outside of them; and whether the value is that level."""
    value = np.asarray(value, dtype=np.float64)
    below = np.searchsorted(levels, value, side="right") - 1
    on_level = np.append(levels, np.nan)[below] == value  # -1 finds nan, which equals nothing
    return np.where((below < levels.size - 1) | on_level, below, -1), on_level


@entry
def lagrange_weight(levels: FloatArray, first: int, count: int, k: int, x: float) -> float:
    """Lagrange's weight at x of the k-th of `count` levels from `first` on."""
    weight = 1.0
    for m in range(count):
        if m != k:
            weight *= (x - levels[first + m]) / (levels[first + k] - levels[first + m])
    return weight


def first_valid_stencils(serves: NDArray[np.bool_]) -> NDArray[np.int8]:
    """For each cell the first of `STENCIL_SHIFTS` whose 4 x 4 nodes all serve, -1 if there is none.

    Parameters
    ----------
    serves : bool array, shape (n, m), n and m >= 4
        Nodes that may be used.

    Returns
    -------
    int8 array, shape (n - 1, m - 1)
    """
    n, m = serves.shape
    rows = serves[:, :-3] & serves[:, 1:-2] & serves[:, 2:-1] & serves[:, 3:]
    whole = rows[:-3] & rows[1:-2] & rows[2:-1] & rows[3:]
    i, j = np.arange(n - 1)[:, None], np.arange(m - 1)
    found = np.full((n - 1, m - 1), -1, dtype=np.int8)
    for code in reversed(range(len(STENCIL_SHIFTS))):
        row, column = i - STENCIL_SHIFTS[code][0], j - STENCIL_SHIFTS[code][1]
        inside = (row >= 0) & (row < n - 3) & (column >= 0) & (column < m - 3)
        fits = inside & whole[np.clip(row, 0, n - 4), np.clip(column, 0, m - 4)]
        found[fits] = code
    return found
