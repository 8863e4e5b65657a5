"""One flight of the slender block, from the ground back to the ground: its state at any time, its zeros."""

from __future__ import annotations

import math

from rocking.compilation import Record, Vector, kernel
from rocking.slender_arcs import RADIUS, acceleration, anchor, arc, expand, pull, rotation, velocity


@kernel
def turn(flight: Record, phase: float, cosine: Vector, sine: Vector) -> None:
    """Set the cosines and sines of the angles at `phase`."""
    for k in range(len(flight.force)):
        angle = flight.multiple[k] * phase + flight.shift[k]
        cosine[k] = math.cos(angle)
        sine[k] = math.sin(angle)


@kernel
def start_flight(flight: Record, phase: float, w0: float, sign: float, lifted: bool) -> None:
    """Begin at `phase`, where `cosine0` and `sine0` are set already; q is exactly 0 at uplift through |a f| = 1."""
    flight.sign = sign
    for k in range(len(flight.force)):
        flight.force[k] = sign * flight.a * flight.amplitude[k]
    flight.phase = phase
    flight.w0 = w0
    flight.lifted = int(lifted)
    flight.q0 = 0.0 if lifted else pull(flight, flight.cosine0)
    anchor(flight)


@kernel
def state(flight: Record, h: float, cosine: Vector, sine: Vector) -> tuple[float, float]:
    """(z, w) a time h after the start, where the angles have that cosine and sine."""
    if flight.fastest * h <= RADIUS:  # the arc would cancel
        expand(flight, 0.0, flight.w0, flight.q0, flight.cosine0, flight.sine0)
        return rotation(flight, h), velocity(flight, h)
    return arc(flight, h, cosine, sine)


@kernel
def derivative(flight: Record, order: int, delta: float) -> float:
    """Derivative of z of that order (0 to 3) from the local series."""
    if order == 0:
        return rotation(flight, delta)
    if order == 1:
        return velocity(flight, delta)
    if order == 2:
        return acceleration(flight, delta)
    c = flight.coef
    return 6.0 * c[3] + delta * (24.0 * c[4] + delta * (60.0 * c[5] + delta * 120.0 * c[6]))


@kernel
def locate(
    flight: Record, order: int, falling: bool, lo: float, hi: float, guess: float
) -> tuple[float, float, float]:
    """The one zero between times `lo` and `hi` of z (order 0), w (1) or z'' (2), which falls or rises through it.

    Exact arc, then Newton on the local series; the bracket shrinks at every arc, so that it cannot fail.
    Returns the time after the flight's start, and z and w there.
    """
    h = guess
    reach = RADIUS / flight.fastest
    for _ in range(200):
        turn(flight, flight.phase + flight.omega * h, flight.cosine1, flight.sine1)
        z, w = state(flight, h, flight.cosine1, flight.sine1)
        expand(flight, z, w, pull(flight, flight.cosine1), flight.cosine1, flight.sine1)
        value = derivative(flight, order, 0.0)  # of z'' only the change of sign is used
        if (value > 0.0) == falling:
            lo = h
        else:
            hi = h
        delta, near = 0.0, False
        for _ in range(8):
            step = -derivative(flight, order, delta) / derivative(flight, order + 1, delta)
            delta += step
            if not abs(delta) <= reach or abs(step) <= 1e-4 * reach:
                near = abs(delta) <= reach
                break
        if near and lo <= h + delta <= hi:
            # steps square: one more from here leaves an error of 1e-16, and the series need not be summed again after it
            z, w, bend = rotation(flight, delta), velocity(flight, delta), acceleration(flight, delta)
            last = -z / w if order == 0 else (-w / bend if order == 1 else 0.0)
            return h + delta + last, z + last * (w + 0.5 * bend * last), w + last * bend
        if hi - lo <= 4e-16 * hi:
            return h, z, w
        follow = h + delta
        h = follow if lo < follow < hi and abs(delta) <= 8.0 * reach else 0.5 * (lo + hi)
    return h, z, w


@kernel
def hermite_root(f0: float, d0: float, f1: float, d1: float, length: float) -> float:
    """Where the cubic through two values of opposite sign with their slopes vanishes, in [0, length]; a first guess."""
    d0 *= length
    d1 *= length
    c2 = 3.0 * (f1 - f0) - 2.0 * d0 - d1
    c3 = 2.0 * (f0 - f1) + d0 + d1
    lo, hi = 0.0, 1.0
    x = f0 / (f0 - f1)
    for _ in range(2):
        value = f0 + x * (d0 + x * (c2 + x * c3))
        if (value > 0.0) == (f0 > 0.0):
            lo = x
        else:
            hi = x
        slope = d0 + x * (2.0 * c2 + x * 3.0 * c3)
        x -= value / slope
        if not lo < x < hi:
            x = 0.5 * (lo + hi)
    return x * length
