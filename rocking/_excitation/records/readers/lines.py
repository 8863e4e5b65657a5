"""Lines, numbers and units of a text file; errors with the file, the line, what was found and what was expected.

Every reader takes time in proportion to the size of the file, whatever it holds: lines are short, and no expression has
two adjoining repetitions over the same characters.
"""

from __future__ import annotations

import codecs
import re
from array import array
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from functools import cached_property
from itertools import chain, islice
from typing import TYPE_CHECKING

import numpy as np

from rocking._base.arrays import Array
from rocking._base.errors import RecordFileError
from rocking._base.units import unit_name

if TYPE_CHECKING:  # loads the compiler
    from rocking._numba.cancellation import StopFlag

NUMBER = re.compile(r"[+-]?(?:\d+(?:\.\d*)?|\.\d+)(?:[EeDd][+-]?\d+)?", re.ASCII)
"""A number as Fortran and C write it; not nan, inf or 1_000, which Python reads as well."""

MAX_LINE = 8192  # most bytes of a line: several hundred columns. A longer one is no line of a record
HEAD_LINES = 200  # largest number of lines that are searched for a header
CHUNK = 65536  # bytes of rows that are read at once: some milliseconds, in which no other thread may run
MAX_SAMPLES = 10_000_000  # largest number of values that is read from one file [-]
MAX_CLOSING = 200  # most bytes of a comment behind the last number, such as *** End data ***, or the end of a DOS file

_FILL = re.compile(r"9{2,}(\.(9+|25))?")
FILL_RATIO = 3.0  # a number of nines this many times larger than all other values stands for a missing one [-]

_CLOSING = re.compile(rb"[\r\n]+[ \t]*[*#!%\x1a][^\r\n]*\s*\Z")

COUNT_DIFFERENCE = 0.01
"""Largest difference between the number of values and the number that the header states, as a share of it [-]: headers
are often off by a few. A larger one is a damaged file."""


@dataclass(frozen=True)
class TextFile:
    """A text file in UTF-8, with or without a byte order mark, in UTF-16 with it, or in Latin-1.

    Lines are numbered from 1 in messages, from 0 in arguments. Rows are read in chunks of `CHUNK` bytes, as the lines
    of a whole file take twenty times its memory; `stop` is checked before each.
    """

    name: str
    content: bytes
    stop: StopFlag | None = None
    overruled: list[str] = field(default_factory=list)
    """Remarks on statements of the file that an argument contradicts."""

    def __post_init__(self) -> None:
        """Convert UTF-16 to UTF-8, as numbers are read from bytes, and CR CR LF to LF; leave out a last comment."""
        if self.content.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
            try:
                vars(self)["content"] = self.content.decode("utf-16").encode()
            except UnicodeDecodeError as error:
                raise self.error(None, f"UTF-16 with {error.reason}", "text") from None
        if b"\r\r\n" in self.content:  # a line end written twice by a system that adds a carriage return
            vars(self)["content"] = self.content.replace(b"\r\r\n", b"\n")
        if end := _CLOSING.search(self.content, max(1, len(self.content) - MAX_CLOSING)):
            vars(self)["content"] = self.content[: end.start()]

    @cached_property
    def head(self) -> list[str]:
        """The first lines, at most `HEAD_LINES`."""
        return [decoded(line).rstrip("\r\n") for line in self._raw_head]

    @cached_property
    def _raw_head(self) -> list[bytes]:
        chunks = (lines for _, lines in self._chunks(0, self._begin))
        return [*islice(chain.from_iterable(chunks), HEAD_LINES)]

    @property
    def _begin(self) -> int:
        """Index of the first byte after a byte order mark."""
        return len(codecs.BOM_UTF8) if self.content.startswith(codecs.BOM_UTF8) else 0

    def rows(self, first: int) -> Iterator[tuple[int, list[bytes]]]:
        """Lines, stripped, from `first` in the head to the last that is not blank; some at a time, with an index.

        Several blank lines may be passed on as one.
        """
        blank = None
        for k, lines in self._chunks(first, self.start_of(first)):
            found = [*map(bytes.strip, lines)]
            while found and not found[-1]:
                found.pop()
            if found:
                if blank is not None:
                    yield blank, [b""]
                    blank = None
                yield k, found
            if blank is None and len(found) < len(lines):
                blank = k + len(found)

    def start_of(self, line: int) -> int:
        """Index of the first byte of a line of the head."""
        return self._begin + sum(map(len, self._raw_head[:line]))

    def _chunks(self, index: int, start: int) -> Iterator[tuple[int, list[bytes]]]:
        """Lines with their ends from a byte on, which starts the line of this index."""
        while start < len(self.content):
            if self.stop is not None:
                self.stop.check()
            part = self.content[start : start + CHUNK]
            lines = part.splitlines(keepends=True)
            if start + CHUNK < len(self.content) and len(lines) > 1:
                part = part.removesuffix(lines.pop())  # it may be incomplete
            if max(map(len, lines)) > MAX_LINE:
                place, line = next((k, line) for k, line in enumerate(lines, index) if len(line) > MAX_LINE)
                raise self.error(place, decoded(line[:100]), f"lines of at most {MAX_LINE} bytes")
            yield index, lines
            index += len(lines)
            start += len(part)

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

    def values(self, first: int) -> Array:
        """All numbers from the line `first` on, any number on each line; blank lines only at the start and the end.

        Columns of fixed width may touch where a sign separates the numbers.
        """
        while first < len(self.head) and not self.head[first].strip():
            first += 1
        found = array("d")
        for k, lines in self.rows(first):
            if b"" in lines:
                raise self.error(k + lines.index(b""), "a blank line", "acceleration values up to the end of the file")
            try:
                found.extend(to_floats(b" ".join(lines).split()))
            except ValueError:
                for j, line in enumerate(lines, k):
                    found.extend(self.numbers(j, decoded(line)))
            if len(found) > MAX_SAMPLES:
                raise self.error(k, f"more than {MAX_SAMPLES} values", "a record of one component")
        values = np.frombuffer(found)
        self.check_values(values)
        return values

    def numbers(self, index: int, line: str) -> list[float]:
        """The numbers of a line."""
        found: list[float] = []
        for text in line.split():
            parts = [text] if NUMBER.fullmatch(text) else TOUCHING.split(text)
            if not all(NUMBER.fullmatch(part) for part in parts):
                raise self.error(index, text, "a number")
            found += map(to_float, parts)
        return found

    def check_values(self, values: Array) -> None:
        """Refuse fewer than two values, some beyond the range of doubles, and numbers such as -999 for missing ones."""
        if values.size < 2:
            raise self.error(None, f"{values.size} acceleration values", "at least 2")
        if not np.isfinite(values).all():
            raise self.error(None, "a number beyond the range of doubles", "finite numbers")
        sizes = np.abs(values)
        if _FILL.fullmatch(f"{(largest := float(sizes.max())):.10g}"):
            filled, sizes[sizes == largest] = float(values[sizes.argmax()]), 0.0
            if largest > FILL_RATIO * sizes.max():
                raise self.error(None, f"the value {filled:g}, as for missing ones", "an acceleration in each row")

    def checked_count(self, values: Array, stated: int, line: int) -> tuple[str, ...]:
        """The remark on a number of values that differs from the stated one, by as much as headers are usually off."""
        difference = abs(values.size - stated)
        if difference > COUNT_DIFFERENCE * stated:
            raise self.error(line, f"{stated} stated, {values.size} values in the file", "equal numbers")
        return (f"the file holds {values.size} samples, its header states {stated}",) if difference else ()


def to_floats(fields: list[bytes]) -> list[float]:
    """Numbers that match `NUMBER`, with exponents of E; `ValueError` for any other text."""
    if b" ".join(fields).translate(None, b"0123456789+-.Ee "):
        raise ValueError("not only numbers")
    return [*map(float, fields)]


def decoded(text: bytes) -> str:
    """A text in UTF-8 or Latin-1."""
    try:
        return text.decode()
    except UnicodeDecodeError:
        return text.decode("latin-1")


TOUCHING = re.compile(r"(?<=[\d.])(?=[+-])")  # where two numbers touch; not after an exponent's letter


def to_float(text: str) -> float:
    """A number that matches `NUMBER`."""
    return float(text.strip().translate(_EXPONENT))


_EXPONENT = str.maketrans("Dd", "Ee")


def parse_unit(text: str) -> str | None:
    """The unit of acceleration that a text names, a key of `UNITS`; None if it names none."""
    return unit_name(text, "m/s2")


def agreed_unit(file: TextFile, line: int | None, stated: str | None, given: str | None) -> str:
    """The unit given as an argument, else the one stated in the file; a remark if they differ.

    Raises `RecordFileError` if there is none.
    """
    if stated is None and given is None:
        raise file.error(line, "no unit of acceleration", "one in the header, or the argument `unit`")
    same = stated is None or given is None or {stated, given} <= {"gal", "cm/s2"} or stated == given
    if same:
        return stated or str(given)
    file.overruled.append(overruled(f"the unit {stated}", "unit", str(given)))
    return str(given)


def agreed_step(file: TextFile, line: int | None, stated: float | None, given: float | None) -> float:
    """The time step given as an argument, else the one stated in the file [s]; as `agreed_unit`."""
    if stated is None and given is None:
        raise file.error(line, "no time step", "one in the header, a column of times, or the argument `time_step`")
    if stated is not None and given is not None and abs(given / stated - 1.0) > 1e-3:
        file.overruled.append(overruled(f"a time step of {stated:g} s", "time_step", f"{given:g} s"))
    return float(given if given is not None else stated)  # type: ignore[arg-type]  # not both are None


def overruled(stated: str, argument: str, given: str) -> str:
    """The remark on a statement of a file that an argument contradicts."""
    return f"the file states {stated}; {given} is used, as the argument `{argument}` says"


def joined(parts: Iterable[str]) -> str:
    """The parts that are not empty, separated by semicolons."""
    return "; ".join(part for part in parts if part)
