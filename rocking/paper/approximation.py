"""Approximate impact time of case 1.1, (3.23) to (3.30): the sine is replaced by a constant and two exponentials."""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rocking.paper.arguments import Array, checked
from rocking.paper.motion import coefficients, cot_psi, pulse_end, uplift_phase
from rocking.paper.overturning import AmplitudeInterval, case_2_amplitude, overturning_condition
from rocking.paper.roots import find_root, residual, rising_root

EXPANSION_TIME = 1.0
"""tau_i1^0 = p t_i1^0 [-], (3.23): the initial guess of the impact time, about which (3.24) and (3.25) expand."""

_GRID = 1024  # number of amplitudes, uniform in log(a - 1), at which (3.30) is searched for changes of sign
_LOG_START = np.log(1e-6)  # smallest log(a - 1) of that search


def kappa_lambda(amplitude: ArrayLike, frequency_ratio: ArrayLike) -> tuple[Array, Array]:
    """Coefficients kappa of e^-tau and lambda of e^tau [-], (3.26), which make (3.24) and (3.25) equal."""
    a, omega = checked(amplitude=amplitude, frequency_ratio=frequency_ratio)
    phi = omega * EXPANSION_TIME + uplift_phase(a)
    kappa = -math.e * omega / 2 * (np.cos(phi) + omega * np.sin(phi))  # (3.26)
    lambda_ = omega / (2 * math.e) * (np.cos(phi) - omega * np.sin(phi))  # (3.26)
    return np.asarray(kappa), np.asarray(lambda_)


def sine_series(amplitude: ArrayLike, frequency_ratio: ArrayLike, time: ArrayLike) -> Array:
    """sin(omega tau + psi) [-] to second order about tau = 1, (3.24)."""
    a, omega, tau = checked(amplitude=amplitude, frequency_ratio=frequency_ratio, time=time)
    phi, step = omega * EXPANSION_TIME + uplift_phase(a), tau - EXPANSION_TIME
    with np.errstate(over="ignore", invalid="ignore"):
        return np.asarray(np.sin(phi) * (1 - (omega * step) ** 2 / 2) + omega * np.cos(phi) * step)  # (3.24)


def exponential_series(amplitude: ArrayLike, frequency_ratio: ArrayLike, time: ArrayLike) -> Array:
    """kappa e^-tau + lambda e^tau [-] to second order about tau = 1, (3.25)."""
    a, omega, tau = checked(amplitude=amplitude, frequency_ratio=frequency_ratio, time=time)
    kappa, lambda_ = kappa_lambda(a, omega)
    decaying, growing, step = kappa / math.e, lambda_ * math.e, tau - EXPANSION_TIME
    with np.errstate(over="ignore", invalid="ignore"):
        return np.asarray((decaying + growing) * (1 + step**2 / 2) + (growing - decaying) * step)  # (3.25)


def ad_hoc_sine(amplitude: ArrayLike, frequency_ratio: ArrayLike, time: ArrayLike) -> Array:
    """Approximation of sin(omega tau + psi) [-] around tau = 1, (3.27) (figure S1)."""
    a, omega, tau = checked(amplitude=amplitude, frequency_ratio=frequency_ratio, time=time)
    kappa, lambda_ = kappa_lambda(a, omega)
    constant = (omega**2 + 1) * np.sin(omega * EXPANSION_TIME + uplift_phase(a))
    return residual(kappa, lambda_, constant, tau)  # (3.27)


def _exponential_terms(amplitude: ArrayLike, frequency_ratio: ArrayLike) -> tuple[Array, Array, Array]:
    """I1, I2 and I3 of (A 1) for (3.28) [-]."""
    a, omega = checked(amplitude=amplitude, frequency_ratio=frequency_ratio)
    A0, B0, C0 = coefficients(a, omega)
    kappa, lambda_ = kappa_lambda(a, omega)
    a_sine = np.cos(omega) + cot_psi(a) * np.sin(omega)  # a sin(omega + psi), as a sin(psi) = 1
    return A0 + C0 * kappa, B0 + C0 * lambda_, np.asarray(2 * (a_sine - 1))


def ad_hoc_residual(amplitude: ArrayLike, frequency_ratio: ArrayLike, time: ArrayLike) -> Array:
    """2 theta/alpha [-] before any impact with the sine replaced by (3.27): the left side of (3.28)."""
    a, omega, tau = checked(amplitude=amplitude, frequency_ratio=frequency_ratio, time=time)
    return residual(*_exponential_terms(a, omega), tau)  # (3.28)


def ad_hoc_impact_time(amplitude: ArrayLike, frequency_ratio: ArrayLike) -> Array:
    """Approximate time from uplift to the first impact inside the pulse, (3.29).

    tau [-], nan where (3.28) has no root with positive slope. Of its two roots, (3.29) takes the one with the plus
    sign, at which theta increases; `transcendental.rising_root` shows why this root is the impact.
    """
    return rising_root(*_exponential_terms(amplitude, frequency_ratio))  # (3.29)


def ad_hoc_margin(amplitude: ArrayLike, frequency_ratio: ArrayLike, restitution: ArrayLike) -> Array:
    """Left side minus right side of the semi-analytical overturning condition (3.30).

    Zero on the semi-analytical curve, positive where the block overturns, nan where (3.29) has no root [-].
    """
    a, omega, eta = checked(amplitude=amplitude, frequency_ratio=frequency_ratio, restitution=restitution)
    tau = ad_hoc_impact_time(a, omega)
    A0, B0, C0 = coefficients(a, omega)
    with np.errstate(over="ignore", invalid="ignore"):
        doubled = B0 * np.exp(tau) - A0 * np.exp(-tau) + C0 * omega * np.cos(omega * tau + uplift_phase(a))  # (3.22)
        return overturning_condition(a, omega, eta, tau, doubled / 2)  # (3.30)


def semi_analytical_amplitudes(frequency_ratio: ArrayLike, restitution: ArrayLike) -> AmplitudeInterval:
    """Amplitudes between which (3.30) predicts overturning after an impact within the pulse.

    Returns
    -------
    AmplitudeInterval
        Of the broadcast shape. `lower` is the smallest solution of (3.30), which the paper compares with (3.20) and
        (3.21). `upper` is the next solution below twice the amplitude of case 2, nan where there is none; it is not
        physical, as its impact time lies beyond the end of the pulse. The same may hold for `lower`: check with
        `within_pulse`.
    """
    omega, eta = checked(frequency_ratio=frequency_ratio, restitution=restitution)
    top = np.log(2 * case_2_amplitude(omega) - 1)
    steps = np.linspace(0.0, 1.0, _GRID).reshape(-1, *(1,) * omega.ndim)
    grid = 1 + np.exp(_LOG_START + (top - _LOG_START) * steps)
    margin = ad_hoc_margin(grid, omega, eta)
    # comparisons with nan are false: the limits of existence of (3.29) are not counted
    rises = (margin[:-1] < 0) & (margin[1:] >= 0)
    after = np.cumsum(rises, axis=0) > 0
    falls = after & (margin[:-1] >= 0) & (margin[1:] < 0)
    return AmplitudeInterval(*(_refined(crossing, grid, omega, eta) for crossing in (rises, falls)))


def _refined(crossing: NDArray[np.bool_], grid: Array, omega: Array, eta: Array) -> Array:
    """Root of (3.30) in the first grid interval marked in `crossing` (axis 0), nan where no interval is marked."""
    first = np.argmax(crossing, axis=0)[np.newaxis]
    low, high = (np.take_along_axis(grid, first + k, axis=0)[0] for k in (0, 1))
    root = find_root(lambda a, w, e: ad_hoc_margin(np.maximum(a, 1.0), w, e), low, high, omega, eta)
    return np.asarray(np.where(crossing.any(axis=0), root, np.nan))


def within_pulse(amplitude: ArrayLike, frequency_ratio: ArrayLike) -> NDArray[np.bool_]:
    """True where the approximate impact time (3.29) is within the pulse, the condition for (3.30) to be physical."""
    with np.errstate(invalid="ignore"):
        return np.asarray(ad_hoc_impact_time(amplitude, frequency_ratio) <= pulse_end(amplitude, frequency_ratio))
