"""Coefficients of the response to one full sine before any impact: (3.3), (3.7) and (3.9) of the paper.

Times are measured from uplift, `tau = p t`. Below a frequency ratio of about 0.009, `e^{p T_ex}` exceeds the double
range. Formulas that contain it are therefore multiplied by `e^{-p T_ex}`; only D0*, which is of that magnitude, is
infinite there.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from rocking._model.checks import check
from rocking.closed_form.arguments import AMPLITUDE, Array, checked


class Coefficients(NamedTuple):
    """A0*, B0* and C0* of (3.9); arrays [-] of the broadcast shape."""

    A0: Array
    B0: Array
    C0: Array


def cot_psi(a: Array) -> Array:
    """cot(psi) = sqrt(a^2 - 1) [-], factored to avoid cancellation near a = 1."""
    return np.sqrt((a - 1.0) * (a + 1.0))


def uplift_phase(amplitude: ArrayLike) -> Array:
    """Phase psi of the sine at uplift, (3.3).

    Parameters
    ----------
    amplitude : array_like
        a = a_g/(g alpha) [-], [1, 1e12].

    Returns
    -------
    ndarray
        psi = arcsin(1/a) [rad], (0, pi/2]. The paper prints 1/alpha instead of 1/a; a is defined in (3.6).
    """
    a = check(AMPLITUDE, amplitude)
    return np.asarray(
        np.arctan2(1.0, cot_psi(a))
    )  # (3.3), accurate near a = 1, where arcsin(1/a) loses half the digits


def pulse_end(amplitude: ArrayLike, frequency_ratio: ArrayLike) -> Array:
    """p T_ex = (2 pi - psi)/omega [-], the time from uplift to the end of the pulse, below (3.2).

    Parameters
    ----------
    amplitude : array_like
        a [-], [1, 1e12].
    frequency_ratio : array_like
        omega [-], [1e-12, 1e12].
    """
    a, omega = checked(amplitude=amplitude, frequency_ratio=frequency_ratio)
    return np.asarray((2 * np.pi - uplift_phase(a)) / omega)


def integration_constants(amplitude: ArrayLike, frequency_ratio: ArrayLike) -> tuple[Array, Array]:
    """A0/alpha and B0/alpha [-] for a start from rest, (3.7).

    Parameters
    ----------
    amplitude : array_like
        a [-], [1, 1e12].
    frequency_ratio : array_like
        omega [-], [1e-12, 1e12].
    """
    starred = coefficients(amplitude, frequency_ratio)
    return np.asarray(starred.A0 / 2), np.asarray(starred.B0 / 2)  # (3.7)


def coefficients(amplitude: ArrayLike, frequency_ratio: ArrayLike) -> Coefficients:
    """A0*, B0* and C0*, (3.9).

    Parameters
    ----------
    amplitude : array_like
        a [-], [1, 1e12].
    frequency_ratio : array_like
        omega [-], [1e-12, 1e12].
    """
    a, omega = checked(amplitude=amplitude, frequency_ratio=frequency_ratio)
    s, K = cot_psi(a), omega / (omega * omega + 1)
    A0, B0, C0 = K * (omega + s), K * (omega - s), 2 * a * K / omega  # (3.9)
    return Coefficients(np.asarray(A0), np.asarray(B0), np.asarray(C0))


def after_pulse_coefficients(amplitude: ArrayLike, frequency_ratio: ArrayLike) -> tuple[Array, Array]:
    """Coefficients of free rocking after the pulse and before any impact, the two factors of D0* in (3.9).

    After the pulse `2 theta/alpha = -2 + [decaying] e^{p T_ex} e^{-tau} + [growing] e^{tau}`, (3.5).

    Parameters
    ----------
    amplitude : array_like
        a [-], [1, 1e12].
    frequency_ratio : array_like
        omega [-], [1e-12, 1e12].

    Returns
    -------
    decaying : ndarray
        (A0* - (omega/2) C0* e^{p T_ex}) e^{-p T_ex} [-], scaled so that it is finite.
    growing : ndarray
        B0* + (omega/2) C0* e^{-p T_ex} [-]; its sign changes on the boundary of overturning without
        impact, (3.10).
    """
    a, omega = checked(amplitude=amplitude, frequency_ratio=frequency_ratio)
    s, K = cot_psi(a), omega / (omega * omega + 1)
    decay = np.exp(-pulse_end(a, omega))
    decaying, growing = K * ((omega + s) * decay - a), K * (omega - s + a * decay)  # (3.5), factors of D0* in (3.9)
    return np.asarray(decaying), np.asarray(growing)


def d0_star(amplitude: ArrayLike, frequency_ratio: ArrayLike) -> Array:
    """D0* by the product in the first line of (3.9); -inf where e^{p T_ex} exceeds the double range.

    Parameters
    ----------
    amplitude : array_like
        a [-], [1, 1e12].
    frequency_ratio : array_like
        omega [-], [1e-12, 1e12].

    Returns
    -------
    ndarray
        D0* [-]; the velocity at the first impact is sqrt(1 - D0*), (3.15).
    """
    decaying, growing = after_pulse_coefficients(amplitude, frequency_ratio)
    with np.errstate(over="ignore"):
        return np.asarray(decaying * growing * np.exp(pulse_end(amplitude, frequency_ratio)))  # (3.9), first line


def d0_star_expanded(amplitude: ArrayLike, frequency_ratio: ArrayLike) -> Array:
    """D0* by the second line of (3.9), corrected; nan or infinite where e^{p T_ex} exceeds the double range.

    The paper prints the factor omega/(omega^2 + 1); the product in the first line gives its square.

    Parameters
    ----------
    amplitude : array_like
        a [-], [1, 1e12].
    frequency_ratio : array_like
        omega [-], [1e-12, 1e12].
    """
    a, omega = checked(amplitude=amplitude, frequency_ratio=frequency_ratio)
    s, T = cot_psi(a), pulse_end(a, omega)
    with np.errstate(over="ignore", invalid="ignore"):
        bracket = omega**2 - 2 * a**2 + 1 + (s + omega) * a * np.exp(-T) + (s - omega) * a * np.exp(T)
    return np.asarray((omega / (omega**2 + 1)) ** 2 * bracket)  # (3.9), second line, square restored
