"""Families of pulses of your own: any smooth function of the phase."""

from __future__ import annotations

import copy
import hashlib
from abc import abstractmethod
from dataclasses import dataclass, field
from typing import ClassVar, final

import numpy as np
from numpy.typing import ArrayLike

from rocking._base.arrays import Array
from rocking._base.errors import InvalidArgumentError, float_array
from rocking._excitation.polynomials import Polynomials, fit_polynomials
from rocking._excitation.series import ExcitationSeries, Family
from rocking._excitation.shapes import MAX_PIECES, AbstractPulse, mirrored_name, peak_amplitude


@final
@dataclass(frozen=True)
class PolynomialSeries(ExcitationSeries):
    """f is a polynomial on each of many pieces."""

    family: ClassVar[Family] = Family.POLYNOMIALS
    polynomials: Polynomials


@dataclass(frozen=True)
class SmoothPulse(AbstractPulse):
    """A pulse of any smooth shape, f = curve over its peak; a subclass gives `curve` as a function of phi.

    Responses are exact to rounding: the curve is represented by polynomials of degree 15 on at most 128 pieces of the
    window, as accurately as it can be evaluated. Parameters of the family are fields of the subclass.

    Attributes
    ----------
    name : str
        Not empty.
    start, end : float
        Window of the phase [rad], start < end, within +-1e6.
    stationary : tuple of float
        All phases strictly inside the window at which f' changes its sign [rad], found from the polynomials.
    peak : float
        largest absolute value of the curve on the window, negative for a mirrored pulse.
    digest : str
        sha256 of what the solver is given; pulses with another one differ.

    Raises
    ------
    InvalidArgumentError
        If a value is out of range, or the curve is not smooth: it has a jump, a kink or too many extremes.

    Examples
    --------
    >>> import numpy as np
    >>> from dataclasses import dataclass
    >>> @dataclass(frozen=True)
    ... class Decay(SmoothPulse):
    ...     rate: float
    ...
    ...     def curve(self, phi):
    ...         return np.exp(-self.rate * phi) * np.sin(phi)
    >>> Decay("decay", 0.0, 4.0 * np.pi, rate=0.1).acceleration([0.0, 4.5]).round(3).tolist()
    [0.0, -0.726]
    """

    stationary: tuple[float, ...] = field(init=False, repr=False, compare=False)
    peak: float = field(init=False, repr=False, compare=False)
    polynomials: Polynomials = field(init=False, repr=False, compare=False)
    digest: str = field(init=False, repr=False)

    @abstractmethod
    def curve(self, phi: Array) -> Array:
        """Evaluate the shape in any unit at phases within the window, float array (n,) [rad]; of the same shape."""

    def __post_init__(self) -> None:
        self._check_window()
        fitted = fit_polynomials(self.curve, self.start, self.end)
        turns = fitted.turning_phases()
        if len(turns) >= MAX_PIECES:
            raise InvalidArgumentError("curve", f"{len(turns)} extremes", f"fewer than {MAX_PIECES}: a shorter window")
        peak = peak_amplitude(self.curve, self.start, self.end, turns)
        self._set(stationary=turns, peak=peak, polynomials=fitted.times(1.0 / peak))

    def _set(self, *, polynomials: Polynomials, **values: object) -> None:
        numbers = np.append(polynomials.ends, polynomials.coefficients)
        digest = hashlib.sha256(numbers.astype("<f8").tobytes()).hexdigest()
        vars(self).update(values | {"polynomials": polynomials, "digest": digest})

    def shape(self, phi: ArrayLike) -> Array:
        return np.asarray(self.curve(float_array("phi", phi, unit="rad")) / self.peak)

    def mirrored(self) -> SmoothPulse:
        mirrored = copy.copy(self)
        mirrored._set(name=mirrored_name(self.name), peak=-self.peak, polynomials=self.polynomials.times(-1.0))
        return mirrored

    @property
    def series(self) -> PolynomialSeries:
        return PolynomialSeries(self.polynomials)

    def _stationary_phases(self, start: float, end: float) -> tuple[float, ...]:
        del start, end
        return self.stationary
