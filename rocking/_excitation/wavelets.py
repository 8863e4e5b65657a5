"""Wavelets, a polynomial times a Gaussian: the slender block has exact arcs but for low frequencies."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, final

import numpy as np
from numpy.typing import ArrayLike

from rocking._base.arrays import Array
from rocking._base.errors import InvalidArgumentError, float_array
from rocking._excitation.series import ExcitationSeries, Family
from rocking._excitation.shapes import AbstractPulse, checked_number, checked_numbers, mirrored_name
from rocking._excitation.stationary import sign_changes

MAX_POLYNOMIAL = 4  # most coefficients of a wavelet's polynomial
MAX_DECAY = 1.25  # largest sqrt(spread)/(2 omega) [-] at which the arcs under a wavelet are accurate to rounding


@final
@dataclass(frozen=True)
class WaveletSeries(ExcitationSeries):
    """f = (sum of c_k phi^k) exp(-phi^2/spread)."""

    family: ClassVar[Family] = Family.WAVELET
    polynomial: tuple[float, ...]  # coefficients c_k [-]
    spread: float  # of the Gaussian [rad2]

    @property
    def least_arc_frequency(self) -> float:
        """Arcs cancel like omega^-2 or omega^-3 below (`rocking._solver.stages.wavelets`)."""
        return math.sqrt(self.spread) / (2.0 * MAX_DECAY)

    @property
    def derivatives(self) -> tuple[float, ...]:
        """Coefficients h_k of f = sum of h_k d^k/dphi^k exp(-phi^2/spread), from h_0 to h_3 [rad^k]."""
        c0, c1, c2, c3 = (*self.polynomial, 0.0, 0.0, 0.0)[:4]
        half = 0.5 * self.spread
        h2, h3 = half * half * c2, -half * half * half * c3
        return c0 + h2 / half, 3.0 * h3 / half - half * c1, h2, h3

    def growth_rate(self, order: int) -> float:
        """Return the smallest r of 1/rad with |d^n f/dphi^n| <= r^n, n = `order`, by the inequality of Cramer.

        It is |d^n/dx^n exp(-x^2)| <= 1.0865 sqrt(2^n n!).
        """
        bound = 0.0
        for k, h in enumerate(self.derivatives):
            n = order + k
            bound += 1.0865 * abs(h) * (2.0 / self.spread) ** (0.5 * n) * math.sqrt(math.factorial(n))
        return float(bound ** (1.0 / order))


@final
@dataclass(frozen=True)
class WaveletPulse(AbstractPulse):
    """A wavelet, a polynomial times a Gaussian: f(phi) = (sum of c_k phi^k) exp(-phi^2 / spread).

    Attributes
    ----------
    polynomial : tuple of float
        c_0, c_1, ... [-], 1 to `MAX_POLYNOMIAL` of them, within +-`MAX_MAGNITUDE`.
    spread : float
        Of the Gaussian [rad2], [1e-6, `MAX_MAGNITUDE`].
    """

    polynomial: tuple[float, ...]
    spread: float

    def __post_init__(self) -> None:
        polynomial = checked_numbers("polynomial", self.polynomial)
        if not 1 <= len(polynomial) <= MAX_POLYNOMIAL:
            raise InvalidArgumentError("polynomial", polynomial, f"1 to {MAX_POLYNOMIAL} coefficients")
        spread = checked_number("spread", self.spread, low=1e-6, unit="rad2")
        vars(self).update(polynomial=polynomial, spread=spread)
        super().__post_init__()

    def shape(self, phi: ArrayLike) -> Array:
        phi = float_array("phi", phi, unit="rad")
        return np.asarray(np.polynomial.polynomial.polyval(phi, self.polynomial) * np.exp(-phi * phi / self.spread))

    @cached_property
    def series(self) -> WaveletSeries:
        return WaveletSeries(self.polynomial, self.spread)

    def mirrored(self) -> WaveletPulse:
        polynomial = tuple(-c for c in self.polynomial)
        return WaveletPulse(mirrored_name(self.name), self.start, self.end, self.stationary, polynomial, self.spread)

    def _stationary_phases(self, start: float, end: float) -> tuple[float, ...]:
        # f' = (P' - 2 phi/spread P) exp(-phi^2/spread) has the sign of the polynomial
        shape = np.polynomial.Polynomial(self.polynomial)
        factor = shape.deriv() - shape * np.polynomial.Polynomial([0.0, 2.0 / self.spread])
        bound = np.polynomial.Polynomial(np.abs(factor.coef))
        farthest, slope = max(abs(start), abs(end)), factor.deriv()
        return sign_changes(
            lambda phi: (factor(phi), slope(phi)), bound(farthest), bound.deriv(2)(farthest), start, end
        )
