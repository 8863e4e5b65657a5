"""Tables of objects and of blocks in a stated layout: CSV text, or a sheet of a workbook through pandas.

The first line is the header: canonical names of quantities, whose case, blanks and underscores do not matter, each with
its unit in brackets or in its cells. `TableLayout` states another layout. What is not stated is not read: a row is
refused with all its reasons, and columns of other names are kept as they stand.
"""

from __future__ import annotations

import csv
import io
import math
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, Generic, NamedTuple, TypeVar

from rocking._base.cells import Cell, is_empty, name_and_unit, plain_name, read_cell, text_of_cell
from rocking._base.errors import InvalidArgumentError, SeveralArgumentsError, TableFileError, UnreadableFileError
from rocking._base.quantity import Quantity
from rocking._base.units import UNITS, unit_name
from rocking._excitation.records.readers.layout import SEPARATORS

if TYPE_CHECKING:
    from rocking._numba.cancellation import StopFlag  # numba takes longer to load than a table

Item = TypeVar("Item")

SHEETS = (".xlsx", ".ods")  # endings of files that are not text
MAX_CHARACTERS = 20_000_000  # longest table that is read
MAX_COLUMNS = 1000  # most columns of a table
SHEET_CELLS = 1_000_000  # most cells of a sheet: one far out makes all
SHOWN_LINES, SHOWN_SIGNS = 6, 120  # first lines of a file that a message shows, and signs of each
LINES_ABOVE = 12  # lines above a header that a message proposes to skip
EXTENTS = ("width", "depth", "diameter", "height")
SIZE_RANGE = 0.01, 50.0  # sizes of an object that are read without a question [m]
UNUSED = "unused"  # what `columns` maps a column to that is not read


class TooManyRowsError(InvalidArgumentError):
    """A table has more rows than the caller allows; no item was made."""


@dataclass(frozen=True, kw_only=True)
class TableLayout:
    """What the user states about a table.

    Attributes
    ----------
    columns : mapping of str to str
        The header that stands for another one: {"Breite (cm)": "width [cm]"}; "unused" for a column that is not read.
    decimal : {".", ","}
        Decimal sign of texts.
    delimiter : str, optional
        Sign between the cells; it is needed where the header has several of comma, semicolon and tab.
    skip : int
        Lines above the header.
    sheet : str, optional
        Name of the sheet of a workbook; it is needed where several hold cells.
    allow_unusual : bool
        True to read objects below 1 cm or above 50 m.
    """

    columns: Mapping[str, str] = field(default_factory=dict)
    decimal: str = "."
    delimiter: str | None = None
    skip: int = 0
    sheet: str | None = None
    allow_unusual: bool = False

    def __post_init__(self) -> None:
        if self.decimal not in (".", ","):
            raise InvalidArgumentError("decimal", self.decimal, "'.' or ','")
        if self.delimiter is not None and self.delimiter not in SEPARATORS:
            raise InvalidArgumentError("delimiter", self.delimiter, f"one of {', '.join(map(repr, SEPARATORS))}")


def stated_columns(texts: Iterable[str]) -> dict[str, str]:
    """The argument `columns` from texts such as "Breite (cm)=width [cm]"."""
    columns: dict[str, str] = {}
    for text in texts:
        label, _, header = (part.strip() for part in text.rpartition("="))
        if not label or label in columns:
            raise InvalidArgumentError("columns", text, 'HEADER=NAME, each header once: "Breite (cm)=width [cm]"')
        columns[label] = header
    return columns


class Row(NamedTuple):
    """A row of a table whose cells could be read."""

    number: int  # in the table, from 1
    values: dict[str, Any]  # by quantity: numbers in SI units, texts
    cells: dict[str, Cell]  # all of them as they stand, by header
    unread: dict[str, Cell]  # those of the columns that are not read


@dataclass(frozen=True)
class Schema(Generic[Item]):
    """What a table holds."""

    argument: str  # what errors call the table
    quantities: tuple[Quantity, ...]  # what is read; other columns are kept as they stand
    required: tuple[tuple[str, ...], ...]  # each row has a value of one of each group
    make: Callable[[Row], Item]  # raises `InvalidArgumentError` with the name of a quantity
    needs_depth: bool = False  # True to ask what a length is that is not read where no column is the depth


@dataclass(frozen=True)
class BadRow:
    """A row that was not read, with all reasons."""

    row: int  # its number in the table, from 1
    errors: list[InvalidArgumentError]  # the parameter is the quantity, "row" for the whole row
    cells: dict[str, Cell] = field(default_factory=dict)  # as they stand, by header

    @property
    def columns(self) -> list[str]:
        """The quantities that could not be read."""
        return [error.parameter for error in self.errors]

    @property
    def reasons(self) -> list[str]:
        """Each value that was not read, and what is allowed."""
        return [
            f"{error.parameter}: {'missing' if error.value is None else repr(error.value)}; allowed: {error.allowed}"
            for error in self.errors
        ]

    def __str__(self) -> str:
        return f"row {self.row}, {', '.join(self.reasons)}"


@dataclass(frozen=True)
class Table(Generic[Item]):
    """The rows of a table."""

    items: list[Item] = field(default_factory=list)  # one for each row that was read
    cells: dict[str, list[Cell]] = field(default_factory=dict)  # of these rows as they stand, by header
    columns: dict[str, str] = field(default_factory=dict)  # canonical header of each column that is read, by header
    bad_rows: list[BadRow] = field(default_factory=list)
    remarks: list[str] = field(default_factory=list)  # where `columns` and the header differ

    @property
    def skipped(self) -> list[str]:
        """The columns that are not read."""
        return [label for label in self.cells if label not in self.columns]

    @property
    def reading(self) -> str:
        """How each column was read, and which columns were not, in words."""
        if not self.columns:
            return ""
        read = ", ".join(f"{label} as {header}" for label, header in self.columns.items())
        unread = f"; not read: {', '.join(self.skipped)}" if self.skipped else ""
        return "; ".join([f"columns read: {read}{unread}", *self.remarks])


class Column(NamedTuple):
    """A column: its header as it stands, with its number where that is empty or not the first; what is read of it."""

    label: str
    quantity: Quantity | None
    unit: str  # "" where the cells state it

    @property
    def name(self) -> str:
        """The name of the quantity, "" of a column that is not read."""
        return "" if self.quantity is None else self.quantity.name

    @property
    def header(self) -> str:
        """The canonical header."""
        return f"{self.name} [{self.unit}]" if self.unit else self.name


@dataclass(frozen=True)
class TableFile:
    """The rows of a file from its header on, in a stated layout."""

    schema: Schema[Any]
    name: str  # of the file
    layout: TableLayout
    first: int  # number of the row of the header, from 1
    rows: Iterable[Sequence[Cell]]  # the header, and what is below
    head: Sequence[str]  # first lines of the file
    lines: Sequence[str] = ()  # of CSV text from the header on, with their ends
    delimiter: str = ""  # sign between the cells of CSV

    def error(
        self, line: int | None, found: str, expected: str, call: Mapping[str, Any] | None = None
    ) -> TableFileError:
        """An error with the first lines of the file, and arguments that would read it where they can be said."""
        lines = [f"line {k}: {text[:SHOWN_SIGNS]}" for k, text in enumerate(self.head[:SHOWN_LINES], start=1)]
        return TableFileError(self.schema.argument, self.name, line, found, expected, lines, call)


def read_bytes(source: str | PathLike[str], argument: str) -> bytes:
    """The content of a file; `-` is standard input."""
    try:
        return sys.stdin.buffer.read() if source == "-" else Path(source).read_bytes()
    except OSError as error:
        raise UnreadableFileError(argument, str(source), error) from None


def text_of(raw: bytes, argument: str) -> str:
    """A text of UTF-8, UTF-16 with its mark, or the code page of older spreadsheets; binary content is refused."""
    is_utf16 = raw[:2] in (b"\xff\xfe", b"\xfe\xff")
    if b"\0" in raw and not is_utf16:
        raise InvalidArgumentError(argument, "binary content", "text, or a sheet whose name ends in .xlsx or .ods")
    try:
        return raw.decode("utf-16" if is_utf16 else "utf-8-sig")
    except UnicodeDecodeError:
        return raw.decode("cp1252", "replace")


def read_table_file(source: str | PathLike[str], schema: Schema[Item], layout: TableLayout) -> Table[Item]:
    """A table from a file: a workbook (.xlsx, .ods), or CSV with any other ending; `-` is standard input."""
    raw = read_bytes(source, schema.argument)
    path = Path(source)
    if path.suffix.lower() not in SHEETS:
        return read_rows(open_text(text_of(raw, schema.argument), path.name, schema, layout), schema)
    rows = rows_of_sheet(raw, schema.argument, layout.sheet)
    texts = ["; ".join(map(text_of_cell, row)) for row in rows]
    first = _header_line(texts, layout)
    return read_rows(TableFile(schema, path.name, layout, first + 1, rows[first:], texts), schema)


def open_text(
    text: str, name: str, schema: Schema[Any], layout: TableLayout, stop: StopFlag | None = None
) -> TableFile:
    """The rows of CSV text. `stop` cancels the work."""
    if len(text) > MAX_CHARACTERS:
        raise InvalidArgumentError(schema.argument, f"{len(text)} characters", f"at most {MAX_CHARACTERS}")
    lines = io.StringIO(text.removeprefix("\ufeff"), newline="").readlines()
    first = _header_line(lines, layout)
    file = TableFile(schema, name, layout, first + 1, (), [line.rstrip("\r\n") for line in lines[:LINES_ABOVE]])
    header = "".join(lines[first : first + 1])
    signs = [sign for sign in ",;\t" if sign in "".join(header.split('"')[::2])]
    if len(signs) > 1 and layout.delimiter is None:
        raise file.error(first + 1, header.strip(), "the argument `delimiter`: the header has several signs")
    delimiter = SEPARATORS[layout.delimiter] if layout.delimiter else [*signs, ","][0]
    rows = _csv_rows(file, lines[first:], delimiter, stop)
    return replace(file, rows=rows, lines=lines[first:], delimiter=delimiter)


def _header_line(lines: Sequence[str], layout: TableLayout) -> int:
    """The place of the first line below `skip` that is neither blank nor a comment."""
    for place, line in enumerate(lines):
        text = line.lstrip('"')
        if place >= layout.skip and any(map(str.isalnum, text)) and not text.startswith("# "):
            return place
    return len(lines)


def _csv_rows(file: TableFile, lines: Sequence[str], delimiter: str, stop: StopFlag | None) -> Iterator[list[str]]:
    """The rows by the standard library, which refuses quotes that are not closed, as pandas does not."""
    reader = csv.reader(lines, delimiter=delimiter, strict=True)
    line = file.first
    try:
        for row in reader:
            if stop is not None:
                stop.check()
            yield row
            line = file.first + reader.line_num
    except csv.Error as error:
        expected = "cells that are in quotes as a whole or not at all, with each inner quote doubled"
        raise file.error(line, str(error), expected) from None


def rows_of_sheet(raw: bytes, argument: str, sheet: str | None = None) -> list[list[Cell]]:
    """The cells of a sheet; numbers are numbers."""
    import pandas as pd  # noqa: PLC0415  (takes long to load, and only sheets need it)

    try:
        with pd.ExcelFile(io.BytesIO(raw), engine="calamine") as file:
            book = file.book
            areas = {name: book.get_sheet_by_name(name) for name in file.sheet_names}
            names = [sheet] if sheet is not None else [name for name in areas if areas[name].total_height]
            if len(names) != 1 or names[0] not in areas:
                raise InvalidArgumentError(
                    "sheet", sheet, f"the argument `sheet`, one of: {', '.join(map(str, areas))}"
                )
            rows, columns = areas[names[0]].total_height, areas[names[0]].total_width
            if columns > MAX_COLUMNS or rows * columns > SHEET_CELLS:
                allowed = f"at most {MAX_COLUMNS} columns and {SHEET_CELLS} cells"
                raise InvalidArgumentError(argument, f"a sheet of {rows} rows and {columns} columns", allowed)
            frame = pd.read_excel(file, sheet_name=names[0], header=None, dtype=object, na_filter=False)
    except ImportError as error:
        raise ImportError("sheets need the extra `sheets`: pip install 'rocking[sheets]'", name=error.name) from None
    except (InvalidArgumentError, MemoryError):
        raise
    except Exception as error:  # noqa: BLE001  (the reader of sheets has its own errors)
        raise InvalidArgumentError(argument, str(error), "a sheet of a spreadsheet, .xlsx or .ods") from None
    return [list(map(_sheet_cell, row)) for row in frame.to_numpy().tolist()]


def _sheet_cell(value: object) -> Cell:
    if value is None or value != value:
        return ""
    if isinstance(value, int | float) and not isinstance(value, bool):
        return value
    return str(value).removesuffix(" 00:00:00")  # a date


def csv_of_sheet(raw: bytes, argument: str, sheet: str | None = None, decimal: str = ".") -> str:
    """The cells of a sheet as CSV text; its numbers have this decimal sign, its texts are as they stand."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    for row in rows_of_sheet(raw, argument, sheet):
        writer.writerow(cell if isinstance(cell, str) else text_of_cell(cell).replace(".", decimal) for cell in row)
    return text.getvalue()


def labels_of(cells: Sequence[Cell]) -> list[str]:
    """The texts of a header, with the number of the column where one is empty or not the first."""
    labels: list[str] = []
    for number, cell in enumerate(cells, start=1):
        text = text_of_cell(cell).strip()
        labels.append(text if text and text not in labels else f"{text}#{number}")
    return labels


def columns_of(file: TableFile, cells: Sequence[Cell]) -> tuple[list[Column], list[str]]:
    """The columns of a header, each quantity at most once, and remarks where `columns` and the header differ."""
    if len(cells) > MAX_COLUMNS:
        raise file.error(file.first, f"{len(cells)} columns", f"at most {MAX_COLUMNS}")
    quantities = {plain_name(quantity.name): quantity for quantity in file.schema.quantities}
    stated = {" ".join(label.split()): text for label, text in file.layout.columns.items()}
    labels = labels_of(cells)
    for label in stated.keys() - {" ".join(label.split()) for label in labels}:
        raise InvalidArgumentError("columns", label, f"a header of the table: {'; '.join(labels)[:300]}")
    columns: list[Column] = []
    remarks: list[str] = []
    for label in labels:
        text = stated.get(" ".join(label.split()))
        name, bracket = name_and_unit(label if text is None else text)
        quantity = quantities.get(plain_name(name))
        if text is not None and quantity is None and plain_name(text) != UNUSED:
            allowed = f"{', '.join(q.name for q in file.schema.quantities)}, with a unit in brackets; or {UNUSED}"
            raise InvalidArgumentError("columns", f"{label}={text}", allowed)
        if quantity is None or not quantity.unit:
            columns.append(Column(label, quantity if bracket is None else None, ""))
            continue
        in_header = name_and_unit(label)[1]
        written = in_header if bracket is None else bracket
        unit = unit_name(written, quantity.unit) if written else ""
        if unit is None:
            units = ", ".join(f"[{key}]" for key in UNITS[quantity.unit])
            raise file.error(file.first, label, f"one of {units}; or `columns`, which states what the column is")
        if quantity.name in (column.name for column in columns):
            raise file.error(
                file.first, label, f"one column {quantity.name}; state `columns` for another one: {UNUSED}"
            )
        if text is not None and in_header and unit_name(in_header, quantity.unit) not in (unit, None):
            remarks.append(f"the header says {label}; {text} is read, as `columns` says")
        columns.append(Column(label, quantity, unit))
    return columns, remarks


def missing_groups(columns: Sequence[Column], schema: Schema[Any]) -> list[str]:
    """The quantities that the header lacks, one of each group."""
    names = {column.name for column in columns}
    return [" or ".join(group[:2]) for group in schema.required if names.isdisjoint(group)]


def _check_header(file: TableFile, columns: Sequence[Column]) -> None:
    """Refuse a header that lacks a quantity, or leaves open which column is the depth."""
    missing = missing_groups(columns, file.schema)
    if missing:
        expected = f"a column {' and a column '.join(missing)}, each with its unit in brackets; where a column has"
        expected += " another header, state it by `columns`, such as HEADER=width [cm]"
        labels = "; ".join(column.label for column in columns)
        raise file.error(file.first, labels or "nothing", expected, _lines_above(file))
    names = {column.name for column in columns}
    if not file.schema.needs_depth or not names.isdisjoint(("depth", "diameter", "left", "body", "vertices")):
        return
    for column in columns:
        bracket = name_and_unit(column.label)[1]
        if not column.name and column.label not in file.layout.columns and bracket and unit_name(bracket, "m"):
            expected = "a column depth or diameter; state by `columns` what this one is: depth, diameter, another"
            raise file.error(file.first, column.label, f"{expected} quantity, or {UNUSED}")


def _lines_above(file: TableFile) -> dict[str, Any] | None:
    """The argument `skip` for a line below that is a complete header."""
    for skip in range(file.first, min(len(file.head), LINES_ABOVE)):
        with suppress(InvalidArgumentError):
            below = open_text(file.head[skip], file.name, file.schema, TableLayout(columns=file.layout.columns))
            columns, _ = columns_of(below, next(iter(below.rows), []))
            if not missing_groups(columns, file.schema):
                return {"skip": skip}
    return None


def read_rows(file: TableFile, schema: Schema[Item], most: int | None = None) -> Table[Item]:
    """The items of a table, and the rows that cannot be read.

    Raises `TableFileError` for a header that does not state what is needed, `TooManyRowsError` beyond `most` rows.
    """
    rows = iter(file.rows)
    header = next(rows, [])
    columns, remarks = columns_of(file, header)
    _check_header(file, columns)
    labels = [column.label for column in columns]
    body: list[tuple[int, Sequence[Cell]]] = []
    for number, row in enumerate(rows, start=file.first + 1):
        if not any(map(str.strip, map(text_of_cell, row))):
            continue
        if len(body) == most:
            raise TooManyRowsError(schema.argument, f"more than {most} rows", f"at most {most}")
        body.append((number, row))
    table: Table[Item] = Table(columns={column.label: column.header for column in columns if column.quantity})
    kept: list[dict[str, Cell]] = []
    for number, cells in body:
        by_label: dict[str, Cell] = dict.fromkeys(labels, "")
        by_label.update(zip(labels, cells, strict=False))
        values, errors = _read_row(file, columns, cells)
        if not errors:
            try:
                unread = {label: by_label[label] for label in labels if label not in table.columns}
                table.items.append(schema.make(Row(number, values, by_label, unread)))
                kept.append(by_label)
            except InvalidArgumentError as error:
                several = error.errors if isinstance(error, SeveralArgumentsError) else [error]
                errors = [_of_cell(error, columns, cells) for error in several]
        if errors:
            table.bad_rows.append(BadRow(number, errors, by_label))
    table.cells.update({label: [cells[label] for cells in kept] for label in labels})
    table.remarks.extend(remarks)
    return table


def _read_row(
    file: TableFile, columns: Sequence[Column], cells: Sequence[Cell]
) -> tuple[dict[str, Any], list[InvalidArgumentError]]:
    """The values of a row by quantity, and all that is wrong with it."""
    values: dict[str, Any] = {}
    errors: list[InvalidArgumentError] = []
    if any(text_of_cell(cell).strip() for cell in cells[len(columns) :]):
        errors.append(InvalidArgumentError("row", f"{len(cells)} cells", f"{len(columns)}, as in the header"))
    for column, cell in zip(columns, cells, strict=False):
        quantity = column.quantity
        if quantity is None or is_empty(cell):
            continue
        if not quantity.unit:
            values[quantity.name] = text_of_cell(cell)
            continue
        if plain_name(name_and_unit(text_of_cell(cell))[0]) == plain_name(quantity.name):
            raise file.error(
                None, "; ".join(map(text_of_cell, cells)), "one header: a second table in a file of its own"
            )
        try:
            values[quantity.name] = read_cell(quantity, cell, column.unit, file.layout.decimal)
        except InvalidArgumentError as error:
            errors.append(error)
    stated = values.keys() | {error.parameter for error in errors}
    absent = [group for group in file.schema.required if stated.isdisjoint(group)]
    errors += [InvalidArgumentError(group[0], None, f"{' or '.join(group[:2])} in each row") for group in absent]
    errors += unusual_sizes(values, file.layout)
    return values, errors


def unusual_sizes(values: Mapping[str, Any], layout: TableLayout) -> list[InvalidArgumentError]:
    """A question for each size [m] of an object, by quantity, that is below 1 cm or above 50 m."""
    low, high = (-math.inf, math.inf) if layout.allow_unusual else SIZE_RANGE
    allowed = f"{SIZE_RANGE[0]:g} to {SIZE_RANGE[1]:g} m; check unit and decimal sign, or state `allow_unusual`"
    sizes = ((name, values.get(name)) for name in EXTENTS)
    wrong = [(name, size) for name, size in sizes if isinstance(size, float) and not low <= size <= high]
    return [InvalidArgumentError(name, f"{size:g} m", allowed) for name, size in wrong]


def _of_cell(error: InvalidArgumentError, columns: Sequence[Column], cells: Sequence[Cell]) -> InvalidArgumentError:
    """The error with the text of the cell in place of its value in SI units."""
    for column, cell in zip(columns, cells, strict=False):
        if column.name == error.parameter and not is_empty(cell):
            return InvalidArgumentError(error.parameter, text_of_cell(cell).strip(), error.allowed)
    return error
