"""Circolare 2 febbraio 2009, n. 617 (Italy, to NTC 2008), C8A.4: local mechanisms of existing masonry, here one block.

The text was not seen: formulas after secondary sources, by section and not by equation number; compare them with it
before use. For one block the mass ratio e* is 1, the multiplier of collapse b/h, and the horizontal displacement of the
centre of mass at which the block is in equilibrium without a force is d_0 = b. A block on a floor passes the check at
the ground as well: demands on floors are at least those of the ground. The Circolare of 2019, in
`rocking_assessment.standards.circolare2019`, changes periods and limits. Arguments that all clauses share:
`rocking_assessment.standards`.

References
----------
Ministero delle Infrastrutture e dei Trasporti (2009), Circolare 2 febbraio 2009, n. 617, Gazzetta Ufficiale n. 47 del
26 febbraio 2009, Appendice C8A.4.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rocking.extension import Array
from rocking_assessment.standards.arguments import checked
from rocking_assessment.standards.static import west_acceleration

CAPACITY = 0.4  # d_u over d_0, and d_s over d_u [-]


def circolare2009_activation(
    half_width: ArrayLike, mass_height: ArrayLike, confidence_factor: ArrayLike = 1.0
) -> Array:
    """Spectral acceleration that activates the mechanism (C8A.4.1): a_0 = g tan(alpha)/FC [m/s2].

    Parameters
    ----------
    confidence_factor : array_like
        FC [-], [1, 2].
    """
    b, h, factor = checked(half_width=half_width, mass_height=mass_height, confidence_factor=confidence_factor)
    return west_acceleration(b, h) / factor  # C8A.4.1


def circolare2009_linear_check(
    acceleration: ArrayLike,
    half_width: ArrayLike,
    mass_height: ArrayLike,
    *,
    behaviour_factor: ArrayLike = 2.0,
    confidence_factor: ArrayLike = 1.0,
) -> NDArray[np.bool_]:
    """Linear kinematic check (C8A.4.2.3): a_0 >= a/q.

    Parameters
    ----------
    acceleration : array_like
        At the ground a_g S, the peak acceleration with the soil factor; on a floor `circolare2009_floor_acceleration`
        [m/s2], >= 0.
    behaviour_factor : array_like
        q [-], [1, 10]: 2 for the limit state of life safety, 1 for that of damage.
    confidence_factor : array_like
        FC [-], [1, 2].
    """
    a, q = checked(acceleration=acceleration, behaviour_factor=behaviour_factor)
    passes: NDArray[np.bool_] = (
        circolare2009_activation(half_width, mass_height, confidence_factor) >= a / q
    )  # C8A.4.2.3
    return passes


def circolare2009_floor_acceleration(
    acceleration: ArrayLike, height_ratio: ArrayLike, storeys: ArrayLike, *, ground_acceleration: ArrayLike
) -> Array:
    """Demand on a floor of the linear check before q (C8A.4.2.3): S_e(T_1) psi(Z) gamma, at least a_g S [m/s2].

    psi = Z/H, gamma = 3 N/(2 N + 1).

    Parameters
    ----------
    acceleration : array_like
        Elastic spectrum S_e at the first period T_1 of the building [m/s2], >= 0.
    height_ratio : array_like
        Z/H [-], [0, 1].
    storeys : array_like
        N [-], [1, 1000].
    ground_acceleration : array_like
        a_g S, that of the check at the ground [m/s2], >= 0.
    """
    a, psi, n, ground = checked(
        acceleration=acceleration, height_ratio=height_ratio, storeys=storeys, ground_acceleration=ground_acceleration
    )
    return np.maximum(a * psi * _participation(n), ground)  # C8A.4.2.3


def circolare2009_displacement_capacity(half_width: ArrayLike) -> Array:
    """Ultimate displacement of the centre of mass (C8A.4.2.2): d_u = 0.4 d_0, d_0 = b [m]."""
    (b,) = checked(half_width=half_width)
    return CAPACITY * b  # C8A.4.2.2


def circolare2009_secant_period(half_width: ArrayLike, mass_height: ArrayLike) -> Array:
    """Secant period (C8A.4.2.3): T_s = 2 pi sqrt(d_s/a_s), d_s = 0.4 d_u, a_s = a_0 (1 - d_s/d_0) [s]."""
    b, h = checked(half_width=half_width, mass_height=mass_height)
    secant = CAPACITY * circolare2009_displacement_capacity(b)  # d_s, C8A.4.2.3
    acceleration = west_acceleration(b, h) * (1.0 - secant / b)  # capacity curve, C8A.4.2.2
    return 2.0 * math.pi * np.sqrt(secant / acceleration)  # T_s, C8A.4.2.3


def circolare2009_nonlinear_check(displacement: ArrayLike, half_width: ArrayLike) -> NDArray[np.bool_]:
    """Nonlinear kinematic check (C8A.4.2.3): d_u >= demand.

    Parameters
    ----------
    displacement : array_like
        At the ground S_De(T_s) at 5 % damping; on a floor `circolare2009_floor_displacement` [m], >= 0.
    """
    demand, b = checked(displacement=displacement, half_width=half_width)
    return circolare2009_displacement_capacity(b) >= demand  # C8A.4.2.3


def circolare2009_floor_displacement(
    displacement: ArrayLike,
    period: ArrayLike,
    secant_period: ArrayLike,
    height_ratio: ArrayLike,
    storeys: ArrayLike,
    *,
    ground_displacement: ArrayLike,
) -> Array:
    """Demand on a floor of the nonlinear check (C8A.4.2.3) [m].

    S_De(T_1) psi(Z) gamma (T_s/T_1)^2/sqrt((1 - T_s/T_1)^2 + 0.02 T_s/T_1), at least S_De(T_s).

    Parameters
    ----------
    displacement : array_like
        S_De at the first period of the building [m], >= 0.
    period : array_like
        T_1 [s], > 0.
    secant_period : array_like
        T_s of the mechanism, `circolare2009_secant_period` [s], > 0.
    height_ratio, storeys
        As for `circolare2009_floor_acceleration`.
    ground_displacement : array_like
        S_De(T_s), that of the check at the ground [m], >= 0.
    """
    d, first, secant, psi, n, ground = checked(
        displacement=displacement,
        period=period,
        secant_period=secant_period,
        height_ratio=height_ratio,
        storeys=storeys,
        ground_displacement=ground_displacement,
    )
    ratio = secant / first
    amplified = d * psi * _participation(n) * ratio**2 / np.sqrt((1.0 - ratio) ** 2 + 0.02 * ratio)  # C8A.4.2.3
    return np.maximum(amplified, ground)  # C8A.4.2.3


def _participation(storeys: Array) -> Array:
    """gamma = 3 N/(2 N + 1)."""
    return 3.0 * storeys / (2.0 * storeys + 1.0)
