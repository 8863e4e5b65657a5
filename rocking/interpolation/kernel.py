"""Compiled interpolation of spectrum cubes at many points, with the error bound of each.

A point is interpolated from up to four slices of restitution, four slices of slenderness angle and 4 x 4 nodes of each.
What is known of a cell lies in one record of 16 bytes (`CELL_RECORD`), so that a point on slices reads one record and
four rows of peaks: most of the time is spent waiting for memory. The kernel takes arrays only; files and classes of
cubes belong to `rocking.lookup`.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rocking._numba.compilation import FloatArray, Record, contiguous_array, entry, kernel
from rocking._numba.memory import load_float32, load_float64, load_int32, prefetch
from rocking.interpolation.stencils import (
    NO_STENCIL,
    OVERTURNS,
    PEAK,
    SQUARED,
    STENCIL_SIZE,
    Mesh,
    cell_of,
    lagrange_weights,
    padded_weights,
    slice_products,
    slice_window,
)
from rocking.model.outcome import Outcome
from rocking.model.outcome_code import impacts_of_code, outcome_of_code, overturning_code

UNKNOWN_IMPACTS = -1
"""Value of `impacts` where the nodes around a point have different numbers."""

UNKNOWN, INTERPOLATED, NO_UPLIFT = 0, 1, 2
"""Values of `Found.state`: not determined by the cubes within the tolerance, interpolated, 1/a >= 1."""

CELL_RECORD = np.dtype(
    [
        ("code", np.int32),
        ("interpolation_error", np.float32),
        ("restitution_error", np.float32),
        ("alpha_error", np.float32),
    ],
    align=True,
)
"""What is known of a cell.

`code` is -1 where nothing is interpolated, else 4 v + `stencil`. Where all blocks of the cell overturn in the same way,
v is their overturning code (`rocking.model.outcome_code`), else 1 + the impacts of the four corners, 0 where these
differ. The errors are the variables of the cube [-].
"""

BLOCK = 16
"""Points whose cells are located, and read ahead of their use, together."""

_ROW, _COLUMN, _FIRST, _COUNT, _GROUP = range(5)
"""Columns of the places of a block: cell, first angle and number of angles, group of restitutions."""

PLACE_SIZE = 5
"""Number of these columns."""

_SAFE = int(Outcome.SAFE)

CELL_BYTES = CELL_RECORD.itemsize
INTERPOLATION_ERROR, RESTITUTION_ERROR, ALPHA_ERROR = 4, 8, 12
"""Size of a cell's record and offsets of its errors [bytes]."""

FORM_BITS = 2
"""Bits of a code that state the stencil: `PEAK`, `SQUARED` or `OVERTURNS`."""


SLICE_WINDOW = np.dtype(
    [
        ("restitutions", np.float64, STENCIL_SIZE),
        ("products", np.float64, STENCIL_SIZE),
        ("lower", np.int64),
        ("size", np.int64),
        ("cells", np.int64, STENCIL_SIZE),
        ("peaks", np.int64, STENCIL_SIZE),
    ]
)
"""The slices of restitution from which points on one slice, or between the same two, are interpolated.

`restitutions` are those of the slices [-], `products` the denominators of their Lagrange weights; `lower` is the slice
at or below the restitutions of the points, `size` the number of slices used. `cells` and `peaks` are addresses: of the
array (angles, n - 1, m - 1) of `CELL_RECORD` of each slice, and of its variable `peak_rotation`, float64 (angles, n, m)
[-]; those from `size` on are not read.
"""


class AngleAxis(NamedTuple):
    """The slenderness angles of a cube.

    Attributes
    ----------
    angles, squares : float arrays (angles,)
        Ascending [rad], and their squares [rad2], the variable of interpolation: the equation of motion depends on the
        square of the angle only.
    products : float array (windows, STENCIL_SIZE)
        Denominators of the Lagrange weights of the windows that start at each angle.
    """

    angles: NDArray[np.float64]
    squares: NDArray[np.float64]
    products: NDArray[np.float64]

    @classmethod
    def of(cls, angles: NDArray[np.float64]) -> AngleAxis:
        """The axis of some ascending angles [rad]."""
        return cls(contiguous_array(angles), angles**2, slice_products(angles**2))


class Found(NamedTuple):
    """Responses to be filled, arrays (points,); fields as in `rocking.solver.bounded_response`.

    Attributes
    ----------
    state : int8 array
        `UNKNOWN`, `INTERPOLATED` or `NO_UPLIFT`; the other fields are set where it is `INTERPOLATED`.
    """

    state: NDArray[np.int8]
    peak_rotation: NDArray[np.float64]
    outcome: NDArray[np.int8]
    impacts: NDArray[np.int32]
    exceeded_alpha: NDArray[np.bool_]
    error_bound: NDArray[np.float64]


def pack_cells(
    stencil: NDArray[np.int8],
    outcome: NDArray[np.int8],
    impacts: NDArray[np.int32],
    interpolation_error: NDArray[np.float32],
    restitution_error: NDArray[np.float32],
    alpha_error: NDArray[np.float32],
) -> NDArray[np.void]:
    """The records (angles, n - 1, m - 1) of the cells of a cube, from its variables (angles, n, m)."""
    lower = np.s_[:, :-1, :-1]
    corner = impacts[lower]
    equal = np.logical_and.reduce(
        [corner == impacts[:, i : i - 1 or None, j : j - 1 or None] for i in (0, 1) for j in (0, 1)]
    )
    form = stencil[lower].astype(np.int32)
    value = np.where(form == OVERTURNS, overturning_code(outcome[lower], corner), np.where(equal, corner + 1, 0))
    cells = np.empty(form.shape, CELL_RECORD)
    cells["code"] = np.where(form == NO_STENCIL, -1, (value << FORM_BITS) + form)
    cells["interpolation_error"] = interpolation_error[lower]
    cells["restitution_error"] = restitution_error[lower]
    cells["alpha_error"] = alpha_error[lower]
    return cells


@entry
def group_points(restitution: FloatArray, slices: FloatArray, group: FloatArray, counts: FloatArray) -> None:
    """Find the slices of restitution from which points are interpolated.

    Parameters
    ----------
    restitution : float array (points,)
        eta [-].
    slices : float array (n,)
        Restitutions of the cubes, ascending [-].
    group : int32 array (points,), filled
        2 k for a point on slice k, 2 k + 1 between it and the next one, -1 outside of the slices.
    counts : int64 array (2 n,), filled
        Number of points of each group.
    """
    counts[:] = 0
    for point in range(len(restitution)):
        group[point] = _group(restitution[point], slices)
        if group[point] >= 0:
            counts[group[point]] += 1


@kernel
def _group(value: float, slices: FloatArray) -> int:
    """2 k on slice k, 2 k + 1 between it and the next one, -1 outside of the slices."""
    below = -1
    for one in slices:
        below += one <= value
    if below < 0 or np.isnan(value):
        return -1
    if slices[below] == value:
        return 2 * below
    return 2 * below + 1 if below + 1 < len(slices) else -1


@kernel
def _interpolate_layer(address: int, stride: int, squared: bool, by_row: Record, by_column: Record) -> float:
    """Interpolate 4 x 4 node values, or (1 - value)^2 if `squared`, with the weights of rows and columns.

    The first value is at `address`; rows are `stride` bytes apart.
    """
    c0, c1, c2, c3 = 0.0, 0.0, 0.0, 0.0  # one for each column: the compiler makes vectors of them
    for p in range(4):
        row = address + p * stride
        c0 += by_row[p] * _form(load_float64(row), squared)
        c1 += by_row[p] * _form(load_float64(row + 8), squared)
        c2 += by_row[p] * _form(load_float64(row + 16), squared)
        c3 += by_row[p] * _form(load_float64(row + 24), squared)
    total: float = c0 * by_column[0] + c1 * by_column[1] + c2 * by_column[2] + c3 * by_column[3]
    return total


@kernel
def _peak_of(value: float) -> float:
    """The peak from an interpolated (1 - peak)^2."""
    root: float = np.sqrt(max(value, 0.0))
    return 1.0 - root


@kernel
def _form(value: float, squared: bool) -> float:
    """The interpolated variable, (1 - value)^2 or the value; a product in both cases, without a branch."""
    rest: float = (1.0 if squared else 0.0) - value
    return rest * (rest if squared else -1.0)


@entry
def interpolate_many(
    slenderness: FloatArray,
    frequency_ratio: FloatArray,
    restitution: FloatArray,
    alpha: FloatArray,
    mesh: Mesh,
    axis: AngleAxis,
    group: FloatArray,
    windows: FloatArray,
    tolerance: float,
    safety: float,
    solver_error: float,
    places: FloatArray,
    logs: FloatArray,
    counts: FloatArray,
    found: Found,
) -> None:
    """Fill `found` where the cubes determine the response within the tolerance.

    Parameters
    ----------
    slenderness, frequency_ratio, restitution, alpha : float arrays (points,)
        The points [-], [-], [-], [rad].
    mesh : Mesh
        The nodes.
    axis : AngleAxis
        The angles.
    group : int32 array (points,)
        Groups of the points, of `group_points`.
    windows : array (groups,) of `SLICE_WINDOW`
        The slices of each group; those of size 0 are not interpolated.
    tolerance : float
        Largest error bound [-].
    safety, solver_error : float
        The bound is `safety` times the sum of the measured errors, plus `solver_error` [-].
    places, logs : int64 array (BLOCK, PLACE_SIZE), float array (BLOCK,)
        Working memory.
    counts : int64 array (groups,)
        Increased by the number of points of each group that were interpolated.
    found : Found
        Responses of all points.
    """
    points = len(slenderness)
    for start in range(0, points, BLOCK):
        size = min(BLOCK, points - start)
        for k in range(size):
            point = start + k
            s, w, angle = slenderness[point], frequency_ratio[point], alpha[point]
            logs[k] = np.log(w)
            i = cell_of(mesh.rows, s, mesh.rows, s, mesh.row_guide)
            j = cell_of(mesh.frequency_ratio, w, mesh.columns, logs[k], mesh.column_guide)
            first, count = _angle_window(axis, angle)
            own = group[point]
            slices = windows[own].size if own >= 0 else 0
            if slices == 0 or i < 0 or j < 0 or s >= 1.0:
                count = 0
            places[k, _ROW], places[k, _COLUMN], places[k, _FIRST], places[k, _COUNT] = i, j, first, count
            places[k, _GROUP] = own
            _prefetch_point(places[k], mesh, windows)
        for k in range(size):
            point = start + k
            if places[k, _COUNT]:
                counts[places[k, _GROUP]] += _interpolate_point(
                    point,
                    places[k],
                    (slenderness[point], logs[k], restitution[point], alpha[point]),
                    mesh,
                    axis,
                    windows,
                    (tolerance, safety, solver_error),
                    found,
                )


@kernel
def _angle_window(axis: AngleAxis, angle: float) -> tuple[int, int]:
    """First and number of the angles from which a point is interpolated; the number is 0 outside of the axis."""
    below, size = -1, len(axis.angles)
    for k in range(size):
        below += axis.angles[k] <= angle
    if below < 0:
        return 0, 0
    if axis.angles[below] == angle:
        return below, 1
    return slice_window(size, below) if below + 1 < size else (0, 0)


@kernel
def _prefetch_point(place: FloatArray, mesh: Mesh, windows: FloatArray) -> None:
    """Prefetch the records and peaks of a point."""
    i, j, first, count, own = place[_ROW], place[_COLUMN], place[_FIRST], place[_COUNT], place[_GROUP]
    rows, columns = len(mesh.rows), len(mesh.columns)
    for layer in range(first, first + count):
        for e in range(windows[own].size):
            prefetch(windows[own].cells[e] + CELL_BYTES * ((layer * (rows - 1) + i) * (columns - 1) + j))
            for p in range(STENCIL_SIZE):
                prefetch(windows[own].peaks[e] + 8 * ((layer * rows + i - 1 + p) * columns + j - 1))
                prefetch(windows[own].peaks[e] + 8 * ((layer * rows + i - 1 + p) * columns + j + 2))


@kernel
def _interpolate_point(
    point: int,
    place: FloatArray,
    coordinates: Record,
    mesh: Mesh,
    axis: AngleAxis,
    windows: FloatArray,
    limits: Record,
    found: Found,
) -> bool:
    """`interpolate_many` for one point, given its cell and the window of its angle."""
    i, j, first, count = place[_ROW], place[_COLUMN], place[_FIRST], place[_COUNT]
    window = windows[place[_GROUP]]
    size = window.size
    s, x, eta, angle = coordinates
    tolerance, safety, solver_error = limits
    rows, columns = len(mesh.rows), len(mesh.columns)
    # offsets in bytes: of the cell and of the first node of its stencil in the first layer, and of one layer
    cell_layer, peak_layer = CELL_BYTES * (rows - 1) * (columns - 1), 8 * rows * columns
    cell_offset = CELL_BYTES * (i * (columns - 1) + j) + first * cell_layer
    peak_offset = 8 * ((i - 1) * columns + j - 1) + first * peak_layer
    lower = window.cells[window.lower] + cell_offset
    error = 0.0
    by_angle = by_slice = (1.0, 0.0, 0.0, 0.0)
    if count > 1:
        by_angle = padded_weights(axis.squares, axis.products[first], first, count, angle * angle)
        below = np.searchsorted(axis.angles, angle) - 1 - first
        error = float(load_float32(lower + below * cell_layer + ALPHA_ERROR))
        if size > 1:  # between slices: the larger of the two measured on either side, nan if either is
            upper = window.cells[window.lower + 1] + cell_offset
            error = np.maximum(error, float(load_float32(upper + below * cell_layer + ALPHA_ERROR)))
    if size > 1:
        by_slice = padded_weights(window.restitutions, window.products, 0, size, eta)
    kind, agree, all_squared, impacts = -1, True, True, -2
    for a in range(count):
        if size > 1:
            error += abs(by_angle[a]) * load_float32(lower + a * cell_layer + RESTITUTION_ERROR)
        for e in range(size):
            cell = window.cells[e] + cell_offset + a * cell_layer
            code = load_int32(cell)
            this = code if code & 3 == OVERTURNS else PEAK
            agree = agree and code >= 0 and kind in (-1, this)
            kind = this
            all_squared = all_squared and code & 3 == SQUARED
            corners = (code >> FORM_BITS) - 1
            impacts = corners if impacts in (-2, corners) else UNKNOWN_IMPACTS
            error += abs(by_angle[a] * by_slice[e]) * load_float32(cell + INTERPOLATION_ERROR)
    if not agree or np.isnan(error):
        return False
    if kind & 3 == OVERTURNS:
        code = kind >> FORM_BITS
        found.peak_rotation[point] = np.nan
        found.outcome[point] = outcome_of_code(code)
        found.impacts[point] = impacts_of_code(code)
        found.exceeded_alpha[point] = True
        found.error_bound[point] = np.nan
        found.state[point] = INTERPOLATED
        return True
    bound = safety * error + solver_error
    if bound > tolerance:
        return False
    by_row = lagrange_weights(mesh.rows, mesh.row_products, i - 1, s)
    by_column = lagrange_weights(mesh.columns, mesh.column_products, j - 1, x)
    peak = 0.0
    for a in range(count):
        layer_squared = all_squared
        if not all_squared:
            layer_squared = True
            for e in range(size):
                code = load_int32(window.cells[e] + cell_offset + a * cell_layer)
                layer_squared = layer_squared and code & 3 == SQUARED
        layer_value = 0.0
        for e in range(size):
            squared = load_int32(window.cells[e] + cell_offset + a * cell_layer) & 3 == SQUARED
            stencil = window.peaks[e] + peak_offset + a * peak_layer
            value = _interpolate_layer(stencil, 8 * columns, squared, by_row, by_column)
            # (1 - peak)^2 is interpolated where all slices have it, as when the errors were measured
            layer_value += by_slice[e] * (_peak_of(value) if squared and not layer_squared else value)
        peak += by_angle[a] * (_peak_of(layer_value) if layer_squared and not all_squared else layer_value)
    if all_squared:
        peak = _peak_of(peak)
    # a block that survives passes alpha if and only if its peak does: unknown for a peak within its bound of alpha
    if abs(peak - 1.0) <= bound:
        return False
    found.peak_rotation[point] = max(peak, 0.0)
    found.outcome[point] = _SAFE
    found.impacts[point] = impacts
    found.exceeded_alpha[point] = peak > 1.0
    found.error_bound[point] = bound
    found.state[point] = INTERPOLATED
    return True
