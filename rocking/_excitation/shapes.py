"""The protocol of an excitation, `AbstractPulse`; each family of pulses is a module beside this one.

An excitation gives its shape f(phi), the phases that divide it into monotone intervals, and the coefficients by which
the solver expands f (`rocking._excitation.series`). Arguments are checked at construction.
"""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from rocking._base.arrays import Array
from rocking._base.errors import InvalidArgumentError, float_array, in_range, number
from rocking._base.quantities import FREQUENCY_RATIO, PEAK_ACCELERATION, PERIOD
from rocking._excitation.motion import AbstractMotion
from rocking._excitation.series import ExcitationSeries

MAX_PIECES = 84  # most monotone pieces of a pulse: Mavroeidis & Papageorgiou with 20 cycles

MAX_MAGNITUDE = 1e6
"""Largest phase [rad], coefficient and frequency [-] of a pulse: beyond it the phase has fewer than six digits."""

PEAK_TOLERANCE = 1e-12  # largest difference of max |f| from 1 [-]


@dataclass(frozen=True)
class AbstractPulse(AbstractMotion):
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

    kind = "pulse"
    strength = PEAK_ACCELERATION
    arguments = (PEAK_ACCELERATION, PERIOD)
    rate = FREQUENCY_RATIO
    highest_amplitude = 100.0
    is_scanned = False

    def __post_init__(self) -> None:
        self._check_window()
        start, end = self.start, self.end
        turns = self._stationary_phases(start, end)
        stationary = checked_numbers("stationary", self.stationary, unit="rad")
        if stationary:
            tolerance = 1e-10 * (end - start)
            if len(stationary) != len(turns) or not np.allclose(stationary, turns, rtol=0.0, atol=tolerance):
                allowed = f"(), or all phases inside where f' changes its sign: {turns}"
                raise InvalidArgumentError("stationary", stationary, allowed)
        if len(turns) >= MAX_PIECES:
            raise InvalidArgumentError("stationary", turns, f"fewer than {MAX_PIECES} phases: a shorter window")
        vars(self)["stationary"] = stationary or turns
        peak = peak_amplitude(self.shape, start, end, turns)
        if not abs(peak - 1.0) <= PEAK_TOLERANCE:
            raise InvalidArgumentError("max |f|", peak, "1: divide the coefficients by it")

    def _check_window(self) -> None:
        """Check the name and the window, and make its ends numbers."""
        if not (self.name and isinstance(self.name, str)):
            raise InvalidArgumentError("name", self.name, "a string that is not empty")
        vars(self).update(zip(("start", "end"), checked_window(self.start, self.end), strict=True))

    @property
    def unit_acceleration(self) -> float:
        """1 [m/s2]: the strength is the peak acceleration."""
        return 1.0

    def duration_at(self, period: Any) -> Any:
        """Duration [s]: of the half sine and the rectangular pulse half a period, of the sine a whole one."""
        return (self.end - self.start) / (2.0 * math.pi) * period

    def rate_at(self, frequency_parameter: Array, period: Array) -> Array:
        """Frequency ratio omega_g/p [-], checked."""
        return FREQUENCY_RATIO.convert(2.0 * math.pi / (period * frequency_parameter))

    @abstractmethod
    def shape(self, phi: ArrayLike) -> Array:
        """f(phi) [-] on the window, its smooth continuation outside; `phi` [rad], any shape."""

    @abstractmethod
    def mirrored(self) -> AbstractPulse:
        """Return the pulse -f(phi)."""

    @property
    @abstractmethod
    def series(self) -> ExcitationSeries:
        """Family and coefficients by which the solver evaluates and expands f."""

    @abstractmethod
    def _stationary_phases(self, start: float, end: float) -> tuple[float, ...]:
        """Return the phases strictly inside the window at which f' changes its sign [rad]."""

    def acceleration(self, phi: ArrayLike) -> Array:
        """f(phi) [-], zero outside the window; `phi` [rad], any shape."""
        phi = float_array("phi", phi, unit="rad")
        inside = (phi >= self.start) & (phi <= self.end)
        return np.where(inside, self.shape(np.clip(phi, self.start, self.end)), 0.0)

    @cached_property
    def samples(self) -> tuple[Array, Array] | None:
        """Phases [rad] and values of f between which it is linear, None if it is not given so."""
        return None

    @property
    def monotone_pieces(self) -> tuple[tuple[float, float], ...]:
        """Intervals of phi [rad] that cover the window, on each of which f is monotone."""
        ends = (self.start, *self.stationary, self.end)
        return tuple(pairwise(ends))


def checked_number(parameter: str, value: ArrayLike, *, low: float = -MAX_MAGNITUDE, unit: str = "-") -> float:
    """Return a number from `low` to `MAX_MAGNITUDE`, checked."""
    return number(parameter, value, low, MAX_MAGNITUDE, unit=unit)


def checked_window(start: ArrayLike, end: ArrayLike) -> tuple[float, float]:
    """Return the ends of a window [rad], checked."""
    first, last = checked_number("start", start, unit="rad"), checked_number("end", end, unit="rad")
    in_range("end", last, first, MAX_MAGNITUDE, closed="right", unit="rad")
    return first, last


def checked_numbers(parameter: str, values: ArrayLike, unit: str = "-") -> tuple[float, ...]:
    """Return numbers within +-`MAX_MAGNITUDE`, checked."""
    array = in_range(parameter, values, -MAX_MAGNITUDE, MAX_MAGNITUDE, unit=unit)
    if array.ndim != 1:
        raise InvalidArgumentError(parameter, values, "a sequence of numbers")
    return tuple(array.tolist())


def peak_amplitude(shape: Callable[[Array], Array], start: float, end: float, turns: tuple[float, ...]) -> float:
    """Return max |f| on the window [-]."""
    return float(np.max(np.abs(shape(np.array([start, *turns, end])))))


def mirrored_name(name: str) -> str:
    """Return the name of the mirrored pulse: with a leading minus, or without it."""
    return name.removeprefix("-") if name.startswith("-") else "-" + name
