"""What the compiled solver needs to evaluate an excitation and to expand it in powers of time."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import IntEnum

from rocking.excitation.polynomials import Polynomials

Terms = tuple[tuple[float, float, float], ...]
"""Sinusoids c cos(w phi + d): c [-], w [-], d [rad]."""


MAX_WAVELET_DECAY = 1.25
"""Largest sqrt(spread)/(2 omega) [-] at which the arcs under a wavelet are accurate to rounding."""


class Family(IntEnum):
    """Families of f(phi) that the solver can expand; `rocking.solver.excitation` selects by them."""

    SINUSOIDS = 0
    """f = sum of c cos(w phi + d)."""
    WAVELET = 1
    """f = (sum of c_k phi^k) exp(-phi^2/spread)."""
    SAMPLES = 2
    """f is linear between samples, `rocking.excitation.sampled`; solved by `rocking.solver.records`."""
    POLYNOMIALS = 3
    """f is a polynomial on each of many pieces, `rocking.excitation.smooth`."""


@dataclass(frozen=True)
class ExcitationSeries:
    """Family and coefficients of an excitation.

    Attributes
    ----------
    family : Family
        Which expansion.
    terms : Terms
        Of a sum of sinusoids; others have one of amplitude 0, so that the loops over the terms need no other case.
    polynomial : tuple of float
        Coefficients c_k of a wavelet [-].
    spread : float
        Of the Gaussian of a wavelet [rad2].
    polynomials : Polynomials or None
        Of a smooth pulse.
    """

    family: Family
    terms: Terms = ((0.0, 1.0, 0.0),)
    polynomial: tuple[float, ...] = ()
    spread: float = 0.0
    polynomials: Polynomials | None = None

    @property
    def has_exact_arcs(self) -> bool:
        """Whether the slender block (3.1) has exact arcs (3.4) under it at all frequencies."""
        return self.family == Family.SINUSOIDS

    @property
    def least_arc_frequency(self) -> float:
        """Frequency ratio omega [-] from which the slender block has exact arcs that lose no digits.

        Arcs under wavelets cancel like omega^-2 or omega^-3 below (`rocking.solver.stages.wavelets`).
        """
        if self.family == Family.WAVELET:
            return math.sqrt(self.spread) / (2.0 * MAX_WAVELET_DECAY)
        return 0.0 if self.has_exact_arcs else math.inf

    @property
    def derivatives(self) -> tuple[float, ...]:
        """Coefficients h_k of a wavelet as f = sum of h_k d^k/dphi^k exp(-phi^2/spread), from h_0 to h_3 [rad^k]."""
        c0, c1, c2, c3 = (*self.polynomial, 0.0, 0.0, 0.0)[:4]
        half = 0.5 * self.spread
        h2, h3 = half * half * c2, -half * half * half * c3
        return c0 + h2 / half, 3.0 * h3 / half - half * c1, h2, h3

    def growth_rate(self, order: int) -> float:
        """The smallest r of 1/rad with |d^n f/dphi^n| <= r^n of a wavelet, n = `order`, by the inequality of Cramer.

        It is |d^n/dx^n exp(-x^2)| <= 1.0865 sqrt(2^n n!).
        """
        bound = 0.0
        for k, h in enumerate(self.derivatives):
            n = order + k
            bound += 1.0865 * abs(h) * (2.0 / self.spread) ** (0.5 * n) * math.sqrt(math.factorial(n))
        return float(bound ** (1.0 / order))
