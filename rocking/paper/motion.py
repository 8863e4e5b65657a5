"""Motion from uplift to the first impact under one full sine: (3.3), (3.4), (3.7) and (3.9) without cancellation.

Below a frequency ratio of about 0.009, `e^{p T_ex}` exceeds the double range. Formulas that contain it are therefore
multiplied by `e^{-p T_ex}`; only D0*, which is of that magnitude, is infinite there.

With (3.7) inserted, (3.4) is linear in s = sqrt(a^2 - 1):

    theta/alpha = [Y_c(tau) - s Y_s(tau)]/(omega^2 + 1),   Y_c = omega^2 (cosh tau - 1) - (1 - cos omega tau),
                                                           Y_s = omega sinh tau - sin omega tau,   Y_c' = omega Y_s.

For small tau, Y_c is of order tau^4 and Y_s of order tau^3, while the four terms of (3.4) are of order one. Close to
a = 1 the first impact follows shortly after uplift, where (3.4) as printed loses all digits. A power series is used
there.
"""

from math import factorial
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from rocking.paper.arguments import AMPLITUDE, TIME, Array, checked


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

    psi = arcsin(1/a) [rad], (0, pi/2]. The paper prints 1/alpha instead of 1/a; a is defined in (3.6).
    """
    a = AMPLITUDE.convert(amplitude)
    # accurate near a = 1, where arcsin(1/a) loses half the digits
    return np.asarray(np.arctan2(1.0, cot_psi(a)))  # (3.3)


def pulse_end(amplitude: ArrayLike, frequency_ratio: ArrayLike) -> Array:
    """p T_ex = (2 pi - psi)/omega [-], the time from uplift to the end of the pulse, below (3.2)."""
    a, omega = checked(amplitude=amplitude, frequency_ratio=frequency_ratio)
    return np.asarray((2 * np.pi - uplift_phase(a)) / omega)


def integration_constants(amplitude: ArrayLike, frequency_ratio: ArrayLike) -> tuple[Array, Array]:
    """A0/alpha and B0/alpha [-] for a start from rest, (3.7)."""
    starred = coefficients(amplitude, frequency_ratio)
    return np.asarray(starred.A0 / 2), np.asarray(starred.B0 / 2)  # (3.7)


def coefficients(amplitude: ArrayLike, frequency_ratio: ArrayLike) -> Coefficients:
    """A0*, B0* and C0*, (3.9)."""
    a, omega = checked(amplitude=amplitude, frequency_ratio=frequency_ratio)
    s, K = cot_psi(a), omega / (omega * omega + 1)
    A0, B0, C0 = K * (omega + s), K * (omega - s), 2 * a * K / omega  # (3.9)
    return Coefficients(np.asarray(A0), np.asarray(B0), np.asarray(C0))


def after_pulse_coefficients(amplitude: ArrayLike, frequency_ratio: ArrayLike) -> tuple[Array, Array]:
    """Coefficients of free rocking after the pulse and before any impact, the two factors of D0* in (3.9).

    After the pulse `2 theta/alpha = -2 + [decaying] e^{p T_ex} e^{-tau} + [growing] e^{tau}`, (3.5).

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

    D0* [-]; the velocity at the first impact is sqrt(1 - D0*), (3.15).
    """
    decaying, growing = after_pulse_coefficients(amplitude, frequency_ratio)
    with np.errstate(over="ignore"):
        return np.asarray(decaying * growing * np.exp(pulse_end(amplitude, frequency_ratio)))  # (3.9), first line


def d0_star_expanded(amplitude: ArrayLike, frequency_ratio: ArrayLike) -> Array:
    """D0* by the second line of (3.9), corrected; nan or infinite where e^{p T_ex} exceeds the double range.

    The paper prints the factor omega/(omega^2 + 1); the product in the first line gives its square.
    """
    a, omega = checked(amplitude=amplitude, frequency_ratio=frequency_ratio)
    s, T = cot_psi(a), pulse_end(a, omega)
    with np.errstate(over="ignore", invalid="ignore"):
        bracket = omega**2 - 2 * a**2 + 1 + (s + omega) * a * np.exp(-T) + (s - omega) * a * np.exp(T)
    return np.asarray((omega / (omega**2 + 1)) ** 2 * bracket)  # (3.9), second line, square restored


_SERIES_UNTIL = 1.0  # max(tau, omega tau) up to which the series is used; the error of ten terms is then 1e-19
_SERIES_TERMS = 10


def rotation(amplitude: ArrayLike, frequency_ratio: ArrayLike, time: ArrayLike) -> Array:
    """theta/alpha [-] before any impact while the pulse acts, (3.4)."""
    TIME.convert(time)
    a, omega, tau = checked(amplitude=amplitude, frequency_ratio=frequency_ratio, time=time)
    Yc, Ys = arc_terms(tau, omega)
    with np.errstate(over="ignore", invalid="ignore"):
        return np.asarray((Yc - cot_psi(a) * Ys) * np.exp(tau) / (2 * (omega * omega + 1)))  # (3.4), theta


def angular_velocity(amplitude: ArrayLike, frequency_ratio: ArrayLike, time: ArrayLike) -> Array:
    """d(theta/alpha)/d tau [-] before any impact while the pulse acts, (3.4) and, at an impact, (3.22)."""
    TIME.convert(time)
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
        Yc, Ys = np.asarray(Yc), np.asarray(Ys)
        Yc[short], Ys[short] = _short_time_series(tau[short], omega[short])
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
    """theta/alpha [-] before any impact, (3.4) term by term as in (3.21): inaccurate at short and at long times."""
    TIME.convert(time)
    a, omega, tau = checked(amplitude=amplitude, frequency_ratio=frequency_ratio, time=time)
    A0, B0, C0 = coefficients(a, omega)
    forced = C0 * np.sin(omega * tau + uplift_phase(a))
    with np.errstate(over="ignore", invalid="ignore"):
        return np.asarray((A0 * np.exp(-tau) + B0 * np.exp(tau) + forced - 2) / 2)  # (3.4), left side of (3.21)


def state_at_pulse_end(amplitude: ArrayLike, frequency_ratio: ArrayLike) -> tuple[Array, Array]:
    """Rotation theta_ex0/alpha and velocity [-] at the end of the pulse if there was no impact before, (3.11)."""
    T = pulse_end(amplitude, frequency_ratio)
    return rotation(amplitude, frequency_ratio, T), angular_velocity(amplitude, frequency_ratio, T)  # (3.11)
