"""Overturning of the slender block under any pulse, if no further impact occurs within the pulse.

Between impacts the growing part of the motion, E = theta/alpha + velocity -+ 1, obeys E' = E - a f. The block overturns
after the pulse if E then has the sign of the rotation. This condition is one integral over the pulse, from uplift or
from an impact on. It contains (3.10), (3.18) and (3.20) and is an independent check of the solver for every pulse. At
the end, published conditions of overturning without impact for three simple pulses.
"""

import cmath
import math

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq

from rocking._base.errors import number, positive
from rocking._base.quantities import RESTITUTION
from rocking._excitation.pulses import AbstractPulse, SinusoidalPulse, as_pulse
from rocking.paper.arguments import ANY_FREQUENCY_RATIO, Array
from rocking.paper.roots import find_root

_NEGLIGIBLE = 50.0  # time s beyond which e^-s < 2e-22 is neglected
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(20)


def first_uplift_phase(pulse: str | AbstractPulse, amplitude: float) -> float:
    """Phase of the pulse at which |a f| first reaches 1.

    phi [rad]; nan if the block never uplifts.
    """
    shape = as_pulse(pulse)
    a = positive("amplitude", amplitude, "-")
    if abs(a * float(shape.shape(shape.start))) >= 1:
        return shape.start
    for low, high in shape.monotone_pieces:
        if abs(a * float(shape.shape(high))) >= 1:  # |f| reaches 1/a from below exactly once on this piece
            return float(brentq(lambda phi: a * abs(float(shape.shape(phi))) - 1, low, high, xtol=1e-15, rtol=8.9e-16))
    return math.nan


def discounted_integral(pulse: str | AbstractPulse, frequency_ratio: float, start_phase: float) -> float:
    """Integral of f e^{-(s - tau_0)} ds from phase `start_phase` to the end of the pulse [-].

    Parameters
    ----------
    pulse : str or AbstractPulse
        Closed form for sums of sinusoids, composite Gauss quadrature for others.
    start_phase : float
        phi at tau_0 [rad], within the pulse.
    """
    shape = as_pulse(pulse)
    omega = ANY_FREQUENCY_RATIO.number(frequency_ratio)
    phi0 = number("start_phase", start_phase, shape.start, shape.end, unit="rad")
    length = (shape.end - phi0) / omega
    if isinstance(shape, SinusoidalPulse):
        total = 0.0
        for c, w, d in shape.terms:
            rate = complex(-1.0, w * omega)
            total += (c * cmath.exp(1j * (w * phi0 + d)) * (cmath.exp(rate * length) - 1) / rate).real
        return total
    length = min(length, _NEGLIGIBLE)
    # at most one unit of s, one radian and one monotone or linear piece each: 20 nodes are exact to rounding
    equal = np.linspace(0.0, length, math.ceil(length * max(omega, 1.0)) + 1)
    cuts = (np.asarray(shape.stationary if shape.samples is None else shape.samples[0]) - phi0) / omega
    edges = np.unique(np.concatenate([equal, cuts[(cuts > 0.0) & (cuts < length)]]))
    halves = 0.5 * np.diff(edges)[:, None]
    s = edges[:-1, None] + halves * (_NODES + 1)
    values = shape.shape(phi0 + omega * s) * np.exp(-s)
    return float(np.sum(values * _WEIGHTS * halves))


def margin_without_impact(pulse: str | AbstractPulse, amplitude: float, frequency_ratio: float) -> float:
    """Margin of overturning without impact, for any pulse.

    +- a * integral of f e^{-(s - tau_0)} ds - 1 [-] from uplift on, with the sign of f at uplift: positive where the
    block overturns without impact, provided that no impact occurs before the pulse ends. -1 if there is no uplift. For
    the sine the margin vanishes on (3.10).
    """
    shape = as_pulse(pulse)
    a = positive("amplitude", amplitude, "-")
    phi0 = first_uplift_phase(shape, a)
    if math.isnan(phi0):
        return -1.0
    side = math.copysign(1.0, float(shape.shape(phi0)))
    return side * a * discounted_integral(shape, frequency_ratio, phi0) - 1


def margin_after_impact(
    pulse: str | AbstractPulse,
    amplitude: float,
    frequency_ratio: float,
    restitution: float,
    impact_phase: float,
    impact_velocity: float,
) -> float:
    """Margin of overturning after the last impact within the pulse.

    Parameters
    ----------
    impact_phase : float
        phi of the impact [rad]; the forcing is zero from the end of the pulse on.
    impact_velocity : float
        d(theta/alpha)/d tau just before the impact [-], with its sign.

    Returns
    -------
    float
        eta |v| - (sign of v) a * integral of f e^{-(s - tau_1)} ds - 1 [-], positive where the block overturns. For the
        sine the margin vanishes on (3.18) and on (3.20).
    """
    shape = as_pulse(pulse)
    a, eta = positive("amplitude", amplitude, "-"), RESTITUTION.number(restitution)
    phase = number("impact_phase", impact_phase, shape.start, math.inf, unit="rad")
    velocity = number("impact_velocity", impact_velocity, -math.inf, math.inf)
    forced = discounted_integral(shape, frequency_ratio, phase) if phase < shape.end else 0.0
    return eta * abs(velocity) - math.copysign(a, velocity) * forced - 1


def rectangular_amplitude(frequency_ratio: ArrayLike) -> Array:
    """Smallest amplitude at which a rectangular pulse of duration T_p/2 overturns the block (Housner 1963).

    Parameters
    ----------
    frequency_ratio : array_like
        omega [-], [1e-12, 1e12]; the pulse lasts p t_1 = pi/omega.

    Returns
    -------
    ndarray
        a = 1/(1 - exp(-p t_1)) [-].
    """
    omega = ANY_FREQUENCY_RATIO.convert(frequency_ratio)
    return np.asarray(-1 / np.expm1(-np.pi / omega))


def half_sine_amplitude(frequency_ratio: ArrayLike) -> Array:
    """Smallest amplitude at which half a sine overturns the block (Shi et al. 1996).

    a = 1/sin(psi) [-] with omega sin(psi) - cos(psi) = exp(-(pi - psi)/omega).
    """
    omega = ANY_FREQUENCY_RATIO.convert(frequency_ratio)
    psi = find_root(_half_sine, np.zeros_like(omega), np.full_like(omega, np.pi / 2), omega)
    return np.asarray(1 / np.sin(psi))


def _half_sine(psi: Array, omega: Array) -> Array:
    return np.asarray(omega * np.sin(psi) - np.cos(psi) - np.exp(-(np.pi - psi) / omega))


def cosine_amplitude(frequency_ratio: ArrayLike) -> Array:
    """Smallest amplitude at which one full cosine overturns the block, if no impact occurs within the pulse.

    a = (1 + omega^2)/(1 - exp(-2 pi/omega)) [-].
    """
    omega = ANY_FREQUENCY_RATIO.convert(frequency_ratio)
    return np.asarray(-(1 + omega**2) / np.expm1(-2 * np.pi / omega))
