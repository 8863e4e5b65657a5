"""What a file of a record holds, for a person who states its layout: first lines, columns, what is missing."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from rocking._base.errors import RecordFileError
from rocking._excitation.records.readers import seismic
from rocking._excitation.records.readers.columns import Choice, Table
from rocking._excitation.records.readers.layout import Layout, stated_layout
from rocking._excitation.records.readers.read_record import FORMATS, TEXT_FORMATS, text_format_of
from rocking._excitation.records.readers.text_file import TextFile

if TYPE_CHECKING:  # loads the compiler
    from rocking._numba.cancellation import StopFlag

FIRST_LINES = 20  # lines from the start of a file that are shown
LINES_BELOW = 8  # lines below those of `skip`
SHOWN_SIGNS = 200  # most characters of a line or of a cell that are shown
SHOWN_CELLS = 60  # most cells of a line that are shown
NOTHING = Choice(None, None, None, None)


@dataclass(frozen=True)
class PreviewLine:
    """A line of a file: its number from 1, its text, and its cells if it has names or numbers of columns."""

    number: int
    text: str
    cells: list[str]


@dataclass(frozen=True)
class FilePreview:
    """What a file holds.

    `columns` are the names of the columns or channels in their order, "" for one without a name; `names_line` is the
    number of the line with the names. `in_file` is what the header states by itself, `choice` what is read with the
    arguments: columns from 0, and units. `missing` are the arguments that are missing. `format` is None for a file of a
    format that is not read.
    """

    format: str | None
    encoding: str | None
    lines: list[PreviewLine]
    columns: list[str]
    names_line: int | None = None
    in_file: Choice = NOTHING
    choice: Choice = NOTHING
    missing: tuple[str, ...] = ()


def preview_record(content: bytes, name: str, *, stop: StopFlag | None = None, **arguments: Any) -> FilePreview:
    """Describe the content of a file, as far as the arguments of `read_record` say how it is laid out.

    Raises `InvalidArgumentError` for an argument that is out of range, and `RecordFileError` for a file without text.
    What is wrong with the rows is the business of `parse_record`.
    """
    layout = stated_layout(FORMATS, **arguments)
    kind = layout.format or seismic.format_of(content)
    if kind in ("SAC", "miniSEED"):
        return FilePreview(kind, None, [], _traces(content, name, kind))
    file = TextFile(name, content, stop)
    try:
        kind = kind or text_format_of(file)
    except RecordFileError:
        return FilePreview(None, file.encoding, _lines(file, layout, None), [])
    if kind in seismic.NAMES:
        return FilePreview(kind, file.encoding, _lines(file, layout, None), _traces(content, name, kind))
    if kind == "columns":
        return _preview_columns(file, layout)
    channels = TEXT_FORMATS[kind].channels
    names: list[str] = []
    if channels is not None:
        try:
            with file.guarded(kind):
                names = channels(file)
        except RecordFileError:
            names = []
    return FilePreview(kind, file.encoding, _lines(file, layout, None), names)


def _preview_columns(file: TextFile, layout: Layout) -> FilePreview:
    try:
        table = Table(file, layout)
    except RecordFileError:
        return FilePreview("columns", file.encoding, _lines(file, layout, None), [])
    names = [cell.text for cell in table.header] or [""] * table.width
    names_line = table.header_line + 1 if table.header and table.header_line is not None else None
    preview = FilePreview("columns", file.encoding, _lines(file, layout, table), names, names_line)
    try:
        columns = Table(file, replace(layout, acceleration=None, time=None)).choice()
        units = Table(file, replace(layout, unit=None, time_unit=None)).choice()
        choice = table.choice()
    except RecordFileError:  # a column that is not there
        return preview
    in_file = Choice(columns.samples, units.unit, columns.time, units.time_unit)
    return replace(preview, in_file=in_file, choice=choice, missing=tuple(table.missing(choice)))


def _traces(content: bytes, name: str, kind: str) -> list[str]:
    try:
        return [str(trace.id) for trace in seismic.traces_of(content, name, kind)]
    except RecordFileError:
        return []


def _lines(file: TextFile, layout: Layout, table: Table | None) -> list[PreviewLine]:
    """Return the first lines of a file, and those around the first row."""
    start = layout.skip if table is None else table.first
    lines = []
    for k, text in file.lines(0):
        if k > start + LINES_BELOW:
            break
        if FIRST_LINES <= k < start - LINES_BELOW:
            continue
        cells: list[str] = []
        if table is not None and k == table.header_line and table.header:
            cells = [cell.text for cell in table.header]
        elif table is not None and k >= table.first and text.strip():
            cells = table.cells_of(text)
        short_cells = [cell[:SHOWN_SIGNS] for cell in cells[:SHOWN_CELLS]]
        lines.append(PreviewLine(k + 1, text[:SHOWN_SIGNS], short_cells))
    return lines
