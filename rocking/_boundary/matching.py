"""Matching of the thresholds of two neighbouring columns that lie on one boundary curve, and trends of the curves.

The trend of a threshold holds four numbers, all nan where unknown: the slope of the chord of the boundary curve that
ends there, the width of this chord in log omega, the second derivative of 1/a with respect to log omega from the last
two chords, and the width of both together. `SECANT` to `SPAN` number them. The loops over thresholds are compiled.
"""

import math
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rocking._boundary.columns import Column
from rocking._boundary.search import UNCOUNTED
from rocking._model.outcome import SURVIVES
from rocking._numba.compilation import FloatArray, array_entry, array_kernel

SECANT, STEP, CURVATURE, SPAN = range(4)  # indices of the numbers of a trend

KNOWN, UNKNOWN, SINGLE = 0.02, 0.03, 0.5
"""Cost of a threshold without partner, per step in log omega, if the slope of its curve is known or not, and if both
columns have one threshold of its kind only [-]."""

NEAR = 0.3  # two thresholds this share of the distance to the next one apart can belong to one curve only [-]

PAIR, LEFT_ALONE, RIGHT_ALONE = range(3)
"""Choices for the next thresholds of two columns: they belong to one curve, or one of them has no partner."""

STRAIGHT = 0.05
"""Two chords between equal regions belong to one curve if their slopes differ by less than this [-]."""

IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]

Pairs = NDArray[np.int64]  # indices (pairs, 2) of thresholds in a left and in a right column

Side = tuple[Column, int, int]
"""A column, a threshold of it, and the region beside that: 0 for the one below, 1 for the one above."""


@array_kernel
def end_slopes(trends: FloatArray, side: int) -> FloatArray:
    """Return the derivatives of 1/a with respect to log omega at thresholds (thresholds,); nan where unknown."""
    slopes = np.empty(len(trends))
    for m in range(len(trends)):
        slopes[m] = trends[m, SECANT]
        # the secant is the slope at the middle of the chord: on by half a chord, to the threshold
        bend = (0.5 - side) * trends[m, STEP] * trends[m, CURVATURE]
        if not math.isnan(bend):
            slopes[m] += bend
    return slopes


@array_kernel
def _distances_to_next(x: FloatArray) -> FloatArray:
    """Return the distance of each threshold from the nearest other one of its column."""
    nearest = np.full(x.size, np.inf)
    for m in range(x.size - 1):
        gap = x[m + 1] - x[m]
        nearest[m] = min(nearest[m], gap)
        nearest[m + 1] = gap
    return nearest


@array_kernel
def _interpolate(position: float, x: FloatArray, y: FloatArray) -> Any:
    """Interpolate linearly, constant beyond the ends."""
    if position <= x[0]:
        return y[0]
    for m in range(1, x.size):
        if position <= x[m]:
            return y[m - 1] + (position - x[m - 1]) * ((y[m] - y[m - 1]) / (x[m] - x[m - 1]))
    return y[-1]


@array_kernel
def _filled(x: FloatArray, slopes: FloatArray) -> FloatArray:
    """Return slopes; unknown ones are interpolated between the curves beside them."""
    is_known = ~np.isnan(slopes)
    if not is_known.any() or is_known.all():
        return slopes
    positions, values = x[is_known], slopes[is_known]
    filled = slopes.copy()
    for m in range(x.size):
        if not is_known[m]:
            filled[m] = _interpolate(x[m], positions, values)
    return filled


@array_kernel
def _distance(x: float, y: float, slope: float, other_slope: float, step: float, slope_known: bool) -> float:
    """Return the smallest distance of two thresholds, one moved along its slope; a nan slope does not count."""
    moved = abs(x + slope * step - y)
    back = abs(y - other_slope * step - x)
    if math.isnan(moved) or back < moved:
        moved = back
    if not slope_known:
        straight = abs(x - y)
        if math.isnan(moved) or straight < moved:
            moved = straight
    return moved


@array_kernel
def _kinds(codes: IntArray) -> IntArray:
    """Return a number for the two regions that each threshold separates."""
    return 4096 * codes[:-1] + codes[1:]


@array_kernel
def _costs_alone(
    kinds: IntArray, other_kinds: IntArray, codes: IntArray, many: int, slope_known: BoolArray
) -> FloatArray:
    """Return the cost of each threshold of a column without partner, per step in log omega."""
    costs = np.empty(kinds.size)
    for m in range(kinds.size):
        costs[m] = KNOWN if slope_known[m] else UNKNOWN
        once = (kinds == kinds[m]).sum() == 1 and (other_kinds == kinds[m]).sum() == 1
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
    """Pair the thresholds (pairs, 2) that belong to one curve, in order: the cheapest choice, see `match_thresholds`.

    Curves do not cross, so that pairs keep the order of both columns. No choice is missed: `cost` holds the least cost
    of all of them, from the last thresholds to the first.

    `x` (n,), `y` (m,): 1/a of the thresholds of the left and the right column, ascending; `codes` (n + 1,),
    `other_codes` (m + 1,): region codes, `many` for many impacts; `trends` (n, 4), `other_trends` (m, 4): from the
    left, and from the right; `step`: distance of the columns in log omega [-].
    """
    kinds, other_kinds = _kinds(codes), _kinds(other_codes)
    slopes, other_slopes = end_slopes(trends, 0), end_slopes(other_trends, 1)
    slope_known, other_known = ~np.isnan(slopes), ~np.isnan(other_slopes)
    gaps, other_gaps = _distances_to_next(x), _distances_to_next(y)
    n, m = x.size, y.size
    filled, other_filled = _filled(x, slopes), _filled(y, other_slopes)
    alone = _costs_alone(kinds, other_kinds, codes, many, slope_known) * step
    other_alone = _costs_alone(other_kinds, kinds, other_codes, many, other_known) * step
    distance = np.empty((n, m))
    for i in range(n):
        for j in range(m):
            moved = _distance(x[i], y[j], filled[i], other_filled[j], step, slope_known[i] or other_known[j])
            # much nearer to each other than to any other threshold: one curve, however it bends
            distance[i, j] = 0.0 if moved < NEAR * min(gaps[i], other_gaps[j]) else moved
    # cost[i, j]: the least cost of the thresholds from i and from j on; choices[i, j]: what the first of them do for it
    cost, choices = np.zeros((n + 1, m + 1)), np.zeros((n + 1, m + 1), dtype=np.int8)
    for i in range(n, -1, -1):
        for j in range(m, -1, -1):
            if i == n and j == m:
                continue
            least, choice = np.inf, PAIR
            # only thresholds between the same two regions can lie on one curve
            if i < n and j < m and kinds[i] == other_kinds[j]:
                least = cost[i + 1, j + 1] + distance[i, j]
            if i < n and cost[i + 1, j] + alone[i] < least:
                least, choice = cost[i + 1, j] + alone[i], LEFT_ALONE
            if j < m and cost[i, j + 1] + other_alone[j] < least:
                least, choice = cost[i, j + 1] + other_alone[j], RIGHT_ALONE
            cost[i, j], choices[i, j] = least, choice
    # follow the cheapest choices from the first thresholds on
    pairs = np.empty((min(n, m), 2), dtype=np.int64)
    i = j = count = 0
    while i < n or j < m:
        choice = choices[i, j]
        if choice == PAIR:
            pairs[count, 0], pairs[count, 1] = i, j
            count += 1
        i, j = i + (choice != RIGHT_ALONE), j + (choice != LEFT_ALONE)
    return pairs[:count].copy()


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

    `pairs` (pairs, 2), `x` (n,), `y` (m,) and `step` as for `match_trends`. `before` (n, 4) holds the trends of the
    left column from the left, `after` (m, 4) those of the right column from the right; `left` and `right`, of the same
    shapes, are filled with those from the other side.
    """
    for k in range(len(pairs)):
        m, n = pairs[k, 0], pairs[k, 1]
        secant = (y[n] - x[m]) / step
        # the right threshold learns the chord to its left, and the left one that to its right; the second derivative
        # is the change of the secants between the middles of two chords
        for trend, previous, sign in ((right[n], before[m], 2.0), (left[m], after[n], -2.0)):
            trend[SECANT], trend[STEP], trend[SPAN] = secant, step, step + previous[STEP]
            trend[CURVATURE] = sign * (secant - previous[SECANT]) / trend[SPAN]


@array_entry
def follow_trends(
    below: FloatArray,
    above: FloatArray,
    inner: IntArray,
    trends: FloatArray,
    side: int,
    step: float,
    positions: FloatArray,
    shifts: FloatArray,
) -> FloatArray:
    """Predict where the regions above some thresholds lie one step further: see `courses_of`.

    `below`, `above` (n,), `trends` (n, 4): of the thresholds of the column, as in `Column`, from the side `side`; the
    others as there. Returns an array (3, regions): 1/a halfway through each region, its least width, and how far from
    there it may lie [-].
    """
    slopes = end_slopes(trends, side)
    courses = np.empty((3, inner.size))
    for k in range(inner.size):
        m = inner[k]
        low, high = above[m], below[m + 1]
        middle, width = 0.5 * (low + high), high - low
        straight = 0.5 * (slopes[m] + slopes[m + 1]) * step
        bend = 0.25 * (trends[m, CURVATURE] + trends[m + 1, CURVATURE]) * step * step
        # where slopes are not known the region moves as the matched curves around it do
        beside, nearby = 0.0, 0.1 * abs(step)
        if positions.size:
            beside = _interpolate(middle, positions, shifts)
            nearby = 0.5 * abs(_interpolate(high, positions, shifts) - beside) + 0.3 * abs(beside)
        narrow = width
        if math.isnan(straight):
            moved, error = beside, nearby
        else:
            # one chord is known on either side, and perhaps the curvature: the error falls with what is known
            narrow = min(max(width + (slopes[m + 1] - slopes[m]) * step, 0.1 * width), width)
            if math.isnan(bend):
                moved, error = straight, max(0.2 * abs(beside - straight), 0.02 * abs(straight))
            else:
                moved, error = straight + bend, 0.5 * abs(bend)
        courses[0, k] = middle + moved
        courses[1, k] = narrow
        courses[2, k] = max(1.5 * width, 2.0 * error)
    return courses


def match_thresholds(left: Column, right: Column) -> Pairs:
    """Pair the thresholds that separate equal regions and lie where the slopes of the curves lead, in order.

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
        column.trends[side, straight, SECANT] = secants[k][straight]
        column.trends[side, straight, STEP] = steps[k]


def join_sides(left: Column, right: Column) -> list[tuple[Side, Side]]:
    """Join the outlines of overturning regions between two columns that differ and are very near to each other.

    The sides of one region are its lower and upper ends in turn. Each is joined to an end of the same kind in the
    other column, or to the next end in its own column, where the region, or the gap in it, ends; the total length of
    all joins is smallest.
    """
    codes = sorted({*left.codes, *right.codes} - {SURVIVES})
    joins = []
    for code in codes:
        joins += _shortest(_sides_of(left, code), _sides_of(right, code))
    return joins


def _sides_of(column: Column, code: int) -> list[Side]:
    """Return the ends of the regions of one code, ascending."""
    sides: list[Side] = []
    for m, kind in enumerate(pairwise(column.codes)):
        sides += [(column, m, side) for side in (0, 1) if kind[side] == code]
    return sides


def _position(side: Side) -> float:
    column, m, above = side
    return float(column.above[m] if above else column.below[m])


def _shortest(a: list[Side], b: list[Side]) -> list[tuple[Side, Side]]:
    """Return the joins of smallest total length between the sides of one region in two columns.

    The ends are taken in order from below: two of equal kind in both columns are joined, or two neighbours in one
    column, between which the region or its gap ends. `cost[i][j]` is the least length for the first i and j of them.
    """
    x, y = [*map(_position, a)], [*map(_position, b)]
    n, m = len(a), len(b)
    worst = float("inf")
    cost = [[worst] * (m + 1) for _ in range(n + 1)]
    way: list[list[int]] = [[0] * (m + 1) for _ in range(n + 1)]
    cost[0][0] = 0.0
    for i in range(n + 1):
        for j in range(m + 1):
            options = [(cost[i][j], 0)]
            if i and j and a[i - 1][2] == b[j - 1][2]:
                options.append((cost[i - 1][j - 1] + abs(x[i - 1] - y[j - 1]), 1))
            if i > 1:
                options.append((cost[i - 2][j] + x[i - 1] - x[i - 2], 2))
            if j > 1:
                options.append((cost[i][j - 2] + y[j - 1] - y[j - 2], 3))
            cost[i][j], way[i][j] = min(options)
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


def load_entries() -> None:
    """Load the compiled loops from the cache, or compile them, by a small call of each."""
    x, codes, trends = np.array([0.5]), np.zeros(2, dtype=np.int64), np.full((1, 4), np.nan)
    pairs = match_trends(x, x, codes, codes, 1, trends, trends, 0.1)
    learn_trends(pairs, x, x, trends, trends.copy(), trends.copy(), trends, 0.1)
    follow_trends(x, x, np.empty(0, dtype=np.int64), trends, 0, 0.1, np.empty(0), np.empty(0))
