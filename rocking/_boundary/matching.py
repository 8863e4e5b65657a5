"""Which thresholds of two neighbouring columns lie on one boundary curve."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from rocking._boundary.columns import Column
from rocking._boundary.search import UNCOUNTED
from rocking._boundary.trends import SECANT, STEP, learn_trends, match_trends

STRAIGHT = 0.05
"""Difference of the slopes of two chords up to which they belong to one curve, the regions being equal [-]."""

Pairs = NDArray[np.int64]
"""Indices (pairs, 2) of thresholds in a left and in a right column."""

Side = tuple[Column, int, int]
"""A column, a threshold of it, and the region beside that: 0 for the one below, 1 for the one above."""


def match_thresholds(left: Column, right: Column) -> Pairs:
    """Pairs of thresholds that separate equal regions and lie where the slopes of the curves lead, in order.

    The cheapest choice: a pair costs the distance between the two, one moved along its slope; a threshold without
    partner costs a share of the step, a small one if its slope is known. A pair much nearer to each other than to all
    other thresholds costs nothing.
    """
    pairs: Pairs = match_trends(
        left.middle,
        right.middle,
        left.regions,
        right.regions,
        UNCOUNTED,
        left.trends[0],
        right.trends[1],
        right.log_omega - left.log_omega,
    )
    return pairs


def learn_slopes(left: Column, right: Column, pairs: Pairs) -> None:
    """Note at both ends of the chords between matched thresholds how the curves go there."""
    step = right.log_omega - left.log_omega
    learn_trends(pairs, left.middle, right.middle, *left.trends, *right.trends, step)


def learn_smooth_slopes(columns: tuple[Column, Column, Column]) -> None:
    """Note the slopes of curves that go straight through three columns of equal regions."""
    left, middle, right = columns
    if not left.codes == middle.codes == right.codes:
        return
    steps = middle.log_omega - left.log_omega, right.log_omega - middle.log_omega
    secants = (middle.middle - left.middle) / steps[0], (right.middle - middle.middle) / steps[1]
    straight = np.abs(secants[1] - secants[0]) < STRAIGHT
    for column, side, k in ((left, 1, 0), (middle, 0, 0), (middle, 1, 1), (right, 0, 1)):
        column.trends[side, straight, SECANT], column.trends[side, straight, STEP] = secants[k][straight], steps[k]


def join_sides(left: Column, right: Column) -> list[tuple[Side, Side]]:
    """How the outlines of overturning regions go on between two columns that differ, and are very near to each other.

    The sides of one region are its lower and upper ends in turn. Each is joined to an end of the same kind in the
    other column, or to the next end in its own column, where the region, or the gap in it, ends; the total length of
    all joins is smallest.
    """
    joined = []
    for code in sorted({*left.codes, *right.codes} - {0}):
        a, b = _sides_of(left, code), _sides_of(right, code)
        joined += _shortest(a, b)
    return joined


def _sides_of(column: Column, code: int) -> list[Side]:
    """The ends of the regions of one code, ascending."""
    sides: list[Side] = []
    for m, kind in enumerate(pairwise(column.codes)):
        sides += [(column, m, side) for side in (0, 1) if kind[side] == code]
    return sides


def _position(side: Side) -> float:
    column, m, above = side
    return float(column.above[m] if above else column.below[m])


def _shortest(a: list[Side], b: list[Side]) -> list[tuple[Side, Side]]:
    """The joins of smallest total length between the sides of one region in two columns."""
    x, y = [*map(_position, a)], [*map(_position, b)]
    n, m = len(a), len(b)
    worst = float("inf")
    cost = [[worst] * (m + 1) for _ in range(n + 1)]
    way: list[list[int]] = [[0] * (m + 1) for _ in range(n + 1)]
    cost[0][0] = 0.0
    for i in range(n + 1):
        for j in range(m + 1):
            options = [
                (cost[i - 1][j - 1] + abs(x[i - 1] - y[j - 1]), 1)
                if i and j and a[i - 1][2] == b[j - 1][2]
                else (worst, 1),
                (cost[i - 2][j] + x[i - 1] - x[i - 2], 2) if i > 1 else (worst, 2),
                (cost[i][j - 2] + y[j - 1] - y[j - 2], 3) if j > 1 else (worst, 3),
            ]
            found = min(options)
            if found[0] < cost[i][j]:
                cost[i][j], way[i][j] = found
    joins: list[tuple[Side, Side]] = []
    while n or m:
        if way[n][m] == 1:
            n, m = n - 1, m - 1
            joins.append((a[n], b[m]))
        elif way[n][m] == 2:
            joins.append((a[n - 2], a[n - 1]))
            n -= 2
        elif way[n][m] == 3:
            joins.append((b[m - 2], b[m - 1]))
            m -= 2
        else:
            break  # an end without partner: the window's edge cuts the region
    return joins
