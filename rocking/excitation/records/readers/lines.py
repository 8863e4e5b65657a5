"""Lines, numbers and units of a text file; errors with the file, the line, what was found and what was expected."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rocking.errors import RecordFileError

NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[EeDd][+-]?\d+)?", re.ASCII)
"""A number as Fortran and C write it; not nan, inf or 1_000, which Python reads as well."""

MAX_SAMPLES = 10_000_000
"""Largest number of values that is read from one file [-]."""

LINE_DIFFERENCE, SHARE_DIFFERENCE = 8, 0.01
"""Largest difference between the number of values and the number that the header states [-], one line of values or a
share: headers are often off by a few. A larger one is a damaged file."""

_UNIT_FORMS = {
    "g": {"g", "gs", "gravity"},
    "gal": {"gal", "gals"},
    "m/s2": {"m/s2", "m/s/s", "ms-2", "m/s-2", "ms2"},
    "cm/s2": {"cm/s2", "cm/s/s", "cms-2", "cm/s-2", "cms2"},
    "mm/s2": {"mm/s2", "mm/s/s", "mms-2", "mm/s-2", "mms2"},
}


@dataclass(frozen=True)
class TextFile:
    """Name and lines of a text file, numbered from 1 in messages."""

    name: str
    lines: Sequence[str]

    def error(self, line: int | None, found: object, expected: str) -> RecordFileError:
        """The error for a line (index from 0), or for the whole file."""
        return RecordFileError(self.name, None if line is None else line + 1, found, expected)

    def number(self, line: int, text: str, expected: str) -> float:
        """One number from the text, found on a line."""
        if not NUMBER.fullmatch(text.strip()):
            raise self.error(line, text.strip(), expected)
        return to_float(text)

    def positive(self, line: int, text: str, expected: str) -> float:
        """One finite number > 0."""
        value = self.number(line, text, expected)
        if not 0.0 < value < np.inf:
            raise self.error(line, text.strip(), f"{expected}, > 0")
        return value

    def count(self, line: int, text: str, expected: str) -> int:
        """One integer > 0, which Fortran may have written with a point."""
        value = self.positive(line, text, expected)
        if value != int(value):
            raise self.error(line, text.strip(), f"{expected}, an integer")
        return int(value)

    def values(self, first: int) -> NDArray[np.float64]:
        """All numbers from the line `first` on, any number on each line; blank lines only at the end.

        Columns of fixed width may touch where a minus sign separates the numbers.
        """
        found: list[float] = []
        last = max((k for k, line in enumerate(self.lines) if line.strip()), default=-1)
        for k in range(first, last + 1):
            if not self.lines[k].strip():
                raise self.error(k, "a blank line", "acceleration values up to the end of the file")
            for field in re.split(r"[ \t]+", self.lines[k].strip(" \t")):
                if NUMBER.fullmatch(field):
                    found.append(to_float(field))
                    continue
                parts = re.split(r"(?<=[\d.])(?=[+-])", field)  # not after an exponent's letter
                if not all(NUMBER.fullmatch(part) for part in parts):
                    raise self.error(k, field, "a number")
                found += [to_float(part) for part in parts]
            if len(found) > MAX_SAMPLES:
                raise self.error(k, f"more than {MAX_SAMPLES} values", "a record of one component")
        values = np.array(found)
        self.check_values(values)
        return values

    def check_values(self, values: NDArray[np.float64]) -> None:
        """Refuse fewer than two values, and values beyond the range of doubles."""
        if values.size < 2:
            raise self.error(None, f"{values.size} acceleration values", "at least 2")
        if not np.isfinite(values).all():
            raise self.error(None, "a number beyond the range of doubles", "finite numbers")

    def checked_count(self, values: NDArray[np.float64], stated: int, line: int) -> str:
        """A remark if the number of values differs from the stated one; empty if not.

        Raises
        ------
        RecordFileError
            If the difference is larger than headers are usually off: the file is damaged.
        """
        difference = abs(values.size - stated)
        if difference == 0:
            return ""
        if difference > max(LINE_DIFFERENCE, SHARE_DIFFERENCE * stated):
            raise self.error(line, f"{stated} stated, {values.size} values in the file", "equal numbers")
        return f"{values.size} samples, {stated} stated in the header"


def to_float(text: str) -> float:
    """A number that matches `NUMBER`."""
    return float(text.strip().translate(_EXPONENT))


_EXPONENT = str.maketrans("Dd", "Ee")


def parse_unit(text: str) -> str | None:
    """The unit of acceleration that a text names, a key of `UNITS`; None if it names none."""
    plain = re.sub(r"[\s_*^()\[\]]|\*\*", "", text.strip().lower().replace("²", "2").replace("sec", "s"))
    return next((unit for unit, forms in _UNIT_FORMS.items() if plain in forms), None)


def agreed_unit(file: TextFile, line: int | None, stated: str | None, given: str | None) -> str:
    """The unit stated in the file, or given as an argument.

    Raises
    ------
    RecordFileError
        If there is none, or the two differ.
    """
    if stated is None and given is None:
        raise file.error(line, "no unit of acceleration", "one in the header, or the argument `unit`")
    same = stated is None or given is None or {stated, given} <= {"gal", "cm/s2"} or stated == given
    if not same:
        raise file.error(line, f"the unit {stated}", f"{given}, as the argument `unit` says")
    return stated or str(given)


def agreed_step(file: TextFile, line: int | None, stated: float | None, given: float | None) -> float:
    """The time step stated in the file [s], or given as an argument; errors as for `agreed_unit`."""
    if stated is None and given is None:
        raise file.error(line, "no time step", "one in the header, a column of times, or the argument `time_step`")
    if stated is not None and given is not None and abs(given / stated - 1.0) > 1e-3:
        raise file.error(line, f"a time step of {stated:g} s", f"{given:g} s, as the argument `time_step` says")
    return float(given if given is not None else stated)  # type: ignore[arg-type]  # not both are None


def joined(parts: Iterable[str]) -> str:
    """The parts that are not empty, separated by semicolons."""
    return "; ".join(part for part in parts if part)
