"""Search with the solver for points where the outcome changes, on one line of the control space or on many.

A point is 1/a, log omega, the restitution and the slenderness angle, 0 for the slender limit.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from rocking._base.quantities import FREQUENCY_RATIO
from rocking._excitation.pulses import AbstractPulse
from rocking._model.energy import outcome_margin
from rocking._model.outcome import SURVIVES, impacts_of_code, outcome_codes
from rocking._numba.cancellation import StopFlag
from rocking._solver.peak_response import solve_blocks, solve_cells
from rocking._solver.records.record_response import NO_RESTRAINT
from rocking._solver.restrained import restrain, restrained_margin
from rocking._solver.state import FULL_PRECISION, block_cells

RESOLUTION = 1e-12  # width of the final bracket, in 1/a and in log omega; the curves are good to it

ELASTIC_RESOLUTION = 1e-6
"""In place of `RESOLUTION` for elastic blocks, where one of the two regions has uncounted impacts [-].

Where a wavelet has just uplifted an elastic block, it strikes 200,000 times before the main part of the pulse.
"""

ROUNDS = 32  # times that brackets on a line are refined: each may uncover a further outcome between the two at its ends

MANY_IMPACTS = 12
"""Overturning after more impacts than this, or after impacts that accumulate to rest, is one region [-]."""

MOST_IMPACTS = 32  # overturning after more impacts than this is not told apart even on one line [-]

MOST_COUNTED = 200
"""Overturning after more impacts than this is not told apart where the outcomes of one block are listed [-].

Of 495 lines of all pulses, 5 lose thresholds against an unlimited count, 22 with 64; without a limit 12 lines at
restitutions of 0.99 and more take over 5 s, since each of thousands of counts is a region of its own.
"""

UNCOUNTED = -1  # region code of overturning whose impacts are not counted, and the `impacts` of its curves

LARGE_MARGIN = 10.0
"""A larger margin counts by its logarithm where points are interpolated [-].

On the brackets of the cosine at 0 and 20 degrees the mean number of points differs by less than 5 % from 3 to 30, and
and from the mean without the logarithm; with it 8 % of the brackets take more than 25 points, without it 10 %.
"""

Floats = NDArray[np.float64]
Codes = NDArray[np.int64]
Index = NDArray[np.intp]
Classify = Callable[[Floats, Floats, Floats, Floats], tuple[Codes, Floats]]
"""From 1/a, log omega, eta and alpha, which broadcast, to the code of the outcome and its margin to another."""
Solve = Callable[[Floats, Floats, Floats, Floats], tuple[NDArray[np.void], Floats]]
"""From arrays (size,) of 1/a, omega, eta and alpha to response records and the margin of the outcome to another."""


class Outcomes(Protocol):
    """Outcomes of blocks: a `Response`, or records of the solver; arrays of one shape."""

    @property
    def outcome(self) -> NDArray[np.int8]:
        """Code of `Outcome`."""

    @property
    def impacts(self) -> NDArray[np.int32]:
        """Number of impacts."""

    @property
    def chatter(self) -> NDArray[np.bool_]:
        """True where impacts were replaced by their sum."""


def layer_code(outcomes: Outcomes) -> Codes:
    """Return the code of the outcome, `UNCOUNTED` for overturning after chatter or more than `MOST_IMPACTS` impacts.

    After chatter the count says when the solver replaced the remaining impacts by their sum, not what the block did.
    """
    codes = outcome_codes(outcomes.outcome, outcomes.impacts)
    many = outcomes.chatter | (outcomes.impacts > MOST_IMPACTS)
    return np.where((codes != SURVIVES) & many, UNCOUNTED, codes)


def region_code(outcomes: Outcomes) -> Codes:
    """Return `layer_code`, with the code `UNCOUNTED` for overturning after more than `MANY_IMPACTS` impacts too.

    After many impacts the regions of one count are layers thinner than any figure shows.
    """
    return without_layers(layer_code(outcomes))


def without_layers(codes: Codes) -> Codes:
    """Return region codes from layer codes."""
    return np.where(impacts_of_code(codes) > MANY_IMPACTS, UNCOUNTED, codes)


def counted_code(outcomes: Outcomes) -> Codes:
    """Return the code of the outcome, but `UNCOUNTED` for overturning after more than `MOST_COUNTED` impacts."""
    codes = outcome_codes(outcomes.outcome, outcomes.impacts)
    return np.where((codes != SURVIVES) & (outcomes.impacts > MOST_COUNTED), UNCOUNTED, codes)


class Work:
    """Cost of the search for curves so far: impacts that the solver has followed, and blocks, for each angle."""

    def __init__(self, alphas: Sequence[float]) -> None:
        self.alphas = np.unique(alphas)
        self.done = np.zeros(self.alphas.size)

    def angle(self, alpha: Floats) -> Index:
        """Return the numbers of some of the angles."""
        return np.searchsorted(self.alphas, alpha)

    def add(self, impacts: NDArray[np.int32], alpha: Floats) -> None:
        """Count blocks, and their impacts."""
        self.done += np.bincount(self.angle(alpha), 1.0 + impacts, self.done.size)


@dataclass(frozen=True, eq=False)
class Found:
    """Results of the solver for some blocks, see `Outcomes`; arrays of one shape."""

    outcome: NDArray[np.int8]
    impacts: NDArray[np.int32]
    chatter: NDArray[np.bool_]


def block_solver(
    pulse: AbstractPulse,
    threads: int | None = None,
    stop: StopFlag | None = None,
    restraint: Mapping[str, Floats] = NO_RESTRAINT,
) -> Solve:
    """Return the solver for blocks as a `Solve`, which raises `StoppedError` once `stop` is set.

    `restraint`: of `rocking._model.checks.check_restraint`; the slenderness is then over that of uplift, 1 + sigma.

    It calls the solver below `peak_response`: the points of a search are in range, and most calls have a few of them.
    """

    def solve(*cells: Floats) -> tuple[NDArray[np.void], Floats]:
        records = solve_cells(pulse, [*cells], FULL_PRECISION, threads, stop)
        return records, outcome_margin(records["end_rotation"], records["end_velocity"], *cells[2:])

    def solve_restrained(
        slenderness: Floats, omega: Floats, eta: Floats, alpha: Floats
    ) -> tuple[NDArray[np.void], Floats]:
        cells = block_cells(omega, slenderness / level, eta, alpha)
        restrain(cells, restraint)
        records = solve_blocks(pulse, cells, threads, stop)
        return records, restrained_margin(records, cells)

    level = 1.0 + restraint.get("prestress", 0.0)
    return solve_restrained if restraint else solve


def classifier(solve: Solve, code_of: Callable[[Outcomes], Codes] | None = None, work: Work | None = None) -> Classify:
    """Return a solver as a `Classify`, which notes its work in `work`; `code_of` tells more outcomes apart."""

    def classify(slenderness: Floats, log_omega: Floats, eta: Floats, alpha: Floats) -> tuple[Codes, Floats]:
        # rounding must not lead out of the range
        omega = np.clip(np.exp(log_omega), FREQUENCY_RATIO.lower, FREQUENCY_RATIO.upper)
        point = np.stack(np.broadcast_arrays(slenderness, omega, eta, alpha))
        cells = point.reshape(4, -1)  # rows that are contiguous and writable
        records, margin = solve(*cells)
        if work is not None:
            work.add(records["impacts"], cells[3])
        if code_of is None:
            codes = outcome_codes(records["outcome"], records["impacts"])
        else:
            codes = code_of(Found(records["outcome"], records["impacts"], records["chatter"]))
        return codes.reshape(point.shape[1:]), margin.reshape(point.shape[1:])

    return classify


@dataclass(frozen=True, eq=False)
class Nodes:
    """Classified points on lines of the control space; arrays (nodes,)."""

    line: Index  # index of the line
    x: Floats  # coordinate on it
    codes: Codes  # outcome there
    margin: Floats  # its margin to another outcome

    def take(self, index: Index | NDArray[np.bool_] | slice) -> Nodes:
        """Return the nodes of some indices."""
        return Nodes(self.line[index], self.x[index], self.codes[index], self.margin[index])

    @classmethod
    def joined(cls, parts: Iterable[Nodes]) -> Nodes:
        """Return the nodes of one part after the other."""
        columns = [(part.line, part.x, part.codes, part.margin) for part in parts]
        return cls(*map(np.concatenate, zip(*columns, strict=True)))

    @classmethod
    def merged(cls, parts: Iterable[Nodes]) -> Nodes:
        """Return the nodes of all parts in ascending order of line, then coordinate, each once."""
        together = cls.joined(parts)
        nodes = together.take(np.lexsort((together.x, together.line)))
        first = np.ones(nodes.x.size, dtype=bool)
        first[1:] = (np.diff(nodes.line) != 0) | (np.diff(nodes.x) != 0.0)
        return nodes.take(first)


@dataclass(frozen=True, eq=False)
class Brackets:
    """Brackets of changes of outcome: the outcome of each bracket holds at the first end only."""

    # ends, margins: (points, 2) coordinates of the two ends, and the margins there
    ends: Floats
    margins: Floats
    beyond: Codes  # (points,) outcomes at the second end


def refine_brackets(
    axis: int,
    points: Floats,
    ends: Floats,
    margins: Floats,
    code: Codes,
    beyond: Codes,
    classify: Classify,
    resolution: Floats | float = RESOLUTION,
) -> Brackets:
    """Shrink brackets along one axis of the control space to a width of `resolution` [-] at most.

    `axis`: 0 for brackets in 1/a, 1 for log omega; `points` (points, 4): 1/a, log omega, eta and alpha, that along the
    axis does not count; `ends`, `margins` (points, 2): coordinates and margins of both ends; `code`, `beyond`
    (points,): outcomes there, which differ.

    The outcome at the first end is kept, so that the bracket always holds a change; the second end takes any other
    outcome. Chandrupatla's method: the
    outcome alone decides on which side a point lies. The margin in energy, as a rule continuous through the change of
    outcome, only chooses the next point, and makes it a third of the work of bisection. The first point lies halfway:
    there it shows regions between the two ends more often than near one of them.
    """
    current, ends, margins, beyond = points.copy(), ends.copy(), margins.copy(), beyond.copy()
    # a is the newest end of the bracket, b the other one, c the end that a replaced
    active = np.arange(len(code))
    b, a = ends.T.copy()
    fb, fa = _distance(margins[:, 0]), -_distance(margins[:, 1])
    c, fc = a, fa
    share = np.full(len(code), 0.5)
    least_width = np.broadcast_to(resolution, len(code))
    while active.size:
        x = a + share * (b - a)
        current[active, axis] = x
        code_here, margin = classify(*current[active].T)
        within = code_here == code[active]
        end = np.where(within, 0, 1)
        ends[active, end], margins[active, end] = x, margin
        beyond[active[~within]] = code_here[~within]
        fx = np.where(within, 1.0, -1.0) * _distance(margin)
        # the new point replaces the end on its own side
        same = within == (fa > 0.0)
        c, fc = np.where(same, a, b), np.where(same, fa, fb)
        b, fb = np.where(same, b, a), np.where(same, fb, fa)
        a, fa = x, fx
        width = np.abs(b - a)
        left = width > least_width[active]
        active, width = active[left], width[left]
        a, b, c = a[left], b[left], c[left]
        fa, fb, fc = fa[left], fb[left], fc[left]
        share = _next_share(a, b, c, fa, fb, fc)
        # half the final width from either end: a point nearer to one would hardly shrink the bracket
        least = 0.5 * least_width[active] / width
        share = np.clip(share, least, 1.0 - least)
    return Brackets(ends, margins, beyond)


def _distance(margin: Floats) -> Floats:
    """Return a positive measure of the distance from a change of outcome: the margin, or its logarithm if large."""
    distance: Floats = np.log1p(np.abs(margin) / LARGE_MARGIN) + 1e-300
    return distance


def _next_share(a: Floats, b: Floats, c: Floats, fa: Floats, fb: Floats, fc: Floats) -> Floats:
    """Choose the next point between a and b: by inverse quadratic interpolation if well inside, else halfway."""
    with np.errstate(divide="ignore", invalid="ignore"):
        xi, phi = (a - b) / (c - b), (fa - fb) / (fc - fb)
        inside = (phi * phi < xi) & ((1.0 - phi) ** 2 < 1.0 - xi)
        share = fa / (fb - fa) * fc / (fb - fc) + (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb)
    return np.where(inside & np.isfinite(share), share, 0.5)


def refine_lines(
    axis: int,
    points: Floats,
    nodes: Nodes,
    classify: Classify,
    thinnest: float = RESOLUTION,
    layers: Floats | float = RESOLUTION,
) -> Nodes:
    """Refine every change of outcome between nodes on lines along one axis to two nodes at most `RESOLUTION` apart.

    Between two nodes that differ there
    is a change for certain; a region that no node shows is found only if a point of a search meets it. Each
    point of a search is a node of the next round, so that a region that was seen once is not lost.

    Where `layers` or `ELASTIC_RESOLUTION` hold, the two nodes may lie so far apart. `axis`, `points` (lines, 4): as for
    `refine_brackets`; `nodes`: on these lines, in ascending order of line, then coordinate; `thinnest`: width below
    which a region between two others need not be found [-]; `layers` (lines,): distance of the two nodes where two
    layers of one region meet, see `region_code` [-].
    """
    layers = np.broadcast_to(layers, len(points))
    uncounted = np.where(points[:, 2] == 1.0, ELASTIC_RESOLUTION, RESOLUTION)

    def resolution_at(line: Index, below: Codes, above: Codes) -> Floats:
        many = np.where((below == UNCOUNTED) | (above == UNCOUNTED), uncounted[line], RESOLUTION)
        regions = without_layers(np.stack([below, above]))
        return np.where(regions[0] == regions[1], layers[line], many)

    def refined(inner: Nodes, outer: Nodes) -> tuple[Nodes, Nodes]:
        """Return the last nodes with the outcomes of the inner ones, and the first beyond, towards the outer ones."""
        resolution = resolution_at(inner.line, inner.codes, outer.codes)
        ends, margins = np.stack([inner.x, outer.x], axis=1), np.stack([inner.margin, outer.margin], axis=1)
        brackets = refine_brackets(
            axis, points[inner.line], ends, margins, inner.codes, outer.codes, classify, resolution
        )
        (x, x_beyond), (margin, margin_beyond) = brackets.ends.T, brackets.margins.T
        return Nodes(inner.line, x, inner.codes, margin), Nodes(inner.line, x_beyond, brackets.beyond, margin_beyond)

    for _ in range(ROUNDS):
        change = (np.diff(nodes.codes) != 0) & (np.diff(nodes.line) == 0)
        # pairs of neighbours that differ and are not refined yet, but for regions too thin to be found
        width = np.diff(nodes.x)
        resolution = resolution_at(nodes.line[:-1], nodes.codes[:-1], nodes.codes[1:])
        exact = np.concatenate([[False], change & (width <= 2 * resolution), [False]])  # where a region is known to end
        narrow = width <= thinnest
        edge = change & (width > 2 * resolution) & ~(narrow & exact[:-2] & exact[2:])
        if not edge.any():
            break

        # where the region at the lower end stops ...
        first = np.flatnonzero(edge & ~(narrow & exact[:-2]))
        upper = nodes.take(first + 1)
        inside, outside = refined(nodes.take(first), upper)
        # ... and, where another one than that at the upper end begins there, where that at the upper end begins
        differs = outside.codes != upper.codes
        after = np.flatnonzero(edge & narrow & exact[:-2])
        upper = Nodes.joined([upper.take(differs), nodes.take(after + 1)])
        lower = Nodes.joined([outside.take(differs), nodes.take(after)])
        last, before = refined(upper, lower)
        # between the two points another region lies: points near its ends and in its middle show what it holds
        wide = before.x - lower.x > 2 * thinnest
        on, low, high = before.line[wide], lower.x[wide], before.x[wide]
        probes = low + thinnest, 0.5 * (low + high), high - thinnest
        between = [Nodes(on, x, *_classify_at(axis, points[on], x, classify)) for x in probes]
        nodes = Nodes.merged([nodes, inside, outside, last, before, *between])
    return nodes


def _classify_at(axis: int, points: Floats, x: Floats, classify: Classify) -> tuple[Codes, Floats]:
    """Classify points whose coordinate along the axis is replaced."""
    moved = points.copy()
    moved[:, axis] = x
    return classify(*moved.T)


def outcomes_along(
    axis: int, point: tuple[float, float, float, float], nodes: Floats, classify: Classify
) -> tuple[Floats, Codes]:
    """Classify nodes on one line of the control space and refine all changes; return all nodes, ascending, and codes.

    `axis`: 0 for a line of 1/a, 1 for one of log omega; `point`: 1/a, log omega, eta and alpha, of which the coordinate
    along the axis does not count; `nodes`: where outcomes are looked for first, ascending.
    """
    start = np.tile(point, (nodes.size, 1))
    start[:, axis] = nodes
    classified = Nodes(np.zeros(nodes.size, dtype=np.intp), nodes, *classify(*start.T))
    refined = refine_lines(axis, np.array([point]), classified, classify)
    return refined.x, refined.codes
