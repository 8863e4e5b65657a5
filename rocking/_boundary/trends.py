"""Compiled loops over the thresholds of two columns: which belong to one curve, how curves go on, where regions lie.

The trend of a threshold holds four numbers, all nan where unknown: the slope of the chord of the boundary curve that
ends there, the width of this chord in log omega, the second derivative of 1/a with respect to log omega from the last
two chords, and the width of both together. `TREND` numbers them.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rocking._numba.compilation import FloatArray, array_entry, array_kernel

SECANT, STEP, CURVATURE, SPAN = range(4)
"""Indices of the numbers of a trend."""

KNOWN, UNKNOWN, SINGLE = 0.02, 0.03, 0.5
"""Cost of a threshold without partner, per step in log omega, if the slope of its curve is known or not, and if both
columns have one threshold of its kind only [-]."""

NEAR = 0.3
"""Share of the distance to the next threshold up to which two thresholds can belong to one curve only [-]."""

IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]


@array_kernel
def end_slopes(trends: FloatArray, side: int) -> FloatArray:
    """Derivatives of 1/a with respect to log omega at thresholds (thresholds,); nan where unknown."""
    slopes = np.empty(len(trends))
    for m in range(len(trends)):
        slopes[m] = trends[m, SECANT]
        bend = (0.5 - side) * trends[m, STEP] * trends[m, CURVATURE]
        if not math.isnan(bend):
            slopes[m] += bend
    return slopes


@array_kernel
def _distances_to_next(x: FloatArray) -> FloatArray:
    """Distance of each threshold from the nearest other one of its column."""
    nearest = np.full(x.size, np.inf)
    for m in range(x.size - 1):
        gap = x[m + 1] - x[m]
        nearest[m] = min(nearest[m], gap)
        nearest[m + 1] = gap
    return nearest


@array_kernel
def _interpolate(at: float, x: FloatArray, y: FloatArray) -> Any:
    """Linear interpolation, constant beyond the ends."""
    if at <= x[0]:
        return y[0]
    for m in range(1, x.size):
        if at <= x[m]:
            return y[m - 1] + (at - x[m - 1]) * ((y[m] - y[m - 1]) / (x[m] - x[m - 1]))
    return y[-1]


@array_kernel
def _filled(x: FloatArray, slopes: FloatArray) -> FloatArray:
    """Slopes, the unknown ones interpolated between those of the curves beside them."""
    known = ~np.isnan(slopes)
    if not known.any() or known.all():
        return slopes
    places, values = x[known], slopes[known]
    filled = slopes.copy()
    for m in range(x.size):
        if not known[m]:
            filled[m] = _interpolate(x[m], places, values)
    return filled


@array_kernel
def _distance(x: float, y: float, slope: float, other: float, step: float, known: bool) -> float:
    """Distance of two thresholds, one of them moved along its slope, the nearer way; nan slopes do not count."""
    moved = abs(x + slope * step - y)
    back = abs(y - other * step - x)
    if math.isnan(moved) or back < moved:
        moved = back
    if not known:
        straight = abs(x - y)
        if math.isnan(moved) or straight < moved:
            moved = straight
    return moved


@array_kernel
def _kinds(codes: IntArray) -> IntArray:
    """A number for the two regions that each threshold separates."""
    return 4096 * codes[:-1] + codes[1:]


@array_kernel
def _costs_alone(kinds: IntArray, others: IntArray, codes: IntArray, many: int, known: BoolArray) -> FloatArray:
    """Cost of each threshold of a column without partner, per step in log omega."""
    costs = np.empty(kinds.size)
    for m in range(kinds.size):
        costs[m] = KNOWN if known[m] else UNKNOWN
        once = (kinds == kinds[m]).sum() == 1 and (others == kinds[m]).sum() == 1
        if once and codes[m] != many and codes[m + 1] != many:
            costs[m] = SINGLE
    return costs


@array_entry
def match_trends(
    x: FloatArray,
    y: FloatArray,
    codes: IntArray,
    other_codes: IntArray,
    many: int,
    trends: FloatArray,
    other_trends: FloatArray,
    step: float,
) -> IntArray:
    """Pairs of thresholds (pairs, 2) that belong to one curve, in order: the cheapest choice, see `match_thresholds`.

    Parameters
    ----------
    x, y : float arrays (n,), (m,)
        1/a of the thresholds of the left and of the right column, ascending [-].
    codes, other_codes : int arrays (n + 1,), (m + 1,)
        Region codes of both columns.
    many : int
        The region code of overturning after many impacts.
    trends, other_trends : float arrays (n, 4), (m, 4)
        Trends of the thresholds, those of the left column from the left and those of the right column from the right.
    step : float
        Distance of the columns in log omega [-].
    """
    kinds, others = _kinds(codes), _kinds(other_codes)
    slopes, other_slopes = end_slopes(trends, 0), end_slopes(other_trends, 1)
    known, others_known = ~np.isnan(slopes), ~np.isnan(other_slopes)
    least, others_least = _distances_to_next(x), _distances_to_next(y)
    n, m = x.size, y.size
    if n == m and (codes == other_codes).all():
        equal = True
        for i in range(n):
            moved = _distance(x[i], y[i], slopes[i], other_slopes[i], step, True)
            if math.isnan(moved):
                moved = abs(x[i] - y[i])
            equal &= moved <= KNOWN * step or moved < NEAR * min(least[i], others_least[i])
        if equal:
            pairs = np.empty((n, 2), dtype=np.int64)
            for i in range(n):
                pairs[i] = i
            return pairs
    filled, others_filled = _filled(x, slopes), _filled(y, other_slopes)
    alone = _costs_alone(kinds, others, codes, many, known) * step
    others_alone = _costs_alone(others, kinds, other_codes, many, others_known) * step
    distance = np.empty((n, m))
    for i in range(n):
        for j in range(m):
            moved = _distance(x[i], y[j], filled[i], others_filled[j], step, known[i] or others_known[j])
            # however curved: no other curve is in question
            distance[i, j] = 0.0 if moved < NEAR * min(least[i], others_least[j]) else moved
    first, last, other = 0, n, m
    while first < min(last, other) and kinds[first] == others[first] and distance[first, first] == 0.0:
        first += 1
    while min(last, other) > first and kinds[last - 1] == others[other - 1] and distance[last - 1, other - 1] == 0.0:
        last, other = last - 1, other - 1

    cost = np.zeros((last - first + 1, other - first + 1))
    for j in range(first, other):
        cost[0, j - first + 1] = cost[0, j - first] + others_alone[j]
    for i in range(first, last):
        row, above = cost[i - first + 1], cost[i - first]
        row[0] = above[0] + alone[i]
        for j in range(first, other):
            found = min(above[j - first + 1] + alone[i], row[j - first] + others_alone[j])
            if kinds[i] == others[j]:
                found = min(found, above[j - first] + distance[i, j])
            row[j - first + 1] = found
    reverse = np.empty((min(n, m), 2), dtype=np.int64)
    count = 0
    for k in range(n - last):
        reverse[count, 0], reverse[count, 1] = n - 1 - k, m - 1 - k
        count += 1
    while last > first and other > first:
        here = cost[last - first, other - first]
        if here == cost[last - first - 1, other - first] + alone[last - 1]:
            last -= 1
        elif here == cost[last - first, other - first - 1] + others_alone[other - 1]:
            other -= 1
        else:
            last, other = last - 1, other - 1
            reverse[count, 0], reverse[count, 1] = last, other
            count += 1
    for k in range(first):
        reverse[count] = first - 1 - k
        count += 1
    return reverse[:count][::-1].copy()


@array_entry
def learn_trends(
    pairs: IntArray,
    x: FloatArray,
    y: FloatArray,
    before: FloatArray,
    left: FloatArray,
    right: FloatArray,
    after: FloatArray,
    step: float,
) -> None:
    """Note at both ends of the chords between matched thresholds how the curves go there.

    Parameters
    ----------
    pairs : int array (pairs, 2)
        Matched thresholds of the left and of the right column.
    x, y : float arrays (n,), (m,)
        1/a of the thresholds of both columns [-].
    before, left : float arrays (n, 4)
        Trends of the left column, from the left, and, to be filled, from the right.
    right, after : float arrays (m, 4)
        Trends of the right column: to be filled, from the left, and from the right.
    step : float
        Distance of the columns in log omega [-].
    """
    for k in range(len(pairs)):
        m, n = pairs[k, 0], pairs[k, 1]
        secant = (y[n] - x[m]) / step
        for own, other, sign in ((right[n], before[m], 2.0), (left[m], after[n], -2.0)):
            own[SECANT], own[STEP], own[SPAN] = secant, step, step + other[STEP]
            own[CURVATURE] = sign * (secant - other[SECANT]) / own[SPAN]


@array_entry
def follow_trends(
    below: FloatArray,
    above: FloatArray,
    inner: IntArray,
    trends: FloatArray,
    side: int,
    step: float,
    at: FloatArray,
    shift: FloatArray,
) -> FloatArray:
    """Where the regions above some thresholds lie one step further: see `courses_of`.

    Parameters
    ----------
    below, above : float arrays (n,)
        1/a where the region below a threshold ends and where the one above it begins [-].
    inner : int array (regions,)
        The thresholds.
    trends : float array (n, 4)
        Trends of the thresholds of the column, known from one side.
    side : int
        That side: 0 for the left one.
    step : float
        In log omega [-].
    at, shift : float arrays (k,)
        Ascending 1/a, and by how much curves there move: it counts where slopes are not known [-].

    Returns
    -------
    float array (3, regions)
        1/a halfway through each region, its least width, and how far from there it may lie [-].
    """
    slopes = end_slopes(trends, side)
    found = np.empty((3, inner.size))
    for k in range(inner.size):
        m = inner[k]
        low, high = above[m], below[m + 1]
        middle, width = 0.5 * (low + high), high - low
        straight = 0.5 * (slopes[m] + slopes[m + 1]) * step
        bend = 0.25 * (trends[m, CURVATURE] + trends[m + 1, CURVATURE]) * step * step
        beside, nearby = 0.0, 0.1 * abs(step)
        if at.size:
            beside = _interpolate(middle, at, shift)
            nearby = 0.5 * abs(_interpolate(high, at, shift) - beside) + 0.3 * abs(beside)
        narrow = width
        if math.isnan(straight):
            moved, error = beside, nearby
        else:
            narrow = min(max(width + (slopes[m + 1] - slopes[m]) * step, 0.1 * width), width)
            if math.isnan(bend):
                moved, error = straight, max(0.2 * abs(beside - straight), 0.02 * abs(straight))
            else:
                moved, error = straight + bend, 0.5 * abs(bend)
        found[0, k] = middle + moved
        found[1, k] = narrow
        found[2, k] = max(1.5 * width, 2.0 * error)
    return found


def load_entries() -> None:
    """Load the compiled loops from the cache, or compile them, by a small call of each."""
    x, codes, trends = np.array([0.5]), np.zeros(2, dtype=np.int64), np.full((1, 4), np.nan)
    pairs = match_trends(x, x, codes, codes, 1, trends, trends, 0.1)
    learn_trends(pairs, x, x, trends, trends.copy(), trends.copy(), trends, 0.1)
    follow_trends(x, x, np.empty(0, dtype=np.int64), trends, 0, 0.1, np.empty(0), np.empty(0))
