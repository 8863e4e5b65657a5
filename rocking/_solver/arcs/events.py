"""Events of a flight of the slender block: peaks, impact, end of the pulse."""

from __future__ import annotations

import math

from rocking._numba.compilation import Record, kernel
from rocking._solver.arcs.arc import (
    SERIES_RADIUS,
    acceleration,
    expand_series,
    restoring_acceleration,
    rotation,
    velocity,
)
from rocking._solver.arcs.flight import hermite_root, locate_root, state_at
from rocking._solver.state import IMPACT, PULSE_END


@kernel
def peak_on_piece(
    flight: Record,
    left: int,
    right: int,
    at_left: tuple[float, float, float],
    at_right: tuple[float, float, float],
) -> tuple[float, float]:
    """Time and z of the only maximum of z on intervals `left` to `right` - 1, with q >= 0 and f' of one sign.

    `at_left` and `at_right` are time, z and w at the ends. Without a maximum the time is -1. w has one zero or none if
    it has different signs at the ends; with equal signs it can have two only if w'' = w - q' lets it turn inside: these
    are separated by the zero of w' = z'', of which there is one then.
    """
    (lo, z_lo, w_lo), (hi, z_hi, w_hi) = at_left, at_right
    restoring_increases = flight.sign * flight.interval_slope[left] >= 0.0
    q_lo = flight.q0 if lo == 0.0 else restoring_acceleration(flight, flight.interval_cosine[left])
    d_lo, d_hi = z_lo - q_lo, z_hi - restoring_acceleration(flight, flight.interval_cosine[right])  # z''
    whole = True
    if w_lo > 0.0 and w_hi >= 0.0 and not restoring_increases and d_lo < 0.0 < d_hi:
        # w'' >= w > 0: w may become negative and positive again
        hi, _, w_hi = locate_root(flight, 2, False, lo, hi, 0.5 * (lo + hi))
        whole = hi == at_right[0]
    elif w_lo <= 0.0 and w_hi < 0.0 and restoring_increases and d_hi < 0.0 < d_lo:
        lo, _, w_lo = locate_root(flight, 2, True, lo, hi, 0.5 * (lo + hi))
        whole = lo == at_left[0]
    if not w_lo > 0.0 > w_hi:
        return -1.0, 0.0
    guess = lo + hermite_root(w_lo, d_lo, w_hi, d_hi, hi - lo) if whole else 0.5 * (lo + hi)
    h, z, _ = locate_root(flight, 1, True, lo, hi, guess)
    return h, z


@kernel
def peak_in_run(
    flight: Record,
    first: int,
    last: int,
    at_first: tuple[float, float, float],
    at_last: tuple[float, float, float],
) -> tuple[float, float, float]:
    """Largest and last peak of z in a run of intervals `first` to `last` - 1 with q >= 0, divided where f' = 0.

    `at_first` and `at_last` are time, z and w at the ends of the run. Returns the largest z (or 0), and time and z of
    the last peak (or of the start of the run).
    """
    largest, h_peak, z_peak = 0.0, at_first[0], at_first[1]
    left, at_left = first, at_first
    while left < last:
        right = left + 1
        while right < last and flight.interval_slope[right] == flight.interval_slope[left]:
            right += 1
        at_right = at_last
        if right < last:
            h = (flight.interval_phase[right] - flight.phase) / flight.omega
            z, w = state_at(flight, h, flight.interval_cosine[right], flight.interval_sine[right])
            at_right = h, z, w
        h, z = peak_on_piece(flight, left, right, at_left, at_right)
        if h >= 0.0:
            h_peak, z_peak = h, z
            largest = max(largest, z)
        left, at_left = right, at_right
    return largest, h_peak, z_peak


@kernel
def impact_of_destabilised(
    flight: Record, at_left: tuple[float, float, float], at_right: tuple[float, float, float]
) -> tuple[float, float]:
    """Time and velocity of the impact on a run of intervals with q <= 0, from time, z and w < 0 at its left end.

    z is convex while it is positive: an impact happens if z <= 0 at the right end, or at the one minimum, which exists
    if w > 0 there. Without an impact the time is -1.
    """
    (lo, z_lo, w_lo), (hi, z_hi, w_hi) = at_left, at_right
    if z_hi > 0.0 and w_hi > 0.0:
        hi, z_hi, w_hi = locate_root(flight, 1, False, lo, hi, 0.5 * (lo + hi))
    if z_hi > 0.0:
        return -1.0, 0.0
    guess = lo + hermite_root(z_lo, w_lo, z_hi, w_hi, hi - lo)
    h, _, w = locate_root(flight, 0, True, lo, hi, guess)
    return h, w


@kernel
def long_flight(flight: Record) -> tuple[int, float, float, float, float]:
    """Follow one flight from its start to its impact or to the end of the pulse.

    The intervals of the pulse (`rocking._solver.kernels.intervals`) are joined to runs on which q keeps its sign, and
    the state is computed at the ends of runs only. On each run the signs of z and w at its ends decide whether there is
    an impact or a peak, as `rocking._solver.kernels.intervals` shows: none can be missed, however long the run is.

    Returns what ended it (`IMPACT`; `PULSE_END` also where overturning is certain earlier), time and velocity w there,
    z at the end of the pulse, and the largest z, the latter only if the block can still return. Beyond
    z + w = `limit` = 1 + a no ground acceleration of this pulse prevents overturning, since (z + w)' = (z + w) - q and
    q <= limit.
    """
    z_left, w_left, h_left = 0.0, flight.w0, 0.0
    known = True  # z and w at the left end
    sign, limit = flight.sign, 1.0 + flight.a[0]
    largest = 0.0
    left, count = flight.interval, flight.interval_count
    while left < count:
        destabilised = flight.interval_level[left] * sign < 0.0
        right = left + 1
        while right < count and (flight.interval_level[right] * sign < 0.0) == destabilised:
            right += 1
        h_right = (flight.interval_phase[right] - flight.phase) / flight.omega
        if destabilised and (not known or w_left >= 0.0) and right < count:
            known = False  # convex and increasing: neither impact nor peak, and w > 0 at the end
            left, h_left = right, h_right
            continue
        z_right, w_right = state_at(flight, h_right, flight.interval_cosine[right], flight.interval_sine[right])
        at_right = h_right, z_right, w_right
        if destabilised:
            if known and w_left < 0.0:
                h, w = impact_of_destabilised(flight, (h_left, z_left, w_left), at_right)
                if h >= 0.0:
                    return IMPACT, h, w, 0.0, largest
        else:
            if z_right > 0.0 and z_right + w_right >= (1.0 if right == count else limit):  # (3.8) at the end
                return PULSE_END, h_right, w_right, z_right, largest
            if not known:
                z_left, w_left = state_at(flight, h_left, flight.interval_cosine[left], flight.interval_sine[left])
            top, h_peak, z_peak = peak_in_run(flight, left, right, (h_left, z_left, w_left), at_right)
            largest = max(largest, top)
            if z_right <= 0.0:  # restored: what has gone below zero stays below, the impact follows the last peak
                guess = h_peak + hermite_root(z_peak, 0.0, z_right, w_right, h_right - h_peak)
                h, _, w = locate_root(flight, 0, True, h_peak, h_right, guess)
                return IMPACT, h, w, 0.0, largest
        left, h_left, z_left, w_left, known = right, h_right, z_right, w_right, True
    return PULSE_END, h_left, w_left, z_left, largest


@kernel
def short_flight(flight: Record, longest: float, peak: float) -> tuple[float, float, float]:
    """A flight within the radius of the series at its start: time of impact (-1 if outside), w there, peak.

    The impact is the first zero of z/h; the peak is computed only if it can exceed `peak`.
    """
    w0, q0 = flight.w0, flight.q0
    reach = min(SERIES_RADIUS / flight.max_rate, longest)
    if q0 <= 0.0 or 2.5 * w0 > reach * q0:
        return -1.0, 0.0, 0.0
    expand_series(flight, 0.0, w0, q0, flight.cosine0, flight.sine0)
    h = 2.0 * w0 / q0
    step = math.inf
    for _ in range(12):
        over_h = rotation(flight, h) / h
        step = -over_h * h / (velocity(flight, h) - over_h)
        h += step
        if not 0.0 < h <= reach:
            return -1.0, 0.0, 0.0
        if abs(step) <= 1e-8 * h:
            break
    else:
        return -1.0, 0.0, 0.0
    largest = 0.0
    if 0.5 * w0 * h > peak:
        top = 0.5 * h
        for _ in range(6):
            top -= velocity(flight, top) / acceleration(flight, top)
        largest = rotation(flight, top)
    return h, velocity(flight, h), largest
