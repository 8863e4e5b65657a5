"""Files of sampled pulses: columns of numbers, or JSON. `rocking.SampledPulse.from_file` reads them."""

import codecs
import json
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import Any

from rocking._base.arrays import Array
from rocking._base.errors import InvalidArgumentError, RecordFileError, UnreadableFileError
from rocking._excitation.records.readers.columns import Table
from rocking._excitation.records.readers.layout import Layout, stated_layout
from rocking._excitation.records.readers.text_file import TextFile

MAX_BYTES = 8_000_000  # largest file of a pulse [bytes]: 100,000 times and accelerations of all digits
KEYS = ("acceleration", "time", "period", "name")  # keys of a JSON file, arguments of `rocking.SampledPulse`
MAX_TEXT = 60  # characters of a value that an error repeats


@dataclass(frozen=True)
class PulseFile:
    """Content of a file of a pulse."""

    arguments: dict[str, Any]  # arguments of `rocking.SampledPulse`
    name: str  # of the file
    table: Table | None  # None for JSON

    def error(self, error: InvalidArgumentError) -> InvalidArgumentError:
        """Convert an error about an argument to one about the file, with its name and the line."""
        position, name = self.name, error.parameter
        if error.index and self.table is None:
            name += f"[{error.index[0]}]"
        elif error.index and self.table is not None:
            position += f", line {self.table.line_of(error.index[0]) + 1}"
        return InvalidArgumentError("pulse", f"{position}: {name} {str(error.value)[:MAX_TEXT]}", error.allowed)


def read_pulse_file(path: str | PathLike[str], limit: int, **columns: Any) -> PulseFile:
    """Read the arguments of a pulse of at most `limit` samples from a file; `columns`: the layout that is stated.

    Raises `InvalidArgumentError` if the file cannot be read, with the parameter `path`; with the parameter `pulse`,
    naming the file and the line, if it does not hold a pulse.
    """
    layout = stated_layout(("columns",), **columns)
    file = Path(path)
    try:
        with file.open("rb") as stream:
            content = stream.read(MAX_BYTES + 1)
    except OSError as error:
        raise UnreadableFileError("path", str(path), error) from None
    try:
        if len(content) > MAX_BYTES:
            raise RecordFileError(file.name, None, "a larger file", f"at most {MAX_BYTES} bytes")
        text = TextFile(file.name, content)
        if text.content.removeprefix(codecs.BOM_UTF8).lstrip()[:1] == b"{":
            return PulseFile({"name": file.stem} | _parse_json(text), text.name, None)
        table, time, acceleration = _read_columns(text, limit, layout)
    except RecordFileError as error:
        position = error.file if error.line is None else f"{error.file}, line {error.line}"
        raise InvalidArgumentError("pulse", f"{position}: {str(error.value)[:MAX_TEXT]}", error.expected) from None
    return PulseFile({"acceleration": acceleration, "time": time, "name": file.stem}, text.name, table)


def _read_columns(text: TextFile, limit: int, layout: Layout) -> tuple[Table, Array | None, Array]:
    """Read the columns, times if there are some, and accelerations, in any units.

    Where they are neither stated nor named, a single column holds accelerations, and two hold times and accelerations.
    """
    with text.guarded("a pulse"):
        table = Table(text, layout)
        choice = table.choice()
        columns = [choice.samples] if choice.time is None else [choice.samples, choice.time]
        if columns == [None] and not table.header and table.width <= 2:
            table.check_comma()
            table.quantity_remarks(choice)
            columns = [0] if table.width == 1 else [1, 0]
        if None in columns:
            expected = "accelerations, or times and accelerations, named `acceleration` and `time` or stated"
            raise table.error(table.first, table.shown, expected)
        values, *times = table.columns([column for column in columns if column is not None], times=True)
        if values.size > limit:
            raise text.error(None, f"{values.size} rows", f"at most {limit}")
        return table, times[0] if times else None, values


def _parse_json(text: TextFile) -> dict[str, Any]:
    """Parse the object in a JSON file."""
    try:
        values = json.loads(text.content)
    except json.JSONDecodeError as error:
        raise text.error(error.lineno - 1, error.msg, "JSON") from None
    except (ValueError, RecursionError) as error:  # bytes that are no text, integers of thousands of digits
        raise text.error(None, error, "JSON") from None
    if "acceleration" not in values:
        raise text.error(None, "no key acceleration", f"the keys {', '.join(KEYS)}, the first required")
    if unknown := next((key for key in values if key not in KEYS), None):
        raise text.error(None, f"the key {unknown}", f"the keys {', '.join(KEYS)}, the first required")
    return dict(values)
