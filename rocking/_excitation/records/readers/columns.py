"""Columns of numbers in a stated layout, read by pandas: separators, quotes and decimal signs are its work.

The line below those that are skipped is the header, unless all of it are numbers. A column of the canonical name with
its unit in brackets, such as `time [s]` or `acceleration [g]`, states itself; all else is stated by arguments. What is
missing is asked for, with the first lines of the file.
"""

from __future__ import annotations

import csv
import io
from array import array
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import fields, replace
from itertools import islice
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from rocking._base.arrays import Array
from rocking._base.cells import name_and_unit
from rocking._base.errors import RecordFileError
from rocking._base.units import UNITS, unit_name
from rocking._excitation.records.readers.layout import Column, Layout, Samples, stated_layout
from rocking._excitation.records.readers.text_file import (
    HEAD_LINES,
    MAX_SAMPLES,
    TextFile,
    fortran_widths,
    is_number,
    numbers,
    says_other_quantity,
)

if TYPE_CHECKING:
    import pandas as pd

STEP_TOLERANCE = 0.02
"""Largest deviation of a time from the uniform grid, in steps [-]: times are often rounded to a few digits."""

LARGEST_ROUNDING = 0.3  # largest last place of times, in steps [-]: a missing row is off by more
CELLS_AT_ONCE = 100_000  # cells of a part that pandas reads [-]
SHOWN_LINES, SHOWN_SIGNS = 6, 80  # first lines of a file that a message shows, and signs of each
SIGNS_OF_NUMBERS = frozenset("0123456789+-.ed\"'")
MISSING = {"nan", "na", "n/a", "null", "none", "inf", "-inf"}  # in a row they are refused, and make no header of it


class Quantity(NamedTuple):
    """Quantity that is read from a file: the argument for its column, its canonical names, its SI unit."""

    argument: str
    names: tuple[str, ...]
    unit: str


ACCELERATION = Quantity("acceleration", ("acceleration", "accel", "acc"), "m/s2")
ROTATION = Quantity("rotation", ("rotation",), "rad")
TIME = Quantity("time", ("time",), "s")


class Cell(NamedTuple):
    """A cell of the header: its text, the name in it, and what is in brackets at its end."""

    text: str
    name: str
    bracket: str | None


class Choice(NamedTuple):
    """The columns that are read, from 0, and their units; None: not stated."""

    samples: int | None
    unit: str | None
    time: int | None
    time_unit: str | None


class Table:
    """Header and rows of a file of columns."""

    def __init__(self, file: TextFile, layout: Layout, quantity: Quantity = ACCELERATION) -> None:
        self.file, self.layout, self.quantity = file, layout, quantity
        below = islice(file.lines(layout.skip), HEAD_LINES)
        filled = ((k, line) for k, line in below if line.strip())
        texts = [*islice(filled, 2)]
        has_header = bool(texts) and not is_row(texts[0][1])
        if len(texts) <= has_header:
            raise file.error(None, f"{len(texts)} lines below those of `skip`".replace("`", ""), "rows of numbers")
        self.header_line = texts[0][0] if has_header else None
        self.first, row = texts[has_header]
        self.widths = fortran_widths(layout.delimiter) if layout.delimiter else None
        self.separator = layout.delimiter or self._separator(row, texts[0][1])
        cells = self.cells_of(row)
        self.width = len(cells)
        self.header: list[Cell] = []
        if has_header:
            header = texts[0][1].strip("#% \t")
            names = [header] if self.width == 1 else self._names_of(header)
            if len(names) == self.width - 1 and not cells[-1]:
                names.append("")
            if len(names) == self.width:
                self.header = [_cell(name) for name in names]
        self.title_lines = layout.skip if self.header else self.first

    def _separator(self, row: str, header: str) -> str:
        """Return the one sign between the cells of the first row."""
        parts = row.split('"')
        signs = [sign for sign in ",;\t" if sign in "".join(parts[::2])]
        if self.layout.decimal == "," and len(parts) == 1 and "," in signs:
            signs.remove(",")
        if len(signs) > 1:
            raise self.error(self.first, row.strip(), "the argument `delimiter`, and `decimal` if it is a comma")
        if signs == ["\t"] and "\t" not in header:
            return " "
        return signs[0] if signs else " "

    @property
    def _sign(self) -> str:
        """The sign to which all separators are translated."""
        return " " if " " in self.separator else self.separator[0]

    @property
    def _translation(self) -> dict[int, str]:
        """Other separators, each with that sign."""
        signs = self.separator + ("\t" if self._sign == " " else "")
        return {ord(sign): self._sign for sign in signs if sign != self._sign}

    def cells_of(self, line: str) -> list[str]:
        """Return the cells of a line."""
        if self.widths is not None:
            count, width = self.widths
            cells = [line[k * width : (k + 1) * width] for k in range(count)]
        else:
            line = line.translate(self._translation).strip(" ")
            cells = next(csv.reader([line], delimiter=self._sign, skipinitialspace=True), [])
        cells = [cell.strip() for cell in cells]
        return [cell for cell in cells if cell] if self.widths or self._sign == " " else cells

    def _names_of(self, header: str) -> list[str]:
        """Return the cells of the header; one that starts with a bracket behind a blank belongs to the one before."""
        names: list[str] = []
        for text in self.cells_of(header):
            if names and text[:1] in ("[", "(") and self._sign == " ":
                names[-1] += f" {text}"
            else:
                names.append(text)
        return names

    @property
    def shown(self) -> str:
        """The names of the columns, or their number, for messages."""
        return ", ".join(cell.text for cell in self.header) or f"{self.width} columns without names"

    def check_comma(self) -> None:
        """Refuse rows such as 0,1 without names, which are two columns or one of decimal commas."""
        if self.separator != "," or self.layout.delimiter is not None or self.header:
            return
        for _, line in islice(self.file.lines(self.first), HEAD_LINES):
            if not all(is_number(cell.replace(",", ".", 1)) for cell in line.replace(";", " ").split()):
                return
        expected = 'the argument `delimiter=","` or `decimal=","`: the comma separates columns or decimals'
        raise self.error(self.first, "numbers with one comma", expected)

    def quantity_remarks(self, choice: Choice) -> list[str]:
        """Remarks on titles and the name of the column that contradict `unit`.

        Raises `RecordFileError` where one says velocity, displacement, counts or a spectrum, unless the format is
        stated as well.
        """
        layout = self.layout
        texts: list[tuple[int | None, str]] = [*islice(self.file.lines(0), self.title_lines)]
        cell = _cell("")
        if self.header and choice.samples is not None:
            cell = self.header[choice.samples]
        texts.append((self.header_line, cell.text))
        other = [(k, text.strip()) for k, text in texts if says_other_quantity(text)]
        if other and (layout.format is None or layout.unit is None):
            raise self.file.other_quantity(*other[0])
        unit = UNITS[self.quantity.unit].get(str(layout.unit))
        if unit is not None and cell.bracket is not None and not other:
            in_name = unit_name(cell.bracket, self.quantity.unit)
            if UNITS[self.quantity.unit].get(str(in_name)) != unit:
                other = [(self.header_line, cell.text)]
        remarks = [f"the file says {text}; {layout.unit} is used, as the argument `unit` says" for _, text in other]
        in_name = self._unit(choice.time, TIME)
        if in_name not in (None, choice.time_unit):
            remarks.append(
                f"the times are in {in_name}, says the file; {choice.time_unit} is used, as `time_unit` says"
            )
        return remarks

    # the columns that are stated

    def choice(self) -> Choice:
        """Return the columns and units that the arguments and the header state."""
        samples = self._column(self.layout.acceleration, self.quantity)
        time = self._column(self.layout.time, TIME) if self.layout.time_step is None else None
        unit = self.layout.unit or self._unit(samples, self.quantity)
        return Choice(samples, unit, time, self.layout.time_unit or self._unit(time, TIME))

    def missing(self, choice: Choice) -> list[str]:
        """Return the arguments that are missing."""
        wrapped = self.layout.wrapped
        missing = []
        if not wrapped and choice.samples is None:
            missing.append(self.quantity.argument)
        if choice.time is None and self.layout.time_step is None:
            missing.append("time_step" if wrapped or self.width == 1 else "time")
        elif choice.time is not None and choice.time_unit is None:
            missing.append("time_unit")
        named = [k for k in range(len(self.header)) if self._unit(k, self.quantity)]
        is_stated = choice.unit is not None or (choice.samples is None and bool(named))
        return missing if is_stated else [*missing, "unit"]

    def check_stated(self, choice: Choice) -> None:
        """Refuse a file whose layout is not stated: what is missing, and what there is to choose from."""
        missing = self.missing(choice)
        quantity = self.quantity
        texts = {
            quantity.argument: f"`{quantity.argument}` (a column: its name, or its number from 1)",
            "time": "`time` (a column) or `time_step`",
            "time_step": "`time_step`",
            "time_unit": f"`time_unit` ({', '.join(UNITS['s'])})",
            "unit": f"`unit` ({', '.join(UNITS[quantity.unit])})",
        }
        if missing:
            expected = "the argument " + " and ".join(texts[name] for name in missing)
            if quantity is ACCELERATION and self.width > 2 and not (self.header or self.layout.wrapped):
                expected += "; or `wrapped=True` if the rows are one series"
            line = self.first if self.header_line is None else self.header_line
            raise self.error(line, self.shown, expected, missing)
        if choice.samples is not None and choice.samples == choice.time:
            raise self.error(None, "one column", f"different columns for `time` and `{quantity.argument}`")
        self.check_comma()
        wrong = [cell.text for cell in self.header if "." in cell.text and is_number(cell.text)]
        if wrong:
            raise self.error(self.header_line, f"{wrong[0]} among names", "names, or numbers only", [])
        lines = (line for _, line in self.file.lines(self.first) if line.strip())
        rows = [self.cells_of(line) for line in islice(lines, 0 if self.layout.wrapped else 2)]
        for column in zip(*rows, strict=False):
            words = [cell for cell in column if cell and not is_number(cell.replace(",", "."))]
            if len(rows) == 2 and words == [column[0]] and column[1] != column[0]:
                expected = "a number, as below it; or another number of lines in `skip`"
                raise self.error(self.first, column[0], expected, [])

    def _column(self, argument: Column | None, quantity: Quantity) -> int | None:
        """Return the column of an argument, or of a canonical name."""
        if isinstance(argument, int):
            if argument > self.width:
                raise self.error(self.first, self.shown, f"column {argument}, as `{quantity.argument}` says", [])
            return argument - 1
        names = quantity.names if argument is None else (argument.strip().lower(),)
        named = [k for k, cell in enumerate(self.header) if {cell.name.lower(), cell.text.lower()} & {*names}]
        if argument is None:
            # a canonical name states nothing beside other columns in such units or, without a unit, beside any other
            other_columns = [
                k for k, cell in enumerate(self.header) if cell.name.lower() not in (*TIME.names, "vertical")
            ]
            alike = [k for k in other_columns if self._unit(k, quantity)]
            alone = quantity is TIME or named in (other_columns, alike)
            return named[0] if len(named) == 1 and alone else None
        if len(named) == 1:
            return named[0]
        if not named and names[0].isdecimal() and 0 < int(names[0][:5]) <= self.width:
            return int(names[0][:5]) - 1
        raise self.error(self.header_line, self.shown, f"one column {argument} for `{quantity.argument}`", [])

    def _unit(self, column: int | None, quantity: Quantity) -> str | None:
        """Return the unit in brackets in the name of a column."""
        bracket = self.header[column].bracket if self.header and column is not None else None
        return None if bracket is None else unit_name(bracket, quantity.unit)

    # the rows

    def series(self) -> Array:
        """Read all values, row by row; rows but the last are of one length."""
        values = array("d")
        short = None
        for k, line in self.file.lines(self.first):
            cells = self.cells_of(line)
            if cells and (short is not None or len(cells) > self.width):
                expected = f"{self.width} in each line but the last"
                raise self.error(k if short is None else short, "another number of cells", expected)
            if 0 < len(cells) < self.width:
                short = k
            if len(values) > MAX_SAMPLES:
                raise self.file.error(k, f"more than {MAX_SAMPLES} values", f"at most {MAX_SAMPLES}")
            values.extend(self._numbers(cells, lambda _, line=k: line))  # type: ignore[misc]
        return self.file.checked(np.frombuffer(values))

    def columns(self, indices: list[int], *, times: bool) -> list[Array]:
        """Read some columns; without `times` that show whether a row is missing, no line between the rows is blank."""
        arrays = [array("d") for _ in indices]
        rows = 0
        for frame in self._frames():
            short = frame.iloc[:, -1].isna().to_numpy()
            if self._sign == " " and short.any():
                expected = f"{self.width} cells, as in line {self.first + 1}"
                raise self.error(self.line_of(rows + int(short.argmax())), "fewer cells", expected)
            for values, column in zip(arrays, indices, strict=True):
                values.extend(self._numbers(frame.iloc[:, column].tolist(), lambda k, row=rows: self.line_of(row + k)))  # type: ignore[misc]
            rows += len(frame)
            if rows > MAX_SAMPLES:
                raise self.file.error(None, f"more than {MAX_SAMPLES} rows", f"at most {MAX_SAMPLES}")
        self._check_lines(rows, times)
        return [np.frombuffer(values) for values in arrays]

    def _frames(self) -> Iterator[pd.DataFrame]:
        """Yield parts of the rows as texts."""
        import pandas as pd  # noqa: PLC0415  # other commands and the rules of a workflow start without it

        start = 0
        for _ in range(self.first):
            start = self.file.content.index(b"\n", start) + 1
        body = self.file.content[start:]
        if self.widths is not None:
            body = "\n".join(",".join(self.cells_of(line)) for _, line in self.file.lines(self.first)).encode()
        elif self._translation:
            separators = bytes(self._translation)
            body = body.translate(bytes.maketrans(separators, self._sign.encode() * len(separators)))
        sign = "," if self.widths is not None else self._sign
        options: dict[str, Any] = {"sep": r"\s+" if sign == " " else sign, "header": None, "skipinitialspace": True}
        options |= {"dtype": object, "keep_default_na": False, "chunksize": max(1, CELLS_AT_ONCE // self.width)}
        try:
            with pd.read_csv(io.BytesIO(body), **options) as reader:
                for frame in reader:
                    if self.file.stop is not None:
                        self.file.stop.check()
                    yield frame
        except pd.errors.ParserError as error:
            for k, line in self.file.lines(self.first):
                cells = len(self.cells_of(line))
                if cells > self.width:
                    expected = f"{self.width} cells, as in line {self.first + 1}"
                    raise self.error(k, f"{cells} cells", expected) from None
            raise self.file.error(None, str(error).strip(), "rows that pandas can read") from None

    def _numbers(self, texts: list[Any], line_of: Callable[[int], int]) -> list[float]:
        """Read the numbers of some cells; `line_of` gives the line of one that is wrong."""
        cells = [text.rstrip() if isinstance(text, str) else "" for text in texts]
        if self.layout.decimal == ",":  # a dot beside it is no number
            cells = [cell.replace(".", "?").replace(",", ".") for cell in cells]
        with suppress(ValueError):
            values = numbers(cells)
            if np.isfinite(values).all():
                return values
        wrong = next(k for k, cell in enumerate(cells) if not (is_number(cell) and np.isfinite(numbers([cell]))))
        text = str(texts[wrong]) if cells[wrong] else "an empty cell"
        expected = "a number"
        if self.layout.decimal == "." and is_number(text.replace(",", ".")):
            expected = 'a number; or `decimal=","`'
        elif text.count(".") > 1 and is_row(text):
            expected = 'a number; or, where numbers touch, their format, such as `delimiter="8f9.6"`'
        raise self.error(line_of(wrong), text, expected)

    def line_of(self, row: int) -> int:
        """Return the line of a row: rows are the lines that are not blank."""
        lines = (k for k, line in self.file.lines(self.first) if line.strip())
        return next(islice(lines, row, None), self.first)

    def _check_lines(self, rows: int, times: bool) -> None:
        """Refuse a blank line between rows without times, and quotes that join several lines to one row."""
        blank = None
        count = 0
        for k, line in self.file.lines(self.first):
            if not line.strip():
                blank = k if blank is None else blank
                continue
            if blank is not None and not times:
                expected = "rows up to the end: cut the file here if another block follows, or take the blank lines out"
                raise self.error(blank, "a blank line between the rows", expected)
            count += 1
        if count != rows:
            raise self.file.error(None, f"{count} lines that are {rows} rows", "quotes that are closed on their line")

    # messages

    def error(self, line: int | None, found: str, expected: str, missing: list[str] | None = None) -> RecordFileError:
        """Return an error with the first lines of the file, and with arguments where `missing` ones can be said."""
        head = self.file.head[:SHOWN_LINES]
        lines = [f"line {k + 1}: {text[:SHOWN_SIGNS]}" for k, text in enumerate(head)]
        call = None if missing is None else self._call(missing)
        return RecordFileError(self.file.name, None if line is None else line + 1, found, expected, lines, call)

    def _call(self, missing: list[str]) -> dict[str, Any] | None:
        """Return arguments that would read the file; `...` for what cannot be said."""
        call: dict[str, Any] = {}
        for field in fields(self.layout):
            value = getattr(self.layout, field.name)
            if value != field.default:
                call[self.quantity.argument if field.name == "acceleration" else field.name] = value
        skip, missing = self._lines_above(missing)
        call |= {"skip": skip} if skip else {}
        return call | dict.fromkeys(missing, ...) if skip or missing else None

    def _lines_above(self, missing: list[str]) -> tuple[int, list[str]]:
        """Return the number of lines above the names or rows, 0 for what is stated, and what is missing beside it."""
        head = self.file.head
        for skip in range(1, len(head) - 1) if self.layout.skip == 0 else ():
            with suppress(RecordFileError):
                below = Table(self.file, replace(self.layout, skip=skip), self.quantity)
                if below.header_line == skip and not below.missing(below.choice()):
                    return skip, []
        counts = [len(line.replace(",", " ").replace(";", " ").split()) for line in head]
        start = len(counts)
        while start and is_row(head[start - 1]) and counts[start - 1] == counts[-1]:
            start -= 1
        if self.layout.skip or start <= self.first or len(counts) - start < 3:
            return 0, missing
        return (start - 1 if counts[start - 1] == counts[-1] else start), missing


def read(file: TextFile, layout: Layout) -> Samples:
    """Read the acceleration in the columns of a file."""
    table = Table(file, layout)
    choice = table.choice()
    remarks = table.quantity_remarks(choice)
    table.check_stated(choice)
    name = file.name.rsplit(".", 1)[0]
    step = layout.time_step
    if choice.samples is None:
        values = table.series()
        text = "one series row by row"
    else:
        indices = [choice.samples] if choice.time is None else [choice.samples, choice.time]
        values, *times = table.columns(indices, times=choice.time is not None)
        file.checked(values)
        if times:
            step = uniform_step(table, times[0] * UNITS["s"][str(choice.time_unit)])
        text = f"column {choice.samples + 1}"
        if table.header:
            text += f", {table.header[choice.samples].text}"
            if layout.acceleration is not None:
                name += f" {table.header[choice.samples].name}"
    source = f"{file.name} ({text}, from line {table.first + 1})"
    return Samples(values, float(step or 0.0), str(choice.unit), name, source, remarks)


def read_rotations(file: TextFile, limit: int, **arguments: Any) -> tuple[Array, Array]:
    """Read times [s] and rotations [rad] of a trace, at most `limit` rows.

    `arguments` are those of `read_record` about columns, with `rotation` for the column, in `unit`, rad, deg or mrad.
    """
    layout = stated_layout(("columns",), "rad", "rotation", **arguments)
    with file.guarded("columns"):
        table = Table(file, layout, ROTATION)
        choice = table.choice()
        table.check_stated(choice)
        indices = [column for column in (choice.samples, choice.time) if column is not None]
        values, *times = table.columns(indices, times=choice.time is not None)
        if values.size > limit:
            raise file.error(None, f"{values.size} rows", f"at most {limit}")
        if times:
            seconds = times[0] * UNITS["s"][str(choice.time_unit)]
        else:
            seconds = np.arange(values.size, dtype=np.float64) * float(layout.time_step or 0.0)
        return seconds, values * UNITS["rad"][str(choice.unit)]


def uniform_step(table: Table, times: Array) -> float:
    """Return the step [s] of times that are uniform to 2 % of a step, or as far as their last decimal says.

    The error names the first line that is not.
    """
    steps = np.diff(times)
    middle = float(np.median(steps))
    if not (middle > 0.0 and np.isfinite(middle)):
        raise table.error(table.first, f"times {times[0]:g} and {times[1]:g}", "times that increase")
    step = float(times[-1] - times[0]) / steps.size
    digits = 0
    while digits < 9 and not np.allclose(times * 10.0**digits, np.round(times * 10.0**digits), rtol=1e-15, atol=1e-6):
        digits += 1
    decimal = 10.0**-digits  # the last decimal of the times [s]
    rounding = 1.001 * decimal if decimal <= LARGEST_ROUNDING * step else 0.0
    deviation = float(np.abs(times[0] + step * np.arange(times.size) - times).max())
    if not (step > 0.0 and deviation <= max(STEP_TOLERANCE * step, rounding)):
        wrong = int(np.abs(steps / middle - 1.0).argmax())
        expected = (
            f"uniform steps of {middle:g} s: interpolate the samples to uniform times; or `time_step`, if the samples "
            "are uniform and the times are not"
        )
        raise table.error(table.line_of(wrong + 1), f"a step of {steps[wrong]:g} s", expected)
    if deviation > 0.01 * decimal and decimal > 1e-3 * step * steps.size:
        expected = "times with more decimals, or the argument `time_step`"
        raise table.error(table.first, f"times rounded to {decimal:g} s, about {step:.3g} s apart", expected)
    return float(f"{step:.12g}")  # removes the rounding of the difference


def is_row(line: str) -> bool:
    """True if all of a line are numbers, or stand for missing ones, whatever separates them."""
    words = line.replace(",", " ").replace(";", " ").lower().split()
    numeric = (word in MISSING or SIGNS_OF_NUMBERS.issuperset(word) for word in words)
    return any(map(str.isdecimal, line)) and all(numeric)


def _cell(text: str) -> Cell:
    return Cell(" ".join(text.split()), *name_and_unit(text))
