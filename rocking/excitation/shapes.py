"""The protocol of an excitation, `AbstractPulse`, and its two families: sums of sinusoids and wavelets.

An excitation gives its shape f(phi), the phases that divide it into monotone intervals, and the coefficients by which
the solver expands f (`rocking.excitation.series`). Arguments are checked at construction.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial
from itertools import pairwise
from typing import final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rocking.errors import InvalidArgumentError, float_array, in_range, number
from rocking.excitation.series import ExcitationSeries, Family, Terms
from rocking.excitation.stationary import sign_changes

MAX_SINUSOIDS = 8
"""Most terms of a sum of sinusoids."""

MAX_POLYNOMIAL = 4
"""Most coefficients of a wavelet's polynomial."""

MAX_PIECES = 84
"""Most monotone pieces of a pulse: Mavroeidis & Papageorgiou with 20 cycles."""

MAX_MAGNITUDE = 1e6
"""Largest phase [rad], coefficient and frequency [-] of a pulse: beyond it the phase has fewer than six digits."""

PEAK_TOLERANCE = 1e-12
"""Largest difference of max |f| from 1 [-]."""

Array = NDArray[np.float64]


@dataclass(frozen=True)
class AbstractPulse(ABC):
    """A pulse shape f(phi), max |f| = 1, zero outside `start` <= phi <= `end` [rad].

    Attributes
    ----------
    name : str
        Not empty.
    start, end : float
        Window of the phase [rad], start < end, within +-`MAX_MAGNITUDE`.
    stationary : tuple of float
        All phases strictly inside the window at which f' changes its sign [rad], ascending; at most `MAX_PIECES` - 1.
        If empty, they are computed.

    Raises
    ------
    InvalidArgumentError
        If a value is out of range, `stationary` is incomplete, or max |f| is not 1 to within `PEAK_TOLERANCE`.
    """

    name: str
    start: float
    end: float
    stationary: tuple[float, ...]

    def __post_init__(self) -> None:
        self._check_window()
        start, end = self.start, self.end
        found = self._stationary_phases(start, end)
        given = _checked_numbers("stationary", self.stationary, unit="rad")
        if given and not (len(given) == len(found) and np.allclose(given, found, rtol=0.0, atol=1e-10 * (end - start))):
            raise InvalidArgumentError(
                "stationary", given, f"(), or all phases inside where f' changes its sign: {found}"
            )
        if len(found) >= MAX_PIECES:
            raise InvalidArgumentError("stationary", found, f"fewer than {MAX_PIECES} phases: a shorter window")
        object.__setattr__(self, "stationary", given or found)
        peak = peak_amplitude(self.shape, start, end, found)
        if not abs(peak - 1.0) <= PEAK_TOLERANCE:
            raise InvalidArgumentError("max |f|", peak, "1: divide the coefficients by it")

    def _check_window(self) -> None:
        """Check the name and the window, and make its ends numbers."""
        if not (self.name and isinstance(self.name, str)):
            raise InvalidArgumentError("name", self.name, "a string that is not empty")
        for name, value in zip(("start", "end"), _checked_window(self.start, self.end), strict=True):
            object.__setattr__(self, name, value)

    @abstractmethod
    def shape(self, phi: ArrayLike) -> Array:
        """f(phi) [-] on the window, its smooth continuation outside; `phi` [rad], any shape."""

    @abstractmethod
    def mirrored(self) -> AbstractPulse:
        """The pulse -f(phi)."""

    @property
    @abstractmethod
    def series(self) -> ExcitationSeries:
        """Family and coefficients by which the solver evaluates and expands f."""

    @abstractmethod
    def _stationary_phases(self, start: float, end: float) -> tuple[float, ...]:
        """The phases strictly inside the window at which f' changes its sign [rad]."""

    def acceleration(self, phi: ArrayLike) -> NDArray[np.float64]:
        """f(phi) [-], zero outside the window; `phi` [rad], any shape."""
        phi = float_array("phi", phi, unit="rad")
        return np.where((phi >= self.start) & (phi <= self.end), self.shape(np.clip(phi, self.start, self.end)), 0.0)

    @property
    def monotone_pieces(self) -> tuple[tuple[float, float], ...]:
        """Intervals of phi [rad] that cover the window, on each of which f is monotone."""
        ends = (self.start, *self.stationary, self.end)
        return tuple(pairwise(ends))


@final
@dataclass(frozen=True)
class SinusoidalPulse(AbstractPulse):
    """f(phi) = sum of c cos(w phi + d) over `terms`.

    Attributes
    ----------
    terms : tuple of (float, float, float)
        c [-], w >= 0 [-] and d [rad] of 1 to `MAX_SINUSOIDS` sinusoids, within +-`MAX_MAGNITUDE`.
    """

    terms: Terms

    @classmethod
    def of_unit_peak(cls, name: str, start: float, end: float, terms: Terms) -> SinusoidalPulse:
        """The sum of `terms` over its largest absolute value on the window; arguments and errors as for the class."""
        checked = _checked_terms(terms)
        turns = stationary_phases_of_sinusoids(checked, *_checked_window(start, end))
        peak = peak_amplitude(partial(sum_of_sinusoids, checked), start, end, turns)
        if not peak > 0.0:
            raise InvalidArgumentError("terms", terms, "a sum that is not zero on the whole window")
        return cls(name, start, end, (), tuple((c / peak, w, d) for c, w, d in checked))

    def __post_init__(self) -> None:
        object.__setattr__(self, "terms", _checked_terms(self.terms))
        super().__post_init__()

    def shape(self, phi: ArrayLike) -> Array:
        return sum_of_sinusoids(self.terms, phi)

    @cached_property
    def series(self) -> ExcitationSeries:
        return ExcitationSeries(Family.SINUSOIDS, self.terms)

    def mirrored(self) -> SinusoidalPulse:
        terms = tuple((-c, w, d) for c, w, d in self.terms)
        return SinusoidalPulse(mirrored_name(self.name), self.start, self.end, self.stationary, terms)

    def _stationary_phases(self, start: float, end: float) -> tuple[float, ...]:
        return stationary_phases_of_sinusoids(self.terms, start, end)


@final
@dataclass(frozen=True)
class WaveletPulse(AbstractPulse):
    """f(phi) = (sum of c_k phi^k) exp(-phi^2 / spread).

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
        polynomial = _checked_numbers("polynomial", self.polynomial)
        if not 1 <= len(polynomial) <= MAX_POLYNOMIAL:
            raise InvalidArgumentError("polynomial", polynomial, f"1 to {MAX_POLYNOMIAL} coefficients")
        spread = checked_number("spread", self.spread, low=1e-6, unit="rad2")
        object.__setattr__(self, "polynomial", polynomial)
        object.__setattr__(self, "spread", spread)
        super().__post_init__()

    def shape(self, phi: ArrayLike) -> Array:
        phi = float_array("phi", phi, unit="rad")
        return np.asarray(np.polynomial.polynomial.polyval(phi, self.polynomial) * np.exp(-phi * phi / self.spread))

    @cached_property
    def series(self) -> ExcitationSeries:
        return ExcitationSeries(Family.WAVELET, polynomial=self.polynomial, spread=self.spread)

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


def checked_number(parameter: str, value: ArrayLike, *, low: float = -MAX_MAGNITUDE, unit: str = "-") -> float:
    """A number from `low` to `MAX_MAGNITUDE`, checked."""
    return number(parameter, value, low, MAX_MAGNITUDE, unit=unit)


def _checked_window(start: ArrayLike, end: ArrayLike) -> tuple[float, float]:
    first, last = checked_number("start", start, unit="rad"), checked_number("end", end, unit="rad")
    in_range("end", last, first, MAX_MAGNITUDE, closed="right", unit="rad")
    return first, last


def _checked_terms(terms: Terms) -> Terms:
    array = in_range("terms", terms, -MAX_MAGNITUDE, MAX_MAGNITUDE)
    if array.ndim != 2 or not 1 <= len(array) <= MAX_SINUSOIDS or array.shape[1] != 3 or (array[:, 1] < 0.0).any():
        raise InvalidArgumentError("terms", terms, f"1 to {MAX_SINUSOIDS} triples (c, w, d) with w >= 0")
    return tuple((c, w, d) for c, w, d in array.tolist())


def _checked_numbers(parameter: str, values: ArrayLike, unit: str = "-") -> tuple[float, ...]:
    array = in_range(parameter, values, -MAX_MAGNITUDE, MAX_MAGNITUDE, unit=unit)
    if array.ndim != 1:
        raise InvalidArgumentError(parameter, values, "a sequence of numbers")
    return tuple(array.tolist())


def sum_of_sinusoids(terms: Terms, phi: ArrayLike) -> Array:
    """The sum of c cos(w phi + d) [-]; `phi` [rad], any shape."""
    phi = float_array("phi", phi, unit="rad")
    return np.asarray(sum(c * np.cos(w * phi + d) for c, w, d in terms))


def stationary_phases_of_sinusoids(terms: Terms, start: float, end: float) -> tuple[float, ...]:
    """The phases strictly inside the window at which the slope of a sum of sinusoids changes its sign [rad]."""
    c, w, d = np.array(terms).T

    def slope(phi: Array) -> tuple[Array, Array]:
        angle = np.multiply.outer(phi, w) + d
        return -np.sin(angle) @ (c * w), -np.cos(angle) @ (c * w * w)

    return sign_changes(slope, np.abs(c * w).sum(), np.abs(c * w**3).sum(), start, end)


def peak_amplitude(shape: Callable[[Array], Array], start: float, end: float, turns: tuple[float, ...]) -> float:
    """max |f| on the window [-]."""
    return float(np.max(np.abs(shape(np.array([start, *turns, end])))))


def mirrored_name(name: str) -> str:
    """The name of the mirrored pulse: with a leading minus, or without it."""
    return name.removeprefix("-") if name.startswith("-") else "-" + name
