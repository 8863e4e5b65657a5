"""Points where the outcome changes, found with the solver itself: on one line of the control space, or on many.

A point is 1/a, log omega and the restitution.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from rocking._numba.cancellation import StopFlag
from rocking._numba.compilation import contiguous_array
from rocking.excitation.pulses import AbstractPulse
from rocking.model.checks import check_alpha
from rocking.model.outcome_code import SURVIVES, impacts_of_code, outcome_codes
from rocking.model.outcome_margin import outcome_margin
from rocking.model.parameters import FREQUENCY_RATIO
from rocking.solver.peak_response import solve_cells
from rocking.solver.state import FULL_PRECISION

RESOLUTION = 1e-12
"""Width of the final bracket, in 1/a and in log omega; the curves are good to it."""

ROUNDS = 32
"""Times that brackets on a line are refined: each may uncover a further outcome between the two at its ends."""

MANY_IMPACTS = 12
"""Overturning after more impacts than this, or after impacts that accumulate to rest, is one region [-]."""

MOST_IMPACTS = 32
"""Overturning after more impacts than this is not told apart even on one line [-]."""

UNCOUNTED = -1
"""Region code of overturning whose impacts are not counted, and the `impacts` of its curves."""

Floats = NDArray[np.float64]
Codes = NDArray[np.int64]
Index = NDArray[np.intp]
Classify = Callable[[Floats, Floats, Floats], tuple[Codes, Floats]]
"""From 1/a, log omega and eta, which broadcast, to the code of the outcome and its margin to another."""


class Outcomes(Protocol):
    """What the codes are made from: a `Response`, or records of the solver; arrays of one shape."""

    @property
    def outcome(self) -> NDArray[np.int8]:
        """Code of `Outcome`."""

    @property
    def impacts(self) -> NDArray[np.int32]:
        """Number of impacts."""

    @property
    def chatter(self) -> NDArray[np.bool_]:
        """Whether impacts were replaced by their sum."""


def outcome_code(found: Outcomes) -> Codes:
    """One integer for the outcome, see `rocking.model.outcome_code`."""
    return outcome_codes(found.outcome, found.impacts)


def layer_code(found: Outcomes) -> Codes:
    """The code of the outcome, but `UNCOUNTED` for overturning after chatter or more than `MOST_IMPACTS` impacts.

    After chatter the count says when the solver replaced the remaining impacts by their sum, not what the block did.
    """
    codes = outcome_code(found)
    many = found.chatter | (found.impacts > MOST_IMPACTS)
    return np.where((codes != SURVIVES) & many, UNCOUNTED, codes)


def region_code(found: Outcomes) -> Codes:
    """`layer_code`, with the code `UNCOUNTED` for overturning after more than `MANY_IMPACTS` impacts too.

    After many impacts the regions of one count are layers thinner than any figure shows.
    """
    return without_layers(layer_code(found))


def without_layers(codes: Codes) -> Codes:
    """Region codes from layer codes."""
    return np.where(impacts_of_code(codes) > MANY_IMPACTS, UNCOUNTED, codes)


class Work:
    """Impacts that the solver has followed, and blocks, at each restitution: what the search for curves has cost."""

    def __init__(self) -> None:
        self._done: Counter[float] = Counter()

    def add(self, eta: Floats, impacts: NDArray[np.int32]) -> None:
        """Count blocks and their impacts, arrays of one shape."""
        values, which = np.unique(eta, return_inverse=True)
        done = np.bincount(which.ravel(), 1.0 + impacts.ravel())
        self._done.update({float(value): int(amount) for value, amount in zip(values, done, strict=True)})

    def at(self, eta: float) -> int:
        """Impacts and blocks at one restitution so far."""
        return self._done[eta]


def classifier(
    pulse: AbstractPulse,
    alpha: float | None,
    stop: StopFlag | None = None,
    code_of: Callable[[Outcomes], Codes] = outcome_code,
    work: Work | None = None,
) -> Classify:
    """The solver as a `Classify`, which raises `StoppedError` once `stop` is set, and notes its work in `work`.

    It calls the solver below `peak_response`: the points of a search are in range, and most calls have a few of them.

    Raises
    ------
    InvalidArgumentError
        For an angle out of range.
    """
    angle = float(check_alpha(alpha))

    def classify(slenderness: Floats, log_omega: Floats, eta: Floats) -> tuple[Codes, Floats]:
        omega = np.clip(
            np.exp(log_omega), FREQUENCY_RATIO.lower, FREQUENCY_RATIO.upper
        )  # rounding must not lead out of the range
        groups = np.broadcast_arrays(slenderness, omega, eta, angle)
        cells = [contiguous_array(group).ravel() for group in groups]
        records = solve_cells(pulse, cells, FULL_PRECISION, None, stop)
        found: Any = records.view(np.recarray).reshape(groups[0].shape)
        if work is not None:
            work.add(groups[2], found.impacts)
        return code_of(found), outcome_margin(found.end_rotation, found.end_velocity, groups[2], groups[3])

    return classify


def refine_brackets(
    axis: int,
    points: Floats,
    ends: Floats,
    code: Codes,
    classify: Classify,
    resolution: Floats | float = RESOLUTION,
) -> tuple[Floats, Floats]:
    """Shrink brackets along one axis of the control space.

    Parameters
    ----------
    axis : int
        0 for brackets in 1/a, 1 for brackets in log omega.
    points : float array (points, 3)
        1/a, log omega and eta of each bracket; the coordinate along the axis does not count.
    ends : float array (points, 2)
        Coordinates of the two ends; the outcome `code` holds at the first one only.
    code : int array (points,)
    classify : Classify
        The solver.
    resolution : float or float array (points,)
        Width of the final brackets [-].

    Returns
    -------
    inside, outside : float arrays (points,)
        Coordinates at most `resolution` apart: the outcome is `code` at `inside` only.

    Notes
    -----
    Chandrupatla's method: the outcome alone decides on which side a point lies; the margin in energy, which is
    continuous through the change of outcome as a rule, makes it a third of the work of bisection.
    """

    def side(x: Floats, which: Index) -> Floats:
        """Positive where the outcome is `code`."""
        place = points[which]
        place[:, axis] = x
        met, margin = classify(*place.T)
        distance = 1.0 - 1.0 / (1.0 + np.abs(margin)) + 1e-300
        return np.where(met == code[which], distance, -distance)

    # b is the newest end of the bracket, a the other one, c the point before them
    active = np.arange(len(code))
    b, a = ends.T.copy()
    both = side(np.concatenate([b, a]), np.concatenate([active, active])) if len(code) else np.empty(0)
    fb, fa = np.split(both, 2)
    c, fc = a.copy(), fa.copy()
    share = np.full(len(code), 0.5)
    least_width = np.broadcast_to(resolution, len(code))
    found = ends.copy()
    while active.size:
        x = a + share * (b - a)
        fx = side(x, active)
        same = np.sign(fx) == np.sign(fa)
        c, fc = np.where(same, a, b), np.where(same, fa, fb)
        b, fb = np.where(same, b, a), np.where(same, fb, fa)
        a, fa = x, fx
        found[active] = np.where((fa > 0.0)[:, None], np.stack([a, b], axis=1), np.stack([b, a], axis=1))
        width = np.abs(b - a)
        left = width > least_width[active]
        active, a, b, c, fa, fb, fc, width = (each[left] for each in (active, a, b, c, fa, fb, fc, width))
        share = _next_share(a, b, c, fa, fb, fc)
        least = 0.5 * least_width[active] / width
        share = np.clip(share, least, 1.0 - least)
    return found[:, 0], found[:, 1]


def _next_share(a: Floats, b: Floats, c: Floats, fa: Floats, fb: Floats, fc: Floats) -> Floats:
    """Where the next point lies between a and b: by inverse quadratic interpolation if it is safe, else halfway."""
    with np.errstate(divide="ignore", invalid="ignore"):
        xi, phi = (a - b) / (c - b), (fa - fb) / (fc - fb)
        safe = (phi * phi < xi) & ((1.0 - phi) ** 2 < 1.0 - xi)
        share = fa / (fb - fa) * fc / (fb - fc) + (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb)
    return np.where(safe & np.isfinite(share), share, 0.5)


def refine_lines(
    axis: int,
    points: Floats,
    line: Index,
    x: Floats,
    codes: Codes,
    classify: Classify,
    thinnest: float = RESOLUTION,
    layers: Floats | float = RESOLUTION,
) -> tuple[Index, Floats, Codes]:
    """Every change of outcome between nodes on lines along one axis, as two nodes at most `RESOLUTION` apart.

    Parameters
    ----------
    axis : int
        0 for lines along 1/a, 1 for lines along log omega.
    points : float array (lines, 3)
        1/a, log omega and eta of each line; the coordinate along the axis does not count.
    line, x, codes : arrays (nodes,)
        Line, coordinate and outcome of each node, in ascending order of line, then coordinate.
    classify : Classify
        The solver.
    thinnest : float
        Width below which a region between two others need not be found [-].
    layers : float or float array (lines,)
        Distance of the two nodes where two layers of one region meet, see `region_code` [-].

    Returns
    -------
    line, x, codes : arrays (nodes,)
        The nodes and both ends of every bracket in which the outcome changes, in the same order.
    """
    layers = np.broadcast_to(layers, len(points))
    for _ in range(ROUNDS):
        change = (np.diff(codes) != 0) & (np.diff(line) == 0)
        width = np.diff(x)
        resolution = _resolution(codes[:-1], codes[1:], layers[line[:-1]])
        exact = np.concatenate([[False], change & (width <= 2 * resolution), [False]])  # where a region is known to end
        narrow = width <= thinnest
        edge = change & (width > 2 * resolution) & ~(narrow & exact[:-2] & exact[2:])
        if not edge.any():
            break
        added = [(line, x, codes)]

        # where the region at the lower end stops ...
        first = np.flatnonzero(edge & ~(narrow & exact[:-2]))
        own, on = codes[first], line[first]
        ends = np.stack([x[first], x[first + 1]], 1)
        inside, outside = refine_brackets(axis, points[on], ends, own, classify, resolution[first])
        added.append((on, inside, own))
        met = _codes_at(axis, points[on], outside, classify)
        added.append((on, outside, met))
        other = met != codes[first + 1]
        # ... and, where another one than that at the upper end begins there, where that at the upper end begins
        after = np.flatnonzero(edge & narrow & exact[:-2])
        last = np.append(first[other], after) + 1
        low, below = np.append(outside[other], x[after]), np.append(met[other], codes[after])
        own, on = codes[last], line[last]
        ends = np.stack([x[last], low], 1)
        inside, outside = refine_brackets(axis, points[on], ends, own, classify, _resolution(below, own, layers[on]))
        added.append((on, inside, own))
        added.append((on, outside, _codes_at(axis, points[on], outside, classify)))
        wide = outside - low > 2 * thinnest
        on, low, outside = on[wide], low[wide], outside[wide]
        between = (low + thinnest, 0.5 * (low + outside), outside - thinnest)
        added += [(on, at, _codes_at(axis, points[on], at, classify)) for at in between]
        line, x, codes = merge_nodes(*(np.concatenate(each) for each in zip(*added, strict=True)))
    return line, x, codes


def _resolution(below: Codes, above: Codes, layers: Floats) -> Floats:
    """How near to each other the two nodes beside a change of outcome shall lie."""
    return np.where(without_layers(below) == without_layers(above), layers, RESOLUTION)


def _codes_at(axis: int, points: Floats, x: Floats, classify: Classify) -> Codes:
    """Codes at points whose coordinate along the axis is replaced."""
    place = points.copy()
    place[:, axis] = x
    return classify(*place.T)[0]


def merge_nodes(line: Index, x: Floats, codes: Codes) -> tuple[Index, Floats, Codes]:
    """Nodes in ascending order of line, then coordinate, each once."""
    order = np.lexsort((x, line))
    line, x, codes = line[order], x[order], codes[order]
    first = np.ones(x.size, dtype=bool)
    first[1:] = (np.diff(line) != 0) | (np.diff(x) != 0.0)
    return line[first], x[first], codes[first]


def outcomes_along(
    axis: int, point: tuple[float, float, float], nodes: Floats, classify: Classify
) -> tuple[Floats, Codes]:
    """Outcomes along one line of the control space, and where they change.

    Parameters
    ----------
    axis : int
        0 for a line of 1/a, 1 for one of log omega.
    point : (float, float, float)
        Of the line; its coordinate along the axis does not count.
    nodes : float array
        Ascending; where outcomes are looked for first.
    classify : Classify
        The solver.

    Returns
    -------
    grid, codes : arrays (points,)
        The nodes and both ends of every bracket in which the outcome changes, ascending, with the outcome at each.
    """
    places = np.tile(point, (nodes.size, 1))
    places[:, axis] = nodes
    codes, _ = classify(*places.T)
    points = np.array([point])
    line = np.zeros(nodes.size, dtype=np.intp)
    _, grid, codes = refine_lines(axis, points, line, nodes, codes, classify)
    return grid, codes
