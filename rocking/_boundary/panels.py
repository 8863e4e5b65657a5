"""Regions between two columns: courses of regions that one of them lacks, and panels, which are halved.

A panel is two columns, or parts of them, between which a region ends, divides or begins.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
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
    """Predicted positions of the regions of a column on another line; all arrays (regions,)."""

    codes: Codes  # region codes
    # middle, narrow, reach: 1/a halfway through the region, its least width, and how far from there it may lie [-]
    middle: Floats
    narrow: Floats
    reach: Floats

    def points(self) -> list[Floats]:
        """Return points for each region, over its reach."""
        distance = 0.3 * np.maximum(self.narrow, 0.3 * THINNEST)
        count = np.clip(2 * np.ceil(self.reach / distance) + 1, 9, PROBES)
        rows = zip(self.middle, self.reach, count, strict=True)
        return [middle + np.linspace(-reach, reach, int(n)) for middle, reach, n in rows]

    def missed(self, x: Floats, codes: Codes) -> Floats:
        """Return points for the regions that nodes at `x` with these codes do not show."""
        displayed = (codes == self.codes[:, None]) & (np.abs(x - self.middle[:, None]) <= self.reach[:, None])
        lost = ~displayed.any(axis=1)
        courses = Courses(**{name: values[lost] for name, values in vars(self).items()})
        return np.concatenate([np.empty(0), *courses.points()])

    @classmethod
    def joined(cls, *parts: Courses) -> Courses:
        """Return the courses of several columns together."""
        columns = zip(*[vars(part).values() for part in parts], strict=True)
        return cls(*map(np.concatenate, columns))


def courses_of(column: Column, inner: Index, side: int, step: float, at: Floats, shift: Floats) -> Courses:
    """Predict where the regions above some thresholds lie one step (log omega) further.

    `inner`: the thresholds; `side`: side from which the slopes are known, 0 for a step to the right; `at`, `shift`:
    ascending 1/a, and by how much curves move there, which counts where slopes are not known [-].
    """
    courses = follow_trends(column.below, column.above, inner, column.trends[side], side, step, at, shift)
    return Courses(column.regions[inner + 1], *courses)


def probes_for_lost_regions(
    left: Column, right: Column, pairs: Pairs
) -> list[tuple[Column, Floats, tuple[float, int]]]:
    """Return each column that lacks a region of the other, points at which to look for it, and a key of the region."""
    probes: list[tuple[Column, Floats, tuple[float, int]]] = []
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
                probes.append((other, x, (round(float(x[x.size // 2]), 8), x.size)))
    return probes


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
        """True if all blocks that overturn in it do so after many impacts."""
        return {*self.left.codes, *self.right.codes} <= {SURVIVES, UNCOUNTED}

    def share(self, end: float) -> float:
        """Choose where the next column lies, as a share of the step: near the predicted end of a region, or halfway.

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
        """Predict where the regions of the two columns lie at a share of the step."""
        ends = self._ends()
        shift = ends[1] - ends[0]
        courses = []
        for side, column, part in ((0, self.left, share), (1, self.right, share - 1.0)):
            regions = np.arange(column.below.size - 1)
            courses.append(courses_of(column, regions, side, part * self.step, ends[side], part * shift))
        return Courses.joined(*courses)

    def inner(self, x: Floats, share: float) -> Floats:
        """Return the points between the ends of the panel at a share of the step."""
        left, right = self._ends()
        low, high = left + share * (right - left)
        return np.asarray(x[(x > low) & (x < high)])

    def _ends(self) -> Floats:
        """Return 1/a at the two ends of each column (columns, ends)."""
        return np.array([[column.bottom, column.top] for column in (self.left, self.right)])

    def nodes(self, expected: Courses, share: float) -> Floats:
        """Return nodes at a share of the step: across the panel, and where regions are expected."""
        left, right = self.left, self.right
        ends = self._ends()
        low, high = ends[0] + share * (ends[1] - ends[0])
        nodes = [low + (high - low) * ACROSS, (expected.middle + expected.narrow * NEARBY[:, None]).ravel()]
        for column, end, other, part in ((left, *ends, share), (right, *ends[::-1], 1.0 - share)):
            # from either end to the next threshold
            nearest = column.middle[[0, -1]] if column.middle.size else end[::-1]
            nodes.append(nearest + part * (other - nearest))
        x = self.inner(np.unique(np.concatenate(nodes)), share)
        # where the regions at an end differ, it is the edge of the window, and the column goes on to there
        if left.codes[0] != right.codes[0]:
            x = np.append(low, x)
        if left.codes[-1] != right.codes[-1]:
            x = np.append(x, high)
        return x

    def bounded(self, column: Column) -> Column | None:
        """Return the part of a column within the panel that has the same regions at its ends, or None if it lacks them.

        The ends of the two columns differ only where they lie on the edge of the window; there the whole column counts.
        """
        left, right = self.left, self.right
        first = left.codes[0] if left.codes[0] == right.codes[0] else column.codes[0]
        last = left.codes[-1] if left.codes[-1] == right.codes[-1] else column.codes[-1]
        if first not in column.codes or last not in column.codes:
            return None
        start, end = column.codes.index(first), len(column.codes) - 1 - column.codes[::-1].index(last)
        return column.between(start, end) if start <= end else None

    def gaps(self, pairs: Pairs) -> list[Panel]:
        """Return the parts of the panel between matched thresholds that hold others."""
        left, right = self.left, self.right
        ends = [(-1, -1), *pairs.tolist(), (left.below.size, right.below.size)]
        gaps = []
        for (m, n), (i, j) in pairwise(ends):
            if i > m + 1 or j > n + 1:
                gaps.append(replace(self, left=left.between(m + 1, i), right=right.between(n + 1, j)))
        return gaps

    def sides(self, pairs: Pairs) -> list[tuple[Side, Side]]:
        """Return the joins of the overturning regions beside matched thresholds."""
        joins: list[tuple[Side, Side]] = []
        for m, n in pairs.tolist():
            sides = [side for side in (0, 1) if self.left.codes[m + side] != SURVIVES]
            joins += [((self.left, m, side), (self.right, n, side)) for side in sides]
        return joins


def _distance_to_end(column: Column, side: int) -> float:
    """Estimate how far in log omega from a column the region between its two thresholds ends; nan if unknown.

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
    length = span[0] - step[0]
    first = before + length * (narrowing - 0.5 * span[0] * (curvature[0] - curvature[1]))  # two chords away
    as_root = column.codes[0] == column.codes[2]
    if math.isfinite(first):
        straight = before + narrowing * length
        as_root = abs(math.sqrt(before**2 + of_squares * length) - first) < abs(straight - first)
    return float((width**2 - least**2) / of_squares if as_root else (width - least) / narrowing)
