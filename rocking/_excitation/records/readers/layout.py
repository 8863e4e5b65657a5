"""Layout of a file, as the arguments of `read_record` state it, and the samples that a reader returns."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any, NamedTuple

from rocking._base.arrays import Array
from rocking._base.errors import InvalidArgumentError, integer, number, one_of
from rocking._base.units import UNITS, unit_name
from rocking._excitation.records.readers.text_file import TextFile, fortran_widths
from rocking._excitation.records.record import TIME_STEP

MAX_SKIP = 10_000  # most lines above the samples
SEPARATORS = {",": ",", ";": ";", "\t": "\t", " ": " ", "comma": ",", "semicolon": ";", "tab": "\t", "blank": " "}
"""Separators of cells, as a sign or a word; a blank stands for any number of blanks and tabs."""

Column = str | int
"""A column or channel: its name, or its number from 1."""


class Samples(NamedTuple):
    """Result of a reader: values in a unit, step [s], texts and remarks for the record."""

    values: Array
    step: float
    unit: str
    name: str
    source: str
    remarks: list[str]


@dataclass(frozen=True, kw_only=True)
class Layout:
    """The arguments of `read_record` of the same names; None: not stated."""

    format: str | None = None
    acceleration: Column | None = None
    time: Column | None = None
    time_step: float | None = None
    time_unit: str | None = None
    unit: str | None = None
    skip: int = 0
    delimiter: str | None = None
    decimal: str = "."
    wrapped: bool = False

    def agreed_unit(self, in_file: str | None, remarks: list[str]) -> str | None:
        """Return the unit that is stated, else the one in the file; add a remark if they differ."""
        if self.unit is None or in_file is None:
            return self.unit or in_file
        if UNITS["m/s2"][self.unit] != UNITS["m/s2"].get(in_file):
            remarks.append(f"the file states the unit {in_file}; {self.unit} is used, as the argument `unit` says")
        return self.unit

    def agreed_step(self, in_file: float | None, remarks: list[str]) -> float | None:
        """Return the time step [s] that is stated, else the one in the file; add a remark if they differ."""
        if self.time_step is None or in_file is None:
            return self.time_step or in_file
        if abs(self.time_step / in_file - 1.0) > 1e-3:
            remarks.append(
                f"the file states a time step of {in_file:g} s; {self.time_step:g} s is used, as the argument "
                "`time_step` says"
            )
        return self.time_step

    def refuse_columns(self, file: TextFile, kind: str, *, channels: bool = False) -> None:
        """Refuse what is stated about columns beside a named format."""
        for field in fields(self):
            if field.name in ("format", "time_step", "unit") or (channels and field.name == "acceleration"):
                continue
            value = getattr(self, field.name)
            if value != field.default:
                expected = f'nothing about columns in a file of {kind}; or `format="columns"`, to read it as columns'
                raise file.error(None, f"{field.name} {value!r} beside {kind}", expected)


def stated_layout(
    formats: tuple[str, ...], quantity: str = "m/s2", column: str = "acceleration", **arguments: Any
) -> Layout:
    """Check arguments; errors name them. `column` is the argument of the column of samples, in `quantity`."""
    samples = arguments.pop(column, None)
    layout = Layout(acceleration=samples, **arguments)
    names = {"kik-net": "K-NET"} | {name.casefold(): name for name in formats}
    if layout.time is not None and layout.time_step is not None:
        raise InvalidArgumentError("time_step", layout.time_step, "either a column of times or a time step")
    if layout.wrapped and (samples is not None or layout.time is not None):
        raise InvalidArgumentError("wrapped", True, "no columns beside it: all values are one series, row by row")
    if layout.format is not None and str(layout.format).casefold() not in names:
        raise InvalidArgumentError("format", layout.format, f"one of {', '.join(formats)}")
    return Layout(
        format=names.get(str(layout.format).casefold()),
        acceleration=_column(column, samples),
        time=_column("time", layout.time),
        time_step=None if layout.time_step is None else number("time_step", layout.time_step, *TIME_STEP, unit="s"),
        time_unit=_unit("time_unit", layout.time_unit, "s"),
        unit=_unit("unit", layout.unit, quantity),
        skip=integer("skip", layout.skip, 0, MAX_SKIP),
        delimiter=_delimiter(layout.delimiter),
        decimal=one_of("decimal", layout.decimal, (".", ",")),
        wrapped=bool(layout.wrapped),
    )


def _column(parameter: str, value: Any) -> Column | None:
    if value is None or (isinstance(value, str) and value.strip()):
        return value
    if isinstance(value, str | bool):
        raise InvalidArgumentError(parameter, value, "the name of a column, or its number from 1")
    return integer(parameter, value, 1, 10_000)


def _unit(parameter: str, value: Any, quantity: str) -> str | None:
    if value is None:
        return None
    name = unit_name(value, quantity) if isinstance(value, str) else None
    return name or one_of(parameter, value, UNITS[quantity])


def _delimiter(value: Any) -> str | None:
    """Return the signs that separate cells, or the Fortran format of numbers of fixed width."""
    if value is None or value in SEPARATORS:
        return value and SEPARATORS[value]
    signs = str(value).replace("\\s", " ").replace("\\t", "\t").strip("[]+")  # as pandas has them, such as \s+
    if signs and set(signs) <= set(",;\t "):
        return signs
    allowed = (
        "comma, semicolon, tab or blank, or these signs; several signs such as ',;' if each separates; or a Fortran "
        "format such as 8f10.6 for numbers of fixed width"
    )
    try:
        if fortran_widths(str(value)):
            return str(value)
    except ValueError as error:
        allowed = str(error)
    raise InvalidArgumentError("delimiter", value, allowed)
