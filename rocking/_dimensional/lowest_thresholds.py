"""Lowest peak accelerations of a pulse that overturn bodies, for arrays of bodies at once."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from rocking._base.errors import InvalidArgumentError
from rocking._boundary.search import RESOLUTION, refine_brackets
from rocking._dimensional.problem import Problem
from rocking._excitation.impulse import impulse_of
from rocking._excitation.pulses import AbstractPulse
from rocking._excitation.records.record import Record
from rocking._model.outcome import Outcome
from rocking._numba.cancellation import StopFlag
from rocking._solver.bodies import outcome_margin_of, solve_motion
from rocking._solver.chunks import AVAILABLE_CORES, fill_chunks

Array = NDArray[np.float64]
Index = NDArray[np.intp]
Solved = tuple[Array, Array, NDArray[np.int32], NDArray[np.bool_]]
"""Margin of the outcome, peak |theta|/alpha, impacts, and whether the body overturns."""

HIGHEST = 100.0
"""Largest peak acceleration searched over that of uplift [-]."""

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

BALANCED = 1.0
"""|theta|/alpha of a body that is balanced on an edge, and of one that overturns."""

AT_ONCE = 4
"""Coarse nodes solved at a time, before the bodies that have overturned are left out."""

PARTS = 4
"""Parts of an array of bodies for each core; `FEWEST` bodies in one at least, below which the overhead counts."""

FEWEST = 64


@dataclass(eq=False)
class _Nodes:
    """Solved nodes of several bodies in order of body, then amplitude; arrays (nodes,)."""

    line: Index
    place: Index
    margin: Array
    peak: Array
    impacts: NDArray[np.int32]
    overturned: NDArray[np.bool_]

    def joined(self, other: _Nodes) -> _Nodes:
        """Those of both up to the first of each body that overturns, in order."""
        both = _Nodes(*(np.concatenate(pair) for pair in zip(vars(self).values(), vars(other).values(), strict=True)))
        order = np.argsort(both.line * GRID.size + both.place, kind="stable")  # of two sorted runs: one merge
        line, place, overturned = both.line[order], both.place[order], both.overturned[order]
        first = np.full(line.max(initial=-1) + 1, GRID.size)
        np.minimum.at(first, line[overturned], place[overturned])
        kept = order[place <= first[line]]
        return _Nodes(*(column[kept] for column in vars(both).values()))


def lowest_thresholds(problem: Problem, highest: Array | float, stop: StopFlag | None = None) -> Array:
    """The lowest peak acceleration of a pulse that overturns each body of a problem, whose own one is not read.

    The nodes of `rocking.thresholds` are searched from uplift on: every 128th one up to the first that
    overturns, then those between them where the body could overturn, see `COARSE`. The change of outcome is bracketed
    to `RESOLUTION` in 1/a, and both ends of the bracket have been solved.

    Parameters
    ----------
    problem : Problem
        Bodies under a pulse.
    highest : float array
        Highest peak acceleration searched, which broadcasts with the problem [m/s2]; at most `HIGHEST` times that of
        uplift is searched.
    stop : StopFlag, optional
        Cancels the work, which then raises `StoppedError`.

    Returns
    -------
    float array
        Peak acceleration at which the body overturns [m/s2], nan where none up to the highest was found.

    Raises
    ------
    InvalidArgumentError
        For a record.
    """
    motion = problem.motion
    if isinstance(motion, Record):
        raise InvalidArgumentError("motion", motion, "a pulse")
    shape = np.broadcast_shapes(problem.shape, np.shape(highest))
    uplift = np.broadcast_to(problem.body.uplift_acceleration, shape)
    cells = replace(problem, peak_acceleration=np.asarray(uplift)).cells
    top = (np.broadcast_to(highest, shape) / uplift).ravel()
    count = np.minimum(np.searchsorted(-GRID, -1.0 / np.maximum(top, 1.0)) + 1, GRID.size)  # nodes up to the highest

    found = np.full(top.size, np.nan)

    def fill(part: slice, _flag: NDArray[np.uint8]) -> None:
        found[part] = _lowest(motion, cells[part], count[part], top[part], stop)

    fill_chunks(fill, top.size, max(FEWEST, math.ceil(top.size / (PARTS * AVAILABLE_CORES))), AVAILABLE_CORES, stop)
    return found.reshape(shape) * uplift


def _lowest(motion: AbstractPulse, cells: NDArray[np.void], count: Index, top: Array, stop: StopFlag | None) -> Array:
    """The lowest threshold of each cell over uplift, of `count` nodes up to `top`."""

    def solve(line: Index, slenderness: Array) -> Solved:
        chosen = cells[line]
        chosen["slenderness"] *= slenderness[:, None]
        records, edges = solve_motion(motion, chosen, 1, stop)
        margin = np.maximum(outcome_margin_of(records, edges, chosen), -1.0)
        overturned = records["outcome"] >= Outcome.OVERTURNED_DIRECTLY
        return margin, np.where(overturned, BALANCED, records["peak_rotation"]), records["impacts"], overturned

    safe = np.clip(_certain_survival(motion, cells), 1.0, HIGHEST)
    start = np.searchsorted(-GRID, -1.0 / safe, "right") - 1
    nodes = _searched(solve, start, np.where(top > safe, count, 0))
    found = np.full(top.size, np.nan)
    above = np.flatnonzero(nodes.overturned)
    if above.size:
        line = nodes.line[above]

        def classify(slenderness: Array, lines: Array, _eta: Array) -> tuple[NDArray[np.int64], Array]:
            margin, *_, overturned = solve(lines.astype(np.intp), slenderness)
            return overturned.astype(np.int64), margin

        points = np.stack([np.ones(line.size), line, np.zeros(line.size)], axis=1)
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
    while True:
        same = np.diff(nodes.line) == 0
        gap = np.where(same, np.diff(nodes.place), 0)
        flights = np.minimum(1 + np.maximum(nodes.impacts[:-1], nodes.impacts[1:]), MOST_FLIGHTS)
        likely = _reach(nodes.margin, same, flights) >= 0.0
        likely &= _reach(nodes.peak, same, np.maximum(flights, FEWEST_FLIGHTS)) >= BALANCED
        likely &= np.maximum(nodes.peak[:-1], nodes.peak[1:]) > QUIET
        first = np.full(count.size, 2 * GRID.size)
        first[nodes.line[nodes.overturned]] = nodes.place[nodes.overturned]
        close = first[nodes.line[1:]] - nodes.place[1:] < np.minimum(CLOSE, LAYERS * flights)
        below = nodes.overturned[1:] | np.append(nodes.overturned, False)[2:]
        halved = np.flatnonzero((gap > 1) & (likely | close | below))
        if not halved.size:
            return nodes
        nodes = nodes.joined(solved(nodes.line[halved], (nodes.place[halved] + nodes.place[halved + 1]) // 2))


def _reach(values: Array, same: NDArray[np.bool_], multiple: NDArray[np.integer]) -> Array:
    """The larger of two consecutive values of a body plus a multiple of the variation there; arrays (values - 1,)."""
    step = np.where(same, np.abs(np.diff(values)), 0.0)
    variation = np.maximum(step, np.maximum(np.append(0.0, step)[:-1], np.append(step, 0.0)[1:]))
    return np.asarray(np.maximum(values[:-1], values[1:]) + multiple * variation)


def _certain_survival(pulse: AbstractPulse, cells: NDArray[np.void]) -> Array:
    """An a = a_g/(g tan alpha) of the weaker edge below which each body cannot overturn [-].

    Let v be the velocity that the body would have at theta = 0. Between impacts v' <= p_s^2 (a_g/g) |f|, impacts do not
    raise v, and to pass the equilibrium on the edge s takes v = 2 p_s sin(alpha_s/2).
    """
    alpha = np.stack([cells["alpha"], cells["alpha"] * cells["ratio"]])
    p = np.stack([np.ones(cells.size), np.sqrt(cells["stiffness"])])  # over that of the right edge
    needed = (2.0 * p * np.sin(0.5 * alpha)).min(axis=0)
    gained = (p * p).max(axis=0) * np.tan(alpha.min(axis=0)) * impulse_of(pulse).total / cells["rate"]
    return np.asarray(needed / gained)
