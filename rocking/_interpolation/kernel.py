"""Compiled interpolation of spectrum cubes at many points, with the error bound of each.

A point is interpolated from up to four slices of restitution, four slenderness angles of each, and 4 x 4 nodes of each
of these. The kernel takes the arrays of the files; files and classes of cubes belong to `rocking._lookup`.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rocking._interpolation.stencils import (
    NO_STENCIL,
    OVERTURNS,
    PEAK,
    SQUARED,
    AngleAxis,
    Mesh,
    Weights,
    cell_of,
    interpolate_in_cell,
    lagrange_weight,
    lagrange_weights,
)
from rocking._model.outcome import Outcome
from rocking._numba.compilation import FloatArray, entry, kernel

UNKNOWN_IMPACTS = -1  # value of `impacts` where the nodes do not determine the number

_RECOVERS = int(Outcome.RECOVERS)


NODE = np.dtype(
    [
        ("peak_rotation", np.float64),
        ("interpolation_error", np.float32),
        ("restitution_error", np.float32),
        ("alpha_error", np.float32),
        ("impacts", np.int32),
        ("stencil", np.int8),
        ("outcome", np.int8),
        ("counted", np.bool_),
    ]
)
"""The variables of a cube from which points are interpolated, at one node; `counted`: whether its number of impacts is
certain in the cell above it (`rocking._lookup.cube_slice.counted_cells`)."""

Nodes = NDArray[np.void]  # the nodes (angles, n, m) of a cube, of type `NODE`

FourSlices = tuple[Nodes, Nodes, Nodes, Nodes]


class Found(NamedTuple):
    """Responses to be filled, arrays (points,); fields as in `rocking._solver.bounded_response`."""

    # whether the response is determined within the tolerance, or 1/a >= 1; the other fields are 0 elsewhere
    known: NDArray[np.bool_]
    from_cube: NDArray[np.bool_]
    peak_rotation: NDArray[np.float64]
    outcome: NDArray[np.int8]
    impacts: NDArray[np.int32]
    exceeded_alpha: NDArray[np.bool_]
    error_bound: NDArray[np.float64]

    @classmethod
    def zeros(cls, size: int) -> Found:
        """Return responses of some points before they are filled: without uplift, as the codes are 0."""
        determined, from_cube, exceeded = np.zeros((3, size), np.bool_)
        peak, bound = np.zeros((2, size))
        return cls(determined, from_cube, peak, np.zeros(size, np.int8), np.zeros(size, np.int32), exceeded, bound)


@entry
def prepare(
    slenderness: FloatArray,
    restitution: FloatArray,
    levels: FloatArray,
    groups: FloatArray,
    present: FloatArray,
    responses: Found,
) -> int:
    """Mark points without uplift, and slices from which points are interpolated; return the number without uplift.

    `slenderness`, `restitution` (points,): of the points [-]. `levels` (n,): the restitutions of the slices [-],
    ascending. `groups` (points,): 2 k for points on slice k, 2 k + 1 for those between it and the next one, -1 outside
    of the slices. `present` (2 n + 1,): set to True for the groups of the points; the last element if some are outside
    of the slices. `responses`: of the points, all 0.
    """
    without_uplift = 0
    for k in range(len(restitution)):
        groups[k] = _group_of(levels, restitution[k])
        present[groups[k]] = True
        if slenderness[k] >= 1.0:
            responses.known[k] = True
            without_uplift += 1
    return without_uplift


@entry
def interpolate_many(
    slenderness: FloatArray,
    frequency_ratio: FloatArray,
    restitution: FloatArray,
    alpha: FloatArray,
    groups: FloatArray,
    group: int,
    mesh: Mesh,
    axis: AngleAxis,
    slices: FourSlices,
    levels: FloatArray,
    lower: int,
    tolerance: float,
    safety: float,
    solver_error: float,
    responses: Found,
) -> int:
    """Fill `responses` where some slices determine the response within the tolerance; return the number of these.

    A point is filled if all cells around it are of one kind, the errors of the formulas that are used were measured,
    and the bound of the error meets the tolerance. All other points are left to the solver.

    `slenderness`, `frequency_ratio`, `restitution`, `alpha` (points,) [-, -, -, rad]; `groups` (points,): of `prepare`;
    `group`: whose points are interpolated here; `mesh`, `axis`: nodes and angles of the slices; `slices`: ascending,
    beyond the number of `levels` they are not read; `levels` (slices,): their restitutions, one for points on a slice
    [-]; `lower`: the slice at or below the points; `tolerance`: largest error bound [-], which is `safety` times the
    sum of the measured errors plus `solver_error` [-]; `responses`: of all points.
    """
    interpolated = 0
    for k in range(len(slenderness)):
        if groups[k] != group:
            continue
        s, w, angle = slenderness[k], frequency_ratio[k], alpha[k]
        i, j, a = cell_of(mesh.rows, s), cell_of(mesh.columns, w), _group_of(axis.angles, angle)
        if i < 0 or j < 0 or a < 0 or s >= 1.0:
            continue  # outside of the axes, or without uplift, which `prepare` has filled
        first, count = axis.windows[a, 0], axis.windows[a, 1]
        by_angle = _level_weights(axis.squares, first, count, angle * angle)
        by_level = _level_weights(levels, 0, len(levels), restitution[k])
        window = first, count, i, j
        kind, error = _judge(slices, len(levels), lower, (a >> 1) - first, window, by_angle, by_level)
        if kind == NO_STENCIL or np.isnan(error):
            continue
        if kind == OVERTURNS:  # in the same way at all nodes: nothing is interpolated
            responses.peak_rotation[k] = responses.error_bound[k] = np.nan
            responses.outcome[k] = slices[0][first, i, j].outcome
            responses.exceeded_alpha[k] = True
        else:
            bound = safety * error + solver_error
            if bound > tolerance:
                continue
            by_row, by_column = lagrange_weights(mesh.rows, i - 1, s), lagrange_weights(mesh.logs, j - 1, np.log(w))
            peak = _peak(slices, len(levels), window, kind == SQUARED, (by_angle, by_level, by_row, by_column))
            # a block that survives passes alpha if and only if its peak does: unknown for a peak within its bound of it
            if abs(peak - 1.0) <= bound:
                continue
            responses.peak_rotation[k], responses.error_bound[k] = max(peak, 0.0), bound
            responses.outcome[k] = _RECOVERS
            responses.exceeded_alpha[k] = peak > 1.0
        responses.impacts[k] = _impacts(slices, len(levels), window)
        responses.known[k] = responses.from_cube[k] = True
        interpolated += 1
    return interpolated


@kernel
def _group_of(levels: FloatArray, x: float) -> int:
    """Return 2 k for a value on level k, 2 k + 1 between it and the next one, -1 outside of the levels."""
    group = -1
    for k in range(len(levels)):
        group += (x >= levels[k]) + (x > levels[k])
    return group if group < 2 * len(levels) - 1 else -1


@kernel
def _level_weights(levels: FloatArray, first: int, count: int, x: float) -> Weights:
    """Return the Lagrange weights at x of `count` levels from `first` on, 0 for those above."""
    if count == 1:
        return 1.0, 0.0, 0.0, 0.0
    return (
        lagrange_weight(levels, first, count, 0, x),
        lagrange_weight(levels, first, count, 1, x),
        lagrange_weight(levels, first, count, 2, x),
        lagrange_weight(levels, first, count, 3, x),
    )


@kernel
def _judge(
    slices: FourSlices,
    size: int,
    lower: int,
    below: int,
    window: tuple[int, int, int, int],
    by_angle: Weights,
    by_level: Weights,
) -> tuple[int, float]:
    """Decide what is interpolated between the angles of some cells, and sum the errors measured in them [-].

    `window`: first angle, number of angles, and row and column of the cells.

    `NO_STENCIL` if the cells differ, one has no stencil, or the error between the angles is not known; `OVERTURNS` if
    all blocks overturn in the same way; `SQUARED` or `PEAK` as `_form_between_angles`, `PEAK` on one angle.
    """
    first, count, i, j = window
    error = 0.0
    if count > 1:
        # the error between the two angles beside the point, measured when the cubes were made
        error = float(slices[lower][first + below, i, j].alpha_error)
        if size > 1:  # between slices: the larger of the two measured on either side, nan if either is
            error = np.maximum(error, float(slices[lower + 1][first + below, i, j].alpha_error))
    corner = slices[0][first, i, j]
    overturns, outcome, impacts = corner.stencil == OVERTURNS, corner.outcome, corner.impacts
    for a in range(count):
        if size > 1:
            error += abs(by_angle[a]) * slices[lower][first + a, i, j].restitution_error
        for e in range(size):
            node = slices[e][first + a, i, j]
            # one cell without a stencil, one that overturns beside one that survives, or another way of overturning
            alike = node.outcome == outcome and node.impacts == impacts
            if node.stencil == NO_STENCIL or (node.stencil == OVERTURNS) != overturns or (overturns and not alike):
                return NO_STENCIL, error
            error += abs(by_angle[a] * by_level[e]) * node.interpolation_error
    if overturns:
        return OVERTURNS, error
    if count == 1:
        return PEAK, error
    return _form_between_angles(slices, size, lower, window), error


@kernel
def _form_between_angles(slices: FourSlices, size: int, lower: int, window: tuple[int, int, int, int]) -> int:
    """Return `SQUARED` or `PEAK`: what was interpolated between the angles when the error between them was measured.

    It was measured on the slice at or below the point and, between slices, on the one above. `NO_STENCIL` if these two
    differ: no error is known of either formula.
    """
    form: int = _form_of_slice(slices[lower], window)
    if size > 1 and _form_of_slice(slices[lower + 1], window) != form:
        return NO_STENCIL
    return form


@kernel
def _form_of_slice(nodes: Nodes, window: tuple[int, int, int, int]) -> int:
    """Return `SQUARED` if a cell has it on all angles of a slice, else `PEAK`."""
    first, count, i, j = window
    for a in range(first, first + count):
        if nodes[a, i, j].stencil != SQUARED:
            return PEAK
    return SQUARED


@kernel
def _peak(
    slices: FourSlices,
    size: int,
    window: tuple[int, int, int, int],
    squared: bool,
    weights: tuple[Weights, Weights, Weights, Weights],
) -> float:
    """Return the interpolated peak [-]; `squared`: (1 - peak)^2 is interpolated between the angles.

    Each step uses the formula with which its error was measured: between restitutions (1 - peak)^2 where all slices of
    an angle have it, between angles that of `_form_between_angles`.
    """
    first, count, i, j = window
    by_angle, by_level, by_row, by_column = weights
    total = 0.0
    for a in range(count):
        all_squared = True
        for e in range(size):
            all_squared = all_squared and slices[e][first + a, i, j].stencil == SQUARED
        value = 0.0
        for e in range(size):
            form = slices[e][first + a, i, j].stencil == SQUARED
            in_cell = interpolate_in_cell(slices[e][first + a].peak_rotation, i, j, form, by_row, by_column)
            value += by_level[e] * (_peak_of(in_cell) if form and not all_squared else in_cell)
        if all_squared and not squared:
            value = _peak_of(value)
        if squared and not all_squared:
            value = (1.0 - value) * (1.0 - value)
        total += by_angle[a] * value
    return _peak_of(total) if squared else total


@kernel
def _impacts(slices: FourSlices, size: int, window: tuple[int, int, int, int]) -> int:
    """Return the number of impacts where it is certain in all cells and the same, else `UNKNOWN_IMPACTS`."""
    first, count, i, j = window
    impacts = slices[0][first, i, j].impacts
    for a in range(first, first + count):
        for e in range(size):
            node = slices[e][a, i, j]
            if node.impacts != impacts or not node.counted:
                return UNKNOWN_IMPACTS
    return int(impacts)


@kernel
def _peak_of(value: float) -> float:
    """Return the peak from an interpolated (1 - peak)^2."""
    root: float = np.sqrt(max(value, 0.0))
    return 1.0 - root
