"""First guesses of zeros by cubics, for `LANES` cells."""

from __future__ import annotations

from typing import Any

from rocking._numba.compilation import SimdVector, kernel
from rocking._numba.simd import select


@kernel
def hermite_roots(f0: SimdVector, d0: SimdVector, f1: SimdVector, d1: SimdVector, length: SimdVector) -> Any:
    """Guess of the zero in [0, length] of the cubic through two values of opposite sign with their slopes.

    Two Newton steps from the secant.
    """
    d0 = d0 * length
    d1 = d1 * length
    c2 = 3.0 * (f1 - f0) - 2.0 * d0 - d1
    c3 = 2.0 * (f0 - f1) + d0 + d1
    x = f0 / (f0 - f1)
    for _ in range(2):
        better = x - (f0 + x * (d0 + x * (c2 + x * c3))) / (d0 + x * (2.0 * c2 + x * 3.0 * c3))
        x = select((better > 0.0) & (better < 1.0), better, x)
    return x * length
