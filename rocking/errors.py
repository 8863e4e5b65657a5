"""Errors with three parts: which argument, what it was, what is allowed.

Every public function checks its arguments here, so that the same wrong question gets the same answer in Python, on
the command line and over HTTP. Physical outcomes such as overturning are results and never raise.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any, NoReturn

import numpy as np
from numpy.typing import ArrayLike, NDArray


class InvalidArgumentError(ValueError):
    """A wrong question: names the argument, its value and what is allowed.

    Parameters
    ----------
    parameter : str
        Name of the argument, as the caller knows it.
    value : object
        The offending value.
    allowed : str
        What would be accepted, in words or as an interval.
    """

    def __init__(self, parameter: str, value: Any, allowed: str) -> None:
        self.parameter = parameter
        self.value = value
        self.allowed = allowed
        super().__init__(f"`{parameter}` = {value!r} is not allowed; allowed: {allowed}")

    def __reduce__(self) -> tuple[type[InvalidArgumentError], tuple[str, Any, str]]:
        return type(self), (self.parameter, self.value, self.allowed)


class DatasetError(RuntimeError):
    """A data set file is missing, damaged or of another schema; the message says which file and what to do."""


class OutsideCubeError(InvalidArgumentError, LookupError):
    """A cube was asked for a point that it cannot answer with a promise (outside its axes, or a mixed cell)."""


def in_range(
    parameter: str, value: ArrayLike, low: float, high: float, *, closed: str = "both", unit: str = "-"
) -> NDArray[np.float64]:
    """Return `value` as a float64 array (shape kept) after checking that all of it is finite and in the range.

    Parameters
    ----------
    parameter : str
        Name for the error message.
    value : array_like, any shape
    low, high : float
        Range; `high` may be infinite.
    closed : {"both", "left", "right", "neither"}
        Which ends belong to the range.
    unit : str
        Unit for the message.

    Raises
    ------
    InvalidArgumentError
        With the first offending entry.
    """
    try:
        array = np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError):
        reject_range(parameter, value, low, high, closed, unit)
    if array.size == 0:
        return array
    # two numbers instead of arrays of flags; nan if there is one
    least, most = (float(array), float(array)) if array.ndim == 0 else (float(array.min()), float(array.max()))
    if not (_within(least, low, high, closed) and _within(most, low, high, closed)):
        wrong = next(entry for entry in array.flat if not _within(float(entry), low, high, closed))
        reject_range(parameter, float(wrong), low, high, closed, unit)
    return array


def _within(value: float, low: float, high: float, closed: str) -> bool:
    above = value >= low if closed in ("both", "left") else value > low
    below = value <= high if closed in ("both", "right") else value < high
    return above and below and math.isfinite(value)


def reject_range(parameter: str, value: Any, low: float, high: float, closed: str, unit: str) -> NoReturn:
    """Raise `InvalidArgumentError` with the allowed range in words."""
    left = "[" if closed in ("both", "left") else "("
    right = "]" if closed in ("both", "right") and np.isfinite(high) else ")"
    raise InvalidArgumentError(parameter, value, f"{left}{low:g}, {high:g}{right} [{unit}]")


def one_of(parameter: str, value: str, choices: Iterable[str]) -> str:
    """Return `value` if it is among `choices`, else raise `InvalidArgumentError` listing them."""
    names = list(choices)
    if value not in names:
        raise InvalidArgumentError(parameter, value, "one of " + ", ".join(names))
    return value
