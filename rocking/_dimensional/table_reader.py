"""Tables as people keep them: CSV with any separator and decimal sign, and sheets as an extra.

Units stand in the header ("width [cm]", "Breite (cm)", "height, m") or in the cells ("40 cm"). A number whose decimal
sign is not certain, such as "1,234", is not read: the table is refused unless other numbers of it settle the sign.
"""

from __future__ import annotations

import csv
import io
import re
import sys
import unicodedata
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from itertools import chain, islice
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from rocking._base.errors import InvalidArgumentError
from rocking._base.units import MAX_LENGTH, UNITS, USUAL, unit_name

if TYPE_CHECKING:
    from rocking._numba.cancellation import StopFlag  # numba takes longer to load than a table

Item = TypeVar("Item")

DELIMITERS = ",;\t|"

SHEETS = (".xlsx", ".ods")
"""Endings of files that are not text."""

HEADER_ROWS = 12
"""So many rows at the top are looked through for the header."""

MAX_CHARACTERS = 20_000_000
"""Longest table that is read."""

MAX_COLUMNS = 1000
"""Most columns of a table."""

EMPTY_ROWS, SHEET_COLUMNS, SHEET_CELLS = 20_000, 16_384, 1_000_000
"""Most rows without an item where rows are limited; columns and cells of a sheet, of which one far out makes all."""

MAX_NAME = 200
"""Longest name of a column with its unit [characters]."""

TOTALS = {
    *("total", "totals", "sum", "mean", "average", "summe", "gesamt", "mittelwert"),
    *("totale", "somma", "somme", "suma"),
}
"""First cells of rows that are no objects."""

EMPTY = ("", "-", "\u2013", "n/a", "?")
"""Cells without a value."""

_UNIT = re.compile(r"[\[(]([^\[\]()]*)[\])]\s*$|[,/]\s*([^\s,/]{1,8})\s*$|\bin\s+([a-zA-Z]{1,8})\s*$")
MARK = "\ufeff"
_GAP = r"[\s'\u2019]"
_NUMBER = re.compile(
    r"\s*([+-]?[0-9][0-9.,'\u2019 \u00a0\u202f]*|[+-]?[.,][0-9]+)((?:(?<=[0-9.,])e[+-]?[0-9]+)?)\s*(.*?)\s*",
    re.DOTALL | re.IGNORECASE,
)


@dataclass(frozen=True)
class Column:
    """One quantity of a table.

    Attributes
    ----------
    name : str
        In Python and in tables that are written.
    unit : str
        SI unit; "-" for a number, "" for text, "bool" for yes or no.
    meaning : str
        In one sentence.
    aliases : tuple of str
        Other names in the headers of tables, in small letters without accents.
    """

    name: str
    unit: str
    meaning: str
    aliases: tuple[str, ...] = ()

    @property
    def label(self) -> str:
        """The name with its unit, in the header of a table."""
        return self.name if self.unit in ("", "-", "bool") else f"{self.name} [{self.unit}]"


NAME = Column(
    "name",
    "",
    "name of the object",
    (
        *("object", "item", "title", "id", "inventory number", "inventory no", "inv no", "inv nr", "no", "nr"),
        *("bezeichnung", "objekt", "inventarnummer", "nome", "oggetto", "inventario", "nom", "objet", "designation"),
        *("nombre", "objeto", "onoma", "antikeimeno"),
    ),
)
WIDTH = Column("width", "m", "width of the base", ("w", "breite", "larghezza", "largeur", "ancho", "anchura", "platos"))
HEIGHT = Column(
    "height",
    "m",
    "height of the object",
    ("h", "hohe", "hoehe", "altezza", "hauteur", "alto", "altura", "ypsos"),
)
RESTITUTION = Column(
    "restitution",
    "-",
    "coefficient of restitution; by default from the angular momentum",
    ("coefficient of restitution", "eta", "stosszahl", "restituzione", "restitucion"),
)


class TooManyRowsError(InvalidArgumentError):
    """A table has more rows than the caller takes; none of them was made an item."""


@dataclass(frozen=True)
class BadRow:
    """A row that was not read.

    Attributes
    ----------
    row : int
        Its number in the table, from 1.
    column : str
        Name of the column, "" for the whole row.
    reason : str
        What was found and what is allowed.
    """

    row: int
    column: str
    reason: str

    def __str__(self) -> str:
        return f"row {self.row}{f', {self.column}' if self.column else ''}: {self.reason}"


@dataclass(frozen=True)
class Schema(Generic[Item]):
    """What a table holds.

    Attributes
    ----------
    argument : str
        What errors call the table.
    columns : tuple of Column
        The columns that are read; others are passed through.
    required : tuple of tuple of str
        Columns that the header has; one of each group.
    make : callable
        The item of a row, from its number and the values of the cells that are not empty: texts as they stand, numbers
        in SI units. It raises `InvalidArgumentError`, with the name of a column.
    """

    argument: str
    columns: tuple[Column, ...]
    required: tuple[tuple[str, ...], ...]
    make: Callable[[int, dict[str, Any]], Item]


@dataclass(frozen=True)
class Table(Generic[Item]):
    """The rows of a table.

    Attributes
    ----------
    items : list
        One for each row that was read.
    cells : dict of str to list of str
        Every column of the table as it stands, by the text of its header, with its number where that is empty or not
        the first; for the rows that were read.
    columns : dict of str to str
        The name of the quantity in each of these columns that is read.
    units : dict of str to str
        The unit of each quantity that is read: of the header, or of the first cell with one, otherwise "".
    errors : list of (int, InvalidArgumentError)
        Number of each row that was not read, and why; the parameter is the column, "row" the whole row.
    """

    items: list[Item]
    cells: dict[str, list[str]] = field(default_factory=dict)
    columns: dict[str, str] = field(default_factory=dict)
    units: dict[str, str] = field(default_factory=dict)
    errors: list[tuple[int, InvalidArgumentError]] = field(default_factory=list)

    @property
    def bad_rows(self) -> list[BadRow]:
        """The rows that were not read, in words."""
        return [
            BadRow(row, *("", f"{one.value}; {one.allowed}") if one.parameter == "row" else (one.parameter, str(one)))
            for row, one in self.errors
        ]


def read_bytes(source: str | PathLike[str], argument: str) -> bytes:
    """The content of a file; `-` is standard input.

    Raises
    ------
    InvalidArgumentError
        If it cannot be read.
    """
    try:
        return sys.stdin.buffer.read() if source == "-" else Path(source).read_bytes()
    except OSError as error:
        raise InvalidArgumentError(argument, str(source), f"a file that can be read ({error.strerror})") from None


def read_file(source: str | PathLike[str], schema: Schema[Item]) -> Table[Item]:
    """A table from a file: a sheet (.xlsx, .ods), or CSV with any other ending; `-` is standard input.

    Raises
    ------
    InvalidArgumentError
        If the file cannot be read, its header lacks a column, or the decimal sign of a number is not certain.
    ImportError
        If the package for sheets is not installed, the extra `sheets`.
    """
    raw = read_bytes(source, schema.argument)
    if Path(source).suffix.lower() in SHEETS:
        return read_rows(rows_of_sheet(raw, schema.argument), schema)
    return read_csv(text_of(raw), schema)


def text_of(raw: bytes) -> str:
    """A text of UTF-8, UTF-16 with its mark, or the code page of older spreadsheets."""
    try:
        return raw.decode("utf-16" if raw[:2] in (b"\xff\xfe", b"\xfe\xff") else "utf-8-sig")
    except UnicodeDecodeError:
        return raw.decode("cp1252", "replace")


def read_csv(text: str, schema: Schema[Item], most: int | None = None, stop: StopFlag | None = None) -> Table[Item]:
    """A table from text; errors of `read_file`, of a line that is not CSV, of `most`. `stop` cancels the work."""
    delimiter = _delimiter(text, schema)
    # where commas separate the columns, a single point is the decimal sign
    usual = "." if delimiter == "," else ""
    return read_rows(_rows(_open(text), delimiter, schema, stop), schema, usual, most)


def rows_of_csv(text: str, schema: Schema[Any], stop: StopFlag | None = None) -> Iterator[str]:
    """The text of each row that `read_csv` counts, with its end; the errors of `read_csv`."""
    text = text.removeprefix(MARK)
    source, start = _open(text), 0
    for _ in _rows(source, _delimiter(text, schema), schema, stop):
        yield text[start : source.tell()]
        start = source.tell()


def _delimiter(text: str, schema: Schema[Any]) -> str:
    if len(text) > MAX_CHARACTERS:
        raise InvalidArgumentError(schema.argument, f"{len(text)} characters", f"at most {MAX_CHARACTERS}")
    sizes = dict.fromkeys(DELIMITERS, 0)
    for delimiter in DELIMITERS:
        with suppress(InvalidArgumentError):
            sizes[delimiter] = len(_header(_start(text, delimiter, schema), schema).columns)
    delimiter = max(DELIMITERS, key=sizes.__getitem__)
    if not sizes[delimiter]:
        _header(list(islice(_rows(_open(text), delimiter, schema), HEADER_ROWS)), schema)  # says what is missing
    return delimiter


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
            frame = pd.read_excel(file, header=None, dtype=object)
    except ImportError as error:
        raise ImportError("sheets need the extra `sheets`: pip install 'rocking[sheets]'", name=error.name) from None
    except (InvalidArgumentError, MemoryError):
        raise
    except Exception as error:  # noqa: BLE001  (the reader of sheets has its own errors)
        raise InvalidArgumentError(argument, str(error), "a sheet of a spreadsheet, .xlsx or .ods") from None
    return [list(map(_cell_text, row)) for row in frame.to_numpy().tolist()]


def csv_of_sheet(raw: bytes, argument: str) -> str:
    """The first sheet of a file as text with semicolons, whose numbers `read_csv` takes as they are in the sheet."""
    text = io.StringIO()
    rows = csv.writer(text, delimiter=";", lineterminator="\n")
    for row in rows_of_sheet(raw, argument):  # 1.250, with three decimals, could be 1250
        rows.writerow([f"{cell}0" if isinstance(cell, _Exact) and cell[-4:-3] == "." else cell for cell in row])
    return text.getvalue()


class _Exact(str):
    """A number of a sheet, whose decimal sign is a point whatever the texts of the table have."""

    __slots__ = ()


def _cell_text(value: object) -> str:
    """A cell of a sheet as text."""
    if value is None or value != value:
        return ""
    return _Exact(f"{value:.12g}") if isinstance(value, float) else str(value)


@dataclass(frozen=True)
class _Header:
    """The last line of the header, the texts of its cells, its columns: index to column and unit, "" in the cells."""

    last: int
    texts: list[str]
    columns: dict[int, tuple[Column, str]]


def _plain(text: str) -> str:
    """A name in small letters, without accents, signs and doubled blanks."""
    bare = "".join(one for one in unicodedata.normalize("NFKD", text.lower()) if not unicodedata.combining(one))
    return " ".join(re.sub(r"[^0-9a-z\u0370-\u03ff]+", " ", bare.replace("\u00df", "ss")).split())


def _name_and_unit(text: str) -> tuple[str, str]:
    """The parts of a header; "" without a unit."""
    found = _UNIT.search(text)
    return (text[: found.start()], next(filter(None, found.groups()), "").strip()) if found else (text, "")


def _column(text: str, names: Mapping[str, Column], argument: str) -> tuple[Column, str] | None:
    """The column that a header names, and its unit."""
    for name, written in ((text, ""), _name_and_unit(text)):
        one = names.get(_plain(name))
        if one is None:
            continue
        known = unit_name(written, one.unit) if written and one.unit in UNITS else None
        if written and one.unit in UNITS and known is None:
            raise InvalidArgumentError(f"{argument}, header", text, f"a unit such as {', '.join(UNITS[one.unit])}")
        return one, known or ("kg" if one.unit == "kg" else "")
    return None


def _header(rows: Sequence[Sequence[str]], schema: Schema[Any]) -> _Header:
    """The header among the first rows; where it has two lines, the lower one completes the upper one."""
    known = {_plain(name): one for one in schema.columns for name in (one.name, *one.aliases)}
    for last, row in enumerate(rows[:HEADER_ROWS]):
        if len(row) > MAX_COLUMNS:
            continue
        above = _merged(rows[last - 1], len(row)) if last else [""] * len(row)
        texts = [_joined(*pair) if max(map(len, pair)) <= MAX_NAME else "" for pair in zip(above, row, strict=True)]
        pairs = [(place, _column(text, known, schema.argument)) for place, text in enumerate(texts) if text.strip()]
        found = {place: one for place, one in pairs if one}
        names = Counter(one.name for one, _ in found.values())
        if not all(any(name in names for name in group) for group in schema.required):
            continue
        several = [name for name, count in names.items() if count > 1 and name != "name"]
        if several:
            raise InvalidArgumentError(
                f"{schema.argument}, header", "; ".join(texts)[:MAX_NAME], f"one column {several[0]}"
            )
        places = [place for place, (one, _) in found.items() if one.name == "name"]
        for place in places[:-1]:  # such as number and name: the last one counts
            del found[place]
        columns, after = _with_units(found, rows, last)
        return _Header(after, texts, columns)
    shown = "; ".join(rows[0])[:MAX_NAME] if rows else "nothing"
    needed = ", ".join(" or ".join(group) for group in schema.required)
    raise InvalidArgumentError(f"{schema.argument}, header", shown, f"columns {needed}, of at most {MAX_COLUMNS}")


def _joined(upper: str, lower: str) -> str:
    """The name of a column from two lines: the lower one with the unit of the upper, or the reverse."""
    _, unit = _name_and_unit(upper)
    if not lower.strip() or _is_unit(lower):
        return f"{upper} [{lower.strip('[]() ')}]" if lower.strip() else upper
    return lower if not unit or _name_and_unit(lower)[1] else f"{lower} [{unit}]"


def _is_unit(text: str) -> bool:
    """Whether a text is a unit of a quantity."""
    written = text.strip("[]() ")
    return any(unit_name(written, unit) for unit in UNITS) or written.lower() == "kg"


def _merged(row: Sequence[str], size: int) -> list[str]:
    """A line of a header in which merged cells leave empty ones to their right."""
    found: list[str] = []
    for text in [*row, *[""] * size][:size]:
        found.append(text.strip() or (found[-1] if found else ""))
    return found


def _with_units(
    found: dict[int, tuple[Column, str]], rows: Sequence[Sequence[str]], last: int
) -> tuple[dict[int, tuple[Column, str]], int]:
    """The columns with the units of a line of its own below the header, if there is one, and the last line of both."""
    below = [text.strip() for text in rows[last + 1]] if last + 1 < len(rows) else []
    units = {place: below[place] for place in found if place < len(below) and below[place] not in ("", "-")}
    if not units or not all(map(_is_unit, units.values())):
        return found, last
    for place, text in units.items():
        one, _ = found[place]
        if one.unit in UNITS:
            found[place] = one, unit_name(text.strip("[]() "), one.unit) or ""
    return found, last + 1


def read_rows(
    rows: Iterable[Sequence[str]], schema: Schema[Item], usual: str = "", most: int | None = None
) -> Table[Item]:
    """A table from its cells, its header among the first rows; the errors of `read_file`.

    `usual` is the decimal sign where no number settles it; "": the table is refused. Beyond `most` rows, without those
    that are empty or totals, it is refused by `TooManyRowsError`.
    """
    rest = iter(rows)
    top = list(islice(rest, HEADER_ROWS + 1))  # with a line of units
    header = _header(top, schema)
    body: list[tuple[int, Sequence[str]]] = []
    for number, row in enumerate(chain(top[header.last + 1 :], rest), start=header.last + 2):
        if _is_item(row):
            if len(body) == most:
                raise TooManyRowsError(schema.argument, f"more than {most} rows", f"at most {most}")
            body.append((number, row))
        elif most is not None and number - len(body) > EMPTY_ROWS:
            allowed = f"at most {EMPTY_ROWS} rows that are empty or totals"
            raise TooManyRowsError(schema.argument, f"{number} rows", allowed)
    numeric = [place for place, (one, _) in header.columns.items() if one.unit]
    measured = [place for place in numeric if header.columns[place][0].unit not in ("-", "kg")]
    decimal = _decimal_sign(
        (row[place] for _, row in body for place in numeric if place < len(row) and not isinstance(row[place], _Exact)),
        schema.argument,
        usual,
    )
    items, kept, errors = [], [], []
    for number, row in body:
        try:
            if any(cell.strip() for cell in row[len(header.texts) :]):
                raise InvalidArgumentError("row", f"{len(row)} cells", f"{len(header.texts)}, as in the header")
            if not any(place < len(row) and row[place].strip() for place in measured):
                raise InvalidArgumentError("row", "no dimension", "one or more in each row")
            items.append(schema.make(number, _values(row, header, decimal)))
            kept.append(row)
        except InvalidArgumentError as error:
            errors.append((number, _of_cell(error, row, header)))
    size = len(header.texts)
    padded = [[*row[:size], *[""] * (size - len(row))] for row in kept]
    first: dict[str, int] = {}
    labels = [
        text if text.strip() and first.setdefault(text, place) == place else f"{text}#{place + 1}"
        for place, text in enumerate(header.texts)
    ]
    cells = {label: [row[place] for row in padded] for place, label in enumerate(labels)}
    cells = {label: column for label, column in cells.items() if not label.startswith("#") or any(column)}
    read = {labels[place]: one.name for place, (one, _) in header.columns.items()}
    units = {
        one.name: unit or next((written for row in padded if (written := _written_unit(row[place], one))), "")
        for place, (one, unit) in header.columns.items()
    }
    return Table(items, cells, read, units, errors)


def _is_item(row: Sequence[str]) -> bool:
    """Whether a row has values, and is not one of totals."""
    first = next(filter(None, map(str.strip, row)), "")
    return (
        bool(first) and first.lower().removesuffix(":").rstrip() not in TOTALS and any(map(str.isalnum, "".join(row)))
    )


def _written_unit(cell: str, one: Column) -> str:
    """The unit in a cell, "" for none."""
    found = _NUMBER.fullmatch(cell) if len(cell) <= MAX_LENGTH and one.unit in UNITS else None
    return (unit_name(found[3], one.unit) or "") if found else ""


def _values(row: Sequence[str], header: _Header, decimal: str) -> dict[str, Any]:
    """The values of a row by the name of their columns."""
    cells = [(one, unit, row[place]) for place, (one, unit) in header.columns.items() if place < len(row)]
    return {one.name: _value(one, text, unit, decimal) for one, unit, text in cells if text.strip() not in EMPTY}


def _of_cell(error: InvalidArgumentError, row: Sequence[str], header: _Header) -> InvalidArgumentError:
    """The error with the text of the cell in place of its value in SI units."""
    for place, (one, _) in header.columns.items():
        if one.name == error.parameter and place < len(row) and row[place].strip() not in EMPTY:
            return InvalidArgumentError(one.name, row[place].strip(), error.allowed)
    return error


def _value(one: Column, cell: str, unit: str, decimal: str) -> Any:
    """The value of a cell in the unit of its column, in SI units."""
    if one.unit == "":
        return cell
    text, decimal = cell.strip(), "." if isinstance(cell, _Exact) else decimal
    if one.name == "restitution" and text.lower() == "momentum":
        return "momentum"
    found = _NUMBER.fullmatch(text) if len(text) <= MAX_LENGTH else None
    if not found:
        raise InvalidArgumentError(one.name, text[:MAX_LENGTH], "a number, with its unit or with one in the header")
    written = found[1].strip()
    if re.search(_GAP, written) and not re.fullmatch(rf"[+-]?\d{{1,3}}(?:{_GAP}\d{{3}})+(?:[.,]\d*)?", written):
        raise InvalidArgumentError(one.name, text, "one number, with blanks between thousands only")
    digits = re.sub(_GAP, "", written)
    thousands = "." if decimal == "," else ","
    if not re.fullmatch(rf"[+-]?(\d*|\d{{1,3}}(?:{re.escape(thousands)}\d{{3}})+)(?:{re.escape(decimal)}\d*)?", digits):
        raise InvalidArgumentError(one.name, text, f"a number with the decimal sign {decimal!r} of the table")
    value = float(digits.replace(thousands, "").replace(decimal, ".") + found[2])
    if one.unit not in UNITS:  # kg
        factor = {"": 1.0, "kg": 1.0, "t": 1000.0, "g": 0.001}.get(found[3].lower())
        if factor is None:
            raise InvalidArgumentError(one.name, text, "a mass in kg, g or t")
        return value * factor
    name = unit_name(found[3], one.unit) if found[3] else unit
    if found[3] and name is None:
        raise InvalidArgumentError(one.name, text, f"a unit such as {', '.join(UNITS[one.unit])}")
    if not name and one.unit != "-":
        usual = USUAL[one.unit][-1]
        raise InvalidArgumentError(
            one.name, text, f"a unit: write {one.name} [{usual}] in the header, or {text} {usual} in the cell"
        )
    return value * (UNITS[one.unit][name] if name else 1.0)


def _decimal_sign(cells: Iterable[str], argument: str, usual: str) -> str:
    """The decimal sign of a table.

    Raises
    ------
    InvalidArgumentError
        If its numbers use both signs, or have one sign that may separate thousands and no other number settles it.
    """
    signs: dict[str, str] = {}
    for cell in cells:
        found = _NUMBER.fullmatch(cell) if len(cell) <= MAX_LENGTH else None
        digits = re.sub(_GAP, "", found[1]) if found else ""
        used = [sign for sign in digits if sign in ".,"]
        if not used:
            continue
        last = used[-1]
        if len(set(used)) == 2:
            signs[last] = cell
        elif len(used) > 1:
            if re.fullmatch(r"[+-]?\d{1,3}(?:[.,]\d{3})+", digits):
                signs["," if last == "." else "."] = cell
        elif (
            last != usual
            and len(digits.rsplit(last, 1)[1]) == 3
            and re.fullmatch(r"[+-]?[1-9]\d{0,2}", digits.rsplit(last, 1)[0])
        ):
            signs.setdefault("?" + last, cell)
        else:
            signs[last] = cell
    certain = {sign: cell for sign, cell in signs.items() if sign in ".,"}
    if len(certain) == 2:
        raise InvalidArgumentError(argument, list(certain.values()), "one decimal sign in the whole table")
    unsettled = [cell for sign, cell in signs.items() if sign.startswith("?")]
    if unsettled and not certain:
        raise InvalidArgumentError(
            argument, unsettled[0], "a number whose decimal sign is certain, such as 1.2340 or 1234"
        )
    return next(iter(certain), ".")
