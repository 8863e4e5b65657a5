"""Exact arcs of the slender block under a sum of sinusoids, (3.4), without overflow and cancellation.

A flight is described by z = sgn(theta) theta/alpha >= 0 and w = dz/dtau. By (3.1), z'' = z - q with q = 1 + F and
F = sgn(theta) a f. From its start, where z = 0, the solution is written as an increment
with cosh h - 1 and sinh h: the coefficients A, B of (3.4) would lose all digits on short flights. Close to a known
state it is expanded in a Taylor series, which needs no transcendental function.

`cosine` and `sine` are those of the angles w_k phi + d_k, shape (terms,), at the point considered. The fields of the
record `flight` are in `rocking._solver.state`.
"""

from __future__ import annotations

import math

from rocking._numba.compilation import FloatArray, Record, kernel
from rocking._solver.families.sinusoids import SERIES_LENGTH

MAX_EXPONENT = 350.0
"""e^350 determines the sign of any growing term that is not exactly zero, and its square does not overflow."""

SERIES_RADIUS = 0.68
"""Largest max(1, Omega) |delta| at which the series below is exact to rounding: 0.68^16/16! = 1e-16."""


@kernel
def cosh_minus_one_and_sinh(h: float) -> tuple[float, float]:
    """cosh(h) - 1 and sinh(h) for h >= 0, without cancellation."""
    if h < 0.5:
        x = h * h
        sinh = 1 / 362880 + x * (1 / 39916800 + x / 6227020800.0)
        sinh = h + h * x * (1 / 6 + x * (1 / 120 + x * (1 / 5040 + x * sinh)))
        cosh1 = 1 / 3628800 + x * (1 / 479001600 + x / 87178291200.0)
        cosh1 = x * (0.5 + x * (1 / 24 + x * (1 / 720 + x * (1 / 40320 + x * cosh1))))
        return cosh1, sinh
    grown = math.exp(min(h, MAX_EXPONENT))
    decayed = 1.0 / grown
    return 0.5 * (grown + decayed) - 1.0, 0.5 * (grown - decayed)


@kernel
def init_arc(flight: Record) -> None:
    """Coefficients of the arc from the start of the flight; `force`, `w0`, `cosine0` and `sine0` must be set."""
    x0, y0, offset_z, offset_w = -1.0, flight.w0, 0.0, flight.w0
    for k in range(flight.terms):
        particular = flight.force[k] / (flight.rate[k] * flight.rate[k] + 1.0)
        flight.particular[k] = particular
        offset_z -= particular * flight.cosine0[k]
        x0 -= particular * flight.cosine0[k]
        y0 += particular * flight.rate[k] * flight.sine0[k]
        offset_w += particular * flight.rate[k] * flight.sine0[k]
    flight.x0, flight.y0, flight.offset_z, flight.offset_w = x0, y0, offset_z, offset_w


@kernel
def arc_state(flight: Record, h: float, cosine: FloatArray, sine: FloatArray) -> tuple[float, float]:
    """State (z, w) a time h after the start of the flight (z = 0, w = w0), with the cosines and sines of the angles.

    (3.4) with `particular` = F_k/(Omega_k^2 + 1) as the particular part, regrouped as increments from the start.
    """
    moved, offset_w = flight.offset_z, flight.offset_w
    for k in range(flight.terms):
        moved += flight.particular[k] * cosine[k]
        offset_w -= flight.particular[k] * flight.rate[k] * sine[k]
    cosh1, sinh = cosh_minus_one_and_sinh(h)
    return moved + (flight.x0 * cosh1 + flight.y0 * sinh), offset_w + (flight.x0 * sinh + flight.y0 * cosh1)


@kernel
def restoring_acceleration(flight: Record, cosine: FloatArray) -> float:
    """Restoring acceleration q = 1 + F [-]."""
    q = 1.0
    for k in range(flight.terms):
        q += flight.force[k] * cosine[k]
    return q


@kernel
def expand_series(flight: Record, z: float, w: float, q: float, cosine: FloatArray, sine: FloatArray) -> None:
    """Fill `flight.coef` with the Taylor coefficients of z about a point; q is given since it is exactly 0 at uplift.

    z'' = z - 1 - F gives (n + 1)(n + 2) z_{n+2} = z_n - F_n.
    """
    coef = flight.coef
    for n in range(1, SERIES_LENGTH - 2):
        coef[n + 2] = 0.0
    for k in range(flight.terms):  # coef[n + 2] becomes F_n
        scaled, rate, cosine_k, sine_k = flight.force[k], flight.rate[k], cosine[k], sine[k]
        for n in range(1, SERIES_LENGTH - 2):
            scaled *= rate * (1.0 / n)
            turned = n % 4  # derivatives of cos run cos, -sin, -cos, sin
            if turned == 0:
                coef[n + 2] += scaled * cosine_k
            elif turned == 1:
                coef[n + 2] -= scaled * sine_k
            elif turned == 2:
                coef[n + 2] -= scaled * cosine_k
            else:
                coef[n + 2] += scaled * sine_k
    coef[0] = z
    coef[1] = w
    coef[2] = 0.5 * (z - q)
    for n in range(1, SERIES_LENGTH - 2):
        coef[n + 2] = (coef[n] - coef[n + 2]) * (1.0 / ((n + 1.0) * (n + 2.0)))


@kernel
def rotation(flight: Record, delta: float) -> float:
    """z at `delta` from the point of expansion, by Estrin's scheme."""
    c = flight.coef
    d2 = delta * delta
    d4 = d2 * d2
    low = (c[0] + c[1] * delta) + d2 * (c[2] + c[3] * delta)
    middle = (c[4] + c[5] * delta) + d2 * (c[6] + c[7] * delta)
    high = (c[8] + c[9] * delta) + d2 * (c[10] + c[11] * delta)
    top = (c[12] + c[13] * delta) + d2 * (c[14] + c[15] * delta) + d4 * c[16]
    return low + d4 * (middle + d4 * (high + d4 * top))


@kernel
def velocity(flight: Record, delta: float) -> float:
    """w = dz/dtau at `delta`."""
    c = flight.coef
    d2 = delta * delta
    d4 = d2 * d2
    low = (c[1] + 2.0 * c[2] * delta) + d2 * (3.0 * c[3] + 4.0 * c[4] * delta)
    middle = (5.0 * c[5] + 6.0 * c[6] * delta) + d2 * (7.0 * c[7] + 8.0 * c[8] * delta)
    high = (9.0 * c[9] + 10.0 * c[10] * delta) + d2 * (11.0 * c[11] + 12.0 * c[12] * delta)
    top = (13.0 * c[13] + 14.0 * c[14] * delta) + d2 * (15.0 * c[15] + 16.0 * c[16] * delta)
    return low + d4 * (middle + d4 * (high + d4 * top))


@kernel
def acceleration(flight: Record, delta: float) -> float:
    """z'' at `delta`."""
    c = flight.coef
    d2 = delta * delta
    d4 = d2 * d2
    low = (2.0 * c[2] + 6.0 * c[3] * delta) + d2 * (12.0 * c[4] + 20.0 * c[5] * delta)
    middle = (30.0 * c[6] + 42.0 * c[7] * delta) + d2 * (56.0 * c[8] + 72.0 * c[9] * delta)
    high = (90.0 * c[10] + 110.0 * c[11] * delta) + d2 * (132.0 * c[12] + 156.0 * c[13] * delta)
    top = (182.0 * c[14] + 210.0 * c[15] * delta) + d2 * (240.0 * c[16])
    return low + d4 * (middle + d4 * (high + d4 * top))


@kernel
def jerk(flight: Record, delta: float) -> float:
    """z''' at `delta` to a few digits, sufficient for the scale of corrections."""
    c = flight.coef
    low = 6.0 * c[3] + delta * (24.0 * c[4] + delta * (60.0 * c[5] + delta * 120.0 * c[6]))
    return low + delta**4 * (210.0 * c[7] + delta * 336.0 * c[8])
