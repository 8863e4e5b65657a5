"""`read_record`: reads an accelerogram file; the format is recognised by the content, not by the name."""

from __future__ import annotations

from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

from rocking.errors import InvalidArgumentError, RecordFileError, number, one_of
from rocking.excitation.records.readers import columns, esm, knet, peer_at2, seismic
from rocking.excitation.records.readers.lines import MAX_LINE, TextFile
from rocking.excitation.records.record import TIME_STEP, UNITS, Record
from rocking.units import Scalar

if TYPE_CHECKING:  # loads the compiler
    from rocking._numba.cancellation import StopFlag

MAX_BYTES = 200_000_000
"""Largest file that is read [bytes]."""


def read_record(
    path: str | PathLike[str],
    *,
    unit: str | None = None,
    time_step: Scalar | None = None,
    component: str | None = None,
) -> Record:
    """Read a recorded ground acceleration from a file.

    The format is recognised by the content: PEER AT2, ESM ASCII, K-NET, columns of times and accelerations or of
    accelerations alone (docs/records.md), SAC and miniSEED with the package obspy. Nothing is corrected or resampled.

    Parameters
    ----------
    path : str or path
        The file.
    unit : str, optional
        Unit of the samples, a key of `rocking.excitation.records.record.UNITS`. Required where the file states none;
        refused where it states another.
    time_step : float, optional
        Time step [s], [1e-6, 10]; likewise.
    component : str, optional
        Name of the column or trace, where the file has several.

    Raises
    ------
    RecordFileError
        If the file is damaged, ambiguous or of an unknown format: with the line, what was found and what was expected.
    InvalidArgumentError
        If the file cannot be read, or an argument is out of range.
    """
    file = Path(path)
    try:
        with file.open("rb") as stream:
            content = stream.read(MAX_BYTES + 1)
    except OSError as error:
        raise InvalidArgumentError("path", str(path), f"a file that can be read ({error.strerror})") from None
    return parse_record(content, file.name, unit=unit, time_step=time_step, component=component)


def parse_record(
    content: bytes,
    name: str,
    *,
    unit: str | None = None,
    time_step: Scalar | None = None,
    component: str | None = None,
    stop: StopFlag | None = None,
) -> Record:
    """Read a recorded ground acceleration from the bytes of a file; `name` is its name for messages.

    `stop` cancels the work, which then raises `StoppedError`. Other parameters and errors as for `read_record`.
    """
    if unit is not None:
        one_of("unit", unit, UNITS)
    step = None if time_step is None else number("time_step", time_step, *TIME_STEP, unit="s")
    if len(content) > MAX_BYTES:
        raise RecordFileError(name, None, "a larger file", f"at most {MAX_BYTES} bytes")
    if seismic.is_seismic(content):
        return seismic.read(content, name, unit, step, component)
    _check_text(content, name)
    file = TextFile(name, content, stop)
    try:
        return _read_text(file, unit, step, component)
    except RecordFileError:
        raise
    except InvalidArgumentError as error:  # samples that make no record, such as zeros only
        raise file.error(None, f"{error.parameter} {error.value}", error.allowed) from None


def _read_text(file: TextFile, unit: str | None, time_step: float | None, component: str | None) -> Record:
    if esm.is_esm(file):
        found = esm.read(file, unit, time_step)
    elif knet.is_knet(file):
        found = knet.read(file, unit, time_step)
    elif peer_at2.header_line(file) is not None:
        found = peer_at2.read(file, unit, time_step)
    else:
        return columns.read(file, unit, time_step, component)
    if component is not None:
        raise file.error(None, "a file with one component", "no argument `component`")
    return found


def _check_text(content: bytes, name: str) -> None:
    """Refuse what is no text of numbers."""
    if not content or content.isspace():
        raise RecordFileError(name, None, "an empty file", "a recorded ground acceleration")
    if b"\0" in content:
        raise RecordFileError(name, None, "binary content", "text, or a SAC or miniSEED file")
    start = content[:MAX_LINE].lstrip()[:40].decode("latin-1")
    if start.startswith(("<", "{")):
        expected = "numbers or the header of a known format, not a web page or JSON"
        raise RecordFileError(name, 1, start.splitlines()[0], expected)
