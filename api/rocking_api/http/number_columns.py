"""Columns of numbers from JSON and CSV bodies, parsed in chunks between which the work can be cancelled.

The parsers of pydantic and numpy hold the interpreter lock until they return, 0.2 s for a million blocks as JSON. A
chunk takes some milliseconds.
"""

from __future__ import annotations

import io
import re
from collections.abc import Iterator
from itertools import islice

import numpy as np
from numpy.typing import NDArray
from pydantic import TypeAdapter, ValidationError

from rocking._base.errors import InvalidArgumentError
from rocking._numba.cancellation import StopFlag
from rocking_api.http.errors import TooLargeError

Columns = dict[str, NDArray[np.float64]]

GROUPS = ("slenderness", "frequency_ratio", "restitution")

CHUNK_BYTES = 500_000
"""Bytes of a JSON array that are parsed at once: 25,000 numbers, 2 ms."""

CHUNK_LINES = 10_000
"""Lines of CSV that are parsed at once: 5 ms."""

MAX_LINE = 1000
"""Characters of a line of CSV."""

MAX_OTHER_BYTES = 100_000
"""Bytes of a JSON body beside the arrays of the groups, which are parsed at once."""

_ARRAY = re.compile(rb'"(' + "|".join(GROUPS).encode() + rb')"\s*:\s*\[')
_NUMBERS = TypeAdapter(list[float])


def cut_arrays(body: bytes) -> tuple[bytes, dict[str, tuple[int, int]]]:
    """A JSON body with empty arrays in place of those of the groups, and where the entries of these start and end.

    Nested arrays remain.

    Raises
    ------
    InvalidArgumentError
        If more than `MAX_OTHER_BYTES` remain.
    """
    rest: list[bytes] = []
    arrays: dict[str, tuple[int, int]] = {}
    position = 0
    for name, start, end in _arrays(body):
        if body.find(b"[", start, end) < 0:
            rest.append(body[position:start])
            arrays[name] = start, end
            position = end
    rest.append(body[position:])
    size = sum(map(len, rest))
    if size > MAX_OTHER_BYTES:
        raise InvalidArgumentError("body", f"{size} bytes", f"at most {MAX_OTHER_BYTES} beside {', '.join(GROUPS)}")
    return b"".join(rest), arrays


def _arrays(body: bytes) -> Iterator[tuple[str, int, int]]:
    """Names of groups, each with where the entries of its array start, and where the next array ends."""
    end = 0
    while found := _ARRAY.search(body, end):
        end = body.find(b"]", found.end())
        if end < 0:
            return  # none of the arrays from here on has an end
        yield found[1].decode(), found.end(), end


def parse_array(name: str, body: bytes, span: tuple[int, int], max_points: int, stop: StopFlag) -> NDArray[np.float64]:
    """The numbers of a JSON array of a group, as `cut_arrays` found it.

    Raises
    ------
    InvalidArgumentError
        If an entry is not a number.
    TooLargeError
        For more than `max_points` numbers.
    StoppedError
        If `stop` was set.
    """
    parts: list[NDArray[np.float64]] = []
    (start, end), count, complete = span, 0, False
    while not complete:
        stop.check()
        comma = body.find(b",", start + CHUNK_BYTES, end)
        complete = comma < 0
        try:
            numbers = _NUMBERS.validate_json(b"[%b]" % body[start : end if complete else comma])
        except ValidationError as error:
            wrong = error.errors(include_url=False)[0]
            value = wrong["input"] if wrong["loc"] else wrong["msg"]
            raise InvalidArgumentError(name, value, "numbers separated by commas") from None
        if not numbers and (parts or not complete):
            raise InvalidArgumentError(name, ",", "numbers separated by commas")
        parts.append(np.array(numbers, dtype=np.float64))
        count += len(numbers)
        if count > max_points:
            raise TooLargeError("points", count, f"at most {max_points}")
        start = comma + 1
    return np.concatenate(parts)


def parse_csv(body: bytes, max_points: int, stop: StopFlag) -> Columns:
    """The columns of a CSV body with a header line; decoded line by line, as the text would take five times its memory.

    Raises
    ------
    InvalidArgumentError
        If it cannot be parsed, or a column is not a group.
    TooLargeError
        For more than `max_points` lines.
    StoppedError
        If `stop` was set.
    """
    lines = _lines(io.TextIOWrapper(io.BytesIO(body), encoding="utf-8-sig", newline="\n"))
    tables: list[NDArray[np.float64]] = []
    first = 2
    try:
        names = [name.strip() for name in next(lines, "").split(",")]
        check_columns(names)
        while chunk := [*islice(lines, CHUNK_LINES)]:
            stop.check()
            rows = [line for line in chunk if not line.isspace()]
            if rows:
                tables.append(np.loadtxt(rows, delimiter=",", ndmin=2, comments=None))
                if tables[-1].shape[1] != len(names):
                    columns = f"{tables[-1].shape[1]} columns"
                    raise InvalidArgumentError("body", columns, f"{len(names)}, as in the header line")
            first += len(chunk)
            if sum(map(len, tables)) > max_points:
                raise TooLargeError("points", sum(map(len, tables)), f"at most {max_points}")
    except (InvalidArgumentError, TooLargeError):
        raise
    except ValueError as error:  # UnicodeDecodeError among them
        allowed = "CSV: a header line, then numbers separated by commas"
        raise InvalidArgumentError("body", f"from line {first}: {error}", allowed) from None
    table = np.concatenate(tables) if tables else np.empty((0, len(names)))
    return dict(zip(names, table.T, strict=True))


def _lines(stream: io.TextIOWrapper) -> Iterator[str]:
    while line := stream.readline(MAX_LINE + 1):
        if len(line) > MAX_LINE:
            raise InvalidArgumentError("body", line[:40], f"lines of at most {MAX_LINE} characters")
        yield line


def check_columns(names: list[str]) -> None:
    """Refuse columns that are not groups, or that occur twice.

    Raises
    ------
    InvalidArgumentError
        For the first.
    """
    for name in names:
        if name not in GROUPS or names.count(name) > 1:
            raise InvalidArgumentError("body", name, "columns " + ", ".join(GROUPS) + ", each at most once")
