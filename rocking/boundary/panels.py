"""Panels: two neighbouring columns, or parts of them, between which a region ends, divides or begins."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from rocking.boundary.columns import Column
from rocking.boundary.courses import Courses, courses_of
from rocking.boundary.matching import Pairs, Side
from rocking.boundary.search import UNCOUNTED, Floats
from rocking.model.outcome_code import SURVIVES

ACROSS = np.linspace(0.02, 0.98, 9)
"""Nodes of a column within a panel, as shares of its height [-]."""

NEARBY = np.array([-0.3, 0.0, 0.3])
"""The first nodes by which a region is looked for in it, in widths from the middle of the region [-]."""


@dataclass(frozen=True)
class Panel:
    """Two columns, or parts of them.

    Attributes
    ----------
    line : int
        Index of the line of the grid on its left.
    left, right : Column
    """

    line: int
    left: Column
    right: Column

    @property
    def step(self) -> float:
        """Its width in log omega [-]."""
        return self.right.log_omega - self.left.log_omega

    @property
    def uncounted(self) -> bool:
        """Whether all blocks that overturn in it do so after many impacts."""
        return {*self.left.codes, *self.right.codes} <= {SURVIVES, UNCOUNTED}

    @property
    def middle(self) -> float:
        """Log omega halfway between the two columns [-]."""
        return 0.5 * (self.left.log_omega + self.right.log_omega)

    def expected(self) -> Courses:
        """Where the regions of the two columns lie halfway between them."""
        ends = self._ends()
        shift = 0.5 * (ends[1] - ends[0])
        return Courses.joined(
            *(
                courses_of(
                    column, np.arange(column.below.size - 1), side, sign * 0.5 * self.step, ends[side], sign * shift
                )
                for side, column, sign in ((0, self.left, 1.0), (1, self.right, -1.0))
            )
        )

    def inner(self, x: Floats) -> Floats:
        """The points between the ends of the panel halfway between the two columns."""
        low, high = self._ends().mean(axis=0)
        within: Floats = x[(x > low) & (x < high)]
        return within

    def _ends(self) -> Floats:
        """1/a at the two ends of each column (columns, ends)."""
        return np.array([[column.bottom, column.top] for column in (self.left, self.right)])

    def nodes(self, expected: Courses) -> Floats:
        """Nodes halfway between the two columns: across the panel, and where regions are expected."""
        left, right = self.left, self.right
        ends = self._ends()
        low, high = 0.5 * (ends[0] + ends[1])
        nodes = [low + (high - low) * ACROSS, (expected.middle + expected.narrow * NEARBY[:, None]).ravel()]
        for column, end, other in ((left, *ends), (right, *ends[::-1])):
            # halfway from either end to the next threshold
            next_ones = column.middle[[0, -1]] if column.middle.size else end[::-1]
            nodes.append(0.5 * (next_ones + other))
        x = self.inner(np.unique(np.concatenate(nodes)))
        # where the regions at an end differ, it is the edge of the window, and the column goes on to there
        bottom, top = ([end] if left.codes[k] != right.codes[k] else [] for k, end in ((0, low), (-1, high)))
        return np.concatenate([bottom, x, top])

    def bounded(self, column: Column) -> Column | None:
        """The part of a column within the panel that has the same regions at its ends, or None if it lacks them.

        The ends of the two columns differ only where they lie on the edge of the window; there the whole column counts.
        """
        left, right = self.left, self.right
        first, last = (left.codes[k] if left.codes[k] == right.codes[k] else column.codes[k] for k in (0, -1))
        if first not in column.codes or last not in column.codes:
            return None
        start, end = column.codes.index(first), len(column.codes) - 1 - column.codes[::-1].index(last)
        return column.between(start, end) if start <= end else None

    def gaps(self, pairs: Pairs) -> list[Panel]:
        """The parts of the panel between matched thresholds that hold others."""
        left, right = self.left, self.right
        ends = [(-1, -1), *pairs, (left.below.size, right.below.size)]
        return [
            replace(self, left=left.between(m + 1, i), right=right.between(n + 1, j))
            for (m, n), (i, j) in pairwise(ends)
            if i > m + 1 or j > n + 1
        ]

    def sides(self, pairs: Pairs) -> list[tuple[Side, Side]]:
        """The joins of the overturning regions beside matched thresholds."""
        codes = self.left.codes
        return [((self.left, m, side), (self.right, n, side)) for m, n in pairs for side in (0, 1) if codes[m + side]]
