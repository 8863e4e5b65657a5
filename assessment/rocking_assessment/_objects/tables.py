"""Tables of objects: CSV, workbooks, JSON, and a template to fill in."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import fields
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rocking.extension import (
    SIZES,
    BadRow,
    Cell,
    InvalidArgumentError,
    Row,
    Schema,
    Table,
    TableLayout,
    TooManyRowsError,
    described,
    open_text,
    read_bytes,
    read_rows,
    read_table_file,
    text_of,
    text_of_cell,
    unusual_sizes,
    write_output,
)
from rocking_assessment._objects.columns import INPUTS, SHAPES
from rocking_assessment._objects.objects import Object
from rocking_assessment._objects.xlsx import xlsx_bytes

if TYPE_CHECKING:
    from rocking.extension import StopFlag

TEMPLATE = ("name", "width [cm]", "depth [cm]", "diameter [cm]", "height [cm]", "mass [kg]", "friction", "notes")
"""Header of the table to fill in."""

COMMENTS = (
    "# One object a row. Lines above the header that begin with # are passed over.",
    "# Each length has its unit in brackets in the header: mm; cm; m; in; ft. Write the unit that you measure in.",
    "# width and depth: sides of the base on which it stands. diameter: of a round base; leave both empty then.",
    "# height: of the whole object. mass and friction (coefficient at the base) may be empty; so may notes.",
    "# The decimal sign is the point. Columns of other names are kept as they stand.",
)
"""Lines above this header."""


class ObjectTable(Table[Object]):
    """Objects of a table, and the rows that could not be read.

    Attributes
    ----------
    objects : list of Object
        In the order of the rows.
    bad_rows : list of BadRow
        Rows that name no valid object, each with all reasons.
    skipped : list of str
        Headers of columns that are not read; their cells are kept in the `details` of the objects.
    columns : dict of str to str
        Canonical header, such as "width [cm]", of each column that was read, by its header; empty for JSON.
    remarks : list of str
        Where `columns` states another unit than the header.
    reading : str
        The columns that were read, and those that were not, in words.
    """

    @property
    def objects(self) -> list[Object]:
        """The objects."""
        return self.items

    def __repr__(self) -> str:
        """The number of objects that were read, and of rows and columns that were not."""
        reading = f"; {self.reading}" if self.reading else ""
        return f"<rocking.ObjectTable of {len(self.objects)} objects, {len(self.bad_rows)} bad rows{reading}>"


def read_objects(
    source: str | PathLike[str],
    *,
    columns: Mapping[str, str] | None = None,
    decimal: str = ".",
    delimiter: str | None = None,
    skip: int = 0,
    sheet: str | None = None,
    allow_unusual: bool = False,
) -> ObjectTable:
    """The objects in a table: a CSV file (any ending), JSON (.json), or a workbook (.xlsx, .ods).

    The header has canonical names, such as "width [cm]" or "Height (mm)", with the unit there or in each cell. A row
    that cannot be read is in `bad_rows` with all its reasons; the others are read.

    Parameters
    ----------
    source : str or path
        The file; `-` is standard input.
    columns : mapping of str to str, optional
        The canonical header of a column with another one, {"Breite (cm)": "width [cm]"}, or "unused". Not for JSON.
    decimal : {".", ","}
        Decimal sign of texts.
    delimiter : str, optional
        Sign between the cells of CSV, where the header has several of comma, semicolon and tab.
    skip : int
        Lines above the header.
    sheet : str, optional
        Name of the sheet of a workbook, where several hold cells.
    allow_unusual : bool
        True to read objects below 1 cm or above 50 m.

    Raises
    ------
    InvalidArgumentError
        If the file cannot be read, or its header does not state a base and a height with units.
    ImportError
        If the package for workbooks is not installed, the extra `sheets`.
    """
    layout = TableLayout(
        columns=dict(columns or {}),
        decimal=decimal,
        delimiter=delimiter,
        skip=skip,
        sheet=sheet,
        allow_unusual=allow_unusual,
    )
    if Path(source).suffix.lower() == ".json":
        return objects_of_json(text_of(read_bytes(source, "objects"), "objects"), layout=layout)
    return ObjectTable(**vars(read_table_file(source, SCHEMA, layout)))


def objects_of_json(text: str, max_rows: int | None = None, layout: TableLayout | None = None) -> ObjectTable:
    """Objects from JSON: a list of objects with the names of the columns as keys; numbers are in SI units."""
    try:
        rows = json.loads(text)
        json.dumps(rows, ensure_ascii=False).encode()  # an escape such as \ud800 is of no character
    except (ValueError, RecursionError) as error:  # also integers of thousands of digits, brackets within brackets
        raise InvalidArgumentError("objects", str(error), "JSON, with texts that UTF-8 can encode") from None
    if not isinstance(rows, list) or not all(isinstance(row, dict) for row in rows):
        raise InvalidArgumentError("objects", type(rows).__name__, "a list of objects, one for each row")
    if max_rows is not None and len(rows) > max_rows:
        raise TooManyRowsError("objects", len(rows), f"at most {max_rows}")
    names = {field.name for field in fields(Object)} - {"cells"} | _SHAPES
    allowed = f"one of {', '.join(sorted(names))}"
    table = ObjectTable()
    for number, row in enumerate(rows, start=1):
        errors = [InvalidArgumentError(str(key), row[key], allowed) for key in row.keys() - names]
        if not errors:
            try:
                obj = object_of({"name": f"row {number}"} | row)
                errors = unusual_sizes(vars(obj), layout or TableLayout())
            except InvalidArgumentError as error:
                errors = [error]
        if errors:
            table.bad_rows.append(BadRow(number, errors))
        else:
            table.objects.append(obj)
    return table


def objects_of_csv(
    text: str, max_rows: int | None = None, stop: StopFlag | None = None, layout: TableLayout | None = None
) -> ObjectTable:
    """Objects from CSV text in a stated layout; the errors of `read_objects`. `stop` cancels the work.

    Beyond `max_rows` rows the table is refused by `TooManyRowsError`, before an object is made.
    """
    file = open_text(text, "objects", SCHEMA, layout or TableLayout(), stop)
    return ObjectTable(**vars(read_rows(file, SCHEMA, max_rows)))


def _object_of_row(row: Row) -> Object:
    """The object of a row; its details are the cells of the columns that are not read."""
    texts = {name: value.strip() if isinstance(value, str) else value for name, value in row.values.items()}
    details = {label: text_of_cell(cell) for label, cell in row.unread.items()}
    return object_of({"name": f"row {row.number}"} | texts | {"details": details, "cells": row.cells})


def object_of(values: dict[str, Any]) -> Object:
    """The object from its own parameters, or from those of a kind of body."""
    if values.get("sides") == "both":
        del values["sides"]
    kind, shapes = values.pop("body", None), values.keys() & _SHAPES
    if kind is None and not shapes:
        return Object(**values)
    if "sides" in shapes and values.get("depth") is not None and values.keys().isdisjoint(["wall"]):
        raise InvalidArgumentError("depth", values["depth"], "none beside sides: the width is across the wall")
    properties = {name: value for name, value in values.items() if name in _NOT_SHAPES}
    body, parameters = described(kind, {name: value for name, value in values.items() if name not in _NOT_SHAPES})
    return Object.from_body(body(**parameters), **properties)


_SHAPES = {quantity.name for quantity in SHAPES}

_NOT_SHAPES = {"name", "mass", "friction", "restitution", "tolerance", "pedestal", "notes", "details", "cells"}
"""The values of an object other than its body."""

SCHEMA = Schema("objects", (*INPUTS, *SHAPES), SIZES, _object_of_row, needs_depth=True)
"""A table of objects."""


def table_template() -> str:
    """A table of objects to fill in, as CSV text: comments, and a header that states the units."""
    return "\n".join([*COMMENTS, ",".join(TEMPLATE), ""])


def write_template(path: str | PathLike[str]) -> None:
    """Write the table to fill in, CSV or a workbook as the name ends."""
    if Path(path).suffix.lower() != ".xlsx":
        write_output(path, table_template())
        return
    rows: dict[str, list[Cell]] = {name: [] for name in TEMPLATE}
    write_output(path, xlsx_bytes(rows, above=COMMENTS))
