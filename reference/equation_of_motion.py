"""Taylor series and energy of the rocking block in multi-precision arithmetic, slender (3.1) and rigid (2.2).

With z = |theta|/alpha and s the sign of theta, u = a f the ground acceleration over g tan(alpha), and ' = d/d tau:

    slender   z'' = -(1 - z) - s u
    rigid     z'' = -sin(alpha (1 - z))/alpha - s u (tan(alpha)/alpha) cos(alpha (1 - z))

The series also hold for a flight about an edge of another angle alpha_s = r alpha, with r - z for 1 - z, and under a
vertical ground acceleration, with V = 1 + (vertical acceleration)/g as a factor of the first term. A frequency
parameter p_s other than p, the unit of tau, is a factor (p_s/p)^2 of the square of the step.
"""

from __future__ import annotations

from operator import mul
from typing import NamedTuple

from flint import arb

from reference.exact_pulses import ExactPulse


class Motion(NamedTuple):
    """The equation of motion of one block under one pulse; `alpha` None is the slender limit."""

    pulse: ExactPulse
    amplitude: arb
    frequency_ratio: arb
    alpha: arb | None

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
        if self.alpha is None:
            return slender_series(z, (v * step).mid(), square, forcing, at_crossing)
        return rigid_series(z, (v * step).mid(), square, forcing, self.alpha, at_crossing)

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
