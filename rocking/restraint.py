"""Closed forms for slender blocks with a tendon and a damper, in the manner of section 3 of the paper.

They are not the paper's: its conditions with exp(lambda tau) in place of exp(tau). A vertical tendon along the centre
line, stiffness k and prestress P0, holds the block down; a vertical damper c acts at the edge that uplifts. In the
slender limit, with y = theta/alpha, tau = p t and s = sgn(y),

    y'' + 2 zeta y' - (1 - kappa) y + s (1 + sigma) = -a f,
    kappa = k b^2/(m g R),  sigma = P0/(m g),  zeta = (3/2) (b/R)^2 c/(m p)

The block uplifts at |a f| = 1 + sigma. The growing part of the motion is

    w = y' + ((1 - kappa)/lambda) (y - s y*),  w' = lambda w - a f,
    lambda = sqrt(zeta^2 + 1 - kappa) - zeta,  y* = (1 + sigma)/(1 - kappa)

and its sign decides about overturning after the pulse. From kappa = 1 on there is no escape: amplitudes are infinite or
nan there. Without damping y (1 - kappa)/(1 + sigma) is the rotation of a free block with the amplitude a/(1 + sigma)
and the frequency ratio omega/sqrt(1 - kappa).

Parameters
----------
amplitude, frequency_ratio, restitution, pulse
    As in `rocking.paper`; without `pulse` one full sine.
stiffness, prestress, damping : array_like
    kappa, [0, 1e4], sigma, [0, 1e4], zeta, [0, 10] [-]; 0 by default.

Returns
-------
ndarray
    Of the broadcast shape of the arguments, float64; nan where the event does not occur.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from rocking._base.quantities import DAMPING, PRESTRESS, STIFFNESS
from rocking._excitation.pulses import AbstractPulse
from rocking.paper import any_pulse
from rocking.paper.arguments import AMPLITUDE, ANY_FREQUENCY_RATIO, Array, checked
from rocking.paper.overturning import OverturningAmplitudes, case_2_amplitude
from rocking.paper.roots import find_maximum, find_root

__all__ = [
    "direct_amplitude",
    "direct_groups",
    "equilibrium_rotation",
    "growth_rate",
    "limit_amplitude",
    "margin_after_impact",
    "margin_after_one_impact",
    "margin_without_impact",
    "overturning_amplitudes",
]


def growth_rate(stiffness: ArrayLike = 0.0, damping: ArrayLike = 0.0) -> Array:
    """Rate lambda of the growing part of the motion per tau [-]; nan from stiffness 1 on."""
    kappa, zeta = checked(stiffness=STIFFNESS.convert(stiffness), damping=DAMPING.convert(damping))
    left = np.where(kappa < 1.0, 1.0 - kappa, np.nan)
    return np.asarray(left / (np.sqrt(zeta * zeta + left) + zeta))  # sqrt(zeta^2 + 1 - kappa) - zeta, not cancelling


def equilibrium_rotation(stiffness: ArrayLike = 0.0, prestress: ArrayLike = 0.0) -> Array:
    """Unstable equilibrium y* = (1 + sigma)/(1 - kappa), over alpha [-]; infinite from stiffness 1 on."""
    kappa, sigma = checked(stiffness=STIFFNESS.convert(stiffness), prestress=PRESTRESS.convert(prestress))
    with np.errstate(divide="ignore"):
        return np.asarray(np.where(kappa < 1.0, (1.0 + sigma) / np.maximum(1.0 - kappa, 0.0), np.inf))


def direct_groups(
    amplitude: ArrayLike,
    frequency_ratio: ArrayLike,
    *,
    stiffness: ArrayLike = 0.0,
    prestress: ArrayLike = 0.0,
    damping: ArrayLike = 0.0,
) -> tuple[Array, Array]:
    """Amplitude a/(1 + sigma) and frequency ratio omega/lambda of the free block that overturns under the same pulses.

    That is without impact: a abs(integral of f exp(-lambda (tau - tau0))) >= (1 + sigma)/lambda from uplift tau0 on is
    the condition of this free block, with lambda tau in place of tau.
    """
    sigma = PRESTRESS.convert(prestress)
    a, omega = checked(amplitude=amplitude, frequency_ratio=ANY_FREQUENCY_RATIO.convert(frequency_ratio))
    return np.asarray(a / (1.0 + sigma)), np.asarray(omega / growth_rate(stiffness, damping))


def direct_amplitude(
    frequency_ratio: ArrayLike, *, stiffness: ArrayLike = 0.0, prestress: ArrayLike = 0.0, damping: ArrayLike = 0.0
) -> Array:
    """Smallest amplitude at which the block overturns without impact, the curve (3.10) of a restrained block.

    a [-]; infinite from stiffness 1 on. For example 2.591268 for omega = 2 and zeta = 0.1.
    """
    omega, rate = checked(frequency_ratio=frequency_ratio, rate=growth_rate(stiffness, damping))
    escapes = ~np.isnan(rate)
    free = case_2_amplitude(np.where(escapes, omega / np.where(escapes, rate, 1.0), 1.0))
    return np.asarray((1.0 + PRESTRESS.convert(prestress)) * np.where(escapes, free, np.inf))


def margin_without_impact(
    pulse: str | AbstractPulse,
    amplitude: float,
    frequency_ratio: float,
    *,
    stiffness: float = 0.0,
    prestress: float = 0.0,
    damping: float = 0.0,
) -> float:
    """Margin of overturning without impact under any pulse, as `rocking.paper.margin_without_impact`.

    -1 if there is no uplift, and from stiffness 1 on.
    """
    a, omega = direct_groups(amplitude, frequency_ratio, stiffness=stiffness, prestress=prestress, damping=damping)
    if math.isnan(omega):
        return -1.0
    return any_pulse.margin_without_impact(pulse, float(a), float(omega))


def margin_after_impact(
    pulse: str | AbstractPulse,
    amplitude: float,
    frequency_ratio: float,
    restitution: float,
    impact_phase: float,
    impact_velocity: float,
    *,
    stiffness: float = 0.0,
    prestress: float = 0.0,
    damping: float = 0.0,
) -> float:
    """Margin of overturning after the last impact within any pulse, as `rocking.paper.margin_after_impact`.

    `impact_phase` is phi of the impact [rad], `impact_velocity` is dy/dtau just before it, with its sign [-]. -1 from
    stiffness 1 on.
    """
    a, omega = direct_groups(amplitude, frequency_ratio, stiffness=stiffness, prestress=prestress, damping=damping)
    if math.isnan(omega):
        return -1.0
    velocity = impact_velocity * float(growth_rate(stiffness, damping)) / (1.0 + prestress)
    return any_pulse.margin_after_impact(pulse, float(a), float(omega), restitution, impact_phase, velocity)


class _Arc(NamedTuple):
    """First flight under a full sine in the groups without tendon: z = -y obeys z'' + 2 zeta z' - z + 1 = a sin.

    z = 1 + a P + A exp(lambda tau) + B exp(-nu tau) with nu = 1/lambda and P = Im(G exp(i phi)), all but 1 times
    1/a = sin(psi). `Q` is dP/dphi.
    """

    psi: Array
    omega: Array
    zeta: Array
    A: Array
    B: Array

    @property
    def rates(self) -> tuple[Array, Array]:
        """Lambda and nu."""
        nu = np.sqrt(1.0 + self.zeta * self.zeta) + self.zeta
        return np.asarray(1.0 / nu), np.asarray(nu)

    @property
    def end(self) -> Array:
        """Time from uplift to the end of the pulse."""
        return np.asarray((2.0 * np.pi - self.psi) / self.omega)

    def forced(self, tau: Array) -> tuple[Array, Array]:
        """P and Q."""
        return _forced(self.psi + self.omega * tau, self.omega, self.zeta)

    def scaled_rotation(self, tau: Array) -> Array:
        """z sin(psi) exp(-lambda tau)."""
        rate, fall = self.rates
        P, _ = self.forced(tau)
        return np.asarray(self.A + (np.sin(self.psi) + P) * np.exp(-rate * tau) + self.B * np.exp(-(rate + fall) * tau))


def _forced(phi: Array, omega: Array, zeta: Array) -> tuple[Array, Array]:
    """P and Q of `_Arc`, with G = 1/(2 i zeta omega - 1 - omega^2)."""
    inertia, drag = 1.0 + omega * omega, 2.0 * zeta * omega
    square = inertia * inertia + drag * drag
    sine, cosine = np.sin(phi), np.cos(phi)
    return np.asarray(-(inertia * sine + drag * cosine) / square), np.asarray((drag * sine - inertia * cosine) / square)


def _arc(psi: Array, omega: Array, zeta: Array) -> _Arc:
    """The arc that starts from rest at the phase psi, where z = z' = 0."""
    nu = np.sqrt(1.0 + zeta * zeta) + zeta
    P, Q = _forced(psi, omega, zeta)
    A = -(nu * (np.sin(psi) + P) + omega * Q) / (1.0 / nu + nu)
    return _Arc(psi, omega, zeta, np.asarray(A), np.asarray(-np.sin(psi) - P - A))


def _rotation_at_end(psi: Array, omega: Array, zeta: Array) -> Array:
    arc = _arc(psi, omega, zeta)
    return arc.scaled_rotation(arc.end)


def _rotation_at(tau: Array, psi: Array, omega: Array, zeta: Array) -> Array:
    return _arc(psi, omega, zeta).scaled_rotation(tau)


def _free_rotation(tau: Array, A: Array, B: Array, start: Array, rate: Array, fall: Array) -> Array:
    """z exp(-lambda tau) after the pulse, which ends at `start`."""
    return np.asarray(A + np.exp(-rate * tau) * (1.0 + B * np.exp(-fall * (tau - start))))


def _margin(psi: Array, omega: Array, zeta: Array, eta: Array) -> Array:
    """lambda (eta |v| - a integral) - 1 at the first impact, within the pulse or after it; nan if there is none.

    In the flight z'' + 2 zeta z' - z > 0 while the phase is in (psi, pi - psi), so that no impact takes place, and < 0
    from then on: a zero is the only one, and within the pulse if and only if z < 0 at its end.
    """
    arc = _arc(psi, omega, zeta)
    rate, fall = arc.rates
    end, a = arc.end, 1.0 / np.sin(psi)
    first = np.maximum((np.pi - 2.0 * psi) / omega, 1e-3 * end)
    inside = find_root(_rotation_at, first, end, psi, omega, zeta)
    P, Q = arc.forced(inside)
    # at z = 0 the growing exponential is eliminated: no overflow
    decayed = arc.B * a * np.exp(-fall * inside)
    speed = rate * (1.0 + a * P) + (rate + fall) * decayed - a * omega * Q
    phi = psi + omega * inside
    forced = rate * np.sin(phi) + omega * np.cos(phi) - omega * np.exp(-rate * (end - inside))
    during = rate * (eta * speed - a * forced / (rate * rate + omega * omega)) - 1.0
    # after the pulse: z = 1 + A exp(lambda tau) + B exp(-nu (tau - end))
    P, Q = arc.forced(end)
    B = a * (arc.B * np.exp(-fall * end) + (rate * P - omega * Q) / (rate + fall))
    A = a * (arc.A + np.exp(-rate * end) * (fall * P + omega * Q) / (rate + fall))
    with np.errstate(divide="ignore", invalid="ignore"):
        last = np.log((1.0 + np.abs(B)) / -A) / rate
    later = find_root(_free_rotation, end, np.maximum(last, end), A, B, end, rate, fall)
    after = rate * eta * (rate + (rate + fall) * B * np.exp(-fall * (later - end))) - 1.0
    return np.asarray(np.where(np.isnan(inside), after, during))


def _reduced(
    frequency_ratio: ArrayLike, stiffness: ArrayLike, prestress: ArrayLike, damping: ArrayLike
) -> tuple[Array, Array, Array]:
    """Omega and zeta of the block without tendon, nan from stiffness 1 on; the factor 1 + sigma of its amplitude."""
    kappa, sigma = STIFFNESS.convert(stiffness), PRESTRESS.convert(prestress)
    zeta = DAMPING.convert(damping)
    omega = ANY_FREQUENCY_RATIO.convert(frequency_ratio)
    root = np.sqrt(np.where(kappa < 1.0, 1.0 - kappa, np.nan))
    reduced, damped, factor = checked(omega=omega / root, zeta=zeta / root, factor=1.0 + sigma)
    return reduced, damped, factor


def limit_amplitude(
    frequency_ratio: ArrayLike, *, stiffness: ArrayLike = 0.0, prestress: ArrayLike = 0.0, damping: ArrayLike = 0.0
) -> Array:
    """Amplitude at which the first impact coincides with the end of the pulse, the limit (3.31) of a restrained block.

    a [-]: below it the first impact takes place within the pulse.
    """
    omega, zeta, factor = _reduced(frequency_ratio, stiffness, prestress, damping)
    psi = find_root(_rotation_at_end, np.zeros_like(omega), np.full_like(omega, np.pi / 2), omega, zeta)
    return np.asarray(factor / np.sin(psi))


def margin_after_one_impact(
    amplitude: ArrayLike,
    frequency_ratio: ArrayLike,
    restitution: ArrayLike,
    *,
    stiffness: ArrayLike = 0.0,
    prestress: ArrayLike = 0.0,
    damping: ArrayLike = 0.0,
) -> Array:
    """Margin of overturning after the first impact, within the pulse or after it [-]; positive where it overturns.

    lambda/(1 + sigma) (eta abs(y') - a integral of f exp(-lambda (tau - tau1))) - 1 with y' just before the impact;
    (3.20) and (3.17) of a restrained block. nan where there is no impact.
    """
    omega, zeta, factor = _reduced(frequency_ratio, stiffness, prestress, damping)
    a, eta = checked(amplitude=amplitude, restitution=restitution)
    a, omega, zeta, eta = np.broadcast_arrays(AMPLITUDE.convert(a / factor), omega, zeta, eta)
    return _margin(np.arctan2(1.0, np.sqrt((a - 1.0) * (a + 1.0))), omega, zeta, eta)


def overturning_amplitudes(
    frequency_ratio: ArrayLike,
    restitution: ArrayLike,
    *,
    stiffness: ArrayLike = 0.0,
    prestress: ArrayLike = 0.0,
    damping: ArrayLike = 0.0,
) -> OverturningAmplitudes:
    """Overturning thresholds under one full sine, as `rocking.paper.overturning_amplitudes`.

    Between `overturns_from` and `survives_again` the block overturns after one impact; both are nan where it does not.
    Regions of several impacts are not contained.

    Examples
    --------
    >>> [round(float(a), 4) for a in overturning_amplitudes(3.0, 0.9, stiffness=0.3, prestress=0.2)]
    [1.9074, 5.1187, 5.4404]
    """
    omega, zeta, factor = _reduced(frequency_ratio, stiffness, prestress, damping)
    (eta,) = checked(restitution=restitution)
    omega, zeta, factor, eta = np.broadcast_arrays(omega, zeta, factor, eta)
    direct = direct_amplitude(frequency_ratio, stiffness=stiffness, prestress=prestress, damping=damping)
    # from the curve without impact on, where psi is smallest, to the amplitude of uplift
    start = np.arcsin(factor / np.where(np.isinf(direct), np.nan, direct)) * (1.0 + 1e-12)
    end = np.full_like(omega, np.pi / 2 * (1.0 - 1e-9))
    top = find_maximum(_margin, start, end, omega, zeta, eta)
    overturns = _margin(top, omega, zeta, eta) > 0.0
    again, lower = (
        np.where(overturns, factor / np.sin(find_root(_margin, low, high, omega, zeta, eta)), np.nan)
        for low, high in ((start, top), (top, end))
    )
    return OverturningAmplitudes(lower, again, np.broadcast_to(direct, lower.shape).copy())
