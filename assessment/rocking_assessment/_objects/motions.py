"""One object under the motions of a site: its history, the friction it needs, and its thresholds over the period."""

from __future__ import annotations

import math
from collections.abc import Sequence
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
from rocking_assessment._objects.objects import Bodies, BodyArray, Object
from rocking_assessment._objects.search import least, problems_of
from rocking_assessment._objects.site import LENGTH, Motion, static_acceleration
from rocking_assessment._objects.sliding import first_exceedance

if TYPE_CHECKING:
    import xarray as xr

ENVELOPE_PERIODS = 25
"""Periods of an envelope, from a third of the shortest period of the site to three times the longest [-]."""


def bodies_of(given: Sequence[tuple[Object, str]]) -> BodyArray:
    """The bodies of objects in one direction each."""
    rows = [list(one.planes).index(direction) for one, direction in given]
    starts = np.cumsum([0, *(len(one.planes) for one, _ in given)])[:-1]
    return Bodies.of(one for one, _ in given).take(starts + np.array(rows)).scaled()


def history_of(one: Object, direction: str, motion: Motion) -> xr.Dataset:
    """The motion of an object under a motion of a site, for the sign of the motion that rotates it more."""
    rigid = bodies_of([(one, direction)]).rigid
    body = rigid.changed(**{name: value.reshape(()) for name, value in rigid.parameters.items()})
    plane, given = one.planes[direction], body.parameters
    mirrored = body.changed(**{**given, "left": given["right"], "right": given["left"]})
    lopsided = plane.offset != 0.0 or plane.side != 0.0
    sides = [plane.against_wall(body), *([plane.mirrored.against_wall(mirrored)] if lopsided else [])]
    ground = motion.motion
    strength: dict[str, Any] = {ground.strength.name: motion.peak_acceleration / ground.unit_acceleration}
    if PERIOD in ground.arguments:
        strength["period"] = motion.period
    found = [side.history(ground, restitution=one.restitution, **strength) for side in sides]
    return max(found, key=lambda each: float(np.abs(each["rotation"]).max()))


def frictions_of(given: Sequence[tuple[Object, str]], motions: Sequence[Motion]) -> tuple[Array, Array]:
    """Friction that objects in a direction need under each motion, and when their own is first exceeded [s].

    Arrays (objects, motions), as the variables of `Assessment.friction`.
    """
    body = bodies_of(given)
    uplift, mirrored = np.asarray(body.uplift_acceleration), body.is_lopsided
    needed = np.empty((len(given), len(motions)))
    for k, motion in enumerate(motions):
        static = static_acceleration(motion)
        needed[:, k] = static / STANDARD_GRAVITY  # of bodies that do not uplift
        problems = problems_of(body, motion)
        needed[(static > uplift) & (body.side != 0.0), k] = math.nan  # the forces of a wall are not known
        for row in np.flatnonzero((static > uplift) & (body.side == 0.0)).tolist():
            both = problems if mirrored[row] else problems[:1]
            found = (contact_extremes(one.body_motion(index=row)) for one in both)
            needed[row, k] = max(one.largest_friction_demand for one in found)
    own: list[Any] = [math.nan if one.friction is None else one.friction for one, _ in given]
    return needed, first_exceedances(body, np.array(own, dtype=np.float64), motions)


def first_exceedances(
    body: BodyArray, friction: Array, motions: Sequence[Motion], stop: StopFlag | None = None, *, rocking: bool = True
) -> Array:
    """Times at which motions first need more than the friction (bodies,) of bodies [s]; array (bodies, motions).

    Nan where a motion does not, where the friction is nan, of bodies against a wall, whose forces are not known, and,
    without `rocking`, of bodies that uplift before they slide: their whole motion is computed otherwise.
    """
    uplift, friction = np.asarray(body.uplift_acceleration), np.where(body.side == 0.0, friction, math.nan)
    slides = friction * STANDARD_GRAVITY < uplift
    found = np.full((friction.size, len(motions)), math.nan)
    for k, motion in enumerate(motions):
        at = {mu: first_exceedance(motion, mu) for mu in set(friction[slides].tolist())}
        found[slides, k] = [at[mu] for mu in friction[slides].tolist()]
        rocks = np.flatnonzero(~slides & ~np.isnan(friction) & (static_acceleration(motion) > uplift))
        for problem in problems_of(body, motion) if rocking else ():
            p = problem.body.right.frequency_parameter
            for row in rocks.tolist():
                time = first_excess(problem.body_motion(stop=stop, index=row), friction[row]) / p[row]
                found[row, k] = np.fmin(found[row, k], time)
                check_stop(stop)
    return found


def envelope_of(
    given: Sequence[tuple[Object, str]], motions: Sequence[Motion], highest: float
) -> tuple[Array, dict[str, Array]]:
    """Periods [s], and by shape of pulse the lowest peak accelerations [m/s2] (objects, periods) that overturn objects.

    Of objects in directions; nan where none up to `highest` [m/s2] was found.
    """
    pulses = {one.motion.name: one.motion for one in motions if PERIOD in one.motion.arguments}
    if not pulses or not given:
        return np.empty(0), {}
    body = bodies_of(given).column
    site = [one.period for one in motions]
    p = body.right.frequency_parameter
    shortest = max(min(site) / 3.0, LENGTH[0], float(2.0 * math.pi / (FREQUENCY_RATIO.upper * p.min())))
    longest = min(3.0 * max(site), LENGTH[1], float(2.0 * math.pi / (FREQUENCY_RATIO.lower * p.max())))
    periods = np.geomspace(shortest, longest, ENVELOPE_PERIODS)
    found = {}
    for name, pulse in pulses.items():
        problems = [Problem(side, pulse, np.asarray(1.0), periods, None) for side in body.sides]
        lowest = [lowest_thresholds(one, highest) for one in problems]
        found[name] = least(np.stack([one.ravel() for one in lowest], axis=1)).reshape(lowest[0].shape)
    return periods, found
