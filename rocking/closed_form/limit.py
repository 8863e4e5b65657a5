"""The limit (3.31) between cases 1.1 and 1.2: the first impact coincides with the end of the pulse."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from rocking._model.checks import check
from rocking.closed_form.arguments import ANY_FREQUENCY_RATIO, Array, checked
from rocking.closed_form.coefficients import coefficients, cot_psi, pulse_end
from rocking.closed_form.roots import find_root


def limit_margin(amplitude: ArrayLike, frequency_ratio: ArrayLike) -> Array:
    """Margin of (3.31): sign and distance to the limit between cases 1.1 and 1.2.

    Parameters
    ----------
    amplitude : array_like
        a [-], [1, 1e12].
    frequency_ratio : array_like
        omega [-], [1e-12, 1e12].

    Returns
    -------
    ndarray
        (3.31), left side minus right side, times e^{-p T_ex} [-]: positive where the first impact is after the end of
        the pulse or does not occur; negative where it is within the pulse.
    """
    a, omega = checked(amplitude=amplitude, frequency_ratio=frequency_ratio)
    left = 1 + omega**2 + np.sqrt(1 + (a**2 + 1) * omega**2)
    return np.asarray(left * np.exp(-pulse_end(a, omega)) - omega * (omega - cot_psi(a)))  # (3.31)


def limit_amplitude(frequency_ratio: ArrayLike) -> Array:
    """Amplitude at which the first impact coincides with the end of the pulse, the curve of (3.31).

    Parameters
    ----------
    frequency_ratio : array_like
        omega [-], [1e-12, 1e12].

    Returns
    -------
    ndarray
        a [-], > 1, of the shape of `frequency_ratio`. Above it the first impact is after the pulse (case 1.2, up to
        `case_2_amplitude`), below it within the pulse (case 1.1). Below frequency ratios of about 0.2 the curve and
        that of case 2 agree in all printed digits.
    """
    omega = check(ANY_FREQUENCY_RATIO, frequency_ratio)
    psi = find_root(_limit, np.zeros_like(omega), np.full_like(omega, np.pi / 2), omega)
    return np.asarray(1 / np.sin(psi))


def _limit(psi: Array, omega: Array) -> Array:
    """(3.31) times sin(psi) e^{-p T_ex}; collected in omega^2 sin(psi) to avoid cancellation for large omega."""
    decay = np.exp(-(2 * np.pi - psi) / omega)
    regular = decay * (np.sin(psi) + np.sqrt((1 + omega**2) * np.sin(psi) ** 2 + omega**2)) + omega * np.cos(psi)
    return np.asarray(regular + omega**2 * np.sin(psi) * np.expm1(-(2 * np.pi - psi) / omega))


def limit_velocity(frequency_ratio: ArrayLike) -> Array:
    """d(theta/alpha)/d tau [-] just before the impact at the end of the pulse, on the curve of (3.31).

    Parameters
    ----------
    frequency_ratio : array_like
        omega [-], [1e-12, 1e12].

    Returns
    -------
    ndarray
        [-]; where eta times this value exceeds 1 the curve separates overturning by case 1.1 from overturning by case
        1.2; elsewhere it lies in the region where the block survives.
    """
    a = limit_amplitude(frequency_ratio)
    omega = check(ANY_FREQUENCY_RATIO, frequency_ratio)
    A0, B0, C0 = coefficients(a, omega)
    grown = 1 + np.sqrt(1 - A0 * B0)  # B0* e^{p T_ex}, (3.31)
    return np.asarray((grown - A0 * np.exp(-pulse_end(a, omega)) + C0 * omega) / 2)  # (3.11)
