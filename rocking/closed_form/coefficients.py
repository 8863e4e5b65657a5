"""Coefficients of the response to one full sine before any impact: (3.3), (3.7) and (3.9) of the paper.

Times are measured from uplift, `tau = p t`. `e^{p T_ex}` exceeds the range of a double below a frequency ratio of
about 0.009, so every formula that meets it is multiplied through by `e^{-p T_ex}`; D0* alone, which is of that size,
is then infinite.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rocking.errors import in_range

Array = NDArray[np.float64]


class Coefficients(NamedTuple):
    """A0*, B0* and C0* of (3.9); arrays [-] of the broadcast shape."""

    A0: Array
    B0: Array
    C0: Array


def checked(amplitude: ArrayLike, frequency_ratio: ArrayLike) -> tuple[Array, Array]:
    """Amplitude a [-], [1, inf), and frequency ratio omega [-], (0, inf), broadcast against each other."""
    a = in_range("amplitude", amplitude, 1.0, np.inf)
    omega = in_range("frequency_ratio", frequency_ratio, 0.0, np.inf, closed="neither")
    a, omega = np.broadcast_arrays(a, omega)
    return a, omega


def cot_psi(a: Array) -> Array:
    """cot(psi) = sqrt(a^2 - 1) [-], factored so that nothing cancels near a = 1."""
    return np.sqrt((a - 1.0) * (a + 1.0))


def uplift_phase(amplitude: ArrayLike) -> Array:
    """Phase psi of the sine at which the block uplifts, (3.3).

    Parameters
    ----------
    amplitude : array_like
        a = a_g/(g alpha) [-], [1, inf).

    Returns
    -------
    ndarray
        psi = arcsin(1/a) [rad], (0, pi/2]. The paper prints 1/alpha where 1/a is meant; a is defined in (3.6).
    """
    a = in_range("amplitude", amplitude, 1.0, np.inf)
    return np.asarray(np.arctan2(1.0, cot_psi(a)))  # (3.3), exact near a = 1 where arcsin(1/a) loses half the digits


def pulse_end(amplitude: ArrayLike, frequency_ratio: ArrayLike) -> Array:
    """p T_ex = (2 pi - psi)/omega [-], the time from uplift to the end of the pulse, below (3.2).

    Parameters
    ----------
    amplitude : array_like
        a [-], [1, inf).
    frequency_ratio : array_like
        omega [-], (0, inf).
    """
    a, omega = checked(amplitude, frequency_ratio)
    return np.asarray((2 * np.pi - uplift_phase(a)) / omega)


def integration_constants(amplitude: ArrayLike, frequency_ratio: ArrayLike) -> tuple[Array, Array]:
    """(A0/alpha, B0/alpha) [-] of a block that starts from rest, (3.7).

    Parameters
    ----------
    amplitude : array_like
        a [-], [1, inf).
    frequency_ratio : array_like
        omega [-], (0, inf).
    """
    starred = coefficients(amplitude, frequency_ratio)
    return np.asarray(starred.A0 / 2), np.asarray(starred.B0 / 2)  # (3.7)


def coefficients(amplitude: ArrayLike, frequency_ratio: ArrayLike) -> Coefficients:
    """A0*, B0* and C0*, (3.9).

    Parameters
    ----------
    amplitude : array_like
        a [-], [1, inf).
    frequency_ratio : array_like
        omega [-], (0, inf).
    """
    a, omega = checked(amplitude, frequency_ratio)
    s, K = cot_psi(a), omega / (omega * omega + 1)
    A0, B0, C0 = K * (omega + s), K * (omega - s), 2 * a * K / omega  # (3.9)
    return Coefficients(np.asarray(A0), np.asarray(B0), np.asarray(C0))


def after_pulse_coefficients(amplitude: ArrayLike, frequency_ratio: ArrayLike) -> tuple[Array, Array]:
    """Free-rocking coefficients of a block without impact so far, the two factors of D0* in (3.9).

    After the pulse `2 theta/alpha = -2 + [falling] e^{p T_ex} e^{-tau} + [growing] e^{tau}`, (3.5).

    Parameters
    ----------
    amplitude : array_like
        a [-], [1, inf).
    frequency_ratio : array_like
        omega [-], (0, inf).

    Returns
    -------
    falling : ndarray
        (A0* - (omega/2) C0* e^{p T_ex}) e^{-p T_ex} [-], scaled so that it stays finite.
    growing : ndarray
        B0* + (omega/2) C0* e^{-p T_ex} [-]; it changes sign where the block overturns directly, (3.10).
    """
    a, omega = checked(amplitude, frequency_ratio)
    s, K = cot_psi(a), omega / (omega * omega + 1)
    decay = np.exp(-pulse_end(a, omega))
    falling, growing = K * ((omega + s) * decay - a), K * (omega - s + a * decay)  # (3.5), factors of D0* in (3.9)
    return np.asarray(falling), np.asarray(growing)


def d0_star(amplitude: ArrayLike, frequency_ratio: ArrayLike) -> Array:
    """D0* by the product in the first line of (3.9); -inf where e^{p T_ex} is beyond a double.

    Parameters
    ----------
    amplitude : array_like
        a [-], [1, inf).
    frequency_ratio : array_like
        omega [-], (0, inf).

    Returns
    -------
    ndarray
        D0* [-]; the block reaches its first impact with velocity sqrt(1 - D0*), (3.15).
    """
    falling, growing = after_pulse_coefficients(amplitude, frequency_ratio)
    with np.errstate(over="ignore"):
        return np.asarray(falling * growing * np.exp(pulse_end(amplitude, frequency_ratio)))  # (3.9), first line


def d0_star_expanded(amplitude: ArrayLike, frequency_ratio: ArrayLike) -> Array:
    """D0* by the second line of (3.9), corrected; nan or infinite where e^{p T_ex} is beyond a double.

    The paper prints the factor omega/(omega^2 + 1); the product in its first line gives the square of it.

    Parameters
    ----------
    amplitude : array_like
        a [-], [1, inf).
    frequency_ratio : array_like
        omega [-], (0, inf).
    """
    a, omega = checked(amplitude, frequency_ratio)
    s, T = cot_psi(a), pulse_end(a, omega)
    with np.errstate(over="ignore", invalid="ignore"):
        bracket = omega**2 - 2 * a**2 + 1 + (s + omega) * a * np.exp(-T) + (s - omega) * a * np.exp(T)
    return np.asarray((omega / (omega**2 + 1)) ** 2 * bracket)  # (3.9), second line, square restored
