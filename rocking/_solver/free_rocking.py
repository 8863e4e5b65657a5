"""Free rocking after the pulse: the outcome follows from the energy, without integration.

With z = |theta|/alpha and w = dz/dtau let X(z) = (2/alpha) sin(alpha (1 - z)/2), which is 1 - z in the slender limit.
(2.2) without ground motion conserves X^2 - w^2 between impacts, with the barrier at X = 0 (theta = alpha). The block
escapes when w >= X, which is (3.8) in the slender limit; otherwise it returns. `rocking._solver.rules.final_outcome`
says which impacts after the motion can matter. The functions hold for a block in its own time p t and angle alpha;
edges that differ are scaled by the caller.
"""

import math
from typing import Any

from rocking._numba.compilation import kernel
from rocking._numba.simd import select


@kernel
def barrier_of(alpha: float) -> float:
    """X(0) [-]: the velocity at z = 0 from which the block passes alpha."""
    return 1.0 if alpha == 0.0 else 2.0 * math.sin(0.5 * alpha) / alpha


@kernel
def release(z: float, w: float, alpha: float) -> tuple[bool, float, float]:
    """What follows from the rotation z >= 0 and the velocity w at the end of the motion, up to the next impact.

    `z`, `w`: |theta|/alpha, below pi/(2 alpha), and its rate with respect to tau [-]. `alpha`: slenderness angle [rad],
    [0, pi/2); 0 is the slender limit. Returns `escapes`: whether the block overturns without another impact, (3.8);
    `top`: largest z up to the impact [-]; `squared`: square of the velocity at the impact, (3.15).
    """
    barrier = barrier_of(alpha)
    if alpha == 0.0:
        x, squared = slender_energy(z, w)
    else:
        x = 2.0 * math.sin(0.5 * alpha * (1.0 - z)) / alpha
        # X(0)^2 - X(z)^2 as a product: for small z the difference of the squares would lose its digits
        climbed = 4.0 * math.sin(0.5 * alpha * z) * math.sin(0.5 * alpha * (2.0 - z)) / (alpha * alpha)
        squared = w * w + climbed if x > 0.0 else barrier * barrier - (x - w) * (x + w)
    if w >= x:  # (3.8): B >= 0
        return True, math.inf, math.inf
    if w > 0.0:  # z increases first, to where the velocity is used up: X(z)^2 = X^2 - w^2
        return False, highest_rotation(squared, math.sqrt((x - w) * (x + w)), barrier, alpha), squared
    return False, z, squared


@kernel
def slender_energy(z: Any, w: Any) -> Any:
    """X and the squared velocity at the next impact of a slender block, from a number each or a SIMD vector each.

    The second form of the latter has no cancellation far beyond alpha.
    """
    x = 1.0 - z
    return x, select(x > 0.0, w * w + z * (2.0 - z), 1.0 - (x - w) * (x + w))


@kernel
def slender_top(squared: Any, left: Any) -> Any:
    """`highest_rotation` of a slender block, of numbers or SIMD vectors: without cancellation."""
    return squared / (1.0 + left)


@kernel
def highest_rotation(squared: float, left: float, barrier: float, alpha: float) -> float:
    """Largest z of a block with squared velocity `squared` at z = 0, where X(z) = `left`, (4.12), (4.13).

    With X = (2/alpha) sin B and the barrier (2/alpha) sin A, alpha z/2 = A - B is taken from
    sin(A - B) = (sin^2 A - sin^2 B)/(sin A cos B + cos A sin B), which has no cancellation for small z.
    """
    if alpha == 0.0:
        return float(slender_top(squared, left))
    half = 0.5 * alpha
    cos_a = math.cos(half)
    cos_b = math.sqrt((1.0 - half * left) * (1.0 + half * left))
    return math.asin(half * squared / (barrier * cos_b + left * cos_a)) / half
