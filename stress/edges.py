"""Cells beside the places where the answer changes its kind, found in multi-precision arithmetic.

Along a line of slendernesses the response is computed at some points; where a kind of response changes between two of
them the change is bisected to 2^-70, far below the last bit of a double. The cells lie at chosen distances on both
sides.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import islice, pairwise
from typing import NamedTuple

import numpy as np
from flint import arb

from reference.conditioning import MOST_IMPACTS
from reference.exact_pulses import PULSES
from reference.exact_response import CAPPED, ExactResponse, working_precision
from stress.cells import BITS, PROMISES, Cell, Draw, any_angle, drawn, look

WIDTH = 2.0**-70
"""Relative width at which a bisection ends."""

MOST_LINES = 4000
"""Lines searched at most for one family."""


class Kind(NamedTuple):
    """What changes at an edge: a `key` of the response, and whether a change of it is of the kind that is meant."""

    key: Callable[[ExactResponse], object]
    confirm: Callable[[ExactResponse, ExactResponse], bool]


def _same_fate_other_count(one: ExactResponse, other: ExactResponse) -> bool:
    return one.overturned == other.overturned and not one.chatter and not other.chatter and one.impacts != other.impacts


def _more(one: ExactResponse, other: ExactResponse) -> ExactResponse:
    return max(one, other, key=lambda response: response.impacts)


def _tiny(value: arb | None) -> bool:
    return value is not None and float(value) < 1e-8


FATE = Kind(lambda r: r.overturned, lambda one, other: one.overturned != other.overturned)
"""The block falls on one side only: the separatrix."""

ISLAND = Kind(
    lambda r: r.overturned,
    lambda one, other: one.overturned != other.overturned and max(one.impacts, other.impacts) >= 3,
)
"""The same, after three impacts or more."""

ALPHA = Kind(lambda r: r.exceeded_alpha, lambda one, other: not (one.overturned or other.overturned))
"""The peak touches alpha and comes back all the same."""

GRAZE = Kind(
    lambda r: r.impacts,
    lambda one, other: _same_fate_other_count(one, other) and _tiny(_more(one, other).slowest_impact),
)
"""The block touches the ground with next to no velocity, or just misses it."""

END = Kind(
    lambda r: r.impacts,
    lambda one, other: (
        _same_fate_other_count(one, other)
        and not _tiny(_more(one, other).slowest_impact)
        and abs(one.impacts - other.impacts) == 1
    ),
)
"""The last impact coincides with the end of the pulse."""


@dataclass(frozen=True)
class EdgeFamily:
    """Cells on both sides of edges; see `cells.Family` for what both have in common.

    Parameters
    ----------
    kind : Kind
        What changes there.
    line : tuple
        Slendernesses where the search along a line begins and ends, and the number of its points.
    nearest, farthest : float
        Relative distances of the cells from the edge, uniform in the logarithm.
    edges : int
        Number of edges, with two cells on each side.
    most_impacts : int
        Lines are not followed through more of them.
    """

    name: str
    why: str
    groups: Callable[[Draw], tuple[float, float, float]]
    kind: Kind
    line: tuple[float, float, int] = (0.02, 0.99, 16)
    pulses: tuple[str, ...] = PULSES
    angle: Callable[[Draw], float] = any_angle
    rigid: tuple[bool, ...] = (False, True)
    nearest: float = 1e-12
    farthest: float = 1e-3
    edges: int = 72
    most_impacts: int = MOST_IMPACTS
    promises: tuple[str, ...] = PROMISES

    def cells(self) -> Iterator[Cell]:
        """All of them, in order; the slenderness that `groups` draws is not used."""
        distance = Draw(f"{self.name} distances")
        for cell, edge in islice(self._edges(), self.edges):
            for side in (-1, 1, -1, 1):
                away = side * distance.log(self.nearest, self.farthest)
                with working_precision(BITS):
                    yield cell | {"slenderness": float(edge * (1 + arb(away)))}

    def _edges(self) -> Iterator[tuple[Cell, arb]]:
        """Cells that fix a line, with the slenderness of an edge on it."""
        for cell in islice(drawn(self), MOST_LINES):
            edge = self._first_on(cell)
            if edge is not None:
                yield cell, edge

    def _first_on(self, cell: Cell) -> arb | None:
        """The first edge on a line that is of the kind that is meant; no line shall fill the family."""
        points = [float(s) for s in np.geomspace(*self.line)]
        responses = [self._at(cell, s) for s in points]
        for (left, one), (right, other) in pairwise(zip(points, responses, strict=True)):
            if self.kind.key(one) != self.kind.key(other):
                edge, *beside = self._bisected(cell, left, right)
                if CAPPED not in {response.outcome for response in beside} and self.kind.confirm(*beside):
                    return edge
        return None

    def _at(self, cell: Cell, slenderness: arb | float) -> ExactResponse:
        return look(cell, self.most_impacts, slenderness=slenderness)

    def _bisected(self, cell: Cell, first: float, second: float) -> tuple[arb, ExactResponse, ExactResponse]:
        """An edge between two slendernesses, and the responses on its sides."""
        with working_precision(BITS):
            left, right = arb(first), arb(second)
            one, other = self._at(cell, left), self._at(cell, right)
            kept = self.kind.key(one)
            while right - left > WIDTH * right:
                middle = ((left + right) / 2).mid()
                response = self._at(cell, middle)
                if self.kind.key(response) == kept:
                    left, one = middle, response
                else:
                    right, other = middle, response
            return left, one, other
