"""Cells near the points where the response changes its kind, found in multi-precision arithmetic.

The response is computed at points along a line of slendernesses; where its kind differs between two of them, the
change is bisected to 2^-70, far below the last bit of a double. The cells lie at given distances on both sides.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import islice, pairwise
from typing import NamedTuple

import numpy as np
from flint import arb

from reference.conditioning import MAX_IMPACTS
from reference.exact_pulses import PULSES
from reference.exact_response import CAPPED, ExactResponse, working_precision
from stress.cells import BITS, REQUIREMENTS, Cell, Draw, any_angle, draw_cells, reference_response

WIDTH = 2.0**-70
"""Relative width at which the bisection ends."""

MAX_LINES = 4000
"""Maximum number of lines searched for one family."""


class Kind(NamedTuple):
    """Kind of an edge: the `key` of the response that changes, and a check that the change is the intended one."""

    key: Callable[[ExactResponse], object]
    confirm: Callable[[ExactResponse, ExactResponse], bool]


def _same_outcome_other_count(one: ExactResponse, other: ExactResponse) -> bool:
    return one.overturned == other.overturned and not one.chatter and not other.chatter and one.impacts != other.impacts


def _with_more_impacts(one: ExactResponse, other: ExactResponse) -> ExactResponse:
    return max(one, other, key=lambda response: response.impacts)


def _is_tiny(value: arb | None) -> bool:
    return value is not None and float(value) < 1e-8


OUTCOME = Kind(lambda r: r.overturned, lambda one, other: one.overturned != other.overturned)
"""The block overturns on one side only: the separatrix."""

ISLAND = Kind(
    lambda r: r.overturned,
    lambda one, other: one.overturned != other.overturned and max(one.impacts, other.impacts) >= 3,
)
"""The same after three impacts or more."""

ALPHA = Kind(lambda r: r.exceeded_alpha, lambda one, other: not (one.overturned or other.overturned))
"""The peak is close to alpha and the block survives."""

GRAZING = Kind(
    lambda r: r.impacts,
    lambda one, other: (
        _same_outcome_other_count(one, other) and _is_tiny(_with_more_impacts(one, other).slowest_impact)
    ),
)
"""The block touches the ground at a very small velocity, or just misses it."""

PULSE_END = Kind(
    lambda r: r.impacts,
    lambda one, other: (
        _same_outcome_other_count(one, other)
        and not _is_tiny(_with_more_impacts(one, other).slowest_impact)
        and abs(one.impacts - other.impacts) == 1
    ),
)
"""The last impact coincides with the end of the pulse."""


@dataclass(frozen=True)
class EdgeFamily:
    """Cells on both sides of edges; see `cells.Family` for the common parameters.

    Parameters
    ----------
    kind : Kind
        What changes there.
    line : tuple
        First and last slenderness of the search along a line, and its number of points.
    nearest, farthest : float
        Relative distances of the cells from the edge, uniform in the logarithm.
    edges : int
        Number of edges, with two cells on each side.
    max_impacts : int
        Maximum number of impacts in the search.
    """

    name: str
    reason: str
    groups: Callable[[Draw], tuple[float, float, float]]
    kind: Kind
    line: tuple[float, float, int] = (0.02, 0.99, 16)
    pulses: tuple[str, ...] = PULSES
    angle: Callable[[Draw], float] = any_angle
    rigid: tuple[bool, ...] = (False, True)
    nearest: float = 1e-12
    farthest: float = 1e-3
    edges: int = 72
    max_impacts: int = MAX_IMPACTS
    requirements: tuple[str, ...] = REQUIREMENTS

    def cells(self) -> Iterator[Cell]:
        """Yield all cells in order; the slenderness drawn by `groups` is not used."""
        distance = Draw(f"{self.name} distances")
        for cell, edge in islice(self._edges(), self.edges):
            for side in (-1, 1, -1, 1):
                away = side * distance.log(self.nearest, self.farthest)
                with working_precision(BITS):
                    yield cell | {"slenderness": float(edge * (1 + arb(away)))}

    def _edges(self) -> Iterator[tuple[Cell, arb]]:
        """Yield cells that define a line, with the slenderness of an edge on it."""
        for cell in islice(draw_cells(self), MAX_LINES):
            edge = self._first_edge(cell)
            if edge is not None:
                yield cell, edge

    def _first_edge(self, cell: Cell) -> arb | None:
        """Return the first edge of the intended kind on a line; one edge per line keeps the family diverse."""
        points = [float(s) for s in np.geomspace(*self.line)]
        responses = [self._at(cell, s) for s in points]
        for (left, one), (right, other) in pairwise(zip(points, responses, strict=True)):
            if self.kind.key(one) != self.kind.key(other):
                edge, *sides = self._bisect(cell, left, right)
                if CAPPED not in {response.outcome for response in sides} and self.kind.confirm(*sides):
                    return edge
        return None

    def _at(self, cell: Cell, slenderness: arb | float) -> ExactResponse:
        return reference_response(cell, self.max_impacts, slenderness=slenderness)

    def _bisect(self, cell: Cell, first: float, second: float) -> tuple[arb, ExactResponse, ExactResponse]:
        """Return an edge between two slendernesses, and the responses on its sides."""
        with working_precision(BITS):
            left, right = arb(first), arb(second)
            one, other = self._at(cell, left), self._at(cell, right)
            left_key = self.kind.key(one)
            while right - left > WIDTH * right:
                middle = ((left + right) / 2).mid()
                response = self._at(cell, middle)
                if self.kind.key(response) == left_key:
                    left, one = middle, response
                else:
                    right, other = middle, response
            return left, one, other
