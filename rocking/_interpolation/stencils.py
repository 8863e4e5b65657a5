"""Lagrange interpolation of spectrum cubes: stencils, levels and their weights.

Rows are slenderness, columns the logarithm of frequency_ratio; both may have uneven spacing. Cell (i, j) lies between
the nodes (i, j) and (i + 1, j + 1). It is interpolated from the 4 x 4 nodes (i - 1, j - 1) to (i + 2, j + 2); cells at
the edge of the grid are not interpolated. Between slices of restitution and of slenderness angle the four nearest
slices are used.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rocking._base.errors import InvalidArgumentError
from rocking._interpolation.slices import STENCIL_SIZE, slice_window
from rocking._numba.compilation import FloatArray, contiguous_array, entry, jitable, kernel

NO_STENCIL, PEAK, SQUARED, OVERTURNS = -1, 0, 1, 2
"""Values of `stencil`: not interpolated; interpolated peak; interpolated (1 - peak)^2; all overturn in the same way."""

Array = NDArray[np.float64]

Weights = tuple[float, float, float, float]


class Mesh(NamedTuple):
    """The nodes over which a cube is interpolated, ascending."""

    # rows, columns: (n,), (m,) slenderness and frequency_ratio [-]
    rows: Array
    columns: Array
    logs: Array  # (m,) the logarithms of the columns, the variable of interpolation [-]

    @classmethod
    def of(cls, slenderness: Array, frequency_ratio: Array) -> Mesh:
        """Return the mesh of the axes of a cube, of at least four nodes each."""
        shape = slenderness.size, frequency_ratio.size
        if min(shape) < STENCIL_SIZE:
            raise InvalidArgumentError("nodes", shape, f"axes of at least {STENCIL_SIZE} nodes")
        return cls(contiguous_array(slenderness), contiguous_array(frequency_ratio), np.log(frequency_ratio))

    def within(self, cells: tuple[NDArray[np.intp], ...], fractions: tuple[float, float]) -> tuple[Array, Array]:
        """Return row and column coordinates of the point at these fractions [0, 1] of each of several cells."""
        (i, j), (up, along) = cells, fractions
        x, y = self.rows, self.logs
        return x[i] + up * (x[i + 1] - x[i]), y[j] + along * (y[j + 1] - y[j])


class AngleAxis(NamedTuple):
    """The slenderness angles of a cube."""

    # angles, squares: (angles,) ascending [rad], and their squares [rad2], the variable of interpolation: the equation
    # of motion depends on the square of the angle only
    angles: Array
    squares: Array
    # (2 angles - 1, 2) first angle and number of angles of points on angle k in row 2 k, of those between it and the
    # next one below
    windows: NDArray[np.int64]

    @classmethod
    def of(cls, angles: Array) -> AngleAxis:
        """Return the axis of some ascending angles [rad]."""
        size = angles.size
        windows = []
        for k in range(size - 1):
            windows += [(k, 1), slice_window(size, k)]
        windows.append((size - 1, 1))
        return cls(contiguous_array(angles), angles**2, np.array(windows, dtype=np.int64))

    def needed(self, alpha: Array) -> set[int]:
        """Return the indices of the angles from which points at some angles [rad] are interpolated."""
        low, high = alpha.min(), alpha.max()
        indices: set[int] = set()
        for angle in (low,) if low == high else np.unique(alpha):
            if self.angles[0] <= angle <= self.angles[-1]:
                k = int(self.angles.searchsorted(angle, "right")) - 1
                first, count = self.windows[2 * k + bool(self.angles[k] != angle)].tolist()
                indices.update(range(first, first + count))
        return indices


@kernel
def cell_of(nodes: FloatArray, value: float) -> int:
    """Return the cell of ascending nodes that contains a value, -1 outside; the last cell includes its end."""
    low, high = 0, len(nodes) - 1
    if not nodes[low] <= value <= nodes[high]:
        return -1
    while high - low > 1:
        middle = (low + high) >> 1
        if nodes[middle] <= value:
            low = middle
        else:
            high = middle
    return low


@jitable
def lagrange_weight(slices: FloatArray, first: int, count: int, k: int, x: float) -> float:
    """Return the Lagrange weight at x of the k-th of `count` slices from `first` on; 0 from k = `count` on."""
    weight = 1.0 if k < count else 0.0
    for m in range(count):
        if m != k and k < count:
            weight *= (x - slices[first + m]) / (slices[first + k] - slices[first + m])
    return weight


@kernel
def lagrange_weights(nodes: FloatArray, first: int, x: float) -> Weights:
    """Return the Lagrange weights at x of the four nodes from `first` on."""
    x0, x1, x2, x3 = nodes[first], nodes[first + 1], nodes[first + 2], nodes[first + 3]
    d0, d1, d2, d3 = x - x0, x - x1, x - x2, x - x3
    return (
        d1 * d2 * d3 / ((x0 - x1) * (x0 - x2) * (x0 - x3)),
        d0 * d2 * d3 / ((x1 - x0) * (x1 - x2) * (x1 - x3)),
        d0 * d1 * d3 / ((x2 - x0) * (x2 - x1) * (x2 - x3)),
        d0 * d1 * d2 / ((x3 - x0) * (x3 - x1) * (x3 - x2)),
    )


@kernel
def interpolate_in_cell(
    values: FloatArray, i: int, j: int, squared: bool, by_row: Weights, by_column: Weights
) -> float:
    """Interpolate node values, or (1 - value)^2 if `squared`, in cell (i, j) with the weights of its nodes."""
    total = 0.0
    for p in range(4):
        along = 0.0
        for q in range(4):
            value = values[i - 1 + p, j - 1 + q]
            along += by_column[q] * ((1.0 - value) * (1.0 - value) if squared else value)
        total += by_row[p] * along
    return total


@entry
def interpolate_cells(
    peaks: FloatArray,
    i: FloatArray,
    j: FloatArray,
    codes: FloatArray,
    x: FloatArray,
    y: FloatArray,
    mesh: Mesh,
    values: FloatArray,
) -> None:
    """Fill `values` (cells,) with the peak, or (1 - peak)^2 for code `SQUARED`, at one point of each cell."""
    for c in range(len(i)):
        by_row = lagrange_weights(mesh.rows, i[c] - 1, x[c])
        by_column = lagrange_weights(mesh.logs, j[c] - 1, y[c])
        values[c] = interpolate_in_cell(peaks, i[c], j[c], codes[c] == SQUARED, by_row, by_column)


def interpolated_cells(valid: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return the cells (n - 1, m - 1) whose 4 x 4 nodes are all valid; `valid` (n, m), n and m >= 4."""
    rows = valid[:, :-3] & valid[:, 1:-2] & valid[:, 2:-1] & valid[:, 3:]
    return np.pad(rows[:-3] & rows[1:-2] & rows[2:-1] & rows[3:], 1)
