"""Exceptions and argument checks. A message has three parts: which argument, its value, what is allowed.

Every public function checks its arguments with these functions, so that Python, the command line and the HTTP service
report the same errors. Physical outcomes such as overturning are results and raise nothing.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Hashable, Iterable, Mapping, Sequence
from decimal import Decimal
from numbers import Real
from typing import Any, NoReturn

import numpy as np
from numpy.typing import ArrayLike, NDArray

_MAX_FLOAT = sys.float_info.max


class InvalidArgumentError(ValueError):
    """An invalid argument: its name, its value and what is allowed.

    Parameters
    ----------
    parameter : str
        Name of the argument, as the caller knows it.
    value : object
        The offending value.
    allowed : str
        Accepted values, in words or as an interval.
    """

    def __init__(self, parameter: str, value: Any, allowed: str) -> None:
        self.parameter = parameter
        self.value = value
        self.allowed = allowed
        super().__init__(f"`{parameter}` = {value!r} is not allowed; allowed: {allowed}")

    def __reduce__(self) -> tuple[type[InvalidArgumentError], tuple[str, Any, str]]:
        return type(self), (self.parameter, self.value, self.allowed)


class SeveralArgumentsError(InvalidArgumentError):
    """Several invalid arguments; parameter, value and allowed are those of the first.

    Parameters
    ----------
    errors : sequence of InvalidArgumentError
        One for each, at least one.
    """

    def __init__(self, errors: Sequence[InvalidArgumentError]) -> None:
        super().__init__(errors[0].parameter, errors[0].value, errors[0].allowed)
        self.errors = list(errors)
        self.args = ("; ".join(map(str, errors)),)

    def __reduce__(self) -> tuple[type[SeveralArgumentsError], tuple[Any, ...]]:
        return type(self), (self.errors,)


class DatasetError(RuntimeError):
    """A data set file is missing, damaged or of another schema; the message names the file and the remedy."""


class SearchError(RuntimeError):
    """A search of the solver exceeded the number of steps that is proved to suffice: a defect of this package."""


class StoppedError(RuntimeError):
    """The work was cancelled through its flag (`rocking._numba.cancellation.StopFlag`)."""


class OutsideCubeError(InvalidArgumentError, LookupError):
    """A point for which a cube gives no response with an error bound: outside its axes, or in a mixed cell."""


def in_range(
    parameter: str, value: ArrayLike, low: float, high: float, *, closed: str = "both", unit: str = "-"
) -> NDArray[np.float64]:
    """Return `value` as a float64 array (shape kept) after checking that all of it is finite and in the range.

    Parameters
    ----------
    parameter : str
        Name for the error message.
    value : array_like of real numbers, any shape
        Boolean, complex, date and text values, which numpy would convert, are rejected, and so are masked entries.
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
    if not _is_real(value):
        allowed = f"real numbers, none of them masked, in {_interval(low, high, closed, unit)}"
        raise InvalidArgumentError(parameter, value, allowed)
    try:
        array = np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError):
        reject_range(parameter, value, low, high, closed, unit)
    except OverflowError:  # an integer beyond the range of doubles
        wrong = next(entry for entry in np.asarray(value, dtype=object).flat if not -_MAX_FLOAT <= entry <= _MAX_FLOAT)
        reject_range(parameter, math.copysign(math.inf, wrong > 0 or -1), low, high, closed, unit)
    if array.size == 0:
        return array
    # two comparisons instead of arrays of them; min and max are nan if an entry is
    least, most = (float(array), float(array)) if array.ndim == 0 else (float(array.min()), float(array.max()))
    if not (_within(least, low, high, closed) and _within(most, low, high, closed)):
        wrong = next(entry for entry in array.flat if not _within(float(entry), low, high, closed))
        reject_range(parameter, float(wrong), low, high, closed, unit)
    return array


def _is_real(value: ArrayLike) -> bool:
    """Whether all entries are real numbers; booleans are not."""
    if type(value) in (float, int):
        return True
    if np.ma.is_masked(value):
        return False
    try:
        array = np.asarray(value)
    except ValueError:  # lists of different lengths
        return False
    if array.dtype.kind == "O":
        return all(isinstance(entry, Real | Decimal) and not isinstance(entry, bool) for entry in array.flat)
    return array.dtype.kind in "iuf"


def _within(value: float, low: float, high: float, closed: str) -> bool:
    above = value >= low if closed in ("both", "left") else value > low
    below = value <= high if closed in ("both", "right") else value < high
    return above and below and math.isfinite(value)


def reject_range(parameter: str, value: Any, low: float, high: float, closed: str, unit: str) -> NoReturn:
    """Raise `InvalidArgumentError` with the allowed range in words."""
    raise InvalidArgumentError(parameter, value, _interval(low, high, closed, unit))


def _interval(low: float, high: float, closed: str, unit: str) -> str:
    left = "[" if closed in ("both", "left") else "("
    right = "]" if closed in ("both", "right") and np.isfinite(high) else ")"
    return f"{left}{low:g}, {high:g}{right} [{unit}]"


def broadcast(
    given: Mapping[str, ArrayLike | None], checked: Sequence[NDArray[np.float64]]
) -> list[NDArray[np.float64]]:
    """The `checked` arrays of some arguments, broadcast against each other.

    Parameters
    ----------
    given : mapping
        The arguments by name, as given by the caller.
    checked : sequence of float arrays
        Their values.

    Raises
    ------
    InvalidArgumentError
        If the shapes do not broadcast; also if labelled arguments (xarray, pandas) differ in their dimensions, in the
        order of these, or in their indexes: numpy would combine entries by position.
    """
    labelled = {name: _labels(value) for name, value in given.items() if np.ndim(value) > 0}  # type: ignore[arg-type]
    first: list[tuple[Hashable, Any]] = []
    for labels in labelled.values():
        first = first or labels
        if labels and not _same_labels(labels, first):
            dims = tuple(tuple(dim for dim, _ in one) for one in labelled.values())
            raise InvalidArgumentError(
                ", ".join(labelled), dims, "equal dimensions and indexes: use xarray.broadcast or align first"
            )
    try:
        shape = np.broadcast_shapes(*(array.shape for array in checked))
    except ValueError:
        shapes = tuple(array.shape for array in checked)
        raise InvalidArgumentError(", ".join(given), shapes, "shapes that broadcast against each other") from None
    # copies, because kernels need contiguous arrays
    return [array if array.shape == shape else np.array(np.broadcast_to(array, shape)) for array in checked]


def _labels(value: Any) -> list[tuple[Hashable, Any]]:
    """Dimensions of an xarray or pandas object, each with its index or None; empty for other objects."""
    if hasattr(value, "dims"):
        indexes = getattr(value, "indexes", {})
        return [(dim, indexes.get(dim)) for dim in value.dims]
    return list(enumerate(getattr(value, "axes", ())))


def _same_labels(labels: list[tuple[Hashable, Any]], others: list[tuple[Hashable, Any]]) -> bool:
    return len(labels) == len(others) and all(
        dim == other and (index is None or one is None or index.equals(one))
        for (dim, index), (other, one) in zip(labels, others, strict=True)
    )


def one_of(parameter: str, value: str, choices: Iterable[str]) -> str:
    """Return `value` if it is among `choices`, else raise `InvalidArgumentError` listing them."""
    names = list(choices)
    if value not in names:
        raise InvalidArgumentError(parameter, value, "one of " + ", ".join(names))
    return value


class RecordFileError(InvalidArgumentError):
    """A file of a recorded motion that is damaged, ambiguous or of an unknown format.

    Parameters
    ----------
    file : str
        Name of the file.
    line : int or None
        Number of the line, from 1; None for the whole file.
    found : object
        What was found there.
    expected : str
        What was expected.
    """

    def __init__(self, file: str, line: int | None, found: Any, expected: str) -> None:
        super().__init__("record", found, expected)
        self.file, self.line, self.expected = file, line, expected
        text = str(found)
        shown = text if len(text) <= 60 else f"{text[:60]}..."
        place = file if line is None else f"{file}, line {line}"
        self.args = (f"{place}: found {shown}; expected {expected}",)

    def __reduce__(self) -> tuple[type[RecordFileError], tuple[Any, ...]]:
        return type(self), (self.file, self.line, self.value, self.expected)
