"""Interpolates cubes at many points: up to four restitutions, four angles and 4 x 4 nodes, with the bound of each."""

from __future__ import annotations

import numpy as np

from rocking._numba.compilation import FloatArray, Record, entry, kernel
from rocking.interpolation.stencils import (
    OVERTURNS,
    SLICE_STENCILS,
    SQUARED,
    STENCIL_SIZE,
    Mesh,
    interpolate_in_cell,
    lagrange_weight,
)
from rocking.model.response import Outcome

UNKNOWN_IMPACTS = -1
"""Impacts where the nodes around a point differ in them."""

LOWER_PLACE = STENCIL_SIZE - 2
"""Of the cubes that `interpolate_many` takes: the one at or below the restitutions asked for."""

SLICE_COUNT = LOWER_PLACE + STENCIL_SIZE
"""How many these are: all that may serve a gap."""

INTERVAL_WEIGHT = 0.7
"""Weight of the errors between levels beside those within cells [-]: they are measured where they are largest, in the
middle of the gap, and the safety factor is made for those within cells, which creases can pass by."""

WORST_CELL_WEIGHT = 0.5
"""Share of the largest of the errors within cells that counts, however little the cell weighs [-]: what makes it large,
as a crease does, may lie closer at the levels between."""

_OVERTURNED = int(Outcome.OVERTURNED_DIRECTLY)


@kernel
def common_impacts(cubes: Record, layer: int, e: int, i: int, j: int, before: int) -> int:
    """The impacts of the four nodes around a cell if they agree with each other and with `before` (-2: none yet)."""
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
    on_eta: bool,
    etas: FloatArray,
    usable: FloatArray,
    angle_level: FloatArray,
    on_angle: FloatArray,
    angle: FloatArray,
    angles: FloatArray,
    cubes: Record,
    answers: Record,
) -> None:
    """Fill `answers` (points,) where the cubes know one.

    Parameters
    ----------
    row, column : int arrays (points,)
        The cell that holds each point; -1 outside.
    x, y : float arrays (points,)
        slenderness and log(frequency_ratio).
    mesh : Mesh
        The nodes.
    eta, on_eta : float array (points,), bool
        Restitutions, all above that of cube `LOWER_PLACE`, and below that of the next; or all equal to it.
    etas, usable : float array (SLICE_COUNT,), bool array (SLICE_COUNT,)
        Restitutions of the cubes, and whether there is one.
    angle_level, on_angle : int array, bool array (points,)
        Layer at or below each angle, -1 where there is none; whether the angle is that of the layer.
    angle, angles : float arrays (points,), (layers,)
        Squares of the angles, and of those of the layers.
    cubes : named tuple of `lookup.FIELDS`
        Each a tuple of `SLICE_COUNT` arrays (layers, n, m), one for each cube.
    answers : array (points,) of `lookup.FOUND_RECORD`
        `known` is set where there is an answer.
    """
    for point in range(len(row)):
        i, j, layer = row[point], column[point], angle_level[point]
        if i < 0 or j < 0 or layer < 0:
            continue
        kind, impacts = 0, -2
        peak, value, squared_all = 0.0, 0.0, True
        # the errors of what is interpolated further go on with the sizes of the weights: levels may lie unevenly
        in_cells, worst, between_etas, between_angles = 0.0, 0.0, 0.0, 0.0
        first_angle, count_angles = layer, 1
        if not on_angle[point]:
            choice = cubes.alpha_levels[LOWER_PLACE][layer, i, j]
            if choice < 0:
                continue
            count_angles, first_angle = SLICE_STENCILS[choice][0], layer - SLICE_STENCILS[choice][1]
            between_angles = cubes.alpha_error[LOWER_PLACE][layer, i, j]
            if not on_eta:
                # measured on both sides of the gap between restitutions, with the same layers
                other = cubes.alpha_error[LOWER_PLACE + 1][layer, i, j]
                if cubes.alpha_levels[LOWER_PLACE + 1][layer, i, j] != choice or np.isnan(other):
                    continue
                between_angles = max(between_angles, other)
        agree = not np.isnan(between_angles)
        for a in range(count_angles):
            if not agree:
                break
            layer = first_angle + a
            by_angle = lagrange_weight(angles, first_angle, count_angles, a, angle[point])
            layer_peak, layer_value, layer_squared = 0.0, 0.0, True
            first_eta, count_etas = LOWER_PLACE, 1
            if not on_eta:
                choice = cubes.restitution_levels[LOWER_PLACE][layer, i, j]
                error = cubes.restitution_error[LOWER_PLACE][layer, i, j]
                if choice < 0 or np.isnan(error):
                    agree = False
                    break
                count_etas, first_eta = SLICE_STENCILS[choice][0], LOWER_PLACE - SLICE_STENCILS[choice][1]
                between_etas += abs(by_angle) * error
            for b in range(count_etas):
                e = first_eta + b
                if not usable[e]:
                    agree = False
                    break
                code, error = cubes.stencil[e][layer, i, j], cubes.interpolation_error[e][layer, i, j]
                if code == OVERTURNS:
                    here = -(4 * cubes.impacts[e][layer, i, j] + cubes.outcome[e][layer, i, j])
                else:
                    here = 0 if code < 0 else 1
                agree = here != 0 and (kind == 0 or kind == here) and not np.isnan(error)
                if not agree:
                    break
                kind, weight = here, lagrange_weight(etas, first_eta, count_etas, b, eta[point])
                in_cells += abs(by_angle * weight) * error
                worst = max(worst, error)
                impacts = common_impacts(cubes, layer, e, i, j, impacts)
                if kind > 0:
                    squared = code >= SQUARED
                    shift = code - SQUARED if squared else code
                    here_value = interpolate_in_cell(
                        cubes.peak_rotation[e][layer], i, j, shift, squared, x[point], y[point], mesh
                    )
                    layer_value += weight * here_value
                    layer_peak += weight * (1.0 - np.sqrt(max(here_value, 0.0)) if squared else here_value)
                    layer_squared = layer_squared and squared
            # (1 - peak)^2 where all have it, as it was when the errors were measured, see `sweep_gap`
            value += by_angle * layer_value
            peak += by_angle * (1.0 - np.sqrt(max(layer_value, 0.0)) if layer_squared else layer_peak)
            squared_all = squared_all and layer_squared
        if not agree:
            continue
        found = answers[point]
        found.known = True
        found.error = max(in_cells, WORST_CELL_WEIGHT * worst) + INTERVAL_WEIGHT * (between_etas + between_angles)
        found.impacts = impacts
        found.overturned = kind < 0
        found.outcome = (-kind) % 4 if kind < 0 else _OVERTURNED - 1
        found.peak = 1.0 - np.sqrt(max(value, 0.0)) if squared_all else peak
