"""Sine and cosine of `LANES` angles at once.

The C library takes one angle at a time, and four of them would cost as much as the rest of a Taylor step together.
Reduction to [-pi/4, pi/4] in two parts, then the polynomials of fdlibm (Sun Microsystems 1993), good to an ulp for
angles up to about 1e8.
"""

from __future__ import annotations

from typing import Any

from rocking._numba.compilation import SimdVector, kernel

ROUNDING_CONSTANT = 6755399441055744.0
"""1.5 * 2**52: adding and subtracting it rounds to the nearest whole number."""

HALF_PI, HALF_PI_LOW = 1.5707963267948966, 6.123233995736766e-17
"""pi/2 as a double, and what that leaves out."""


@kernel
def round_to_nearest(x: SimdVector) -> Any:
    """The nearest whole number."""
    return (x + ROUNDING_CONSTANT) - ROUNDING_CONSTANT


@kernel
def sine_and_cosine(angle: SimdVector) -> Any:
    """Both of them."""
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
    # quarters = 2 halves + odd: an odd quarter swaps the two, an odd half turns both
    halves = round_to_nearest(quarters * 0.5 - 0.25)
    odd = quarters - 2.0 * halves
    turned = halves - 2.0 * round_to_nearest(halves * 0.5 - 0.25)
    side = 1.0 - 2.0 * turned
    even = 1.0 - odd
    return side * (even * sine + odd * cosine), side * (even * cosine - odd * sine)
