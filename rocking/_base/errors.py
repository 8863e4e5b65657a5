"""Exceptions and argument checks. A message has three parts: which argument, its value, what is allowed.

Every public function checks its arguments with these functions, so that Python, the command line and the HTTP service
report the same errors. Physical outcomes such as overturning are results and raise nothing.

What the checks share is said here. `parameter` is the name of the argument in the message. A `value` is a number, an
array of any shape, a quantity of a library (pint, astropy) or a text with a unit such as "40 cm", also in lists and
arrays. Numbers without a unit are in `unit`, the unit of the result. Boolean, complex, date and other text values,
which numpy would convert, are rejected, and so are masked entries. The range goes from `low` to `high`, which may be
infinite; `closed` says which ends belong to it: "both", "left", "right" or "neither". Each check raises
`InvalidArgumentError` with the first entry that fails, and its index.
"""

from __future__ import annotations

import ast
import math
import operator
import re
import sys
from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence
from decimal import Decimal
from numbers import Real
from types import NoneType
from typing import Any, NoReturn

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rocking._base.units import EXAMPLES, UNITS, USUAL, WithUnit, split_quantity, unit_name

_MAX_FLOAT = sys.float_info.max

MAX_TEXT = 300  # longest text of a value in a message [characters]
MAX_FOUND = 60  # longest text of a file in a message [characters]


class RockingError(Exception):
    """Any error that this package raises on purpose."""


class InvalidArgumentError(RockingError, ValueError):
    """An invalid argument: its name, its value and what is allowed.

    Parameters
    ----------
    parameter : str
        Name of the argument, as the caller knows it.
    value : object
        The offending value.
    allowed : str
        Accepted values, in words or as an interval.
    index : tuple of int
        Position of the value in an argument with several.
    """

    def __init__(self, parameter: str, value: Any, allowed: str, index: tuple[int, ...] = ()) -> None:
        self.parameter = parameter
        self.value = value
        self.allowed = allowed
        self.index = index
        position = ""
        if index:
            position = f" at index {index if len(index) > 1 else index[0]}"
        super().__init__(f"`{parameter}` = {_short(value)}{position} is not allowed; allowed: {allowed}")

    def __reduce__(self) -> tuple[type[InvalidArgumentError], tuple[Any, ...]]:
        return type(self), (self.parameter, self.value, self.allowed, self.index)


class MissingUnitError(InvalidArgumentError):
    """A text with a number and no unit."""

    def __init__(self, parameter: str, value: str, allowed: str) -> None:
        super().__init__(parameter, value, allowed)
        self.args = (f"`{parameter}` = {value!r}: {allowed}",)

    def __reduce__(self) -> tuple[type[MissingUnitError], tuple[Any, ...]]:
        return type(self), (self.parameter, self.value, self.allowed)


class UnreadableFileError(InvalidArgumentError):
    """A file that cannot be read, and why: "no such file", or what the system says."""

    def __init__(self, parameter: str, value: str, reason: OSError | str) -> None:
        super().__init__(parameter, value, "a file that can be read")
        if isinstance(reason, OSError):
            reason = "no such file" if isinstance(reason, FileNotFoundError) else str(reason.strerror or reason).lower()
        self.reason = reason
        self.args = (f"`{parameter}` = {value!r}: {reason}",)

    def __reduce__(self) -> tuple[type[UnreadableFileError], tuple[Any, ...]]:
        return type(self), (self.parameter, self.value, self.reason)


class SeveralArgumentsError(InvalidArgumentError):
    """Several invalid arguments, an error for each; parameter, value and allowed are those of the first."""

    def __init__(self, errors: Sequence[InvalidArgumentError]) -> None:
        super().__init__(errors[0].parameter, errors[0].value, errors[0].allowed)
        self.errors = list(errors)
        self.args = ("; ".join(map(str, errors)),)

    def __reduce__(self) -> tuple[type[SeveralArgumentsError], tuple[Any, ...]]:
        return type(self), (self.errors,)


class DatasetError(RockingError, RuntimeError):
    """A data set file is missing, damaged or of another schema; the message names the file and the remedy."""


class SearchError(RockingError, RuntimeError):
    """A search of the solver exceeded the number of steps that is proved to suffice: a defect of this package."""


class StoppedError(RockingError, RuntimeError):
    """The work was cancelled through its flag (`rocking._numba.cancellation.StopFlag`)."""


class OutsideCubeError(InvalidArgumentError, LookupError):
    """A point for which a cube gives no response with an error bound: outside its axes, or in a mixed cell."""


def _short(value: Any) -> str:
    """Return a value as text; of a long one, such as an array, its beginning."""
    text = repr(value)
    if len(text) <= MAX_TEXT:
        return text
    return f"{' '.join(text[: MAX_TEXT // 2].split())} ... ({type(value).__name__})"


def in_range(
    parameter: str, value: ArrayLike | WithUnit, low: float, high: float, *, closed: str = "both", unit: str = "-"
) -> NDArray[np.float64]:
    """Return `value` as a float64 array (shape kept) after checking that all of it is finite and in the range."""
    array = float_array(parameter, value, low, high, closed=closed, unit=unit)
    # two comparisons instead of arrays of them; min and max are nan if an entry is
    if array.size == 0 or (low < array.min() and array.max() < high):
        return array
    if array.ndim == 0:
        if not _within(float(array), low, high, closed):
            if _has_unit(value):  # then degrees were not meant
                raise InvalidArgumentError(parameter, float(array), _interval(low, high, closed, unit))
            reject_range(parameter, float(array), low, high, closed, unit)
        return array
    if _within(float(array.min()), low, high, closed) and _within(float(array.max()), low, high, closed):
        return array
    for index, entry in np.ndenumerate(array):
        if not _within(float(entry), low, high, closed):
            reject_range(parameter, float(entry), low, high, closed, unit, index)
    return array


def number(
    parameter: str, value: ArrayLike | WithUnit, low: float, high: float, *, closed: str = "both", unit: str = "-"
) -> float:
    """Return `value` as a float after checking that it is one finite number in the range."""
    if type(value) is float and low < value < high:  # all that is left to do for most
        return value
    if isinstance(value, list | tuple) or (hasattr(value, "ndim") and value.ndim):
        raise InvalidArgumentError(parameter, value, f"one number in {_interval(low, high, closed, unit)}")
    return float(in_range(parameter, value, low, high, closed=closed, unit=unit))


def positive(parameter: str, value: ArrayLike | WithUnit, unit: str) -> float:
    """Return `value` as a float after checking that it is one finite number > 0."""
    return number(parameter, value, 0.0, math.inf, closed="neither", unit=unit)


def integer(parameter: str, value: ArrayLike | WithUnit, low: float, high: float) -> int:
    """Return `value` as an int after checking that it is one whole number from `low` to `high`."""
    real = number(parameter, value, low, high)
    if not real.is_integer():
        raise InvalidArgumentError(parameter, value, f"a whole number in {_interval(low, high, 'both', '-')}")
    return int(real)


def si_value(parameter: str, text: str, unit: str) -> float:
    """Read a text with a number and a unit, such as "30cm", "4 m/s^2", "0.4 g", "20 deg" or "45 %".

    `unit` is a key of `rocking._base.units.UNITS`. Without a unit it raises `MissingUnitError`, which proposes one.
    """
    allowed = "a number, or a percentage such as '45 %'"
    if unit != "-":
        allowed = f"a number with its unit, such as {EXAMPLES[unit]}"
    value, suffix = split_quantity(text) or (math.nan, "")
    if not suffix and math.isfinite(value) and unit in USUAL:
        proposed = " or ".join(f"{text.strip()}{usual}" for usual in USUAL[unit])
        raise MissingUnitError(parameter, text, f"missing unit: write {proposed} (such as {EXAMPLES[unit]})")
    name = unit_name(suffix, unit)
    value = value * UNITS[unit][name] if name else math.nan
    if not math.isfinite(value):
        raise InvalidArgumentError(parameter, text, allowed)
    return value


def plain_number(parameter: str, text: str) -> float:
    """Read a text without a unit, such as "0.45", "1e-3" or "45 %"."""
    try:
        return float(text)
    except ValueError:
        return si_value(parameter, text, "-")


def plain_numbers(parameter: str, text: str) -> list[float]:
    """Read a text of numbers that are separated by commas."""
    try:
        return [float(part) for part in text.split(",")]
    except ValueError:
        raise InvalidArgumentError(parameter, text, "a number, or several separated by commas") from None


def finite(value: float) -> float | None:
    """Return the number, or None, which JSON can hold, if it is not finite."""
    return value if math.isfinite(value) else None


def float_array(
    parameter: str,
    value: Any,
    low: float = -math.inf,
    high: float = math.inf,
    *,
    closed: str = "neither",
    unit: str = "-",
) -> NDArray[np.float64]:
    """Return `value` as a float64 array that may hold nan and infinity; the range is only for the message."""
    if type(value) is np.ndarray and value.dtype == np.float64:
        return value
    plain = value if type(value) in _PLAIN_TYPES else _without_unit(parameter, value, unit)
    if not _is_real(plain):
        allowed = f"real numbers, none of them masked, in {_interval(low, high, closed, unit)}"
        raise InvalidArgumentError(parameter, value, allowed)
    try:
        return np.asarray(plain, dtype=np.float64)
    except (TypeError, ValueError):
        reject_range(parameter, value, low, high, closed, unit)
    except OverflowError:  # an integer beyond the range of doubles
        entries = np.asarray(plain, dtype=object).flat
        wrong = next(entry for entry in entries if not -_MAX_FLOAT <= entry <= _MAX_FLOAT)
        reject_range(parameter, math.copysign(math.inf, wrong > 0 or -1), low, high, closed, unit)


_PLAIN_TYPES = {float, int, np.float64, bytes, bool, NoneType}  # types without a unit


def _without_unit(parameter: str, value: Any, unit: str) -> Any:
    """Convert a quantity of any library or a text, or a list with some, to `unit`; return other values as they are."""
    if isinstance(value, str) and unit in UNITS:
        return si_value(parameter, value, unit)
    if isinstance(value, str) and not any(unit in names for names in UNITS.values()):
        raise InvalidArgumentError(parameter, value, f"a number in [{unit}]; texts with this unit are not read")
    if hasattr(value, "dtype") and value.dtype.kind in "UO":  # an array of texts or quantities, with or without labels
        array = np.asarray(value)
        if any(_has_unit(entry) for entry in array.flat):
            return _without_unit(parameter, array.tolist(), unit)
    if isinstance(value, np.ndarray) and not hasattr(value, "unit"):
        return value
    if isinstance(value, list | tuple):
        if set(map(type, value)) <= _PLAIN_TYPES:
            return value
        entries = [_without_unit(parameter, entry, unit) for entry in value]
        return value if all(map(operator.is_, entries, value)) else entries
    quantity = value.variable.data if hasattr(value, "variable") else value  # in a labelled array of xarray
    if not _has_unit(quantity):
        return value
    si_unit = next((key for key, names in UNITS.items() if unit in names), unit)  # other libraries' g is a gram
    try:
        converted = quantity.to("" if unit == "-" else re.sub(r"(?<=[a-z])2", "**2", si_unit))
    except Exception:  # noqa: BLE001  (each library has its own errors)
        raise InvalidArgumentError(parameter, quantity, f"a quantity that can be converted to [{unit}]") from None
    value = converted.magnitude if hasattr(converted, "magnitude") else converted.value
    return value if unit == si_unit else value / UNITS[si_unit][unit]


def _has_unit(value: Any) -> bool:
    """Return True for a quantity of a library, or a text with a unit."""
    if isinstance(value, str):
        return bool((split_quantity(value) or (math.nan, ""))[1])
    return hasattr(value, "to") and (hasattr(value, "units") or hasattr(value, "unit"))


def _is_real(value: ArrayLike) -> bool:
    """Return True if all entries are real numbers; booleans are not."""
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


def reject_range(
    parameter: str, value: Any, low: float, high: float, closed: str, unit: str, index: tuple[int, ...] = ()
) -> NoReturn:
    """Raise `InvalidArgumentError` with the allowed range in words."""
    allowed = _interval(low, high, closed, unit)
    if unit == "rad" and isinstance(value, float) and value > high and _within(math.radians(value), low, high, closed):
        allowed += "; numpy.radians converts degrees" if index else f"; write '{value:g} deg' if degrees were meant"
    raise InvalidArgumentError(parameter, value, allowed, index)


def _interval(low: float, high: float, closed: str, unit: str) -> str:
    left = "[" if closed in ("both", "left") else "("
    right = "]" if closed in ("both", "right") and np.isfinite(high) else ")"
    return f"{left}{low:g}, {high:g}{right} [{unit}]"


def broadcast(
    arguments: Mapping[str, ArrayLike | WithUnit | None], checked: Sequence[NDArray[np.float64]]
) -> list[NDArray[np.float64]]:
    """Broadcast the `checked` arrays of arguments against each other; `arguments`: these by name, for messages.

    Labelled arguments (xarray, pandas) have to agree in dimensions, their order and their indexes: numpy would combine
    entries by position.
    """
    pairs = zip(arguments.items(), checked, strict=False)  # an argument that is None may be left out at the end
    labelled = {name: _labels(value) for (name, value), array in pairs if array.ndim}
    first: list[tuple[Hashable, Any]] = []
    for labels in labelled.values():
        first = first or labels
        if labels and not _same_labels(labels, first):
            dims = tuple(tuple(dict(axes)) for axes in labelled.values())
            raise InvalidArgumentError(
                ", ".join(labelled), dims, "equal dimensions and indexes: use xarray.broadcast or align first"
            )
    try:
        shape = np.broadcast_shapes(*(array.shape for array in checked))
    except ValueError:
        shapes = tuple(array.shape for array in checked)
        raise InvalidArgumentError(", ".join(arguments), shapes, "shapes that broadcast against each other") from None
    # copies, because kernels need contiguous arrays
    return [array if array.shape == shape else np.array(np.broadcast_to(array, shape)) for array in checked]


def _labels(value: Any) -> list[tuple[Hashable, Any]]:
    """Return the dimensions of an xarray or pandas object, each with its index or None; empty for other objects."""
    if hasattr(value, "dims"):
        indexes = getattr(value, "indexes", {})
        return [(dim, indexes.get(dim)) for dim in value.dims]
    return list(enumerate(getattr(value, "axes", ())))


def _same_labels(labels: list[tuple[Hashable, Any]], other_labels: list[tuple[Hashable, Any]]) -> bool:
    if len(labels) != len(other_labels):
        return False
    for (dim, index), (other_dim, other_index) in zip(labels, other_labels, strict=True):
        if dim != other_dim:
            return False
        if index is not None and other_index is not None and not index.equals(other_index):
            return False
    return True


def needed(kind: str, **argument: Any) -> Any:
    """Return an argument that a kind of motion, "a pulse" or "a record", needs; None is an error."""
    ((name, value),) = argument.items()
    if value is None:
        raise InvalidArgumentError(name, None, f"a number, for {kind}")
    return value


def reject_given(kind: str, **arguments: Any) -> None:
    """Reject arguments that have no meaning for a kind of motion: each has to be None."""
    for name, value in arguments.items():
        if value is not None:
            raise InvalidArgumentError(name, value, f"nothing for {kind}")


def one_of(parameter: str, value: str, choices: Iterable[str]) -> str:
    """Return `value` if it is among `choices`, else raise `InvalidArgumentError` listing them."""
    names = list(choices)
    if value not in names:
        raise InvalidArgumentError(parameter, value, "one of " + ", ".join(names))
    return value


class RecordFileError(InvalidArgumentError):
    """A file of a recorded motion that is damaged, or whose layout is not stated.

    Parameters
    ----------
    file : str
        Its name.
    line : int or None
        Number of the line from 1, or None for the whole file.
    found, expected
        What is there, and what should be. In `expected` a part between backticks is an argument, `name` or
        `name=value` with a value as Python writes it.
    lines : sequence of str
        Further lines of the message, such as the first lines of the file.
    call : mapping, optional
        Arguments that would read the file; `...` for a value that is not known.
    """

    def __init__(
        self,
        file: str,
        line: int | None,
        found: Any,
        expected: str,
        lines: Sequence[str] = (),
        call: Mapping[str, Any] | None = None,
    ) -> None:
        super().__init__("record", found, expected)
        self.file, self.line, self.expected, self.call = file, line, expected, call
        self.lines = tuple(text.replace("`", "'") for text in lines)
        self._set_text()

    def _set_text(self) -> None:
        """Set the message of Python, which proposes a call of the function that reads the file."""
        self.args = (self.message(_as_argument, f'read_{self.parameter}("{self.file}", ', ", ", ")"),)

    def message(self, spell: Callable[[str, Any], str], before: str, between: str, after: str = "") -> str:
        """Return the message, with arguments as an interface spells them.

        `spell` writes a name and its value, None without one; a call is written between `before` and `after`.
        """
        value = str(self.value)
        if len(value) > MAX_FOUND:
            value = f"{value[:MAX_FOUND]}..."
        position = self.file if self.line is None else f"{self.file}, line {self.line}"
        text = f"{position}: found {value}".replace("`", "'")
        parts = f"{text}; expected {self.expected}".split("`")
        for k, part in enumerate(parts):
            if k % 2:
                name, equals, literal = part.partition("=")
                parts[k] = spell(name, ast.literal_eval(literal) if equals else None)
        lines = ["".join(parts), *(f"  {line}" for line in self.lines)]
        if self.call is not None:
            arguments = between.join(spell(name, value) for name, value in self.call.items())
            lines.append(f"such as {before}{arguments}{after}")
        return "\n".join(lines)

    def __reduce__(self) -> tuple[type[RecordFileError], tuple[Any, ...]]:
        return type(self), (self.file, self.line, self.value, self.expected, self.lines, self.call)


class TableFileError(RecordFileError):
    """A table that is damaged, or whose layout is not stated; `argument` is "objects" or "blocks"."""

    def __init__(self, argument: str, *parts: Any) -> None:
        super().__init__(*parts)
        self.parameter = argument
        self._set_text()

    def __reduce__(self) -> tuple[type[RecordFileError], tuple[Any, ...]]:
        kind, parts = super().__reduce__()
        return kind, (self.parameter, *parts)


def _as_argument(name: str, value: Any) -> str:
    """Return an argument of Python: its name in backticks, or with a value."""
    if value is None:
        return f"`{name}`"
    return f"{name}=..." if value is ... else f"{name}={value!r}"
