"""Which stencil serves a cell best, and how well: interpolation held against the solver at points of the cell."""

from __future__ import annotations

import math

from rocking._numba.compilation import FloatArray, entry
from rocking.interpolation.stencils import SQUARED, STENCIL_SHIFTS, Mesh, interpolate_in_cell

_SHIFTS = len(STENCIL_SHIFTS)


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
    """Fill `values` (cells,) with what `codes` interpolate, the peak or (1 - peak)^2, at a point of each cell."""
    for c in range(len(i)):
        squared = codes[c] >= SQUARED
        values[c] = interpolate_in_cell(
            peaks, i[c], j[c], codes[c] - SQUARED if squared else codes[c], squared, x[c], y[c], mesh
        )


@entry
def choose_stencils(
    peaks: FloatArray,
    i: FloatArray,
    j: FloatArray,
    x: FloatArray,
    y: FloatArray,
    truth: FloatArray,
    mesh: Mesh,
    codes: FloatArray,
    errors: FloatArray,
) -> None:
    """For each cell the code of least largest error at some points of it, where the one it has is not the best.

    Parameters
    ----------
    peaks : float array (n, m)
        At the nodes, nan where the block overturns: no stencil holds such a node.
    i, j : int arrays (cells,)
        Row and column of each cell.
    x, y, truth : float arrays (points, cells)
        Coordinates of the points, and the solver's peak there; where one overturns no code serves.
    codes : int array (cells,)
        What each cell has; replaced by the best.
    errors : float array (cells,)
        Largest error of the code; filled, infinite where none serves.
    """
    n, m = peaks.shape
    for c in range(len(i)):
        chosen, least = codes[c], math.inf
        for k in range(-1, 2 * _SHIFTS):
            code = codes[c] if k < 0 else k
            squared = code >= SQUARED
            shift = code - SQUARED if squared else code
            row, column = i[c] - STENCIL_SHIFTS[shift][0], j[c] - STENCIL_SHIFTS[shift][1]
            if row < 0 or column < 0 or row + 4 > n or column + 4 > m:
                continue
            largest = 0.0
            for point in range(len(truth)):
                value = interpolate_in_cell(peaks, i[c], j[c], shift, squared, x[point, c], y[point, c], mesh)
                if math.isnan(value + truth[point, c]):  # a block overturns, at a node or at the point
                    largest = math.inf
                    break
                error = abs((1.0 - math.sqrt(max(value, 0.0)) if squared else value) - truth[point, c])
                largest = max(largest, error)
            if largest < least:
                chosen, least = code, largest
        codes[c], errors[c] = chosen, least
