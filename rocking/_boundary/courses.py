"""Courses of regions: where those of one column lie on another line omega = const, by their slopes and neighbours."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from rocking._boundary.columns import THINNEST, Column, Index
from rocking._boundary.matching import Pairs
from rocking._boundary.search import Codes, Floats
from rocking._boundary.trends import follow_trends

PROBES = 81
"""Most points by which a region is looked for in one column [-]."""


@dataclass(frozen=True, eq=False)
class Courses:
    """Where regions of a column lie on another line: one of each array's entries for each region.

    Attributes
    ----------
    codes : int array
        Region codes.
    middle, narrow, reach : float arrays
        1/a halfway through the region, its least width, and how far from there it may lie [-].
    """

    codes: Codes
    middle: Floats
    narrow: Floats
    reach: Floats

    def points(self) -> list[Floats]:
        """Points by which each region is looked for."""
        distance = 0.3 * np.maximum(self.narrow, 0.3 * THINNEST)
        count = np.clip(2 * np.ceil(self.reach / distance) + 1, 9, PROBES)
        return [
            middle + np.linspace(-reach, reach, int(n))
            for middle, reach, n in zip(self.middle, self.reach, count, strict=True)
        ]

    def missed(self, x: Floats, codes: Codes) -> Floats:
        """Points by which the regions are looked for that nodes with these codes do not show."""
        met = (codes == self.codes[:, None]) & (np.abs(x - self.middle[:, None]) <= self.reach[:, None])
        lost = np.flatnonzero(~met.any(axis=1))
        chosen = Courses(*(getattr(self, each.name)[lost] for each in fields(self)))
        return np.concatenate([np.empty(0), *chosen.points()])

    @classmethod
    def joined(cls, *parts: Courses) -> Courses:
        """Those of several columns."""
        return cls(*(np.concatenate([getattr(part, each.name) for part in parts]) for each in fields(cls)))


def courses_of(column: Column, inner: Index, side: int, step: float, at: Floats, shift: Floats) -> Courses:
    """Where the regions above some thresholds lie one step further.

    Parameters
    ----------
    column : Column
    inner : int array
        The thresholds.
    side : int
        Side from which the slopes are known: 0 for a step to the right.
    step : float
        In log omega [-].
    at, shift : float arrays
        Ascending 1/a, and by how much curves there move: it counts where slopes are not known [-].
    """
    found = follow_trends(column.below, column.above, inner, column.trends[side], side, step, at, shift)
    return Courses(column.regions[inner + 1], *found)


def probes_for_lost_regions(
    left: Column, right: Column, pairs: Pairs
) -> list[tuple[Column, Floats, tuple[float, int]]]:
    """Points at which regions that one of two columns lacks are looked for in it, and a key of the region."""
    found: list[tuple[Column, Floats, tuple[float, int]]] = []
    for side, column, other in ((0, left, right), (1, right, left)):
        lost = np.ones(column.below.size, dtype=bool)
        lost[pairs[:, side]] = False
        inner = np.flatnonzero(lost[:-1] & lost[1:])
        if not inner.size:
            continue
        step = other.log_omega - column.log_omega
        at = column.middle[pairs[:, side]]
        shift = other.middle[pairs[:, 1 - side]] - at
        for points in courses_of(column, inner, side, step, at, shift).points():
            x = points[(points > other.bottom) & (points < other.top)]
            if x.size:
                found.append((other, x, (round(float(x[x.size // 2]), 8), x.size)))
    return found
