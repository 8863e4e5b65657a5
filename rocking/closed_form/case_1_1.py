"""Case 1.1: overturning after one impact within the pulse, (3.19) to (3.22), without approximation.

The transcendental equation (3.21) has no closed-form root tau_i1(a), but it is linear in s = sqrt(a^2 - 1) (see
`first_arc`), so its inverse a(tau_i1) is explicit. Inserting the inverse makes (3.20) one equation in tau_i1 alone. The
curve is then found by a single root search, without nested iterations.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from rocking._base.errors import in_range
from rocking._model.checks import check
from rocking.closed_form.arguments import POSITIVE_RESTITUTION, Array, checked
from rocking.closed_form.coefficients import coefficients, cot_psi, pulse_end, uplift_phase
from rocking.closed_form.first_arc import angular_velocity, arc_terms
from rocking.closed_form.interval import AmplitudeInterval
from rocking.closed_form.limit import limit_amplitude
from rocking.closed_form.roots import find_maximum, find_root


def case_1_1_impact_time(amplitude: ArrayLike, frequency_ratio: ArrayLike) -> Array:
    """Time tau_i1 from uplift to the first impact if that impact is within the pulse, the root of (3.21).

    Parameters
    ----------
    amplitude : array_like
        a [-], [1, 1e12].
    frequency_ratio : array_like
        omega [-], [1e-12, 1e12].

    Returns
    -------
    ndarray
        tau_i1 [-], nan where the pulse ends before the impact (above (3.31)); 0 for a = 1, where the block does not
        lift off.

    Notes
    -----
    While the phase is in (psi, pi - psi), theta'' - theta < 0: the ground acceleration moves the block away from
    theta = 0, and no impact is possible. From then on theta'' - theta > 0 until the pulse ends, and a solution that
    starts below zero crosses zero at most once. Any root is therefore unique and lies in [(pi - 2 psi)/omega, p T_ex];
    there is one if and only if theta >= 0 at the end of the pulse.
    """
    a, omega = checked(amplitude=amplitude, frequency_ratio=frequency_ratio)
    psi = uplift_phase(a)
    tau = find_root(_rotation, (np.pi - 2 * psi) / omega, pulse_end(a, omega), omega, cot_psi(a))
    return np.asarray(np.where(a == 1.0, 0.0, tau))  # (3.21)


def _rotation(tau: Array, omega: Array, s: Array) -> Array:
    Yc, Ys = arc_terms(tau, omega)
    return np.asarray(Yc - s * Ys)


def case_1_1_impact_velocity(amplitude: ArrayLike, frequency_ratio: ArrayLike) -> Array:
    """d(theta/alpha)/d tau [-] just before the impact within the pulse, (3.22); nan where there is none.

    Parameters
    ----------
    amplitude : array_like
        a [-], [1, 1e12].
    frequency_ratio : array_like
        omega [-], [1e-12, 1e12].
    """
    tau = case_1_1_impact_time(amplitude, frequency_ratio)
    velocity = angular_velocity(amplitude, frequency_ratio, np.where(np.isnan(tau), 0.0, tau))  # (3.22)
    return np.asarray(np.where(np.isnan(tau), np.nan, velocity))


def overturning_condition(
    amplitude: ArrayLike, frequency_ratio: ArrayLike, restitution: ArrayLike, time: ArrayLike, velocity: ArrayLike
) -> Array:
    """Left side minus right side of (3.20) for an impact at a given time with a given velocity.

    Parameters
    ----------
    amplitude : array_like
        a [-], [1, 1e12].
    frequency_ratio : array_like
        omega [-], [1e-12, 1e12].
    restitution : array_like
        eta [-], [0, 1].
    time : array_like
        tau_i since uplift [-], [0, p T_ex].
    velocity : array_like
        d(theta/alpha)/d tau just before the impact [-].

    Returns
    -------
    ndarray
        2 B_ex1/alpha e^{tau_i} [-], zero for (3.19), positive where the block overturns.
    """
    a, omega, eta, tau, v = checked(
        amplitude=amplitude, frequency_ratio=frequency_ratio, restitution=restitution, time=time, velocity=velocity
    )
    C0, phi = coefficients(a, omega).C0, omega * tau + uplift_phase(a)
    with np.errstate(over="ignore", invalid="ignore"):
        forced = omega * np.exp(tau - pulse_end(a, omega)) - omega * np.cos(phi) - np.sin(phi)
        return np.asarray(2 * eta * v + C0 * forced - 2)  # (3.19), (3.20)


def case_1_1_margin(amplitude: ArrayLike, frequency_ratio: ArrayLike, restitution: ArrayLike) -> Array:
    """Margin of overturning after an impact within the pulse, (3.20) at the root of (3.21).

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
        [-], zero on the curve, positive where the block overturns, nan where the pulse ends before the impact.
    """
    tau = case_1_1_impact_time(amplitude, frequency_ratio)
    velocity = case_1_1_impact_velocity(amplitude, frequency_ratio)
    return overturning_condition(amplitude, frequency_ratio, restitution, tau, velocity)


def amplitude_of_impact_time(impact_time: ArrayLike, frequency_ratio: ArrayLike) -> Array:
    """Amplitude at which the first impact occurs at a given time, (3.21) solved for a.

    Parameters
    ----------
    impact_time : array_like
        tau_i1 since uplift [-], [1e-30, p T_ex].
    frequency_ratio : array_like
        omega [-], [1e-12, 1e12].

    Returns
    -------
    ndarray
        a [-]: sqrt(a^2 - 1) = [omega^2 (cosh tau - 1) - (1 - cos omega tau)]/[omega sinh tau - sin omega tau].
    """
    in_range("impact_time", impact_time, 1e-30, np.inf, closed="left")
    tau, omega = checked(impact_time=impact_time, frequency_ratio=frequency_ratio)
    Yc, Ys = arc_terms(tau, omega)
    return np.asarray(np.hypot(1.0, Yc / Ys))  # (3.21)


def _condition(tau: Array, omega: Array, eta: Array) -> Array:
    """(3.20) with a eliminated by (3.21), as a function of the impact time; exponentials are scaled by e^-tau."""
    decay, c, n = np.exp(-tau), np.cos(omega * tau), np.sin(omega * tau)
    Yc, Ys = arc_terms(tau, omega)
    s = Yc / Ys
    # velocity (3.22) = (Y_c' Y_s - Y_c Y_s')/Y_s/(omega^2 + 1); its e^{2 tau} terms cancel and are left out
    numerator = (1 + omega**2) * (1 + decay**2 - 2 * decay * c) + (1 - omega**2) * (2 * decay - (1 + decay**2) * c)
    numerator = numerator + 2 * omega * n * np.expm1(-2 * tau)
    velocity = omega * numerator / Ys / (1 + omega**2)
    to_end = np.exp(tau - (2 * np.pi - np.arctan2(1.0, s)) / omega)
    forced = omega * np.hypot(1.0, s) * to_end - omega * (s * c - n) - (s * n + c)  # a cos psi = s, a sin psi = 1
    return np.asarray(2 * eta * velocity + 2 * forced / (1 + omega**2) - 2)


def case_1_1_amplitudes(frequency_ratio: ArrayLike, restitution: ArrayLike) -> AmplitudeInterval:
    """Amplitudes between which the block overturns after an impact within the pulse, (3.20) with (3.21).

    Parameters
    ----------
    frequency_ratio : array_like
        omega [-], [1e-12, 1e12].
    restitution : array_like
        eta [-], [0, 1].

    Returns
    -------
    AmplitudeInterval
        Of the broadcast shape. `lower` is the curve of figure 3. `upper` is the limit (3.31), where case 1.2 begins,
        except for low frequency ratios (omega < 0.25 for eta = 0.8), where the block survives already below that
        limit. Both are nan where there is no such overturning, beyond `case_1_1_end`.
    """
    omega, eta = checked(frequency_ratio=frequency_ratio, restitution=restitution)
    limit = limit_amplitude(omega)
    end = pulse_end(limit, omega)
    start = 1e-3 * end  # an impact this early never overturns: (3.20) is near -2 + C0* omega e^{-p T_ex} < 0
    top = find_maximum(_condition, start, end, omega, eta)
    overturned = _condition(top, omega, eta) > 0
    lower = _amplitude(find_root(_condition, start, top, omega, eta), omega)
    upper = _amplitude(find_root(_condition, top, end, omega, eta), omega)
    upper = np.where(np.isnan(upper), limit, upper)
    return AmplitudeInterval(np.where(overturned, lower, np.nan), np.where(overturned, upper, np.nan))


def _amplitude(tau: Array, omega: Array) -> Array:
    Yc, Ys = arc_terms(np.where(np.isnan(tau), 1.0, tau), omega)
    return np.asarray(np.where(np.isnan(tau), np.nan, np.hypot(1.0, Yc / Ys)))


def case_1_1_end(restitution: ArrayLike) -> Array:
    """Frequency ratio beyond which no block overturns after an impact within the pulse.

    Parameters
    ----------
    restitution : array_like
        eta [-], (0, 1].

    Returns
    -------
    ndarray
        omega [-]: 4.1 for eta = 0.80, 4.4 for 0.85, 4.8 for 0.90, 5.5 for 1. For eta above about 0.6 the lower
        branch of (3.18) and the curve (3.20) meet there on the limit (3.31); for smaller eta the curve (3.20) has a
        turning point there.
    """
    eta = check(POSITIVE_RESTITUTION, restitution)
    return find_root(_best_condition, np.full_like(eta, 0.05), np.full_like(eta, 8.0), eta)


def _best_condition(omega: Array, eta: Array) -> Array:
    end = pulse_end(limit_amplitude(omega), omega)
    top = find_maximum(_condition, 1e-3 * end, end, omega, eta)
    return _condition(top, omega, eta)
