"""Sine and cosine of a SIMD vector of angles.

The functions of the C library take one angle, and four calls cost as much as the rest of a Taylor step. The angle is
reduced to [-pi/4, pi/4] in two parts (Cody and Waite), followed by the polynomials of fdlibm (Sun Microsystems 1993).
The error is about one ulp for angles up to 1e8.
"""

from typing import Any

from rocking._numba.compilation import SimdVector, kernel
from rocking._numba.simd import cosine_of_quadrant, sine_of_quadrant

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
