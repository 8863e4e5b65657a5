"""Sums of sinusoids: the slender block has exact arcs (3.4) under them at all frequencies."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, partial
from typing import ClassVar, final

import numpy as np
from numpy.typing import ArrayLike

from rocking._base.arrays import Array
from rocking._base.errors import InvalidArgumentError, float_array, in_range
from rocking._excitation.series import ExcitationSeries, Family
from rocking._excitation.shapes import MAX_MAGNITUDE, AbstractPulse, checked_window, mirrored_name, peak_amplitude
from rocking._excitation.stationary import sign_changes

MAX_SINUSOIDS = 8  # most terms of a sum of sinusoids

Terms = tuple[tuple[float, float, float], ...]  # sinusoids c cos(w phi + d): c [-], w [-], d [rad]


@final
@dataclass(frozen=True)
class SinusoidSeries(ExcitationSeries):
    """f = sum of c cos(w phi + d) over `terms`."""

    family: ClassVar[Family] = Family.SINUSOIDS
    terms: Terms

    least_arc_frequency: ClassVar[float] = 0.0


@final
@dataclass(frozen=True)
class SinusoidalPulse(AbstractPulse):
    """A pulse that is a sum of sinusoids: f(phi) = sum of c cos(w phi + d) over `terms`.

    Attributes
    ----------
    terms : tuple of (float, float, float)
        c [-], w >= 0 [-] and d [rad] of 1 to `MAX_SINUSOIDS` sinusoids, within +-`MAX_MAGNITUDE`.
    """

    terms: Terms

    @classmethod
    def of_unit_peak(cls, name: str, start: float, end: float, terms: Terms) -> SinusoidalPulse:
        """Divide the sum of `terms` by its largest absolute value on the window; arguments, errors as for the class."""
        checked = _checked_terms(terms)
        turns = stationary_phases_of_sinusoids(checked, *checked_window(start, end))
        peak = peak_amplitude(partial(sum_of_sinusoids, checked), start, end, turns)
        if not peak > 0.0:
            raise InvalidArgumentError("terms", terms, "a sum that is not zero on the whole window")
        return cls(name, start, end, (), tuple((c / peak, w, d) for c, w, d in checked))

    def __post_init__(self) -> None:
        vars(self)["terms"] = _checked_terms(self.terms)
        super().__post_init__()

    def shape(self, phi: ArrayLike) -> Array:
        return sum_of_sinusoids(self.terms, phi)

    @cached_property
    def series(self) -> SinusoidSeries:
        return SinusoidSeries(self.terms)

    def mirrored(self) -> SinusoidalPulse:
        terms = tuple((-c, w, d) for c, w, d in self.terms)
        return SinusoidalPulse(mirrored_name(self.name), self.start, self.end, self.stationary, terms)

    def _stationary_phases(self, start: float, end: float) -> tuple[float, ...]:
        return stationary_phases_of_sinusoids(self.terms, start, end)


def _checked_terms(terms: Terms) -> Terms:
    array = in_range("terms", terms, -MAX_MAGNITUDE, MAX_MAGNITUDE)
    if array.ndim != 2 or not 1 <= len(array) <= MAX_SINUSOIDS or array.shape[1] != 3 or (array[:, 1] < 0.0).any():
        raise InvalidArgumentError("terms", terms, f"1 to {MAX_SINUSOIDS} triples (c, w, d) with w >= 0")
    return tuple((c, w, d) for c, w, d in array.tolist())


def sum_of_sinusoids(terms: Terms, phi: ArrayLike) -> Array:
    """Return the sum of c cos(w phi + d) [-]; `phi` [rad], any shape."""
    phi = float_array("phi", phi, unit="rad")
    total = np.zeros(phi.shape)
    for c, w, d in terms:
        total += c * np.cos(w * phi + d)
    return total


def stationary_phases_of_sinusoids(terms: Terms, start: float, end: float) -> tuple[float, ...]:
    """Return the phases strictly inside the window at which the slope of a sum of sinusoids changes its sign [rad]."""
    c, w, d = np.array(terms).T

    def slope(phi: Array) -> tuple[Array, Array]:
        angle = np.multiply.outer(phi, w) + d
        return -np.sin(angle) @ (c * w), -np.cos(angle) @ (c * w * w)

    return sign_changes(slope, np.abs(c * w).sum(), np.abs(c * w**3).sum(), start, end)
