"""Columns: the regions of outcome along a line omega = const, as runs of 1/a with one region code each."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from rocking._boundary.search import UNCOUNTED, Classify, Codes, Floats, Nodes, refine_lines, without_layers

THINNEST = 1e-6  # width in 1/a below which a region is not resolved: the regions on its two sides are taken to meet [-]

Index = NDArray[np.intp]


@dataclass(eq=False)
class Column:
    """Regions along one line omega = const between two values of 1/a, ascending, and the thresholds between them."""

    log_omega: float  # of the line [-]
    # below, above: (thresholds,) 1/a where the region below a threshold ends and where the one above it begins:
    # `RESOLUTION` apart, or up to `THINNEST` where thinner regions lie between them [-]
    below: Floats
    above: Floats
    codes: list[int]  # (thresholds + 1,) region codes, see `region_code`
    # bottom, top: 1/a at the two ends [-]
    bottom: float
    top: float
    # as `THINNEST`, for overturning after many impacts and for the bands of surviving blocks within it [-]
    thinnest: float = THINNEST
    middle: Floats = field(init=False)  # (thresholds,) 1/a of each threshold, halfway between its two regions [-]
    regions: Codes = field(init=False)  # (thresholds + 1,) the codes as an array
    # (2, thresholds, 4) how the boundary curve goes that ends at each threshold, see `rocking._boundary.matching`:
    # known from the left (row 0) and from the right (row 1); nan where unknown
    trends: Floats = field(init=False)
    # parent, offset: the column that this one is a part of, and the index of its first threshold there
    parent: Column = field(init=False)
    offset: int = field(init=False, default=0)

    def __post_init__(self) -> None:
        self.regions = np.array(self.codes, dtype=np.int64)
        self.trends = np.full((2, self.below.size, 4), np.nan)
        self.parent = self
        self.middle = 0.5 * (self.below + self.above)

    def code_at(self, x: Floats) -> Codes:
        """Return the region code at points between the two ends."""
        return self.regions[np.searchsorted(self.middle, x)]

    def least_width(self, inner: Index) -> Floats:
        """Return the widths in 1/a below which the regions above some thresholds are not resolved [-]."""
        below, inside, above = self.regions[inner + np.arange(3)[:, None]] == UNCOUNTED
        return np.where(inside | (below & above), self.thinnest, THINNEST)

    def between(self, first: int, last: int) -> Column:
        """Return the part from the threshold `first` to before `last`, with the regions beside them."""
        bottom = self.above[first - 1] if first else self.bottom
        top = self.below[last] if last < self.below.size else self.top
        cut = slice(first, last)
        part = Column(
            self.log_omega,
            self.below[cut],
            self.above[cut],
            self.codes[first : last + 1],
            bottom,
            top,
            self.thinnest,
        )
        part.trends = self.trends[:, cut]
        part.parent, part.offset = self.parent, self.offset + first
        return part


class Lines:
    """Classified nodes on many lines omega = const, every change of outcome between them refined.

    `points` (lines, 4): 1/a (any), log omega, eta and alpha of each line; `classify`: the solver, with layer codes or
    region codes; `thinnest` (lines,): as `THINNEST`, for overturning after many impacts and for the bands of surviving
    blocks within it [-].
    """

    def __init__(self, points: Floats, classify: Classify, thinnest: Floats) -> None:
        self.points = points
        self.classify = classify
        self.thinnest = thinnest
        self.nodes: dict[int, Nodes] = {}

    def add(self, new: Nodes) -> dict[int, Column]:
        """Take in classified nodes, refine all changes between neighbours, and give the columns of these lines."""
        touched = np.unique(new.line).tolist()
        nodes = Nodes.merged([new, *(self.nodes[k] for k in touched if k in self.nodes)])
        nodes = refine_lines(0, self.points, nodes, self.classify, THINNEST, 0.5 * self.thinnest)
        edge = (np.diff(nodes.line) != 0) | (np.diff(nodes.codes) != 0)
        nodes = nodes.take(np.append(True, edge) | np.append(edge, True))  # the ends of every run
        bounds = np.append(np.searchsorted(nodes.line, touched), nodes.line.size).tolist()
        for k, first, last in zip(touched, bounds[:-1], bounds[1:], strict=True):
            self.nodes[k] = nodes.take(slice(first, last))
        return dict(zip(touched, self._columns(nodes.line, nodes.x, nodes.codes), strict=True))

    def _columns(self, line: Index, x: Floats, codes: Codes) -> list[Column]:
        """Build a column for each line of some nodes, without the regions that are too thin."""
        codes = without_layers(codes)
        start, end = _runs(line, codes)
        line, codes, low, high = line[start], codes[start], x[start], x[end]
        for many in (False, True):  # first the surviving bands between two regions of many impacts, then such regions
            thinnest = np.full(codes.size, THINNEST)
            uncounted = codes == UNCOUNTED
            coarse = uncounted if many else _between(uncounted)
            thinnest[coarse] = self.thinnest[line[coarse]]
            # the first and the last run of a line reach the ends of the window: they stay, however thin
            edge = np.diff(line) != 0
            resolved = np.append(True, edge) | np.append(edge, True) | (high - low >= thinnest)
            line, codes, low, high = line[resolved], codes[resolved], low[resolved], high[resolved]
            start, end = _runs(line, codes)
            line, codes, low, high = line[start], codes[start], low[start], high[end]
        first = np.flatnonzero(np.append(True, np.diff(line) != 0))
        columns = []
        for a, b in zip(first, np.append(first[1:], line.size), strict=True):
            column = Column(
                log_omega=float(self.points[line[a], 1]),
                below=high[a : b - 1],
                above=low[a + 1 : b],
                codes=codes[a:b].tolist(),
                bottom=float(low[a]),
                top=float(high[b - 1]),
                thinnest=float(self.thinnest[line[a]]),
            )
            columns.append(column)
        return columns


def _between(flags: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return True for the entries whose two neighbours are set."""
    between = np.zeros(flags.size, dtype=bool)
    between[1:-1] = flags[:-2] & flags[2:]
    return between


def _runs(line: Index, codes: Codes) -> tuple[Index, Index]:
    """Return the first and last index of each run of one outcome on one line."""
    edge = (np.diff(line) != 0) | (np.diff(codes) != 0)
    return np.flatnonzero(np.append(True, edge)), np.flatnonzero(np.append(edge, True))
