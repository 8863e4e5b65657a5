"""What a table holds, for a person who states its layout: first rows, columns, what is missing."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import islice
from typing import Any

from rocking._base.cells import name_and_unit, plain_name, text_of_cell
from rocking._base.errors import InvalidArgumentError
from rocking._base.units import UNITS, unit_name
from rocking._dimensional.table_reader import TableFile, columns_of, labels_of, missing_groups
from rocking._excitation.records.readers.preview import SHOWN_CELLS, SHOWN_SIGNS, PreviewLine

ROWS = 8  # rows below the header that are shown


@dataclass(frozen=True)
class TablePreview:
    """What a table holds.

    `labels` are the headers of the columns, each once, `names_line` the number of the header. `named` is the quantity
    of each column that its own header states, by label; `units` the unit in a header, by label and SI unit of the
    quantities that have it. `missing` are the quantities that the header lacks, one of each group.
    """

    lines: list[PreviewLine]
    labels: list[str] = field(default_factory=list)
    names_line: int | None = None
    named: dict[str, str] = field(default_factory=dict)
    units: dict[str, dict[str, str]] = field(default_factory=dict)
    missing: list[str] = field(default_factory=list)


def preview_table(file: TableFile) -> TablePreview:
    """First rows and columns of a table; what is wrong with them is the business of `read_rows`.

    Raises `TableFileError` for quotes that are not closed in the first rows.
    """
    lines = [PreviewLine(number, text[:SHOWN_SIGNS], []) for number, text in enumerate(file.head[: file.first - 1], 1)]
    rows = [*islice(file.rows, 1 + ROWS)]
    lines += [_line(number, cells) for number, cells in enumerate(rows, start=file.first)]
    if not rows:
        return TablePreview(lines)
    labels = [" ".join(label.split()) for label in labels_of(rows[0])]
    quantities = {plain_name(quantity.name): quantity for quantity in file.schema.quantities}
    named: dict[str, str] = {}
    units: dict[str, dict[str, str]] = {}
    for label in labels:
        name, bracket = name_and_unit(label)
        quantity = quantities.get(plain_name(name))
        if quantity is not None and (quantity.unit or bracket is None):
            named[label] = quantity.name
        stated = {si: unit_name(bracket, si) for si in UNITS} if bracket else {}
        units[label] = {si: unit for si, unit in stated.items() if unit is not None}
    try:
        columns, _ = columns_of(file, rows[0])
    except InvalidArgumentError:  # which `read_rows` raises too
        return TablePreview(lines, labels, file.first, named, units)
    return TablePreview(lines, labels, file.first, named, units, missing_groups(columns, file.schema))


def _line(number: int, cells: Sequence[Any]) -> PreviewLine:
    texts = [text_of_cell(cell)[:SHOWN_SIGNS] for cell in cells[:SHOWN_CELLS]]
    return PreviewLine(number, "; ".join(texts)[:SHOWN_SIGNS], texts)
