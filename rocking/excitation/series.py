"""What the compiled solver needs to evaluate an excitation and to expand it in powers of time."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

Terms = tuple[tuple[float, float, float], ...]
"""Sinusoids c cos(w phi + d): c [-], w [-], d [rad]."""


class Family(IntEnum):
    """Families of f(phi) that the solver can expand; `rocking.solver.excitation` selects by them."""

    SINUSOIDS = 0
    """f = sum of c cos(w phi + d)."""
    WAVELET = 1
    """f = (sum of c_k phi^k) exp(-phi^2/spread)."""


@dataclass(frozen=True)
class ExcitationSeries:
    """Family and coefficients of an excitation.

    Attributes
    ----------
    family : Family
        Which expansion.
    terms : Terms
        Of a sum of sinusoids; a wavelet has one of amplitude 0, so that the loops over the terms need no other case.
    polynomial : tuple of float
        Coefficients c_k of a wavelet [-].
    spread : float
        Of the Gaussian of a wavelet [rad2].
    """

    family: Family
    terms: Terms = ((0.0, 1.0, 0.0),)
    polynomial: tuple[float, ...] = ()
    spread: float = 0.0

    @property
    def has_exact_arcs(self) -> bool:
        """Whether the slender block (3.1) has exact arcs (3.4) under it."""
        return self.family == Family.SINUSOIDS
