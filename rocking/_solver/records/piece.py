"""Motion of the slender block on a piece of a sample interval, exact: (3.1) with a ground acceleration linear in time.

In the mirror image of a flight z'' = z - q, and q = q0 + r s is its own particular solution. From z, w at s = 0

    z(s) = z + w s + C (cosh s - 1) + D (sinh s - s),   C = z - q0,   D = w - r
    w(s) = w + C sinh s + D (cosh s - 1)

increments that keep their digits on short flights. A piece does not contain a change of the sign of q inside:

- q >= 0: what has gone below zero stays below, by the maximum principle for z'' - z = -q: z has a zero if and only if
  it is not positive at the right end, and then exactly one.
- q <= 0: z'' >= 0 where z >= 0. A zero needs w < 0 at the left end; z has at most one minimum, and its sign at the
  right end or at the minimum decides. There is no maximum inside.
- w - r = C sinh s + D cosh s has at most one zero of its derivative, so w has at most two zeros. If w has equal signs
  at the ends, two zeros require a minimum (maximum) of w inside, where z'' changes its sign: tanh s = -C/D.
"""

from __future__ import annotations

import math

from rocking._numba.compilation import kernel

MAX_ITERATIONS = 200
"""Largest number of iterations of a root search; bisection alone needs about 60."""


@kernel
def hyperbolic(s: float) -> tuple[float, float, float]:
    """cosh(s) - 1, sinh(s) and sinh(s) - s for 0 <= s < 700, without cancellation."""
    x = s * s
    if s < 0.05:
        cosh1 = x * (0.5 + x * (1 / 24 + x * (1 / 720 + x * (1 / 40320))))
        above = s * x * (1 / 6 + x * (1 / 120 + x * (1 / 5040 + x * (1 / 362880))))
        return cosh1, s + above, above
    if s < 1.0:
        cosh1 = 1 / 20922789888000.0 + x * (1 / 6402373705728000.0)
        cosh1 = 1 / 3628800 + x * (1 / 479001600 + x * (1 / 87178291200.0 + x * cosh1))
        cosh1 = x * (0.5 + x * (1 / 24 + x * (1 / 720 + x * (1 / 40320 + x * cosh1))))
        above = 1 / 1307674368000.0 + x * (1 / 355687428096000.0 + x * (1 / 121645100408832000.0))
        above = 1 / 362880 + x * (1 / 39916800 + x * (1 / 6227020800.0 + x * above))
        above = s * x * (1 / 6 + x * (1 / 120 + x * (1 / 5040 + x * above)))
        return cosh1, s + above, above
    grown = math.exp(s)
    decayed = 1.0 / grown
    sinh = 0.5 * (grown - decayed)
    return 0.5 * (grown + decayed) - 1.0, sinh, sinh - s


@kernel
def piece_state(z: float, w: float, q0: float, r: float, s: float) -> tuple[float, float]:
    """(z, w) a time s after the start of a piece."""
    cosh1, sinh, above = hyperbolic(s)
    c = z - q0
    return z + (c * cosh1 + w * sinh - r * above), w + (c * sinh + (w - r) * cosh1)


@kernel
def next_time(
    s: float, value: float, rate: float, second: float, lo: float, hi: float, before: float
) -> tuple[float, float]:
    """Halley's step towards the zero of a function from its value and derivatives at `s`, or the middle of [lo, hi].

    Returns the next time and the length of the step, negative if the step after it would be below rounding: the error
    is cubed at each step, so that the next one is step^4/before^3 where `before` is the length of the one before.
    """
    following = 0.5 * (lo + hi)
    if rate != 0.0:
        newton = -value / rate
        halley = s + newton / (1.0 + 0.5 * newton * second / rate)
        following = halley if lo <= halley <= hi else following
    step = abs(following - s)
    fourth = step * step * (step * step)
    done = fourth <= 1e-16 * following * (before * before * before) or step <= 1e-16 * following
    return following, -step if done else step


@kernel
def impact_time(z: float, w: float, q0: float, r: float, lo: float, hi: float, guess: float) -> float:
    """The time in (lo, hi] at which z falls to zero: bracketed Halley iteration.

    From the ground (z = 0) the iteration is on z/s, which removes the zero at the start.
    """
    from_ground = z == 0.0
    s = guess if lo < guess < hi else 0.5 * (lo + hi)
    step = 0.0
    for _ in range(MAX_ITERATIONS):
        value, rate = piece_state(z, w, q0, r, s)
        second = value - (q0 + r * s)
        if from_ground:
            value /= s
            rate = (rate - value) / s
            second = (second - 2.0 * rate) / s
        if value > 0.0:
            lo = s
        else:
            hi = s
        s, step = next_time(s, value, rate, second, lo, hi, step)
        if step <= 0.0:
            break
    return s


@kernel
def velocity_zero(z: float, w: float, q0: float, r: float, lo: float, hi: float, guess: float, falling: bool) -> float:
    """The time between lo and hi at which w crosses zero in the given direction: bracketed Halley iteration."""
    s, step = guess, 0.0
    for _ in range(MAX_ITERATIONS):
        at, rate = piece_state(z, w, q0, r, s)
        if (rate > 0.0) == falling:
            lo = s
        else:
            hi = s
        s, step = next_time(s, rate, at - (q0 + r * s), rate - r, lo, hi, step)
        if step <= 0.0:
            break
    return s


@kernel
def highest_in_piece(z: float, w: float, q0: float, r: float, length: float, w1: float) -> float:
    """Largest maximum of z inside a piece with q >= 0 that ends with the velocity `w1`; 0 if there is none."""
    lo, hi, guess = 0.0, length, length * (w / (w - w1))
    c, d = z - q0, w - r
    if (w > 0.0) == (w1 > 0.0):
        # w has two zeros or none: both lie on different sides of its extremum
        if (w > 0.0) != (c < 0.0) or abs(c) >= abs(d) or c * d >= 0.0:
            return 0.0
        turn = math.atanh(-c / d)
        if turn >= length or (piece_state(z, w, q0, r, turn)[1] > 0.0) == (w > 0.0):
            return 0.0
        if w > 0.0:
            hi = turn
        else:
            lo = turn
        guess = 0.5 * (lo + hi)
    elif w1 > 0.0:
        return 0.0
    top = velocity_zero(z, w, q0, r, lo, hi, guess, True)
    return float(piece_state(z, w, q0, r, top)[0])


@kernel
def follow_piece(
    z: float, w: float, q0: float, r: float, length: float, restoring: bool, known: float
) -> tuple[float, float, float, float]:
    """Follow a piece from z >= 0 and w; `known` is a rotation that has been reached before.

    Returns
    -------
    Time of the impact, -1 if there is none; z and w there or at the right end; the largest maximum of z inside, if it
    exceeds `known`, else 0.
    """
    z1, w1 = piece_state(z, w, q0, r, length)
    impact = -1.0
    if restoring:
        if z1 <= 0.0:
            guess = 2.0 * w / q0 if z == 0.0 and q0 > 0.0 else length * (z / (z - z1))
            impact = impact_time(z, w, q0, r, 0.0, length, guess)
    elif w < 0.0:
        if z1 <= 0.0:
            impact = impact_time(z, w, q0, r, 0.0, length, length * (z / (z - z1)))
        elif w1 > 0.0:
            bottom = velocity_zero(z, w, q0, r, 0.0, length, length * (w / (w - w1)), False)
            if piece_state(z, w, q0, r, bottom)[0] <= 0.0:
                impact = impact_time(z, w, q0, r, 0.0, bottom, 0.5 * bottom)
    if impact >= 0.0:
        z1, w1, length = 0.0, min(piece_state(z, w, q0, r, impact)[1], 0.0), impact
    top = 0.0
    if restoring:
        # z <= max(z, z1) + (largest -z'')/8 length^2
        sagitta = 0.125 * length * length * max(q0, q0 + r * length)
        if max(z, z1) + sagitta > known:
            top = highest_in_piece(z, w, q0, r, length, w1)
    return impact, z1, w1, top
