"""Columns as CSV text (RFC 4180), for the command line, the service and the workflow."""

import csv
import re
from collections.abc import Iterable, Mapping, Sequence
from math import isfinite
from types import SimpleNamespace
from typing import Any

FORMULA_STARTS = ("=", "+", "-", "@", "\r", "\n", "\uff1d", "\uff0b", "\uff0d", "\uff20")
"""Text that begins so is a formula for a spreadsheet; the last four are = + - @ of full width."""

_DELIMITERS = ";\t"
"""Signs at which a program that expects other delimiters than commas divides a cell, so that a formula begins there."""

_NEGATIVE = re.compile("-[0-9]+(?:[.,][0-9]+)?")


def csv_text(columns: Mapping[str, Sequence[Any]]) -> str:
    """Return a header line with the names of the columns, and the rows.

    Floats have all digits. None, nan and infinite values are empty cells; booleans are true and false. Text with a
    comma, a quote or a line break is quoted; text that a spreadsheet would take for a formula has a leading apostrophe,
    and so has a part of it behind a semicolon or a tabulator.
    """
    return csv_header(columns) + csv_rows(columns)


def csv_header(names: Iterable[str]) -> str:
    """Return the header line alone, for a table that is written in parts."""
    return _lines([map(_cell, names)])


def csv_rows(columns: Mapping[str, Sequence[Any]]) -> str:
    """Return the rows alone."""
    cells = [map(_cell, column) for column in columns.values()]
    return _lines(zip(*cells, strict=True))


def _lines(rows: Iterable[Iterable[Any]]) -> str:
    lines: list[str] = []
    # with this end of a line, which is replaced below, the writer quotes a lone carriage return as well
    csv.writer(SimpleNamespace(write=lines.append), lineterminator="\r\n").writerows(rows)
    return "".join(f"{line[:-2]}\n" for line in lines)


def _cell(value: Any) -> Any:
    if isinstance(value, float):
        return value if isfinite(value) else None
    if isinstance(value, bool):
        return "true" if value else "false"
    return _escaped(value) if isinstance(value, str) else value


def _escaped(text: str) -> str:
    """Put an apostrophe before each part of a text that a spreadsheet would take for a formula."""
    if text.isidentifier():  # such as the name of an outcome, a million times
        return text
    parts = re.split(f"([{_DELIMITERS}])", text)
    safe = "".join(f"'{part}" if _is_formula(part) else part for part in parts)
    return f"'{safe}" if _is_formula(safe) or safe.startswith("\t") else safe


def _is_formula(part: str) -> bool:
    return part.startswith(FORMULA_STARTS) and not _NEGATIVE.fullmatch(part)
