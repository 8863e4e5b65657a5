"""Statics: the acceleration at which a body at rest starts to tilt (West's formula; Milne 1881).

Textbook statics, derived in one line: moments about the edge of the weight, m g b, and of the inertia force, m a h.
Arguments that all clauses share: `rocking_assessment.standards`.

References
----------
Milne J. (1881), Experiments in observational seismology, Transactions of the Seismological Society of Japan 3, 12-64.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rocking.extension import STANDARD_GRAVITY
from rocking_assessment.standards.arguments import checked


def west_acceleration(half_width: ArrayLike, mass_height: ArrayLike) -> NDArray[np.float64]:
    """Peak ground acceleration from which a body uplifts, and that it needs to overturn: g b/h [m/s2].

    Examples
    --------
    >>> float(west_acceleration(half_width=0.2, mass_height=0.8))
    2.4516625
    """
    b, h = checked(half_width=half_width, mass_height=mass_height)
    return STANDARD_GRAVITY * b / h  # West


def static_check(acceleration: ArrayLike, half_width: ArrayLike, mass_height: ArrayLike) -> NDArray[np.bool_]:
    """Whether a body stays on its base under a constant horizontal acceleration: a_g < g b/h.

    Parameters
    ----------
    acceleration : array_like
        Peak ground acceleration a_g [m/s2], >= 0.
    """
    a, b, h = checked(acceleration=acceleration, half_width=half_width, mass_height=mass_height)
    return a < west_acceleration(b, h)  # static check
