"""Tables as people keep them: CSV with any separator and decimal sign, and sheets as an extra.

Units stand in the header ("width [cm]", "Breite (cm)", "height, m"), in a line of their own above or below it, in a
column of their own, or in the cells ("40 cm"). What is not certain is not read: a number whose decimal sign other
numbers of the table do not settle ("1,234") refuses its row, and so does a length in a column that is not read.
"""

from __future__ import annotations

import csv
import io
import re
import sys
from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from itertools import chain, islice, zip_longest
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from rocking._base.cells import decimal_sign, half_width, name_and_unit, plain_name, read_cell, split_number
from rocking._base.errors import InvalidArgumentError, UnreadableFileError
from rocking._base.quantity import Quantity
from rocking._base.units import MAX_LENGTH, UNITS, unit_name
from rocking._dimensional.table_header import (
    AMOUNT,
    EMPTY,
    HEADER_ROWS,
    MAX_NAME,
    Header,
    HeaderLine,
    Schema,
    find_header,
    header_lines,
    is_sizes,
    is_unit,
    is_used,
)
from rocking._dimensional.table_sizes import BETWEEN, with_sizes

if TYPE_CHECKING:
    from rocking._numba.cancellation import StopFlag  # numba takes longer to load than a table

Item = TypeVar("Item")

DELIMITERS = ",;\t|"

SHEETS = (".xlsx", ".ods")  # endings of files that are not text
MAX_CHARACTERS = 20_000_000  # longest table that is read

EMPTY_ROWS, SHEET_COLUMNS, SHEET_CELLS = 20_000, 16_384, 1_000_000
"""Limits: rows without an item, where rows are limited; columns and cells of a sheet (one far out makes all)."""

_TOTAL = re.compile(
    r"(?:sub|grand |zwischen)?(?:totals?|sum|mean|average|summe|gesamt(?:summe)?|insgesamt|mittel(?:wert)?|totale|"
    r"totaux|somma|somme|suma|soma|count|media|moyenne|promedio|avg|median|m[e\u00e9]diane|std|sd|std\.?\s*dev|"
    r"standard deviation|minimum|maximum|min|max|durchschnitt|overall|all objects|totaal|summa|razem|toplam|ortalama|"
    r"\u0438\u0442\u043e\u0433\u043e|\u03c3\u03cd\u03bd\u03bf\u03bb\u03bf|\u03bc\u03ad\u03c3\u03bf\u03c2 "
    r"\u03cc\u03c1\u03bf\u03c2|\u03a3|[\u5408\u5c0f\u7dcf\u603b][\u8a08\u8ba1]|\u5e73\u5747)"
    r"\.?\s*(?:[:(\d\u00b1].*|(?:of|all|objects?|items?|pieces|weight|number|objekte|oggetti|objets|objetos|hall|room|general|"
    r"g\u00e9n\u00e9ral|geral)\b.*)?",
    re.IGNORECASE | re.DOTALL,
)
"""First cells of rows that are no objects: "Total", "Sum (12 objects)", not "Total Eclipse"."""

_EXACT = re.compile(r"-?[0-9]+(?:\.[0-9]+)?(?:e[-+][0-9]+)?")

_PLAIN = re.compile(r"-?(?:0|[1-9][0-9]{0,14})(?:[.,][0-9]{1,15})?")

MARK = "\ufeff"  # what some programs put before a text of UTF-8
EXACT = "\u2060"  # before a number of a sheet in its text


class TooManyRowsError(InvalidArgumentError):
    """A table has more rows than the caller allows; no item was made."""


@dataclass(frozen=True)
class BadRow:
    """A row that was not read."""

    row: int  # its number in the table, from 1
    column: str  # name of the column, "" for the whole row
    reason: str  # what was found and what is allowed
    cells: dict[str, str] = field(default_factory=dict)  # the row as it stands, by the headers of the table

    def __str__(self) -> str:
        return f"row {self.row}{f', {self.column}' if self.column else ''}: {self.reason}"


@dataclass(frozen=True)
class Table(Generic[Item]):
    """The rows of a table."""

    items: list[Item]  # one for each row that was read
    # every column of the table as it stands, by the text of its header, with its number where that is empty or
    # not the first; for the rows that were read
    cells: dict[str, list[str]] = field(default_factory=dict)
    # the name of the quantity in each of these columns that is read
    columns: dict[str, str] = field(default_factory=dict)
    # the unit of each quantity that is read: of the header, or of the first cell with one, otherwise ""
    units: dict[str, str] = field(default_factory=dict)
    # number of each row that was not read, and why; the parameter is the column, "row" the whole row
    errors: list[tuple[int, InvalidArgumentError]] = field(default_factory=list)
    # the cells of each of these rows
    unread: list[dict[str, str]] = field(default_factory=list)
    # rows of totals, which are no items: "row 9: Total"
    totals: list[str] = field(default_factory=list)

    @property
    def skipped(self) -> list[str]:
        """The columns that are not read."""
        return [label for label in self.cells if label not in self.columns]

    @property
    def bad_rows(self) -> list[BadRow]:
        """The rows that were not read, in words."""
        return [
            BadRow(
                row,
                *("", f"{one.value}; {one.allowed}") if one.parameter == "row" else (one.parameter, str(one)),
                cells,
            )
            for (row, one), cells in zip(self.errors, self.unread, strict=True)
        ]


def read_bytes(source: str | PathLike[str], argument: str) -> bytes:
    """The content of a file; `-` is standard input."""
    try:
        return sys.stdin.buffer.read() if source == "-" else Path(source).read_bytes()
    except OSError as error:
        raise UnreadableFileError(argument, str(source), error) from None


def read_file(source: str | PathLike[str], schema: Schema[Item]) -> Table[Item]:
    """A table from a file: a sheet (.xlsx, .ods), or CSV with any other ending; `-` is standard input."""
    raw = read_bytes(source, schema.argument)
    if Path(source).suffix.lower() in SHEETS:
        return read_rows(rows_of_sheet(raw, schema.argument), schema)
    return read_csv(text_of(raw, schema.argument), schema)


def text_of(raw: bytes, argument: str) -> str:
    """A text of UTF-8, UTF-16 with its mark, or the code page of older spreadsheets; binary content is refused."""
    is_utf16 = raw[:2] in (b"\xff\xfe", b"\xfe\xff")
    if b"\0" in raw and not is_utf16:
        raise InvalidArgumentError(argument, "binary content", "text, or a sheet whose name ends in .xlsx or .ods")
    try:
        return raw.decode("utf-16" if is_utf16 else "utf-8-sig")
    except UnicodeDecodeError:
        return raw.decode("cp1252", "replace")


def read_csv(text: str, schema: Schema[Item], most: int | None = None, stop: StopFlag | None = None) -> Table[Item]:
    """A table from text; errors of `read_file`, of a line that is not CSV, of `most`. `stop` cancels the work."""
    delimiter = delimiter_of(text, schema)
    # where commas separate the columns, a single point is the decimal sign
    usual = "." if delimiter == "," else ""
    rows = _rows(_open(text), delimiter, schema, stop)
    return read_rows(map(_typed, rows) if EXACT in text else rows, schema, usual, most)


def rows_of_csv(text: str, schema: Schema[Any], stop: StopFlag | None = None) -> Iterator[str]:
    """The text of each row that `read_csv` counts, with its end; the errors of `read_csv`."""
    text = text.removeprefix(MARK)
    source, start = _open(text), 0
    for _ in _rows(source, delimiter_of(text, schema), schema, stop):
        yield text[start : source.tell()]
        start = source.tell()


def delimiter_of(text: str, schema: Schema[Any]) -> str:
    """The sign between the columns of a text; the errors of `read_csv`."""
    if len(text) > MAX_CHARACTERS:
        raise InvalidArgumentError(schema.argument, f"{len(text)} characters", f"at most {MAX_CHARACTERS}")
    sizes = {
        one: max(map(_fit, _header_lines(_start(text, one, schema), schema)), default=(0, 0)) for one in DELIMITERS
    }
    delimiter = max(DELIMITERS, key=sizes.__getitem__)
    if not sizes[delimiter][0]:
        list(islice(_rows(_open(text), delimiter, schema), HEADER_ROWS))  # says which line is not CSV
    return delimiter


def _header_lines(rows: list[list[str]], schema: Schema[Any]) -> Iterator[HeaderLine]:
    several, schema = with_sizes(rows, schema)
    return header_lines([*several.spread(rows)] if several else rows, schema)


def _fit(line: HeaderLine) -> tuple[bool, int]:
    """Whether a line has all columns that a header needs, and how many of its columns are read."""
    return line.complete, len(line.columns)


def _open(text: str) -> io.StringIO:
    return io.StringIO(text.removeprefix(MARK), newline="")


def _rows(
    source: Iterable[str], delimiter: str, schema: Schema[Any], stop: StopFlag | None = None
) -> Iterator[list[str]]:
    rows = csv.reader(source, delimiter=delimiter, strict=True)
    while True:
        if stop is not None:
            stop.check()
        line = rows.line_num + 1
        try:
            row = next(rows)
        except StopIteration:
            return
        except csv.Error as error:
            allowed = f"values of at most {csv.field_size_limit()} characters; in quotes, with each inner quote doubled"
            raise InvalidArgumentError(f"{schema.argument}, line {line}", str(error), allowed) from None
        yield row


def _start(text: str, delimiter: str, schema: Schema[Any]) -> list[list[str]]:
    """The rows that may be a header; none from a line on that is not CSV."""
    rows: list[list[str]] = []
    with suppress(InvalidArgumentError):
        for row in islice(_rows(_open(text), delimiter, schema), HEADER_ROWS):
            rows.append(row)  # noqa: PERF402  (the rows before an error are kept)
    return rows


def rows_of_sheet(raw: bytes, argument: str) -> list[list[str]]:
    """The first sheet of a file as text; numbers have decimal points. The errors of `read_file`."""
    import pandas as pd  # noqa: PLC0415  (takes long to load, and only sheets need it)

    try:
        with pd.ExcelFile(io.BytesIO(raw), engine="calamine") as file:
            sheet = file.book.get_sheet_by_index(0)
            rows, columns = sheet.total_height, sheet.total_width
            if columns > SHEET_COLUMNS or rows * columns > SHEET_CELLS:
                allowed = f"at most {SHEET_COLUMNS} columns and {SHEET_CELLS} cells"
                raise InvalidArgumentError(argument, f"a sheet of {rows} rows and {columns} columns", allowed)
            frame = pd.read_excel(file, header=None, dtype=object, na_filter=False)
    except ImportError as error:
        raise ImportError("sheets need the extra `sheets`: pip install 'rocking[sheets]'", name=error.name) from None
    except (InvalidArgumentError, MemoryError):
        raise
    except Exception as error:  # noqa: BLE001  (the reader of sheets has its own errors)
        raise InvalidArgumentError(argument, str(error), "a sheet of a spreadsheet, .xlsx or .ods") from None
    return [list(map(_cell_text, row)) for row in frame.to_numpy().tolist()]


def csv_of_sheet(raw: bytes, argument: str) -> str:
    """The first sheet of a file as text with semicolons, which `read_csv` reads as `read_file` does the sheet.

    Numbers keep their type: the sign `EXACT`, which has no width, stands before them.
    """
    text = io.StringIO()
    written = csv.writer(text, delimiter=";", lineterminator="\n")
    for row in rows_of_sheet(raw, argument):
        written.writerow([f"{EXACT}{cell}" if isinstance(cell, _Exact) else cell for cell in row])
    return text.getvalue()


class _Exact(str):
    """A number of a sheet, whose decimal sign is a point whatever the texts of the table have."""

    __slots__ = ()


def _typed(row: Sequence[str]) -> list[str]:
    """A row of the text of a sheet with its numbers."""
    return [_Exact(cell[1:]) if cell.startswith(EXACT) and _EXACT.fullmatch(cell[1:]) else cell for cell in row]


def numbers_of(cells: Sequence[str]) -> Sequence[str | float | None]:
    """A column of a table with its numbers as numbers, where all of its cells are plain ones or all are of a sheet.

    Digits that begin with 0, such as 0012, and numbers whose decimal sign is in doubt remain texts.
    """
    texts = [cell for cell in cells if cell.strip()]
    if not any(isinstance(cell, _Exact) for cell in texts):
        signs = {decimal_sign(cell.strip().lstrip("-")) for cell in texts}
        if len(signs - {""}) > 1 or not all(_PLAIN.fullmatch(cell.strip()) for cell in texts) or signs & {"?.", "?,"}:
            return cells
        return [float(cell.strip().replace(",", ".")) if cell.strip() else None for cell in cells]
    return [float(cell) if isinstance(cell, _Exact) else cell for cell in cells]


def _cell_text(value: object) -> str:
    """A cell of a sheet as text."""
    if value is None or value != value:
        return ""
    if not isinstance(value, float):
        return str(value).removesuffix(" 00:00:00")  # a date
    return _Exact(int(value) if value.is_integer() and abs(value) < 1e15 else f"{value:.15g}")


def read_rows(
    rows: Iterable[Sequence[str]], schema: Schema[Item], usual: str = "", most: int | None = None
) -> Table[Item]:
    """A table from its cells, its header among the first rows; the errors of `read_file`.

    `usual` is the decimal sign where no number settles it; "": rows with a number that needs it are not read. Beyond
    `most` rows, without those that are empty or totals, the table is refused by `TooManyRowsError`.
    """
    rest = iter(rows)
    top = list(islice(rest, HEADER_ROWS + 1))  # with a line of units
    several, schema = with_sizes(top, schema)
    if several is not None:
        rest = several.spread(chain(top, rest))
        top = list(islice(rest, HEADER_ROWS + 1))
    header = find_header(top, schema)
    body: list[tuple[int, Sequence[str]]] = []
    totals: list[str] = []
    for number, row in enumerate(chain(top[header.last + 1 :], rest), start=header.last + 2):
        if _is_item(row):
            if len(body) == most:
                raise TooManyRowsError(schema.argument, f"more than {most} rows", f"at most {most}")
            body.append((number, row))
            continue
        if any(map(str.isalnum, "".join(row))):
            totals.append(f"row {number}: {next(filter(None, map(str.strip, row)))[:MAX_NAME]}")
        if most is not None and number - len(body) > EMPTY_ROWS:
            allowed = f"at most {EMPTY_ROWS} rows that are empty or totals"
            raise TooManyRowsError(schema.argument, f"{number} rows", allowed)
    numeric = [place for place, (one, _) in header.columns.items() if one.unit]
    decimal = _decimal_sign((row[place] for _, row in body for place in numeric if place < len(row)), usual)
    labels = header.labels
    used = {place for place, (one, _) in header.columns.items() if one.unit or one.name == "name"}
    used |= set(header.units.values())
    items: list[Item] = []
    kept: list[Sequence[str]] = []
    errors: list[tuple[int, InvalidArgumentError]] = []
    unread: list[dict[str, str]] = []
    for number, row in body:
        try:
            values = _values(row, header, decimal, schema)
            others = {
                label: cell
                for place, (label, text, cell) in enumerate(zip(labels, header.texts, row, strict=False))
                if place not in used and (text.strip() or cell.strip())
            }
            items.append(schema.make(number, values, others))
            kept.append(row)
        except InvalidArgumentError as error:
            _check_no_header(number, row, header, schema)
            errors.append((number, _of_cell(error, row, header)))
            unread.append(dict(zip_longest(labels, row[: len(labels)], fillvalue="")))
    size = len(header.texts)
    padded = [[*row[:size], *[""] * (size - len(row))] for row in kept]
    columns = {label: [row[place] for row in padded] for place, label in enumerate(labels)}
    columns = {label: column for label, column in columns.items() if not label.startswith("#") or any(column)}
    read = {
        labels[place]: one.name if one.times == 1.0 else f"half_{one.name}"
        for place, (one, _) in header.columns.items()
    }
    read |= {labels[place]: "units" for place in header.units.values()}
    units = {
        one.name: unit or next((written for row in padded if (written := _written_unit(row[place], one))), "")
        for place, (one, unit) in header.columns.items()
    }
    return Table(items, columns, read, units, errors, unread, totals)


def _check_no_header(number: int, row: Sequence[str], header: Header, schema: Schema[Any]) -> None:
    """Refuse a table in which a second header names other columns or units for the rows below it."""
    if any(split_number(row[place]) for place, (one, _) in header.columns.items() if one.unit and place < len(row)):
        return
    for line in header_lines([row], schema):
        for place, (one, unit) in line.columns.items() if line.complete else ():
            above = header.columns.get(place)
            if one.unit and (above is None or above[0] != one or unit not in ("", above[1])):
                allowed = "one header; a table with other columns or units in a file of its own"
                raise InvalidArgumentError(f"{schema.argument}, row {number}", "; ".join(row)[:MAX_NAME], allowed)


def _is_item(row: Sequence[str]) -> bool:
    """Whether a row has values and is not a row of totals."""
    first = next(filter(None, map(str.strip, row)), "")
    return bool(first) and not _TOTAL.fullmatch(first[:MAX_NAME]) and any(map(str.isalnum, "".join(row)))


def _written_unit(cell: str, one: Quantity) -> str:
    """The unit in a cell, "" for none."""
    found = split_number(cell) if one.unit in UNITS else None
    return (unit_name(found[1], one.unit) or "") if found else ""


def _values(row: Sequence[str], header: Header, decimal: str, schema: Schema[Any]) -> dict[str, Any]:
    """The values of a row by the name of their columns."""
    if any(cell.strip() for cell in row[len(header.texts) :]):
        raise InvalidArgumentError("row", f"{len(row)} cells", f"{len(header.texts)}, as in the header")
    if schema.every_length:
        _check_lengths(row, header)
    values: dict[str, Any] = {}
    for place, (one, unit) in header.columns.items():
        cell = row[place] if place < len(row) else ""
        if (cell.strip().lower() in EMPTY) if one.unit else not any(map(str.isalnum, cell)):
            continue
        stated = _row_unit(row, header, place) if one.unit in UNITS and not _written_unit(cell, one) else unit
        value = read_cell(one, cell, stated, "." if isinstance(cell, _Exact) else decimal)
        values[one.name] = f"{values[one.name]}; {value}" if one.name in values else value
    for one, _ in header.columns.values():
        if values.get(one.name) == 0.0 and any(values.get(other) for other in one.absent_beside):
            del values[one.name]
    if schema.every_length and "name" not in values and not _has_text(row, header):
        raise InvalidArgumentError("row", "numbers only", "a name or another text, which totals lack")
    dimensions = (one for one, _ in header.columns.values() if one.unit not in ("", "-", "kg") or one.name == "body")
    if not any(one.name in values for one in dimensions):
        raise InvalidArgumentError("row", "no dimension", "one or more in each row")
    return values


def _has_text(row: Sequence[str], header: Header) -> bool:
    """Whether a row of a table with names has a text."""
    if not any(one.name == "name" for one, _ in header.columns.values()):
        return True
    numeric = {place for place, (one, _) in header.columns.items() if one.unit}
    texts = (cell for place, cell in enumerate(row) if place not in numeric and not is_unit(cell))
    return any(map(str.isalnum, "".join(texts)))


def _row_unit(row: Sequence[str], header: Header, place: int) -> str:
    """The unit of a cell without one: that of its header, or of the column of units."""
    one, unit = header.columns[place]
    where = header.units.get(place)
    stated = row[where].strip() if where is not None and where < len(row) else ""
    if stated.lower() in EMPTY:
        return unit
    found = unit_name(stated, one.unit)
    quantities = {header.columns[k][0].unit for k, of in header.units.items() if of == where}
    if not found and not any(unit_name(stated, other) for other in quantities):
        raise InvalidArgumentError(
            one.name, f"{row[place].strip()} {stated}", f"a unit such as {', '.join(UNITS[one.unit])}"
        )
    if found and unit and found != unit:
        raise InvalidArgumentError(one.name, f"{row[place].strip()} {stated}", f"the unit of its header, {unit}")
    return found or unit


def _check_lengths(row: Sequence[str], header: Header) -> None:
    """Refuse a row with a length in a column that is not read.

    A text such as "394 x 419 x 120 mm" is left alone if the row has all three dimensions, or as many as the text.
    """
    given = {
        one.name
        for place, (one, _) in header.columns.items()
        if place < len(row) and row[place].strip().lower() not in EMPTY
    }
    # a diameter is width and depth
    dimensions = len(given & {"width", "depth", "length", "height", "diameter"}) + ("diameter" in given)
    for place, text in enumerate(header.texts[: len(row)]):
        cell = row[place].strip()
        if place in header.columns or place in header.units.values() or cell.lower() in EMPTY:
            continue
        if text.strip() and not is_used(text):
            continue
        number = split_number(cell, "in")
        is_length = bool(number and unit_name(number[1], "m"))  # in its cell
        if place in header.lengths:
            bare = number and not any(map(str.isalpha, number[1]))  # such as 12, 12-15
            is_length |= bool(AMOUNT.match(cell) if header.lengths[place] else bare)
            several = is_sizes(name_and_unit(text)[0]) and re.search(r"\d", cell) is not None
            is_length |= several and dimensions < 3 and len(BETWEEN.split(cell[:MAX_LENGTH])) != dimensions
        if is_length and not (number and not number[0].strip("+-0.,")):
            known = '"width", "depth", "diameter", "height" or "friction"'
            allowed = f'a column named as what it is, such as {known}, or whose name begins with "unused"'
            raise InvalidArgumentError(header.labels[place].strip(), cell, allowed)


def _of_cell(error: InvalidArgumentError, row: Sequence[str], header: Header) -> InvalidArgumentError:
    """The error with the text of the cell in place of its value in SI units, and the header where it is another."""
    for place, (one, _) in header.columns.items():
        if one.name == error.parameter and place < len(row) and row[place].strip().lower() not in EMPTY:
            text = header.labels[place].strip()
            of = "" if plain_name(name_and_unit(text)[0]) == plain_name(one.name) else f" (column {text!r})"
            cell = row[place].strip().removeprefix("'") if one.unit else row[place].strip()
            return InvalidArgumentError(one.name, cell, error.allowed + of)
    return error


def _decimal_sign(cells: Iterable[str], usual: str) -> str:
    """The decimal sign that the numbers of a table settle; "" if none or both do.

    A single `usual` sign counts as one, as where commas separate the columns. Numbers of a sheet say nothing of texts.
    """
    signs: set[str] = set()
    for cell in cells:
        found = None if isinstance(cell, _Exact) else split_number(cell)
        own = decimal_sign(found[0]) if found and found[0].strip("+-0.,") else ""  # 0.0 is written by machines
        written = own[-1:] in half_width(cell)  # which a fraction such as 1 1/2 has not
        if own and written and (not own.startswith("?") or own[1] == usual):
            signs.add(own[-1])
    return signs.pop() if len(signs) == 1 else ""
