"""Columns as an .xlsx workbook, by pandas and XlsxWriter."""

from __future__ import annotations

import datetime as dt
import io
from collections.abc import Mapping, Sequence
from math import isfinite
from typing import Any

LONGEST = 32_767  # longest text of a cell [characters]

WIDEST = 300  # widest column [pixels]

OPTIONS = {"strings_to_formulas": False, "strings_to_urls": False, "in_memory": True}
"""Options of XlsxWriter: no text of a table becomes a formula or a link; no temporary files, which need a disk."""

CREATED = dt.datetime(2000, 1, 1, tzinfo=dt.UTC)
"""Stated date of creation: the bytes depend on the columns only."""


def xlsx_bytes(columns: Mapping[str, Sequence[Any]], above: Sequence[str] = ()) -> bytes:
    """A workbook with lines of text `above` a header, which stays in sight and has filters, and the rows.

    Numbers and booleans have cells of their own type, numbers to 16 digits; None, nan and infinite values are empty;
    texts are no formulas.
    """
    import pandas as pd  # noqa: PLC0415  (takes longer to load than the package)

    table = pd.DataFrame({name: [_cell(value) for value in values] for name, values in columns.items()}, dtype=object)
    header = len(above)
    workbook = io.BytesIO()
    with pd.ExcelWriter(workbook, engine="xlsxwriter", engine_kwargs={"options": OPTIONS}) as writer:
        table.to_excel(
            writer,
            sheet_name="assessment",
            index=False,
            startrow=header,
            freeze_panes=(header + 1, 0),
        )
        writer.book.set_properties({"created": CREATED})
        sheet = writer.sheets["assessment"]
        for row, line in enumerate(above):
            sheet.write_string(row, 0, line)
        sheet.autofilter(header, 0, header + len(table), max(len(columns) - 1, 0))
        sheet.autofit(WIDEST)
    return workbook.getvalue()


def _cell(value: Any) -> Any:
    if isinstance(value, str):
        return value[:LONGEST] or None
    if isinstance(value, float) and not isfinite(value):
        return None
    return value
