"""Ishiyama (1982): lower bounds of the peak ground acceleration and velocity that overturn a body.

The source was not seen beyond its summary, which says that both are needed; the formulas follow secondary sources. For
a slender rectangle B wide and H high the second one is v = 10.2 B/sqrt(H) in cm and s, the rule that is often quoted
as 10 B/sqrt(H). Arguments that all clauses share: `rocking_assessment.standards`.

References
----------
Ishiyama Y. (1982), Motions of rigid bodies and criteria for overturning by earthquake excitations, Earthquake
Engineering & Structural Dynamics 10(5), 635-650.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rocking.extension import STANDARD_GRAVITY
from rocking_assessment.standards.arguments import checked, checked_body
from rocking_assessment.standards.static import west_acceleration

SHARE = 0.4  # of the velocity that overturns a body when the ground stops at once: the lower bound of observed ones [-]


def ishiyama_velocity(
    half_width: ArrayLike, mass_height: ArrayLike, gyration: ArrayLike | None = None
) -> NDArray[np.float64]:
    """Peak ground velocity that a body needs to overturn [m/s].

    v = 0.4 sqrt((2 g I_O/(m R)) (1 - cos alpha)/cos^2 alpha), for a uniform rectangle
    0.4 sqrt((8 g R/3) (1 - cos alpha)/cos^2 alpha).

    Examples
    --------
    >>> round(float(ishiyama_velocity(half_width=0.2, mass_height=0.8)), 4)
    0.3308
    """
    b, h, inertia = checked_body(half_width, mass_height, gyration)
    radius, alpha = np.hypot(b, h), np.arctan2(b, h)
    rise = 2.0 * np.sin(0.5 * alpha) ** 2 / np.cos(alpha) ** 2  # (1 - cos alpha)/cos^2 alpha
    velocity: NDArray[np.float64] = SHARE * np.sqrt(2.0 * STANDARD_GRAVITY * inertia / radius * rise)  # Ishiyama
    return velocity


def ishiyama_check(
    acceleration: ArrayLike,
    velocity: ArrayLike,
    half_width: ArrayLike,
    mass_height: ArrayLike,
    gyration: ArrayLike | None = None,
) -> NDArray[np.bool_]:
    """Whether PGA or PGV is below its bound: overturning needs PGA >= g b/h and PGV >= `ishiyama_velocity`.

    Parameters
    ----------
    acceleration, velocity : array_like
        PGA [m/s2] and PGV [m/s], >= 0.
    """
    a, v, b, h = checked(acceleration=acceleration, velocity=velocity, half_width=half_width, mass_height=mass_height)
    passes: NDArray[np.bool_] = (a < west_acceleration(b, h)) | (v < ishiyama_velocity(b, h, gyration))
    return passes
