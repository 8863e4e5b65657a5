"""Columns as CSV text, for the command line and the service."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import isfinite
from typing import Any


def csv_text(columns: Mapping[str, Sequence[Any]]) -> str:
    """A header line with the names of the columns, and the rows.

    Parameters
    ----------
    columns : mapping of str to sequence
        Plain Python values, equally many in each column. Names and strings contain no comma, quote or line break.

    Returns
    -------
    str
        Floats have all digits. None, nan and infinite values are empty cells; booleans are true and false.
    """
    return ",".join(columns) + "\n" + csv_rows(columns)


def csv_rows(columns: Mapping[str, Sequence[Any]]) -> str:
    """The rows alone, for a table that is written in parts."""
    lines = zip(*(map(_cell, column) for column in columns.values()), strict=True)
    return "".join(f"{','.join(line)}\n" for line in lines)


def _cell(value: Any) -> str:
    if isinstance(value, float):
        return repr(value) if isfinite(value) else ""
    if isinstance(value, bool):
        return "true" if value else "false"
    return "" if value is None else str(value)
