"""Lagrange interpolation of spectrum cubes: stencils, slice windows and their weights.

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
from rocking._interpolation.slices import STENCIL_SIZE
from rocking._numba.compilation import FloatArray, contiguous_array, entry, kernel
from rocking._numba.memory import load_float64, load_int32
from rocking._numba.quads import load_quad, numbers_of, quad

NO_STENCIL, PEAK, SQUARED, OVERTURNS = -1, 0, 1, 2
"""Values of `stencil`: not interpolated; interpolated peak; interpolated (1 - peak)^2; all overturn in the same way."""

GUIDE_SIZE = 4
"""Parts per cell of the guide to the cells of an axis: a search takes a few tenths of a step on average [-]."""

Array = NDArray[np.float64]

Weights = tuple[float, float, float, float]


class NodeAxis(NamedTuple):
    """Nodes along an axis of a mesh, which may have uneven spacing.

    Attributes
    ----------
    values, coordinates : float arrays (n,)
        Ascending nodes in the variable of the cube and in that of interpolation [-].
    products : float array (n - 3, 4)
        Denominators of the Lagrange weights of the four nodes from each node on.
    guide : int32 array
        The cell at the start of each of `GUIDE_SIZE` equal parts per cell, see `cell_of`.
    parts : float
        Parts of the guide per unit of the coordinate.
    """

    values: Array
    coordinates: Array
    products: Array
    guide: NDArray[np.int32]
    parts: float

    @classmethod
    def of(cls, values: Array, coordinates: Array) -> NodeAxis:
        """The axis of at least four ascending nodes."""
        span = coordinates[-1] - coordinates[0]
        parts = GUIDE_SIZE * (values.size - 1)
        starts = coordinates[0] + span * np.arange(parts) / parts
        cells = np.minimum(np.searchsorted(coordinates, starts, side="right") - 1, values.size - 2)
        return cls(
            contiguous_array(values),
            contiguous_array(coordinates),
            _node_products(coordinates),
            cells.astype(np.int32),
            float(parts / span),
        )


class Mesh(NamedTuple):
    """The nodes over which a cube is interpolated.

    Attributes
    ----------
    rows, columns : NodeAxis
        slenderness, and frequency_ratio, of which the logarithm is the variable of interpolation.
    """

    rows: NodeAxis
    columns: NodeAxis

    @classmethod
    def of(cls, slenderness: Array, frequency_ratio: Array) -> Mesh:
        """The mesh of the axes of a cube.

        Raises
        ------
        InvalidArgumentError
            If an axis has fewer than four nodes.
        """
        shape = slenderness.size, frequency_ratio.size
        if min(shape) < STENCIL_SIZE:
            raise InvalidArgumentError("nodes", shape, f"axes of at least {STENCIL_SIZE} nodes")
        return cls(NodeAxis.of(slenderness, slenderness), NodeAxis.of(frequency_ratio, np.log(frequency_ratio)))

    def within(self, cells: tuple[NDArray[np.intp], ...], place: tuple[float, float]) -> tuple[Array, Array]:
        """Row and column coordinates of a point, given by its fractions [0, 1] of a cell, in each of several cells."""
        (i, j), (up, along) = cells, place
        x, y = self.rows.coordinates, self.columns.coordinates
        return x[i] + up * (x[i + 1] - x[i]), y[j] + along * (y[j + 1] - y[j])


def _node_products(axis: Array) -> Array:
    """Products of (x_k - x_m), m != k, for the four nodes from each node on."""
    nodes = [axis[k : axis.size - 3 + k] for k in range(STENCIL_SIZE)]
    return np.stack(
        [np.prod([nodes[k] - nodes[m] for m in range(STENCIL_SIZE) if m != k], axis=0) for k in range(STENCIL_SIZE)],
        axis=-1,
    )


@kernel
def cell_of(axis: NodeAxis, value: float, x: float) -> int:
    """Cell of an axis that contains a value; the last cell includes its end; -1 outside of the axis.

    The guide gives a cell near the right one in constant time; comparing `value` with the nodes then decides exactly.
    The first comparison is added, not branched on: it is true for a tenth of the points.

    Parameters
    ----------
    axis : NodeAxis
        The nodes.
    value, x : float
        The point in the variable of the cube and in that of interpolation [-].
    """
    nodes, last = axis.values.ctypes.data, len(axis.values) - 1
    if not load_float64(nodes) <= value <= load_float64(nodes + 8 * last):
        return -1
    part = min(max(int((x - axis.coordinates[0]) * axis.parts), 0), len(axis.guide) - 1)
    cell: int = load_int32(axis.guide.ctypes.data + 4 * part)
    cell += (load_float64(nodes + 8 * (cell + 1)) <= value) & (cell + 1 < last)
    while cell + 1 < last and load_float64(nodes + 8 * (cell + 1)) <= value:
        cell += 1
    while load_float64(nodes + 8 * cell) > value:
        cell -= 1
    return cell


@entry
def lagrange_weight(slices: FloatArray, first: int, count: int, k: int, x: float) -> float:
    """Lagrange weight at x of the k-th of `count` slices from `first` on."""
    weight = 1.0
    for m in range(count):
        if m != k:
            weight *= (x - slices[first + m]) / (slices[first + k] - slices[first + m])
    return weight


@kernel
def lagrange_weights(axis: NodeAxis, first: int, x: float) -> Weights:
    """Lagrange weights at x of the four nodes of an axis from `first` on."""
    d0, d1, d2, d3 = numbers_of(x - load_quad(axis.coordinates.ctypes.data + 8 * first))
    weights: Weights = _quotients(d0, d1, d2, d3, axis.products.ctypes.data + 8 * STENCIL_SIZE * first)
    return weights


@kernel
def _quotients(d0: float, d1: float, d2: float, d3: float, products: int) -> Weights:
    """Lagrange weights from the distances to four nodes and the address of their products."""
    above = quad(d1 * d2 * d3, d0 * d2 * d3, d0 * d1 * d3, d0 * d1 * d2)
    weights: Weights = numbers_of(above / load_quad(products))
    return weights


@kernel
def padded_weights(slices: FloatArray, products: FloatArray, first: int, count: int, x: float) -> Weights:
    """Lagrange weights at x of `count` slices from `first` on, 0 for those above; a row of `slice_products`."""
    d0, d1 = x - slices[first], x - slices[first + 1]
    d2 = x - slices[first + 2] if count > 2 else 1.0
    d3 = x - slices[first + 3] if count > 3 else 1.0
    weights: Weights = _quotients(d0, d1, d2, d3, products.ctypes.data)
    return weights


def slice_products(slices: Array) -> Array:
    """Denominators of `padded_weights` (windows, STENCIL_SIZE); infinite for slices that do not exist."""
    size = min(slices.size, STENCIL_SIZE)
    windows = [slices[first : first + size] for first in range(slices.size - size + 1)]
    products = np.full((len(windows), STENCIL_SIZE), np.inf)
    for row, window in zip(products, windows, strict=True):
        row[:size] = [np.prod(np.delete(window[k] - window, k)) for k in range(size)]
    return products


@kernel
def interpolate_in_cell(values: FloatArray, i: int, j: int, squared: bool, x: float, y: float, mesh: Mesh) -> float:
    """Interpolate node values, or (1 - value)^2 if `squared`, at the coordinates x and y of cell (i, j)."""
    by_row = lagrange_weights(mesh.rows, i - 1, x)
    by_column = lagrange_weights(mesh.columns, j - 1, y)
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
        values[c] = interpolate_in_cell(peaks, i[c], j[c], codes[c] == SQUARED, x[c], y[c], mesh)


def interpolated_cells(valid: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Cells (n - 1, m - 1) whose 4 x 4 nodes are all valid.

    Parameters
    ----------
    valid : bool array, shape (n, m), n and m >= 4
        Nodes that may be used.
    """
    rows = valid[:, :-3] & valid[:, 1:-2] & valid[:, 2:-1] & valid[:, 3:]
    return np.pad(rows[:-3] & rows[1:-2] & rows[2:-1] & rows[3:], 1)
