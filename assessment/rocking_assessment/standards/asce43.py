"""ASCE/SEI 43-05, Appendix A: approximate methods for sliding (A.1) and rocking (A.2) of an unanchored rigid body.

Seen in a public scan: text and numbers of (A-1) to (A-3), (A-5) and its parts (a) to (c), with the images of some
formulas missing. Step 2 of A.2 follows a secondary description. Both steps can be derived: a linear oscillator stores
at theta the work against gravity m g h f_1, and loses per cycle what two impacts with C_R take. The design rule of
section 7 multiplies the best estimate by a factor of safety, which is not applied here.

The formulas assume M_L = M, the mass that acts horizontally is that of the body; for other bodies the text has a factor
F_H, which is left out. The body rotates by theta; a = b/h; C_3 = I_O/(m h^2), 4/3 (1 + a^2) for a uniform rectangle.
Arguments that all clauses share: `rocking_assessment.standards`.

References
----------
ASCE/SEI 43-05 (2005), Seismic design criteria for structures, systems, and components in nuclear facilities,
Appendix A.
Dar A. (2014), Evaluation of seismic design criteria for rocking objects in nuclear facilities, thesis, McMaster
University.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from rocking.extension import STANDARD_GRAVITY, Array, InvalidArgumentError, Scalar
from rocking_assessment.standards.arguments import checked, checked_body, checked_number

ANGLES = 400  # angles between 1e-4 alpha and alpha at which spectrum and capacity are compared, in equal ratios [-]

FREQUENCIES = 0.02, 100.0, 800
"""Lowest and highest frequency [Hz] at which the sliding coefficient is looked for, and their number [-]."""

BISECTIONS = 40


def asce43_capacity(
    rotation: ArrayLike, half_width: ArrayLike, mass_height: ArrayLike, vertical_ratio: ArrayLike = 0.0
) -> Array:
    """Horizontal spectral acceleration capacity at a rotation (A.2 step 1): SA_cap = 2 g f_1/(theta F_V) [m/s2].

    f_1 = cos theta + a sin theta - 1, F_V = sqrt(1 + (a SA_V/SA_H)^2); for M_L = M, without F_H.

    Parameters
    ----------
    rotation : array_like
        theta [rad], (0, pi/2].
    vertical_ratio : array_like
        SA_V/SA_H at the effective frequency and damping [-], [0, 100]; 0 without vertical motion.
    """
    theta, b, h, ratio = checked(
        rotation=rotation, half_width=half_width, mass_height=mass_height, vertical_ratio=vertical_ratio
    )
    a = b / h  # (A-5c)
    vertical = np.sqrt(1.0 + (a * ratio) ** 2)  # (A-5b)
    capacity: Array = 2.0 * STANDARD_GRAVITY * _rise(theta, a) / (theta * vertical)
    return capacity


def asce43_effective_frequency(
    rotation: ArrayLike, half_width: ArrayLike, mass_height: ArrayLike, gyration: ArrayLike | None = None
) -> Array:
    """Effective rocking frequency at a rotation (A.2 step 2): f_e = sqrt(2 f_1 g/(C_3 theta^2 h))/(2 pi) [Hz].

    Parameters
    ----------
    rotation : array_like
        theta [rad], (0, pi/2].
    """
    b, h, inertia = checked_body(half_width, mass_height, gyration)
    (theta,) = checked(rotation=rotation)
    squared = 2.0 * _rise(theta, b / h) * STANDARD_GRAVITY / (inertia / h**2 * theta**2 * h)  # A.2 step 2
    return np.sqrt(np.maximum(squared, 0.0)) / (2.0 * math.pi)


def asce43_effective_damping(half_width: ArrayLike, mass_height: ArrayLike, gyration: ArrayLike | None = None) -> Array:
    """Effective damping ratio (A.2 step 2): beta_e = gamma/sqrt(4 pi^2 + gamma^2), gamma = -2 ln C_R [-].

    C_R = 1 - 2 a^2/C_3 is (2.4) of the paper, the restitution "momentum"; nan where it is not positive.
    """
    b, _, inertia = checked_body(half_width, mass_height, gyration)
    restitution = 1.0 - 2.0 * b**2 / inertia  # C_R, A.2 step 2; = (2.4)
    gamma = -2.0 * np.log(np.where(restitution > 0.0, restitution, np.nan))
    damping: Array = gamma / np.sqrt(4.0 * math.pi**2 + gamma**2)  # beta_e, A.2 step 2
    return damping


def asce43_rocking_angle(
    spectrum: Callable[[Array, float], ArrayLike],
    half_width: Scalar,
    mass_height: Scalar,
    gyration: Scalar | None = None,
    *,
    vertical_spectrum: Callable[[Array, float], ArrayLike] | None = None,
) -> float:
    """Best-estimate rocking angle (A.2): where SA_H(f_e, beta_e) equals the capacity [rad].

    Of several angles it is the largest, which has the lowest frequency. The body overturns, nan, where the demand still
    reaches the capacity at alpha; it is 0 where the demand is below the capacity at all angles. The standard applies
    this to bodies that uplift (`west_acceleration`).

    Parameters
    ----------
    spectrum : callable
        Horizontal spectral acceleration [m/s2] of frequencies, an array [Hz], and a damping ratio [-]; of a record from
        `rocking.elastic_spectrum`.
    vertical_spectrum : callable, optional
        The same of the vertical motion, which lowers the capacity.
    """
    b, h = checked_number("half_width", half_width), checked_number("mass_height", mass_height)
    r = None if gyration is None else checked_number("gyration", gyration)
    alpha, damping = math.atan2(b, h), float(asce43_effective_damping(b, h, r))
    if math.isnan(damping):
        raise InvalidArgumentError("half_width", half_width, "a body with 1 - 2 a^2/C_3 > 0, which can rock")

    def excess(theta: Array) -> Array:
        frequency = asce43_effective_frequency(theta, b, h, r)
        demand = np.asarray(spectrum(frequency, damping), dtype=np.float64)
        upwards = 0.0 if vertical_spectrum is None else np.asarray(vertical_spectrum(frequency, damping)) / demand
        return demand - asce43_capacity(theta, b, h, upwards)

    # The spectrum may have any shape, and cross the capacity often. Decided: the last of the angles at which the demand
    # reaches it, and the crossing just above. Two crossings between neighbouring angles (2.3 % apart) are missed.
    angles = np.geomspace(1e-4 * alpha, alpha, ANGLES)
    over = np.flatnonzero(excess(angles) >= 0.0)
    if not over.size:
        return 0.0
    k = int(over[-1])
    if k == ANGLES - 1:
        return math.nan
    low, high = angles[k], angles[k + 1]
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if excess(np.array([middle]))[0] >= 0.0 else (low, middle)
    return float(0.5 * (low + high))


def asce43_sliding_distance(
    spectrum: Callable[[Array, float], ArrayLike], friction: Scalar, vertical_acceleration: Scalar = 0.0
) -> float:
    """Best-estimate sliding distance by the reserve-energy method (A.1): delta_s = c_s/(2 pi f_es)^2 [m].

    mu_e = mu (1 - 0.4 A_V/g), c_s = 2 mu_e g; f_es is the lowest frequency at which the 10 % damped spectrum equals
    c_s. 0 where the spectrum does not reach c_s, nan where it does so at the lowest frequency that is tried.

    Parameters
    ----------
    spectrum : callable
        As for `asce43_rocking_angle`. The standard takes the vector sum of two horizontal components.
    friction : float
        mu [-], (0, 10].
    vertical_acceleration : float
        Peak vertical acceleration A_V [m/s2], [0, 2.5 g).
    """
    mu, up = checked_number("friction", friction), checked_number("vertical_acceleration", vertical_acceleration)
    effective = mu * (1.0 - 0.4 * up / STANDARD_GRAVITY)
    coefficient = 2.0 * effective * STANDARD_GRAVITY
    # from low frequencies upwards: the first one that reaches the coefficient, and the crossing just below
    frequencies = np.geomspace(*FREQUENCIES)
    over = np.flatnonzero(np.asarray(spectrum(frequencies, 0.1)) >= coefficient)
    if not over.size:
        return 0.0
    k = int(over[0])
    if k == 0:
        return math.nan
    low, high = frequencies[k - 1], frequencies[k]
    for _ in range(BISECTIONS):
        middle = math.sqrt(low * high)
        low, high = (low, middle) if np.asarray(spectrum(np.array([middle]), 0.1))[0] >= coefficient else (middle, high)
    return coefficient / (2.0 * math.pi * float(high)) ** 2


def _rise(theta: Array, a: Array) -> Array:
    """f_1 = cos theta + a sin theta - 1, without cancellation."""
    rise: Array = a * np.sin(theta) - 2.0 * np.sin(0.5 * theta) ** 2  # (A-5a)
    return rise
