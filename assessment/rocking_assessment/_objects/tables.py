"""Tables of objects: the columns of an inventory, read by `rocking._dimensional.table_reader`, and JSON."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rocking.extension import (
    FREQUENCY_PARAMETER,
    BadRow,
    InvalidArgumentError,
    Schema,
    Table,
    TooManyRowsError,
    described,
    name_and_unit,
    plain_name,
    read_bytes,
    read_csv,
    read_file,
    text_of,
    unit_name,
)
from rocking_assessment._objects.columns import INPUTS, REQUIRED, SHAPES, STAND_INS
from rocking_assessment._objects.objects import Object, RowDetails

if TYPE_CHECKING:
    from rocking.extension import StopFlag


@dataclass(frozen=True, repr=False)
class ObjectTable:
    """Objects of a table, and the rows that could not be read.

    Attributes
    ----------
    objects : list of Object
        In the order of the rows.
    bad_rows : list of BadRow
        Rows that name no valid object.
    skipped : list of str
        Headers of columns that are not read; their cells are kept in the `details` of the objects.
    columns : dict of str to str
        What each other column was read as, by its header; of JSON nothing, whose keys say it.
    totals : list of str
        Rows of totals, which are no objects, such as "row 9: Total".
    """

    objects: list[Object]
    bad_rows: list[BadRow] = field(default_factory=list)
    skipped: list[str] = field(default_factory=list)
    columns: dict[str, str] = field(default_factory=dict)
    totals: list[str] = field(default_factory=list)

    @property
    def reading(self) -> str:
        """How each column was read, and which columns and rows were not, in words."""
        read = ", ".join(f"{header} as {name}" for header, name in self.columns.items())
        skipped = [*map(_shown, self.skipped), *(f"{row} (no object)" for row in self.totals)]
        unread = f"; not read: {', '.join(skipped)}" if skipped else ""
        return f"columns read: {read}{unread}" if read else ""

    def __repr__(self) -> str:
        """The number of objects that were read, and of rows and columns that were not."""
        reading = f"; {self.reading}" if self.reading else ""
        return f"<rocking.ObjectTable of {len(self.objects)} objects, {len(self.bad_rows)} bad rows{reading}>"


def _shown(label: str) -> str:
    """The header of a column that is not read; a frequency parameter has the letter of a depth in Italian."""
    name, unit = name_and_unit(label)
    is_frequency = plain_name(name) == FREQUENCY_PARAMETER.symbol and unit_name(unit, FREQUENCY_PARAMETER.unit)
    return f"{label} ({FREQUENCY_PARAMETER.meaning}, no depth)" if is_frequency else label


def read_objects(source: str | PathLike[str], *, columns: Mapping[str, str] | None = None) -> ObjectTable:
    """The objects in a table: a CSV file (any ending), JSON (.json), or a sheet (.xlsx, .ods).

    What is not certain is not read. A row is refused, among others, if a number could be either of two ("1,234"), or a
    length stands in a column that is not read: name what it is, or that it is not used.

    Parameters
    ----------
    source : str or path
        The file; `-` is standard input.
    columns : mapping of str to str, optional
        What columns are, by their headers: the name of a quantity such as "depth", with a unit if the header has none,
        or "unused". Not for JSON.

    Raises
    ------
    InvalidArgumentError
        If the file cannot be read, or has no header with a base and a height in units that are understood.
    ImportError
        If the package for sheets is not installed, the extra `sheets`.
    """
    if Path(source).suffix.lower() == ".json":
        return objects_of_text(read_bytes(source, "objects"), json=True)
    return _objects(read_file(source, replace(SCHEMA, renamed=dict(columns or {}))))


def objects_of_text(raw: bytes, *, json: bool, most: int | None = None, stop: StopFlag | None = None) -> ObjectTable:
    """Objects from the bytes of a text, JSON or CSV; the errors of `read_objects`. `stop` cancels the work.

    Beyond `most` rows the table is refused by `TooManyRowsError`, before an object is made.
    """
    text = text_of(raw, "objects")
    return objects_of_json(text, most) if json else objects_of_csv(text, most, stop)


def objects_of_json(text: str, most: int | None = None) -> ObjectTable:
    """Objects from JSON: a list of objects with the names of the columns as keys; numbers are in SI units."""
    try:
        given = json.loads(text)
        json.dumps(given, ensure_ascii=False).encode()  # an escape such as \ud800 is of no character
    except (ValueError, RecursionError) as error:  # also integers of thousands of digits, brackets within brackets
        raise InvalidArgumentError("objects", str(error), "JSON, with texts that UTF-8 can encode") from None
    if not isinstance(given, list) or not all(isinstance(one, dict) for one in given):
        raise InvalidArgumentError("objects", type(given).__name__, "a list of objects, one for each row")
    if most is not None and len(given) > most:
        raise TooManyRowsError("objects", len(given), f"at most {most}")
    known = {one.name for one in fields(Object)} | _SHAPES
    found, bad = [], []
    for row, one in enumerate(given, start=1):
        try:
            for key in one.keys() - known:
                raise InvalidArgumentError(str(key), one[key], f"one of {', '.join(sorted(known))}")
            found.append(_made({"name": f"row {row}"} | one))
        except InvalidArgumentError as error:
            bad.append(BadRow(row, error.parameter, str(error)))
    return ObjectTable(found, bad)


def objects_of_csv(text: str, most: int | None = None, stop: StopFlag | None = None) -> ObjectTable:
    """Objects from text with separated columns; the errors of `read_objects`. `stop` cancels the work."""
    return _objects(read_csv(text, SCHEMA, most, stop))


def _objects(table: Table[Object]) -> ObjectTable:
    for one, row in zip(table.items, zip(*table.cells.values(), strict=True), strict=True):
        details = RowDetails(one.details, dict(zip(table.cells, row, strict=True)))
        vars(one)["details"] = details  # a frozen dataclass
    return ObjectTable(table.items, table.bad_rows, table.skipped, table.columns, table.totals)


def _object(row: int, values: dict[str, Any], others: dict[str, str]) -> Object:
    """The object of a row, with the cells of the columns that hold no numbers that are read."""
    given = {name: value.strip() if isinstance(value, str) else value for name, value in values.items()}
    return _made({"name": f"row {row}"} | given | {"details": others})


def _made(given: dict[str, Any]) -> Object:
    """The object from its own parameters, or from those of a kind of body."""
    if given.get("sides") == "both":
        del given["sides"]
    kind, shapes = given.pop("body", None), given.keys() & _SHAPES
    if kind is None and not shapes:
        return Object(**given)
    if "sides" in shapes and given.get("depth") is not None and given.keys().isdisjoint(["wall"]):
        raise InvalidArgumentError("depth", given["depth"], "none beside sides: the width is across the wall")
    stated = {name: given.pop(name) for name in [*given] if name not in _ABOUT}
    made, parameters = described(kind, stated)
    return Object.from_body(made(**parameters), **given)


_SHAPES = {one.name for one in SHAPES}

_ABOUT = {"name", "mass", "friction", "restitution", "tolerance", "pedestal", "notes", "details"}
"""The values of an object other than its body."""


SCHEMA = Schema("objects", (*INPUTS, *STAND_INS, *SHAPES), REQUIRED, _object, every_length=True)  # a table of objects
