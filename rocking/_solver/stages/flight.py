"""One flight of `LANES` blocks with the same sign of rotation, from its start to its impact or the end of the pulse.

Given: the starts of the flights, and the monotone pieces of the pulse. Decided: how each flight ends, and its largest
rotation. The parts of the pulse are visited in their order, all cells at once; a cell ignores the parts before its
flight. No event is missed, since q keeps its sign on a part: it changes at the cut of a piece only
(`rocking._solver.stages.cuts`).

- Restored, q >= 0: z <= 0 at the right end is necessary and sufficient for an impact, since negative z stays negative.
  f' keeps its sign, so that a peak exists if w > 0 at the left end and w < 0 at the right. Two more zeros of w are
  possible only if w'' - w = -q' lets w turn inside: w is then convex (or concave) where it is positive (negative), and
  its tangents at both ends exclude a zero, or the state at one more time shows the two, with a peak between.
- Destabilised, q <= 0: z is convex where it is positive. Where w >= 0 at the left end nothing happens, and the state at
  the right end is not computed before it is needed. Otherwise z <= 0 at the right end means an impact; if z turns
  inside, its tangents exclude a zero, or the state at one more time shows an impact before it.
- z + w > 1 + a at the right end of a restored part: overturning is certain, since (z + w)' = z + w - q and q <= 1 + a.

Worked example: the sine, 1/a = 0.6, omega = 2. The first flight starts at the uplift, phi = 0.644 (f = 0.6), about the
left edge. On the parts to pi/2 and to the cut at phi = 2.498 (f = 0.6 again) q <= 0 and w >= 0 at the left end: no
event, and neither state is computed. The part to 3 pi/2 is restored: z = 0.226 and w = -0.933 at its right end, and
w = 0.460 at its left end, computed only now: one peak, kept for later, and no impact. On the last part, to
2 pi, z < 0 at the right end: one impact, located at phi = 5.099 with w = -1.416, and the peak with it.
"""

from typing import Any

from rocking._numba.compilation import Record, SimdVector, kernel, specialised_kernel
from rocking._numba.simd import absolute, any_lane, fill_mask, load, select, splat, store, store_where
from rocking._solver.stages import columns as column
from rocking._solver.stages.arcs import start_arcs, states_at
from rocking._solver.stages.cuts import cut_phases, init_cuts
from rocking._solver.stages.excitation import restoring_acceleration, set_angles, set_end_angles
from rocking._solver.stages.roots import locate_impacts, locate_peaks, quintic_roots
from rocking._solver.stages.state import FAR
from rocking._solver.state import IMPACT, IN_FLIGHT, PULSE_END

MAX_DIP_ARCS = 8  # states at which the tangents decide on a minimum of z; nearly all need one or two

UPLIFT_SLACK = 1e-13
"""A flight from an uplift starts at a cut; parts that end closer to it than this [rad] lie before it. The part that
follows is wider than 1e-8."""


@kernel
def follow_flights(pulse: Record, group: Record, sign: float) -> None:
    """Follow the flights given by the columns of `flight` to their ends.

    Sets `ended` (`IMPACT`, `PULSE_END`, the latter also where overturning is certain earlier, or -1: left to the
    event loop), `length`, `end_w`, `end_z` and `top`, the largest z, the latter only if the block can still return.
    """
    init_cuts(pulse, group)
    start_arcs(pulse, group, sign)
    zero, one = splat(0.0), splat(1.0)
    store(group.followed, 0, one)
    store(group.known, 0, one)
    store(group.left_h, 0, zero)
    store(group.left_z, 0, zero)
    store(group.left_w, 0, load(group.columns, column.W0))
    store(group.left_q, 0, load(group.q0, 0))
    store(group.peak_pending, 0, zero)
    store(group.top, 0, zero)
    store(group.undecided, 0, zero)
    starts = load(group.columns, column.PHASE) + load(group.columns, column.AT_UPLIFT) * UPLIFT_SLACK
    for piece in range(pulse.pieces):
        right = pulse.end_phase[piece + 1]
        # before all flights, or after the last has ended
        if not any_lane((load(group.followed, 0) > 0.0) & (starts < right)):
            continue
        # g = -sign f destabilises where it exceeds 1/a: a piece on which g rises is restored first, then destabilised
        rising = -sign * pulse.end_shape[piece + 1] >= -sign * pulse.end_shape[piece]
        never_cut = max(-sign * pulse.end_shape[piece + 1], -sign * pulse.end_shape[piece]) <= 0.0
        if not never_cut:
            cuts = cut_phases(pulse, group, piece, sign)
            follow_part(pulse, group, cuts, 0, rising, rising, cuts < right, False)
        last = piece + 1 == pulse.pieces
        follow_part(pulse, group, splat(right), piece + 1, never_cut or not rising, rising, fill_mask(False), last)
    hits = load(group.ended, 0) == float(IMPACT)
    # (3.8): a block that overturns has no peak
    escaped = ~hits & (load(group.end_z, 0) + load(group.end_w, 0) >= 1.0)
    store_where(group.peak_pending, 0, escaped, zero)
    if any_lane(load(group.peak_pending, 0) > 0.0):
        locate_peaks(pulse, group)
    if any_lane(hits):
        locate_impacts(pulse, group, hits)
    undecided = load(group.undecided, 0) > 0.0
    store_where(group.ended, 0, undecided, float(IN_FLIGHT))


@specialised_kernel
def follow_part(
    pulse: Record, group: Record, right: SimdVector, end: int, restored: bool, rising: bool, before_cut: Any, last: bool
) -> None:
    """Continue the flights to the phases `right` [rad] on a part of the pulse with one sign of q.

    `end`: number of the end of a piece of the pulse if all flights are continued to it, else 0. `restored`: whether
    q >= 0 on the part, else q <= 0; `rising`: whether q decreases on it. `before_cut`: mask of the cells for which a
    destabilised part follows. `last`: whether the part ends with the pulse.
    """
    zero, one = splat(0.0), splat(1.0)
    # 1. Cells whose flight has a length on this part, and those for which an event is possible on it
    phase = load(group.columns, column.PHASE)
    followed, known = load(group.followed, 0) > 0.0, load(group.known, 0) > 0.0
    left_h, left_z, left_w = load(group.left_h, 0), load(group.left_z, 0), load(group.left_w, 0)
    ahead = followed & (right > phase + load(group.columns, column.AT_UPLIFT) * UPLIFT_SLACK)
    h = (right - phase) * load(group.reciprocal_omega, 0)
    inside = ahead & (h > left_h)
    h = select(inside, h, left_h)
    falling_back = inside & known & (left_w < 0.0)
    if not last and not any_lane(inside if restored else falling_back):
        # destabilised and rising, all of them: no event, and the state at the right end is not needed yet
        store_where(group.known, 0, inside, zero)
        store(group.left_h, 0, h)
        return
    # 2. Their state at the right end; at the end of the pulse also the states that were left open
    if end > 0:
        set_end_angles(pulse, group, end)
    else:
        set_angles(pulse, group, right)
    computed = inside | (ahead & ~known) if last else inside
    z, w = states_at(pulse, group, select(computed, h, splat(FAR)))
    q = restoring_acceleration(pulse, group)
    # a cell that starts later, or for which the part is empty, keeps its state
    z, w = select(computed, z, left_z), select(computed, w, left_w)
    # 3. Events on the part
    if restored:
        # overturning is certain: at the end of the pulse from z + w = 1 on, (3.8), before it from 1 + a on
        escapes = inside & (z > 0.0) & (z + w >= (one if last else 1.0 + load(group.a, 0)))
        if not last:
            escapes = escapes & before_cut
        hits, undecided, left_z, left_w = restored_events(
            pulse, group, rising, inside & ~escapes, known, (left_h, left_z, left_w), (h, z, w), q
        )
    else:
        escapes = fill_mask(False)
        hits, undecided = destabilised_events(pulse, group, falling_back, (left_h, left_z, left_w), (h, z, w))
    if any_lane(hits):
        bracket_impacts(group, hits, (left_h, left_z, left_w), (h, z, w), q)
    # 4. How each flight goes on: it has ended in an impact, overturns for certain, is left to the event loop, or stays
    ended = select(escapes, splat(float(PULSE_END)), load(group.ended, 0))
    ended = select(hits, splat(float(IMPACT)), ended)
    store_where(group.undecided, 0, undecided, one)
    stays = followed & ~hits & ~undecided & ~escapes
    if last:
        ended = select(stays, splat(float(PULSE_END)), ended)
    finished = (escapes | stays) if last else escapes
    store_where(group.length, 0, finished, h)
    store_where(group.end_z, 0, finished, z)
    store_where(group.end_w, 0, finished, w)
    store(group.ended, 0, ended)
    store(group.followed, 0, zero if last else select(stays, one, zero))
    # where a block on a destabilised part does not fall back, its state at the right end is left open
    now_known = one if restored else select(falling_back, one, zero)
    store_where(group.known, 0, inside, now_known)
    store(group.left_h, 0, h)
    store(group.left_z, 0, z)
    store(group.left_w, 0, w)
    store_where(group.left_q, 0, inside, q)


@specialised_kernel
def restored_events(
    pulse: Record, group: Record, rising: bool, inside: Any, known: Any, left: Any, right: Any, q: SimdVector
) -> Any:
    """Impacts and peaks on a part with q >= 0, from the times, z and w at its ends; on the left where it is `known`.

    Returns the masks of the cells with an impact (z <= 0 at the right end) and of the cells left undecided;
    then z and w at the left end, computed where it was left open and w < 0 at the right end: without a fall there is
    neither a peak nor an impact, whatever the state at the left end was. The peak of a cell is kept as pending, with
    its bracket and first guess.
    """
    left_h, left_z, left_w = left
    h, z, w = right
    one, zero = splat(1.0), splat(0.0)
    left_q = load(group.left_q, 0)
    unknown = inside & ~known & (w < 0.0)
    if any_lane(unknown):
        set_angles(pulse, group, load(group.columns, column.PHASE) + load(group.columns, column.OMEGA) * left_h)
        at_left_z, at_left_w = states_at(pulse, group, select(unknown, left_h, splat(FAR)))
        left_z, left_w = select(unknown, at_left_z, left_z), select(unknown, at_left_w, left_w)
        left_q = select(unknown, restoring_acceleration(pulse, group), left_q)
        known = known | unknown
    left_slope, slope = left_z - left_q, z - q  # of w
    duration = h - left_h
    # Two more zeros of w are possible where it has one sign at both ends and turns inside. q decreases (rising):
    # w'' = w - q' >= w, so that w is convex where it is positive. q increases: concave where it is negative
    if rising:
        turns = (left_w > 0.0) & (w >= 0.0) & (left_slope < 0.0) & (slope > 0.0)
    else:
        turns = (left_w <= 0.0) & (w < 0.0) & (left_slope > 0.0) & (slope < 0.0)
    undecided = inside & known & turns & ~are_apart(left_w, left_slope, w, slope, duration)
    peaks = inside & known & (left_w > 0.0) & (w < 0.0)
    low, low_z, low_w, low_slope = left_h, left_z, left_w, left_slope
    high, high_z, high_w, high_slope = h, z, w, slope
    if any_lane(undecided):
        up = 1.0 if rising else -1.0
        low_end, high_end = (left_h, left_w * up, left_slope * up), (h, w * up, slope * up)
        undecided, dips = find_dips(pulse, group, up, undecided, low_end, high_end)
        # two zeros of w: at the peak w falls, which is before the dip of a positive w and after that of a negative one
        peaks = peaks | dips
        dip, dip_z = load(group.impact_high, 0), load(group.impact_high_z, 0)
        dip_w, dip_slope = load(group.impact_high_w, 0), load(group.impact_high_slope, 0)
        if rising:
            high, high_z = select(dips, dip, high), select(dips, dip_z, high_z)
            high_w, high_slope = select(dips, dip_w, high_w), select(dips, dip_slope, high_slope)
        else:
            low, low_z = select(dips, dip, low), select(dips, dip_z, low_z)
            low_w, low_slope = select(dips, dip_w, low_w), select(dips, dip_slope, low_slope)
    hits = inside & (z <= 0.0)
    undecided = undecided | (hits & (w >= 0.0))  # rounding: z rises through zero
    if any_lane(peaks):
        if any_lane(peaks & (load(group.peak_pending, 0) > 0.0)):
            flush_peaks(pulse, group, peaks)
        guess = low + quintic_roots(True, (low_z, low_w, low_slope), (high_z, high_w, high_slope), high - low)
        store_where(group.peak_pending, 0, peaks, one)
        store_where(group.peak_low, 0, peaks, low)
        store_where(group.peak_high, 0, peaks, high)
        store_where(group.peak_guess, 0, peaks, guess)
    store_where(group.impact_after_peak, 0, hits, select(peaks, one, zero))
    return hits, undecided, left_z, left_w


@kernel
def destabilised_events(pulse: Record, group: Record, falling_back: Any, left: Any, right: Any) -> Any:
    """Impacts on a part with q <= 0 of the cells with w < 0 at its left end; there is no peak inside.

    z is convex while it is positive: z <= 0 at the right end is an impact, and so is z <= 0 at a minimum inside, where
    w changes its sign. Returns the masks of the cells with an impact and of those left undecided.
    """
    left_h, left_z, left_w = left
    h, z, w = right
    hits = falling_back & (z <= 0.0)
    turns = falling_back & (z > 0.0) & (w > 0.0)  # a minimum inside
    undecided = turns & ~are_apart(left_z, left_w, z, w, h - left_h)
    if any_lane(undecided):
        undecided, dips = find_dips(pulse, group, 0.0, undecided, left, right)
        hits = hits | dips
    store_where(group.impact_after_peak, 0, hits, 0.0)
    return hits, undecided


@kernel
def bracket_impacts(group: Record, hits: Any, left: Any, right: Any, q: SimdVector) -> None:
    """Set the bracket of the impact: the part, or its left end and the dip that `find_dips` has set."""
    left_h, left_z, left_w = left
    h, z, w = right
    store_where(group.impact_low, 0, hits, left_h)
    store_where(group.impact_low_z, 0, hits, left_z)
    store_where(group.impact_low_w, 0, hits, left_w)
    store_where(group.impact_low_slope, 0, hits, left_z - load(group.left_q, 0))
    at_end = hits & (z <= 0.0)  # otherwise at the dip
    store_where(group.impact_high, 0, at_end, h)
    store_where(group.impact_high_z, 0, at_end, z)
    store_where(group.impact_high_w, 0, at_end, w)
    store_where(group.impact_high_slope, 0, at_end, z - q)


@kernel
def find_dips(pulse: Record, group: Record, of_w: float, wanted: Any, low_end: Any, high_end: Any) -> Any:
    """Whether v has a zero between two ends, each a time, v > 0 there and its slope, < 0 at the first and > 0 then.

    v is z if `of_w` is 0, otherwise `of_w` w; both are convex where they keep their sign. The state is computed where
    the tangents at both ends meet. That is the next end, until the tangents exclude a zero or v <= 0. Returns the
    masks of the cells that remain undecided, and of those with a zero, whose `impact_high` is set to the time with
    v <= 0.
    """
    low, v_low, slope_low = low_end
    high, v_high, slope_high = high_end
    todo, dips = wanted, fill_mask(False)
    for _ in range(MAX_DIP_ARCS):
        # where the two tangents meet: v, convex, lies above both, so that their meeting above zero excludes a zero
        h = (v_high - v_low + slope_low * low - slope_high * high) / (slope_low - slope_high)
        h = select(todo, h, splat(FAR))
        set_angles(pulse, group, load(group.columns, column.PHASE) + load(group.columns, column.OMEGA) * h)
        z, w = states_at(pulse, group, h)
        second = z - restoring_acceleration(pulse, group)
        v, slope = z, w
        if of_w != 0.0:
            v, slope = w * of_w, second * of_w
        found = todo & (v <= 0.0)
        dips = dips | found
        store_where(group.impact_high, 0, found, h)
        store_where(group.impact_high_z, 0, found, z)
        store_where(group.impact_high_w, 0, found, w)
        store_where(group.impact_high_slope, 0, found, second)
        falls = slope < 0.0  # the minimum lies to the right of h: h becomes the left end, otherwise the right one
        low, high = select(falls, h, low), select(falls, high, h)
        v_low, v_high = select(falls, v, v_low), select(falls, v_high, v)
        slope_low, slope_high = select(falls, slope, slope_low), select(falls, slope_high, slope)
        todo = todo & ~found & ~are_apart(v_low, slope_low, v_high, slope_high, high - low)
        if not any_lane(todo):
            break
    return todo, dips


@kernel
def are_apart(
    left: SimdVector, left_slope: SimdVector, right: SimdVector, right_slope: SimdVector, duration: SimdVector
) -> Any:
    """Whether the tangents at both ends of a part, with slopes of opposite sign, meet before they cross zero."""
    return absolute(left * right_slope) + absolute(right * left_slope) > duration * absolute(left_slope * right_slope)


@kernel
def flush_peaks(pulse: Record, group: Record, where: Any) -> None:
    """Locate the pending peaks of the cells in which another one follows."""
    pending, zero = load(group.peak_pending, 0), splat(0.0)
    store(group.peak_pending, 0, select(where, pending, zero))
    locate_peaks(pulse, group)
    store(group.peak_pending, 0, select(where, zero, pending))
