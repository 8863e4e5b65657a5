"""How near a block that has been left to itself is to another fate: where steps of lower accuracy are not enough."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def fate_margin(z: Array, w: Array, eta: Array, alpha: Array) -> Array:
    """Relative distance of the energy at the end of the pulse from that of another fate [-].

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
        |X - w| over the barrier X(0), see `free_rocking`; where the block returns also the distance of the energy
        after its impact from the barrier, (3.16), whichever is smaller. 0 on the boundary between two fates.
    """
    half = np.where(alpha > 0.0, 0.5 * alpha, 1.0)
    barrier = np.where(alpha > 0.0, np.sin(half) / half, 1.0)
    x = np.where(alpha > 0.0, np.sin(half * (1.0 - z)) / half, 1.0 - z)
    escape = np.abs(x - w) / barrier
    rebound = eta * eta * (1.0 - (x - w) * (x + w) / (barrier * barrier))
    return np.asarray(np.where(w < x, np.minimum(escape, np.abs(1.0 - rebound)), escape))
