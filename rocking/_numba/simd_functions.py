"""Functions of a SIMD vector: exponential, hyperbolic, sine and cosine, arc cosine, error function.

The functions of the C library take one number, and four calls of a sine cost as much as the rest of a Taylor step.
Relative errors of the exponentials are below 6e-16. For sine and cosine the angle is reduced to [-pi/4, pi/4] in two
parts (Cody and Waite), followed by the polynomials of fdlibm (Sun Microsystems 1993): about one ulp of error up to 1e8.
"""

from typing import Any

from rocking._numba.compilation import SimdVector, kernel
from rocking._numba.simd import (
    cosine_of_quadrant,
    maximum,
    minimum,
    power_of_two,
    select,
    sine_of_quadrant,
    splat,
    square_root,
)

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


ROUNDING_CONSTANT = 6755399441055744.0  # 1.5 * 2**52 [-]: adding and subtracting it rounds to the nearest integer
HALF_PI, HALF_PI_LOW = 1.5707963267948966, 6.123233995736766e-17  # pi/2 as the sum of two doubles


@kernel
def round_to_nearest(x: SimdVector) -> Any:
    """The nearest integer, lane by lane."""
    return (x + ROUNDING_CONSTANT) - ROUNDING_CONSTANT


@kernel
def sine_and_cosine(angle: SimdVector) -> Any:
    """Sine and cosine of angles [rad]."""
    quarters = round_to_nearest(angle * (1.0 / HALF_PI))
    r = (angle - quarters * HALF_PI) - quarters * HALF_PI_LOW
    x = r * r
    sine = r + r * x * (
        -1.66666666666666324348e-01
        + x * (8.33333333332248946124e-03
        + x * (-1.98412698298579493134e-04
        + x * (2.75573137070700676789e-06
        + x * (-2.50507602534068634195e-08
        + x * 1.58969099521155010221e-10))))
    )  # fmt: skip
    tail = x * x * (
        4.16666666666666019037e-02
        + x * (-1.38888888888741095749e-03
        + x * (2.48015872894767294178e-05
        + x * (-2.75573143513906633035e-07
        + x * (2.08757232129817482790e-09
        + x * -1.13596475577881948265e-11))))
    )  # fmt: skip
    whole = 1.0 - 0.5 * x
    cosine = whole + (((1.0 - whole) - 0.5 * x) + tail)
    return sine_of_quadrant(quarters, sine, cosine), cosine_of_quadrant(quarters, sine, cosine)


CENTRE = 3.75  # x at which the variable t of the polynomial is 0 (Shepherd & Laframboise 1981)


@kernel
def scaled_erfc(x: SimdVector) -> Any:
    """exp(x^2) erfc(x) for x >= 0, with a relative error below 8e-16.

    (1 + 2 x) exp(x^2) erfc(x) is a polynomial of degree 23 in t = (x - 3.75)/(x + 3.75), the Chebyshev series on
    [-1, 1] in powers of t; the next terms add up to 6e-17.
    """
    shifted, doubled = x + CENTRE, 1.0 + 2.0 * x
    inverse = 1.0 / (shifted * doubled)
    t = (x - CENTRE) * (doubled * inverse)
    s = t * t
    even = (
        1.2375126308378275
        + s * (0.0035854154854790257
        + s * (-0.10880393014244462
        + s * (-0.05869339857664934
        + s * (-0.009746579683265262
        + s * (0.000293714378044958
        + s * (5.164652974177416e-05
        + s * (-1.1438048033346894e-05
        + s * (1.7419821586224816e-06
        + s * (-2.4857126248016745e-07
        + s * (3.197926671666804e-08
        + s * -2.623107347133476e-09))))))))))
    )  # fmt: skip
    odd = (
        -0.14024059858554697
        + s * (0.0822767384901452
        + s * (0.09230432116037748
        + s * (0.028362277418956406
        + s * (0.0017556258528952954
        + s * (-0.0002901540805408417
        + s * (2.238423915508223e-05
        + s * (-9.73559896736775e-07
        + s * (-5.7218230603224086e-08
        + s * (2.3263508708859124e-08
        + s * (-3.744210080962018e-09
        + s * 3.1114333809799254e-10))))))))))
    )  # fmt: skip
    return (even + t * odd) * (shifted * inverse)
