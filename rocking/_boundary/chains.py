"""Joins between the regions of neighbouring columns, put in order: one chain of points for each boundary curve."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from rocking._boundary.columns import Column, Index
from rocking._boundary.matching import Side
from rocking._boundary.search import Codes, Floats


@dataclass(eq=False)
class Chains:
    """Points of the outlines of overturning regions, chain after chain; all arrays (points,)."""

    chain: Index  # number of the chain
    # slenderness, log_omega: the last point within the region along a line omega = const [-]
    slenderness: Floats
    log_omega: Floats
    # region, neighbour: region codes of the region and of its neighbour
    region: Codes
    neighbour: Codes
    side: NDArray[np.int64]  # 1 where the region lies at larger 1/a than its neighbour, else 0
    width: Floats  # of the region there along 1/a [-]

    def take(self, index: Index) -> Chains:
        """Return the points of some indices."""
        return Chains(**{name: values[index] for name, values in vars(self).items()})

    def insert(self, before: Index, points: Chains) -> Chains:
        """Insert points, each before the one of its index."""
        columns = {}
        for name, values in vars(self).items():
            columns[name] = np.insert(values, before, getattr(points, name))
        return Chains(**columns)

    def divide(self, before: Index) -> Chains:
        """Begin new chains at some points."""
        starts = np.diff(self.chain, prepend=-1) != 0
        starts[before] = True
        return replace(self, chain=np.cumsum(starts) - 1)

    def without_points(self) -> Chains:
        """Remove the chains of one point."""
        chains = self.take(np.flatnonzero(np.bincount(self.chain)[self.chain] > 1))
        return chains.divide(np.empty(0, dtype=np.intp))


def chains_of(joins: Iterable[tuple[Side, Side]]) -> Chains:
    """Follow the joins from end to end; a closed chain ends with the point it begins with.

    Regions that lie on a single line are left out.
    """
    # a point is an end of a region in the column of a line: parts of one column have it in common
    number: dict[tuple[int, int, int], int] = {}
    points: list[tuple[float, float, int, int, int, float]] = []
    beside: list[list[int]] = []
    for join in joins:
        ends = []
        for column, m, side in join:
            key = id(column.parent), column.offset + m, side
            if key not in number:
                number[key] = len(points)
                points.append(_point(column.parent, column.offset + m, side))
                beside.append([])
            ends.append(number[key])
        beside[ends[0]].append(ends[1])
        beside[ends[1]].append(ends[0])

    order: list[int] = []
    sizes: list[int] = []
    seen = [False] * len(points)
    # open chains begin at a point with one join; what is left after them is closed
    open_ends = [k for k, adjacent in enumerate(beside) if len(adjacent) == 1]
    for start in [*open_ends, *range(len(points))]:
        if seen[start]:
            continue
        chain, current = [start], start
        seen[start] = True
        while True:
            unseen = [k for k in beside[current] if not seen[k]]
            if not unseen:
                break
            current = unseen[0]
            seen[current] = True
            chain.append(current)
        if len(beside[start]) == 2:
            chain.append(start)
        if len({points[k][1] for k in chain}) == 1:
            continue  # seen on one line only: shorter than the distance within which ends are known
        order += chain
        sizes.append(len(chain))
    table = np.array([points[k] for k in order]).reshape(-1, 6).T
    return Chains(
        chain=np.repeat(np.arange(len(sizes)), sizes),
        slenderness=table[0],
        log_omega=table[1],
        region=table[2].astype(np.int64),
        neighbour=table[3].astype(np.int64),
        side=table[4].astype(np.int64),
        width=table[5],
    )


def _point(column: Column, m: int, side: int) -> tuple[float, float, int, int, int, float]:
    if side:
        top = column.below[m + 1] if m + 1 < column.below.size else column.top
        x, width = column.above[m], top - column.above[m]
    else:
        bottom = column.above[m - 1] if m else column.bottom
        x, width = column.below[m], column.below[m] - bottom
    return (
        float(x),
        column.log_omega,
        column.codes[m + side],
        column.codes[m + 1 - side],
        side,
        float(width),
    )
