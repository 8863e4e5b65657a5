"""One Taylor step of the rocking block, slender or rigid, under any pulse: coefficients, size, value, zeros.

In the mirror image of a flight, z = |theta|/alpha and w = dz/dtau, (2.2) reads

    z'' = -S - T F C,  S = sin(alpha (1 - z))/alpha,  C = cos(alpha (1 - z)),  T = tan(alpha)/alpha,  F = sgn(theta) a f

and tends to (3.1) as alpha goes to 0 without a special form. S and C follow from S' = -C z', C' = alpha^2 S z'.
"""

from __future__ import annotations

import math

from rocking.compilation import Record, Vector, kernel
from rocking.scratch import ORDER, POLYNOMIAL

PRECISION = 1e-17
"""Share of the motion during a step that the last terms of the series may have."""


@kernel
def expand_pulse(flight: Record, phase: float) -> None:
    """Fill `flight.f` with the coefficients of F in powers of tau about `phase`."""
    f, omega = flight.f, flight.omega
    strength = flight.sign * flight.a
    for n in range(ORDER + 1):
        f[n] = 0.0
    if flight.spread > 0.0:
        # g = exp(-phi^2/spread): g' = -(2 phi/spread) g, so (n + 1) g_{n+1} = -(2/spread)(phi g_n + g_{n-1})
        gauss = flight.gauss
        gauss[0] = math.exp(-phase * phase / flight.spread)
        gauss[1] = -2.0 / flight.spread * phase * gauss[0]
        for n in range(1, ORDER):
            gauss[n + 1] = -2.0 / flight.spread * (phase * gauss[n] + gauss[n - 1]) / (n + 1)
        p = flight.polynomial
        shifted = (
            p[0] + phase * (p[1] + phase * (p[2] + phase * p[3])),
            p[1] + phase * (2.0 * p[2] + phase * 3.0 * p[3]),
            p[2] + 3.0 * phase * p[3],
            p[3],
        )
        power = strength
        for n in range(ORDER + 1):
            total = 0.0
            for k in range(min(n + 1, POLYNOMIAL)):
                total += shifted[k] * gauss[n - k]
            f[n] = power * total
            power *= omega
        return
    for k in range(len(flight.force)):
        angle = flight.multiple[k] * phase + flight.shift[k]
        rate = omega * flight.multiple[k]
        even, odd = strength * flight.amplitude[k] * math.cos(angle), -strength * flight.amplitude[k] * math.sin(angle)
        f[0] += even
        factor = 1.0
        for n in range(1, ORDER + 1):
            factor *= rate / n
            if n % 2 == 1:
                f[n] += factor * odd
                odd = -odd
            else:
                even = -even
                f[n] += factor * even


@kernel
def expand_motion(flight: Record, z0: float, w0: float) -> None:
    """Fill `flight.z` and `flight.rate_of_z` from z0, w0 and the pulse's coefficients."""
    z, rate, f = flight.z, flight.rate_of_z, flight.f
    z[0], z[1], rate[0] = z0, w0, w0
    alpha = flight.alpha
    if alpha == 0.0:  # (3.1)
        z[2] = 0.5 * (z0 - (1.0 + f[0]))
        rate[1] = 2.0 * z[2]
        for n in range(1, ORDER - 1):
            z[n + 2] = (z[n] - f[n]) / ((n + 1.0) * (n + 2.0))
            rate[n + 1] = (n + 2.0) * z[n + 2]
        return
    s, c = flight.s, flight.c
    s[0], c[0] = math.sin(alpha * (1.0 - z0)) / alpha, math.cos(alpha * (1.0 - z0))
    square, lean = alpha * alpha, math.tan(alpha) / alpha
    for n in range(ORDER - 1):
        pushed, sine, cosine = 0.0, 0.0, 0.0
        for j in range(n + 1):
            pushed += f[j] * c[n - j]
            sine -= c[n - j] * rate[j]
            cosine += s[n - j] * rate[j]
        z[n + 2] = -(s[n] + lean * pushed) / ((n + 1.0) * (n + 2.0))  # (2.2)
        rate[n + 1] = (n + 2.0) * z[n + 2]
        s[n + 1] = sine / (n + 1.0)
        c[n + 1] = square * cosine / (n + 1.0)


@kernel
def step_size(flight: Record) -> float:
    """Largest step on which the last two terms stay below `PRECISION` of the motion."""
    z = flight.z
    size = math.inf
    for k in (ORDER - 1, ORDER):
        if z[k] == 0.0:
            continue
        last = math.log(abs(z[k]))
        allowed = 0.0
        for j in range(4):
            if z[j] != 0.0:
                allowed = max(allowed, math.exp((math.log(PRECISION * abs(z[j])) - last) / (k - j)))
        size = min(size, allowed)
    return size


@kernel
def evaluate(series: Vector, top: int, h: float) -> float:
    """Value of the series of degree `top` at h."""
    total = series[top]
    for i in range(top):
        total = total * h + series[top - 1 - i]
    return total


@kernel
def slope(series: Vector, top: int, h: float) -> float:
    """Derivative of the series of degree `top` at h."""
    total = top * series[top]
    for i in range(top - 1):
        total = total * h + (top - 1 - i) * series[top - 1 - i]
    return total


@kernel
def polish(series: Vector, top: int, lo: float, hi: float, falling: bool, deflated: bool) -> float:
    """The zero of a series that falls or rises through it between lo and hi: Newton inside a shrinking bracket.

    `deflated` takes the series divided by h, to leave out its zero at the start of a flight.
    """
    h = 0.5 * (lo + hi)
    for _ in range(100):
        value, rate = evaluate(series, top, h), slope(series, top, h)
        if deflated:
            value /= h
            rate = (rate - value) / h
        if (value > 0.0) == falling:
            lo = h
        else:
            hi = h
        follow = h - value / rate if rate != 0.0 else lo
        if not lo <= follow <= hi:
            follow = 0.5 * (lo + hi)
        if abs(follow - h) <= 4.5e-16 * abs(h):
            return follow
        h = follow
    return h


@kernel
def first_crossing(series: Vector, top: int, lo: float, hi: float, falling: bool) -> float:
    """The first zero that the series crosses in that direction between lo and hi, or -1: exclusion, then Newton.

    On an interval of length l about m the series has no zero if |v(m)| > |v'(m)| l/2 + M l^2/8 and at most one if
    |v'(m)| > M l/2, where M bounds |v''| on the whole of [0, hi]; else the interval is halved.
    """
    bound = 0.0
    power = 1.0
    for n in range(2, top + 1):
        bound += n * (n - 1.0) * abs(series[n]) * power
        power *= hi
    left, size = lo, hi - lo
    smallest = 1e-9 * size
    while left < hi:
        middle, half = left + 0.5 * size, 0.5 * size
        value, rate = evaluate(series, top, middle), slope(series, top, middle)
        clear = abs(value) > abs(rate) * half + 0.5 * bound * half * half
        single = abs(rate) > bound * half
        if clear or single or size <= smallest:
            right = left + size
            if not clear and (rate < 0.0) == falling:
                at_left, at_right = evaluate(series, top, left), evaluate(series, top, right)
                if (at_left > 0.0 >= at_right) if falling else (at_left < 0.0 <= at_right):
                    return polish(series, top, left, right, falling, False)
            left = right
            size = min(2.0 * size, hi - left) if hi - left > smallest else hi - left
            if size <= 0.0:
                break
        else:
            size = half
    return -1.0
