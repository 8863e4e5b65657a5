"""Files of sampled pulses: columns of numbers, or JSON. `rocking.SampledPulse.from_file` reads them."""

import codecs
import json
from dataclasses import dataclass
from itertools import islice
from os import PathLike
from pathlib import Path
from typing import Any

from rocking._base.errors import InvalidArgumentError, RecordFileError, UnreadableFileError
from rocking._excitation.records.readers.columns import read_samples
from rocking._excitation.records.readers.lines import TextFile

MAX_BYTES = 8_000_000  # largest file of a pulse [bytes]: 100,000 times and accelerations of all digits
KEYS = ("acceleration", "time", "period", "name")  # keys of a JSON file, arguments of `rocking.SampledPulse`
MAX_TEXT = 60  # characters of a value that an error repeats


@dataclass(frozen=True)
class PulseFile:
    """What a file of a pulse holds."""

    arguments: dict[str, Any]  # arguments of `rocking.SampledPulse`
    text: TextFile  # the file
    first: int | None  # index of the line of the first sample; None for JSON

    def error(self, error: InvalidArgumentError) -> InvalidArgumentError:
        """An error about an argument as one about the file: with its name and the line."""
        place, name = self.text.name, error.parameter
        if error.index and self.first is None:
            name += f"[{error.index[0]}]"
        elif error.index and self.first is not None:
            rows = (k for start, lines in self.text.rows(self.first) for k, line in enumerate(lines, start) if line)
            place += f", line {next(islice(rows, error.index[0], None)) + 1}"
        return InvalidArgumentError("pulse", f"{place}: {name} {str(error.value)[:MAX_TEXT]}", error.allowed)


def read_pulse_file(path: str | PathLike[str], most: int) -> PulseFile:
    """The arguments of a pulse of at most `most` samples from a file.

    Raises `InvalidArgumentError` if the file cannot be read, with the parameter `path`; with the parameter `pulse`,
    naming the file and the line, if it does not hold a pulse.
    """
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
            return PulseFile({"name": file.stem} | _parse_json(text), text, None)
        first, time, acceleration = read_samples(text, most)
    except RecordFileError as error:
        place = error.file if error.line is None else f"{error.file}, line {error.line}"
        raise InvalidArgumentError("pulse", f"{place}: {str(error.value)[:MAX_TEXT]}", error.expected) from None
    return PulseFile({"acceleration": acceleration, "time": time, "name": file.stem}, text, first)


def _parse_json(text: TextFile) -> dict[str, Any]:
    """The object in a JSON file."""
    try:
        found = json.loads(text.content)
    except json.JSONDecodeError as error:
        raise text.error(error.lineno - 1, error.msg, "JSON") from None
    except (ValueError, RecursionError) as error:  # bytes that are no text, integers of thousands of digits
        raise text.error(None, error, "JSON") from None
    if "acceleration" not in found:
        raise text.error(None, "no key acceleration", f"the keys {', '.join(KEYS)}, the first required")
    if unknown := next((key for key in found if key not in KEYS), None):
        raise text.error(None, f"the key {unknown}", f"the keys {', '.join(KEYS)}, the first required")
    return dict(found)
