"""Overturning of the slender block under one full sine: without impact (case 2) and after one (cases 1.1 and 1.2).

Case 2, (3.8) and (3.10), does not depend on restitution. The limit (3.31), where the first impact coincides with the
end of the pulse, separates case 1.1 below it, (3.19) to (3.22), from case 1.2 above it, (3.11) to (3.18).

Case 1.1 is solved without approximation. The transcendental equation (3.21) has no closed-form root tau_i1(a), but it
is linear in s = sqrt(a^2 - 1) (see `motion`), so its inverse a(tau_i1) is explicit. Inserting the inverse makes (3.20)
one equation in tau_i1 alone. The curve is then found by a single root search, without nested iterations.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from rocking._base.errors import in_range
from rocking.paper.arguments import ANY_FREQUENCY_RATIO, POSITIVE_RESTITUTION, Array, checked
from rocking.paper.motion import (
    after_pulse_coefficients,
    angular_velocity,
    arc_terms,
    coefficients,
    cot_psi,
    d0_star,
    pulse_end,
    state_at_pulse_end,
    uplift_phase,
)
from rocking.paper.roots import find_maximum, find_root, residual, rising_root


class AmplitudeInterval(NamedTuple):
    """The block overturns for lower < a < upper [-]; both are nan where the mechanism does not occur."""

    lower: Array
    upper: Array


def case_2_margin(amplitude: ArrayLike, frequency_ratio: ArrayLike) -> Array:
    """Margin of overturning without impact, (3.10).

    sqrt(a^2 - 1) - a e^{-p T_ex} - omega [-]; zero on the curve, positive where the block overturns without impact.
    """
    a, omega = checked(amplitude=amplitude, frequency_ratio=frequency_ratio)
    return np.asarray(cot_psi(a) - a * np.exp(-pulse_end(a, omega)) - omega)  # (3.10), second line


def growing_coefficient(amplitude: ArrayLike, frequency_ratio: ArrayLike) -> Array:
    """2 B_ex0/alpha [-], left side of the first line of (3.10): the block overturns without impact where it is <= 0.

    B0* e^{p T_ex} + (omega/2) C0* [-], infinite where e^{p T_ex} exceeds the double range. In free rocking B = 0 leads
    to the unstable equilibrium, (3.8).
    """
    _, growing = after_pulse_coefficients(amplitude, frequency_ratio)
    with np.errstate(over="ignore"):
        return np.asarray(growing * np.exp(pulse_end(amplitude, frequency_ratio)))  # (3.8), (3.10), first line


def case_2_amplitude(frequency_ratio: ArrayLike) -> Array:
    """Smallest amplitude at which the block overturns without impact, the curve of (3.10).

    a [-], > 1, of the shape of `frequency_ratio`. It is unique: (3.10) divided by a is monotone in psi.
    """
    omega = ANY_FREQUENCY_RATIO.convert(frequency_ratio)
    psi = case_2_phase(omega)
    return np.asarray(1 / np.sin(psi))


def case_2_phase(omega: Array) -> Array:
    """psi [rad] on the curve of (3.10)."""
    return find_root(_manifold, np.zeros_like(omega), np.full_like(omega, np.pi / 2), omega)


def _manifold(psi: Array, omega: Array) -> Array:
    """(3.10) times -sin(psi): omega sin psi - cos psi + e^{-p T_ex}, written with 1 - cos psi and expm1."""
    return np.asarray(omega * np.sin(psi) + 2 * np.sin(psi / 2) ** 2 + np.expm1(-(2 * np.pi - psi) / omega))


def limit_margin(amplitude: ArrayLike, frequency_ratio: ArrayLike) -> Array:
    """Margin of (3.31): sign and distance to the limit between cases 1.1 and 1.2.

    (3.31), left side minus right side, times e^{-p T_ex} [-]: positive where the first impact is after the end of the
    pulse or does not occur; negative where it is within the pulse.
    """
    a, omega = checked(amplitude=amplitude, frequency_ratio=frequency_ratio)
    left = 1 + omega**2 + np.sqrt(1 + (a**2 + 1) * omega**2)
    return np.asarray(left * np.exp(-pulse_end(a, omega)) - omega * (omega - cot_psi(a)))  # (3.31)


def limit_amplitude(frequency_ratio: ArrayLike) -> Array:
    """Amplitude at which the first impact coincides with the end of the pulse, the curve of (3.31).

    a [-], > 1, of the shape of `frequency_ratio`. Above it the first impact is after the pulse (case 1.2, up to
    `case_2_amplitude`), below it within the pulse (case 1.1). Below frequency ratios of about 0.2 it agrees with the
    curve of case 2 in all printed digits.
    """
    omega = ANY_FREQUENCY_RATIO.convert(frequency_ratio)
    psi = find_root(_limit, np.zeros_like(omega), np.full_like(omega, np.pi / 2), omega)
    return np.asarray(1 / np.sin(psi))


def _limit(psi: Array, omega: Array) -> Array:
    """(3.31) times sin(psi) e^{-p T_ex}; collected in omega^2 sin(psi) to avoid cancellation for large omega."""
    decay = np.exp(-(2 * np.pi - psi) / omega)
    regular = decay * (np.sin(psi) + np.sqrt((1 + omega**2) * np.sin(psi) ** 2 + omega**2)) + omega * np.cos(psi)
    return np.asarray(regular + omega**2 * np.sin(psi) * np.expm1(-(2 * np.pi - psi) / omega))


def limit_velocity(frequency_ratio: ArrayLike) -> Array:
    """d(theta/alpha)/d tau [-] just before the impact at the end of the pulse, on the curve of (3.31).

    [-]; where eta times this value exceeds 1 the curve separates overturning by case 1.1 from overturning by case 1.2;
    elsewhere it lies in the region where the block survives.
    """
    a = limit_amplitude(frequency_ratio)
    omega = ANY_FREQUENCY_RATIO.convert(frequency_ratio)
    A0, B0, C0 = coefficients(a, omega)
    grown = 1 + np.sqrt(1 - A0 * B0)  # B0* e^{p T_ex}, (3.31)
    return np.asarray((grown - A0 * np.exp(-pulse_end(a, omega)) + C0 * omega) / 2)  # (3.11)


def case_1_1_impact_time(amplitude: ArrayLike, frequency_ratio: ArrayLike) -> Array:
    """Time tau_i1 from uplift to the first impact if that impact is within the pulse, the root of (3.21).

    tau_i1 [-], nan where the pulse ends before the impact (above (3.31)); 0 for a = 1, where the block does not lift
    off.

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
    """d(theta/alpha)/d tau [-] just before the impact within the pulse, (3.22); nan where there is none."""
    tau = case_1_1_impact_time(amplitude, frequency_ratio)
    velocity = angular_velocity(amplitude, frequency_ratio, np.where(np.isnan(tau), 0.0, tau))  # (3.22)
    return np.asarray(np.where(np.isnan(tau), np.nan, velocity))


def overturning_condition(
    amplitude: ArrayLike, frequency_ratio: ArrayLike, restitution: ArrayLike, time: ArrayLike, velocity: ArrayLike
) -> Array:
    """Left side minus right side of (3.20) for an impact at a given time with a given velocity.

    Parameters
    ----------
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

    Zero on the curve, positive where the block overturns, nan where the pulse ends before the impact [-].
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
    # a grows with the impact time along (3.21). The condition is negative at the start and, of 480 pairs of omega and
    # eta, never had more than two zeros: one before its maximum, the lower amplitude, and one after it, the upper, or
    # none there if the limit comes first.
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
    eta = POSITIVE_RESTITUTION.convert(restitution)
    return find_root(_best_condition, np.full_like(eta, 0.05), np.full_like(eta, 8.0), eta)


def _best_condition(omega: Array, eta: Array) -> Array:
    end = pulse_end(limit_amplitude(omega), omega)
    top = find_maximum(_condition, 1e-3 * end, end, omega, eta)
    return _condition(top, omega, eta)


_UNRESOLVED = 30.0  # p T_ex beyond which e^{-p T_ex} is below the rounding error of a
_PRODUCT_FROM = 4.0  # p T_ex from which the product form of D0* is more accurate than the energy, which may overflow


def case_1_2_residual(amplitude: ArrayLike, frequency_ratio: ArrayLike, time: ArrayLike) -> Array:
    """2 theta/alpha [-] in free rocking before any impact, left side of (3.12).

    Parameters
    ----------
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

    tau_i2 [-]: ln[(1 + sqrt(1 - D0*))/(B0* + (omega/2) C0* e^{-p T_ex})]; nan where the block overturns first. Physical
    where it is at least p T_ex, that is above (3.31).
    """
    decaying, growing = after_pulse_coefficients(amplitude, frequency_ratio)
    T = pulse_end(amplitude, frequency_ratio)
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        since_end = rising_root(decaying, growing * np.exp(T), -2.0)  # (3.13), with tau_i2 - p T_ex as unknown
        root = np.logaddexp(0.0, np.log(-decaying * growing) + T) / 2  # log of sqrt(1 - D0*), for e^T out of range
        return np.asarray(np.where(T < 700, T + since_end, np.logaddexp(0.0, root) - np.log(growing)))  # (3.13)


def free_velocity(amplitude: ArrayLike, frequency_ratio: ArrayLike, time: ArrayLike) -> Array:
    """d(theta/alpha)/d tau [-] in free rocking before any impact, (3.14), at any time after the pulse."""
    a, omega, tau = checked(amplitude=amplitude, frequency_ratio=frequency_ratio, time=time)
    decaying, growing = after_pulse_coefficients(a, omega)
    T = pulse_end(a, omega)
    since_end = tau - T
    with np.errstate(over="ignore", invalid="ignore"):
        return np.asarray((growing * np.exp(T) * np.exp(since_end) - decaying * np.exp(-since_end)) / 2)  # (3.14)


def impact_velocity_squared(amplitude: ArrayLike, frequency_ratio: ArrayLike) -> Array:
    """Square of the velocity at an impact after the pulse, 1 - D0* of (3.15).

    (d(theta/alpha)/d tau)^2 [-]; infinite where e^{p T_ex} exceeds the double range. For short pulses D0* is close to
    one; 1 - D0* is then computed as the energy of free rocking, v_ex^2 - y_ex (y_ex + 2), without cancellation.
    """
    a, omega = checked(amplitude=amplitude, frequency_ratio=frequency_ratio)
    y, v = state_at_pulse_end(a, omega)
    with np.errstate(over="ignore", invalid="ignore"):
        energy = v * v - y * (y + 2)
        # (3.15), the square of the velocity
        return np.asarray(np.where(pulse_end(a, omega) < _PRODUCT_FROM, energy, 1 - d0_star(a, omega)))


def case_1_2_impact_velocity(amplitude: ArrayLike, frequency_ratio: ArrayLike) -> Array:
    """d(theta/alpha)/d tau [-] just before an impact after the pulse, sqrt(1 - D0*), (3.15)."""
    squared = impact_velocity_squared(amplitude, frequency_ratio)
    return np.asarray(np.sqrt(np.where(squared >= 0, squared, np.nan)))  # (3.15)


def case_1_2_margin(amplitude: ArrayLike, frequency_ratio: ArrayLike, restitution: ArrayLike) -> Array:
    """Margin of overturning after an impact that follows the pulse, (3.16) to (3.18).

    eta v_i2 - 1 = B_i2 [-], zero on (3.18), positive where the block overturns; valid between `limit_amplitude` and
    `case_2_amplitude` only.
    """
    a, omega, eta = checked(amplitude=amplitude, frequency_ratio=frequency_ratio, restitution=restitution)
    with np.errstate(invalid="ignore"):
        return np.asarray(eta * case_1_2_impact_velocity(a, omega) - 1)  # (3.16), (3.17)


def condition_3_18(amplitude: ArrayLike, frequency_ratio: ArrayLike) -> Array:
    """Left side of (3.18) as printed [-]; the block overturns where it exceeds 1/eta^2.

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

    Returns
    -------
    AmplitudeInterval
        Of the broadcast shape. `lower` is the lower branch of (3.18), or the limit (3.31) where that branch lies
        below the limit, in case 1.1; `upper` is the upper branch, below the curve of case 2 except for eta = 1. Both
        are nan where there is no such overturning.
    """
    omega, eta = checked(frequency_ratio=frequency_ratio, restitution=restitution)
    limit, overturned_at_limit = limit_amplitude(omega), eta * limit_velocity(omega) >= 1
    # psi falls as a rises: from case 2 to the limit the upper branch lies before the maximum of the excess, the lower
    # branch after it. Of 900 pairs of omega and eta none had more than these two zeros.
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


class OverturningAmplitudes(NamedTuple):
    """Amplitudes a [-] at which the outcome changes.

    The block overturns for overturns_from < a < survives_again, but for the gap of the notes, and for a > direct.
    """

    overturns_from: Array
    survives_again: Array
    direct: Array


def overturning_amplitudes(frequency_ratio: ArrayLike, restitution: ArrayLike) -> OverturningAmplitudes:
    """Overturning thresholds of one full sine by the closed forms of the paper.

    Returns
    -------
    OverturningAmplitudes
        Of the broadcast shape. `overturns_from` and `survives_again` are the limits of overturning after one impact
        (cases 1.1 and 1.2), nan where there is none; from `direct` on the block overturns without impact (case 2).

    Notes
    -----
    Between the two ends a block may survive all the same, near the tip of the region: for eta = 0.72 with omega from
    3.4336 to 3.4395, where a gap reaches into it (2.389 < a < 2.515 at 3.4372). `case_1_1_margin` and
    `case_1_2_margin` are negative there.

    These curves are not complete, contrary to the paper. Near the tip of the surviving region (1/a > 0.897, omega <
    1.1) there are islands in which the block overturns after two or more impacts, all within the pulse: an odd number
    of them unless impacts accumulate to rest before, which was found for eta < 0.1 only. Outside these islands the
    solver gave the outcome predicted by the curves for all of 900 000 random blocks with eta from 0.3 to 1.

    Examples
    --------
    >>> [round(float(a), 5) for a in overturning_amplitudes(3.0, 0.9)]
    [1.40357, 3.48466, 3.63115]
    """
    during = case_1_1_amplitudes(frequency_ratio, restitution)
    after = case_1_2_amplitudes(frequency_ratio, restitution)
    direct = np.broadcast_to(case_2_amplitude(frequency_ratio), during.lower.shape).copy()
    return OverturningAmplitudes(np.fmin(during.lower, after.lower), np.fmax(during.upper, after.upper), direct)
