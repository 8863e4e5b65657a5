"""Motion of the slender block on a piece of a sample interval, exact: (3.1) with a ground acceleration linear in time.

z = |theta|/alpha obeys z'' = z - q, and q = q0 + r s is its own particular solution. From z, w at s = 0

    z(s) = z + w s + C (cosh s - 1) + D (sinh s - s),   C = z - q0,   D = w - r
    w(s) = w + C sinh s + D (cosh s - 1)

increments that keep their digits on short flights. `follow_piece` decides whether a piece holds an impact and a peak.
None is missed, since q does not change its sign inside a piece:

- q >= 0, restored: what has gone below zero stays below, by the maximum principle for z'' - z = -q. z has a zero if and
  only if it is not positive at the right end, and then exactly one.
- q <= 0, destabilised: z'' >= 0 where z >= 0. A zero needs w < 0 at the left end; z has at most one minimum, and its
  sign at the right end or at the minimum decides. There is no maximum inside.
- Peaks: w - r = C sinh s + D cosh s has at most one zero of its derivative, so w has at most two zeros. If w has equal
  signs at the ends, two zeros require a minimum (maximum) of w inside, where z'' changes its sign: tanh s = -C/D.
"""

import math

from rocking._numba.compilation import kernel

MAX_ITERATIONS = 200  # largest number of iterations of a root search; bisection alone needs about 60


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
    s: float, value: float, rate: float, second: float, third: float, lo: float, hi: float
) -> tuple[float, bool]:
    """Halley's step towards the zero of a function from its value and derivatives at `s`, or the middle of [lo, hi].

    Returns the next time and whether its error is below rounding: a step of length d leaves an error of
    d^3 |(second/(2 rate))^2 - third/(6 rate)|, whose two terms are added here.
    """
    halley, error = lo - 1.0, 0.0  # outside of the bracket: halve it
    if rate != 0.0:
        inverse = 1.0 / rate
        newton = -value * inverse
        bend = 0.5 * newton * (second * inverse)
        halley = s + newton / (1.0 + bend)
        error = abs(newton) * min(bend * bend + abs(newton * newton * (third * inverse)) * (1 / 6), 1.0)
    if lo <= halley <= hi:
        return halley, error <= 1e-17 * halley
    middle = 0.5 * (lo + hi)
    return middle, abs(middle - s) <= 1e-16 * middle


@kernel
def impact_time(z: float, w: float, q0: float, r: float, length: float, z1: float) -> float:
    """The time in (0, length] at which z falls to zero, `z1` <= 0 being z at the end: bracketed Halley iteration.

    It starts from the zero of the parabola with z, w and z1. From the ground (z = 0), where many flights are short, it
    starts from that with z, w and z'', and is on z/s, which removes the zero at the start.
    """
    from_ground = z == 0.0
    # the zero of z + w s + curvature s^2, by the form of the quadratic formula that does not cancel
    curvature = -0.5 * q0 if from_ground and q0 > 0.0 else (z1 - z - w * length) / (length * length)
    root = math.sqrt(max(w * w - 4.0 * curvature * z, 0.0))
    s = 2.0 * z / (root - w) if w < 0.0 else -0.5 * (root + w) / curvature
    lo, hi = 0.0, length
    if not lo < s < hi:
        s = 0.5 * hi
    for _ in range(MAX_ITERATIONS):
        value, rate = piece_state(z, w, q0, r, s)
        second, third = value - (q0 + r * s), rate - r
        if from_ground:  # z/s and its derivatives
            inverse = 1.0 / s
            value *= inverse
            rate = (rate - value) * inverse
            second = (second - 2.0 * rate) * inverse
            third = (third - 3.0 * second) * inverse
        if value > 0.0:
            lo = s
        else:
            hi = s
        s, done = next_time(s, value, rate, second, third, lo, hi)
        if done:
            break
    return s


@kernel
def velocity_zero(z: float, w: float, q0: float, r: float, lo: float, hi: float, guess: float, falling: bool) -> float:
    """The time between lo and hi at which w crosses zero in the given direction: bracketed Halley iteration."""
    s = guess
    for _ in range(MAX_ITERATIONS):
        at, rate = piece_state(z, w, q0, r, s)
        if (rate > 0.0) == falling:
            lo = s
        else:
            hi = s
        acceleration = at - (q0 + r * s)
        s, done = next_time(s, rate, acceleration, rate - r, acceleration, lo, hi)
        if done:
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
            return 0.0  # w moves away from zero at first, or has no extremum
        turn = math.atanh(-c / d)
        if turn >= length or (piece_state(z, w, q0, r, turn)[1] > 0.0) == (w > 0.0):
            return 0.0  # the extremum lies beyond the piece, or w does not reach zero there
        # of the two zeros the one at which w falls is the peak: before a minimum of w, after a maximum
        if w > 0.0:
            hi = turn
        else:
            lo = turn
        guess = 0.5 * (lo + hi)
    elif w1 > 0.0:  # the only zero is a minimum of z
        return 0.0
    top = velocity_zero(z, w, q0, r, lo, hi, guess, True)
    return float(piece_state(z, w, q0, r, top)[0])


@kernel
def follow_piece(
    z: float, w: float, q0: float, r: float, length: float, restoring: bool, known: float
) -> tuple[float, float, float, float]:
    """Follow a piece from z >= 0 and w; `known` is a rotation that has been reached before.

    Returns the time of the impact, -1 if there is none; z and w there or at the right end; the largest maximum of z
    inside if it exceeds `known`, else 0.
    """
    z1, w1 = piece_state(z, w, q0, r, length)
    impact = -1.0
    if restoring:
        if z1 <= 0.0:
            impact = impact_time(z, w, q0, r, length, z1)
    elif w < 0.0:  # destabilised, but it still falls
        if z1 <= 0.0:
            impact = impact_time(z, w, q0, r, length, z1)
        elif w1 > 0.0:  # it has turned inside: the minimum decides
            bottom = velocity_zero(z, w, q0, r, 0.0, length, length * (w / (w - w1)), False)
            lowest = piece_state(z, w, q0, r, bottom)[0]
            if lowest <= 0.0:
                impact = impact_time(z, w, q0, r, bottom, lowest)
    if impact >= 0.0:  # the piece ends here; rounding must not make w positive
        z1, w1, length = 0.0, min(piece_state(z, w, q0, r, impact)[1], 0.0), impact
    top = 0.0
    if restoring:
        # z <= max(z, z1) + (largest -z'')/8 length^2
        sagitta = 0.125 * length * length * max(q0, q0 + r * length)
        if max(z, z1) + sagitta > known:
            top = highest_in_piece(z, w, q0, r, length, w1)
    return impact, z1, w1, top
