"""Chords of boundary curves, halved until their distance from the curves is small enough."""

import numpy as np
from numpy.typing import NDArray

from rocking._boundary.chains import Chains
from rocking._boundary.columns import THINNEST, Index
from rocking._boundary.search import ELASTIC_RESOLUTION, RESOLUTION, UNCOUNTED, Classify, Floats, refine_brackets

SCANS = np.linspace(-1.0, 1.0, 31)[10:21], np.linspace(-1.0, 1.0, 31)
"""Points at which a region is looked for at the middle of a chord, as shares of the distance at which it may lie: near
it, then further away [-]."""

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
        allowed = np.where(many, uncounted, largest)
        middle, on_curve, distance = _middles(chains, first, bend, allowed, classify, block)
        wrong = ~on_curve & many
        unknown += int(np.sum(~on_curve & ~wrong))
        chains = chains.divide(first[wrong] + 1)
        middle.chain = chains.chain[first]
        close = ~on_curve | (distance <= allowed)
        error = distance[on_curve & close & ~many].max(initial=error)
        uncounted_error = distance[on_curve & close & many].max(initial=uncounted_error)
        # the point of the curve becomes a vertex, and both halves are looked at in the next round
        cut = first[~close]
        chains = chains.insert(cut + 1, middle.take(np.flatnonzero(~close)))
        todo = np.zeros(chains.chain.size - 1, dtype=bool)
        index = cut + np.arange(cut.size)
        todo[index] = todo[index + 1] = True
    return chains.without_points(), float(error), float(uncounted_error), unknown


def _uncounted(chains: Chains, first: Index) -> NDArray[np.bool_]:
    """Return True for chords that bound a region of many impacts."""
    return np.asarray(chains.region[first] == UNCOUNTED)


def _middles(
    chains: Chains, first: Index, bend: Floats, largest: Floats, classify: Classify, block: tuple[Floats, Floats]
) -> tuple[Chains, NDArray[np.bool_], Floats]:
    """Search the curves halfway along some chords: points, True where found, and their distance from the chords.

    Where the distance is not larger than `largest`, it is a bound, and the point is not refined.
    """
    start, stop = chains.take(first), chains.take(first + 1)
    y = 0.5 * (start.log_omega + stop.log_omega)
    chord = 0.5 * (start.slenderness + stop.slenderness)
    guess = chord + bend
    outward = np.where(start.side == 1, -1.0, 1.0)
    width = np.minimum(start.width, stop.width)
    nearest = np.where((block[0] == 1.0) & (start.region == UNCOUNTED), ELASTIC_RESOLUTION, 1e-8)
    # a bracket around the predicted place, one end inside the region and one outside, widened until it holds the curve
    near = np.clip(0.3 * np.abs(bend), nearest, np.maximum(0.4 * width, nearest))
    ends, margins, neighbour = np.empty((y.size, 2)), np.empty((y.size, 2)), np.empty(y.size, dtype=np.int64)
    on_curve = np.zeros(y.size, dtype=bool)
    for _ in range(WIDENINGS):
        missing = np.flatnonzero(~on_curve)
        if not missing.size:
            break
        reach = (outward * near)[missing, None] * [-1.0, 1.0]
        ends[missing] = guess[missing, None] + reach
        codes, margins[missing] = classify(ends[missing], y[missing, None], *block)
        neighbour[missing] = codes[:, 1]
        on_curve[missing] = (codes[:, 0] == start.region[missing]) & (codes[:, 1] != start.region[missing])
        near = np.minimum(8.0 * near, 0.4 * width)
    # where that fails, rows of points across the region, the second one over three times the distance
    for shares in SCANS:
        missing = np.flatnonzero(~on_curve)
        if not missing.size:
            break
        reach = np.maximum(1.5 * width[missing], 3.0 * np.abs(bend[missing]))
        x = np.clip(guess[missing, None] + (outward[missing] * reach)[:, None] * shares, 1e-6, 1.0)
        codes, margin = classify(x, y[missing, None], *block)
        k, on_curve[missing] = _nearest_end(codes == start.region[missing, None])
        rows = np.arange(missing.size)
        ends[missing] = np.stack([x[rows, k], x[rows, k + 1]], axis=1)
        margins[missing] = np.stack([margin[rows, k], margin[rows, k + 1]], axis=1)
        neighbour[missing] = codes[rows, k + 1]
    slope = (stop.slenderness - start.slenderness) / (stop.log_omega - start.log_omega)
    distance = np.abs(ends - chord[:, None]).max(axis=1) / np.hypot(1.0, slope)
    for resolution in (FINE * largest, np.full(y.size, RESOLUTION)):  # the second one for new vertices only
        k = np.flatnonzero(on_curve & (distance > largest))
        points = np.stack(np.broadcast_arrays(chord[k], y[k], *block), axis=1)
        refined = refine_brackets(
            0, points, ends[k], margins[k], start.region[k], neighbour[k], classify, resolution[k]
        )
        ends[k], margins[k], neighbour[k] = refined.ends, refined.margins, refined.beyond
        distance[k] = np.abs(ends[k] - chord[k, None]).max(axis=1) / np.hypot(1.0, slope[k])
    other = np.flatnonzero(on_curve & (neighbour != start.neighbour) & (neighbour != stop.neighbour))
    if other.size:  # another neighbour, unless it is too thin to be resolved
        beyond, _ = classify(ends[other, 0] + THINNEST * outward[other], y[other], *block)
        neighbour[other] = np.where(beyond == start.region[other], neighbour[other], beyond)
    middle = Chains(start.chain, ends[:, 0], y, start.region, neighbour, start.side, width)
    return middle, on_curve, distance


def _bend(chains: Chains, first: Index) -> tuple[Floats, Floats]:
    """Estimate how far a curve is from the middle of a chord by the chords on both sides, and how much these differ."""
    size = chains.chain.size
    x, y = chains.slenderness, chains.log_omega
    bends = np.full((2, first.size), np.nan)
    for row, (a, b, c) in enumerate(((first - 1, first, first + 1), (first + 2, first + 1, first))):
        inner = (a >= 0) & (a < size)
        end = np.clip(a, 0, size - 1)
        inner &= (chains.chain[end] == chains.chain[b]) & (chains.side[end] == chains.side[b])
        length_before, length = y[b] - y[end], y[c] - y[b]
        inner &= length_before * length > 0.0
        length_before = np.where(inner, length_before, 1.0)
        curvature = 2.0 * ((x[c] - x[b]) / length - (x[b] - x[end]) / length_before) / (length + length_before)
        bends[row] = np.where(inner, -0.125 * curvature * length * length, np.nan)
    is_known = np.isfinite(bends)
    bend = np.where(is_known, bends, 0.0).sum(axis=0) / np.maximum(is_known.sum(axis=0), 1)
    return bend, np.where(is_known.all(axis=0), np.abs(bends[0] - bends[1]), np.inf)


def _nearest_end(within: NDArray[np.bool_]) -> tuple[Index, NDArray[np.bool_]]:
    """Return the last point within a region nearest to the middle of a row of points, and whether there is one."""
    leaves = within[:, :-1] & ~within[:, 1:]
    distance = np.abs(np.arange(leaves.shape[1]) - leaves.shape[1] // 2)
    return np.argmin(np.where(leaves, distance, np.inf), axis=1), np.asarray(leaves.any(axis=1))
