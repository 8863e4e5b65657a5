"""Chords of boundary curves, halved until their distance from the curves is small enough."""

import numpy as np
from numpy.typing import NDArray

from rocking._boundary.chains import Chains
from rocking._boundary.columns import THINNEST, Index
from rocking._boundary.search import ELASTIC_RESOLUTION, RESOLUTION, UNCOUNTED, Classify, Floats, refine_brackets

SCANS = np.linspace(-1.0, 1.0, 31)[10:21], np.linspace(-1.0, 1.0, 31)
"""Where a region is looked for at the middle of a chord: near it, then further away, as shares of the distance at
which it may lie [-]."""

WIDENINGS = 4  # times that the bracket of a curve is widened [-]

SURE = 0.5
"""A distance below this share of the largest one is not measured if the chords on both sides agree on it [-]."""

FINE = 0.02  # accuracy of a measured distance, as a share of the largest one [-]
HALVINGS = 12  # times that a chord is halved at most [-]


def refine_chords(
    chains: Chains, classify: Classify, block: tuple[Floats, Floats], *, largest: float, uncounted: float, end: float
) -> tuple[Chains, float, float, int]:
    """Halve chords until each passes its curve within a distance, measured at the middle of the chord.

    Regions of many impacts lie side by side with equal codes, and a chord can join two of them. Such a chord is taken
    out, since the curve is not found at its middle. `block`: eta and alpha of all curves, arrays without dimensions;
    `largest`: distance in the plane of 1/a and log omega [-], `uncounted` for regions of many impacts; `end`: width in
    log omega of the chords that end a region: not halved.

    Returns the curves, bounds of the largest distance of a chord from its curve, without regions of many impacts and
    for these, and the number of chords whose curve was not found at the middle.
    """
    error = uncounted_error = 0.0
    unknown = 0
    todo = np.ones(max(chains.chain.size - 1, 0), dtype=bool)
    for _ in range(HALVINGS):
        todo &= (
            (np.diff(chains.chain) == 0)
            & (np.abs(np.diff(chains.log_omega)) > 1.01 * end)
            & (np.diff(chains.side) == 0)
        )
        first = np.flatnonzero(todo)
        bend, spread = _bend(chains, first)
        # the chords before and after agree that this one is near its curve: no block is solved for it
        sure = (np.abs(bend) + spread < SURE * largest) & ~_uncounted(chains, first)
        error = (np.abs(bend) + spread)[sure].max(initial=error)
        first, bend = first[~sure], bend[~sure]
        if not first.size:
            break
        many = _uncounted(chains, first)
        most = np.where(many, uncounted, largest)
        middle, found, distance = _middles(chains, first, bend, most, classify, block)
        wrong = ~found & many
        unknown += int(np.sum(~found & ~wrong))
        chains = chains.divide(first[wrong] + 1)
        middle.chain = chains.chain[first]
        close = ~found | (distance <= most)
        error = distance[found & close & ~many].max(initial=error)
        uncounted_error = distance[found & close & many].max(initial=uncounted_error)
        # the point of the curve becomes a vertex, and both halves are looked at in the next round
        cut = first[~close]
        chains = chains.insert(cut + 1, middle.take(np.flatnonzero(~close)))
        todo = np.zeros(chains.chain.size - 1, dtype=bool)
        place = cut + np.arange(cut.size)
        todo[place] = todo[place + 1] = True
    return chains.without_points(), float(error), float(uncounted_error), unknown


def _uncounted(chains: Chains, first: Index) -> NDArray[np.bool_]:
    """Whether chords bound a region of many impacts."""
    return np.asarray(chains.own[first] == UNCOUNTED)


def _middles(
    chains: Chains, first: Index, bend: Floats, largest: Floats, classify: Classify, block: tuple[Floats, Floats]
) -> tuple[Chains, NDArray[np.bool_], Floats]:
    """Points of the curves halfway along some chords, whether they were found, and their distance from the chords.

    Where the distance is not larger than `largest`, it is a bound, and the point is not refined.
    """
    one, two = chains.take(first), chains.take(first + 1)
    y = 0.5 * (one.log_omega + two.log_omega)
    chord = 0.5 * (one.slenderness + two.slenderness)
    guess = chord + bend
    outward = np.where(one.side == 1, -1.0, 1.0)
    width = np.minimum(one.width, two.width)
    nearest = np.where((block[0] == 1.0) & (one.own == UNCOUNTED), ELASTIC_RESOLUTION, 1e-8)
    # a bracket around the predicted place, one end inside the region and one outside, widened until it holds the curve
    near = np.clip(0.3 * np.abs(bend), nearest, np.maximum(0.4 * width, nearest))
    ends, margins, met = np.empty((y.size, 2)), np.empty((y.size, 2)), np.empty(y.size, dtype=np.int64)
    found = np.zeros(y.size, dtype=bool)
    for _ in range(WIDENINGS):
        lost = np.flatnonzero(~found)
        if not lost.size:
            break
        reach = (outward * near)[lost, None] * [-1.0, 1.0]
        ends[lost] = guess[lost, None] + reach
        codes, margins[lost] = classify(ends[lost], y[lost, None], *block)
        met[lost] = codes[:, 1]
        found[lost] = (codes[:, 0] == one.own[lost]) & (codes[:, 1] != one.own[lost])
        near = np.minimum(8.0 * near, 0.4 * width)
    # where that fails, rows of points across the region, the second one over three times the distance
    for shares in SCANS:
        lost = np.flatnonzero(~found)
        if not lost.size:
            break
        reach = np.maximum(1.5 * width[lost], 3.0 * np.abs(bend[lost]))
        x = np.clip(guess[lost, None] + (outward[lost] * reach)[:, None] * shares, 1e-6, 1.0)
        codes, at = classify(x, y[lost, None], *block)
        k, found[lost] = _nearest_end(codes == one.own[lost, None])
        rows = np.arange(lost.size)
        ends[lost], margins[lost] = (np.stack([each[rows, k], each[rows, k + 1]], axis=1) for each in (x, at))
        met[lost] = codes[rows, k + 1]
    slope = (two.slenderness - one.slenderness) / (two.log_omega - one.log_omega)
    distance = np.abs(ends - chord[:, None]).max(axis=1) / np.hypot(1.0, slope)
    for resolution in (FINE * largest, np.full(y.size, RESOLUTION)):  # the second one for new vertices only
        k = np.flatnonzero(found & (distance > largest))
        points = np.stack(np.broadcast_arrays(chord[k], y[k], *block), axis=1)
        refined = refine_brackets(0, points, ends[k], margins[k], one.own[k], met[k], classify, resolution[k])
        ends[k], margins[k], met[k] = refined.ends, refined.margins, refined.met
        distance[k] = np.abs(ends[k] - chord[k, None]).max(axis=1) / np.hypot(1.0, slope[k])
    other = np.flatnonzero(found & (met != one.neighbour) & (met != two.neighbour))
    if other.size:  # another neighbour, unless it is too thin to be resolved
        beyond, _ = classify(ends[other, 0] + THINNEST * outward[other], y[other], *block)
        met[other] = np.where(beyond == one.own[other], met[other], beyond)
    middle = Chains(one.chain, ends[:, 0], y, one.own, met, one.side, width)
    return middle, found, distance


def _bend(chains: Chains, first: Index) -> tuple[Floats, Floats]:
    """Distance of a curve from the middle of a chord, by the chords before and after it, and how much these differ."""
    size = chains.chain.size
    x, y = chains.slenderness, chains.log_omega
    bends = np.full((2, first.size), np.nan)
    for row, (a, b, c) in enumerate(((first - 1, first, first + 1), (first + 2, first + 1, first))):
        inner = (a >= 0) & (a < size)
        end = np.clip(a, 0, size - 1)
        inner &= (chains.chain[end] == chains.chain[b]) & (chains.side[end] == chains.side[b])
        before, here = y[b] - y[end], y[c] - y[b]
        inner &= before * here > 0.0
        before = np.where(inner, before, 1.0)
        curvature = 2.0 * ((x[c] - x[b]) / here - (x[b] - x[end]) / before) / (here + before)
        bends[row] = np.where(inner, -0.125 * curvature * here * here, np.nan)
    known = np.isfinite(bends)
    bend = np.where(known, bends, 0.0).sum(axis=0) / np.maximum(known.sum(axis=0), 1)
    return bend, np.where(known.all(axis=0), np.abs(bends[0] - bends[1]), np.inf)


def _nearest_end(within: NDArray[np.bool_]) -> tuple[Index, NDArray[np.bool_]]:
    """The last point within a region nearest to the middle one of some points in a row, and whether there is one."""
    leaves = within[:, :-1] & ~within[:, 1:]
    distance = np.abs(np.arange(leaves.shape[1]) - leaves.shape[1] // 2)
    return np.argmin(np.where(leaves, distance, np.inf), axis=1), np.asarray(leaves.any(axis=1))
