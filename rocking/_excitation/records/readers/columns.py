"""Columns of numbers, CSV or blank-separated: times and accelerations, or accelerations alone.

Lines before the first row of numbers are the header. It may name the columns, with the unit in the name
(`acceleration_g`, `acc (cm/s2)`, `t/ms`), and hold settings such as `unit: g`, `dt = 0.01` or `sampling rate: 100 Hz`,
also after a `#`. What it does not state has to be given as an argument.
"""

from __future__ import annotations

import re
from array import array
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import chain
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rocking._base.errors import RecordFileError
from rocking._base.units import UNITS, unit_name
from rocking._excitation.records.readers.lines import (
    MAX_SAMPLES,
    NUMBER,
    TextFile,
    agreed_step,
    agreed_unit,
    decoded,
    parse_unit,
    to_float,
    to_floats,
)
from rocking._excitation.records.record import Record

STEP_TOLERANCE = 0.02
"""Largest deviation of a time from the uniform grid, in steps [-]: times are often rounded to a few digits."""

MAX_TIME = 1e12
"""Largest time in a column of times [s]; times are often counted from an epoch."""

MAX_UNIT_PARTS = 8
"""Most parts, separated by blanks, of a unit in a column name, such as m / s ^ 2."""

_COMMENT = "#%!*/\"'"

_DECIMAL_COMMA = (";", "\t")
"""Separators of columns beside which a comma is the decimal sign."""


def read(file: TextFile, unit: str | None, time_step: float | None, component: str | None) -> Record:
    """Read columns; arguments and errors as for `read_record`."""
    first = _first_row(file)
    separator = _separator(file.head[first])
    width = len(_fields(file.head[first], separator))
    names_line, names = _column_names(file, first, separator, width)
    settings = _settings(file, first)
    times, certain = _time_column(file, first, names)
    others = [k for k in range(width) if k != times or (component is not None and not certain)]
    chosen = _chosen(file, names_line, [names[k] for k in others], others, component)
    _check_name(file, names_line, names[chosen])
    in_name, stated_unit = _unit_in_name(names[chosen]), settings.unit
    if in_name and stated_unit and in_name != stated_unit:
        raise file.error(names_line, f"the unit {in_name} in a column name", f"{stated_unit}, as the header says")
    agreed = agreed_unit(file, names_line if in_name else settings.unit_line, in_name or stated_unit, unit)
    measured = None
    if times is None or times == chosen:
        (values,) = _table(file, first, separator, width, [chosen])
    else:
        found, values = _table(file, first, separator, width, [times, chosen])
        if certain or _rises(found):
            measured = _uniform_step(file, first, found * _time_factor(file, names_line, names[times]))
        elif component is None:
            raise _several(file, names_line, names)
    step = _agreed_step(file, first, settings, measured, time_step)
    file.check_values(values)
    stem = file.name.rsplit(".", 1)[0]
    name = stem if component is None else f"{stem} {names[chosen]}"
    return Record(values, step, agreed, name=name, source=f"{file.name} (columns)")


def read_samples(file: TextFile, most: int) -> tuple[int, NDArray[np.float64] | None, NDArray[np.float64]]:
    """Index of the first row, times if there are two columns, and accelerations, in any units; at most `most` rows.

    Raises
    ------
    RecordFileError
        If the file holds anything else.
    """
    first, _, _, (*times, values) = _samples(file, most, "accelerations")
    return first, times[0] if times else None, values


def read_rotations(file: TextFile, most: int, degrees: bool | None) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Times [s] and rotations [rad], at most `most` rows, in the units that the names of the columns state.

    Without units these are seconds, and degrees or radians as `degrees` says; None: radians, unless the file states
    another unit.

    Raises
    ------
    RecordFileError
        If the file holds anything else, or rotations in another unit than `degrees` says.
    """
    first, line, names, columns = _samples(file, most, "rotations")
    if len(columns) == 1:
        raise file.error(first, "one column", "a column of times and one of rotations")
    stated, given = _stated_unit(file, line, names[1], "rad"), "deg" if degrees else "rad"
    if stated not in (None, given) and degrees is not None:
        raise file.error(line, f"the column {names[1]}", f"rotations in {given}, as `degrees` says")
    return columns[0] * _time_factor(file, line, names[0]), columns[1] * UNITS["rad"][stated or given]


class _Samples(NamedTuple):
    """Index of the first row, line of the names, names and values of the columns: times come first."""

    first: int
    line: int | None
    names: list[str]
    columns: list[NDArray[np.float64]]


def _samples(file: TextFile, most: int, kind: str) -> _Samples:
    """One column, or two with times; `kind` is what the other one holds, in messages."""
    expected = f"one column of {kind}, or two of times and {kind}"
    first = _first_row(file, expected)
    separator = _separator(file.head[first])
    width = len(_fields(file.head[first], separator))
    if width > 2:
        raise file.error(first, f"{width} columns", expected)
    line, names = _column_names(file, first, separator, width)
    times, _ = _time_column(file, first, names, kind)
    order = [0] if times is None else [times, 1 - times]
    _check_name(file, line, names[order[-1]], kind)
    return _Samples(first, line, [names[k] for k in order], _table(file, first, separator, width, order, most))


def _check_name(file: TextFile, line: int | None, name: str, kind: str = "accelerations") -> None:
    """Refuse a column of velocities or displacements, by its name."""
    if re.match(r"vel|dis", name, re.I) or re.search(r"[(\[](mm|cm|m)(/s)?[)\]]", name, re.I):
        raise file.error(line, f"the column {name}", f"a column of {kind}")


def _agreed_step(file: TextFile, first: int, settings: _Settings, measured: float | None, given: float | None) -> float:
    """The time step [s] that the column of times, the settings of the header and the argument agree in."""
    if measured is None:
        return agreed_step(file, settings.step_line, settings.step, given)
    if settings.step is not None and abs(measured / settings.step - 1.0) > 1e-3:
        found = f"a time step of {settings.step:g} s"
        raise file.error(settings.step_line, found, f"{measured:g} s, as the column of times says")
    return agreed_step(file, first, measured, given)


def _fields(line: str, separator: str | None) -> list[str]:
    """The fields of a line; a separator at its end adds none."""
    fields = [field.strip().strip("\"'") for field in line.strip().split(separator)]
    return fields[:-1] if len(fields) > 1 and fields[-1] == "" else fields


def _separator(line: str) -> str | None:
    """The separator of a row of numbers; None for blanks."""
    return next((mark for mark in (";", "\t", ",") if mark in line.strip()), None)


def _is_row(line: str) -> bool:
    """Whether all fields of a line are numbers."""
    separator = _separator(line)
    fields = _fields(line, separator)
    if separator in _DECIMAL_COMMA:
        fields = [field.replace(",", ".") for field in fields]
    return bool(line.strip()) and all(NUMBER.fullmatch(field) for field in fields)


def _first_row(
    file: TextFile, expected: str = "the header of a known format (AT2, ESM, K-NET), or rows of numbers"
) -> int:
    """Index of the first row of numbers."""
    for k, line in enumerate(file.head):
        if _is_row(line):
            return k
    shown = next((line.strip() for line in file.head if line.strip()), "blank lines")
    raise file.error(None, shown, expected)


def _table(
    file: TextFile,
    first: int,
    separator: str | None,
    width: int,
    columns: list[int],
    most: int = MAX_SAMPLES,
) -> list[NDArray[np.float64]]:
    """Some columns of all rows; each row has the columns of the first."""
    mark = None if separator is None else separator.encode()
    found = [array("d") for _ in columns]
    for k, raw in file.rows(first):
        lines = [line.replace(b",", b".") for line in raw] if separator in _DECIMAL_COMMA else raw
        # blank lines between rows of several columns are left out: the times show whether a row is missing
        rows = [line.split(mark) for line in lines if line or width == 1]
        try:
            if any(len(row) != width for row in rows):
                raise ValueError("not only whole rows")
            numbers = to_floats([*chain.from_iterable(rows)])
        except ValueError:
            numbers = []
            for j, line in enumerate(lines, k):
                if line or width == 1:
                    numbers += _row(file, j, decoded(line), separator, width, first)
        for values, column in zip(found, columns, strict=True):
            values.extend(numbers[column::width])
        if len(found[0]) > most:
            raise file.error(k, f"more than {most} rows", f"at most {most}")
    return [np.frombuffer(values) for values in found]


def _row(file: TextFile, index: int, line: str, separator: str | None, width: int, first: int) -> list[float]:
    """The numbers of a line."""
    if line.startswith(("#", "%", "!")):  # it may stand for rows that are missing
        raise file.error(index, f"the comment {line}", "comments only above the first row")
    fields = _fields(line, separator)
    if len(fields) != width:
        raise file.error(index, f"{len(fields)} columns", f"{width}, as in line {first + 1}")
    wrong = next((field for field in fields if not NUMBER.fullmatch(field)), None)
    if wrong is not None:
        raise file.error(index, wrong or "an empty field", "a number")
    return [*map(to_float, fields)]


def _column_names(file: TextFile, first: int, separator: str | None, width: int) -> tuple[int | None, list[str]]:
    """Line and names of the columns, from the last header line with as many fields; numbered if there is none."""
    for k in range(first - 1, -1, -1):
        line = file.head[k].strip().lstrip(_COMMENT).strip()
        if separator is None:  # blanks before and in the brackets of a unit separate no columns
            line = _BRACKETS.sub(lambda found: "".join(found[0].split()), line)
        for mark in (separator, ",", ";", "\t"):
            names = [name for name in _fields(line, mark) if name]
            if len(names) == width and not any(re.search(r"[:=]", name) for name in names):
                return k, names
    _check_unnamed(file, first, separator, width)
    return None, [f"column {k + 1}" for k in range(width)]


_BRACKETS = re.compile(r"(?:(?<!\s)\s++)?[(\[][^()\[\]]*+[)\]]")


def _check_unnamed(file: TextFile, first: int, separator: str | None, width: int) -> None:
    """Refuse rows whose last header line, no setting and no comment, names columns in another number.

    Titles are such lines as well. It names columns if it states a unit of times other than seconds, or if it has fewer
    names and commas are decimal signs in all rows of the head.
    """
    k = next((k for k in range(first - 1, -1, -1) if file.head[k].strip()), 0)
    line = file.head[k].strip()
    if k == first or re.search(r"[:=]", line) or line.startswith(tuple("#%!*/")):
        return
    if any(unit_name(text, "s") not in (None, "s") for text in re.findall(r"[(\[]([^()\[\]]*)[)\]]", line)):
        raise file.error(k, line, f"names of {width} columns, as in line {first + 1}")
    rows = [row for row in file.head[first:] if row.strip()]
    if separator == "," and len(_fields(line, ",")) < width and all(map(_DECIMAL_COMMAS.fullmatch, rows)):
        raise file.error(first, file.head[first].strip(), "semicolons or tabs between columns with decimal commas")


_DECIMAL_COMMAS = re.compile(r"\s*+[+-]?\d++,\d++(?:,[+-]?\d++,\d++)*+\s*+")
"""A row that may be of numbers with decimal commas only."""


@dataclass
class _Settings:
    """Unit and time step [s] that the header states, with the indices of their lines."""

    unit: str | None = None
    unit_line: int | None = None
    step: float | None = None
    step_line: int | None = None


def _settings(file: TextFile, first: int) -> _Settings:
    """Settings that header lines state as `key: value` or `key = value`."""
    found = _Settings()
    for k, line in enumerate(file.head[:first]):
        for key, text in _pairs(line):
            name = re.sub(r"[\s_.-]+", " ", key.lower()).strip()
            if re.search(r"\bunits?\b", name):
                unit = parse_unit(text)
                if unit is None:
                    raise file.error(k, text, "a unit of acceleration: m/s2, cm/s2, gal, mm/s2 or g")
                found.unit, found.unit_line = unit, k
            number = re.fullmatch(rf"({NUMBER.pattern})\s*(s|sec|seconds|ms|hz|sps)?\.?", text.strip(), re.I)
            if re.fullmatch(
                r"(dt|delta t|time step|timestep|step|sampling interval|sample interval|delta)( \(?s(ec)?\)?)?", name
            ):
                found.step, found.step_line = _stated_step(file, k, text, number, False), k
            elif re.match(r"(sampling|sample) (rate|frequency)|fs$|frequency", name):
                found.step, found.step_line = _stated_step(file, k, text, number, True), k
    return found


def _pairs(line: str) -> Iterator[tuple[str, str]]:
    """Keys and values of a line such as `station: ABC, dt = 0.01 s unit: g`.

    Between two colons or equals signs are a value and the next key: after a comma or a semicolon, or the last word.
    """
    key, *rest = re.split(r"[:=]", line)
    for k, part in enumerate(rest, 1):
        pieces = re.split(r"[,;]", part)
        if len(pieces) == 1 and k < len(rest):
            pieces = ["", *part.rsplit(None, 1)][-2:]
        name, value = re.split(r"[^\w ()/.-]", key.strip())[-1].lstrip("0123456789 _()/.-"), pieces[0].strip()
        if name and value:
            yield name, value
        key = pieces[-1]


def _stated_step(file: TextFile, line: int, text: str, number: re.Match[str] | None, rate: bool) -> float:
    """The time step [s] of a setting, an interval or a rate."""
    units = ("hz", "sps") if rate else ("s", "sec", "seconds", "ms")
    if number is None or (number[2] or units[0]).lower() not in units:
        raise file.error(line, text, "a rate in Hz" if rate else "a time step in s")
    value = file.positive(line, number[1], "a rate [Hz]" if rate else "a time step [s]")
    return 1.0 / value if rate else value * (1e-3 if (number[2] or "").lower() == "ms" else 1.0)


def _time_column(file: TextFile, first: int, names: list[str], kind: str = "accelerations") -> tuple[int | None, bool]:
    """Index of the column of times, None for one column only, and whether that is certain.

    It is named so, or the first of two and more without names. The first of columns with other names holds times if its
    values increase.
    """
    named = [k for k, name in enumerate(names) if re.match(r"(time|t|zeit|temps|tempo|tiempo)(\b|_|$)", name, re.I)]
    if len(names) == 1:
        if named:
            raise file.error(first, "a column of times only", f"a column of {kind}")
        return None, True
    if len(named) > 1:
        raise file.error(None, f"columns {', '.join(names[k] for k in named)}", "one column of times")
    return named[0] if named else 0, bool(named) or names[0] == "column 1"


def _rises(values: NDArray[np.float64]) -> bool:
    """Whether there are several values, each above the one before."""
    return values.size > 1 and bool((np.diff(values) > 0.0).all())


def _time_factor(file: TextFile, line: int | None, name: str) -> float:
    """Seconds in the unit of the column of times, seconds if its name states none."""
    unit = _stated_unit(file, line, name, "s")
    if unit is None and re.fullmatch(r"[a-z]++[\s_]++[a-z]++\.?", name, re.I):  # such as time h
        raise _no_unit(file, line, name, "s")
    return UNITS["s"][unit or "s"]


def _stated_unit(file: TextFile, line: int | None, name: str, quantity: str) -> str | None:
    """The unit of times or rotations in a column name; None if there is none.

    Raises
    ------
    RecordFileError
        If anything else is in brackets or after a slash.
    """
    unit = _unit_in_name(name, quantity)
    if unit is None and re.search(r"[(\[/]", name):
        raise _no_unit(file, line, name, quantity)
    return unit


def _no_unit(file: TextFile, line: int | None, name: str, quantity: str) -> RecordFileError:
    return file.error(line, f"the column {name}", f"one of the units {', '.join(UNITS[quantity])}")


def _uniform_step(file: TextFile, first: int, times: NDArray[np.float64]) -> float:
    """The step of times that are uniform; the error names the first line that is not."""
    if times.size < 2:
        raise file.error(first, "one row", "at least 2")
    if not np.abs(times).max() <= MAX_TIME:
        raise file.error(None, f"a time of {np.abs(times).max():g} s", f"times up to {MAX_TIME:g} s")
    step = float((times[-1] - times[0]) / (times.size - 1))
    middle = float(np.median(np.diff(times), overwrite_input=True))
    if not (middle > 0.0 and np.isfinite(middle)):
        raise file.error(first + 1, f"times {times[0]:g} and {times[1]:g}", "times that increase")
    off = times[0] + step * np.arange(times.size) - times
    if step > 0.0 and max(off.max(), -off.min()) <= STEP_TOLERANCE * step:
        return float(f"{step:.12g}")  # removes the rounding of the difference
    wrong = int(np.abs(np.diff(times) / middle - 1.0).argmax())
    raise file.error(
        first + wrong + 1, f"a step of {times[wrong + 1] - times[wrong]:g} s", f"uniform steps of {middle:g} s"
    )


def _several(file: TextFile, line: int | None, names: list[str]) -> RecordFileError:
    return file.error(line, f"components {', '.join(names)}", "the argument `component`: one of them")


def _chosen(file: TextFile, line: int | None, names: list[str], columns: list[int], component: str | None) -> int:
    """The column of the component, by name or by the part of the name before the unit."""
    if component is None:
        if len(columns) == 1:
            return columns[0]
        raise _several(file, line, names)
    plain = component.strip().lower()
    whole = [column for column, name in zip(columns, names, strict=True) if name.lower() == plain]
    parts = [
        column for column, name in zip(columns, names, strict=True) if re.split(r"[\s_(\[/]", name.lower())[0] == plain
    ]
    for found in (whole, parts):
        if len(found) == 1:
            return found[0]
    raise file.error(line, f"components {', '.join(names)}", f"component {component}")


def _unit_in_name(name: str, quantity: str = "m/s2") -> str | None:
    """The unit of a quantity in a column name: in brackets, or after a blank, an underscore or a slash."""
    texts = re.findall(r"[(\[]([^()\[\]]*)[)\]]", name)
    if not texts:
        parts = re.split(r"[\s_,]+", name.strip())[-MAX_UNIT_PARTS:]
        texts = [*("".join(parts[k:]) for k in range(len(parts))), name.partition("/")[2]]
    return next((unit for text in texts if (unit := unit_name(text.strip(" ."), quantity))), None)
