"""Taylor series and energy of the rocking block in multi-precision arithmetic, slender (3.1) and rigid (2.2).

With z = |theta|/alpha and s the sign of theta, u = a f the ground acceleration over g tan(alpha), and ' = d/d tau:

    slender   z'' = -(1 - z) - s u
    rigid     z'' = -sin(alpha (1 - z))/alpha - s u (tan(alpha)/alpha) cos(alpha (1 - z))

The series also hold for a flight about an edge of another angle alpha_s = r alpha, with r - z for 1 - z, and under a
vertical ground acceleration, with V = 1 + (vertical acceleration)/g as a factor of the first term. A frequency
parameter p_s other than p, the unit of tau, is a factor (p_s/p)^2 of the square of the step.

A restraint adds to z'', with kappa = k b^2/(m g R), sigma = P0/(m g) and zeta = (3/2) (b/R)^2 c/(m p),

    slender   -(sigma + kappa z) - 2 zeta z'
    rigid     -(sigma sin(alpha) + 2 kappa sin(alpha z/2)) cos(alpha z/2)/alpha - 2 zeta z'

These are the moments (P0 + 2 k b sin(|theta|/2)) b cos(|theta|/2) of a tendon along the centre line, of stiffness k and
prestress P0, whose lower end is fixed to the ground under the middle of the base: the chord 2 b sin(|theta|/2) is its
elongation. The moment 4 b^2 c theta' is that of a vertical damper c at the uplifting edge, for small rotations.
"""

from __future__ import annotations

from operator import mul
from typing import NamedTuple

from flint import arb

from reference.exact_pulses import ExactPulse


class Restraint(NamedTuple):
    """Tendon and damper of a block, in the groups of the module [-]."""

    stiffness: arb
    prestress: arb
    damping: arb


class Motion(NamedTuple):
    """The equation of motion of one block under one pulse; `alpha` None is the slender limit."""

    pulse: ExactPulse
    amplitude: arb
    frequency_ratio: arb
    alpha: arb | None
    restraint: Restraint | None = None

    @property
    def level(self) -> arb:
        """|u| at uplift [-]."""
        return ONE if self.restraint is None else 1 + self.restraint.prestress

    @property
    def duration(self) -> arb:
        """Length of the pulse in tau."""
        return (self.pulse.end - self.pulse.start) / self.frequency_ratio

    def ground(self, tau: arb) -> arb:
        """u = a f [-] at `tau` from the start of the pulse."""
        return self.amplitude * self.pulse.value(self.pulse.start + self.frequency_ratio * tau)

    def max_rate(self) -> float:
        """Inverse of the shortest time scale [-], a guide for the step."""
        rate = max(1.0, self.pulse.max_rate * float(self.frequency_ratio))
        if self.alpha is not None:
            rate = max(rate, float(self.amplitude * self.alpha.tan()) ** 0.5)
        if self.restraint is not None:
            rate = max(rate, float(self.restraint.stiffness) ** 0.5, 2.0 * float(self.restraint.damping))
        return rate

    def expand(self, tau: arb, z: arb, v: arb, side: int, step: arb, order: int, at_crossing: bool) -> list[arb]:
        """Coefficients of z(tau + step x) in powers of x, 0 to `order`.

        `at_crossing` says that the motion starts where |u| = 1: the acceleration is then zero without rounding.
        """
        phi = self.pulse.start + self.frequency_ratio * tau
        forcing = self.pulse.series(phi, self.frequency_ratio * step, order)
        factor = -side * self.amplitude
        forcing = [factor * f for f in forcing]
        square = (step * step).mid()
        slope = (v * step).mid()
        if self.restraint is not None:
            return restrained_series(z, slope, step, forcing, self.alpha, self.restraint, at_crossing)
        if self.alpha is None:
            return slender_series(z, slope, square, forcing, at_crossing)
        return rigid_series(z, slope, square, forcing, self.alpha, at_crossing)

    def barrier_excess(self, z: arb, v: arb) -> arb:
        """Return the growing part of free rocking relative to the barrier: > 0 overturns; z + z' - 1 if slender."""
        return v - self._distance(1 - z)

    def impact_speed(self, z: arb, v: arb) -> arb:
        """Return |z'| at z = 0 in free rocking from (z, z'), by energy."""
        return (v * v - self._distance(1 - z) ** 2 + self._distance(arb(1)) ** 2).sqrt()

    def turning_point(self, z: arb, v: arb) -> arb:
        """Return the largest z of free rocking from (z, z') that does not pass the barrier, by energy."""
        depth = (self._distance(1 - z) ** 2 - v * v).sqrt()
        if self.alpha is None:
            return 1 - depth
        return 1 - 2 * (self.alpha * depth / 2).asin() / self.alpha

    def barrier_speed(self) -> arb:
        """Return the z' at z = 0 that just reaches the barrier; 1 if slender."""
        return self._distance(arb(1))

    def _distance(self, below: arb) -> arb:
        """sqrt(2 (potential at the barrier - potential)) with the sign of `below` = 1 - z."""
        if self.alpha is None:
            return below
        return 2 * (self.alpha * below / 2).sin() / self.alpha


ONE, ZERO = arb(1), arb(0)


def slender_series(
    z: arb,
    slope: arb,
    square: arb,
    forcing: list[arb],
    at_crossing: bool,
    ratio: arb = ONE,
    vertical: tuple[arb, arb] = (ONE, ZERO),
) -> list[arb]:
    """z_{k+2} (k+1)(k+2) = h^2 [V_0 z_k + V_1 z_{k-1} - (r V_k if k < 2) + push_k]."""
    series = [z, slope]
    for k, p in enumerate(forcing[:-1]):
        force = vertical[0] * series[k] + p
        if k > 0:
            force += vertical[1] * series[k - 1]
        if k < 2:
            force -= ratio * vertical[k]
        if k == 0 and at_crossing:
            force = arb(0)
        series.append((square * force / ((k + 1) * (k + 2))).mid())
    return series


def rigid_series(
    z: arb,
    slope: arb,
    square: arb,
    forcing: list[arb],
    alpha: arb,
    at_crossing: bool,
    ratio: arb = ONE,
    vertical: tuple[arb, arb] = (ONE, ZERO),
) -> list[arb]:
    """The same with S = sin(alpha (r - z))/alpha, C = cos(alpha (r - z)): S' = -C z', C' = alpha^2 S z'."""
    series = [z, slope]
    sine, cosine = (alpha * (ratio - z)).sin_cos()
    s, c = [(sine / alpha).mid()], [cosine.mid()]
    weighted = [slope]  # (j + 1) z_{j+1}
    scale, alpha2 = (alpha.tan() / alpha).mid(), (alpha * alpha).mid()
    forcing = [(scale * p).mid() for p in forcing]
    for k in range(len(forcing) - 1):
        force = sum(map(mul, forcing[: k + 1], c[::-1]), -vertical[0] * s[k])
        if k > 0:
            force -= vertical[1] * s[k - 1]
        if k == 0 and at_crossing:
            force = arb(0)
        series.append((square * force / ((k + 1) * (k + 2))).mid())
        backwards = weighted[::-1]
        s.append((-sum(map(mul, c, backwards), arb(0)) / (k + 1)).mid())
        c.append((alpha2 * sum(map(mul, s, backwards), arb(0)) / (k + 1)).mid())
        weighted.append((k + 2) * series[k + 2])
    return series


def restrained_series(
    z: arb, slope: arb, step: arb, forcing: list[arb], alpha: arb | None, restraint: Restraint, at_crossing: bool
) -> list[arb]:
    """The same with the restraint of the module, from the sines and cosines of alpha (1 - z) and of alpha z/2."""
    square, damping = (step * step).mid(), (2 * restraint.damping * step).mid()
    series, weighted = [z, slope], [slope]
    weight, tension = _MomentSeries(alpha, z), _TendonSeries(alpha, z, restraint)
    for k in range(len(forcing) - 1):
        force = weight.coefficient(k, forcing) - tension.coefficient(k)
        if k == 0 and at_crossing:
            force = arb(0)
        series.append(((square * force - damping * weighted[k]) / ((k + 1) * (k + 2))).mid())
        weighted.append((k + 2) * series[k + 2])
        weight.extend(k, weighted)
        tension.extend(k, weighted)
    return series


class _MomentSeries:
    """Moments of gravity and of the ground motion over I p^2 alpha, up to the sign."""

    def __init__(self, alpha: arb | None, z: arb) -> None:
        self.alpha = ONE if alpha is None else alpha
        self.slender = alpha is None
        sine, cosine = (self.alpha * (1 - z)).sin_cos()
        self.sine, self.cosine = ([1 - z], [ONE]) if self.slender else ([(sine / self.alpha).mid()], [cosine.mid()])
        self.scale = ONE if self.slender else (self.alpha.tan() / self.alpha).mid()

    def coefficient(self, k: int, forcing: list[arb]) -> arb:
        return self.scale * sum(map(mul, forcing[: k + 1], self.cosine[::-1]), ZERO) - self.sine[k]

    def extend(self, k: int, weighted: list[arb]) -> None:
        """S' = -C z' and C' = alpha^2 S z'; in the slender limit S = 1 - z and C = 1."""
        backwards = weighted[k::-1]
        falling = sum(map(mul, self.cosine, backwards), ZERO)
        rising = ZERO if self.slender else self.alpha**2 * sum(map(mul, self.sine, backwards), ZERO)
        self.sine.append((-falling / (k + 1)).mid())
        self.cosine.append((rising / (k + 1)).mid())


class _TendonSeries:
    """Moment of the tendon over I p^2 alpha."""

    def __init__(self, alpha: arb | None, z: arb, restraint: Restraint) -> None:
        self.slender, self.restraint = alpha is None, restraint
        self.half = ONE / 2 if alpha is None else alpha / 2
        sine, cosine = (self.half * z).sin_cos()
        self.sine, self.cosine = ([z / 2], [ONE]) if self.slender else ([(sine / self.half / 2).mid()], [cosine.mid()])
        self.prestress = restraint.prestress if alpha is None else restraint.prestress * alpha.sin() / alpha

    def coefficient(self, k: int) -> arb:
        """2 kappa sin(alpha z/2)/alpha is the elastic tension."""
        product = sum(map(mul, self.sine, self.cosine[::-1]), ZERO)
        return self.prestress * self.cosine[k] + 2 * self.restraint.stiffness * product

    def extend(self, k: int, weighted: list[arb]) -> None:
        """S = sin(alpha z/2)/alpha and C = cos(alpha z/2): S' = C z'/2, C' = -alpha^2 S z'/2."""
        backwards = weighted[k::-1]
        rising = sum(map(mul, self.cosine, backwards), ZERO) / 2
        falling = ZERO if self.slender else 2 * self.half**2 * sum(map(mul, self.sine, backwards), ZERO)
        self.sine.append((rising / (k + 1)).mid())
        self.cosine.append((-falling / (k + 1)).mid())
