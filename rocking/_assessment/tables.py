"""Tables of objects as people keep them: CSV with any separator and decimal sign, JSON, and sheets as an extra.

Units stand in the header ("width [cm]", "Breite (cm)", "height, m") or in the cells ("40 cm"). A number whose decimal
sign is not certain, such as "1,234", is not read: the table is refused unless other numbers of it settle the sign.
"""

from __future__ import annotations

import csv
import io
import json
import re
import unicodedata
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, fields
from os import PathLike
from pathlib import Path
from typing import Any

from rocking._assessment.columns import INPUTS, Column
from rocking._assessment.objects import Object
from rocking._base.errors import InvalidArgumentError
from rocking._base.units import MAX_LENGTH, UNITS, unit_name

DELIMITERS = ",;\t|"

HEADER_ROWS = 12
"""So many rows at the top are looked through for the header."""

MAX_CHARACTERS = 20_000_000
"""Longest table that is read."""

TOTALS = {
    "total",
    "totals",
    "sum",
    "summe",
    "gesamt",
    "totale",
    "somma",
    "somme",
    "suma",
    "mean",
    "average",
    "mittelwert",
}
"""First words of rows that are no objects."""

_SIZED = {one.name for one in INPUTS if one.unit == "m"}
_UNIT = re.compile(r"[\[(]\s*([^\[\]()]*?)\s*[\])]\s*$|[,/]\s*([^\s,/]{1,8})\s*$|\bin\s+([a-zA-Z]{1,8})\s*$")
_GAP = r"[\s'\u2019]"
_NUMBER = re.compile(r"\s*([+-]?[0-9][0-9.,'\u2019 \u00a0\u202f]*|[+-]?[.,][0-9]+)\s*(.*?)\s*", re.DOTALL)


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
class ObjectTable:
    """Objects of a table, and the rows that could not be read.

    Attributes
    ----------
    objects : list of Object
        In the order of the rows.
    bad_rows : list of BadRow
        Rows that name no valid object.
    skipped : list of str
        Headers of columns that are not used.
    """

    objects: list[Object]
    bad_rows: list[BadRow] = field(default_factory=list)
    skipped: list[str] = field(default_factory=list)


def read_objects(source: str | PathLike[str]) -> ObjectTable:
    """Read objects from a file: CSV (any ending), JSON (.json), or a sheet (.xlsx, .ods).

    Raises
    ------
    InvalidArgumentError
        If the file cannot be read, has no header with a base and a height, or a number is ambiguous.
    ImportError
        If the packages for sheets are not installed: pandas with openpyxl or odfpy.
    """
    path = Path(source)
    try:
        raw = path.read_bytes()
    except OSError as error:
        raise InvalidArgumentError("objects", str(path), f"a file that can be read ({error.strerror})") from None
    if path.suffix.lower() in (".xlsx", ".ods"):
        return objects_of_rows(_sheet(raw))
    return objects_of_text(raw, json=path.suffix.lower() == ".json")


def objects_of_text(raw: bytes, *, json: bool) -> ObjectTable:
    """Objects from the bytes of a text, JSON or CSV; the errors of `read_objects`."""
    try:
        text = raw.decode("utf-16" if raw[:2] in (b"\xff\xfe", b"\xfe\xff") else "utf-8-sig")
    except UnicodeDecodeError:
        text = raw.decode("cp1252", "replace")  # what older spreadsheets write
    return objects_of_json(text) if json else objects_of_csv(text)


def objects_of_json(text: str) -> ObjectTable:
    """Objects from JSON: a list of objects with the names of the columns as keys; numbers are in SI units."""
    try:
        given = json.loads(text)
    except (ValueError, RecursionError) as error:  # also integers of thousands of digits, brackets within brackets
        raise InvalidArgumentError("objects", str(error), "JSON") from None
    if not isinstance(given, list) or not all(isinstance(one, dict) for one in given):
        raise InvalidArgumentError("objects", type(given).__name__, "a list of objects, one for each row")
    known = {one.name for one in fields(Object)}
    found, bad = [], []
    for row, one in enumerate(given, start=1):
        try:
            for key in one.keys() - known:
                raise InvalidArgumentError(str(key), one[key], f"one of {', '.join(sorted(known))}")
            found.append(Object(**{"name": f"row {row}"} | one))
        except InvalidArgumentError as error:
            bad.append(BadRow(row, error.parameter, str(error)))
    return ObjectTable(found, bad)


def objects_of_csv(text: str) -> ObjectTable:
    """Objects from text with separated columns; the errors of `read_objects`."""
    if len(text) > MAX_CHARACTERS:
        raise InvalidArgumentError("objects", f"{len(text)} characters", f"at most {MAX_CHARACTERS}")
    tables = []
    for delimiter in DELIMITERS:
        try:
            rows = list(csv.reader(io.StringIO(text, newline=""), delimiter=delimiter))
            header = _header(rows)
        except (InvalidArgumentError, csv.Error):
            continue
        tables.append((len(header.columns), rows))
    if not tables:
        try:
            _header(list(csv.reader(io.StringIO(text, newline=""))))  # raises with what was found
        except csv.Error as error:
            raise InvalidArgumentError("objects", str(error), "CSV") from None
    return objects_of_rows(max(tables, key=lambda one: one[0])[1])


def _sheet(raw: bytes) -> list[list[str]]:
    """The first sheet of a file as text; numbers have decimal points."""
    import pandas as pd  # noqa: PLC0415  (reads sheets with openpyxl or odfpy, which are extras)

    frame = pd.read_excel(io.BytesIO(raw), header=None, dtype=object)
    return [list(map(_cell_text, row)) for row in frame.to_numpy().tolist()]


def _cell_text(value: object) -> str:
    """A cell of a sheet as text, whose decimal sign is certain."""
    if value is None or value != value:
        return ""
    if isinstance(value, float):
        return str(int(value)) if value.is_integer() else f"{value:.9f}"
    return str(value)


@dataclass(frozen=True)
class _Header:
    """The last line of the header, its number of cells, its columns: index to column and unit, "" if in the cells."""

    last: int
    size: int
    columns: dict[int, tuple[Column, str]]
    skipped: list[str]


def _plain(text: str) -> str:
    """A name in small letters, without accents, signs and doubled blanks."""
    bare = "".join(one for one in unicodedata.normalize("NFKD", text.lower()) if not unicodedata.combining(one))
    return " ".join(re.sub(r"[^0-9a-z\u0370-\u03ff]+", " ", bare.replace("\u00df", "ss")).split())


_NAMES = {_plain(name): one for one in INPUTS for name in (one.name, *one.aliases)}


def _column(text: str) -> tuple[Column, str] | None:
    """The column that a header names, and its unit."""
    if len(text) > 200:
        return None
    found = _UNIT.search(text.strip())
    unit = next((part for part in found.groups() if part), "") if found else ""
    for name, written in ((text, ""), (text[: found.start()] if found else text, unit)):
        one = _NAMES.get(_plain(name))
        if one is None:
            continue
        known = unit_name(written, one.unit) if written and one.unit in UNITS else None
        if written and one.unit in UNITS and known is None:
            raise InvalidArgumentError("objects, header", text, f"a unit such as {', '.join(UNITS[one.unit])}")
        return one, known or ("kg" if one.unit == "kg" else "")
    return None


def _header(rows: Sequence[Sequence[str]]) -> _Header:
    """The header among the first rows; where it has two lines, the lower one completes the upper one."""
    for last, row in enumerate(rows[:HEADER_ROWS]):
        above = _merged(rows[last - 1], len(row)) if last else [""] * len(row)
        texts = list(map(_joined, above, row))
        found = {place: one for place, text in enumerate(texts) if text.strip() and (one := _column(text))}
        names = Counter(one.name for one, _ in found.values())
        if not ({"width", "diameter"} & names.keys() and "height" in names):
            continue
        several = [name for name, count in names.items() if count > 1 and name != "name"]
        if several:
            raise InvalidArgumentError("objects, header", "; ".join(texts), f"one column {several[0]}")
        places = [place for place, (one, _) in found.items() if one.name == "name"]
        for place in places[:-1]:  # such as number and name: the last one counts
            del found[place]
        columns, after = _with_units(found, rows, last)
        skipped = [text for place, text in enumerate(texts) if text.strip() and place not in columns]
        return _Header(after, len(row), columns, skipped)
    shown = "; ".join(rows[0])[:200] if rows else "nothing"
    raise InvalidArgumentError("objects, header", shown, "columns width or diameter, and height")


def _joined(upper: str, lower: str) -> str:
    """The name of a column from two lines: the lower one with the unit of the upper, or the reverse."""
    unit = _UNIT.search(upper)
    if not lower.strip() or _is_unit(lower):
        return f"{upper} [{lower.strip('[]() ')}]" if lower.strip() else upper
    return lower if unit is None or _UNIT.search(lower) else f"{lower} [{next(filter(None, unit.groups()))}]"


def _is_unit(text: str) -> bool:
    """Whether a text is a unit of length or mass."""
    return unit_name(text.strip("[]() "), "m") is not None or text.strip("[]() ").lower() == "kg"


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


def objects_of_rows(rows: Sequence[Sequence[str]]) -> ObjectTable:
    """Objects from the cells of a table, its header among the first rows; the errors of `read_objects`."""
    header = _header(rows)
    body = [(number, row) for number, row in enumerate(rows[header.last + 1 :], start=header.last + 2)]
    cells = [
        row[place] for _, row in body for place, (one, _) in header.columns.items() if place < len(row) and one.unit
    ]
    decimal = _decimal_sign(cells)
    objects, bad = [], []
    for number, row in body:
        given = {
            one.name: (row[place].strip() if place < len(row) else "") for place, (one, _) in header.columns.items()
        }
        first = _plain(next((text for text in row if text.strip()), ""))
        if not first or first.split()[0] in TOTALS or not any(given.get(name) for name in _SIZED):
            if first and first.split()[0] not in TOTALS:
                bad.append(BadRow(number, "", "no dimension"))
            continue
        if any(text.strip() for text in row[header.size :]):
            bad.append(BadRow(number, "", f"{len(row)} cells, {header.size} in the header"))
            continue
        try:
            values: dict[str, Any] = {"name": given.get("name") or f"row {number}"}
            for one, unit in header.columns.values():
                if given[one.name] not in ("", "-", "\u2013", "n/a", "?") and one.name != "name":
                    values[one.name] = _value(one, given[one.name], unit, decimal)
            objects.append(Object(**values))
        except InvalidArgumentError as error:
            bad.append(BadRow(number, error.parameter, str(error)))
    return ObjectTable(objects, bad, header.skipped)


def _value(one: Column, text: str, unit: str, decimal: str) -> Any:
    """The value of a cell in the unit of its column, in SI units."""
    if one.unit == "":
        return text
    found = _NUMBER.fullmatch(text) if len(text) <= MAX_LENGTH else None
    if not found:
        raise InvalidArgumentError(one.name, text, "a number, with its unit or with one in the header")
    written = found[1].strip()
    if re.search(_GAP, written) and not re.fullmatch(rf"[+-]?\d{{1,3}}(?:{_GAP}\d{{3}})+(?:[.,]\d*)?", written):
        raise InvalidArgumentError(one.name, text, "one number, with blanks between thousands only")
    digits = re.sub(_GAP, "", written)
    thousands = "." if decimal == "," else ","
    if not re.fullmatch(rf"[+-]?(\d*|\d{{1,3}}(?:{re.escape(thousands)}\d{{3}})+)(?:{re.escape(decimal)}\d*)?", digits):
        raise InvalidArgumentError(one.name, text, f"a number with the decimal sign {decimal!r} of the table")
    value = float(digits.replace(thousands, "").replace(decimal, "."))
    if one.unit not in UNITS:  # kg
        factor = {"": 1.0, "kg": 1.0, "t": 1000.0, "g": 0.001}.get(found[2].lower())
        if factor is None:
            raise InvalidArgumentError(one.name, text, "a mass in kg, g or t")
        return value * factor
    name = unit_name(found[2], one.unit) if found[2] else unit
    if found[2] and name is None:
        raise InvalidArgumentError(one.name, text, f"a unit such as {', '.join(UNITS[one.unit])}")
    if one.unit == "m" and not name:
        raise InvalidArgumentError(
            one.name, text, f"a unit: write {one.name} [m] in the header, or {text} cm in the cell"
        )
    return value * (UNITS[one.unit][name] if name else 1.0)


def _decimal_sign(cells: Iterable[str]) -> str:
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
        elif len(digits.rsplit(last, 1)[1]) == 3 and re.fullmatch(r"[+-]?[1-9]\d{0,2}", digits.rsplit(last, 1)[0]):
            signs.setdefault("?" + last, cell)
        else:
            signs[last] = cell
    certain = {sign: cell for sign, cell in signs.items() if sign in ".,"}
    if len(certain) == 2:
        raise InvalidArgumentError("objects", list(certain.values()), "one decimal sign in the whole table")
    unsettled = [cell for sign, cell in signs.items() if sign.startswith("?")]
    if unsettled and not certain:
        raise InvalidArgumentError(
            "objects", unsettled[0], "a number whose decimal sign is certain, such as 1.2340 or 1234"
        )
    return next(iter(certain), ".")
