"""Strengths of a motion that overturn bodies: the lowest of each body, and every change of outcome of one body.

Under a record the outcome is not monotone in the strength, and the lowest range of strengths that overturn a body is
often narrow: of 140 pairs of objects and records half of these ranges are narrower than 0.1 %, since the body strikes
10 to 200 times, and there are others of 0.001 % and less. `lowest_overturning` tries strengths from that of uplift on,
`resolution` apart. Each response has a reach: how far above and below in strength one of its peaks comes to the
unstable equilibrium, by the derivative of the peak (`rocking._solver.records.estimate`). An interval is halved while it
is wide beside the reach at one of its ends, by two limits one after the other (`MULTIPLES`, `WIDER`), down to a 4096th
of the resolution. A flight that just touches the ground makes the response jump, and ranges lie close to such a
strength while both ends are calm: an interval is halved too where the sum of squares of all peaks changes otherwise
than by its derivative at the ends (`JUMP`), down to a 128th of the resolution. All this as long as the body has had
fewer than `BUDGET` responses in a `WINDOW`. Close below the lowest that overturns the intervals are as narrow as a
quarter of their distance from it. All of these are estimates: at the end of each window the solver confirms the lowest,
there or close by, or else the next ones, and the change of outcome below the lowest is bisected with it. Where samples
are coarse beside the motion of the body, strengths a resolution apart are solved too (`LONGEST_INTERVAL`). A narrower
range can be missed.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from numpy.typing import NDArray

from rocking._base.arrays import Array
from rocking._base.errors import number
from rocking._base.units import Scalar
from rocking._model.outcome import Outcome
from rocking._numba.cancellation import StopFlag
from rocking._solver.chunks import AVAILABLE_CORES, fill_chunks
from rocking._solver.records.estimate import estimate_outcomes
from rocking._solver.records.record_response import solve_bodies
from rocking._solver.restrained import is_restrained

Bools = NDArray[np.bool_]
Index = NDArray[np.intp]

RESOLUTION = 0.005
"""Largest relative distance of the strengths of a record that are tried in search of the lowest [-].

`python -m benchmarks.cost.assessment --scan 2000` counts the pairs of an object and a record that overturn below.
"""

RESOLUTIONS = 1e-4, 0.1
"""Finest and coarsest that can be asked for [-]."""

PARTS = 4096
"""Parts of the resolution, a power of two, into which it is divided where the body may overturn."""

CLOSE, CLOSE_RATIO = PARTS, 4
"""Parts below the lowest that overturns in which no interval is wider than its distance over the ratio."""

MULTIPLES, WIDER = (1.0, 8.0), 64.0
"""An interval is halved if so many times its width exceeds the reach at one of its ends, one after the other.

They are more by the factor 1 + `WIDER` width/resolution: in a wide interval the response may change in a way that no
derivative at its ends shows.
"""

JUMP, SMALLEST, STRICTER, NARROWEST = 0.02, 1e-3, 8.0, PARTS // 128
"""An interval is halved, down to `NARROWEST` parts, where the sum of squares changes otherwise than by its derivative,
by more than `JUMP` of itself [-]. A sum below `SMALLEST` counts as that [-]. The share that is allowed is less by the
factor 1 + `STRICTER` width/resolution: wide intervals are few, and some ranges of 0.01 % lie in them.
"""

LONGEST_INTERVAL = 0.1
"""Sample interval times p above which an estimate is not relied on at strengths a resolution apart [-].

Of 48,000 responses to records sampled at 0.05 to 0.1 s, 131 overturn and were estimated to survive, all with longer
intervals: 0.4 % of those that overturn. Under other records 16 of 27,698 have another outcome.
"""

WINDOW, BUDGET = 16, 6000
"""Intervals of the resolution that are searched together, from the weakest on; responses of a body in them after which
only those close below the lowest that overturns are halved."""

FEWEST, SHARES = 64, 4
"""Bodies in a part of an array at least, below which the overhead counts, and parts for each core."""

SCAN_RATIO = 1.002
"""Ratio of the strengths above the lowest that are tried in turn [-]: narrower ranges of an outcome can be missed."""

RELATIVE_ERROR = 1e-6
"""Relative width to which a change of outcome is bisected [-]."""

SHIFTS = 0, *(sign * shift for shift in (1, 2, 3, 4, 6, 8, 12, 16, 24) for sign in (-1, 1))
"""Parts from a strength that overturns by an estimate to those at which the solver confirms it, one after the other."""

_PARTS = 16
"""Values between the two ends of an interval that is bisected, solved by one call."""


@dataclass(frozen=True, eq=False)
class Lines:
    """Bodies under samples, a line of strengths for each body.

    Attributes
    ----------
    samples : float array (7, samples)
        Of `rocking._solver.records.samples.sample_rows`.
    cells : callable
        The bodies `BODY_CELL` from their numbers and strengths.
    each_side : bool
        As for `solve_bodies`.
    threads : int, optional
        For a few bodies; many are distributed over all cores.
    stop : StopFlag, optional
        Cancels the work.
    """

    samples: Array
    cells: Callable[[Index, Array], NDArray[np.void]]
    each_side: bool = False
    threads: int | None = None
    stop: StopFlag | None = None

    def overturned(self, line: Index, strength: Array) -> Bools:
        """Return True for the bodies that overturn."""
        records, _ = solve_bodies(self.samples, self.cells(line, strength), self.threads, self.stop, self.each_side)
        return np.asarray(records["outcome"] >= Outcome.OVERTURNED_DIRECTLY)

    def estimated(self, line: Index, strength: Array) -> tuple[Bools, Array]:
        """Estimate which bodies overturn, and the ends of `Intervals` (bodies, 4) by the logarithm of the strength.

        Of bodies with a tendon or a damper by the solver, without a reach: intervals are as wide as the resolution.
        """
        cells = self.cells(line, strength)
        if is_restrained(cells).any():
            ends = np.zeros((line.size, 4))
            ends[:, :2] = math.inf
            return self.overturned(line, strength), ends
        return estimate_outcomes(self.samples, cells, self.threads, self.stop)

    def overturned_where_coarse(self, line: Index, strength: Array) -> Bools:
        """Return True for the bodies that overturn and have a sample interval longer than `LONGEST_INTERVAL`."""
        cells = self.cells(line, strength)
        coarse = cells["rate"] > LONGEST_INTERVAL
        overturned = np.zeros(line.size, dtype=np.bool_)
        if coarse.any():
            overturned[coarse] = self.overturned(line[coarse], strength[coarse])
        return overturned

    def from_line(self, first: int) -> Lines:
        """Return the bodies from a number on."""
        return replace(self, cells=lambda line, strength: self.cells(line + first, strength))


@dataclass(eq=False)
class Intervals:
    """Intervals of strengths in order of line, then place: line and places (intervals,), the ends (intervals, 4).

    Columns of an end: the reach up, the reach down, the sum of squares of all peaks and its derivative; all 0 where the
    body overturns.
    """

    line: Index
    low: Index
    high: Index
    low_end: Array
    high_end: Array

    def unresolved(self, multiple: Array) -> Bools:
        """Return True where an interval is wide beside a reach into it, or its ends disagree; False for multiple 0."""
        gap = self.high - self.low
        share = gap / PARTS
        reach = np.minimum(self.low_end[:, 0], self.high_end[:, 1])
        wide = multiple * gap * (1.0 + WIDER * share) > reach
        low, high, slope = self.low_end[:, 2], self.high_end[:, 2], self.low_end[:, 3] + self.high_end[:, 3]
        allowed = JUMP * np.maximum(np.maximum(low, high), SMALLEST) / (1.0 + STRICTER * share)
        jumps = np.abs(high - low - 0.5 * gap * slope) > allowed
        return np.asarray(wide | (jumps & (gap > NARROWEST) & (multiple > 0.0)))

    def take(self, index: Index | Bools) -> Self:
        """Return some of the intervals."""
        return type(self)(*[column[index] for column in vars(self).values()])

    def merged(self, *parts: Self) -> Self:
        """Return the intervals of all parts, in order."""
        columns = zip(*[vars(part).values() for part in (self, *parts)], strict=True)
        joined = type(self)(*map(np.concatenate, columns))
        return joined.take(np.lexsort((joined.low, joined.line)))


def checked_resolution(resolution: Scalar) -> float:
    """Check the resolution of `lowest_overturning` [-].

    Raises
    ------
    InvalidArgumentError
        If it is not in `RESOLUTIONS`.
    """
    return number("resolution", resolution, *RESOLUTIONS)


def lowest_overturning(
    lines: Lines,
    start: Array,
    highest: Array | float,
    limit: Array | float = math.inf,
    *,
    resolution: float = RESOLUTION,
    enough: Array | float = 0.0,
) -> Array:
    """Search the lowest strength at which each body overturns, of those tried; nan where none up to the highest does.

    Parameters
    ----------
    lines : Lines
        The bodies.
    start : float array (bodies,)
        Strength up to which a body does not move, or the lowest of interest, > 0.
    highest : float array (bodies,)
        Highest strength. What is found up to it does not depend on it.
    limit : float array (bodies,)
        Strength beyond which there is no response.
    resolution : float
        Largest relative distance of two strengths [-]. Above `RESOLUTION` the budget of responses is smaller.
    enough : float array (bodies,)
        The search of a body ends with a strength up to this one that overturns it, which need not be the lowest; one
        above it is good to a 4096th of the resolution.

    Returns
    -------
    float array (bodies,)
        A strength that overturns the body; one lower by 1e-6, or the weakest, does not or is the start.
    """
    start, highest, limit, enough = np.broadcast_arrays(start, highest, limit, enough)
    lowest = np.full(start.shape, math.nan)
    size = max(FEWEST, math.ceil(start.size / (SHARES * AVAILABLE_CORES)))
    if start.size > size:
        lines = replace(lines, threads=1)

    def fill(part: slice, _flag: NDArray[np.uint8]) -> None:
        search = _Search(lines.from_line(part.start), start[part], limit[part], resolution, enough[part])
        lowest[part] = search.lowest(highest[part])

    fill_chunks(fill, start.size, size, AVAILABLE_CORES, lines.stop)
    return np.where(lowest > highest, math.nan, lowest)


class _Search:
    """Search for the lowest strengths of bodies; steps number the strengths that can be tried, from the start."""

    def __init__(self, lines: Lines, start: Array, limit: Array, resolution: float, enough: Array) -> None:
        self.lines, self.start, self.limit = lines, start, limit
        self.unit, self.budget = math.log1p(resolution) / PARTS, BUDGET * min(RESOLUTION / resolution, 1.0)
        with np.errstate(divide="ignore"):
            self.enough = np.log(enough / start) / self.unit  # step
        self.first = np.full(start.size, math.inf)  # step of the lowest that overturns, by an estimate or confirmed
        self.confirmed = self.first.copy()  # step of the lowest that is confirmed
        self.hits = np.empty((2, 0), dtype=np.intp)  # lines and steps that overturn by an estimate
        self.tried = np.zeros(start.size)  # responses in the window

    def strength(self, line: Index, step: Index | Array) -> Array:
        """Return the strength at a step."""
        return np.asarray(np.minimum(self.start[line] * np.exp(self.unit * step), self.limit[line]))

    def ends(self, line: Index, step: Index, *, solved: bool = False) -> Array:
        """Return the ends of `Intervals`, by parts; `solved`: not by an estimate alone where samples are coarse."""
        strength = self.strength(line, step)
        overturned, ends = self.lines.estimated(line, strength)
        if solved:
            overturned |= self.lines.overturned_where_coarse(line, strength)
        self.tried += np.bincount(line, minlength=self.tried.size)
        hits = np.stack([line, step])[:, overturned]
        self.hits = np.concatenate([self.hits, hits], axis=1)
        np.minimum.at(self.first, *hits)
        return np.where(overturned[:, None], 0.0, ends * [1.0 / self.unit, 1.0 / self.unit, 1.0, self.unit])

    def confirm(self) -> None:
        """Confirm the lowest that overturn by an estimate; where the solver does not, the next ones."""
        while (left := np.flatnonzero(self.first < self.confirmed)).size:
            for shift in SHIFTS:
                step = np.maximum(self.first[left] + shift, 0.0)
                overturned = self.lines.overturned(left, self.strength(left, step))
                line = left[overturned]
                self.confirmed[line] = np.minimum(self.confirmed[line], step[overturned])
                left = left[~overturned]
                if not left.size:
                    break
            line, step = self.hits
            self.hits = self.hits[:, step > self.first[line] + SHIFTS[-1]]
            self.first = self.confirmed.copy()
            np.minimum.at(self.first, *self.hits)

    def settled(self) -> Bools:
        """Return True for lines with a strength that is low enough."""
        return np.asarray(self.first <= self.enough)

    def lowest(self, highest: Array) -> Array:
        """Search the lowest strength of each body, nan where none up to the highest or a little above it is found."""
        with np.errstate(divide="ignore"):
            end = np.log(highest / self.start) / self.unit
            last = np.log(self.limit / self.start) / self.unit
        last = np.ceil(np.minimum(last, end + 2 * WINDOW * PARTS)).astype(np.intp)  # of the limit, where it is near
        lines, solved_to, intervals = np.flatnonzero(highest >= self.start), 0, None
        while lines.size:
            line, step = np.broadcast_arrays(lines[:, None], solved_to + PARTS * np.arange(WINDOW + 1))
            step = np.minimum(step, last[line])
            self.tried[:] = 0.0
            ends = self.ends(line.ravel(), step.ravel(), solved=True).reshape((*step.shape, 4))
            low, high = step[:, :-1].ravel(), step[:, 1:].ravel()
            low_end, high_end = ends[:, :-1].reshape(-1, 4), ends[:, 1:].reshape(-1, 4)
            window = Intervals(line[:, 1:].ravel(), low, high, low_end, high_end)
            intervals = window if intervals is None else intervals.merged(window)
            for multiple in MULTIPLES:
                intervals = self.refined(intervals, multiple)
            before = np.zeros(0)
            while not np.array_equal(before, self.first):  # what is close below the lowest
                before = self.first.copy()
                intervals = self.refined(intervals, MULTIPLES[-1])
                if np.array_equal(before, self.first):
                    self.confirm()
            solved_to += WINDOW * PARTS
            # those close below a later one are looked at again
            lines = lines[np.isinf(self.first[lines]) & (solved_to - CLOSE < end[lines]) & (solved_to < last[lines])]
            left = np.zeros(self.start.size, dtype=np.bool_)
            left[lines] = True
            intervals = intervals.take(left[intervals.line] & (intervals.high > solved_to - CLOSE))
        return self.bisected(np.flatnonzero(np.isfinite(self.first)))

    def refined(self, intervals: Intervals, multiple: float) -> Intervals:
        """Halve intervals until none is unresolved."""
        done: list[Intervals] = []
        while True:
            gap = intervals.high - intervals.low
            used = np.where(self.tried[intervals.line] < self.budget, multiple, 0.0)
            below = self.first[intervals.line] - intervals.low
            close = (below < CLOSE) & (CLOSE_RATIO * gap > below)
            searched = (below > 0.0) & ~self.settled()[intervals.line]
            halved = (gap > 1) & (intervals.unresolved(used) | close) & searched
            if not halved.any():
                return intervals.merged(*done) if done else intervals
            done.append(intervals.take(~halved))
            wide = intervals.take(halved)
            middle = (wide.low + wide.high) // 2
            end = self.ends(wide.line, middle)
            lower = replace(wide, high=middle, high_end=end)
            intervals = lower.merged(replace(wide, low=middle, low_end=end))

    def bisected(self, lines: Index) -> Array:
        """Bisect the change of outcome below the confirmed strength of some lines; return the lowest that overturn."""
        step = self.confirmed[lines]
        low = np.where(np.isfinite(self.enough[lines]), step, np.maximum(step - 1.0, 0.0))
        overturned, distance = np.ones(lines.size, dtype=np.bool_), 1.0
        while (down := np.flatnonzero(overturned & (low < step))).size:
            overturned[down] = self.lines.overturned(lines[down], self.strength(lines[down], low[down]))
            down, distance = down[overturned[down]], 2.0 * distance
            step[down] = low[down]
            low[down] = np.maximum(low[down] - distance, 0.0)
        over, under = self.strength(lines, step), self.strength(lines, low)
        while (wide := np.flatnonzero(over / under - 1.0 > RELATIVE_ERROR)).size:
            middle = np.sqrt(under[wide] * over[wide])
            overturned = self.lines.overturned(lines[wide], middle)
            under[wide] = np.where(overturned, under[wide], middle)
            over[wide] = np.where(overturned, middle, over[wide])
        lowest = np.full(self.start.size, math.nan)
        lowest[lines] = over
        return lowest


def scanned(lowest: float, highest: float) -> Array:
    """Return values from the lowest on at the ratio `SCAN_RATIO`; only the last one depends on the highest."""
    count = max(math.ceil(math.log(highest / lowest) / math.log(SCAN_RATIO)), 0)
    return np.minimum(lowest * SCAN_RATIO ** np.arange(count + 1.0), highest)


def outcome_changes(
    lines: Lines,
    lowest: float,
    highest: float,
    limit: float = math.inf,
    *,
    resolution: float = RESOLUTION,
) -> tuple[Array, Bools]:
    """Search every change of outcome of one body, bisected, and whether it overturns above; arrays (changes,).

    The first is that of `lowest_overturning`; above it the values of `scanned` are tried.
    """
    first = lowest_overturning(lines, np.array([lowest]), highest, limit, resolution=resolution)
    if np.isnan(first[0]):
        return np.empty(0), np.empty(0, dtype=np.bool_)

    def overturns(values: Array) -> Bools:
        return lines.overturned(np.zeros(values.size, dtype=np.intp), values)

    values = scanned(float(first[0]), highest)
    overturned = np.append(True, overturns(values[1:]))
    edges = np.flatnonzero(overturned[1:] != overturned[:-1])
    above = overturned[edges + 1]
    rows = zip(values[edges].tolist(), values[edges + 1].tolist(), above.tolist(), strict=True)
    changes = [_bisected(overturns, *row) for row in rows]
    return np.append(first, changes), np.append(True, above)


def _bisected(solve: Callable[[Array], Bools], low: float, high: float, above: bool) -> float:
    """Narrow the interval of a change; return the end that overturns, the upper one if `above`."""
    while high / low - 1.0 > RELATIVE_ERROR:
        edges: Array = np.geomspace(low, high, _PARTS + 2).astype(np.float64)
        changed = solve(edges[1:-1]) == above
        first = int(changed.argmax()) if changed.any() else _PARTS
        low, high = float(edges[first]), float(edges[first + 1])
    return high if above else low
