"""Energy margin of a block in free rocking with respect to overturning."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def outcome_margin(z: Array, w: Array, eta: Array, alpha: Array) -> Array:
    """Excess of the energy at the end of the pulse, or after the next impact, over that of the barrier [-].

    Parameters
    ----------
    z, w : float arrays
        |theta|/alpha and its rate with respect to tau at the end of the pulse [-].
    eta : float array
        Restitution [-], [0, 1].
    alpha : float array
        Slenderness angle [rad], 0: slender.

    Returns
    -------
    float array
        Positive where the block overturns: the larger of (w - X)/X(0), see `rocking._solver.free_rocking`, and
        of the energy after the next impact, relative to that of the barrier, minus 1, (3.16). It is continuous and
        zero at the transition.
    """
    half = np.where(alpha > 0.0, 0.5 * alpha, 1.0)
    barrier = np.where(alpha > 0.0, np.sin(half) / half, 1.0)
    x = np.where(alpha > 0.0, np.sin(half * (1.0 - z)) / half, 1.0 - z)
    escape = (w - x) / barrier  # (3.8)
    rebound = eta * eta * (1.0 - (x - w) * (x + w) / (barrier * barrier))
    return np.asarray(np.where(w < x, np.maximum(escape, rebound - 1.0), escape))
