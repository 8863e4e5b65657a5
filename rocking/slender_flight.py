"""One flight of the slender block, from the ground back to the ground: its state at any time, its zeros."""

from __future__ import annotations

import math

from rocking.compilation import Record, Vector, kernel
from rocking.slender_arcs import RADIUS, acceleration, arc, expand, pull, rotation, velocity


@kernel
def turn(flight: Record, phase: float, cosine: Vector, sine: Vector) -> None:
    """Set the cosines and sines of the angles at `phase`."""
    for k in range(len(flight.force)):
        angle = flight.multiple[k] * phase + flight.shift[k]
        cosine[k] = math.cos(angle)
        sine[k] = math.sin(angle)


@kernel
def start_flight(flight: Record, phase: float, w0: float, sign: float, at_uplift: bool) -> None:
    """Begin at `phase`, where `cosine0` and `sine0` are set already; q is exactly 0 at uplift through |a f| = 1."""
    flight.sign = sign
    for k in range(len(flight.force)):
        flight.force[k] = sign * flight.a * flight.amplitude[k]
    flight.phase = phase
    flight.w0 = w0
    flight.q0 = 0.0 if at_uplift else pull(flight, flight.cosine0)


@kernel
def state(flight: Record, h: float, cosine: Vector, sine: Vector) -> tuple[float, float]:
    """(z, w) a time h after the start, where the angles have that cosine and sine."""
    if flight.fastest * h <= RADIUS:  # the arc would cancel
        expand(flight, 0.0, flight.w0, flight.q0, flight.cosine0, flight.sine0)
        return rotation(flight, h), velocity(flight, h)
    return arc(flight, h, cosine, sine)


@kernel
def derivative(flight: Record, order: int, delta: float) -> float:
    """Derivative of z of that order (0, 1 or 2) from the local series."""
    if order == 0:
        return rotation(flight, delta)
    if order == 1:
        return velocity(flight, delta)
    return acceleration(flight, delta)


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
        value = derivative(flight, order, 0.0)
        if (value > 0.0) == falling:
            lo = h
        else:
            hi = h
        delta = 0.0
        step = math.inf
        for _ in range(8):
            if order == 0:
                step = -rotation(flight, delta) / velocity(flight, delta)
            elif order == 1:
                step = -velocity(flight, delta) / acceleration(flight, delta)
            else:  # a secant of z'' over the bracket's remaining uncertainty is enough: only its sign change is used
                slope = 6.0 * flight.coef[3] + delta * (24.0 * flight.coef[4] + delta * 60.0 * flight.coef[5])
                step = -acceleration(flight, delta) / slope
            delta += step
            if not abs(delta) <= reach or abs(step) <= 1e-8 * reach:
                break
        # steps square: one below 1e-8 of the radius leaves an error at rounding level
        if abs(step) <= 1e-8 * reach and abs(delta) <= reach and lo <= h + delta <= hi:
            return h + delta, rotation(flight, delta), velocity(flight, delta)
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
    for _ in range(3):
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
