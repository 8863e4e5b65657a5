"""A value at which the outcome changes, and its text.

It is rounded so that no range in which the block overturns is shown as one that it survives.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from decimal import ROUND_CEILING, ROUND_FLOOR, Context

from rocking._boundary.scan import RELATIVE_ERROR  # that of elastic blocks under pulses, too

MARGIN = 0.05
"""Relative distance of a change of outcome below which a warning is given [-]: ground motions are not known better."""

DIGITS = 6  # significant digits of a threshold in texts [-]

MAX_LISTED = 4  # changes of outcome that a warning lists; of more, it states the number and both ends


@dataclass(frozen=True)
class Threshold:
    """A value at which the outcome changes."""

    value: float  # peak acceleration [m/s2], period [s], half-diagonal [m], or factor of a record [-]
    overturns_above: bool  # true: the block overturns just above and survives just below; False: the reverse

    def __str__(self) -> str:
        """The outcome above the value in words, such as `overturns above 4.70006`."""
        return f"{'overturns' if self.overturns_above else 'survives'} above {self.text()}"

    def text(self, digits: int = DIGITS) -> str:
        """The value with some significant digits, 1 to 15, on the safe side of itself and of its error."""
        return threshold_text(self.value, digits, overturns_above=self.overturns_above)


def threshold_text(value: float, digits: int = DIGITS, *, overturns_above: bool = True) -> str:
    """A threshold > 0 as text: rounded down if the block overturns above it, rounded up if it survives there."""
    error, rounding = (-RELATIVE_ERROR, ROUND_FLOOR) if overturns_above else (RELATIVE_ERROR, ROUND_CEILING)
    rounded = Context(prec=digits, rounding=rounding).create_decimal_from_float(value * (1.0 + error))
    return f"{float(rounded):.{digits}g}"


def warnings_of_changes(given: float, changes: Iterable[Threshold], name: str, unit: str = "") -> list[str]:
    """A warning that the outcome changes close to the given value."""
    near = sorted((one for one in changes if abs(one.value / given - 1.0) < MARGIN), key=lambda one: one.value)
    if not near:
        return []
    places = f"at {', '.join(one.text() for one in near)}"
    if len(near) > MAX_LISTED:
        places = f"{len(near)} times, from {near[0].text()} to {near[-1].text()}"
    return [f"the outcome changes within {100 * MARGIN:g} % of this {name}: {places}{unit}"]
