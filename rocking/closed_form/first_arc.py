"""Motion from uplift to the first impact under one full sine, (3.4) with (3.7), in forms without cancellation.

With (3.7) inserted, (3.4) is linear in s = sqrt(a^2 - 1):

    theta/alpha = [Y_c(tau) - s Y_s(tau)]/(omega^2 + 1),   Y_c = omega^2 (cosh tau - 1) - (1 - cos omega tau),
                                                           Y_s = omega sinh tau - sin omega tau,   Y_c' = omega Y_s.

For small tau, Y_c is of order tau^4 and Y_s of order tau^3, while the four terms of (3.4) are of order one. Close to
a = 1 the first impact follows shortly after uplift, where (3.4) as printed loses all digits. A power series is used
there.
"""

from __future__ import annotations

from math import factorial

import numpy as np
from numpy.typing import ArrayLike

from rocking._model.checks import check
from rocking.closed_form.arguments import TIME, Array, checked
from rocking.closed_form.coefficients import coefficients, cot_psi, pulse_end, uplift_phase

_SERIES_UNTIL = 1.0  # max(tau, omega tau) up to which the series is used; the error of ten terms is then 1e-19
_SERIES_TERMS = 10


def rotation(amplitude: ArrayLike, frequency_ratio: ArrayLike, time: ArrayLike) -> Array:
    """theta/alpha [-] before any impact while the pulse acts, (3.4).

    Parameters
    ----------
    amplitude : array_like
        a [-], [1, 1e12].
    frequency_ratio : array_like
        omega [-], [1e-12, 1e12].
    time : array_like
        tau = p t since uplift [-], [0, inf).
    """
    check(TIME, time)
    a, omega, tau = checked(amplitude=amplitude, frequency_ratio=frequency_ratio, time=time)
    Yc, Ys = arc_terms(tau, omega)
    with np.errstate(over="ignore", invalid="ignore"):
        return np.asarray((Yc - cot_psi(a) * Ys) * np.exp(tau) / (2 * (omega * omega + 1)))  # (3.4), theta


def angular_velocity(amplitude: ArrayLike, frequency_ratio: ArrayLike, time: ArrayLike) -> Array:
    """d(theta/alpha)/d tau [-] before any impact while the pulse acts, (3.4) and, at an impact, (3.22).

    Parameters
    ----------
    amplitude : array_like
        a [-], [1, 1e12].
    frequency_ratio : array_like
        omega [-], [1e-12, 1e12].
    time : array_like
        tau = p t since uplift [-], [0, inf).
    """
    check(TIME, time)
    a, omega, tau = checked(amplitude=amplitude, frequency_ratio=frequency_ratio, time=time)
    _, Ys = arc_terms(tau, omega)
    decay = np.exp(-tau)
    Ys_slope = omega * (np.expm1(-tau) ** 2 + 4 * decay * np.sin(omega * tau / 2) ** 2)
    with np.errstate(over="ignore", invalid="ignore"):
        scale = np.exp(tau) / (2 * (omega * omega + 1))
        return np.asarray((omega * Ys - cot_psi(a) * Ys_slope) * scale)  # (3.4), velocity; (3.22)


def arc_terms(tau: Array, omega: Array) -> tuple[Array, Array]:
    """2 e^{-tau} Y_c and 2 e^{-tau} Y_s [-] as in the module docstring; `tau` >= 0 and `omega` > 0 broadcast."""
    tau, omega = np.broadcast_arrays(tau, omega)
    decay = np.exp(-tau)
    Yc = omega * omega * np.expm1(-tau) ** 2 - 4 * decay * np.sin(omega * tau / 2) ** 2
    Ys = -omega * np.expm1(-2 * tau) - 2 * decay * np.sin(omega * tau)
    short = np.maximum(tau, omega * tau) < _SERIES_UNTIL
    if short.any():
        cosine_part, sine_part = _short_time_series(np.where(short, tau, 0.0), np.where(short, omega, 1.0))
        Yc, Ys = np.where(short, cosine_part, Yc), np.where(short, sine_part, Ys)
    return np.asarray(Yc), np.asarray(Ys)


def _short_time_series(tau: Array, omega: Array) -> tuple[Array, Array]:
    """Power series of `arc_terms` without the leading terms, which cancel identically."""
    Yc, Ys = np.zeros_like(tau), np.zeros_like(tau)
    for k in range(1, _SERIES_TERMS):
        sign = (-1.0) ** k
        Ys = Ys + (omega * tau ** (2 * k + 1) - sign * (omega * tau) ** (2 * k + 1)) / factorial(2 * k + 1)
        Yc = Yc + (omega**2 * tau ** (2 * k + 2) - sign * (omega * tau) ** (2 * k + 2)) / factorial(2 * k + 2)
    return 2 * np.exp(-tau) * Yc, 2 * np.exp(-tau) * Ys


def printed_rotation(amplitude: ArrayLike, frequency_ratio: ArrayLike, time: ArrayLike) -> Array:
    """theta/alpha [-] before any impact, (3.4) term by term as in (3.21): inaccurate at short and at long times.

    Parameters
    ----------
    amplitude : array_like
        a [-], [1, 1e12].
    frequency_ratio : array_like
        omega [-], [1e-12, 1e12].
    time : array_like
        tau = p t since uplift [-], [0, inf).
    """
    check(TIME, time)
    a, omega, tau = checked(amplitude=amplitude, frequency_ratio=frequency_ratio, time=time)
    A0, B0, C0 = coefficients(a, omega)
    forced = C0 * np.sin(omega * tau + uplift_phase(a))
    with np.errstate(over="ignore", invalid="ignore"):
        return np.asarray((A0 * np.exp(-tau) + B0 * np.exp(tau) + forced - 2) / 2)  # (3.4), left side of (3.21)


def state_at_pulse_end(amplitude: ArrayLike, frequency_ratio: ArrayLike) -> tuple[Array, Array]:
    """Rotation theta_ex0/alpha and velocity [-] at the end of the pulse if there was no impact before, (3.11).

    Parameters
    ----------
    amplitude : array_like
        a [-], [1, 1e12].
    frequency_ratio : array_like
        omega [-], [1e-12, 1e12].
    """
    T = pulse_end(amplitude, frequency_ratio)
    return rotation(amplitude, frequency_ratio, T), angular_velocity(amplitude, frequency_ratio, T)  # (3.11)
