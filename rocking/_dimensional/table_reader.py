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
from dataclasses import dataclass, field, replace
from itertools import islice
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
    units: dict[str, str] = field(default_factory=dict)  # of each quantity, in the header or in the first cell
    bad_rows: list[BadRow] = field(default_factory=list)
    remarks: list[str] = field(default_factory=list)  # where `columns` and the header differ

    @property
    def skipped(self) -> list[str]:
        """The columns that are not read."""
        return [label for label in self.cells if label not in self.columns]


class Column(NamedTuple):
    """A column: its header as it stands, with its number where that is empty or not the first; what is read of it."""

    label: str
    quantity: Quantity | None
    unit: str  # "" where the cells state it

    @property
    def header(self) -> str:
        """The canonical header."""
        name = "" if self.quantity is None else self.quantity.name
        return f"{name} [{self.unit}]" if self.unit else name


@dataclass(frozen=True)
class TableFile:
    """The rows of a file from its header on, in a stated layout."""

    argument: str
    name: str  # of the file
    layout: TableLayout
    first: int  # number of the row of the header, from 1
    rows: Iterator[Sequence[Cell]]  # the header, and what is below
    head: Sequence[str]  # first lines of the file
    start: int = 0  # place of the header in CSV text
    delimiter: str = ""  # sign between its cells

    def error(
        self, line: int | None, found: str, expected: str, call: Mapping[str, Any] | None = None
    ) -> TableFileError:
        """An error with the first lines of the file, and arguments that would read it where they can be said."""
        lines = [f"line {k}: {text[:SHOWN_SIGNS]}" for k, text in enumerate(self.head[:SHOWN_LINES], start=1)]
        return TableFileError(self.argument, self.name, line, found, expected, lines, call)


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
    if path.suffix.lower() in SHEETS:
        return read_rows(
            open_rows(rows_of_sheet(raw, schema.argument, layout.sheet), path.name, schema, layout), schema
        )
    return read_rows(open_text(text_of(raw, schema.argument), path.name, schema, layout), schema)


def open_text(
    text: str, name: str, schema: Schema[Any], layout: TableLayout, stop: StopFlag | None = None
) -> TableFile:
    """The rows of CSV text. `stop` cancels the work."""
    if len(text) > MAX_CHARACTERS:
        raise InvalidArgumentError(schema.argument, f"{len(text)} characters", f"at most {MAX_CHARACTERS}")
    source = io.StringIO(text.removeprefix("\ufeff"), newline="")
    head = [line.rstrip("\r\n") for line in islice(source, LINES_ABOVE)]
    source.seek(0)
    number, start, header = 0, 0, ""
    for line in iter(source.readline, ""):
        number += 1
        if number > layout.skip and not _is_passed_over([line.lstrip('"')]):
            header = line
            break
        start = source.tell()
    source.seek(start)
    file = TableFile(schema.argument, name, layout, number, iter(()), head)
    delimiter = SEPARATORS[layout.delimiter] if layout.delimiter else _delimiter(file, header)
    rows = _csv_rows(csv.reader(source, delimiter=delimiter, strict=True), file, stop)
    return replace(file, rows=rows, start=start, delimiter=delimiter)


def _delimiter(file: TableFile, header: str) -> str:
    """The one sign between the cells of the header."""
    unquoted = "".join(header.split('"')[::2])
    signs = [sign for sign in ",;\t" if sign in unquoted]
    if len(signs) > 1:
        raise file.error(file.first, header.strip(), "the argument `delimiter`: the header has several signs")
    return signs[0] if signs else ","


def _csv_rows(rows: Any, file: TableFile, stop: StopFlag | None) -> Iterator[list[str]]:
    """The rows of a reader of the standard library, which refuses quotes that are not closed, as pandas does not."""
    while True:
        if stop is not None:
            stop.check()
        line = file.first + rows.line_num
        try:
            row = next(rows)
        except StopIteration:
            return
        except csv.Error as error:
            expected = "cells that are in quotes as a whole or not at all, with each inner quote doubled"
            raise file.error(line, str(error), expected) from None
        yield row


def open_rows(rows: Sequence[Sequence[Cell]], name: str, schema: Schema[Any], layout: TableLayout) -> TableFile:
    """The rows of a sheet."""
    first = layout.skip
    while first < len(rows) and _is_passed_over([text_of_cell(cell) for cell in rows[first]]):
        first += 1
    head = ["; ".join(map(text_of_cell, row)) for row in rows[:LINES_ABOVE]]
    return TableFile(schema.argument, name, layout, first + 1, iter(rows[first:]), head)


def rows_of_sheet(raw: bytes, argument: str, sheet: str | None = None) -> list[list[Cell]]:
    """The cells of a sheet; numbers are numbers."""
    import pandas as pd  # noqa: PLC0415  (takes long to load, and only sheets need it)

    try:
        with pd.ExcelFile(io.BytesIO(raw), engine="calamine") as file:
            book = file.book
            areas = {name: book.get_sheet_by_name(name) for name in file.sheet_names}
            names = [sheet] if sheet is not None else [name for name in areas if areas[name].total_height]
            if len(names) != 1 or names[0] not in areas:
                raise InvalidArgumentError("sheet", sheet, f"one of {', '.join(map(str, areas))}")
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
    """The cells of a sheet as CSV text, numbers with a decimal sign."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    for row in rows_of_sheet(raw, argument, sheet):
        writer.writerow(cell if isinstance(cell, str) else text_of_cell(cell).replace(".", decimal) for cell in row)
    return text.getvalue()


def _is_passed_over(cells: Sequence[str]) -> bool:
    """True for a blank row, and above the header for a comment."""
    text = "".join(cells).strip()
    return not any(map(str.isalnum, text)) or text.startswith("# ")


def labels_of(cells: Sequence[Cell]) -> list[str]:
    """The texts of a header, with the number of the column where one is empty or not the first."""
    labels: list[str] = []
    for number, cell in enumerate(cells, start=1):
        text = text_of_cell(cell).strip()
        labels.append(text if text and text not in labels else f"{text}#{number}")
    return labels


def columns_of(file: TableFile, cells: Sequence[Cell], schema: Schema[Any]) -> tuple[list[Column], list[str]]:
    """The columns of a header, each quantity at most once, and remarks where `columns` and the header differ."""
    quantities = {plain_name(quantity.name): quantity for quantity in schema.quantities}
    labels = labels_of(cells)
    stated = {" ".join(label.split()): text for label, text in file.layout.columns.items()}
    columns: list[Column] = []
    remarks: list[str] = []
    for label in labels:
        text = stated.pop(" ".join(label.split()), None)
        name, bracket = name_and_unit(label if text is None else text)
        quantity = quantities.get(plain_name(name))
        if text is not None and quantity is None and plain_name(text) != UNUSED:
            allowed = f"{', '.join(q.name for q in schema.quantities)}, with a unit in brackets; or {UNUSED}"
            raise InvalidArgumentError("columns", f"{label}={text}", allowed)
        if quantity is None or not quantity.unit:
            is_read = quantity is not None and bracket is None
            columns.append(Column(label, quantity if is_read else None, ""))
            continue
        in_header = name_and_unit(label)[1]
        written = bracket if bracket is not None else in_header
        unit = unit_name(written, quantity.unit) if written else ""
        if unit is None:
            units = ", ".join(f"[{key}]" for key in UNITS[quantity.unit])
            raise file.error(file.first, label, f"one of {units}; or `columns`, which states what the column is")
        if text is not None and in_header and unit_name(in_header, quantity.unit) not in (unit, None):
            remarks.append(f"the header says {label}; {text} is read, as `columns` says")
        columns.append(Column(label, quantity, unit))
    if stated:
        raise InvalidArgumentError("columns", next(iter(stated)), f"a header of the table: {'; '.join(labels)[:300]}")
    names = [column.quantity.name for column in columns if column.quantity is not None]
    for name in dict.fromkeys(names):
        if names.count(name) > 1:
            same = "; ".join(column.label for column in columns if column.quantity and column.quantity.name == name)
            raise file.error(file.first, same, f"one column {name}; state `columns` with {UNUSED!r} for the others")
    return columns, remarks


def missing_groups(columns: Sequence[Column], schema: Schema[Any]) -> list[str]:
    """The quantities that the header lacks, one of each group."""
    names = {column.quantity.name for column in columns if column.quantity is not None}
    return [" or ".join(group[:2]) for group in schema.required if names.isdisjoint(group)]


def _check_header(file: TableFile, columns: Sequence[Column], schema: Schema[Any]) -> None:
    """Refuse a header that lacks a quantity, or leaves open which column is the depth."""
    missing = missing_groups(columns, schema)
    labels = "; ".join(column.label for column in columns)
    if missing:
        expected = f"a column {' and a column '.join(missing)}, each with its unit in brackets; where a column has"
        expected += " another header, state it by `columns`, such as HEADER=width [cm]"
        raise file.error(file.first, labels or "nothing", expected, _lines_above(file, schema))
    names = {column.quantity.name for column in columns if column.quantity is not None}
    if not schema.needs_depth or not names.isdisjoint(("depth", "diameter", "left", "body", "vertices")):
        return
    for column in columns:
        bracket = name_and_unit(column.label)[1]
        is_stated = column.label in file.layout.columns
        if column.quantity is None and not is_stated and bracket and unit_name(bracket, "m"):
            expected = "a column depth or diameter; state by `columns` what this one is: depth, diameter, another"
            raise file.error(file.first, column.label, f"{expected} quantity, or {UNUSED}")


def _lines_above(file: TableFile, schema: Schema[Any]) -> dict[str, Any] | None:
    """The argument `skip` for a line below that is a complete header."""
    for skip in range(file.first, len(file.head)):
        try:
            below = open_text("\n".join(file.head[skip:]), file.name, schema, TableLayout(columns=file.layout.columns))
            columns, _ = columns_of(below, next(below.rows, []), schema)
        except InvalidArgumentError:
            continue
        if not missing_groups(columns, schema):
            return {"skip": skip}
    return None


def read_rows(file: TableFile, schema: Schema[Item], most: int | None = None) -> Table[Item]:
    """The items of a table, and the rows that cannot be read.

    Raises `TableFileError` for a header that does not state what is needed, `TooManyRowsError` beyond `most` rows.
    """
    header = next(file.rows, [])
    if len(header) > MAX_COLUMNS:
        raise file.error(file.first, f"{len(header)} columns", f"at most {MAX_COLUMNS}")
    columns, remarks = columns_of(file, header, schema)
    _check_header(file, columns, schema)
    labels = [column.label for column in columns]
    body: list[tuple[int, Sequence[Cell]]] = []
    for number, row in enumerate(file.rows, start=file.first + 1):
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
        values, units, errors = _read_row(file, columns, cells, schema)
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
        for name, unit in units.items():
            table.units.setdefault(name, unit)
    table.cells.update({label: [cells[label] for cells in kept] for label in labels})
    table.remarks.extend(remarks)
    return table


def _read_row(
    file: TableFile, columns: Sequence[Column], cells: Sequence[Cell], schema: Schema[Any]
) -> tuple[dict[str, Any], dict[str, str], list[InvalidArgumentError]]:
    """The values and units of a row by quantity, and all that is wrong with it."""
    values: dict[str, Any] = {}
    units: dict[str, str] = {}
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
            values[quantity.name], units[quantity.name] = read_cell(quantity, cell, column.unit, file.layout.decimal)
        except InvalidArgumentError as error:
            errors.append(error)
    stated = values.keys() | {error.parameter for error in errors}
    absent = [group for group in schema.required if stated.isdisjoint(group)]
    errors += [InvalidArgumentError(group[0], None, f"{' or '.join(group[:2])} in each row") for group in absent]
    errors += unusual_sizes(values, file.layout)
    return values, units, errors


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
        if column.quantity is not None and column.quantity.name == error.parameter and not is_empty(cell):
            return InvalidArgumentError(error.parameter, text_of_cell(cell).strip(), error.allowed)
    return error
