"""Free rocking after the pulse: the outcome follows from the energy, without integration.

With z = |theta|/alpha and w = dz/dtau let X(z) = (2/alpha) sin(alpha (1 - z)/2), which is 1 - z in the slender limit.
(2.2) without ground motion conserves X^2 - w^2 between impacts, with the barrier at X = 0 (theta = alpha). The block
escapes when w >= X, which is (3.8) in the slender limit; otherwise it returns, and at most one more impact can matter.
"""

from __future__ import annotations

import math

from rocking._numba.compilation import kernel


@kernel
def free_outcome(z: float, w: float, eta: float, alpha: float) -> tuple[int, float, int]:
    """Outcome from the rotation z >= 0 and the velocity w at the end of the pulse.

    Parameters
    ----------
    z, w : float
        |theta|/alpha, below pi/(2 alpha), and its rate with respect to tau [-].
    eta : float
        Coefficient of restitution [-], [0, 1].
    alpha : float
        Slenderness angle [rad], [0, pi/2); 0 is the slender limit.

    Returns
    -------
    escapes : int
        0: comes to rest, 1: overturns without another impact, 2: overturns after the next impact.
    peak : float
        Largest z from then on [-] if the block does not overturn.
    after : int
        1 if that peak is after the next impact, else 0.
    """
    if alpha == 0.0:
        barrier, x = 1.0, 1.0 - z
        climbed = z * (2.0 - z)  # X(0)^2 - X(z)^2
    else:
        barrier, x = 2.0 * math.sin(0.5 * alpha) / alpha, 2.0 * math.sin(0.5 * alpha * (1.0 - z)) / alpha
        climbed = 4.0 * math.sin(0.5 * alpha * z) * math.sin(0.5 * alpha * (2.0 - z)) / (alpha * alpha)
    if w >= x:  # (3.8): B >= 0
        return 1, math.inf, 0
    # square of the impact velocity, (3.15); the second form has no cancellation far beyond alpha
    squared = w * w + climbed if x > 0.0 else barrier * barrier - (x - w) * (x + w)
    if w > 0.0:  # z increases first; since w < X, the impact velocity, and eta times it, is smaller than the barrier
        return 0, highest_rotation(squared, math.sqrt((x - w) * (x + w)), barrier, alpha), 0
    rebound = eta * eta * squared
    if rebound >= barrier * barrier:  # (3.16), (3.17)
        return 2, math.inf, 1
    peak = highest_rotation(rebound, math.sqrt(barrier * barrier - rebound), barrier, alpha)
    if peak > z:
        return 0, peak, 1
    return 0, z, 0


@kernel
def highest_rotation(squared: float, left: float, barrier: float, alpha: float) -> float:
    """Largest z of a block with squared velocity `squared` at z = 0, where X(z) = `left`, (4.12), (4.13).

    With X = (2/alpha) sin B and the barrier (2/alpha) sin A, alpha z/2 = A - B is taken from
    sin(A - B) = (sin^2 A - sin^2 B)/(sin A cos B + cos A sin B), which has no cancellation for small z.
    """
    if alpha == 0.0:
        return squared / (1.0 + left)
    half = 0.5 * alpha
    cos_a = math.cos(half)
    cos_b = math.sqrt((1.0 - half * left) * (1.0 + half * left))
    return math.asin(half * squared / (barrier * cos_b + left * cos_a)) / half
