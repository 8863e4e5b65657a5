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
from rocking._excitation.records.record import Record
from rocking._excitation.records.vertical import highest_vertical_scale
from rocking._model.outcome import Outcome
from rocking._numba.cancellation import StopFlag
from rocking._solver.bodies import outcome_margin_of, solve_motion
from rocking._solver.chunks import AVAILABLE_CORES, fill_chunks
from rocking._solver.records.samples import motion_samples

Solved = tuple[Array, Flags, Array, NDArray[np.int32]]
"""Peak |theta|/alpha, whether the body overturns, margin of the outcome, and impacts."""

HIGHEST = 100.0  # largest peak acceleration searched over that of uplift [-]

GRID = np.union1d(np.linspace(1.0 / HIGHEST, 1.0, 2001), np.geomspace(1.0 / HIGHEST, 1.0, 2001))[::-1]
"""1/a [-] of the nodes of `rocking.thresholds`, from uplift on."""

COARSE = 128
"""Number of intervals between the nodes that are solved first, a power of two.

An interval between two nodes is then halved if, at a multiple of their variation there, the margin can reach zero and
the peak rotation alpha, from more than `QUIET` on. The multiple is the number of flights, `FEWEST_FLIGHTS` at least for
the peak, up to `MOST_FLIGHTS`, since each impact makes the outcome depend more on the amplitude. Of 2,800 random bodies
under seven pulses, 1,799 overturn up to a = 12: with 16 at least for the peak, and `LAYERS` equal to `CLOSE`, the
lowest threshold is that of all nodes for each of them. Of 42,000 thresholds at two sites none differs from those with
the present values; with 8 for the peak one does, with a `MOST_FLIGHTS` of 8 one, of 4 five, all under the pulse c2.
"""

MOST_FLIGHTS = 16

FEWEST_FLIGHTS = 4

QUIET = 0.25
"""Peak |theta|/alpha that one end of an interval must exceed to be halved for this reason [-].

Of 14,000 random bodies under seven pulses none loses a threshold up to 0.4, 2 under the pulse c2 do with 0.5, 62 with
0.9. It saves 27 % of the work under c1 and c2, where bodies strike often at small rotations, else 5 to 20 %.
"""

CLOSE, LAYERS = 32, 4
"""Number of nodes below the first that overturns that are all solved, at most and for each flight.

Layers of outcomes lie close together there, the more of them the more flights there are.
"""

AT_ONCE = 4  # coarse nodes solved at a time, before the bodies that have overturned are left out


BALANCED = 1.0  # |theta|/alpha of a body that is balanced on an edge, and of one that overturns [-]


@dataclass(eq=False)
class _Nodes:
    """Solved amplitudes of several bodies in order of body, then amplitude; arrays (nodes,)."""

    line: Index  # number of the body
    place: Index  # number of the amplitude, ascending with it
    peak: Array  # peak |theta|/alpha, `BALANCED` of a body that overturns [-]
    overturned: Flags
    margin: Array  # of the outcome
    impacts: NDArray[np.int32]

    def joined(self, other: _Nodes) -> _Nodes:
        """Those of both up to the first of each body that overturns, in order."""
        both = [np.concatenate(pair) for pair in zip(vars(self).values(), vars(other).values(), strict=True)]
        line, place = both[:2]
        beyond = place.max(initial=0) + 1
        order = np.argsort(line * beyond + place, kind="stable")  # of two sorted runs: one merge
        order = order[place[order] <= _Nodes(*both).first_overturned(beyond)[line[order]]]
        return _Nodes(*(column[order] for column in both))

    def first_overturned(self, none: int) -> Index:
        """Place of the first node of each body that overturns, `none` where there is none."""
        first = np.full(self.line.max(initial=-1) + 1, none)
        np.minimum.at(first, self.line[self.overturned], self.place[self.overturned])
        return first


def lowest_thresholds(
    problem: Problem,
    highest: Array | float,
    stop: StopFlag | None = None,
    *,
    resolution: float = SCAN_RESOLUTION,
    enough: float = 0.0,
) -> Array:
    """The lowest peak acceleration [m/s2] that overturns each body of a problem, whose own one is not read; else nan.

    Under a record as `rocking._boundary.scan.lowest_overturning`. Under a pulse the nodes of `rocking.thresholds` are
    searched from uplift on: every 128th one up to the first that overturns, then those between them where the body
    could overturn, see `COARSE`. The change of outcome is bracketed to `RESOLUTION` in 1/a, and both ends of the
    bracket have been solved. `highest` [m/s2] broadcasts with the problem; under a pulse at most `HIGHEST` times that
    of uplift is searched, under a record up to where the vertical acceleration reaches -g. Under a record: `resolution`
    is the largest relative distance of the accelerations that are tried, `enough` as of `lowest_overturning` [m/s2].
    """
    motion = problem.motion
    shape = np.broadcast_shapes(problem.shape, np.shape(highest))
    if isinstance(motion, Record):
        peak = motion.peak_acceleration
        lines = replace(problem, peak_acceleration=np.full(shape, peak))
        start, limit = record_range(lines)
        factor = np.broadcast_to(highest, shape).ravel() / peak
        given = record_lines(lines, stop)
        found = lowest_overturning(given, start, factor, limit, resolution=resolution, enough=enough / peak)
        return found.reshape(shape) * peak
    uplift = np.broadcast_to(problem.body.uplift_acceleration, shape)
    cells = replace(problem, peak_acceleration=np.asarray(uplift)).cells
    top = (np.broadcast_to(highest, shape) / uplift).ravel()
    count = np.minimum(np.searchsorted(-GRID, -1.0 / np.maximum(top, 1.0)) + 1, GRID.size)  # nodes up to the highest

    found = np.full(top.size, np.nan)

    def fill(part: slice, _flag: NDArray[np.uint8]) -> None:
        found[part] = _lowest(motion, cells[part], count[part], top[part], stop)

    fill_chunks(fill, top.size, max(FEWEST, math.ceil(top.size / (SHARES * AVAILABLE_CORES))), AVAILABLE_CORES, stop)
    return found.reshape(shape) * uplift


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
    resisted = problem.cells["slenderness"] * record.peak_acceleration  # g tan(alpha_s)
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
    return 1.0 / np.maximum(excess, 1.0 / HIGHEST_SCALE), np.minimum(limit, HIGHEST_SCALE)


def _lowest(motion: AbstractPulse, cells: NDArray[np.void], count: Index, top: Array, stop: StopFlag | None) -> Array:
    """The lowest threshold of each cell over uplift, of `count` nodes up to `top`."""

    def solve(line: Index, slenderness: Array) -> Solved:
        chosen = cells[line]
        chosen["slenderness"] *= slenderness[:, None]
        records, edges = solve_motion(motion, chosen, 1, stop)
        margin = np.maximum(outcome_margin_of(records, edges, chosen), -1.0)
        overturned = records["outcome"] >= Outcome.OVERTURNED_DIRECTLY
        return np.where(overturned, BALANCED, records["peak_rotation"]), overturned, margin, records["impacts"]

    certain = np.clip(_certain_survival(motion, cells), 1.0, HIGHEST)
    start = np.searchsorted(-GRID, -1.0 / certain, "right") - 1
    nodes = _searched(solve, start, np.where(top > certain, count, 0))
    found = np.full(top.size, np.nan)
    above = np.flatnonzero(nodes.overturned)
    if above.size:
        line = nodes.line[above]

        def classify(slenderness: Array, lines: Array, *_others: Array) -> tuple[NDArray[np.int64], Array]:
            _, overturned, margin, _ = solve(lines.astype(np.intp), slenderness)
            return overturned.astype(np.int64), margin

        unused = np.zeros(line.size)
        points = np.stack([unused, line, unused, unused], axis=1)
        pair = np.stack([above, above - 1], axis=1)
        codes = np.ones(line.size, dtype=np.int64)
        met = np.zeros(line.size, dtype=np.int64)
        ends = GRID[nodes.place[pair]]
        bracket = refine_brackets(0, points, ends, nodes.margin[pair], codes, met, classify, RESOLUTION)
        found[line] = 1.0 / bracket.ends[:, 0]
    return np.where(found > top, np.nan, found)


def _searched(solve: Callable[[Index, Array], Solved], start: Index, count: Index) -> _Nodes:
    """The nodes up to the first that overturns of each body, of those from `start` up to `count`, excluded."""

    def solved(line: Index, place: Index) -> _Nodes:
        return _Nodes(line, place, *solve(line, GRID[place]))

    none = np.empty(0, dtype=np.intp)
    nodes = solved(none, none)
    # the last one may lie closer to the one before
    first, end = start.copy(), np.where(count > 0, count + COARSE - 1, 0)
    while (left := np.flatnonzero(first < end)).size:
        line, place = np.broadcast_arrays(left[:, None], first[left, None] + COARSE * np.arange(AT_ONCE))
        inside = place < end[left, None]
        nodes = nodes.joined(solved(line[inside], np.minimum(place, count[left, None] - 1)[inside]))
        first += AT_ONCE * COARSE
        end[nodes.line[nodes.overturned]] = 0
    while (halved := np.flatnonzero(_halved(nodes))).size:
        nodes = nodes.joined(solved(nodes.line[halved], (nodes.place[halved] + nodes.place[halved + 1]) // 2))
    return nodes


def _halved(nodes: _Nodes) -> Flags:
    """Whether each interval between two nodes is halved."""
    same = np.diff(nodes.line) == 0
    gap = np.where(same, np.diff(nodes.place), 0)
    flights = np.minimum(1 + np.maximum(nodes.impacts[:-1], nodes.impacts[1:]), MOST_FLIGHTS)
    likely = _reach(nodes.margin, same, flights) >= 0.0
    likely &= _reach(nodes.peak, same, np.maximum(flights, FEWEST_FLIGHTS)) >= BALANCED
    likely &= np.maximum(nodes.peak[:-1], nodes.peak[1:]) > QUIET
    first = nodes.first_overturned(2 * GRID.size)
    close = first[nodes.line[1:]] - nodes.place[1:] < np.minimum(CLOSE, LAYERS * flights)
    below = nodes.overturned[1:] | np.append(nodes.overturned, False)[2:]
    return np.asarray((gap > 1) & (likely | close | below))


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


def _reach(values: Array, same: Flags, multiple: NDArray[np.integer]) -> Array:
    """The larger of two consecutive values of a body plus a multiple of the variation there; arrays (values - 1,)."""
    step = np.where(same, np.abs(np.diff(values)), 0.0)
    beside = np.maximum(step, np.maximum(np.append(0.0, step)[:-1], np.append(step, 0.0)[1:]))
    return np.asarray(np.maximum(values[:-1], values[1:]) + multiple * beside)
