"""One object under the motions of a site: its history, the friction it needs, and its thresholds over the period."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.extension import (
    FREQUENCY_RATIO,
    PERIOD,
    STANDARD_GRAVITY,
    Array,
    Problem,
    StopFlag,
    check_stop,
    contact_extremes,
    first_excess,
    lowest_thresholds,
)
from rocking_assessment._objects.objects import Bodies, BodyArray, Object, mirror_image
from rocking_assessment._objects.search import problems_of
from rocking_assessment._objects.site import LENGTH, Motion, static_acceleration
from rocking_assessment._objects.sliding import first_exceedance

if TYPE_CHECKING:
    import xarray as xr

ENVELOPE_PERIODS = 25
"""Periods of an envelope, from a third of the shortest period of the site to three times the longest [-]."""


def bodies_of(objects: Sequence[tuple[Object, str]]) -> BodyArray:
    """The bodies of objects in one direction each."""
    planes = [(obj.planes[direction], obj.restitution) for obj, direction in objects]
    return Bodies.of_planes(planes).scaled()


def history_of(obj: Object, direction: str, motion: Motion) -> xr.Dataset:
    """The motion of an object under a motion of a site, for the sign of the motion that rotates it more."""
    plane = obj.planes[direction]
    rigid = bodies_of([(obj, direction)]).rigid
    body = rigid.changed(**{name: value.reshape(()) for name, value in rigid.parameters.items()})
    sides = [plane.against_wall(body)]
    if plane.offset or plane.side:
        sides.append(plane.mirrored.against_wall(mirror_image(body)))
    ground = motion.motion
    strength: dict[str, Any] = {ground.strength.name: motion.peak_acceleration / ground.unit_acceleration}
    if PERIOD in ground.arguments:
        strength["period"] = motion.period
    histories = [side.history(ground, restitution=obj.restitution, **strength) for side in sides]
    return max(histories, key=lambda history: float(np.abs(history["rotation"]).max()))


def friction_needed(objects: Sequence[tuple[Object, str]], motions: Sequence[Motion]) -> Array:
    """Largest friction that objects in a direction need under each motion [-]; array (objects, motions)."""
    body = bodies_of(objects)
    uplift, is_lopsided = np.asarray(body.uplift_acceleration), body.is_lopsided
    needed = np.empty((len(objects), len(motions)))
    for k, motion in enumerate(motions):
        static = static_acceleration(motion)
        needed[:, k] = static / STANDARD_GRAVITY  # of bodies that do not uplift
        problems = problems_of(body, motion)
        needed[(static > uplift) & (body.side != 0.0), k] = math.nan  # the forces of a wall are not known
        for row in np.flatnonzero((static > uplift) & (body.side == 0.0)).tolist():
            sides = problems if is_lopsided[row] else problems[:1]
            extremes = [contact_extremes(problem.body_motion(index=row)) for problem in sides]
            needed[row, k] = max(extreme.largest_friction_demand for extreme in extremes)
    return needed


def frictions(objects: Iterable[Object]) -> Array:
    """Coefficients of friction of objects, nan where none is given [-]."""
    coefficients: list[Any] = [math.nan if obj.friction is None else obj.friction for obj in objects]
    return np.array(coefficients, dtype=np.float64)


def first_exceedances(
    body: BodyArray, friction: Array, motions: Sequence[Motion], stop: StopFlag | None = None, *, rocking: bool = True
) -> Array:
    """Times at which motions first need more than the friction (bodies,) of bodies [s]; array (bodies, motions).

    Nan where a motion does not, where the friction is nan, of bodies against a wall, whose forces are not known, and,
    without `rocking`, of bodies that uplift before they slide: their whole motion is computed otherwise.
    """
    uplift, friction = np.asarray(body.uplift_acceleration), np.where(body.side == 0.0, friction, math.nan)
    slides = friction * STANDARD_GRAVITY < uplift
    times = np.full((friction.size, len(motions)), math.nan)
    for k, motion in enumerate(motions):
        at = {mu: first_exceedance(motion, mu) for mu in set(friction[slides].tolist())}
        times[slides, k] = [at[mu] for mu in friction[slides].tolist()]
        if not rocking:
            continue
        rocks = np.flatnonzero(~slides & ~np.isnan(friction) & (static_acceleration(motion) > uplift))
        for problem in problems_of(body, motion):
            p = problem.body.right.frequency_parameter
            for row in rocks.tolist():
                time = first_excess(problem.body_motion(stop=stop, index=row), friction[row]) / p[row]
                times[row, k] = np.fmin(times[row, k], time)
                check_stop(stop)
    return times


def envelope_of(
    objects: Sequence[tuple[Object, str]], motions: Sequence[Motion], highest: float
) -> tuple[Array, dict[str, Array]]:
    """Periods [s], and by shape of pulse the lowest peak accelerations [m/s2] (objects, periods) that overturn objects.

    Of objects in directions; nan where none up to `highest` [m/s2] was found.
    """
    pulses = {motion.motion.name: motion.motion for motion in motions if PERIOD in motion.motion.arguments}
    if not pulses or not objects:
        return np.empty(0), {}
    body = bodies_of(objects).column
    site_periods = [motion.period for motion in motions]
    p = body.right.frequency_parameter
    shortest = max(min(site_periods) / 3.0, LENGTH[0], float(2.0 * math.pi / (FREQUENCY_RATIO.upper * p.min())))
    longest = min(3.0 * max(site_periods), LENGTH[1], float(2.0 * math.pi / (FREQUENCY_RATIO.lower * p.max())))
    periods = np.geomspace(shortest, longest, ENVELOPE_PERIODS)
    thresholds = {}
    for name, pulse in pulses.items():
        problems = [Problem(side, pulse, np.asarray(1.0), periods, None) for side in body.sides]
        thresholds[name] = np.fmin.reduce([lowest_thresholds(problem, highest) for problem in problems])
    return periods, thresholds
