"""Workbooks in a body, which a helper process turns into CSV text."""

from __future__ import annotations

import io
import zipfile
from importlib.util import find_spec

from rocking_api.http.errors import TooLargeError, UnsupportedBodyError
from rocking_api.service import Service

from rocking.extension import MAX_CHARACTERS, InvalidArgumentError, csv_of_sheet

MAX_SHEET = 32 * 1024 * 1024  # largest unpacked file of a sheet [bytes]

MEDIA_TYPES = {
    "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet": "a workbook (.xlsx)",
    "application/vnd.oasis.opendocument.spreadsheet": "a workbook (.ods)",
}
"""Kinds of workbooks by their media types."""


async def text_of_workbook(
    service: Service, raw: bytes, parameter: str, name: str, sheet: str | None = None, decimal: str = "."
) -> str:
    """A sheet as CSV text, its numbers with a decimal sign; `parameter` and `name` are those of the file in errors."""
    if find_spec("python_calamine") is None:
        raise UnsupportedBodyError(parameter, name, 'CSV: sheets need pip install "rocking[sheets]" on the service')
    try:
        size = sum(member.file_size for member in zipfile.ZipFile(io.BytesIO(raw)).infolist())
    except zipfile.BadZipFile:
        raise InvalidArgumentError(parameter, name, "a sheet, which is a zip archive") from None
    if size > MAX_SHEET:  # as stated; what is there is bounded by the memory of the helper
        raise TooLargeError(parameter, size, f"at most {MAX_SHEET} bytes, unpacked")
    return await service.helper.read(parameter, name, _text, raw, parameter, sheet, decimal)


def _text(raw: bytes, parameter: str, sheet: str | None, decimal: str) -> str:
    text = csv_of_sheet(raw, parameter, sheet, decimal)
    if len(text) > MAX_CHARACTERS:
        raise InvalidArgumentError(parameter, len(text), f"a table of at most {MAX_CHARACTERS} characters")
    return text
