"""A flight of the slender block between two impacts: its state at any time and its zeros."""

from __future__ import annotations

import math

from rocking._numba.compilation import FloatArray, Record, kernel
from rocking._solver.arcs.arc import (
    SERIES_RADIUS,
    acceleration,
    arc_state,
    expand_series,
    init_arc,
    jerk,
    restoring_acceleration,
    rotation,
    velocity,
)


@kernel
def set_angles(flight: Record, phase: float, cosine: FloatArray, sine: FloatArray) -> None:
    """Set the cosines and sines of the angles at `phase`."""
    for k in range(flight.terms):
        angle = flight.multiple[k] * phase + flight.shift[k]
        cosine[k] = math.cos(angle)
        sine[k] = math.sin(angle)


@kernel
def start_arc(flight: Record) -> None:
    """Set the coefficients of the flight that starts at `phase`; `cosine0` and `sine0` must be set."""
    for k in range(flight.terms):
        flight.force[k] = flight.sign * flight.a[0] * flight.amplitude[k]
    # exactly 0 at uplift through |a f| = 1
    flight.q0 = 0.0 if flight.starts_at_uplift == 1 else restoring_acceleration(flight, flight.cosine0)
    init_arc(flight)


@kernel
def state_at(flight: Record, h: float, cosine: FloatArray, sine: FloatArray) -> tuple[float, float]:
    """(z, w) a time h after the start, with the cosines and sines of the angles there."""
    if flight.max_rate * h <= SERIES_RADIUS:  # the arc would lose digits by cancellation
        expand_series(flight, 0.0, flight.w0, flight.q0, flight.cosine0, flight.sine0)
        return rotation(flight, h), velocity(flight, h)
    return arc_state(flight, h, cosine, sine)


@kernel
def series_root(flight: Record, order: int) -> float:
    """Zero of the local series of z (order 0), w (1) or z'' (2), by series reversion to third order."""
    c = flight.coef
    if order == 0:
        f0, f1, f2, f3 = c[0], c[1], c[2], c[3]
    elif order == 1:
        f0, f1, f2, f3 = c[1], 2.0 * c[2], 3.0 * c[3], 4.0 * c[4]
    else:
        f0, f1, f2, f3 = 2.0 * c[2], 6.0 * c[3], 12.0 * c[4], 20.0 * c[5]
    inverse = 1.0 / f1
    t, b2, b3 = -f0 * inverse, f2 * inverse, f3 * inverse
    return t * (1.0 - t * (b2 - t * (2.0 * b2 * b2 - b3)))


@kernel
def expand_at(flight: Record, h: float, order: int) -> tuple[float, float, float, float, float]:
    """Expand the flight in a series about time `h`, or about its start where that series reaches `h`.

    An expansion far from the start loses the first part of a flight by cancellation; at the start q is known without.
    Returns the centre of the series, the distance from it at which the search for a zero of `order` begins, and z, w
    and z'' at `h`.
    """
    if h <= SERIES_RADIUS / flight.max_rate:
        expand_series(flight, 0.0, flight.w0, flight.q0, flight.cosine0, flight.sine0)
        return 0.0, h, rotation(flight, h), velocity(flight, h), acceleration(flight, h)
    set_angles(flight, flight.phase + flight.omega * h, flight.cosine1, flight.sine1)
    z, w = arc_state(flight, h, flight.cosine1, flight.sine1)
    expand_series(flight, z, w, restoring_acceleration(flight, flight.cosine1), flight.cosine1, flight.sine1)
    return h, series_root(flight, order), z, w, 2.0 * flight.coef[2]


@kernel
def halley_step(flight: Record, order: int, delta: float) -> tuple[float, float]:
    """Halley's step from the distance `delta` to the zero of the local series of z (order 0), w (1) or z'' (2).

    Returns the step and its relative correction of Newton's step: the error that remains is proportional to the cube of
    the step, times the square of that correction over the step near a double zero.
    """
    z, w, second = rotation(flight, delta), velocity(flight, delta), acceleration(flight, delta)
    third = jerk(flight, delta)
    if order == 0:
        value, slope, curve = z, w, second
    elif order == 1:
        value, slope, curve = w, second, third
    else:
        value, slope, curve = second, third, 0.0  # only the sign of w is used
    step = -value / slope
    correction = 0.5 * curve / slope * step
    return step - correction * step, correction


@kernel
def locate_root(
    flight: Record, order: int, falling: bool, lo: float, hi: float, guess: float
) -> tuple[float, float, float]:
    """The only zero between times `lo` and `hi` of z (order 0), w (1) or z'' (2), decreasing if `falling`.

    An exact arc to the guess, then Halley's method on the local series. The sign at each arc shrinks the bracket, and
    every other arc bisects it once the local steps do not converge within eight: the search ends, whatever the guess.
    Returns the time after the start of the flight, and z and w there.
    """
    h = guess
    reach = SERIES_RADIUS / flight.max_rate
    for attempt in range(200):
        centre, delta, z, w, second = expand_at(flight, h, order)
        value = z if order == 0 else (w if order == 1 else second)
        if (value > 0.0) == falling:
            lo = h
        else:
            hi = h
        for _ in range(6):
            if not abs(delta) <= reach:
                break
            step, correction = halley_step(flight, order, delta)
            small = abs(step) <= 2e-5 * min(reach, centre + delta)
            if small and abs(step) * correction * correction <= 1e-16 * (centre + delta):  # the error is below rounding
                root = centre + delta + step
                if centre > 0.0 and root <= reach:
                    delta += step
                    break  # again with the series at the start
                if lo - 4e-16 * hi <= root <= hi + 4e-16 * hi:
                    second, third = acceleration(flight, delta), jerk(flight, delta)
                    near_z, near_w = rotation(flight, delta), velocity(flight, delta)
                    rotated = near_z + step * (near_w + step * (0.5 * second + step * third / 6.0))
                    return root, rotated, near_w + step * (second + 0.5 * step * third)
                break
            delta += step
        if hi - lo <= 4e-16 * hi:
            return h, z, w
        follow = centre + delta
        # where the growing exponential dominates, local steps have length 1; on long arcs they alternate with bisection
        local = lo < follow < hi and abs(delta) <= 8.0 * reach and (attempt < 8 or attempt % 2 == 0)
        h = follow if local else 0.5 * (lo + hi)
    return h, z, w


@kernel
def hermite_root(f0: float, d0: float, f1: float, d1: float, length: float) -> float:
    """Initial guess of the zero in [0, length] of the cubic through two values of opposite sign with their slopes.

    One Newton step from the secant.
    """
    d0 *= length
    d1 *= length
    c2 = 3.0 * (f1 - f0) - 2.0 * d0 - d1
    c3 = 2.0 * (f0 - f1) + d0 + d1
    x = f0 / (f0 - f1)
    value = f0 + x * (d0 + x * (c2 + x * c3))
    better = x - value / (d0 + x * (2.0 * c2 + x * 3.0 * c3))
    return (better if 0.0 < better < 1.0 else x) * length
