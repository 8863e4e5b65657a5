"""Compiled interpolation of spectrum cubes at many points, with the error bound of each.

A point is interpolated from up to four slices of restitution, four slices of slenderness angle and 4 x 4 nodes of each.
Waiting for memory takes most of the time. So points are processed in blocks, in three steps, each of which prefetches
what the next one reads:

1. the cells of the points are located;
2. their records (`rocking._interpolation.cells`) decide which points overturn, which are unknown, and the error bounds
   of the others;
3. only for these the peaks (`rocking._interpolation.strips`) are read and interpolated.

The kernel takes arrays only; files and classes of cubes belong to `rocking._lookup`.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rocking._interpolation.cells import ALPHA_ERROR, CELL_BYTES, FORM_BITS, INTERPOLATION_ERROR, RESTITUTION_ERROR
from rocking._interpolation.slices import STENCIL_SIZE
from rocking._interpolation.stencils import (
    OVERTURNS,
    SQUARED,
    Mesh,
    cell_of,
    lagrange_weights,
    padded_weights,
)
from rocking._interpolation.strips import NODE_BYTES, ROW_BYTES, STRIP_STEP, strip_count
from rocking._interpolation.windows import AngleAxis, groups_of, load_some
from rocking._model.outcome import Outcome
from rocking._model.outcome_code import impacts_of_code, outcome_of_code
from rocking._numba.compilation import FloatArray, Record, entry, kernel
from rocking._numba.memory import load_float32, load_int32, prefetch
from rocking._numba.quads import load_quad, numbers_of, quad, select_quad
from rocking._numba.simd import LANES, store
from rocking._numba.simd_exponentials import logarithm

UNKNOWN_IMPACTS = -1
"""Value of `impacts` where the nodes around a point have different numbers."""

UNKNOWN, INTERPOLATED, NO_UPLIFT = 0, 1, 2
"""Values of `Found.state`: not determined by the cubes within the tolerance, interpolated, 1/a >= 1."""

BLOCK = LANES
"""Points that take a step together."""

WORK = 4 * BLOCK
"""Points for which there is memory between the first step and the last: three blocks, and a power of two."""

POINT = np.dtype(
    [
        ("index", np.int64),
        ("group", np.int64),
        ("size", np.int64),
        ("first", np.int64),
        ("count", np.int64),
        ("below", np.int64),
        ("row", np.int64),
        ("column", np.int64),
        ("cell", np.int64),
        ("peak", np.int64),
        ("some", np.int64),
        ("every", np.int64),
        ("log", np.float64),
        ("bound", np.float64),
        ("by_angle", np.float64, STENCIL_SIZE),
        ("by_slice", np.float64, STENCIL_SIZE),
    ]
)
"""A point on its way through the steps.

`index` is its place in the arrays of points, `group` its group of restitutions (`group_points`) and `size` the number
of their slices, 0 for a point that is not interpolated. The `count` angles from `first` on are used; `below` is the
place among them of the one at or below the angle of the point. (`row`, `column`) is the cell, `log` the logarithm of
the frequency ratio [-]. `cell` and `peak` are the offsets of the first record, and of the first node of the first
stencil, in the tables of a slice [bytes]. `some` has the bits of any code of the cells, `every` the bits of all codes.
`bound` is the error bound [-]; `by_angle` and `by_slice` are the weights of the angles and slices.
"""

_NOT_DETERMINED, _OVERTURNS, _SURVIVES = range(3)
"""What the records state about a point."""

_SAFE = int(Outcome.SAFE)


class Found(NamedTuple):
    """Responses to be filled, arrays (points,); fields as in `rocking._solver.bounded_response`.

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


@entry
def interpolate_many(
    slenderness: FloatArray,
    frequency_ratio: FloatArray,
    restitution: FloatArray,
    alpha: FloatArray,
    mesh: Mesh,
    axis: AngleAxis,
    groups: FloatArray,
    windows: FloatArray,
    tolerance: float,
    safety: float,
    solver_error: float,
    work: FloatArray,
    survivors: FloatArray,
    logs: FloatArray,
    angle_groups: FloatArray,
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
    groups : int32 array (points,)
        Groups of the points by their restitutions, of `group_points`.
    windows : array (groups,) of `SLICE_WINDOW`
        The slices of each group of restitutions; those of size 0 are not interpolated.
    tolerance : float
        Largest error bound [-].
    safety, solver_error : float
        The bound is `safety` times the sum of the measured errors, plus `solver_error` [-].
    work, survivors, logs, angle_groups : arrays (WORK,) of `POINT`, int64 (2, BLOCK), float (BLOCK,) and (BLOCK,)
        Working memory.
    counts : int64 array (groups,)
        Increased by the number of points of each group that were interpolated.
    found : Found
        Responses of all points.
    """
    points = len(slenderness)
    blocks = -(-points // BLOCK)
    surviving = surviving_before = 0
    for block in range(blocks + 2):
        start = block * BLOCK
        if start < points:
            store(logs, 0, logarithm(load_some(frequency_ratio, start, logs)))
            store(angle_groups, 0, groups_of(load_some(alpha, start, angle_groups), axis.angles))
        for k in range(start, min(start + BLOCK, points)):
            point = work[k % WORK]
            point.index, point.group, point.log = k, groups[k], logs[k - start]
            point.size = windows[groups[k]].size if groups[k] >= 0 else 0
            _locate(point, slenderness[k], frequency_ratio[k], int(angle_groups[k - start]), mesh, axis)
        for k in range(start, min(start + BLOCK, points)):
            point = work[k % WORK]
            if point.size:
                _prefetch_cells(point, windows[point.group])
        surviving_before, surviving = surviving, 0
        for k in range(max(start - BLOCK, 0), min(start, points)):
            point = work[k % WORK]
            if point.size:
                place = restitution[k], alpha[k]
                known = _judge(point, windows[point.group], place, axis, (tolerance, safety, solver_error))
                if known == _OVERTURNS:
                    _put_overturning(point, found)
                    counts[point.group] += 1
                survivors[block % 2, surviving] = k % WORK
                surviving += known == _SURVIVES
        for k in range(surviving):
            point = work[survivors[block % 2, k]]
            _prefetch_peaks(point, windows[point.group], mesh)
        for k in range(surviving_before):
            point = work[survivors[1 - block % 2, k]]
            counts[point.group] += _interpolate(point, windows[point.group], slenderness[point.index], mesh, found)


@kernel
def _locate(point: Record, s: float, w: float, angle_group: int, mesh: Mesh, axis: AngleAxis) -> None:
    """Set the cell and the angles of a point, and its size to 0 if it is outside of them."""
    i, j = cell_of(mesh.rows, s, s), cell_of(mesh.columns, w, point.log)
    if i < 0 or j < 0 or angle_group < 0 or s >= 1.0:
        point.size = 0
        return
    first, count = axis.windows[angle_group, 0], axis.windows[angle_group, 1]
    rows, columns = len(mesh.rows.values), len(mesh.columns.values)
    strip = (j - 1) // STRIP_STEP
    point.row, point.column = i, j
    point.first, point.count, point.below = first, count, (angle_group >> 1) - first
    point.cell = CELL_BYTES * ((i * (columns - 1) + j) * len(axis.angles) + first)
    point.peak = ROW_BYTES * ((first * strip_count(columns) + strip) * rows + i - 1)
    point.peak += NODE_BYTES * (j - 1 - strip * STRIP_STEP)


@kernel
def _prefetch_cells(point: Record, window: Record) -> None:
    """Prefetch the records of a point: of the first and the last of its angles, from each slice."""
    for e in range(point.size):
        cell = window.cells[e] + point.cell
        prefetch(cell)
        prefetch(cell + CELL_BYTES * (point.count - 1))


@kernel
def _judge(point: Record, window: Record, place: Record, axis: AngleAxis, limits: Record) -> int:
    """What the records of a point state; sets its codes, and if it survives its bound and weights."""
    count, size, first = point.count, point.size, point.first
    eta, angle = place
    lower = window.cells[window.lower] + point.cell
    error = 0.0
    by_angle = by_slice = (1.0, 0.0, 0.0, 0.0)
    if count > 1:
        by_angle = padded_weights(axis.squares, axis.products[first], first, count, angle * angle)
        error = float(load_float32(lower + CELL_BYTES * point.below + ALPHA_ERROR))
        if size > 1:  # between slices: the larger of the two measured on either side, nan if either is
            upper = window.cells[window.lower + 1] + point.cell
            error = np.maximum(error, float(load_float32(upper + CELL_BYTES * point.below + ALPHA_ERROR)))
    if size > 1:
        by_slice = padded_weights(window.restitutions, window.products, 0, size, eta)
    some = every = int(load_int32(lower))
    for a in range(count):
        if size > 1:
            error += abs(by_angle[a]) * load_float32(lower + CELL_BYTES * a + RESTITUTION_ERROR)
        for e in range(size):
            cell = window.cells[e] + point.cell + CELL_BYTES * a
            code = load_int32(cell)
            some |= code
            every &= code
            error += abs(by_angle[a] * by_slice[e]) * load_float32(cell + INTERPOLATION_ERROR)
    point.some, point.every = some, every
    if some < 0 or np.isnan(error):
        return _NOT_DETERMINED
    if some & OVERTURNS:
        return _OVERTURNS if some == every else _NOT_DETERMINED
    tolerance, safety, solver_error = limits
    point.bound = safety * error + solver_error
    for k in range(STENCIL_SIZE):
        point.by_angle[k], point.by_slice[k] = by_angle[k], by_slice[k]
    return _SURVIVES if point.bound <= tolerance else _NOT_DETERMINED


@kernel
def _put_overturning(point: Record, found: Found) -> None:
    """Set the response of a point whose cells all overturn in the same way."""
    k, code = point.index, point.some >> FORM_BITS
    found.peak_rotation[k] = np.nan
    found.outcome[k] = outcome_of_code(code)
    found.impacts[k] = impacts_of_code(code)
    found.exceeded_alpha[k] = True
    found.error_bound[k] = np.nan
    found.state[k] = INTERPOLATED


@kernel
def _layer_bytes(mesh: Mesh) -> int:
    """Size of the peaks of one angle [bytes]."""
    strips: int = strip_count(len(mesh.columns.values))
    return ROW_BYTES * len(mesh.rows.values) * strips


@kernel
def _prefetch_peaks(point: Record, window: Record, mesh: Mesh) -> None:
    """Prefetch the peaks of a point: four rows of a strip, from each slice and angle."""
    layer = _layer_bytes(mesh)
    for e in range(point.size):
        peak = window.peaks[e] + point.peak
        for _ in range(point.count):
            prefetch(peak)
            prefetch(peak + ROW_BYTES)
            prefetch(peak + 2 * ROW_BYTES)
            prefetch(peak + 3 * ROW_BYTES)
            peak += layer


@kernel
def _interpolate(point: Record, window: Record, s: float, mesh: Mesh, found: Found) -> bool:
    """Set the response of a surviving point; False if it is not known whether its peak exceeds alpha."""
    k, layer = point.index, _layer_bytes(mesh)
    by_row = lagrange_weights(mesh.rows, point.row - 1, s)
    by_column = lagrange_weights(mesh.columns, point.column - 1, point.log)
    if (point.some ^ point.every) & SQUARED:
        peak = _interpolate_both_forms(point, window, layer, by_row, by_column)
    else:
        squared = point.every & SQUARED != 0
        columns = quad(0.0, 0.0, 0.0, 0.0)
        for e in range(point.size):
            stencil = window.peaks[e] + point.peak
            for a in range(point.count):
                columns += point.by_angle[a] * point.by_slice[e] * _sum_rows(stencil, squared, by_row)
                stencil += layer
        value = _sum_columns(columns, by_column)
        peak = _peak_of(value) if squared else value
    # a block that survives passes alpha if and only if its peak does: unknown for a peak within its bound of alpha
    if abs(peak - 1.0) <= point.bound:
        return False
    found.peak_rotation[k] = max(peak, 0.0)
    found.outcome[k] = _SAFE
    impacts = (point.every >> FORM_BITS) - 1
    found.impacts[k] = impacts if point.some >> FORM_BITS == point.every >> FORM_BITS else UNKNOWN_IMPACTS
    found.exceeded_alpha[k] = peak > 1.0
    found.error_bound[k] = point.bound
    found.state[k] = INTERPOLATED
    return True


@kernel
def _interpolate_both_forms(point: Record, window: Record, layer: int, by_row: Record, by_column: Record) -> float:
    """The peak of a point where (1 - peak)^2 is interpolated in some of its cells, and the peak in others."""
    peak = 0.0
    for a in range(point.count):
        cell, stencil = point.cell + CELL_BYTES * a, point.peak + a * layer
        all_squared = True
        for e in range(point.size):
            all_squared = all_squared and load_int32(window.cells[e] + cell) & SQUARED != 0
        value = 0.0
        for e in range(point.size):
            squared = load_int32(window.cells[e] + cell) & SQUARED != 0
            one = _sum_columns(_sum_rows(window.peaks[e] + stencil, squared, by_row), by_column)
            # (1 - peak)^2 is interpolated where all slices have it, as when the errors were measured
            value += point.by_slice[e] * (_peak_of(one) if squared and not all_squared else one)
        peak += point.by_angle[a] * (_peak_of(value) if all_squared else value)
    return peak


@kernel
def _sum_rows(address: int, squared: bool, by_row: Record) -> Any:
    """Sums over the rows of a stencil of the values, or (1 - value)^2 if `squared`, with weights: one for each column.

    The first value is at `address`.
    """
    total = by_row[0] * _form(load_quad(address), squared)
    total += by_row[1] * _form(load_quad(address + ROW_BYTES), squared)
    total += by_row[2] * _form(load_quad(address + 2 * ROW_BYTES), squared)
    total += by_row[3] * _form(load_quad(address + 3 * ROW_BYTES), squared)
    return total


@kernel
def _form(values: Any, squared: bool) -> Any:
    """The interpolated variable, (1 - value)^2 or the value; a product in both cases, without a branch."""
    rest = (1.0 if squared else 0.0) - values
    return rest * select_quad(squared, rest, quad(-1.0, -1.0, -1.0, -1.0))


@kernel
def _sum_columns(columns: Any, by_column: Record) -> float:
    """Sum of four columns with weights."""
    c0, c1, c2, c3 = numbers_of(columns)
    total: float = c0 * by_column[0] + c1 * by_column[1] + c2 * by_column[2] + c3 * by_column[3]
    return total


@kernel
def _peak_of(value: float) -> float:
    """The peak from an interpolated (1 - peak)^2."""
    root: float = np.sqrt(max(value, 0.0))
    return 1.0 - root
