"""A column of several dimensions, such as "W x D x H (cm)" above "60 x 40 x 150": a column for each of them.

The header says the order; where it does not, nothing is read.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

from rocking._base.cells import half_width, name_and_unit, named, plain_name, split_number
from rocking._base.units import MAX_LENGTH, unit_name
from rocking._dimensional.table_header import EMPTY, HEADER_ROWS, Schema, is_sizes, is_unit

_WORD = r"[^\W\d_]+\.?"
_ORDER = re.compile(
    rf"(?<!\w)[^\W\d_](?:[x\u00d7][^\W\d_])+(?!\w)|{_WORD}(?:\s*[\u00d7*]\s*{_WORD}|\s+(?:x|by)\s+{_WORD})+", re.I
)
BETWEEN = re.compile(r"\s*(?:[x\u00d7*]|\bby\b)\s*", re.IGNORECASE)
_AROUND = " ,;:()[]"  # signs around a unit


def _label(header: str, name: str) -> str:
    return f"{header.strip()}, {name} only"


@dataclass(frozen=True)
class Sizes:
    """Where the dimensions stand, and their names in the order of the header."""

    line: int
    place: int
    names: list[str]

    def spread(self, rows: Iterable[Sequence[str]]) -> Iterator[Sequence[str]]:
        """The rows, with a cell for each dimension."""
        for number, row in enumerate(rows):
            if self.place >= len(row):
                yield row
                continue
            cell = row[self.place]
            rest = [""] * (len(self.names) - 1)
            if number == self.line:
                parts = [_label(cell, name) for name in self.names]
            else:
                parts = [cell, *rest] if number < self.line else self._parts(cell, rest)
            yield [*row[: self.place], *parts, *row[self.place + 1 :]]

    def _parts(self, cell: str, rest: list[str]) -> list[str]:
        """The dimensions of a cell, each with the unit of the last one.

        A cell with more or fewer than the header becomes a text that is no number, so that its row is refused with it.
        """
        parts = BETWEEN.split(half_width(cell.strip())) if len(cell) <= MAX_LENGTH else []
        if cell.strip().lower() in EMPTY or len(parts) != len(self.names):
            if is_unit(cell):
                return [cell] * len(self.names)
            wrong = cell.strip().lower() not in EMPTY
            return [f"{cell} ({len(parts)} of {len(self.names)} dimensions)" if wrong else cell, *rest]
        numbers = [*map(split_number, parts)]
        unit = numbers[-1][1] if numbers[-1] else ""
        return [part if one is None or one[1] else f"{part} {unit}" for part, one in zip(parts, numbers, strict=True)]


def with_sizes(rows: Sequence[Sequence[str]], schema: Schema[Any]) -> tuple[Sizes | None, Schema[Any]]:
    """The column of several dimensions, if a header has one, and the schema that knows its parts."""
    known = {plain_name(name): one for one in schema.columns for name in one.names if one.unit == "m"}
    for line, row in enumerate(rows[:HEADER_ROWS]):
        for place, text in enumerate(row):
            found = _ORDER.search(half_width(text)) if len(text) <= MAX_LENGTH else None
            names = BETWEEN.split(found[0]) if found and text.strip() not in schema.renamed else []
            if found is None or not names or not all(named(name, known) for name in names):
                continue
            rest = re.sub(r"[\[(]\s*[\])]", "", half_width(text).replace(found[0], "")).strip()
            name, unit = ("", rest) if unit_name(rest.strip(_AROUND), "m") else name_and_unit(rest)
            if name.strip() and not is_sizes(name):
                continue
            unit = f" [{unit.strip(_AROUND)}]" if unit else ""
            renamed = {_label(text, one): f"{one}{unit}" for one in names}
            return Sizes(line, place, names), replace(schema, renamed={**schema.renamed, **renamed})
    return None, schema
