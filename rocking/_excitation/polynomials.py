"""Approximation of a smooth function by polynomials on consecutive pieces, accurate to rounding.

A piece is halved until the terms beyond the degree `DEGREE` of its Chebyshev series are as small as the rounding of the
function. The coefficients then decay by about ten from one to the next, so that those of the powers of x in [-1, 1],
and their shift to any point of the piece, lose no digits.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.polynomial import chebyshev, polynomial

from rocking._base.arrays import Array
from rocking._base.errors import InvalidArgumentError, float_array
from rocking._excitation.stationary import sign_changes

DEGREE = 15  # degree of the polynomials, below that of the Taylor steps, which therefore expand them exactly
MAX_POLYNOMIALS = 128  # most pieces: about 40 periods of a modulated sine
SHORTEST = 1e-9  # length of a piece over the window at which the function is not smooth

ROUNDING = 4.0 * float(np.finfo(np.float64).eps)
"""Error allowed relative to max |f| + max |phi f'|, which is the rounding of the value and of the phase."""

WIGGLE = 64.0 * float(np.finfo(np.float64).eps)
"""Change of f over max |f| that is rounding: extremes that differ by less do not count."""

_NODES = chebyshev.chebpts1(2 * (DEGREE + 1))
_POINTS = np.concatenate([_NODES, chebyshev.chebpts2(2 * DEGREE + 5)])  # points of the fit, then those that test it

_SPECTRUM = chebyshev.chebvander(_NODES, _NODES.size - 1).T * (2.0 / _NODES.size)
_SPECTRUM[0] *= 0.5  # from values at the nodes to coefficients of the Chebyshev series

Curve = Callable[[Array], Array]


@dataclass(frozen=True, eq=False)
class Polynomials:
    """Polynomials in x on consecutive pieces, x from -1 to 1 on each."""

    ends: Array  # (pieces + 1,) phases at which the pieces start, and the end of the last [rad], ascending
    coefficients: Array  # (pieces, `DEGREE` + 1) of 1, x, x^2, ... [-]

    @property
    def middles(self) -> Array:
        """Phases in the middle of the pieces [rad]."""
        return 0.5 * (self.ends[:-1] + self.ends[1:])

    @property
    def halves(self) -> Array:
        """Half the lengths of the pieces [rad]."""
        return 0.5 * np.diff(self.ends)

    def __call__(self, phi: Array) -> Array:
        """Evaluate the function at phases within the window."""
        piece = np.maximum(np.searchsorted(self.ends[:-1], phi, side="right") - 1, 0)
        return _evaluate(self.coefficients[piece], (phi - self.middles[piece]) / self.halves[piece])

    def times(self, factor: float) -> Polynomials:
        """Multiply the function by a factor."""
        return Polynomials(self.ends, self.coefficients * factor)

    def turning_phases(self) -> tuple[float, ...]:
        """Search the phases strictly inside the window at which the slope changes its sign [rad], but for rounding."""
        count = len(self.coefficients)
        parts = 1 << (count - 1).bit_length()
        positions = np.array(sign_changes(self._normalised_slope(), 1.0, 1.0, 0.0, float(parts), parts))
        phases = np.sort(
            np.append(self.ends, np.interp(positions[positions < count], np.arange(count + 1.0), self.ends))
        )
        values = self(phases)
        return tuple(phases[turning_points(values, WIGGLE * float(np.abs(values).max()))].tolist())

    def _normalised_slope(self) -> Callable[[Array], tuple[Array, Array]]:
        """Return the slope at i + (x + 1)/2 on piece i, over a bound of its second derivative, and its derivative.

        1 where the function is constant but for rounding, and beyond the last piece.
        """
        slope, curvature, third = self._derivative(1), self._derivative(2), self._derivative(3)
        largest = np.abs(slope).sum(axis=1)
        bound = np.maximum(np.abs(third).sum(axis=1), largest)
        constant = largest <= WIGGLE * np.abs(self.coefficients).max()
        bound[constant], slope[constant], curvature[constant], slope[constant, 0] = 1.0, 0.0, 0.0, 1.0

        def evaluate(position: Array) -> tuple[Array, Array]:
            piece = np.minimum(position.astype(np.int64), len(bound) - 1)
            x, beyond = 2.0 * (position - piece) - 1.0, position >= len(bound)
            value, change = _evaluate(slope[piece], x) / bound[piece], _evaluate(curvature[piece], x) / bound[piece]
            return np.where(beyond, 1.0, value), np.where(beyond, 0.0, change)

        return evaluate

    def _derivative(self, order: int) -> Array:
        """Return the coefficients of a derivative by the position on the piece."""
        return np.asarray(polynomial.polyder(self.coefficients, order, axis=1) * 2.0**order, np.float64)


def _evaluate(coefficients: Array, x: Array) -> Array:
    """Evaluate polynomials (n, degree + 1) at x (n,)."""
    return np.asarray(polynomial.polyval(x, coefficients.T, tensor=False))


def turning_points(values: Array, tolerance: float) -> list[int]:
    """Return the indices at which a sequence turns, of changes by more than `tolerance` only."""
    turns: list[int] = []
    extreme, lowest, highest, direction = 0, 0, 0, 0.0
    for i, value in enumerate(values):
        if direction == 0.0:
            if value < values[lowest]:
                lowest = i
            if value > values[highest]:
                highest = i
            if values[highest] - values[lowest] > tolerance:
                direction, extreme = (1.0 if highest > lowest else -1.0), i
        elif (value - values[extreme]) * direction >= 0.0:
            extreme = i
        elif (values[extreme] - value) * direction > tolerance:
            turns.append(extreme)
            direction, extreme = -direction, i
    return turns


def fit_polynomials(curve: Curve, start: float, end: float) -> Polynomials:
    """Fit polynomials that equal `curve` between two phases [rad] to rounding.

    `curve`: from phases (n,) to as many numbers; `start`, `end`: window [rad], start < end. Raises
    `InvalidArgumentError` if `curve` gives anything else, only zeros, or more than `MAX_POLYNOMIALS` pieces are needed.
    """
    values = partial(_checked_values, curve)
    scale = float(np.abs(values(np.linspace(start, end, 1025))).max())
    if not scale > 0.0:
        raise InvalidArgumentError("curve", "0 on the whole window", "a function that is not zero")
    starts, table, waiting = [], [], [(start, end)]
    while waiting:
        left, right = waiting.pop()
        coefficients = _fit(values, left, right, scale)
        if coefficients is not None:
            starts.append(left)
            table.append(coefficients)
            continue
        if right - left < SHORTEST * (end - start) or len(table) + len(waiting) + 2 > MAX_POLYNOMIALS:
            raise InvalidArgumentError(
                "curve",
                f"not resolved near phi = {left:.6g} rad",
                f"a function that is smooth, and equal to at most {MAX_POLYNOMIALS} polynomials of degree {DEGREE}; "
                "jumps and kinks are for rocking.SampledPulse",
            )
        middle = 0.5 * (left + right)
        waiting += [(middle, right), (left, middle)]
    return Polynomials(np.array([*starts, end]), np.array(table))


def _fit(values: Curve, left: float, right: float, scale: float) -> Array | None:
    """Fit the coefficients of 1, x, x^2, ... on an interval; None if no polynomial is accurate."""
    middle, half = 0.5 * (left + right), 0.5 * (right - left)
    phases = np.clip(middle + half * _POINTS, left, right)
    targets, x = values(phases), (phases - middle) / half  # x of the rounded phases
    spectrum = np.abs(_SPECTRUM @ targets[: _NODES.size])
    left_out, noise = spectrum[DEGREE + 1 : DEGREE + 9].max(), spectrum[DEGREE + 9 :].max()
    if left_out > max(4.0 * noise, 0.125 * ROUNDING * scale):
        return None
    coefficients = np.zeros(DEGREE + 1)
    for _ in range(2):
        residual = (targets - polynomial.polyval(x, coefficients))[: _NODES.size]
        powers = chebyshev.cheb2poly((_SPECTRUM @ residual)[: DEGREE + 1])
        coefficients[: powers.size] += powers
    slope = np.abs(polynomial.polyval(x, polynomial.polyder(coefficients))).max() / half
    allowed = ROUNDING * (scale + slope * max(abs(left), abs(right)))
    error = np.abs(targets - polynomial.polyval(x, coefficients)).max()
    return coefficients if error <= allowed else None


def _checked_values(curve: Curve, phi: Array) -> Array:
    values = float_array("curve", curve(phi))
    if values.shape != phi.shape:
        raise InvalidArgumentError("curve", f"shape {values.shape}", f"one number for each of {phi.size} phases")
    wrong = np.flatnonzero(~np.isfinite(values))
    if wrong.size:
        where = phi[wrong[0]]
        raise InvalidArgumentError("curve", f"{values[wrong[0]]} at phi = {where:.6g} rad", "finite numbers")
    return values
