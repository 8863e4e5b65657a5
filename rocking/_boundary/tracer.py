"""Curves between regions of outcome, followed from column to column: steps 3 and 4 of `rocking._boundary`.

A thin region that any node shows is followed as long as it is wider than `THINNEST`, and its end is known to `END`.
"""

import math
from collections import Counter, defaultdict
from collections.abc import Iterable, Sequence

import numpy as np

from rocking._boundary.columns import THINNEST, Column, Index, Lines
from rocking._boundary.matching import Side, join_sides, learn_slopes, learn_smooth_slopes, match_thresholds
from rocking._boundary.panels import Panel, probes_for_lost_regions
from rocking._boundary.search import UNCOUNTED, Classify, Codes, Floats, Nodes, Work, without_layers
from rocking._model.outcome import impacts_of_code

BATCH_SIZE = 500_000  # blocks that are solved in one call, about: a hundred megabytes [-]
END = 1e-4  # distance in log omega within which the end of a region is known [-]

CHORD = 1e-4
"""Largest distance of a chord from its curve, in the plane of 1/a and log omega, at the middle of the chord [-]."""

FINER = 8  # times as many nodes where blocks overturn after two impacts or more [-]

NEARLY_ELASTIC = 0.9
"""Above this restitution, regions of overturning after many impacts are resolved less finely than others [-].

There they lie in ever more layers, and blocks strike a hundred times: the resolution of the others takes several
times the work.
"""

LAYERED = 3.5
"""Ends of regions of many impacts that the nodes of a line show on average, above which these are resolved less
finely, too [-].

Under the pulse c2 surviving bands divide such a region, each with thinner ones beside it, down to the finest scale.
"""

UNCOUNTED_THINNEST, UNCOUNTED_END, UNCOUNTED_CHORD = 3e-4, 3e-3, 3e-4
"""In these two cases, for regions of many impacts: in place of `THINNEST`, of `END` and of `CHORD` [-]."""

EFFORT = 10_000_000
"""After so many impacts and blocks at an angle regions are no longer followed; after twice as many steps are no longer
halved [-].

It bounds the time for blocks that strike hundreds of times; `open_ends` counts what is left then.
"""

SEARCHES = 4  # times that the search starts anew for regions that go on beyond a column [-]


class Tracer:
    """Columns on the lines omega = const of grids, and the joins between the regions of neighbouring ones.

    The grids are of different angles. They do not affect each other: the solver is called for all of them together,
    since most of its calls are for a few blocks. `points` (lines, 4): 1/a (any), log omega, eta and alpha of each line,
    grid after grid; `classify`, `classify_regions`: the solver with layer codes and with region codes, which note their
    work in `work`. `joins`: by the index of the left column of a panel, pairs of ends of regions that follow each other
    on a curve. By the number of the angle in `work`, `thinnest`: width in 1/a below which a region of many impacts is
    not resolved; `end`: distance in log omega within which the end of such a region is known; `chord`: largest distance
    of a chord from the curve of such a region [-].
    """

    def __init__(self, points: Floats, classify: Classify, classify_regions: Classify, work: Work) -> None:
        self.points, self.angle = points, work.angle(points[:, 3])
        self.classify = classify
        self.classify_regions = classify_regions
        self.work = work
        self.columns: list[Column] = []
        self.panels = np.flatnonzero(np.diff(self.angle) == 0).tolist()
        self.joins: dict[int, list[tuple[Side, Side]]] = {}
        self._open: Counter[int] = Counter()
        self._tried: set[tuple[int, int, float, int]] = set()

    def trace(self, rows: Sequence[Floats]) -> None:
        """Find all joins, from nodes of 1/a (nodes, columns) for each grid."""
        self._classify_grid(rows)
        smooth = set(self.panels)
        for k in self.panels:
            if k - 1 in smooth:
                learn_smooth_slopes((self.columns[k - 1], self.columns[k], self.columns[k + 1]))
        followed = self.work.done + EFFORT
        halved = followed + EFFORT
        changed = set(self.panels)
        for _ in range(SEARCHES):
            changed |= self._follow(changed, followed)
            ends = self._join(changed, halved)
            within = self.work.done <= followed
            changed = self._beyond([end for end in ends if within[self.angle[end.line]]])
            if not changed:
                break
        else:
            self._join(changed, halved)

    def open_ends(self, panels: Iterable[int]) -> int:
        """Places at which a region ends, divides or begins that are known to a step of the grid."""
        return sum(self._open[k] for k in panels)

    def _classify_grid(self, rows: Sequence[Floats]) -> None:
        """Build columns from the nodes; after two impacts and more regions are thin, so there are finer nodes there."""
        self.thinnest, self.end, self.chord = np.empty((3, len(rows)))
        grids, first = [], 0
        for grid in rows:
            lines = first + np.arange(grid.shape[1])
            grids.append(self._classified_grid(grid, lines))
            self._resolve_layers(grids[-1], lines)
            first += lines.size
        self.lines = Lines(self.points, self.classify, self.thinnest[self.angle])
        columns = self.lines.add(Nodes.merged(grids))
        self.columns = [columns[k] for k in range(len(self.points))]

    def _classified_grid(self, rows: Floats, columns: Index) -> Nodes:
        """Classify the nodes of one grid; return those where the outcome changes, with the finer ones."""
        parts = []
        for part in np.array_split(columns, math.ceil(rows.size / BATCH_SIZE)):
            x, lines = np.broadcast_arrays(rows.T[part - columns[0]], part[:, None])
            codes, margin = self.classify(x, *self.points[part, 1:, None].swapaxes(0, 1))
            edge = np.diff(codes) != 0
            ends = np.ones((part.size, 1), dtype=bool)
            ends_of_runs = np.concatenate([ends, edge], 1) | np.concatenate([edge, ends], 1)
            parts.append(Nodes(lines[ends_of_runs], x[ends_of_runs], codes[ends_of_runs], margin[ends_of_runs]))
            many = (codes == UNCOUNTED) | (impacts_of_code(codes) >= 2)
            inner = many[..., 1:] | many[..., :-1]
            line, low, high = lines[..., 1:][inner], x[..., :-1][inner], x[..., 1:][inner]
            finer = (low + (high - low) * np.arange(1, FINER)[:, None] / FINER).ravel()
            line = np.tile(line, FINER - 1)
            parts.append(Nodes(line, finer, *self.classify(finer, *self.points[line, 1:].T)))
        return Nodes.merged(parts)

    def _resolve_layers(self, nodes: Nodes, lines: Index) -> None:
        """Choose how finely regions of many impacts are resolved, from how many of their ends the nodes show."""
        many = without_layers(nodes.codes) == UNCOUNTED
        ends = np.count_nonzero((many[1:] != many[:-1]) & (np.diff(nodes.line) == 0))
        coarse = ends > LAYERED * lines.size or self.points[lines[0], 2] > NEARLY_ELASTIC
        angle = self.angle[lines[0]]
        self.thinnest[angle] = UNCOUNTED_THINNEST if coarse else THINNEST
        self.end[angle] = UNCOUNTED_END if coarse else END
        self.chord[angle] = UNCOUNTED_CHORD if coarse else CHORD

    def _follow(self, panels: Iterable[int], limit: Floats) -> set[int]:
        """Look in each column for the regions of its neighbours; return the panels whose columns changed."""
        changed: set[int] = set()
        todo = set(panels)
        while todo := {k for k in todo if self._can_go_on(k, limit)}:
            probes: dict[int, list[Floats]] = defaultdict(list)
            matched = {k: match_thresholds(self.columns[k], self.columns[k + 1]) for k in sorted(todo)}
            # a region without partner in the next column is looked for there, where its slope leads; what is found is a
            # new node of that column and looked for in the one after it. No point is tried twice, so the loop ends
            for k in [*matched, *reversed(matched)]:  # slopes pass from panel to panel in both directions
                learn_slopes(self.columns[k], self.columns[k + 1], matched[k])
            for k, pairs in matched.items():
                left, right = self.columns[k], self.columns[k + 1]
                for column, x, key in probes_for_lost_regions(left, right, pairs):
                    line = k if column is left else k + 1
                    if (line, k, *key) not in self._tried:
                        self._tried.add((line, k, *key))
                        probes[line].append(x)
            todo = self._look(probes)
            changed |= todo
        return changed

    def _look(self, probes: dict[int, list[Floats]]) -> set[int]:
        """Classify points on some lines; return the panels beside the lines on which they show something new."""
        if not probes:
            return set()
        points = {line: np.concatenate(parts) for line, parts in probes.items()}
        line = np.repeat([*points], [part.size for part in points.values()])
        x = np.concatenate([*points.values()])
        nodes = Nodes(line, x, *self.classify(x, *self.points[line, 1:].T))
        expected = np.concatenate([self.columns[k].code_at(part) for k, part in points.items()])
        new = np.isin(line, np.unique(line[without_layers(nodes.codes) != expected]))
        if not new.any():
            return set()
        before = {int(k): self.columns[k] for k in np.unique(line[new])}
        panels = set()
        for k, column in self.lines.add(nodes.take(new)).items():
            if column.codes != before[k].codes:
                self.columns[k] = column
                panels |= {k - 1, k}
        return panels & set(self.panels)

    def _can_go_on(self, line: int, limit: Floats) -> bool:
        """Return True if the work at the angle of a line is below a limit."""
        angle = self.angle[line]
        return bool(self.work.done[angle] < limit[angle])

    def _join(self, lines: set[int], limit: Floats) -> list[Panel]:
        """Join the regions of neighbouring columns; return the panels, or parts of them, in which one ends."""
        todo: list[Panel] = []
        for k in sorted(lines):
            self.joins[k], self._open[k] = [], 0
            todo.append(Panel(k, self.columns[k], self.columns[k + 1]))
        last: list[Panel] = []
        while todo:
            halved: list[Panel] = []
            for panel in todo:
                pairs = match_thresholds(panel.left, panel.right)
                learn_slopes(panel.left, panel.right, pairs)
                self.joins[panel.line] += panel.sides(pairs)
                # only the parts of a panel in which the columns differ are halved; in a part narrower than the end
                # distance the regions end, and it counts as an open end if the effort ran out before
                for gap in panel.gaps(pairs):
                    if gap.step > self._end_distance(gap) and self._can_go_on(gap.line, limit):
                        halved.append(gap)
                    else:
                        self.joins[gap.line] += join_sides(gap.left, gap.right)
                        self._open[gap.line] += gap.step > self._end_distance(gap)
                        last.append(gap)
            todo = self._halve(halved)
        return last

    def _halve(self, panels: list[Panel]) -> list[Panel]:
        """Divide each panel by a further column; return the two panels of each."""
        if not panels:
            return []
        points = self.points[[panel.line for panel in panels]]
        shares, courses, nodes = [], [], []
        for k, panel in enumerate(panels):
            share = panel.share(self._end_distance(panel))
            points[k, 1] = panel.left.log_omega + share * panel.step
            shares.append(share)
            courses.append(panel.expected(share))
            nodes.append(panel.nodes(courses[k], share))
        first, codes = self._classified(points, nodes)
        # regions that the first nodes should have met and did not get a second set of nodes, inside their courses
        missed = []
        for k, panel in enumerate(panels):
            missed.append(panel.inner(courses[k].missed(nodes[k], codes[k]), shares[k]))
        second, _ = self._classified(points, missed)
        thinnest = np.array([panel.left.thinnest for panel in panels])
        columns = Lines(points, self.classify_regions, thinnest).add(Nodes.joined([first, second]))
        halves: list[Panel] = []
        for k, panel in enumerate(panels):
            column = panel.bounded(columns[k])
            if column is None:  # the outcomes at the two sides of the panel do not go on to this column
                self.joins[panel.line] += join_sides(panel.left, panel.right)
                self._open[panel.line] += 1
                continue
            predicted = panel.predicted + (shares[k] != 0.5)
            halves.append(Panel(panel.line, panel.left, column, predicted))
            halves.append(Panel(panel.line, column, panel.right, predicted))
        return halves

    def _classified(self, points: Floats, x: list[Floats]) -> tuple[Nodes, list[Codes]]:
        """Classify points of some lines by region codes: together, and line by line."""
        sizes = [row.size for row in x]
        line = np.repeat(np.arange(len(x)), sizes)
        together = np.concatenate(x)
        nodes = Nodes(line, together, *self.classify_regions(together, *points[line, 1:].T))
        ends = np.cumsum(sizes).tolist()
        return nodes, [nodes.codes[end - size : end] for size, end in zip(sizes, ends, strict=True)]

    def _end_distance(self, panel: Panel) -> float:
        """Return the distance in log omega within which the ends of regions in a panel are known [-]."""
        return float(self.end[self.angle[panel.line]]) if panel.uncounted else END

    def _beyond(self, ends: list[Panel]) -> set[int]:
        """Look for regions that end at a column of the grid beyond it, now that their course is known well."""
        of_column = {id(column): k for k, column in enumerate(self.columns)}
        probes: dict[int, list[Floats]] = defaultdict(list)
        for end in ends:
            if of_column.keys().isdisjoint((id(end.left.parent), id(end.right.parent))):
                continue
            pairs = match_thresholds(end.left, end.right)
            for column, x, _ in probes_for_lost_regions(end.left, end.right, pairs):
                line = of_column.get(id(column.parent))
                if line is not None:
                    probes[line].append(x)
        return self._look(probes)
