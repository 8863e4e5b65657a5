"""Free rocking of the slender block after the pulse: energy alone decides, nothing is integrated.

With z = |theta|/alpha and w = dz/dtau, (3.5) conserves (1 - z)^2 - w^2 between impacts; the block escapes when the
growing exponential has a positive coefficient, z + w > 1, which is (3.8), and at most one more impact can matter.
"""

from __future__ import annotations

import math

from rocking.compilation import kernel


@kernel
def free_fate(z: float, w: float, eta: float) -> tuple[int, float, int]:
    """Fate from rotation z >= 0 and velocity w at the end of the pulse, slender block.

    Parameters
    ----------
    z, w : float
        |theta|/alpha and its rate with respect to tau [-].
    eta : float
        Coefficient of restitution [-], [0, 1].

    Returns
    -------
    escapes : int
        0: returns and rocks to rest, 1: overturns without another impact, 2: overturns after the next impact.
    peak : float
        Largest z from now on [-] if it returns.
    after : int
        1 if that peak comes after the next impact, else 0.
    """
    if z + w >= 1.0:  # (3.8): B >= 0
        return 1, math.inf, 0
    # 1 - D, D = (1 - z)^2 - w^2, is the square of the impact velocity (3.15); two forms, neither cancels
    squared = w * w + z * (2.0 - z) if z < 1.5 else 1.0 - (1.0 - z - w) * (1.0 - z + w)
    if w > 0.0:  # climbs first; z + w < 1 makes the impact velocity, and eta times it, smaller than 1
        return 0, squared / (1.0 + math.sqrt((1.0 - z - w) * (1.0 - z + w))), 0  # 1 - sqrt(D), (4.13)
    rebound = eta * eta * squared
    if rebound >= 1.0:  # (3.16), (3.17)
        return 2, math.inf, 1
    peak = rebound / (1.0 + math.sqrt(1.0 - rebound))  # (4.13)
    if peak > z:
        return 0, peak, 1
    return 0, z, 0
