"""Columns as an .xlsx workbook (ECMA-376, part 1): five short files suffice for one sheet of texts and numbers."""

from __future__ import annotations

import io
import re
import zipfile
from collections.abc import Mapping, Sequence
from math import isfinite
from typing import Any
from xml.sax.saxutils import escape

MAIN = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
OFFICE = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
PACKAGE = "http://schemas.openxmlformats.org/package/2006"
TYPE = "application/vnd.openxmlformats-officedocument.spreadsheetml"

_FORBIDDEN = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")  # what XML cannot hold

LONGEST = 32_767  # longest text of a cell [characters]


def xlsx_bytes(columns: Mapping[str, Sequence[Any]], above: Sequence[str] = ()) -> bytes:
    """A workbook with lines of text `above` a header, which stays in sight and has filters, and the rows.

    Numbers and booleans have cells of their own type; None, nan and infinite values are empty; texts are no formulas.
    """
    rows = [*([line] for line in above), [*columns], *zip(*columns.values(), strict=True)]
    header = len(above) + 1
    sheet = "".join(
        f'<row r="{r}">{"".join(_cell(value, f"{_letters(k)}{r}") for k, value in enumerate(row))}</row>'
        for r, row in enumerate(rows, start=1)
    )
    last = f"{_letters(max(len(columns) - 1, 0))}{len(rows)}"
    widths = "".join(
        f'<col min="{k}" max="{k}" customWidth="1" width="{min(max(len(name), *map(_length, values), 6), 40) + 2}"/>'
        for k, (name, values) in enumerate(columns.items(), start=1)
    )
    view = f'<pane ySplit="{header}" topLeftCell="A{header + 1}" activePane="bottomLeft" state="frozen"/>'
    parts = {
        "[Content_Types].xml": f'<Types xmlns="{PACKAGE}/content-types"><Default Extension="rels" '
        'ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
        f'<Override PartName="/xl/workbook.xml" ContentType="{TYPE}.sheet.main+xml"/>'
        f'<Override PartName="/xl/worksheets/sheet1.xml" ContentType="{TYPE}.worksheet+xml"/></Types>',
        "_rels/.rels": _link("officeDocument", "xl/workbook.xml"),
        "xl/workbook.xml": f'<workbook xmlns="{MAIN}" xmlns:r="{OFFICE}"><bookViews><workbookView/></bookViews><sheets>'
        '<sheet name="assessment" sheetId="1" r:id="rId1"/></sheets></workbook>',
        "xl/_rels/workbook.xml.rels": _link("worksheet", "worksheets/sheet1.xml"),
        "xl/worksheets/sheet1.xml": f'<worksheet xmlns="{MAIN}"><sheetViews><sheetView workbookViewId="0">{view}'
        f"</sheetView></sheetViews><cols>{widths}</cols><sheetData>{sheet}</sheetData>"
        f'<autoFilter ref="A{header}:{last}"/></worksheet>',
    }
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, text in parts.items():
            archive.writestr(
                zipfile.ZipInfo(name), f'<?xml version="1.0" encoding="UTF-8"?>\n{text}', zipfile.ZIP_DEFLATED
            )
    return packed.getvalue()


def _link(kind: str, target: str) -> str:
    relationship = f'<Relationship Id="rId1" Type="{OFFICE}/{kind}" Target="{target}"/>'
    return f'<Relationships xmlns="{PACKAGE}/relationships">{relationship}</Relationships>'


def _letters(place: int) -> str:
    """The letters of a column, from 0."""
    return (_letters(place // 26 - 1) if place >= 26 else "") + chr(65 + place % 26)


def _length(value: Any) -> int:
    return len(value) if isinstance(value, str) else 8


def _cell(value: Any, place: str) -> str:
    if isinstance(value, bool):
        return f'<c r="{place}" t="b"><v>{value:d}</v></c>'
    if isinstance(value, int | float):
        return f'<c r="{place}"><v>{value!r}</v></c>' if isfinite(value) else ""
    if not value:
        return ""
    text = escape(_FORBIDDEN.sub("\ufffd", value[:LONGEST])).replace("\r", "&#13;")
    return f'<c r="{place}" t="inlineStr"><is><t xml:space="preserve">{text}</t></is></c>'
