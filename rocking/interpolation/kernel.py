"""Compiled interpolation of spectrum cubes at many points, with the sum of the measured errors of each.

A point is interpolated from up to four slices of restitution, four slices of slenderness angle and 4 x 4 nodes of each.
The kernel takes arrays only; files and classes of cubes belong to `rocking.lookup`.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rocking._numba.compilation import FloatArray, Record, entry, kernel
from rocking.interpolation.stencils import (
    NO_STENCIL,
    OVERTURNS,
    SQUARED,
    Mesh,
    interpolate_in_cell,
    lagrange_weight,
    slice_window,
)
from rocking.model.outcome_code import SURVIVES, outcome_of_code, overturning_code

UNKNOWN_IMPACTS = -1
"""Value of `impacts` where the nodes around a point have different numbers."""

FOUND_RECORD = np.dtype(
    [
        ("known", np.bool_),
        ("overturned", np.bool_),
        ("outcome", np.int8),
        ("impacts", np.int32),
        ("peak", np.float64),
        ("error", np.float64),
    ],
    align=True,
)
"""Result at a point; `error` is the sum of the measured errors [-]."""

Slices = tuple[NDArray[np.generic], ...]
"""One array (angles, n, m) for each restitution of a window."""

UNKNOWN = -1
"""Code of the outcome before the first slice."""


class SliceArrays(NamedTuple):
    """The variables of a spectrum cube that interpolation needs, for `STENCIL_SIZE` restitutions."""

    peak_rotation: Slices
    outcome: Slices
    impacts: Slices
    stencil: Slices
    interpolation_error: Slices
    restitution_error: Slices
    alpha_error: Slices


@kernel
def common_impacts(cubes: Record, layer: int, e: int, i: int, j: int, before: int) -> int:
    """The impacts of the four corners of a cell if they are equal to each other and to `before` (-2: none yet)."""
    impacts = cubes.impacts[e]
    first = impacts[layer, i, j]
    for p in range(2):
        for q in range(2):
            if impacts[layer, i + p, j + q] != first:
                return UNKNOWN_IMPACTS
    return first if before == -2 or before == first else UNKNOWN_IMPACTS


@entry
def interpolate_many(
    row: FloatArray,
    column: FloatArray,
    x: FloatArray,
    y: FloatArray,
    mesh: Mesh,
    eta: FloatArray,
    etas: FloatArray,
    lower: int,
    count: int,
    angle_slice: FloatArray,
    on_angle: FloatArray,
    angle: FloatArray,
    angles: FloatArray,
    cubes: Record,
    answers: Record,
) -> None:
    """Fill `answers` (points,) where the cubes determine the response.

    Parameters
    ----------
    row, column : int arrays (points,)
        The cell that contains each point; -1 outside.
    x, y : float arrays (points,)
        slenderness and log(frequency_ratio) [-].
    mesh : Mesh
        The nodes.
    eta : float array (points,)
        Restitutions [-], all in the interval above slice `lower`, or all on it if `count` is 1.
    etas : float array (STENCIL_SIZE,)
        Restitutions of the slices [-].
    lower, count : int
        The slice at or below the restitutions, and the number of slices to be used.
    angle_slice, on_angle : int array, bool array (points,)
        Slice at or below each angle, -1 where there is none; whether the angle is on the slice.
    angle, angles : float arrays (points,), (angles,)
        Squares of the angles of the points and of the slices [rad2].
    cubes : SliceArrays
        Variables of the cubes; only the first `count` slices are used.
    answers : array (points,) of `FOUND_RECORD`
        `known` is set where all slices and nodes determine the response.
    """
    for point in range(len(row)):
        i, j, layer = row[point], column[point], angle_slice[point]
        if i < 0 or j < 0 or layer < 0:
            continue
        kind, impacts = UNKNOWN, -2
        peak, value, squared_all = 0.0, 0.0, True
        error = 0.0
        first_angle, count_angles = layer, 1
        if not on_angle[point]:
            first_angle, count_angles = slice_window(len(angles), layer)
            error = cubes.alpha_error[lower][layer, i, j]
            if count > 1:  # between four slices: the larger of the two measured on either side
                error = np.maximum(error, cubes.alpha_error[lower + 1][layer, i, j])  # nan if either is
        agree = not np.isnan(error)
        for a in range(count_angles):
            if not agree:
                break
            layer = first_angle + a
            by_angle = lagrange_weight(angles, first_angle, count_angles, a, angle[point])
            layer_peak, layer_value, layer_squared = 0.0, 0.0, True
            if count > 1:
                error += abs(by_angle) * cubes.restitution_error[lower][layer, i, j]
            for e in range(count):
                code, kind_here = cubes.stencil[e][layer, i, j], SURVIVES
                if code == OVERTURNS:
                    kind_here = overturning_code(cubes.outcome[e][layer, i, j], cubes.impacts[e][layer, i, j])
                agree = code != NO_STENCIL and kind in (UNKNOWN, kind_here)
                if not agree:
                    break
                kind, weight = kind_here, lagrange_weight(etas, 0, count, e, eta[point])
                error += abs(by_angle * weight) * cubes.interpolation_error[e][layer, i, j]
                impacts = common_impacts(cubes, layer, e, i, j, impacts)
                if kind == SURVIVES:
                    squared = code == SQUARED
                    here = interpolate_in_cell(cubes.peak_rotation[e][layer], i, j, squared, x[point], y[point], mesh)
                    layer_value += weight * here
                    layer_peak += weight * (1.0 - np.sqrt(max(here, 0.0)) if squared else here)
                    layer_squared = layer_squared and squared
            # (1 - peak)^2 where all slices have it, as when the errors were measured (`LevelInterval.errors`)
            value += by_angle * layer_value
            peak += by_angle * (1.0 - np.sqrt(max(layer_value, 0.0)) if layer_squared else layer_peak)
            squared_all = squared_all and layer_squared
        if not agree or np.isnan(error):
            continue
        found = answers[point]
        found.known = True
        found.error = error
        found.impacts = impacts
        found.overturned = kind != SURVIVES
        found.outcome = outcome_of_code(kind)
        found.peak = 1.0 - np.sqrt(max(value, 0.0)) if squared_all else peak
