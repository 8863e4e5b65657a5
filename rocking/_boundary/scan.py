"""Strengths of a motion that overturn bodies: the lowest of each body, and every change of outcome of one body.

Under a record the outcome is not monotone in the strength, and the lowest range of strengths that overturn a body is
often narrow: of 208 pairs of objects and records half of these ranges are narrower than 0.1 %, since the body strikes
10 to 200 times. `lowest_overturning` therefore looks closely where the response comes near to overturning, and says how
closely it looks elsewhere.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol, Self, TypeVar

import numpy as np
from numpy.typing import NDArray

from rocking._base.errors import number
from rocking._base.units import Scalar
from rocking._numba.cancellation import StopFlag
from rocking._solver.chunks import AVAILABLE_CORES, fill_chunks

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]
Index = NDArray[np.intp]
N = TypeVar("N", bound="Nodes")

RESOLUTION = 0.005
"""Largest relative distance of the strengths of a record that are tried in search of the lowest [-].

`python -m benchmarks.cost.assessment --scan 2000` counts the pairs of an object and a record that overturn below.
"""

RESOLUTIONS = 1e-4, 0.1
"""Finest and coarsest that can be asked for [-]."""

PARTS = 64
"""Parts of the resolution, a power of two, into which it is divided where the body may overturn."""

CLOSE_PARTS = 32
"""Parts into which it is divided in the last interval below the first strength that overturns."""

QUIET = 0.02
"""Peak |theta|/alpha up to which the resolution is not divided [-]: 40 to 55 % of the strengths below the lowest."""

SLOPE, REACH = 2, 16
"""An interval is halved if its larger peak with so many times its change there, and so many times the distance of a
peak from the line between those beside it, reaches 1 [-].
"""

WINDOW = 8
"""Intervals of the resolution that are refined together, from the weakest on, before stronger ones are tried."""

BALANCED = 1.0
"""|theta|/alpha of a body that is balanced on an edge, and of one that overturns [-]."""

FEWEST, SHARES = 64, 4
"""Bodies in a part of an array at least, below which the overhead counts, and parts for each core."""

SCAN_RATIO = 1.002
"""Ratio of the strengths above the lowest that are tried in turn [-]: narrower ranges of an outcome can be missed."""

RELATIVE_ERROR = 1e-6
"""Relative width to which a change of outcome is bisected [-]."""

_PARTS = 16
"""Values between the two ends of an interval that is bisected, solved by one call."""


class SolveLines(Protocol):
    """Responses of bodies, each a line of strengths."""

    def __call__(self, line: Index, strength: Array, threads: int | None, /) -> tuple[Array, Bools]:
        """Peak |theta|/alpha [-] and whether the body overturns, for bodies by number and strengths (nodes,)."""


@dataclass(eq=False)
class Nodes:
    """Solved strengths of several bodies in order of body, then strength; arrays (nodes,).

    Attributes
    ----------
    line : int array
        Number of the body.
    place : int array
        Number of the strength, ascending with it.
    peak : float array
        Peak |theta|/alpha, `BALANCED` of a body that overturns [-].
    overturned : bool array
        Whether the body does.
    """

    line: Index
    place: Index
    peak: Array
    overturned: Bools

    def take(self, index: Index | Bools) -> Self:
        """Some of them."""
        return type(self)(*(column[index] for column in vars(self).values()))

    def joined(self, other: Self) -> Self:
        """Those of both up to the first of each body that overturns, in order."""
        both = type(self)(*map(np.concatenate, zip(vars(self).values(), vars(other).values(), strict=True)))
        beyond = both.place.max(initial=0) + 1
        order = np.argsort(both.line * beyond + both.place, kind="stable")  # of two sorted runs: one merge
        return both.take(order[both.place[order] <= both.first_overturned(beyond)[both.line[order]]])

    def first_overturned(self, none: int) -> Index:
        """Place of the first node of each body that overturns, `none` where there is none."""
        first = np.full(self.line.max(initial=-1) + 1, none)
        np.minimum.at(first, self.line[self.overturned], self.place[self.overturned])
        return first


def refined(nodes: N, solved: Callable[[Index, Index], N], halved: Callable[[N], Bools]) -> N:
    """The nodes with those between them, until no interval is to be halved.

    Parameters
    ----------
    nodes : Nodes
        To begin with.
    solved : callable
        Nodes from lines and places.
    halved : callable
        Whether each interval between consecutive nodes is, bool array (nodes - 1,).
    """
    while (first := np.flatnonzero(halved(nodes))).size:
        nodes = nodes.joined(solved(nodes.line[first], (nodes.place[first] + nodes.place[first + 1]) // 2))
    return nodes


def beside(values: Array) -> Array:
    """The largest of each value and the two beside it; arrays (values,)."""
    return np.asarray(np.maximum(values, np.maximum(np.append(0.0, values)[:-1], np.append(values, 0.0)[1:])))


def checked_resolution(resolution: Scalar) -> float:
    """The resolution of `lowest_overturning` [-].

    Raises
    ------
    InvalidArgumentError
        If it is not in `RESOLUTIONS`.
    """
    return number("resolution", resolution, *RESOLUTIONS)


def lowest_overturning(
    solve: SolveLines,
    start: Array,
    highest: Array | float,
    limit: Array | float = math.inf,
    *,
    resolution: float = RESOLUTION,
    stop: StopFlag | None = None,
) -> Array:
    """Lowest strength at which each body overturns, of those tried; nan where none up to the highest was found.

    Strengths are tried from the weakest on, `resolution` apart. Where the peak rotation, or its variation from one
    strength to the next, comes near to overturning, and just below the first strength that overturns, intervals are
    halved to 1/64 of it at the narrowest. The change of outcome below the first that overturns is bisected.

    Parameters
    ----------
    solve : SolveLines
        The solver.
    start : float array (bodies,)
        Strength up to which a body does not move, or the lowest of interest, > 0.
    highest : float array (bodies,)
        Highest strength. What is found up to it does not depend on it.
    limit : float array (bodies,)
        Strength beyond which there is no response.
    resolution : float
        Largest relative distance of two strengths [-].
    stop : StopFlag, optional
        Cancels the work.

    Returns
    -------
    float array (bodies,)
        A strength that overturns the body; one lower by 1e-6, or the weakest, does not or is the start.
    """
    start, highest, limit = np.broadcast_arrays(start, highest, limit)
    found = np.full(start.shape, math.nan)

    def fill(part: slice, _flag: NDArray[np.uint8]) -> None:
        first = part.start

        def own(line: Index, strength: Array) -> tuple[Array, Bools]:
            return solve(line + first, strength, None if parts == 1 else 1)

        found[part] = _lowest(own, start[part], np.minimum(highest[part], limit[part]), limit[part], resolution)

    size = max(FEWEST, math.ceil(start.size / (SHARES * AVAILABLE_CORES)))
    parts = math.ceil(start.size / size)
    fill_chunks(fill, start.size, size, AVAILABLE_CORES, stop)
    return np.where(found > highest, math.nan, found)


def _lowest(
    solve: Callable[[Index, Array], tuple[Array, Bools]], start: Array, highest: Array, limit: Array, resolution: float
) -> Array:
    unit = math.log1p(resolution) / PARTS

    def strength(line: Index, place: Index) -> Array:
        return np.asarray(np.minimum(start[line] * np.exp(unit * place), limit[line]))

    def solved(line: Index, place: Index) -> Nodes:
        peak, overturned = solve(line, strength(line, place))
        return Nodes(line, place, np.where(overturned, BALANCED, np.minimum(peak, BALANCED)), overturned)

    with np.errstate(divide="ignore"):
        end, last = (np.log(each / start) / unit for each in (highest, limit))
    last = np.ceil(np.minimum(last, end + WINDOW * PARTS)).astype(np.intp)  # place of the limit, where it is near
    bracket = np.full((start.size, 2), -1)  # places of the first that overturns and of the one before
    none = np.empty(0, dtype=np.intp)
    kept, lines = solved(none, none), np.flatnonzero(highest >= start)
    first = 0
    while lines.size:
        line, place = np.broadcast_arrays(lines[:, None], first + PARTS * np.arange(WINDOW))
        inside = place < last[line] + PARTS
        nodes = refined(kept.joined(solved(line[inside], np.minimum(place, last[line])[inside])), solved, _halved)
        above = np.flatnonzero(nodes.overturned)
        before = np.where(above > 0, nodes.line[above - 1] == nodes.line[above], False)
        bracket[nodes.line[above], 0] = nodes.place[above]
        bracket[nodes.line[above], 1] = np.where(before, nodes.place[above - 1], nodes.place[above])
        first += WINDOW * PARTS
        solved_to = first - PARTS
        lines = lines[(bracket[lines, 0] < 0) & (solved_to < end[lines]) & (solved_to < last[lines])]
        left = np.zeros(start.size, dtype=np.bool_)
        left[lines] = True
        kept = nodes.take(left[nodes.line] & (nodes.place >= solved_to - PARTS))
    found = np.full(start.size, math.nan)
    known = np.flatnonzero(bracket[:, 0] >= 0)
    high, low = (strength(known, bracket[known, k]) for k in (0, 1))
    while (wide := np.flatnonzero(high / low - 1.0 > RELATIVE_ERROR)).size:
        middle = np.sqrt(low[wide] * high[wide])
        _, overturned = solve(known[wide], middle)
        low[wide], high[wide] = np.where(overturned, low[wide], middle), np.where(overturned, middle, high[wide])
    found[known] = high
    return found


def _halved(nodes: Nodes) -> Bools:
    """Whether each interval between two nodes is halved."""
    same = np.diff(nodes.line) == 0
    gap = np.where(same, np.diff(nodes.place), 0)
    below, above = nodes.peak[:-1], nodes.peak[1:]
    largest = np.where(same, np.maximum(below, above), 0.0)
    first = nodes.first_overturned(np.iinfo(np.intp).max)[nodes.line[1:]]
    close = (first - nodes.place[1:] < PARTS) & (gap > PARTS // CLOSE_PARTS)
    apart = _from_chord(nodes, same)
    bound = largest + SLOPE * np.abs(above - below) + REACH * np.maximum(apart[:-1], apart[1:])
    around = beside(largest)
    return np.asarray((gap > 1) & (around > QUIET) & ((gap > PARTS // 2) | close | (bound >= BALANCED)))


def _from_chord(nodes: Nodes, same: Bools) -> Array:
    """Distance of the peak at each node from the straight line between those beside it; 0 at the ends of a line."""
    place, peak = nodes.place, nodes.peak
    found = np.zeros(peak.size)
    inner = np.flatnonzero(same[1:] & same[:-1]) + 1
    share = (place[inner] - place[inner - 1]) / (place[inner + 1] - place[inner - 1])
    found[inner] = np.abs(peak[inner] - (1.0 - share) * peak[inner - 1] - share * peak[inner + 1])
    return found


def scanned(lowest: float, highest: float) -> Array:
    """Values from the lowest on at the ratio `SCAN_RATIO`; only the last one depends on the highest."""
    count = max(math.ceil(math.log(highest / lowest) / math.log(SCAN_RATIO)), 0)
    return np.minimum(lowest * SCAN_RATIO ** np.arange(count + 1.0), highest)


def outcome_changes(
    solve: SolveLines,
    lowest: float,
    highest: float,
    limit: float = math.inf,
    *,
    resolution: float = RESOLUTION,
    stop: StopFlag | None = None,
) -> tuple[Array, Bools]:
    """Every change of outcome of one body, bisected, and whether it overturns above; arrays (changes,).

    The first is that of `lowest_overturning`; above it the values of `scanned` are tried.
    """
    first = lowest_overturning(solve, np.array([lowest]), highest, limit, resolution=resolution, stop=stop)
    if np.isnan(first[0]):
        return np.empty(0), np.empty(0, dtype=np.bool_)

    def overturns(values: Array) -> Bools:
        return solve(np.zeros(values.size, dtype=np.intp), values, None)[1]

    values = scanned(float(first[0]), highest)
    overturned = np.append(True, overturns(values[1:]))
    edges = np.flatnonzero(overturned[1:] != overturned[:-1])
    found = [
        _bisected(overturns, float(values[k]), float(values[k + 1]), bool(overturned[k + 1])) for k in edges.tolist()
    ]
    return np.append(first, found), np.append(True, overturned[edges + 1])


def _bisected(solve: Callable[[Array], Bools], low: float, high: float, above: bool) -> float:
    """The end of the interval of a change that overturns, once the interval is narrow; `above` is the upper end."""
    while high / low - 1.0 > RELATIVE_ERROR:
        edges: Array = np.geomspace(low, high, _PARTS + 2).astype(np.float64)
        changed = solve(edges[1:-1]) == above
        first = int(changed.argmax()) if changed.any() else _PARTS
        low, high = float(edges[first]), float(edges[first + 1])
    return high if above else low
