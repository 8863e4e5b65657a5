"""Lowest factors on the motions of a site that overturn bodies, and responses at the strength of the site."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from rocking.extension import (
    RESOLUTION,
    Array,
    Flags,
    Index,
    Outcome,
    Problem,
    StopFlag,
    highest_vertical_scale,
    lowest_thresholds,
    record_lines,
    respond,
)
from rocking_assessment._objects.objects import BodyArray
from rocking_assessment._objects.site import Motion

Progress = Callable[[float], None]  # called with the share of the work that is done [-]
HIGHEST_FACTOR = 10.0  # highest factor on the motions of a site that is searched [-]


def least(values: Array) -> Array:
    """Smallest of each row, nan where all are."""
    return np.asarray(np.fmin.reduce(values, axis=1))


def factors_of(
    body: BodyArray,
    motions: Sequence[Motion],
    stop: StopFlag | None = None,
    progress: Progress | None = None,
    *,
    resolution: float = RESOLUTION,
    highest: float = HIGHEST_FACTOR,
    enough: float = 0.0,
) -> Array:
    """Lowest factor on each motion that overturns each body, nan where none up to the highest; (bodies, motions).

    `enough`: one up to it suffices under a record, see `rocking._boundary.scan.lowest_overturning`.
    """
    columns = []
    for k, motion in enumerate(motions):
        if progress is not None:
            progress(k / len(motions))
        factors = [
            factor_from_one_side(problem, motion, stop, resolution, highest, enough)
            for problem in problems_of(body, motion)
        ]
        columns.append(np.fmin.reduce(factors))
    return np.stack(columns, axis=1)


def factor_from_one_side(
    problem: Problem,
    motion: Motion,
    stop: StopFlag | None = None,
    resolution: float = RESOLUTION,
    highest: float = HIGHEST_FACTOR,
    enough: float = 0.0,
) -> Array:
    """Lowest factor on the motion of a problem that overturns each body, nan where none does; (bodies,)."""
    peak = motion.peak_acceleration
    return lowest_thresholds(problem, highest * peak, stop, resolution=resolution, enough=enough * peak) / peak


def lowest_factor(
    body: BodyArray, motion: Motion, stop: StopFlag | None, resolution: float, highest: float = HIGHEST_FACTOR
) -> Array:
    """A factor up to 1 that overturns, or the lowest above; 1 where the search finds none but the motion does; inf."""
    factor = factors_of(body, [motion], stop, resolution=resolution, highest=highest, enough=1.0)[:, 0]
    factor = np.fmin(factor, np.where(overturned_by(body, motion, stop), 1.0, np.nan))
    return np.asarray(np.nan_to_num(factor, nan=np.inf))


def overturned_by(
    body: BodyArray, motion: Motion, stop: StopFlag | None = None, acceleration: Array | float | None = None
) -> Flags:
    """True where a motion overturns a body from either side, at the strength of the site or at another one.

    Refused where its vertical acceleration reaches -g, from `strongest_factor` on.
    """
    problems = problems_of(body, motion, acceleration)
    codes = [problem.solve(stop=stop)[0]["outcome"].reshape(problem.shape) for problem in problems]
    return np.asarray(np.max(codes, axis=0) >= Outcome.OVERTURNED_DIRECTLY)


def responses_of(
    body: BodyArray, motions: Sequence[Motion], stop: StopFlag | None = None
) -> tuple[Flags, Array, Array]:
    """True where a motion overturns a body; and largest rotations [rad] and movements of the top [m]."""
    overturned, rotation, displacement = [], [], []
    for motion in motions:
        responses = [respond(problem, stop=stop) for problem in problems_of(body, motion)]
        overturned.append(np.logical_or.reduce([response.overturned for response in responses]))
        rotation.append(np.fmax.reduce([response.rotation for response in responses]))
        displacement.append(np.fmax.reduce([response.displacement for response in responses]))
    return np.stack(overturned, 1), np.stack(rotation, 1), np.stack(displacement, 1)


def problems_of(body: BodyArray, motion: Motion, acceleration: Array | float | None = None) -> list[Problem]:
    """The bodies under a motion, and its mirror image where that differs, at the strength of the site or another."""
    return [problem_of(side, motion, acceleration) for side in body.sides]


def problem_of(body: BodyArray, motion: Motion, acceleration: Array | float | None = None) -> Problem:
    """The bodies under a motion from one side, at the strength of the site or another."""
    peak = motion.peak_acceleration if acceleration is None else acceleration
    strength = np.asarray(peak / motion.motion.unit_acceleration)
    return Problem(body, motion.motion, strength, np.asarray(motion.period), None)


def strongest_factor(motion: Motion) -> float:
    """Factor on a motion up to which a vertical component does not lift everything off the ground [-]."""
    unit = motion.peak_acceleration / motion.motion.unit_acceleration
    return 0.999 * highest_vertical_scale(motion.motion) / unit


def searched_factor(motions: Sequence[Motion]) -> float:
    """Factor up to which all motions are searched, three digits [-]: `HIGHEST_FACTOR`, or the least strongest one."""
    strongest = min(strongest_factor(motion) for motion in motions)
    if strongest >= HIGHEST_FACTOR:
        return HIGHEST_FACTOR
    digits = 2 - math.floor(math.log10(strongest))
    return round(math.floor(strongest * 10.0**digits) / 10.0**digits, digits)


def estimated_outcomes(
    body: BodyArray, records: Sequence[Motion], row: Index, ground: Array, stop: StopFlag | None = None
) -> Flags:
    """True where one of some records overturns a body from either side, by the estimate of the search under records.

    The estimate (`rocking._solver.records.estimate`) takes a fifth of the time of a response.

    Parameters
    ----------
    row : int array (strengths,)
        The body of each strength.
    ground : float array (strengths,)
        Peak ground accelerations [m/s2].
    """
    overturned = np.zeros(row.size, dtype=np.bool_)
    for motion in records:
        record: Any = motion.motion
        factor = ground * (motion.peak_acceleration / motion.ground / record.peak_acceleration)
        for problem in problems_of(body, motion, np.full(body.shape, record.peak_acceleration)):
            overturned |= record_lines(problem, stop).estimated(row, factor)[0]
    return overturned
