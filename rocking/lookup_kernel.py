"""Interpolates cubes at many points: four restitutions by four angles by 4 x 4 nodes, with the bound of each answer."""

from __future__ import annotations

import numpy as np

from rocking.compilation import Record, Vector, kernel
from rocking.cube import OVERTURNS, SQUARED
from rocking.interpolation import Mesh, in_cell
from rocking.response import Outcome

UNKNOWN = -1
"""Impacts where the nodes around a point differ in them."""

GAP_SHARE = 0.7
"""Weight of the errors between levels beside those within cells [-]: they are measured where they are largest, in the
middle of the gap, and the safety factor is made for those within cells, which creases can pass by."""

_OVERTURNED = int(Outcome.OVERTURNED_DIRECTLY)


@kernel
def common_impacts(cubes: Record, layer: int, e: int, i: int, j: int, before: int) -> int:
    """The impacts of the four nodes around a cell if they agree with each other and with `before` (-2: none yet)."""
    impacts = cubes.impacts[e]
    first = impacts[layer, i, j]
    for p in range(2):
        for q in range(2):
            if impacts[layer, i + p, j + q] != first:
                return UNKNOWN
    return first if before == -2 or before == first else UNKNOWN


@kernel
def interpolate_many(
    row: Vector,
    column: Vector,
    x: Vector,
    y: Vector,
    mesh: Mesh,
    eta_gap: Vector,
    eta_weights: Vector,
    angle_gap: Vector,
    angle_first: Vector,
    angle_weights: Vector,
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
    eta_gap : int array (points,)
        Which of the four cubes the restitution lies above; -1 where it is that of the first.
    eta_weights : float array (points, 4)
        Of the four cubes.
    angle_gap, angle_first : int arrays (points,)
        Layer that the angle lies above, -1 on a layer; first of the layers that serve, -1 where none does.
    angle_weights : float array (points, 4)
        Of the layers from there on.
    cubes : named tuple of `lookup.FIELDS`
        Each a tuple of four arrays (angles, n, m), one for each cube.
    answers : array (points,) of `lookup.FOUND`
        `known` is set where there is an answer.
    """
    for point in range(len(row)):
        i, j = row[point], column[point]
        if i < 0 or j < 0 or angle_first[point] < 0:
            continue
        kind, impacts = 0, -2
        peak, value, squares, forms = 0.0, 0.0, 0, 0
        in_cells, between_etas, between_angles = 0.0, 0.0, 0.0
        agree = True
        for e in range(4):
            by_eta = eta_weights[point, e]
            for a in range(4):
                by_angle = angle_weights[point, a]
                if by_eta == 0.0 or by_angle == 0.0 or not agree:
                    continue
                layer = angle_first[point] + a
                code = cubes.stencil[e][layer, i, j]
                if code == OVERTURNS:
                    here = -(4 * cubes.impacts[e][layer, i, j] + cubes.outcome[e][layer, i, j])
                else:
                    here = 0 if code < 0 else 1
                agree = here != 0 and (kind == 0 or kind == here)
                if not agree:
                    continue
                kind = here
                error = cubes.interpolation_error[e][layer, i, j]
                in_cells = error if np.isnan(error) else max(in_cells, error)
                if e == eta_gap[point]:
                    error = cubes.restitution_error[e][layer, i, j]
                    between_etas = error if np.isnan(error) else max(between_etas, error)
                if layer == angle_gap[point]:
                    error = cubes.alpha_error[e][layer, i, j]
                    between_angles = error if np.isnan(error) else max(between_angles, error)
                agree = not np.isnan(in_cells + between_etas + between_angles)
                impacts = common_impacts(cubes, layer, e, i, j, impacts)
                if kind > 0:
                    squared = code >= SQUARED
                    shift = code - SQUARED if squared else code
                    here_value = in_cell(cubes.peak_rotation[e][layer], i, j, shift, squared, x[point], y[point], mesh)
                    value += by_eta * by_angle * here_value
                    peak += by_eta * by_angle * (1.0 - np.sqrt(max(here_value, 0.0)) if squared else here_value)
                    squares, forms = squares + int(squared), forms + 1
        if not agree:
            continue
        found = answers[point]
        found.known = True
        found.error = in_cells + GAP_SHARE * (between_etas + between_angles)
        found.impacts = impacts
        found.overturned = kind < 0
        found.outcome = (-kind) % 4 if kind < 0 else _OVERTURNED - 1
        found.peak = 1.0 - np.sqrt(max(value, 0.0)) if 0 < squares == forms else peak  # as `sweep_layer.gap_error`
