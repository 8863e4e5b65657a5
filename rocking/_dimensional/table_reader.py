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
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from itertools import chain, islice
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from rocking._base.column import (
    Column,
    decimal_sign,
    name_and_unit,
    named,
    plain_name,
    read_header,
    split_number,
    stated_unit,
)
from rocking._base.errors import InvalidArgumentError
from rocking._base.units import UNITS, unit_name

if TYPE_CHECKING:
    from rocking._numba.cancellation import StopFlag  # numba takes longer to load than a table

Item = TypeVar("Item")

DELIMITERS = ",;\t|"

SHEETS = (".xlsx", ".ods")
"""Endings of files that are not text."""

HEADER_ROWS = 12
"""The header is searched in this many rows at the top."""

MAX_CHARACTERS = 20_000_000
"""Longest table that is read."""

MAX_COLUMNS = 1000
"""Most columns of a table."""

EMPTY_ROWS, SHEET_COLUMNS, SHEET_CELLS = 20_000, 16_384, 1_000_000
"""Most rows without an item where rows are limited; columns and cells of a sheet, of which one far out makes all."""

MAX_NAME = 200
"""Longest name of a column with its unit [characters]."""

_TOTAL = re.compile(
    r"(?:sub)?(?:totals?|sum|mean|average|summe|gesamt(?:summe)?|insgesamt|mittelwert|totale|somma|somme|suma|count|media|moyenne)"
    r"\s*(?:[:(\d].*|(?:of|all|objects?|items?|pieces|weight|number|objekte|oggetti|objets|objetos)\b.*)?",
    re.IGNORECASE | re.DOTALL,
)
"""First cells of rows that are no objects: "Total", "Sum (12 objects)", not "Total Eclipse"."""

EMPTY = {
    *("", "-", "--", "\u2013", "\u2014", "?", "n/a", "na", "n.a.", "#n/a", "none", "null", "nan", "nil"),
    *("k.a.", "k. a.", "unknown", "unbekannt", "sconosciuto", "inconnu", "desconocido"),
}
"""Cells without a value, in small letters."""

UNIT_NAMES = {
    *("unit", "units", "uom", "unit of measure", "unit of measurement", "measurement unit", "units of measure"),
    *("einheit", "einheiten", "masseinheit", "unita", "unita di misura", "unite", "unites", "unite de mesure"),
    *("unidad", "unidades", "unidad de medida", "monada", "\u03bc\u03bf\u03bd\u03b1\u03b4\u03b1"),
}
"""Headers of a column with the units of the others."""

SIZE_NAMES = {
    *("dimension", "dimensions", "size", "sizes", "measurement", "measurements", "measure", "measures", "length"),
    *("lengths", "dim", "dims", "masse", "abmessung", "abmessungen", "dimensioni", "misure", "mesures", "medidas"),
    *("dimensiones", "diastaseis", "\u03b4\u03b9\u03b1\u03c3\u03c4\u03b1\u03c3\u03b5\u03b9\u03c2"),
}
"""Words for all lengths of a table."""

_WITH_SIZES = {*("all", "in", "of", "the", "overall", "outer", "external", "object", "objects", "alle", "tutte", "le")}
_LENGTH_WORD = re.compile(
    r"width|breadth|depth|length|height|thick|diam|radius|girth|circumf|\bside\b|\bbase\b|footprint|dimension|\bsize\b"
    r"|breit|tief|lange|hoh|hoeh|dick|stark|largh|profond|lungh|altez|spess|largeur|longueur|hauteur|epais|ancho|altura"
    r"|largo|espes|grosor|fondo|platos|ypsos|vathos|pachos|mikos|^[a-z][12]?$"
)
_NO_LENGTH = re.compile(
    r"year|date|period|found|acquired|signed|gallery|hall|saal|sala|condition|zustand|stato|etat|rank|priority|class|categor"
    r"|century|jahr|anno|annee|\bano\b|made|qty|quantit|count|pieces|anzahl|stuck|value|price|cost|wert|preis"
    r"|valore|prezzo|valeur|prix|valor|precio|room|raum|floor|level|stockwerk|shelf|case|page|number|\bno\b|\bnr\b|id$"
    r"|code|index|age|\blot\b|weight|mass|score|rating|angle|percent"
)
_LAST_UNIT = re.compile(r"\s(?:in|m)\s*$", re.IGNORECASE)
_AMOUNT = re.compile(r"\W*(?:c|ca|circa|approx\w*|about|um|env\w*|max|min)?[\s.:]*\d", re.IGNORECASE)
_UNUSED = ("unused", "not used")
MARK = "\ufeff"
"""What some programs put before a text of UTF-8."""


NAME = Column(
    "name",
    "",
    "name of the object",
    (
        *("object", "object name", "title", "item", "bezeichnung", "objekt", "titel", "nome", "oggetto", "titolo"),
        *("nom", "objet", "designation", "titre", "nombre", "objeto", "titulo", "onoma", "antikeimeno"),
        *("\u03bf\u03bd\u03bf\u03bc\u03b1", "\u03b1\u03bd\u03c4\u03b9\u03ba\u03b5\u03b9\u03bc\u03b5\u03bd\u03bf"),
    ),
)
NUMBER = Column(
    "number",
    "",
    "inventory number, the name of an object without another one",
    (
        *("inventory number", "inventory no", "inv number", "inv no", "inv nr", "inventarnummer", "inventario"),
        *("object number", "object id", "accession number", "accession no", "catalogue number", "catalog number"),
        *("numero di inventario", "numero d inventaire", "numero de inventario", "id", "no", "nr", "#"),
    ),
    stands_for=("name",),
)
"""Read where a table has no names."""
WIDTH = Column(
    "width",
    "m",
    "width of the base",
    (
        *("w", "b", "breadth", "base width", "width of base", "width of the base", "breite", "larghezza", "largeur"),
        *("ancho", "anchura", "largura", "breedte", "platos", "\u03c0\u03bb\u03b1\u03c4\u03bf\u03c2"),
    ),
    absent_beside=("diameter",),
)
HEIGHT = Column(
    "height",
    "m",
    "height of the object",
    (
        *("h", "overall height", "total height", "hohe", "hoehe", "gesamthohe", "altezza", "hauteur", "alto", "altura"),
        *("hoogte", "ypsos", "\u03c5\u03c8\u03bf\u03c2"),
    ),
)
RESTITUTION = Column(
    "restitution",
    "-",
    "coefficient of restitution; by default from the angular momentum",
    ("coefficient of restitution", "restitution coefficient", "eta", "stosszahl", "restituzione", "restitucion"),
    words=("momentum",),
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
        The item of a row, from its number, the values of the cells that are not empty: texts as they stand, numbers in
        SI units; and the cells of all other columns, texts that are read included, by their headers. It raises
        `InvalidArgumentError`, with the name of a column.
    every_length : bool
        Whether a length in a column that is not read refuses its row.
    renamed : mapping of str to str
        Names of columns that replace those of the header, whose units remain.
    """

    argument: str
    columns: tuple[Column, ...]
    required: tuple[tuple[str, ...], ...]
    make: Callable[[int, dict[str, Any], dict[str, str]], Item]
    every_length: bool = False
    renamed: Mapping[str, str] = field(default_factory=dict)


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
    sizes = {one: max(map(_fit, _lines(_start(text, one, schema), schema)), default=(0, 0)) for one in DELIMITERS}
    delimiter = max(DELIMITERS, key=sizes.__getitem__)
    if not sizes[delimiter][0]:
        list(islice(_rows(_open(text), delimiter, schema), HEADER_ROWS))  # says which line is not CSV
    return delimiter


def _fit(line: _Line) -> tuple[bool, int]:
    """Whether a line has all columns that a header needs, and how many that are read."""
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


def csv_of_sheet(raw: bytes, schema: Schema[Any]) -> str:
    """The first sheet of a file as text with semicolons, which `read_csv` reads as `read_file` does the sheet.

    A number of a cell that `read_csv` could take for another has a zero added. A text that could be either of two
    numbers has a leading apostrophe unless other texts of the sheet settle its decimal sign.
    """
    rows = rows_of_sheet(raw, schema.argument)
    numeric: list[int] = []
    last = len(rows)
    with suppress(InvalidArgumentError):
        header = _header(rows[: HEADER_ROWS + 1], schema)
        numeric, last = [place for place, (one, _) in header.columns.items() if one.unit], header.last
    decimal = _decimal_sign((row[place] for row in rows[last + 1 :] for place in numeric), "")

    def certain(cell: str) -> str:
        digits, _ = split_number(cell) or ("", "")
        own = decimal_sign(digits)
        if not own.startswith("?"):
            return cell
        if isinstance(cell, _Exact):
            return f"{cell}0"
        if not decimal:
            return f"'{cell}"
        changed = f"{digits}0" if own[1] == decimal else digits.replace(own[1], "")
        return cell.strip().replace(digits, changed, 1)

    text = io.StringIO()
    written = csv.writer(text, delimiter=";", lineterminator="\n")
    for number, row in enumerate(rows):
        written.writerow([certain(cell) if number > last and k in numeric else cell for k, cell in enumerate(row)])
    return text.getvalue()


class _Exact(str):
    """A number of a sheet, whose decimal sign is a point whatever the texts of the table have."""

    __slots__ = ()


def _cell_text(value: object) -> str:
    """A cell of a sheet as text."""
    if value is None or value != value:
        return ""
    if not isinstance(value, float):
        return str(value)
    return _Exact(int(value) if value.is_integer() and abs(value) < 1e15 else f"{value:.15g}")


@dataclass(frozen=True)
class _Line:
    """A line that may be the header.

    Attributes
    ----------
    number : int
        From 0.
    cells, labels, texts : list of str
        Its cells; completed by the line above, with their number where one is empty or not the first; completed, under
        the names that were given to them.
    columns : dict of int to (Column, str)
        Quantities that are read, with their units.
    grouped : set of int
        Columns in a group of lengths that are not read.
    complete : bool
        Whether it has all columns that a header needs.
    error : InvalidArgumentError or None
        Its first unit that is not understood.
    """

    number: int
    cells: list[str]
    labels: list[str]
    texts: list[str]
    columns: dict[int, tuple[Column, str]]
    grouped: set[int]
    complete: bool
    error: InvalidArgumentError | None


@dataclass(frozen=True)
class _Header:
    """What the header says.

    Attributes
    ----------
    last : int
        Its last line.
    labels : list of str
        Its cells as they stand, with their number where one is empty or not the first.
    texts : list of str
        Its cells, under the names that were given to them.
    columns : dict of int to (Column, str)
        Quantities that are read, with their units, "" in the cells.
    units : dict of int to int
        Column with the units of a column, by the place of that.
    lengths : dict of int to bool
        Columns that are not read and may hold a length; whether it says so by its unit.
    """

    last: int
    labels: list[str]
    texts: list[str]
    columns: dict[int, tuple[Column, str]]
    units: dict[int, int]
    lengths: dict[int, bool]


def _lines(rows: Sequence[Sequence[str]], schema: Schema[Any]) -> Iterator[_Line]:
    """The lines that may be the header, the first ones; where it has two, the lower one is completed by the upper."""
    known = {plain_name(name): one for one in schema.columns for name in (one.name, *one.aliases)}
    for number, row in enumerate(rows[:HEADER_ROWS]):
        if len(row) > MAX_COLUMNS:
            continue
        own = [*rows[number - 1], *[""] * len(row)][: len(row)] if number else [""] * len(row)
        if not all(map(_is_unit, filter(None, map(str.strip, own)))):
            own = ["" if _is_unit(text) else text for text in own]
        above = zip(_merged(own), own, row, strict=True)
        pairs = [_joined(*one, known) if max(map(len, one)) <= MAX_NAME else ("", False) for one in above]
        texts = [_renamed(text, schema.renamed) for text, _ in pairs]
        found: dict[int, tuple[Column, str]] = {}
        error = None
        for place, text in enumerate(texts):
            try:
                one = read_header(text, known, schema.argument) if _is_used(text) else None
            except InvalidArgumentError as wrong:
                column = named(name_and_unit(text)[0], known)
                error, one = error or wrong, (column, "") if column else None
            if one:
                found[place] = one
        found = _assigned(found, texts, schema)
        names = {one.name for one, _ in found.values()}
        complete = all(any(name in names for name in group) for group in schema.required)
        labels = _labels([text for text, _ in pairs])
        groups = {k for k, (_, group) in enumerate(pairs) if group and any(map(str.strip, own[1:]))}  # not by a title
        yield _Line(number, [*row], labels, texts, found, groups, complete, error)


def _header(rows: Sequence[Sequence[str]], schema: Schema[Any]) -> _Header:
    """The header among the first rows."""
    line = next((line for line in _lines(rows, schema) if line.complete), None)
    if line is None:
        shown = "; ".join(rows[0])[:MAX_NAME] if rows else "nothing"
        needed = ", ".join(" or ".join(group) for group in schema.required)
        raise InvalidArgumentError(f"{schema.argument}, header", shown, f"columns {needed}, of at most {MAX_COLUMNS}")
    if line.error is not None:
        raise line.error
    for name in schema.renamed.keys() - set(map(str.strip, line.labels)):
        raise InvalidArgumentError("columns", name, f"a column of the table: {'; '.join(line.labels)[:MAX_NAME]}")
    count = Counter(one.name for one, _ in line.columns.values() if one.unit)
    for name in (name for name, several in count.items() if several > 1):
        same = "; ".join(line.texts[place] for place, (one, _) in line.columns.items() if one.name == name)
        allowed = f'one column {name}; the name of a column that is not read begins with "unused"'
        raise InvalidArgumentError(f"{schema.argument}, header", same[:MAX_NAME], allowed)
    columns, lengths, after = _with_units(line, rows, schema)
    units = _unit_columns(line.texts, columns)
    lengths = dict.fromkeys(sorted(_beside(line, columns, units)), False) | lengths
    return _Header(after, line.labels, line.texts, columns, units, lengths)


def _is_used(text: str) -> bool:
    return bool(text.strip()) and not plain_name(text).startswith(_UNUSED)


def _renamed(text: str, renamed: Mapping[str, str]) -> str:
    """The text of a header under the name that it was given, with its own unit."""
    if text.strip() not in renamed:
        return text
    name, (_, unit) = renamed[text.strip()], name_and_unit(text)
    if name in _UNUSED:
        return f"{name}: {text}"
    return f"{name} [{unit}]" if unit and not name_and_unit(name)[1] else name


def _assigned(
    found: dict[int, tuple[Column, str]], texts: Sequence[str], schema: Schema[Any]
) -> dict[int, tuple[Column, str]]:
    """The columns as what they are read: those that stand for others, and of several with names the best one."""
    known = {one.name: one for one in schema.columns}
    for column in schema.columns:
        places = [place for place, (one, _) in found.items() if one is column]
        if not column.unit and not column.joined and places:
            best = min(places, key=lambda place: column.rank(texts[place]))
            found = {place: pair for place, pair in found.items() if place == best or place not in places}
            places = [best]
        if not column.stands_for:
            continue
        taken = {one.name for one, _ in found.values()}
        target = next((name for name in column.stands_for if name not in taken), None)
        if target is None:
            found = {place: pair for place, pair in found.items() if place not in places}
        else:
            found |= {place: (known[target], found[place][1]) for place in places}
    return found


def _joined(upper: str, own: str, lower: str, known: Mapping[str, Column]) -> tuple[str, bool]:
    """The name of a column from two lines, and whether it is in a group of lengths.

    Parameters
    ----------
    upper, own, lower : str
        Cell of the upper line, or the one of the group to its left; that cell itself; cell of the lower line.
    known : mapping
        Columns by their names.
    """
    if not lower.strip():
        return own, False
    with suppress(InvalidArgumentError):
        one = read_header(own, known, "")
        bare = lower.strip("[]() ")
        if one and one[0].unit in UNITS and not one[1] and unit_name(bare, one[0].unit):
            return f"{own} [{bare}]", False
        unit = _group_unit(upper, known)
        below = read_header(lower, known, "") if unit else None
        if below and not below[1] and unit_name(unit, below[0].unit if below[0].unit in UNITS else "m"):
            return (f"{lower} [{unit}]" if below[0].unit in UNITS else lower), False
        return lower, below is None and unit_name(unit, "m") is not None
    return lower, False


def _group_unit(text: str, known: Mapping[str, Column]) -> str:
    """The unit that an upper line states for the columns below: "Dimensions (cm)", "[cm]"; "" for a title."""
    if _is_unit(text):
        return text.strip("[]() ")
    name, unit = name_and_unit(text)
    words = set(plain_name(name).split())
    is_group = plain_name(name) in known or (bool(words & SIZE_NAMES) and words <= SIZE_NAMES | _WITH_SIZES)
    return unit if is_group else ""


def _is_unit(text: str) -> bool:
    """Whether a text is a unit of a quantity."""
    return any(unit_name(text.strip("[]() "), unit) for unit in UNITS)


def _merged(row: Sequence[str]) -> list[str]:
    """A line of a header in which merged cells leave empty ones to their right."""
    found: list[str] = []
    for text in row:
        found.append(text.strip() or (found[-1] if found and not _is_unit(found[-1]) else ""))
    return found


def _with_units(
    line: _Line, rows: Sequence[Sequence[str]], schema: Schema[Any]
) -> tuple[dict[int, tuple[Column, str]], dict[int, bool], int]:
    """The columns with the units of a line of its own below the header, if there is one; lengths that are not read."""
    columns, last = dict(line.columns), line.number
    others = [place for place, text in enumerate(line.texts) if place not in columns and _is_used(text)]
    lengths = {place: True for place in others if stated_unit(line.texts[place], "m")}
    below = [text.strip("[]() ") for text in rows[last + 1]] if last + 1 < len(rows) else []
    units = {
        place: below[place]
        for place, (one, _) in columns.items()
        if one.unit in UNITS and place < len(below) and below[place] not in ("", "-")
    }
    known = {place: unit_name(text, columns[place][0].unit) for place, text in units.items()}
    if all(map(_is_unit, units.values())) and any(text != "1" for text in units.values()):
        last += 1
        for place, unit in known.items():
            one, stated = columns[place]
            if not unit or stated not in ("", unit):
                allowed = f"a unit of {one.name}, the one of its header"
                raise InvalidArgumentError(
                    f"{schema.argument}, header", f"{line.texts[place]}; {units[place]}", allowed
                )
            columns[place] = one, unit
        lengths |= {place: True for place in others if place < len(below) and unit_name(below[place], "m")}
    names = {place: plain_name(name_and_unit(line.texts[place])[0]) for place in others}
    weak = set()
    for place, name in names.items():
        found = _LENGTH_WORD.search(name)
        exempt = _NO_LENGTH.search(name) and (found is None or found[0] in ("base", "side", "size"))  # "base price"
        if (found or _LAST_UNIT.search(line.texts[place])) and not exempt:
            weak.add(place)
    weak |= line.grouped & set(others)
    return columns, dict.fromkeys(sorted(weak), False) | lengths, last


def _beside(line: _Line, columns: Mapping[int, tuple[Column, str]], units: Mapping[int, int]) -> set[int]:
    """Columns that are not read and may be a length without a unit: between those of lengths, anywhere beside headers
    without units.
    """
    measured = [place for place, (one, _) in columns.items() if one.unit == "m"]
    first, last = min(measured, default=0), max(measured, default=0)
    if not all(stated_unit(line.cells[place], "m") for place in measured):
        first, last = 0, len(line.texts)
    found = set()
    for place, text in enumerate(line.texts[: last + 1]):
        name = plain_name(name_and_unit(text)[0])
        if (
            place >= first
            and place not in columns
            and place not in units.values()
            and (text.strip() or 0 < place < last)
        ):
            found |= {place} if not name.startswith(_UNUSED) and not _NO_LENGTH.search(name) else set()
    return found


def _unit_columns(texts: Sequence[str], columns: Mapping[int, tuple[Column, str]]) -> dict[int, int]:
    """The place of the column that has the units of each column of numbers, where there is one."""
    found: dict[int, int] = {}
    plain = {place: plain_name(text) for place, text in enumerate(texts) if place not in columns}
    bare = [place for place, text in plain.items() if text in UNIT_NAMES]
    numeric = [place for place, (one, _) in columns.items() if one.unit in UNITS]
    for place, text in plain.items():
        of = re.sub(r"\b(?:units?|einheit|unita|unite|unidad)\b(?: of| de| di)?", "", text).strip()
        if place in bare or of == text:
            continue
        named = [k for k in numeric if plain_name(columns[k][0].name) == of or plain_name(texts[k]) == of]
        if of in SIZE_NAMES:
            named = [k for k in numeric if columns[k][0].unit == "m"]
        found |= dict.fromkeys(named, place)
    start = -1
    for place in bare:  # of several, each states those of the columns between it and the one before
        found |= {k: place for k in numeric if k not in found and (len(bare) == 1 or start < k < place)}
        start = place
    return found


def read_rows(
    rows: Iterable[Sequence[str]], schema: Schema[Item], usual: str = "", most: int | None = None
) -> Table[Item]:
    """A table from its cells, its header among the first rows; the errors of `read_file`.

    `usual` is the decimal sign where no number settles it; "": rows with a number that needs it are not read. Beyond
    `most` rows, without those that are empty or totals, the table is refused by `TooManyRowsError`.
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
    decimal = _decimal_sign((row[place] for _, row in body for place in numeric if place < len(row)), usual)
    labels = header.labels
    used = {place for place, (one, _) in header.columns.items() if one.unit or one.name == "name"}
    used |= set(header.units.values())
    items: list[Item] = []
    kept: list[Sequence[str]] = []
    errors: list[tuple[int, InvalidArgumentError]] = []
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
            errors.append((number, _of_cell(error, row, header)))
    size = len(header.texts)
    padded = [[*row[:size], *[""] * (size - len(row))] for row in kept]
    columns = {label: [row[place] for row in padded] for place, label in enumerate(labels)}
    columns = {label: column for label, column in columns.items() if not label.startswith("#") or any(column)}
    read = {labels[place]: one.name for place, (one, _) in header.columns.items()}
    read |= {labels[place]: "units" for place in header.units.values()}
    units = {
        one.name: unit or next((written for row in padded if (written := _written_unit(row[place], one))), "")
        for place, (one, unit) in header.columns.items()
    }
    return Table(items, columns, read, units, errors)


def _labels(texts: Sequence[str]) -> list[str]:
    """The texts of a header, with its number where one is empty or not the first."""
    first: dict[str, int] = {}
    return [
        text if text.strip() and first.setdefault(text, place) == place else f"{text}#{place + 1}"
        for place, text in enumerate(texts)
    ]


def _is_item(row: Sequence[str]) -> bool:
    """Whether a row has values, and is not one of totals."""
    first = next(filter(None, map(str.strip, row)), "")
    return bool(first) and not _TOTAL.fullmatch(first[:MAX_NAME]) and any(map(str.isalnum, "".join(row)))


def _written_unit(cell: str, one: Column) -> str:
    """The unit in a cell, "" for none."""
    found = split_number(cell) if one.unit in UNITS else None
    return (unit_name(found[1], one.unit) or "") if found else ""


def _values(row: Sequence[str], header: _Header, decimal: str, schema: Schema[Any]) -> dict[str, Any]:
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
        value = one.value(cell, stated, "." if isinstance(cell, _Exact) else decimal)
        values[one.name] = f"{values[one.name]}; {value}" if one.name in values else value
    for one, _ in header.columns.values():
        if values.get(one.name) == 0.0 and any(values.get(other) for other in one.absent_beside):
            del values[one.name]
    if schema.every_length and "name" not in values and not _has_text(row, header):
        raise InvalidArgumentError("row", "numbers only", "a name or another text, which totals lack")
    if not any(one.unit not in ("", "-", "kg") and one.name in values for one, _ in header.columns.values()):
        raise InvalidArgumentError("row", "no dimension", "one or more in each row")
    return values


def _has_text(row: Sequence[str], header: _Header) -> bool:
    """Whether a row of a table with names has a text."""
    if not any(one.name == "name" for one, _ in header.columns.values()):
        return True
    numeric = {place for place, (one, _) in header.columns.items() if one.unit}
    texts = (cell for place, cell in enumerate(row) if place not in numeric and not _is_unit(cell))
    return any(map(str.isalnum, "".join(texts)))


def _row_unit(row: Sequence[str], header: _Header, place: int) -> str:
    """The unit of a cell that states none: of its header, or of the column with the units."""
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


def _check_lengths(row: Sequence[str], header: _Header) -> None:
    """Refuse a row with a length in a column that is not read.

    Raises
    ------
    InvalidArgumentError
        Of that column.
    """
    for place, text in enumerate(header.texts[: len(row)]):
        cell = row[place].strip()
        if place in header.columns or place in header.units.values() or cell.lower() in EMPTY:
            continue
        if text.strip() and not _is_used(text):
            continue
        number = split_number(cell)
        is_length = bool(number and unit_name(number[1], "m"))  # in its cell
        if place in header.lengths:
            is_length |= bool(_AMOUNT.match(cell) if header.lengths[place] else number and not number[1])
        if is_length and not (number and not number[0].strip("+-0.,")):
            allowed = 'a column named "width", "depth", "diameter" or "height", or whose name begins with "unused"'
            raise InvalidArgumentError(header.labels[place].strip(), cell, allowed)


def _of_cell(error: InvalidArgumentError, row: Sequence[str], header: _Header) -> InvalidArgumentError:
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
        if own and (not own.startswith("?") or own[1] == usual):
            signs.add(own[-1])
    return signs.pop() if len(signs) == 1 else ""
