"""Lowest peak accelerations of a motion that overturn bodies, for arrays of bodies at once."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rocking._base.arrays import Array, Flags, Index
from rocking._base.quantities import HIGHEST_SCALE
from rocking._boundary.scan import FEWEST, SHARES, Lines, lowest_overturning
from rocking._boundary.scan import RESOLUTION as SCAN_RESOLUTION
from rocking._boundary.search import RESOLUTION, refine_brackets
from rocking._dimensional.problem import Problem
from rocking._excitation.impulse import impulse_of
from rocking._excitation.pulses import AbstractPulse
from rocking._excitation.records.vertical import highest_vertical_scale
from rocking._model.outcome import Outcome
from rocking._numba.cancellation import StopFlag
from rocking._solver.bodies import outcome_margin_of
from rocking._solver.bodies import solve as solve_bodies
from rocking._solver.chunks import AVAILABLE_CORES, fill_chunks
from rocking._solver.records.samples import motion_samples

HIGHEST = 100.0  # largest peak acceleration searched over that of uplift [-]

PULSE_SHARE = 0.4
"""Largest distance of the strengths of a pulse that are tried over the resolution under a record [-]: 0.2 %."""

PARTS, VARIATIONS = 16, 16.0
"""Parts, a power of two, into which this distance is divided where a body may overturn: where the peak |theta|/alpha at
one end of an interval, and so many times its variation there, reach 1.

Compared with strengths 0.01 % apart: of 172 bodies under wavelets of 3 to 15 cycles 9 overturn at a lower one, none by
more than 1 %, after 800 responses a body; with strengths 0.1 % apart everywhere 24 do, 3 by more than 1 %, after 1,140.
Of 180 under the standard pulses 1 does, by 0.1 %. With 4 variations 13 and 1 do.
"""

AT_ONCE = 128
"""Intervals of a body that are searched at a time, before bodies that have overturned are left out."""

NEVER = np.iinfo(np.intp).max
"""Place of the first strength that overturns a body which none overturns."""


@dataclass(eq=False)
class _Responses:
    """Responses of several bodies to a pulse in order of body, then strength; arrays (responses,)."""

    line: Index  # number of the body
    place: Index  # number of the strength, ascending with it
    peak: Array  # peak |theta|/alpha, 1 of a body that overturns [-]
    overturned: Flags

    def with_others(self, other: _Responses) -> _Responses:
        """Those of both, in order."""
        columns = [np.concatenate(pair) for pair in zip(vars(self).values(), vars(other).values(), strict=True)]
        order = np.lexsort((columns[1], columns[0]))
        return _Responses(*(column[order] for column in columns))

    def first_overturned(self) -> Index:
        """Place of the first of each body that overturns, `NEVER` where there is none; (bodies,)."""
        first = np.full(self.line.max(initial=-1) + 1, NEVER)
        np.minimum.at(first, self.line[self.overturned], self.place[self.overturned])
        return first

    def halved(self) -> Flags:
        """Whether the body may overturn between two consecutive responses, which are more than one place apart."""
        same = np.diff(self.line) == 0
        step = np.where(same, np.abs(np.diff(self.peak)), 0.0)
        variation = np.maximum(step, np.maximum(np.append(0.0, step[:-1]), np.append(step[1:], 0.0)))
        likely = np.maximum(self.peak[:-1], self.peak[1:]) + VARIATIONS * variation >= 1.0
        below = self.place[:-1] < self.first_overturned()[self.line[:-1]]
        return np.asarray(same & likely & below & (np.diff(self.place) > 1))


def lowest_thresholds(
    problem: Problem,
    highest: Array | float,
    stop: StopFlag | None = None,
    *,
    resolution: float = SCAN_RESOLUTION,
    enough: float = 0.0,
) -> Array:
    """The lowest peak acceleration [m/s2] that overturns each body of a problem, whose own one is not read; else nan.

    Under a record as `rocking._boundary.scan.lowest_overturning`, with this resolution and `enough` [m/s2]. Under a
    pulse strengths are tried from uplift on, or from where the body may overturn at all, up to the first that
    overturns: `PULSE_SHARE` times the resolution apart, and down to a 16th of that where the body may overturn. The
    change of outcome below it is bracketed to `RESOLUTION` in 1/a, and both ends of the bracket have been solved.
    `highest` [m/s2] broadcasts with the problem; under a pulse at most `HIGHEST` times that of uplift is searched,
    under a record up to where the vertical acceleration reaches -g.
    """
    motion = problem.motion
    shape = np.broadcast_shapes(problem.shape, np.shape(highest))
    if motion.is_scanned:
        peak = motion.unit_acceleration
        lines = replace(problem, strength=np.ones(shape))
        start, limit = record_range(lines)
        factor = np.broadcast_to(highest, shape).ravel() / peak
        given = record_lines(lines, stop)
        found = lowest_overturning(given, start, factor, limit, resolution=resolution, enough=enough / peak)
        return found.reshape(shape) * peak
    uplift = np.broadcast_to(problem.body.uplift_acceleration, shape)
    cells = replace(problem, strength=uplift).cells
    top = np.minimum(np.broadcast_to(highest, shape) / uplift, HIGHEST).ravel()
    lowest, pulse = np.full(top.size, np.nan), problem.pulse

    def fill(part: slice, _flag: NDArray[np.uint8]) -> None:
        lowest[part] = _lowest_under_pulse(pulse, cells[part], top[part], PULSE_SHARE * resolution, stop)

    fill_chunks(fill, top.size, max(FEWEST, math.ceil(top.size / (SHARES * AVAILABLE_CORES))), AVAILABLE_CORES, stop)
    return lowest.reshape(shape) * uplift


def record_lines(problem: Problem, stop: StopFlag | None = None) -> Lines:
    """The bodies of a problem under its record at the factor 1, as lines of other factors."""
    record: Any = problem.motion
    at_one = problem.cells

    def cells(line: Index, factor: Array) -> NDArray[np.void]:
        chosen = at_one[line]
        chosen["slenderness"] /= factor[:, None]
        chosen["vertical"] *= factor
        return chosen

    return Lines(motion_samples(record), cells, each_side=True, stop=stop)


def record_range(problem: Problem) -> tuple[Array, Array]:
    """Factors of a record at which each body uplifts, and at which the vertical acceleration reaches -g; (size,).

    Uplift of an edge is where the horizontal acceleration over g tan(alpha_s) of the other reaches 1 + w/g
    (`rocking._model.body`): at a sample, since all of them are linear between samples.
    """
    record: Any = problem.motion
    cells = problem.cells
    resisted = cells["slenderness"] * record.peak_acceleration  # g tan(alpha_s)
    gravity = np.broadcast_to(problem.body.gravity, problem.shape).ravel()
    if record.vertical is None:
        first, second = record.acceleration.max(), -record.acceleration.min()
        excess = np.maximum(first / resisted[:, 1], second / resisted[:, 0])
        limit = np.full(gravity.size, math.inf)
    else:
        excess = np.array(
            [
                (np.maximum(record.acceleration / left, -record.acceleration / right) - record.vertical / g).max()
                for (right, left), g in zip(resisted.tolist(), gravity.tolist(), strict=True)
            ]
        )
        limit = np.array([highest_vertical_scale(record, g) for g in gravity.tolist()])
    return (1.0 + cells["prestress"]) / np.maximum(excess, 1.0 / HIGHEST_SCALE), np.minimum(limit, HIGHEST_SCALE)


def _lowest_under_pulse(
    motion: AbstractPulse, cells: NDArray[np.void], top: Array, resolution: float, stop: StopFlag | None
) -> Array:
    """The lowest threshold over uplift of each cell up to `top` [-]; strengths are at most `resolution` apart."""
    unit = math.log1p(resolution) / PARTS

    def slenderness_at(place: Index) -> Array:
        return np.asarray(np.exp(-unit * place))

    def solve(line: Index, slenderness: Array) -> tuple[NDArray[np.void], Flags, Array]:
        chosen = cells[line]
        chosen["slenderness"] *= slenderness[:, None]
        records, edges = solve_bodies(motion, chosen, 1, stop)
        margin = np.maximum(outcome_margin_of(records, edges, chosen), -1.0)
        return records, records["outcome"] >= Outcome.OVERTURNED_DIRECTLY, margin

    def responses(line: Index, place: Index) -> _Responses:
        records, overturned, _ = solve(line, slenderness_at(place))
        return _Responses(line, place, np.where(overturned, 1.0, records["peak_rotation"]), overturned)

    certain = np.clip(_certain_survival(motion, cells), 1.0, HIGHEST)
    start = np.floor(np.log(certain) / unit).astype(np.intp)
    end = np.where(top > certain, np.ceil(np.log(np.maximum(top, 1.0)) / unit), 0.0).astype(np.intp)
    below, first = _first_change(responses, start, end)
    lowest = np.full(top.size, np.nan)
    line = np.flatnonzero(first < NEVER)
    if line.size:

        def classify(slenderness: Array, lines: Array, *_others: Array) -> tuple[NDArray[np.int64], Array]:
            _, overturned, margin = solve(lines.astype(np.intp), slenderness)
            return overturned.astype(np.int64), margin

        unused = np.zeros(line.size)
        points: Array = np.stack([unused, line.astype(np.float64), unused, unused], axis=1)
        ends = slenderness_at(np.stack([first[line], below[line]], axis=1))
        margins = solve(np.repeat(line, 2), ends.ravel())[2].reshape(ends.shape)
        codes = np.ones(line.size, dtype=np.int64)
        met = np.zeros(line.size, dtype=np.int64)
        bracket = refine_brackets(0, points, ends, margins, codes, met, classify, RESOLUTION)
        lowest[line] = 1.0 / bracket.ends[:, 0]
    return np.where(lowest > top, np.nan, lowest)


def _first_change(responses: Callable[[Index, Index], _Responses], start: Index, end: Index) -> tuple[Index, Index]:
    """Places of the first strength that overturns each body and of the one tried below it, from `start` up to `end`.

    The first is `NEVER` where none overturns; a body survives at `start`. Arrays (bodies,).
    """
    below, first, solved_to = start.copy(), np.full(start.size, NEVER), start.copy()
    while (left := np.flatnonzero((first == NEVER) & (solved_to < end))).size:
        line, place = np.broadcast_arrays(left[:, None], solved_to[left, None] + PARTS * np.arange(AT_ONCE + 1))
        inside = place < end[left, None] + 2 * PARTS  # the variation up to the end is known
        window = responses(line[inside], place[inside])
        while (halved := np.flatnonzero(window.halved())).size:
            middle = (window.place[halved] + window.place[halved + 1]) // 2
            window = window.with_others(responses(window.line[halved], middle))
        overturned = np.flatnonzero(window.overturned)
        body, index = np.unique(window.line[overturned], return_index=True)
        lowest = overturned[index]
        first[body], below[body] = window.place[lowest], window.place[lowest - 1]
        solved_to[left] += PARTS * AT_ONCE
    return below, first


def _certain_survival(pulse: AbstractPulse, cells: NDArray[np.void]) -> Array:
    """An a = a_g/(g tan alpha) of the weaker edge below which each body cannot overturn [-].

    Let v be the velocity that the body would have at theta = 0. Between impacts v' <= p_s^2 (a_g/g) |f|, impacts do not
    raise v, and to pass the equilibrium on the edge s takes v = 2 p_s sin(alpha_s/2).
    """
    ones = np.ones(cells.size)
    alpha = cells["alpha"] * np.stack([ones, cells["ratio"]])
    p = np.sqrt(np.stack([ones, cells["stiffness"]]))  # over that of the right edge
    needed = (2.0 * p * np.sin(0.5 * alpha)).min(axis=0)
    gained = (p * p).max(axis=0) * np.tan(alpha.min(axis=0)) * impulse_of(pulse).total / cells["rate"]
    return np.asarray(needed / gained)
