"""Case 1.2: overturning after one impact that occurs after the end of the pulse, (3.11) to (3.18)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from rocking.closed_form.arguments import Array, checked
from rocking.closed_form.case_2 import case_2_phase
from rocking.closed_form.coefficients import (
    after_pulse_coefficients,
    coefficients,
    d0_star,
    pulse_end,
    uplift_phase,
)
from rocking.closed_form.first_arc import state_at_pulse_end
from rocking.closed_form.interval import AmplitudeInterval
from rocking.closed_form.limit import limit_amplitude, limit_velocity
from rocking.closed_form.roots import find_maximum, find_root
from rocking.closed_form.transcendental import residual, rising_root

_UNRESOLVED = 30.0  # p T_ex beyond which e^{-p T_ex} is below the rounding error of a
_PRODUCT_FROM = 4.0  # p T_ex from which the product form of D0* is more accurate than the energy, which may overflow


def case_1_2_residual(amplitude: ArrayLike, frequency_ratio: ArrayLike, time: ArrayLike) -> Array:
    """2 theta/alpha [-] in free rocking before any impact, left side of (3.12).

    Parameters
    ----------
    amplitude : array_like
        a [-], [1, 1e12].
    frequency_ratio : array_like
        omega [-], [1e-12, 1e12].
    time : array_like
        tau since uplift [-]; the value is 2 theta/alpha only from the end of the pulse on.
    """
    a, omega, tau = checked(amplitude=amplitude, frequency_ratio=frequency_ratio, time=time)
    decaying, growing = after_pulse_coefficients(a, omega)
    T = pulse_end(a, omega)
    with np.errstate(over="ignore"):
        return residual(decaying, growing * np.exp(T), -2.0, tau - T)  # (3.12)


def case_1_2_impact_time(amplitude: ArrayLike, frequency_ratio: ArrayLike) -> Array:
    """Time tau_i2 from uplift to the first impact if that impact is after the pulse, (3.13).

    Parameters
    ----------
    amplitude : array_like
        a [-], [1, 1e12].
    frequency_ratio : array_like
        omega [-], [1e-12, 1e12].

    Returns
    -------
    ndarray
        tau_i2 [-]: ln[(1 + sqrt(1 - D0*))/(B0* + (omega/2) C0* e^{-p T_ex})]; nan where the block overturns first.
        Physical where it is at least p T_ex, that is above (3.31).
    """
    decaying, growing = after_pulse_coefficients(amplitude, frequency_ratio)
    T = pulse_end(amplitude, frequency_ratio)
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        since_end = rising_root(decaying, growing * np.exp(T), -2.0)  # (3.13), with tau_i2 - p T_ex as unknown
        root = np.logaddexp(0.0, np.log(-decaying * growing) + T) / 2  # log of sqrt(1 - D0*), for e^T out of range
        return np.asarray(np.where(T < 700, T + since_end, np.logaddexp(0.0, root) - np.log(growing)))  # (3.13)


def free_velocity(amplitude: ArrayLike, frequency_ratio: ArrayLike, time: ArrayLike) -> Array:
    """d(theta/alpha)/d tau [-] in free rocking before any impact, (3.14), at any time after the pulse.

    Parameters
    ----------
    amplitude : array_like
        a [-], [1, 1e12].
    frequency_ratio : array_like
        omega [-], [1e-12, 1e12].
    time : array_like
        tau since uplift [-].
    """
    a, omega, tau = checked(amplitude=amplitude, frequency_ratio=frequency_ratio, time=time)
    decaying, growing = after_pulse_coefficients(a, omega)
    T = pulse_end(a, omega)
    since_end = tau - T
    with np.errstate(over="ignore", invalid="ignore"):
        return np.asarray((growing * np.exp(T) * np.exp(since_end) - decaying * np.exp(-since_end)) / 2)  # (3.14)


def impact_velocity_squared(amplitude: ArrayLike, frequency_ratio: ArrayLike) -> Array:
    """Square of the velocity at an impact after the pulse, 1 - D0* of (3.15).

    Parameters
    ----------
    amplitude : array_like
        a [-], [1, 1e12].
    frequency_ratio : array_like
        omega [-], [1e-12, 1e12].

    Returns
    -------
    ndarray
        (d(theta/alpha)/d tau)^2 [-]; infinite where e^{p T_ex} exceeds the double range. For short pulses D0* is close
        to one; 1 - D0* is then computed as the energy of free rocking, v_ex^2 - y_ex (y_ex + 2), without
        cancellation.
    """
    a, omega = checked(amplitude=amplitude, frequency_ratio=frequency_ratio)
    y, v = state_at_pulse_end(a, omega)
    with np.errstate(over="ignore", invalid="ignore"):
        energy = v * v - y * (y + 2)
        return np.asarray(
            np.where(pulse_end(a, omega) < _PRODUCT_FROM, energy, 1 - d0_star(a, omega))
        )  # (3.15), squared


def case_1_2_impact_velocity(amplitude: ArrayLike, frequency_ratio: ArrayLike) -> Array:
    """d(theta/alpha)/d tau [-] just before an impact after the pulse, sqrt(1 - D0*), (3.15).

    Parameters
    ----------
    amplitude : array_like
        a [-], [1, 1e12].
    frequency_ratio : array_like
        omega [-], [1e-12, 1e12].
    """
    squared = impact_velocity_squared(amplitude, frequency_ratio)
    return np.asarray(np.sqrt(np.where(squared >= 0, squared, np.nan)))  # (3.15)


def case_1_2_margin(amplitude: ArrayLike, frequency_ratio: ArrayLike, restitution: ArrayLike) -> Array:
    """Margin of overturning after an impact that follows the pulse, (3.16) to (3.18).

    Parameters
    ----------
    amplitude : array_like
        a [-], [1, 1e12].
    frequency_ratio : array_like
        omega [-], [1e-12, 1e12].
    restitution : array_like
        eta [-], [0, 1].

    Returns
    -------
    ndarray
        eta v_i2 - 1 = B_i2 [-], zero on (3.18), positive where the block overturns; valid between `limit_amplitude`
        and `case_2_amplitude` only.
    """
    a, omega, eta = checked(amplitude=amplitude, frequency_ratio=frequency_ratio, restitution=restitution)
    with np.errstate(invalid="ignore"):
        return np.asarray(eta * case_1_2_impact_velocity(a, omega) - 1)  # (3.16), (3.17)


def condition_3_18(amplitude: ArrayLike, frequency_ratio: ArrayLike) -> Array:
    """Left side of (3.18) as printed [-]; the block overturns where it exceeds 1/eta^2.

    Parameters
    ----------
    amplitude : array_like
        a [-], [1, 1e12].
    frequency_ratio : array_like
        omega [-], [1e-12, 1e12].

    Notes
    -----
    The sentence below (3.31) assigns (3.18) to case 1.1 and (3.30) to case 1.2; their derivations show the opposite.
    """
    a, omega = checked(amplitude=amplitude, frequency_ratio=frequency_ratio)
    A0, B0, C0 = coefficients(a, omega)
    T = pulse_end(a, omega)
    half = omega / 2 * C0
    with np.errstate(over="ignore"):
        return np.asarray(1 - (A0 * B0 - half**2 + half * (A0 * np.exp(-T) - B0 * np.exp(T))))  # (3.18)


def case_1_2_amplitudes(frequency_ratio: ArrayLike, restitution: ArrayLike) -> AmplitudeInterval:
    """Amplitudes between which the block overturns after an impact that follows the pulse, the curves of (3.18).

    Parameters
    ----------
    frequency_ratio : array_like
        omega [-], [1e-12, 1e12].
    restitution : array_like
        eta [-], [0, 1].

    Returns
    -------
    AmplitudeInterval
        Of the broadcast shape. `lower` is the lower branch of (3.18), or the limit (3.31) where that branch lies
        below the limit, in case 1.1; `upper` is the upper branch, below the curve of case 2 except for eta = 1. Both
        are nan where there is no such overturning.
    """
    omega, eta = checked(frequency_ratio=frequency_ratio, restitution=restitution)
    limit, overturned_at_limit = limit_amplitude(omega), eta * limit_velocity(omega) >= 1
    direct, end = case_2_phase(omega), uplift_phase(limit)
    top = find_maximum(_excess, direct, end, omega, eta)
    resolved = pulse_end(limit, omega) < _UNRESOLVED  # else (3.10), (3.18) and (3.31) coincide in double precision
    overturned = np.where(resolved, _excess(top, omega, eta) > 0, overturned_at_limit)
    lower = np.where(overturned_at_limit, limit, 1 / np.sin(find_root(_excess, top, end, omega, eta)))
    upper = find_root(_excess, direct, top, omega, eta)
    upper = np.where(resolved & (eta < 1), upper, direct)  # eta = 1: the upper branch of (3.18) is (3.10)
    return AmplitudeInterval(np.where(overturned, lower, np.nan), np.where(overturned, 1 / np.sin(upper), np.nan))


def _excess(psi: Array, omega: Array, eta: Array) -> Array:
    """(3.18) as -D0* - (1/eta^2 - 1), times e^{-p T_ex} eta^2 so that every term is finite."""
    decay = np.exp(-(2 * np.pi - psi) / omega)
    K = omega / (omega**2 + 1) / np.sin(psi)
    growing = omega * np.sin(psi) + 2 * np.sin(psi / 2) ** 2 + np.expm1(-(2 * np.pi - psi) / omega)
    decaying = 1 - (omega * np.sin(psi) + np.cos(psi)) * decay
    return np.asarray((eta * K) ** 2 * growing * decaying - (1 - eta**2) * decay)
