"""Joins between the regions of neighbouring columns, put in order: one chain of points for each boundary curve."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, fields, replace

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
    # own, neighbour: region codes of the region and of its neighbour
    own: Codes
    neighbour: Codes
    side: NDArray[np.int64]  # 1 where the region lies at larger 1/a than its neighbour, else 0
    width: Floats  # of the region there along 1/a [-]

    def take(self, index: Index) -> Chains:
        """The points of some indices."""
        return Chains(*(getattr(self, each.name)[index] for each in fields(self)))

    def insert(self, before: Index, points: Chains) -> Chains:
        """With further points, each before the one of its index."""
        return Chains(
            *(np.insert(getattr(self, each.name), before, getattr(points, each.name)) for each in fields(self))
        )

    def divide(self, before: Index) -> Chains:
        """With new chains that begin at some points."""
        starts = np.diff(self.chain, prepend=-1) != 0
        starts[before] = True
        return replace(self, chain=np.cumsum(starts) - 1)

    def without_points(self) -> Chains:
        """Without the chains of one point."""
        chains = self.take(np.flatnonzero(np.bincount(self.chain)[self.chain] > 1))
        return chains.divide(np.empty(0, dtype=np.intp))


def chains_of(joins: Iterable[tuple[Side, Side]]) -> Chains:
    """Follow the joins from end to end; a closed chain ends with the point it begins with.

    Regions that lie on a single line are left out.
    """
    # a point is an end of a region in a whole column: parts of one column have it in common
    number: dict[tuple[int, int, int], int] = {}
    points: list[tuple[float, float, int, int, int, float]] = []
    beside: list[list[int]] = []
    for join in joins:
        ends = []
        for column, m, side in join:
            key = id(column.whole), column.offset + m, side
            if key not in number:
                number[key] = len(points)
                points.append(_point(column.whole, column.offset + m, side))
                beside.append([])
            ends.append(number[key])
        beside[ends[0]].append(ends[1])
        beside[ends[1]].append(ends[0])

    order: list[int] = []
    sizes: list[int] = []
    seen = [False] * len(points)
    # open chains begin at a point with one join; what is left after them is closed
    for start in [*(k for k, near in enumerate(beside) if len(near) == 1), *range(len(points))]:
        if seen[start]:
            continue
        chain, here = [start], start
        seen[start] = True
        while True:
            further = [k for k in beside[here] if not seen[k]]
            if not further:
                break
            here = further[0]
            seen[here] = True
            chain.append(here)
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
        own=table[2].astype(np.int64),
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
