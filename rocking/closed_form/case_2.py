"""Case 2: overturning without impact, (3.8) and (3.10). It does not depend on restitution."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from rocking._model.checks import check
from rocking.closed_form.arguments import ANY_FREQUENCY_RATIO, Array, checked
from rocking.closed_form.coefficients import after_pulse_coefficients, cot_psi, pulse_end
from rocking.closed_form.roots import find_root


def case_2_margin(amplitude: ArrayLike, frequency_ratio: ArrayLike) -> Array:
    """Margin of overturning without impact, (3.10).

    Parameters
    ----------
    amplitude : array_like
        a [-], [1, 1e12].
    frequency_ratio : array_like
        omega [-], [1e-12, 1e12].

    Returns
    -------
    ndarray
        sqrt(a^2 - 1) - a e^{-p T_ex} - omega [-]; zero on the curve, positive where the block overturns without impact.
    """
    a, omega = checked(amplitude=amplitude, frequency_ratio=frequency_ratio)
    return np.asarray(cot_psi(a) - a * np.exp(-pulse_end(a, omega)) - omega)  # (3.10), second line


def growing_coefficient(amplitude: ArrayLike, frequency_ratio: ArrayLike) -> Array:
    """2 B_ex0/alpha [-], left side of the first line of (3.10): the block overturns without impact where it is <= 0.

    Parameters
    ----------
    amplitude : array_like
        a [-], [1, 1e12].
    frequency_ratio : array_like
        omega [-], [1e-12, 1e12].

    Returns
    -------
    ndarray
        B0* e^{p T_ex} + (omega/2) C0* [-], infinite where e^{p T_ex} exceeds the double range. In free rocking
        B = 0 leads to the unstable equilibrium, (3.8).
    """
    _, growing = after_pulse_coefficients(amplitude, frequency_ratio)
    with np.errstate(over="ignore"):
        return np.asarray(growing * np.exp(pulse_end(amplitude, frequency_ratio)))  # (3.8), (3.10), first line


def case_2_amplitude(frequency_ratio: ArrayLike) -> Array:
    """Smallest amplitude at which the block overturns without impact, the curve of (3.10).

    Parameters
    ----------
    frequency_ratio : array_like
        omega [-], [1e-12, 1e12].

    Returns
    -------
    ndarray
        a [-], > 1, of the shape of `frequency_ratio`. It is unique: (3.10) divided by a is monotone in psi.
    """
    omega = check(ANY_FREQUENCY_RATIO, frequency_ratio)
    psi = case_2_phase(omega)
    return np.asarray(1 / np.sin(psi))


def case_2_phase(omega: Array) -> Array:
    """psi [rad] on the curve of (3.10)."""
    return find_root(_manifold, np.zeros_like(omega), np.full_like(omega, np.pi / 2), omega)


def _manifold(psi: Array, omega: Array) -> Array:
    """(3.10) times -sin(psi): omega sin psi - cos psi + e^{-p T_ex}, written with 1 - cos psi and expm1."""
    return np.asarray(omega * np.sin(psi) + 2 * np.sin(psi / 2) ** 2 + np.expm1(-(2 * np.pi - psi) / omega))
