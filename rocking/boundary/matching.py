"""Which thresholds of two neighbouring columns lie on one boundary curve."""

from __future__ import annotations

import numpy as np

from rocking.boundary.columns import Column
from rocking.boundary.search import UNCOUNTED, Floats

KNOWN, UNKNOWN, SINGLE = 0.02, 0.03, 0.5
"""Cost of a threshold without partner, per step in log omega, if the slope of its curve is known or not, and if both
columns have one threshold of its kind only [-]."""

NEAR = 0.3
"""Share of the distance to the next threshold up to which two thresholds can belong to one curve only [-]."""

STRAIGHT = 0.05
"""Difference of the slopes of two chords up to which they belong to one curve, the regions being equal [-]."""

Pairs = list[tuple[int, int]]
Side = tuple[Column, int, int]
"""A column, a threshold of it, and the region beside that: 0 for the one below, 1 for the one above."""


def match_thresholds(left: Column, right: Column) -> Pairs:
    """Pairs of thresholds that separate equal regions and lie where the slopes of the curves lead, in order.

    The cheapest choice: a pair costs the distance between the two, one moved along its slope; a threshold without
    partner costs a share of the step, a small one if its slope is known. A pair much nearer to each other than to all
    other thresholds costs nothing.
    """
    step = right.log_omega - left.log_omega
    x, y = left.middle, right.middle
    slopes = left.slope(0), right.slope(1)
    known = np.isfinite(slopes[0]), np.isfinite(slopes[1])
    least = _distance_to_next(x), _distance_to_next(y)
    if left.codes == right.codes:
        moved = np.fmin(np.abs(x + slopes[0] * step - y), np.abs(y - slopes[1] * step - x))
        moved = np.where(known[0] | known[1], moved, np.abs(x - y))
        if ((moved <= KNOWN * step) | (moved < NEAR * np.minimum(*least))).all():
            return [(m, m) for m in range(x.size)]
    slopes = _filled(x, slopes[0]), _filled(y, slopes[1])
    kinds = left.kinds, right.kinds
    single = {
        kind for kind in {*kinds[0]} if kinds[0].count(kind) == kinds[1].count(kind) == 1 and UNCOUNTED not in kind
    }
    alone = [
        np.where([kind in single for kind in each], SINGLE, np.where(sure, KNOWN, UNKNOWN)) * step
        for each, sure in zip(kinds, known, strict=True)
    ]
    distance = np.fmin(
        np.abs((x + slopes[0] * step)[:, None] - y),
        np.abs(x[:, None] - (y - slopes[1] * step)),
    )
    distance = np.where(known[0][:, None] | known[1], distance, np.fmin(distance, np.abs(x[:, None] - y)))
    near = distance < NEAR * np.minimum(least[0][:, None], least[1])
    distance[near] = 0.0  # however curved: no other curve is in question
    first, last, other = 0, len(x), len(y)
    while first < min(last, other) and kinds[0][first] == kinds[1][first] and near[first, first]:
        first += 1
    while min(last, other) > first and kinds[0][last - 1] == kinds[1][other - 1] and near[last - 1, other - 1]:
        last, other = last - 1, other - 1
    inner = _cheapest_match(
        kinds[0][first:last],
        kinds[1][first:other],
        distance[first:last, first:other].tolist(),
        alone[0][first:last].tolist(),
        alone[1][first:other].tolist(),
    )
    return [
        *((m, m) for m in range(first)),
        *((first + m, first + n) for m, n in inner),
        *((last + k, other + k) for k in range(len(x) - last)),
    ]


def _filled(x: Floats, slope: Floats) -> Floats:
    """Slopes, the unknown ones interpolated between those of the curves beside them."""
    known = np.isfinite(slope)
    return np.interp(x, x[known], slope[known]) if known.any() else slope


def learn_slopes(left: Column, right: Column, pairs: Pairs) -> None:
    """Note at both ends of the chords between matched thresholds how the curves go there."""
    if not pairs:
        return
    m, n = np.array(pairs).T
    step = right.log_omega - left.log_omega
    secant = (right.middle[n] - left.middle[m]) / step
    for side, column, k, other, j, sign in ((0, right, n, left, m, 1.0), (1, left, m, right, n, -1.0)):
        column.secant[side, k], column.step[side, k] = secant, step
        column.curvature[side, k] = sign * 2.0 * (secant - other.secant[side, j]) / (step + other.step[side, j])


def learn_smooth_slopes(columns: tuple[Column, Column, Column]) -> None:
    """Note the slopes of curves that go straight through three columns of equal regions."""
    left, middle, right = columns
    if not left.codes == middle.codes == right.codes:
        return
    steps = middle.log_omega - left.log_omega, right.log_omega - middle.log_omega
    secants = (middle.middle - left.middle) / steps[0], (right.middle - middle.middle) / steps[1]
    straight = np.abs(secants[1] - secants[0]) < STRAIGHT
    for column, side, k in ((left, 1, 0), (middle, 0, 0), (middle, 1, 1), (right, 0, 1)):
        column.secant[side, straight], column.step[side, straight] = secants[k][straight], steps[k]


def _distance_to_next(x: Floats) -> Floats:
    """Distance of each threshold from the nearest other one of its column."""
    gap = np.full(x.size + 1, np.inf)
    gap[1:-1] = x[1:] - x[:-1]
    nearest: Floats = np.minimum(gap[:-1], gap[1:])
    return nearest


def _cheapest_match(
    kinds: list[tuple[int, int]],
    others: list[tuple[int, int]],
    distance: list[list[float]],
    alone: list[float],
    others_alone: list[float],
) -> Pairs:
    """The matching in order of two lists of kinds for which the sum of all costs is smallest."""
    n, m = len(kinds), len(others)
    if not n or not m:
        return []
    cost = [[0.0] * (m + 1) for _ in range(n + 1)]
    for j in range(m):
        cost[0][j + 1] = cost[0][j] + others_alone[j]
    for i in range(n):
        row, above = cost[i + 1], cost[i]
        row[0] = above[0] + alone[i]
        for j in range(m):
            found = min(above[j + 1] + alone[i], row[j] + others_alone[j])
            if kinds[i] == others[j]:
                found = min(found, above[j] + distance[i][j])
            row[j + 1] = found
    pairs: Pairs = []
    while n and m:
        here = cost[n][m]
        if here == cost[n - 1][m] + alone[n - 1]:
            n -= 1
        elif here == cost[n][m - 1] + others_alone[m - 1]:
            m -= 1
        else:
            n, m = n - 1, m - 1
            pairs.append((n, m))
    return pairs[::-1]


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
    for m, kind in enumerate(column.kinds):
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
