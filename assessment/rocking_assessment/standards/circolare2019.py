"""Circolare 21 gennaio 2019, n. 7 (Italy, to NTC 2018), C8.7.1.2.1: local mechanisms of existing masonry, one block.

Formulas (C8.7.1.1) to (C8.7.1.12) and (C7.2.5) to (C7.2.10) were seen in a transcription of the text, not in the
Gazzetta; (C8.7.1.2), the friction of interlocked walls, has no place for a free-standing body. For one block the mass
ratio e* is 1 (C8.7.1.5), the spectral displacement d that of the centre of mass (C8.7.1.4), and d_0 = b, where the
centre of mass is above the edge. The limits are 0.4 and 0.6 d_0 (SLV, SLC), the periods 0.84 and 0.78 of the secant
ones at these limits, the damping ratios 8 and 10 %. Arguments that all clauses share: `rocking_assessment.standards`.

Limit states: "SLV", life safety, and "SLC", prevention of collapse.

References
----------
Ministero delle Infrastrutture e dei Trasporti (2019), Circolare 21 gennaio 2019, n. 7 C.S.LL.PP., Supplemento ordinario
n. 5 alla Gazzetta Ufficiale n. 35 dell'11 febbraio 2019, C8.7.1.2.1 and C7.2.3.
"""

from __future__ import annotations

import math
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rocking.extension import STANDARD_GRAVITY, Array, one_of
from rocking_assessment.standards.arguments import checked
from rocking_assessment.standards.static import west_acceleration

LimitState = Literal["SLV", "SLC"]

CAPACITIES = {"SLV": 0.4, "SLC": 0.6}  # limit displacement over d_0 [-]
PERIOD_FACTORS = {"SLV": 1.68 * math.pi, "SLC": 1.56 * math.pi}  # in place of 2 pi of the secant period [-]
DAMPING = {"SLV": 0.08, "SLC": 0.10}  # damping ratio of the mechanism, unless it is known better [-]

PLATEAU = 0.8, 1.1
"""a and b: the floor spectrum is largest from a T_1 to b T_1 [-]."""


def circolare2019_activation(
    half_width: ArrayLike, mass_height: ArrayLike, confidence_factor: ArrayLike = 1.0
) -> Array:
    """Acceleration of the floor or ground that activates the mechanism (C8.7.1.8): a_0 = g tan(alpha)/FC [m/s2].

    Parameters
    ----------
    confidence_factor : array_like
        FC [-], [1, 2]; that of the knowledge level LC1 where the strength of masonry in compression is not considered.
    """
    b, h, factor = checked(half_width=half_width, mass_height=mass_height, confidence_factor=confidence_factor)
    return west_acceleration(b, h) / factor  # (C8.7.1.1), (C8.7.1.5), (C8.7.1.8)


def circolare2019_elastic_period(
    length: ArrayLike, thickness: ArrayLike, unit_weight: ArrayLike, modulus: ArrayLike, coefficient: ArrayLike = 6.2
) -> Array:
    """Period before activation of an element that is free to vibrate (C8.7.1.7): T_0 = kappa lambda L sqrt(W/(E g)).

    Returns the period [s].

    Parameters
    ----------
    length : array_like
        L [m], > 0; lambda = L over the thickness.
    thickness : array_like
        t [m], > 0.
    unit_weight : array_like
        W, weight of a cubic metre of masonry [N/m3], > 0.
    modulus : array_like
        E, Young's modulus [Pa], > 0; less where the masonry is cracked.
    coefficient : array_like
        kappa [-], (0, 10]: 6.2 of a cantilever, 2.2 of a beam on two supports.
    """
    size, t, w, e, kappa = checked(
        length=length, thickness=thickness, unit_weight=unit_weight, modulus=modulus, coefficient=coefficient
    )
    period: Array = kappa * size / t * size * np.sqrt(w / (e * STANDARD_GRAVITY))  # (C8.7.1.7)
    return period


def circolare2019_capacity(
    displacement: ArrayLike,
    half_width: ArrayLike,
    mass_height: ArrayLike,
    *,
    elastic_period: ArrayLike = 0.0,
    confidence_factor: ArrayLike = 1.0,
) -> Array:
    """Capacity curve (C8.7.1.3): a(d) = (g/FC) (b - d)/sqrt(R^2 - (b - d)^2) [m/s2].

    The multiplier of the displaced block, arm of its weight over height of its centre of mass; 0 from d = b on.

    Parameters
    ----------
    displacement : array_like
        d, horizontal displacement of the centre of mass [m], >= 0.
    elastic_period : array_like
        T_0 [s], >= 0, of an element that is free to vibrate before: the curve begins with a = (2 pi/T_0)^2 d. By
        default the block is rigid.
    confidence_factor : array_like
        FC [-], [1, 2].
    """
    d, b, h, period, factor = checked(
        displacement=displacement,
        half_width=half_width,
        mass_height=mass_height,
        elastic_period=elastic_period,
        confidence_factor=confidence_factor,
    )
    arm = np.maximum(b - d, 0.0)
    rigid = STANDARD_GRAVITY * arm / (np.sqrt(b * b + h * h - arm * arm) * factor)  # (C8.7.1.3), (C8.7.1.4)
    free_to_vibrate = period > 0.0
    elastic = d * (2.0 * math.pi / np.where(free_to_vibrate, period, 1.0)) ** 2  # (C8.7.1.6)
    curve: Array = np.where(free_to_vibrate, np.minimum(rigid, elastic), rigid)
    return curve


def circolare2019_displacement_capacity(half_width: ArrayLike, limit_state: LimitState = "SLV") -> Array:
    """Limit displacement of the centre of mass (C8.7.1.2.1.6): d_SLV = 0.4 d_0, d_SLC = 0.6 d_0, d_0 = b [m]."""
    one_of("limit_state", limit_state, CAPACITIES)
    (b,) = checked(half_width=half_width)
    return CAPACITIES[limit_state] * b  # C8.7.1.2.1.6


def circolare2019_period(
    half_width: ArrayLike,
    mass_height: ArrayLike,
    limit_state: LimitState = "SLV",
    confidence_factor: ArrayLike = 1.0,
) -> Array:
    """Equivalent period [s]: T_SLV = 1.68 pi sqrt(d/a(d)) (C8.7.1.10), T_SLC = 1.56 pi sqrt(d/a(d)) (C8.7.1.11).

    d is `circolare2019_displacement_capacity`, a(d) `circolare2019_capacity`.

    Parameters
    ----------
    confidence_factor : array_like
        FC [-], [1, 2].
    """
    limit = circolare2019_displacement_capacity(half_width, limit_state)
    acceleration = circolare2019_capacity(limit, half_width, mass_height, confidence_factor=confidence_factor)
    period: Array = PERIOD_FACTORS[limit_state] * np.sqrt(limit / acceleration)  # (C8.7.1.10), (C8.7.1.11)
    return period


def circolare2019_linear_check(
    acceleration: ArrayLike,
    half_width: ArrayLike,
    mass_height: ArrayLike,
    *,
    behaviour_factor: ArrayLike = 2.0,
    confidence_factor: ArrayLike = 1.0,
) -> NDArray[np.bool_]:
    """Simplified check of SLV with a behaviour factor (C8.7.1.2.1.7): a_0 >= a/q.

    Parameters
    ----------
    acceleration : array_like
        At the ground the peak acceleration with the soil factor; on a floor `circolare2019_floor_acceleration`, and of
        an element that is free to vibrate `circolare2019_floor_spectrum` at T_0 and 5 % (C8.7.1.9) [m/s2], >= 0.
    behaviour_factor : array_like
        q [-], [1, 10]: 2 for SLV, 1 for the activation of the mechanism (SLD).
    confidence_factor : array_like
        FC [-], [1, 2].
    """
    a, q = checked(acceleration=acceleration, behaviour_factor=behaviour_factor)
    passes: NDArray[np.bool_] = circolare2019_activation(half_width, mass_height, confidence_factor) >= a / q
    return passes  # (C8.7.1.8), C8.7.1.2.1.7


def circolare2019_nonlinear_check(
    displacement: ArrayLike, half_width: ArrayLike, limit_state: LimitState = "SLV"
) -> NDArray[np.bool_]:
    """Check in displacements (C8.7.1.2.1.8): the limit displacement is at least the demand.

    A body that the motion does not activate (`circolare2019_activation`) passes whatever the demand is.

    Parameters
    ----------
    displacement : array_like
        At the ground S_De at the period `circolare2019_period` and a damping ratio of 8 % (SLV), 10 % (SLC), under
        records its largest value up to this period; on a floor `circolare2019_floor_displacement` [m], >= 0.
    """
    (demand,) = checked(displacement=displacement)
    passes: NDArray[np.bool_] = circolare2019_displacement_capacity(half_width, limit_state) >= demand
    return passes  # C8.7.1.2.1.8


def circolare2019_floor_acceleration(
    first_acceleration: ArrayLike, height_ratio: ArrayLike, storeys: ArrayLike, first_damping: ArrayLike = 0.05
) -> Array:
    """Peak acceleration of a floor, first mode (C7.2.7): a_Z = S_e(T_1, xi_1) gamma psi sqrt(1 + 4 xi_1^2) [m/s2].

    psi = z/H, gamma = 3 n/(2 n + 1) (C7.2.10). xi_1 is a ratio here; the text has per cent.

    Parameters
    ----------
    first_acceleration : array_like
        S_e of the ground at the first period and damping of the building [m/s2], >= 0.
    height_ratio : array_like
        z/H [-], [0, 1].
    storeys : array_like
        n [-], [1, 1000].
    first_damping : array_like
        xi_1 of the building [-], (0, 1): 0.1 to 0.2 where its masonry is damaged.
    """
    a, psi, n, xi = checked(
        first_acceleration=first_acceleration, height_ratio=height_ratio, storeys=storeys, first_damping=first_damping
    )
    peak: Array = a * 3.0 * n / (2.0 * n + 1.0) * psi * np.sqrt(1.0 + 4.0 * xi * xi)  # (C7.2.7), (C7.2.10)
    return peak


def circolare2019_floor_spectrum(
    floor_acceleration: ArrayLike,
    period: ArrayLike,
    first_period: ArrayLike,
    ground_acceleration: ArrayLike,
    *,
    damping: ArrayLike = 0.05,
    first_damping: ArrayLike = 0.05,
) -> Array:
    """Elastic spectrum of a floor, first mode (C7.2.6), beyond T_1 at least that of the ground (C7.2.5) [m/s2].

    At most a_Z times 1.1 xi_1^-0.5 eta(xi), eta = sqrt(10/(5 + 100 xi)) >= 0.55. The text gives xi_1 in per cent. With
    5 this factor would be 0.49, less than one at resonance; taken is the ratio 0.05, with which it is 4.9.

    Parameters
    ----------
    floor_acceleration : array_like
        a_Z, `circolare2019_floor_acceleration` [m/s2], >= 0.
    period : array_like
        T of the mechanism [s], > 0.
    first_period : array_like
        T_1 of the building [s], > 0; longer by 50 to 100 % where its masonry is damaged.
    ground_acceleration : array_like
        S_e(T, xi) of the ground [m/s2], >= 0.
    damping : array_like
        xi of the mechanism [-], [0, 1).
    first_damping : array_like
        xi_1 of the building [-], (0, 1).
    """
    peak, t, first, ground, xi, building = checked(
        floor_acceleration=floor_acceleration,
        period=period,
        first_period=first_period,
        ground_acceleration=ground_acceleration,
        damping=damping,
        first_damping=first_damping,
    )
    eta = np.maximum(np.sqrt(10.0 / (5.0 + 100.0 * xi)), 0.55)  # (3.2.4) of NTC 2018
    factor = 1.1 * eta / np.sqrt(building)
    low, high = PLATEAU[0] * first, PLATEAU[1] * first
    below = np.maximum(1.0 - t / low, 0.0) ** 1.6
    above = np.maximum(t / high - 1.0, 0.0) ** 1.2
    spectrum = factor * peak / (1.0 + (factor - 1.0) * (below + above))  # (C7.2.6): one of the two is 0
    return np.where(t > first, np.maximum(spectrum, ground), spectrum)  # (C7.2.5)


def circolare2019_floor_displacement(
    floor_acceleration: ArrayLike,
    period: ArrayLike,
    first_period: ArrayLike,
    ground_acceleration: ArrayLike,
    *,
    damping: ArrayLike = DAMPING["SLV"],
    first_damping: ArrayLike = 0.05,
) -> Array:
    """Demand on a floor of the check in displacements (C8.7.1.12): S_eZ(T) T^2/(4 pi^2) [m].

    Beyond b T_1, b = 1.1, at least S_eZ(T_1) (b T_1)^2/(4 pi^2).

    Parameters
    ----------
    period : array_like
        T_SLV or T_SLC, `circolare2019_period` [s], > 0.
    floor_acceleration, first_period, ground_acceleration, damping, first_damping
        As for `circolare2019_floor_spectrum`; damping 0.08 for SLV, 0.1 for SLC.
    """
    ratios = {"damping": damping, "first_damping": first_damping}
    t, first = checked(period=period, first_period=first_period)
    demand = circolare2019_floor_spectrum(floor_acceleration, t, first, ground_acceleration, **ratios) * t * t
    longest = PLATEAU[1] * first
    at_first = circolare2019_floor_spectrum(floor_acceleration, first, first, 0.0, **ratios) * longest * longest
    larger: Array = np.where(t > longest, np.maximum(demand, at_first), demand) / (4.0 * math.pi**2)
    return larger  # (C8.7.1.12)
