"""Curves between regions of outcome, followed from column to column.

A column holds the regions along a line omega = const, see `Column`. Regions that one column has and its neighbour
lacks are searched for where their slopes lead, so a thin region seen anywhere is followed as long as it is wider than
`THINNEST`. Where two columns still differ, a region ends, divides or begins between them: the step is halved there
until that place is known to `END`. The ends of equal regions in neighbouring columns, joined, are the boundary curves.
"""

from __future__ import annotations

import math
from collections import Counter, defaultdict
from collections.abc import Iterable
from itertools import pairwise

import numpy as np

from rocking.boundary.columns import THINNEST, Column, Lines
from rocking.boundary.matching import Pairs, Side, join_sides, learn_slopes, learn_smooth_slopes, match_thresholds
from rocking.boundary.search import UNCOUNTED, Classify, Floats, Work, without_layers
from rocking.model.outcome_code import SURVIVES, impacts_of_code

BATCH_SIZE = 500_000
"""Blocks that are solved in one call, about: a hundred megabytes [-]."""

END = 1e-4
"""Distance in log omega within which the end of a region is known [-]."""

FINER = 8
"""Parts into which the distance of two nodes is divided where blocks overturn after two impacts or more [-]."""

PROBES = 81
"""Most nodes by which a region is searched for in one column [-]."""

NEARLY_ELASTIC = 0.9
"""Restitution above which regions of overturning after many impacts are resolved less finely than others [-].

There they lie in ever more layers, on which blocks strike a hundred times: at 0.96 under the cosine, 301 nodes, the
resolution of the others took 49 million impacts and blocks in all, this one takes 8 million.
"""

UNCOUNTED_THINNEST, UNCOUNTED_END = 1e-4, 1e-3
"""Above `NEARLY_ELASTIC`, for regions of many impacts: in place of `THINNEST` and of `END` [-]."""

EFFORT = 10_000_000
"""Impacts and blocks after which regions are no longer followed, and, as many later, steps no longer halved [-].

It bounds the time for blocks that strike hundreds of times; `open_ends` counts what is left then.
"""

SEARCHES = 4
"""Times that a region which goes on beyond a column may start the search in the next ones anew [-]."""

Item = tuple[int, Column, Column]
"""Two neighbouring columns, or parts of them, and the panel of the grid in which they lie."""


class Tracer:
    """Columns at one restitution, and the joins between the regions of neighbouring ones.

    Attributes
    ----------
    columns : list of Column
        Of the lines omega = const of the grid, ascending.
    joins : dict of lists
        By the index of the left column: pairs of ends of regions that follow each other on a curve.
    thinnest : float
        Width in 1/a below which a region of many impacts is not resolved [-].
    end : float
        Distance in log omega within which the end of such a region is known [-].
    """

    def __init__(
        self, log_omega: Floats, eta: float, classify: Classify, classify_regions: Classify, work: Work
    ) -> None:
        self.points = np.stack([np.zeros(log_omega.size), log_omega, np.full(log_omega.size, eta)], axis=1)
        self.classify = classify
        self.classify_regions = classify_regions
        self.work = work
        elastic = eta > NEARLY_ELASTIC
        self.thinnest, self.end = (UNCOUNTED_THINNEST, UNCOUNTED_END) if elastic else (THINNEST, END)
        self.lines = Lines(self.points, classify, self.thinnest)
        self.columns: list[Column] = []
        self.panels = range(log_omega.size - 1)
        self.joins: dict[int, list[tuple[Side, Side]]] = {}
        self._open: Counter[int] = Counter()
        self._tried: set[tuple[int, int, float, int]] = set()

    def trace(self, rows: Floats) -> None:
        """Find all joins, from nodes of 1/a (nodes, columns)."""
        self._classify_grid(rows)
        for k in self.panels[1:]:
            learn_smooth_slopes((self.columns[k - 1], self.columns[k], self.columns[k + 1]))
        followed = self.work.done + EFFORT
        halved = followed + EFFORT
        changed = set(self.panels)
        for _ in range(SEARCHES):
            changed |= self._follow(changed, followed)
            ends = self._join(changed, halved)
            if self.work.done > followed:
                break
            changed = self._beyond(ends)
            if not changed:
                break
        else:
            self._join(changed, halved)

    @property
    def open_ends(self) -> int:
        """Places at which a region ends, divides or begins that are known to a step of the grid only."""
        return self._open.total()

    def _classify_grid(self, rows: Floats) -> None:
        """Columns from the nodes; after two impacts and more regions are thin, so there are finer nodes there."""
        found = []
        log_omega, eta = self.points[:, 1], self.points[0, 2]
        for part in np.array_split(np.arange(rows.shape[1]), math.ceil(rows.size / BATCH_SIZE)):
            codes = self.classify(rows[:, part], log_omega[part], eta)[0].T
            edge = np.diff(codes) != 0
            ends = np.ones((part.size, 1), dtype=bool)
            column, row = np.nonzero(np.concatenate([ends, edge], 1) | np.concatenate([edge, ends], 1))
            found.append((part[column], rows[row, part[column]], codes[column, row]))
            many = (codes == UNCOUNTED) | (impacts_of_code(codes) >= 2)
            column, row = np.nonzero(many[:, 1:] | many[:, :-1])
            low, high = rows[row, part[column]], rows[row + 1, part[column]]
            x = low + (high - low) * np.arange(1, FINER)[:, None] / FINER
            met, _ = self.classify(x, log_omega[part[column]], eta)
            found.append((np.tile(part[column], FINER - 1), x.ravel(), met.ravel()))
        columns = self.lines.add(*(np.concatenate(each) for each in zip(*found, strict=True)))
        self.columns = [columns[k] for k in range(len(self.points))]

    def _follow(self, panels: Iterable[int], most: int) -> set[int]:
        """Look in each column for the regions of its neighbours; the panels whose columns changed."""
        changed: set[int] = set()
        todo = set(panels)
        while todo and self.work.done < most:
            wanted: dict[int, list[Floats]] = defaultdict(list)
            matched = {k: match_thresholds(self.columns[k], self.columns[k + 1]) for k in sorted(todo)}
            for k in [*matched, *reversed(matched)]:  # slopes pass from panel to panel in both directions
                learn_slopes(self.columns[k], self.columns[k + 1], matched[k])
            for k, pairs in matched.items():
                left, right = self.columns[k], self.columns[k + 1]
                for column, x, key in _probes(left, right, pairs):
                    line = k if column is left else k + 1
                    if (line, k, *key) not in self._tried:
                        self._tried.add((line, k, *key))
                        wanted[line].append(x)
            todo = self._look(wanted)
            changed |= todo
        return changed

    def _look(self, wanted: dict[int, list[Floats]]) -> set[int]:
        """Classify points on some lines; the panels beside the lines on which they show something new."""
        if not wanted:
            return set()
        line = np.repeat([*wanted], [sum(x.size for x in xs) for xs in wanted.values()])
        x = np.concatenate([x for xs in wanted.values() for x in xs])
        codes, _ = self.classify(x, *self.points[line, 1:].T)
        known = np.concatenate([self.columns[k].code_at(np.concatenate(xs)) for k, xs in wanted.items()])
        new = np.isin(line, np.unique(line[without_layers(codes) != known]))
        if not new.any():
            return set()
        before = {int(k): self.columns[k] for k in np.unique(line[new])}
        panels = set()
        for k, column in self.lines.add(line[new], x[new], codes[new]).items():
            if column.codes != before[k].codes:
                self.columns[k] = column
                panels |= {k - 1, k}
        return panels & set(self.panels)

    def _join(self, panels: set[int], most: int) -> list[tuple[Column, Column, Pairs]]:
        """Join the regions of neighbouring columns; the pairs of columns between which one ends."""
        items: list[Item] = []
        for k in sorted(panels):
            self.joins[k], self._open[k] = [], 0
            items.append((k, self.columns[k], self.columns[k + 1]))
        last: list[tuple[Column, Column, Pairs]] = []
        while items:
            halved: list[Item] = []
            for k, left, right in items:
                pairs = match_thresholds(left, right)
                learn_slopes(left, right, pairs)
                self.joins[k] += [join for m, n in pairs for join in _sides(left, m, right, n)]
                for part, other in _gaps(left, right, pairs):
                    end = self.end if {*part.codes, *other.codes} <= {SURVIVES, UNCOUNTED} else END
                    if right.log_omega - left.log_omega > end and self.work.done < most:
                        halved.append((k, part, other))
                    else:
                        self.joins[k] += join_sides(part, other)
                        self._open[k] += right.log_omega - left.log_omega > end
                        last.append((part, other, match_thresholds(part, other)))
            items = self._halve(halved)
        return last

    def _halve(self, items: list[Item]) -> list[Item]:
        """A column halfway in each panel, and the two panels that it makes of it."""
        if not items:
            return []
        points = np.array([[0.0, 0.5 * (left.log_omega + right.log_omega), left.eta] for _, left, right in items])
        nodes = [_nodes_between(left, right) for _, left, right in items]
        line = np.repeat(np.arange(len(items)), [x.size for x in nodes])
        x = np.concatenate(nodes)
        codes, _ = self.classify_regions(x, *points[line, 1:].T)
        columns = Lines(points, self.classify_regions, self.thinnest).add(line, x, codes)
        halves: list[Item] = []
        for i, (k, left, right) in enumerate(items):
            column = _bounded(columns[i], left, right)
            if column is None:
                self.joins[k] += join_sides(left, right)
                self._open[k] += 1
            else:
                halves += [(k, left, column), (k, column, right)]
        return halves

    def _beyond(self, ends: list[tuple[Column, Column, Pairs]]) -> set[int]:
        """Look for regions that end at a column of the grid beyond it, now that their course is known well."""
        of_column = {id(column): k for k, column in enumerate(self.columns)}
        wanted: dict[int, list[Floats]] = defaultdict(list)
        for left, right, pairs in ends:
            for column, x, _ in _probes(left, right, pairs):
                line = of_column.get(id(column.whole))
                if line is not None:
                    wanted[line].append(x)
        return self._look(wanted)


def _sides(left: Column, m: int, right: Column, n: int) -> list[tuple[Side, Side]]:
    """The joins of the overturning regions beside two matched thresholds."""
    kind = left.codes[m], left.codes[m + 1]
    return [((left, m, side), (right, n, side)) for side in (0, 1) if kind[side]]


def _gaps(left: Column, right: Column, pairs: Pairs) -> list[tuple[Column, Column]]:
    """The parts of two columns between matched thresholds that hold others."""
    ends = [(-1, -1), *pairs, (left.below.size, right.below.size)]
    return [
        (left.between(m + 1, i), right.between(n + 1, j)) for (m, n), (i, j) in pairwise(ends) if i > m + 1 or j > n + 1
    ]


def _probes(left: Column, right: Column, pairs: Pairs) -> list[tuple[Column, Floats, tuple[float, int]]]:
    """Points at which regions that one of two columns lacks are looked for in it, and a key of the region."""
    found: list[tuple[Column, Floats, tuple[float, int]]] = []
    matched = np.array(pairs, dtype=np.intp).reshape(-1, 2)
    for side, column, other in ((0, left, right), (1, right, left)):
        own = set(matched[:, side].tolist())
        step = other.log_omega - column.log_omega
        at = column.middle[matched[:, side]]
        shift = other.middle[matched[:, 1 - side]] - at
        lost = [m for m in range(column.below.size - 1) if m not in own and m + 1 not in own]
        for m in lost:
            x = _course(column, m, side, step, at, shift)
            x = x[(x > other.bottom) & (x < other.top)]
            if x.size:
                found.append((other, x, (round(float(x[x.size // 2]), 8), x.size)))
    return found


def _course(column: Column, m: int, side: int, step: float, at: Floats, shift: Floats) -> Floats:
    """Points among which the region above threshold m lies one step further."""
    low, high = float(column.above[m]), float(column.below[m + 1])
    middle, width = 0.5 * (low + high), high - low
    slope, curvature = column.slope(side)[m : m + 2], column.curvature[side, m : m + 2]
    moved = float(np.interp(middle, at, shift)) if at.size else 0.0
    nearby = 0.5 * abs(float(np.interp(high, at, shift)) - moved) + 0.3 * abs(moved) if at.size else 0.1 * abs(step)
    known = int(np.isfinite(slope).all()) + int(np.isfinite(curvature).all())
    narrow = width
    if known == 2:
        bend = 0.5 * float(curvature.mean()) * step * step
        moved, error = float(slope.mean()) * step + bend, 0.5 * abs(bend)
    elif known == 1:
        straight = float(slope.mean()) * step
        moved, error = straight, max(0.2 * abs(moved - straight), 0.02 * abs(straight))
    else:
        error = nearby
    if known:
        narrow = min(max(width + float(slope[1] - slope[0]) * step, 0.1 * width), width)
    reach = max(1.5 * width, 2.0 * error)
    count = min(PROBES, max(9, 2 * math.ceil(reach / (0.3 * max(narrow, 0.3 * THINNEST))) + 1))
    return middle + moved + np.linspace(-reach, reach, count)


def _nodes_between(left: Column, right: Column) -> Floats:
    """Nodes of a column halfway between two: across the window, and where the regions of either lead."""
    low, high = 0.5 * (left.bottom + right.bottom), 0.5 * (left.top + right.top)
    nodes = [low + (high - low) * np.linspace(0.02, 0.98, 9)]
    step = 0.5 * (right.log_omega - left.log_omega)
    at = np.array([left.bottom, left.top])
    shift = 0.5 * (np.array([right.bottom, right.top]) - at)
    for side, column, sign in ((0, left, 1.0), (1, right, -1.0)):
        nodes += [
            _course(column, m, side, sign * step, at if side == 0 else at + 2 * shift, sign * shift)
            for m in range(column.below.size - 1)
        ]
        ends = [column.bottom, *column.middle, column.top]
        nodes += [np.array([0.5 * (ends[0] + ends[1]), 0.5 * (ends[-1] + ends[-2])]) + sign * shift]
    x = np.unique(np.concatenate(nodes))
    x = x[(x > low) & (x < high)]
    # where the regions at an end differ, it is the edge of the window, and the column goes on to there
    bottom, top = ([end] if left.codes[k] != right.codes[k] else [] for k, end in ((0, low), (-1, high)))
    return np.concatenate([bottom, x, top])


def _bounded(column: Column, left: Column, right: Column) -> Column | None:
    """The part of a column halfway between two that has the same regions at its ends, or None if it lacks them.

    The ends of the two columns differ only where they lie on the edge of the window; there the whole column counts.
    """
    first, last = (left.codes[k] if left.codes[k] == right.codes[k] else column.codes[k] for k in (0, -1))
    if first not in column.codes or last not in column.codes:
        return None
    start, end = column.codes.index(first), len(column.codes) - 1 - column.codes[::-1].index(last)
    return column.between(start, end) if start <= end else None
