"""Published closed-form conditions of overturning without impact for other simple pulses."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from rocking._model.checks import check
from rocking.closed_form.arguments import ANY_FREQUENCY_RATIO, Array
from rocking.closed_form.roots import find_root


def rectangular_amplitude(frequency_ratio: ArrayLike) -> Array:
    """Smallest amplitude at which a rectangular pulse of duration T_p/2 overturns the block (Housner 1963).

    Parameters
    ----------
    frequency_ratio : array_like
        omega [-], [1e-12, 1e12]; the pulse lasts p t_1 = pi/omega.

    Returns
    -------
    ndarray
        a = 1/(1 - exp(-p t_1)) [-].
    """
    omega = check(ANY_FREQUENCY_RATIO, frequency_ratio)
    return np.asarray(-1 / np.expm1(-np.pi / omega))


def half_sine_amplitude(frequency_ratio: ArrayLike) -> Array:
    """Smallest amplitude at which half a sine overturns the block (Shi et al. 1996).

    Parameters
    ----------
    frequency_ratio : array_like
        omega [-], [1e-12, 1e12].

    Returns
    -------
    ndarray
        a = 1/sin(psi) [-] with omega sin(psi) - cos(psi) = exp(-(pi - psi)/omega).
    """
    omega = check(ANY_FREQUENCY_RATIO, frequency_ratio)
    psi = find_root(_half_sine, np.zeros_like(omega), np.full_like(omega, np.pi / 2), omega)
    return np.asarray(1 / np.sin(psi))


def _half_sine(psi: Array, omega: Array) -> Array:
    return np.asarray(omega * np.sin(psi) - np.cos(psi) - np.exp(-(np.pi - psi) / omega))


def cosine_amplitude(frequency_ratio: ArrayLike) -> Array:
    """Smallest amplitude at which one full cosine overturns the block, if no impact occurs within the pulse.

    Parameters
    ----------
    frequency_ratio : array_like
        omega [-], [1e-12, 1e12].

    Returns
    -------
    ndarray
        a = (1 + omega^2)/(1 - exp(-2 pi/omega)) [-].
    """
    omega = check(ANY_FREQUENCY_RATIO, frequency_ratio)
    return np.asarray(-(1 + omega**2) / np.expm1(-2 * np.pi / omega))
