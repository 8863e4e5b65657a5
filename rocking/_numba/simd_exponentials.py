"""Exponential and hyperbolic functions and the arc cosine of a SIMD vector.

The functions of the C library take one number. All relative errors are below 6e-16.
"""

from typing import Any

from rocking._numba.compilation import SimdVector, kernel
from rocking._numba.simd import maximum, minimum, power_of_two, select, splat, square_root
from rocking._numba.simd_sines import HALF_PI, round_to_nearest

MAX_EXPONENT = 350.0
"""e^350 determines the sign of any growing term that is not exactly zero, and its square does not overflow."""

SMALLEST_EXPONENT = 700.0  # e^-700 is close to the smallest number with all digits

LOG_2, LOG_2_LOW = 6.93147180369123816490e-01, 1.90821492927058770002e-10
"""log(2) as the sum of two doubles; the first has 21 trailing zero bits."""


@kernel
def reduced_exponential(exponent: SimdVector) -> Any:
    """2^k and e^r - 1 with `exponent` = k log(2) + r, |r| <= log(2)/2, by the Taylor series of degree 13."""
    whole = round_to_nearest(exponent * (1.0 / (LOG_2 + LOG_2_LOW)))
    r = (exponent - whole * LOG_2) - whole * LOG_2_LOW
    x = r * r
    even = x * (
        1 / 2 + x * (1 / 24 + x * (1 / 720 + x * (1 / 40320 + x * (1 / 3628800 + x * (1 / 479001600)))))
    )  # fmt: skip
    odd = r * x * (
        1 / 6 + x * (1 / 120 + x * (1 / 5040 + x * (1 / 362880 + x * (1 / 39916800 + x * (1 / 6227020800)))))
    )  # fmt: skip
    return power_of_two(whole), r + (even + odd)


@kernel
def exponential(x: SimdVector) -> Any:
    """e^x for x <= `MAX_EXPONENT`; x is limited to -`SMALLEST_EXPONENT` from below."""
    power, grown = reduced_exponential(maximum(x, splat(-SMALLEST_EXPONENT)))
    return power + power * grown


@kernel
def cosh_minus_one_and_sinh(h: SimdVector) -> Any:
    """cosh(h) - 1 and sinh(h) for h >= 0, without cancellation; h is limited to `MAX_EXPONENT`.

    With E = e^h - 1 and D = E/(1 + E) = 1 - e^-h they are E D/2 and (E + D)/2, with E = 2^k (e^r - 1) + (2^k - 1).
    """
    power, grown = reduced_exponential(minimum(h, splat(MAX_EXPONENT)))
    grown = power * grown + (power - 1.0)
    decayed = grown / (1.0 + grown)
    return 0.5 * grown * decayed, 0.5 * (grown + decayed)


@kernel
def arccosine(x: SimdVector) -> Any:
    """The arc cosine [rad] of 0 <= x <= 1, by the rational function of fdlibm (Sun Microsystems 1993).

    It is pi/2 - asin(x) below 1/2, else 2 asin(sqrt((1 - x)/2)), which keeps the digits for x close to 1.
    """
    small = x < 0.5
    square = select(small, x * x, 0.5 * (1.0 - x))
    root = select(small, x, square_root(square))
    above = square * (
        1.66666666666666657415e-01
        + square * (-3.25565818622400915405e-01
        + square * (2.01212532134862925881e-01
        + square * (-4.00555345006794114027e-02
        + square * (7.91534994289814532176e-04
        + square * 3.47933107596021167570e-05))))
    )  # fmt: skip
    below = 1.0 + square * (
        -2.40339491173441421878e00
        + square * (2.02094576023350569471e00
        + square * (-6.88283971605453293030e-01
        + square * 7.70381505559019352791e-02))
    )  # fmt: skip
    angle = root + root * (above / below)
    return select(small, HALF_PI - angle, 2.0 * angle)
