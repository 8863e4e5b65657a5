"""Where regions lie between two columns: courses of regions that one of them lacks, and panels, which are halved.

A panel is two columns, or parts of them, between which a region ends, divides or begins.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields, replace
from itertools import pairwise

import numpy as np

from rocking._boundary.columns import THINNEST, Column, Index
from rocking._boundary.matching import Pairs, Side, follow_trends
from rocking._boundary.search import UNCOUNTED, Codes, Floats
from rocking._model.outcome import SURVIVES

PROBES = 81  # most points for one region in one column [-]
ACROSS = np.linspace(0.02, 0.98, 9)  # nodes of a column within a panel, as shares of its height [-]
PREDICTED = 5  # columns that are placed near the predicted end of one region at most; after them all lie halfway [-]
SHORT = 0.1  # a column stays before the predicted end of a region by this share of the distance to it [-]

NEARBY = np.array([-0.3, 0.0, 0.3])
"""The first nodes for a region within a panel, in widths of the region from its middle [-]."""


@dataclass(frozen=True, eq=False)
class Courses:
    """Where regions of a column lie on another line: one of each array's entries for each region."""

    codes: Codes  # region codes
    # middle, narrow, reach: 1/a halfway through the region, its least width, and how far from there it may lie [-]
    middle: Floats
    narrow: Floats
    reach: Floats

    def points(self) -> list[Floats]:
        """Points for each region, over its reach."""
        distance = 0.3 * np.maximum(self.narrow, 0.3 * THINNEST)
        count = np.clip(2 * np.ceil(self.reach / distance) + 1, 9, PROBES)
        return [
            middle + np.linspace(-reach, reach, int(n))
            for middle, reach, n in zip(self.middle, self.reach, count, strict=True)
        ]

    def missed(self, x: Floats, codes: Codes) -> Floats:
        """Points for the regions that nodes at `x` with these codes do not show."""
        met = (codes == self.codes[:, None]) & (np.abs(x - self.middle[:, None]) <= self.reach[:, None])
        lost = np.flatnonzero(~met.any(axis=1))
        chosen = Courses(*(getattr(self, each.name)[lost] for each in fields(self)))
        return np.concatenate([np.empty(0), *chosen.points()])

    @classmethod
    def joined(cls, *parts: Courses) -> Courses:
        """Those of several columns."""
        return cls(*(np.concatenate([getattr(part, each.name) for part in parts]) for each in fields(cls)))


def courses_of(column: Column, inner: Index, side: int, step: float, at: Floats, shift: Floats) -> Courses:
    """Where the regions above some thresholds lie one step (log omega) further.

    `inner`: the thresholds; `side`: side from which the slopes are known, 0 for a step to the right; `at`, `shift`:
    ascending 1/a, and by how much curves move there, which counts where slopes are not known [-].
    """
    found = follow_trends(column.below, column.above, inner, column.trends[side], side, step, at, shift)
    return Courses(column.regions[inner + 1], *found)


def probes_for_lost_regions(
    left: Column, right: Column, pairs: Pairs
) -> list[tuple[Column, Floats, tuple[float, int]]]:
    """Each column that lacks a region of the other one, points at which to look for it, and a key of the region."""
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


@dataclass(frozen=True)
class Panel:
    """Two columns, or parts of them."""

    line: int  # index of the line of the grid on its left
    left: Column
    right: Column
    predicted: int = 0  # how many of the columns that led to it were placed near a predicted end [-]

    @property
    def step(self) -> float:
        """Its width in log omega [-]."""
        return self.right.log_omega - self.left.log_omega

    @property
    def uncounted(self) -> bool:
        """Whether all blocks that overturn in it do so after many impacts."""
        return {*self.left.codes, *self.right.codes} <= {SURVIVES, UNCOUNTED}

    def share(self, end: float) -> float:
        """Where the next column shall lie, as a share of the step: near the predicted end of a region, or halfway.

        First it lies before the end, where the prediction becomes better, then just beyond it and just before it. `end`
        is the distance in log omega within which the end shall be known [-].
        """
        side = int(self.right.below.size > self.left.below.size)
        column, other = (self.right, self.left) if side else (self.left, self.right)
        # predicted is the end of one region: one column has it between its two outer ones, the other column lacks it
        one_ends = column.below.size == 2 and column.codes[::2] == [other.codes[0], other.codes[-1]]
        if not one_ends or other.below.size > 1 or self.predicted >= PREDICTED:
            return 0.5
        distance = _distance_to_end(column, side)
        if not distance < self.step:
            return 0.5
        margin = 0.45 * end
        if SHORT * distance > margin:  # still far: stay before the end
            distance -= SHORT * distance
        elif distance + 1.1 * margin < self.step:  # near: just beyond it
            distance += margin
        else:  # a column beyond it is there already: just before it
            distance -= margin
        share = min(max(distance, margin), self.step - margin) / self.step
        return 1.0 - share if side else share

    def expected(self, share: float) -> Courses:
        """Where the regions of the two columns lie at a share of the step."""
        ends = self._ends()
        shift = ends[1] - ends[0]
        return Courses.joined(
            *(
                courses_of(column, np.arange(column.below.size - 1), side, part * self.step, ends[side], part * shift)
                for side, column, part in ((0, self.left, share), (1, self.right, share - 1.0))
            )
        )

    def inner(self, x: Floats, share: float) -> Floats:
        """The points between the ends of the panel at a share of the step."""
        left, right = self._ends()
        low, high = left + share * (right - left)
        within: Floats = x[(x > low) & (x < high)]
        return within

    def _ends(self) -> Floats:
        """1/a at the two ends of each column (columns, ends)."""
        return np.array([[column.bottom, column.top] for column in (self.left, self.right)])

    def nodes(self, expected: Courses, share: float) -> Floats:
        """Nodes at a share of the step: across the panel, and where regions are expected."""
        left, right = self.left, self.right
        ends = self._ends()
        low, high = ends[0] + share * (ends[1] - ends[0])
        nodes = [low + (high - low) * ACROSS, (expected.middle + expected.narrow * NEARBY[:, None]).ravel()]
        for column, end, other, part in ((left, *ends, share), (right, *ends[::-1], 1.0 - share)):
            # from either end to the next threshold
            next_ones = column.middle[[0, -1]] if column.middle.size else end[::-1]
            nodes.append(next_ones + part * (other - next_ones))
        x = self.inner(np.unique(np.concatenate(nodes)), share)
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
        ends = [(-1, -1), *pairs.tolist(), (left.below.size, right.below.size)]
        return [
            replace(self, left=left.between(m + 1, i), right=right.between(n + 1, j))
            for (m, n), (i, j) in pairwise(ends)
            if i > m + 1 or j > n + 1
        ]

    def sides(self, pairs: Pairs) -> list[tuple[Side, Side]]:
        """The joins of the overturning regions beside matched thresholds."""
        codes = self.left.codes
        return [
            ((self.left, m, side), (self.right, n, side))
            for m, n in pairs.tolist()
            for side in (0, 1)
            if codes[m + side]
        ]


def _distance_to_end(column: Column, side: int) -> float:
    """Distance in log omega from a column with two thresholds to the end of the region between them; nan if unknown.

    A region that ends becomes narrower in proportion to the distance from its end, or to the square root of it. Of both
    the one is chosen that fits the widths on the last three columns; if two are known only, the square root where the
    regions on both sides are equal. `side` is 0 if the end lies to the right.
    """
    secant, step, curvature, span = column.trends[side].T.tolist()  # of the two curves that bound the region
    least = float(column.least_width(np.array([0]))[0])
    width = float(column.below[1] - column.above[0])
    narrowing = (secant[0] - secant[1]) * (1.0 - 2.0 * side)
    if not (narrowing > 0.0 and width > least):
        return math.nan
    before = width + narrowing * step[0]  # the width one chord away
    of_squares = (before**2 - width**2) / step[0]
    further = span[0] - step[0]
    first = before + further * (narrowing - 0.5 * span[0] * (curvature[0] - curvature[1]))  # two chords away
    as_root = column.codes[0] == column.codes[2]
    if math.isfinite(first):
        straight = before + narrowing * further
        as_root = abs(math.sqrt(before**2 + of_squares * further) - first) < abs(straight - first)
    return float((width**2 - least**2) / of_squares if as_root else (width - least) / narrowing)
