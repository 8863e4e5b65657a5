"""Lowest factors on the motions of a site that overturn bodies, and responses at the strength of the site."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from rocking._assessment.objects import BodyArray
from rocking._assessment.site import Motion
from rocking._boundary.search import refine_brackets
from rocking._dimensional.lowest_thresholds import lowest_thresholds
from rocking._dimensional.problem import Problem
from rocking._dimensional.response import respond
from rocking._excitation.records.record import Record
from rocking._excitation.records.vertical import highest_vertical_scale
from rocking._model.outcome import Outcome
from rocking._numba.cancellation import StopFlag
from rocking._solver.bodies import outcome_margin_of, solve_motion

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]
Index = NDArray[np.intp]
Progress = Callable[[float], None]
"""Called with the share of the work that is done [-]."""

HIGHEST_FACTOR = 10.0
"""Highest factor on the motions of a site that is searched [-]."""

LEVELS = np.geomspace(0.1, HIGHEST_FACTOR, 12)
"""Factors on records that are tried [-]; the change of outcome below the first that overturns is bracketed."""

RECORD_RESOLUTION = 1e-6
"""Width of the bracket of a factor on a record [-], whose ends have been solved.

With 1e-4 a suite takes 0.73 of the time. Neither the margin nor the peak rotation shows how far a change of outcome is:
near it a body lingers where it is balanced.
"""


def least(values: Array) -> Array:
    """Smallest of each row, nan where all are."""
    return np.asarray(
        np.where(np.isnan(values).all(axis=1), np.nan, np.nanmin(np.nan_to_num(values, nan=np.inf), axis=1))
    )


def factors_of(
    body: BodyArray, motions: Sequence[Motion], stop: StopFlag | None = None, progress: Progress | None = None
) -> Array:
    """Lowest factor on each motion that overturns each body, nan up to `HIGHEST_FACTOR`; (bodies, motions)."""
    columns = []
    for k, motion in enumerate(motions):
        if progress is not None:
            progress(k / len(motions))
        found = [factor_from_one_side(problem, motion, stop) for problem in problems_of(body, motion)]
        columns.append(least(np.stack(found, axis=1)))
    return np.stack(columns, axis=1)


def factor_from_one_side(problem: Problem, motion: Motion, stop: StopFlag | None = None) -> Array:
    """Lowest factor on the motion of a problem that overturns each body, nan up to `HIGHEST_FACTOR`; (bodies,)."""
    if isinstance(motion.motion, Record):
        return _record_factor(problem, motion.motion, stop)
    peak = motion.peak_acceleration
    return lowest_thresholds(problem, HIGHEST_FACTOR * peak, stop) / peak


def overturned_by(
    body: BodyArray, motion: Motion, stop: StopFlag | None = None, acceleration: Array | float | None = None
) -> Bools:
    """Whether a motion overturns each body from either side, at the strength of the site or at another one."""
    given = motion.peak_acceleration if acceleration is None else acceleration
    if isinstance(motion.motion, Record):
        given = np.minimum(given, motion.motion.peak_acceleration * _strongest(motion.motion))
    problems = problems_of(body, motion, given)
    codes = [problem.solve_edges(stop=stop)[0]["outcome"].reshape(problem.shape) for problem in problems]
    return np.asarray(np.max(codes, axis=0) >= Outcome.OVERTURNED_DIRECTLY)


def responses_of(
    body: BodyArray, motions: Sequence[Motion], stop: StopFlag | None = None
) -> tuple[Bools, Array, Array]:
    """Whether each motion overturns each body, and otherwise its largest rotation [rad] and movement of the top [m]."""
    overturned, rotation, displacement = [], [], []
    for motion in motions:
        problems = problems_of(body, motion)
        found = [respond(problem, stop=stop) for problem in problems]
        overturned.append(np.logical_or.reduce([one.overturned for one in found]))
        rotation.append(np.fmax.reduce([one.rotation for one in found]))
        displacement.append(np.fmax.reduce([one.displacement for one in found]))
    return np.stack(overturned, 1), np.stack(rotation, 1), np.stack(displacement, 1)


def problems_of(body: BodyArray, motion: Motion, acceleration: Array | float | None = None) -> list[Problem]:
    """The bodies under a motion, and its mirror image where that differs, at the strength of the site or another."""
    return [problem_of(side, motion, acceleration) for side in body.sides]


def problem_of(body: BodyArray, motion: Motion, acceleration: Array | float | None = None) -> Problem:
    """The bodies under a motion from one side, at the strength of the site or another."""
    peak = motion.peak_acceleration if acceleration is None else acceleration
    return Problem(body, motion.motion, np.asarray(peak), np.asarray(motion.period), None)


def _strongest(record: Record) -> float:
    """Factor of a record up to which its vertical component does not lift everything off the ground."""
    return 0.999 * highest_vertical_scale(record)


def _record_factor(problem: Problem, record: Record, stop: StopFlag | None) -> Array:
    """Lowest of `LEVELS` at which a record overturns each body, and the change of outcome below it."""
    cells = problem.cells
    top = _strongest(record) * record.peak_acceleration / float(problem.peak_acceleration)

    def classify(factor: Array, lines: Array, _eta: Array) -> tuple[NDArray[np.int64], Array]:
        chosen, limited = cells[lines.astype(np.intp)], np.minimum(factor, top)
        chosen["slenderness"] /= limited[:, None]
        chosen["vertical"] *= limited
        records, edges = solve_motion(record, chosen, None, stop)
        hit = records["outcome"] >= Outcome.OVERTURNED_DIRECTLY
        return hit.astype(np.int64), np.maximum(outcome_margin_of(records, edges, chosen), -1.0)

    hit, margin = np.zeros((cells.size, LEVELS.size + 1)), np.full((cells.size, LEVELS.size + 1), -1.0)
    rows = np.arange(cells.size)
    for k, level in enumerate(LEVELS, start=1):  # from the weakest one, each body up to the first that overturns it
        hit[rows, k], margin[rows, k] = classify(np.full(rows.size, level), rows.astype(np.float64), LEVELS)
        rows = rows[hit[rows, k] == 0]
    found = np.full(cells.size, np.nan)
    line = np.flatnonzero(hit.any(axis=1))
    first = hit[line].argmax(axis=1)
    points = np.stack([np.ones(line.size), line.astype(np.float64), np.zeros(line.size)], axis=1)
    pair = np.stack([first, first - 1], axis=1)
    ends, margins = np.concatenate([[0.0], LEVELS])[pair], margin[line[:, None], pair]
    overturns, survives = np.ones(line.size, dtype=np.int64), np.zeros(line.size, dtype=np.int64)
    bracket = refine_brackets(0, points, ends, margins, overturns, survives, classify, RECORD_RESOLUTION)
    found[line] = np.minimum(bracket.ends[:, 0], top)
    return found
