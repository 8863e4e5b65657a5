"""Factors of one object over the horizontal direction in which the ground moves."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from rocking.extension import RESOLUTION, Outcome, Scalar, StopFlag, variable
from rocking_assessment._objects.objects import STEP, Bodies, Plane
from rocking_assessment._objects.search import HIGHEST_FACTOR, factor_from_one_side, problem_of
from rocking_assessment._objects.site import Motion

if TYPE_CHECKING:
    import xarray as xr

LEAST_COMPONENT = 1e-9  # cosine up to which a motion has no component along a direction [-]


def factors_by_direction(
    planes: Mapping[float, Plane],
    restitution: Scalar,
    motions: Sequence[Motion],
    stop: StopFlag | None = None,
    resolution: float = RESOLUTION,
) -> xr.Dataset:
    """`Assessment.directions`: lowest factors that overturn an object, over the direction of the ground motion.

    The planes are those across the sides of its base, by angle, 0 to below 180 [degrees].

    A motion in direction theta has the component cos(theta - phi) of it along phi. The object turns about the side of
    its base across phi if this component suffices, so the factor is the least of F(phi)/cos(theta - phi), F that of
    the plane across a side. For the uplift this is exact: with distances of sides as F, it is the distance from the
    centre of mass to the boundary of a convex base in the direction. A planar base of the extent in theta itself would
    turn about a corner, which is farther away.
    """
    import xarray as xr  # noqa: PLC0415  (takes longer to load than the package)

    angles = np.array([*planes])
    across = np.concatenate([angles, angles + 180.0])  # in the opposite direction the body is the mirror image
    directions = across if angles.size == 1 else np.union1d(np.arange(0.0, 360.0, STEP), across)
    reversed_planes = [plane.mirrored for plane in planes.values()]
    bodies = Bodies.of_planes((plane, restitution) for plane in [*planes.values(), *reversed_planes])
    body = bodies.scaled()
    component = np.cos(np.radians(directions[:, None] - across))
    ahead = component > LEAST_COMPONENT
    columns = []
    at_full_strength = np.zeros(directions.size, dtype=np.bool_)
    for motion in motions:
        problem = problem_of(body, motion)
        factor = factor_from_one_side(problem, motion, stop, resolution)
        overturned = problem.solve(stop=stop)[0]["outcome"].ravel() >= Outcome.OVERTURNED_DIRECTLY
        # an object beyond the range of the search has no factor, and may overturn
        columns.append(np.fmin(factor, np.where(overturned, 1.0, np.nan)))
        counted = ahead & (np.nan_to_num(columns[-1], nan=np.inf) <= component)  # at a factor up to 1
        direction, side = np.nonzero(counted)
        if direction.size:
            acceleration = motion.peak_acceleration * component[counted]
            full = problem_of(bodies.take(side).scaled(), motion, acceleration).solve(stop=stop)[0]["outcome"]
            at_full_strength[direction[full.ravel() >= Outcome.OVERTURNED_DIRECTLY]] = True
    factors = np.nan_to_num(np.stack(columns, axis=1), nan=np.inf)
    by_side = np.where(ahead, factors.min(axis=1) / np.where(ahead, component, 1.0), np.inf)
    side, factor = by_side.argmin(axis=1), by_side.min(axis=1)
    overturns = factor <= HIGHEST_FACTOR
    governing = np.array([motion.name for motion in motions])[factors[side].argmin(axis=1)]
    factor_meaning = "lowest factor tried on the motions at which one of them overturns the object"
    along_meaning = "direction along which their component does so"
    full_meaning = "whether a motion overturns it at full strength, a factor of 1"
    return xr.Dataset(
        {
            "factor": variable("direction", np.where(overturns, factor, np.nan), "1", factor_meaning),
            "along": variable("direction", np.where(overturns, across[side], np.nan), "degrees", along_meaning),
            "at_full_strength": variable("direction", at_full_strength, "", full_meaning),
            "governing": variable("direction", np.where(overturns, governing, ""), "", "the motion that does so"),
        },
        {"direction": variable("direction", directions, "degrees", "of the ground acceleration")},
    )
