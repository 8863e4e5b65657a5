"""The paper's approximate impact time for case 1.1, (3.23) to (3.30): a sine replaced by two exponentials."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rocking.closed_form.case_1_1 import overturning_condition
from rocking.closed_form.case_2 import case_2_amplitude
from rocking.closed_form.coefficients import Array, checked, coefficients, cot_psi, pulse_end, uplift_phase
from rocking.closed_form.interval import AmplitudeInterval
from rocking.closed_form.roots import find_root
from rocking.closed_form.transcendental import residual, rising_root
from rocking.errors import in_range

EXPANSION_TIME = 1.0
"""tau_i1^0 = p t_i1^0 [-], the guess for the impact time about which (3.24) and (3.25) expand, (3.23)."""

_GRID = 1024  # amplitudes, uniform in log(a - 1), on which a frequency ratio is searched for the roots of (3.30)
_FIRST_STEP = np.log(1e-6)  # of log(a - 1)


def kappa_lambda(amplitude: ArrayLike, frequency_ratio: ArrayLike) -> tuple[Array, Array]:
    """Coefficients kappa and lambda of e^-tau and e^tau [-], (3.26), from matching (3.24) and (3.25).

    Parameters
    ----------
    amplitude : array_like
        a [-], [1, inf).
    frequency_ratio : array_like
        omega [-], (0, inf).
    """
    a, omega = checked(amplitude, frequency_ratio)
    phi = omega * EXPANSION_TIME + uplift_phase(a)
    kappa = -np.e * omega / 2 * (np.cos(phi) + omega * np.sin(phi))  # (3.26)
    lambda_ = omega / (2 * np.e) * (np.cos(phi) - omega * np.sin(phi))  # (3.26)
    return np.asarray(kappa), np.asarray(lambda_)


def sine_series(amplitude: ArrayLike, frequency_ratio: ArrayLike, time: ArrayLike) -> Array:
    """sin(omega tau + psi) [-] to second order about tau = 1, (3.24).

    Parameters
    ----------
    amplitude : array_like
        a [-], [1, inf).
    frequency_ratio : array_like
        omega [-], (0, inf).
    time : array_like
        tau since uplift [-].
    """
    a, omega = checked(amplitude, frequency_ratio)
    phi, step = omega * EXPANSION_TIME + uplift_phase(a), np.asarray(time) - EXPANSION_TIME
    return np.asarray(np.sin(phi) * (1 - (omega * step) ** 2 / 2) + omega * np.cos(phi) * step)  # (3.24)


def exponential_series(amplitude: ArrayLike, frequency_ratio: ArrayLike, time: ArrayLike) -> Array:
    """kappa e^-tau + lambda e^tau [-] to second order about tau = 1, (3.25).

    Parameters
    ----------
    amplitude : array_like
        a [-], [1, inf).
    frequency_ratio : array_like
        omega [-], (0, inf).
    time : array_like
        tau since uplift [-].
    """
    kappa, lambda_ = kappa_lambda(amplitude, frequency_ratio)
    falling, growing, step = kappa / np.e, lambda_ * np.e, np.asarray(time) - EXPANSION_TIME
    return np.asarray((falling + growing) * (1 + step**2 / 2) + (growing - falling) * step)  # (3.25)


def ad_hoc_sine(amplitude: ArrayLike, frequency_ratio: ArrayLike, time: ArrayLike) -> Array:
    """What stands for sin(omega tau + psi) [-] around tau = 1, (3.27) (figure S1).

    Parameters
    ----------
    amplitude : array_like
        a [-], [1, inf).
    frequency_ratio : array_like
        omega [-], (0, inf).
    time : array_like
        tau since uplift [-].
    """
    a, omega = checked(amplitude, frequency_ratio)
    kappa, lambda_ = kappa_lambda(a, omega)
    constant = (omega**2 + 1) * np.sin(omega * EXPANSION_TIME + uplift_phase(a))
    return residual(kappa, lambda_, constant, time)  # (3.27)


def _quadratic(amplitude: ArrayLike, frequency_ratio: ArrayLike) -> tuple[Array, Array, Array]:
    """I1, I2, I3 of appendix A for (3.28)."""
    a, omega = checked(amplitude, frequency_ratio)
    A0, B0, C0 = coefficients(a, omega)
    kappa, lambda_ = kappa_lambda(a, omega)
    a_sine = np.cos(omega) + cot_psi(a) * np.sin(omega)  # a sin(omega + psi), as a sin(psi) = 1
    return A0 + C0 * kappa, B0 + C0 * lambda_, np.asarray(2 * (a_sine - 1))


def ad_hoc_residual(amplitude: ArrayLike, frequency_ratio: ArrayLike, time: ArrayLike) -> Array:
    """2 theta/alpha [-] before any impact with the sine replaced by (3.27): the left side of (3.28).

    Parameters
    ----------
    amplitude : array_like
        a [-], [1, inf).
    frequency_ratio : array_like
        omega [-], (0, inf).
    time : array_like
        tau since uplift [-].
    """
    return residual(*_quadratic(amplitude, frequency_ratio), time)  # (3.28)


def ad_hoc_impact_time(amplitude: ArrayLike, frequency_ratio: ArrayLike) -> Array:
    """Approximate time from uplift to the first impact inside the pulse, (3.29).

    Parameters
    ----------
    amplitude : array_like
        a [-], [1, inf).
    frequency_ratio : array_like
        omega [-], (0, inf).

    Returns
    -------
    ndarray
        [-], nan where (3.28) has no rising root. Of the two roots (3.29) keeps the one with the plus sign, through
        which theta rises; see `transcendental.rising_root` for why that is the impact.
    """
    return rising_root(*_quadratic(amplitude, frequency_ratio))  # (3.29)


def ad_hoc_margin(amplitude: ArrayLike, frequency_ratio: ArrayLike, restitution: ArrayLike) -> Array:
    """Left side minus right side of the semi-analytical condition (3.30).

    Parameters
    ----------
    amplitude : array_like
        a [-], [1, inf).
    frequency_ratio : array_like
        omega [-], (0, inf).
    restitution : array_like
        eta [-], [0, 1].

    Returns
    -------
    ndarray
        [-], zero on the semi-analytical curve, positive where the block overturns, nan where (3.29) has no root.
    """
    a, omega = checked(amplitude, frequency_ratio)
    tau = ad_hoc_impact_time(a, omega)
    A0, B0, C0 = coefficients(a, omega)
    with np.errstate(over="ignore", invalid="ignore"):
        doubled = B0 * np.exp(tau) - A0 * np.exp(-tau) + C0 * omega * np.cos(omega * tau + uplift_phase(a))  # (3.22)
        return overturning_condition(a, omega, restitution, tau, doubled / 2)  # (3.30)


def semi_analytical_amplitudes(frequency_ratio: ArrayLike, restitution: ArrayLike) -> AmplitudeInterval:
    """Amplitudes between which (3.30) has the block overturn after an impact inside the pulse.

    Parameters
    ----------
    frequency_ratio : array_like
        omega [-], (0, inf).
    restitution : array_like
        eta [-], [0, 1].

    Returns
    -------
    AmplitudeInterval
        Of the broadcast shape. `lower` is the smallest solution of (3.30), the one that the paper compares with
        (3.20) and (3.21). `upper` is its next solution below twice the amplitude of case 2, nan where there is none;
        it stands for no event, as its impact time exceeds the end of the pulse. Nor does `lower` where the same
        holds: compare `ad_hoc_impact_time` with `pulse_end`.
    """
    omega = in_range("frequency_ratio", frequency_ratio, 0.0, np.inf, closed="neither")
    eta = in_range("restitution", restitution, 0.0, 1.0)
    omega, eta = np.broadcast_arrays(omega, eta)
    top = np.log(2 * case_2_amplitude(omega) - 1)
    steps = np.linspace(0.0, 1.0, _GRID).reshape(-1, *(1,) * omega.ndim)
    grid = 1 + np.exp(_FIRST_STEP + (top - _FIRST_STEP) * steps)
    margin = ad_hoc_margin(grid, omega, eta)
    rises = (margin[:-1] < 0) & (margin[1:] >= 0)  # nan compares false: the edges of (3.29) do not count
    after = np.cumsum(rises, axis=0) > 0
    falls = after & (margin[:-1] >= 0) & (margin[1:] < 0)
    return AmplitudeInterval(*(_refined(crossing, grid, omega, eta) for crossing in (rises, falls)))


def _refined(crossing: NDArray[np.bool_], grid: Array, omega: Array, eta: Array) -> Array:
    """Root of (3.30) in the first grid step marked in `crossing` (axis 0), nan where none is."""
    first = np.argmax(crossing, axis=0)[np.newaxis]
    low, high = (np.take_along_axis(grid, first + k, axis=0)[0] for k in (0, 1))
    root = find_root(lambda a, w, e: ad_hoc_margin(np.maximum(a, 1.0), w, e), low, high, omega, eta)
    return np.asarray(np.where(crossing.any(axis=0), root, np.nan))


def within_pulse(amplitude: ArrayLike, frequency_ratio: ArrayLike) -> NDArray[np.bool_]:
    """True where the approximate impact (3.29) comes before the end of the pulse, so that (3.30) speaks of an event."""
    with np.errstate(invalid="ignore"):
        return np.asarray(ad_hoc_impact_time(amplitude, frequency_ratio) <= pulse_end(amplitude, frequency_ratio))
