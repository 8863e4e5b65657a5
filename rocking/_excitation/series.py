"""Coefficients by which the compiled solver evaluates an excitation and expands it in powers of time."""

import math
from abc import ABC
from enum import IntEnum
from typing import ClassVar


class Family(IntEnum):
    """Families of f(phi) that the solver distinguishes, in `rocking._solver.excitation` and its stages alone."""

    SINUSOIDS = 0
    """f = sum of c cos(w phi + d), `rocking._excitation.sinusoids`."""
    WAVELET = 1
    """f = (sum of c_k phi^k) exp(-phi^2/spread), `rocking._excitation.wavelets`."""
    SAMPLES = 2
    """f is linear between samples, `rocking._excitation.sampled`; solved by `rocking._solver.records`."""
    POLYNOMIALS = 3
    """f is a polynomial on each of many pieces, `rocking._excitation.smooth`."""


class ExcitationSeries(ABC):
    """Coefficients of an excitation; a family has a subclass with its own."""

    family: ClassVar[Family]

    @property
    def least_arc_frequency(self) -> float:
        """Frequency ratio omega [-] from which the slender block has exact arcs that lose no digits; inf: none."""
        return math.inf

    @property
    def has_exact_arcs(self) -> bool:
        """True if the slender block (3.1) has exact arcs (3.4) under it at all frequencies."""
        return self.least_arc_frequency == 0.0
