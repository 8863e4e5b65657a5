"""Text of a file by lines, the numbers in them, and errors with the file and the line."""

from __future__ import annotations

import codecs
import io
from array import array
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cached_property
from itertools import islice
from typing import TYPE_CHECKING

import numpy as np

from rocking._base.arrays import Array
from rocking._base.errors import InvalidArgumentError, RecordFileError, RockingError

if TYPE_CHECKING:  # loads the compiler
    from rocking._numba.cancellation import StopFlag

MAX_LINE = 8192  # most bytes of a line: several hundred columns
MAX_SAMPLES = 10_000_000  # most values that are read from one file [-]
MAX_WIDTH = 40  # most characters of a number of fixed width
HEAD_LINES = 80  # lines in which the signature of a format is: those of ESM are 64
LINES_BETWEEN_CHECKS = 1000  # lines that are read before the flag of cancellation is looked at again

COUNT_DIFFERENCE = 0.01
"""Largest difference between the number of values and the number that the header states, as a share of it [-]: headers
are often off by a few. A larger one is a damaged file."""

_OF_NUMBERS = frozenset("0123456789+-.eEdD")
_EXPONENT = str.maketrans("dD", "ee")

OTHER_QUANTITIES = {"velocity", "velocities", "vel", "displacement", "displacements", "disp", "counts", "cnt"}
OTHER_QUANTITIES |= {"spectrum", "spectra", "spectral"}
"""Words of a title or a name that say that the numbers are no accelerations."""


class TextFile:
    """A text file in UTF-8, in UTF-16 with its byte order mark, or in Latin-1, with any ends of lines.

    Lines are numbered from 0 in arguments and from 1 in messages. `line` is the line that was read last, `encoding` how
    the text is encoded.
    """

    def __init__(self, name: str, content: bytes, stop: StopFlag | None = None) -> None:
        self.name = name
        self.stop = stop
        self.line = 0
        self.encoding = "UTF-8"
        self.content = self._in_utf8(content)

    def _in_utf8(self, content: bytes) -> bytes:
        if content.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
            try:
                content = content.decode("utf-16").encode()
                self.encoding = "UTF-16"
            except UnicodeDecodeError as error:
                raise self.error(None, f"UTF-16 with {error.reason}", "text") from None
        content = content.removeprefix(codecs.BOM_UTF8)
        if not content.isascii():
            try:
                content.decode()
            except UnicodeDecodeError:
                content = content.decode("latin-1").encode()
                self.encoding = "Latin-1"
        if b"\r" in content:
            content = content.replace(b"\r\r\n", b"\n").replace(b"\r\n", b"\n").replace(b"\r", b"\n")
        content = content.rstrip(b"\x1a \t\n")  # the end of a DOS file
        if not content:
            raise self.error(None, "an empty file", "a recorded ground acceleration")
        if b"\0" in content:
            raise self.error(None, "binary content", "text, or a SAC or miniSEED file")
        return content

    @cached_property
    def head(self) -> list[str]:
        """The first lines, at most `HEAD_LINES`."""
        return [line for _, line in islice(self.lines(0), HEAD_LINES)]

    def lines(self, first: int) -> Iterator[tuple[int, str]]:
        """Yield index and text of the lines from `first` on, without their ends."""
        for k, line in enumerate(io.BytesIO(self.content)):
            if self.stop is not None and k % LINES_BETWEEN_CHECKS == 0:
                self.stop.check()
            if len(line) > MAX_LINE:
                raise self.error(k, line[:100].decode(errors="replace"), f"lines of at most {MAX_LINE} bytes")
            if k >= first:
                self.line = k
                yield k, line.decode().removesuffix("\n")

    def error(self, line: int | None, found: object, expected: str) -> RecordFileError:
        """Return the error for a line, or for the whole file."""
        return RecordFileError(self.name, None if line is None else line + 1, found, expected)

    def number(self, line: int, text: str, expected: str) -> float:
        """Read one finite number > 0 from a text of a line."""
        try:
            (value,) = numbers([text.strip()])
        except ValueError:
            value = np.nan
        if not 0.0 < value < np.inf:
            raise self.error(line, text.strip() or "nothing", f"{expected}, a number above 0")
        return value

    def size(self, line: int, text: str, expected: str, limit: int = MAX_SAMPLES) -> int:
        """Read one integer > 0 from a text of a line, at most the number of bytes of the file."""
        value = self.number(line, text, expected)
        limit = min(limit, len(self.content))
        if value > limit or value != int(value):
            raise self.error(line, text.strip(), f"{expected}, an integer up to {limit} in a file of this size")
        return int(value)

    def values(self, first: int) -> Array:
        """Read all numbers from a line on, any number on each line; blank lines only at the start."""
        values = array("d")
        for k, line in self.lines(first):
            cells = line.split()
            if not cells and values:
                raise self.error(k, "a blank line", "acceleration values up to the end of the file")
            values.extend(self.line_of_numbers(k, cells))
            if len(values) > MAX_SAMPLES:
                raise self.error(k, f"more than {MAX_SAMPLES} values", "a record of one component")
        return self.checked(np.frombuffer(values))

    def line_of_numbers(self, line: int, cells: list[str]) -> list[float]:
        """Read the numbers in the cells of a line."""
        try:
            return numbers(cells)
        except ValueError:
            wrong = next(cell for cell in cells if not is_number(cell))
            raise self.error(line, wrong.strip() or "an empty cell", "a number") from None

    def checked(self, values: Array) -> Array:
        """Return the values if there are two or more and all are in the range of doubles."""
        if values.size < 2:
            raise self.error(None, f"{values.size} acceleration values", "at least 2")
        if not np.isfinite(values).all():
            raise self.error(None, "a number beyond the range of doubles", "finite numbers")
        return values

    def count_remarks(self, values: Array, count: int, line: int) -> list[str]:
        """Return a remark where the number of values differs from the stated one as much as headers usually do."""
        difference = abs(values.size - count)
        if difference > COUNT_DIFFERENCE * count:
            expected = 'equal numbers; or `format="columns"`, if the numbers are laid out in another way'
            raise self.error(line, f"{count} stated, {values.size} values in the file", expected)
        return [f"the file holds {values.size} samples, its header states {count}"] if difference else []

    def check_words(self, line: int, text: str) -> None:
        """Refuse a title of velocities, displacements, counts or a spectrum."""
        if says_other_quantity(text):
            raise self.other_quantity(line, text.strip())

    def other_quantity(self, line: int | None, text: str) -> RecordFileError:
        """Return the error about a title or a name of another quantity."""
        return self.error(line, text, 'accelerations; or `format="columns"` with `unit`, if they are')

    @contextmanager
    def guarded(self, kind: str) -> Iterator[None]:
        """Turn an error of a reader about a damaged file into one that names the line."""
        try:
            yield
        except InvalidArgumentError as error:
            if isinstance(error, RecordFileError):
                raise
            # samples that make no record, such as zeros only
            raise self.error(None, f"{error.parameter} {error.value}", error.allowed) from None
        except RockingError:
            raise
        except (ValueError, IndexError, KeyError, ArithmeticError, MemoryError, StopIteration, RuntimeError) as error:
            description = f"{type(error).__name__}: {error}".strip(": ")
            raise self.error(self.line, description, f"the layout of {kind}") from None


def numbers(cells: list[str]) -> list[float]:
    """Read numbers as C and Fortran write them, and no others that Python reads; `ValueError` for any other text."""
    if not _OF_NUMBERS.issuperset("".join(cells)):
        raise ValueError("not only numbers")
    try:
        return [*map(float, cells)]
    except ValueError:
        return [float(cell.translate(_EXPONENT)) for cell in cells]


def says_other_quantity(text: str) -> bool:
    """True if a title or a name says that the numbers are no accelerations."""
    words = "".join(sign if sign.isalpha() else " " for sign in text).lower().split()
    return not OTHER_QUANTITIES.isdisjoint(words)


def is_number(cell: str) -> bool:
    """Return True if a cell is a number."""
    try:
        numbers([cell])
    except ValueError:
        return False
    return True


def fortran_widths(text: str) -> tuple[int, int] | None:
    """Return the number of values on a line and characters of each in a format such as `8f10.6` or `(5E15.7)`.

    None for other texts. Raises `ValueError` for a width that is not 1 to `MAX_WIDTH`.
    """
    plain = text.strip().strip("()").lower()
    for letter in "efgi":
        count, letter_in_text, width = plain.partition(letter)
        width = width.partition(".")[0]
        if letter_in_text and (count or "1").isdecimal() and width.isdecimal():
            if not (len(count) < 4 and len(width) < 4 and 1 <= int(width) <= MAX_WIDTH and int(count or 1) > 0):
                raise ValueError(f"a width of 1 to {MAX_WIDTH} characters in {text.strip()[:40]}")
            return int(count or 1), int(width)
    return None
