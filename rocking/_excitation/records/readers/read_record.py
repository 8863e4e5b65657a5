"""`read_record`: reads an accelerogram file in a named format, or columns in a layout that its arguments state."""

from __future__ import annotations

from collections.abc import Callable
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from rocking._base.constants import STANDARD_GRAVITY
from rocking._base.errors import InvalidArgumentError, RecordFileError, UnreadableFileError
from rocking._base.units import Scalar
from rocking._excitation.records.readers import at2, columns, esm, knet, seismic, volumes
from rocking._excitation.records.readers.layout import Column, Layout, Samples, stated_layout
from rocking._excitation.records.readers.text_file import TextFile
from rocking._excitation.records.record import Record

if TYPE_CHECKING:  # loads the compiler
    from rocking._numba.cancellation import StopFlag

MAX_BYTES = 200_000_000  # largest file that is read [bytes]

MAX_SHIFT = 0.02
"""Largest distance in time of the last samples of two components whose steps differ by rounding, in steps [-]."""

MAX_LENGTH_RATIO = 1.1  # largest ratio of the numbers of samples of two components of one record [-]

MAX_USUAL_STEP = 0.1  # time step above which the reader asks [s]
MAX_USUAL_PGA = 5.0 * STANDARD_GRAVITY  # peak acceleration above which it asks [m/s2]
MAX_USUAL_PGV = 10.0  # peak velocity above which it asks [m/s]


class TextFormat(NamedTuple):
    """A format of text: whether its signature is in a file, its reader, and the names of channels if it has several."""

    recognises: Callable[[TextFile], bool]
    read: Callable[[TextFile, Layout], Samples]
    channels: Callable[[TextFile], list[str]] | None = None


TEXT_FORMATS = {
    "AT2": TextFormat(at2.is_at2, at2.read),
    "ESM": TextFormat(esm.is_esm, esm.read),
    "K-NET": TextFormat(knet.is_knet, knet.read),
    "COSMOS": TextFormat(volumes.is_cosmos, volumes.read_cosmos, volumes.channel_names),
    "GeoNet": TextFormat(volumes.is_geonet, volumes.read_geonet, volumes.component_names),
    "CSMIP": TextFormat(volumes.is_csmip, volumes.read_csmip, volumes.channel_names),
}
"""In the order in which their signatures are looked for: GeoNet is a CSMIP whose first line names its maker."""

FORMATS = (*TEXT_FORMATS, *seismic.NAMES, "columns")
"""Names of formats, of any case of letters."""

REFUSED = {
    "<": "a web page or XML",
    "{": "JSON",
    "* VOL1DS": "a BHRC Volume 1 file",
    "FILE ": "a USC Volume 1 file",
    "0 RAW": "an SMC file of raw data",
    "1 UNCORRECTED ACCEL": "an SMC file",
    "2 CORRECTED ACCEL": "an SMC file",
    "#K-NET CSV": "a K-NET CSV file",
}
"""Starts of files of other formats, which are refused by name."""


def read_record(
    file: str | PathLike[str],
    format: str | None = None,  # noqa: A002  # the word of the contract, as in pandas
    *,
    acceleration: Column | None = None,
    time: Column | None = None,
    time_step: Scalar | None = None,
    time_unit: str | None = None,
    unit: str | None = None,
    skip: int = 0,
    delimiter: str | None = None,
    decimal: str = ".",
    wrapped: bool = False,
    vertical: Column | PathLike[str] | None = None,
    allow_unusual: bool = False,
) -> Record:
    """Read a record of ground acceleration from a file in a named format, or in columns whose layout is stated.

    Nothing is recognised by its looks: a format is stated, or has a signature that it prescribes; columns are stated,
    or have the names `time` and `acceleration` (`acc`, `accel`) with units in brackets, such as
    `time [s],acceleration [g]`. What is missing is asked for. Nothing is corrected or resampled, but for the offset of
    K-NET counts: their mean is removed (docs/records.md).

    Parameters
    ----------
    file : str or path
        The file.
    format : str, optional
        AT2, ESM, K-NET, COSMOS, CSMIP, GeoNet, columns; SAC, miniSEED, TSPAIR, SLIST with the package obspy. By default
        the one whose signature the file has, else columns. "columns" overrules any signature.
    acceleration : str or int, optional
        The column: its name in the header, with or without the unit in brackets, or its number from 1. Likewise the
        channel of a file with several.
    time : str or int, optional
        The column of the times, which are uniform.
    time_step : float, optional
        Time step [s], [1e-6, 10], in place of a column of times.
    time_unit : str, optional
        Unit of the column of times: "s", "ms", "us" or "min".
    unit : str, optional
        Unit of the samples: "m/s2", "cm/s2", "gal", "mm/s2", "g", "mg", "%g", "g/10", "in/s2" or "ft/s2".
    skip : int, optional
        Lines above the names of the columns, or above the rows where there are no names. The line below them names the
        columns, unless all of it are numbers.
    delimiter : str, optional
        What separates columns: "comma", "semicolon", "tab", "blank" (any number of blanks and tabs), or these signs;
        several signs if each separates; a Fortran format such as "8f10.6" for numbers of fixed width, behind which the
        rest of the line is left out. By default the one of these signs that is in the first row, else blanks.
    decimal : str, optional
        Decimal sign: "." or ",".
    wrapped : bool, optional
        Whether all values are one series, row by row.
    vertical : str, int or path, optional
        File of the vertical component, upwards positive, in the same layout, which starts at the same time; or, where
        there is no file of this name, its column or channel in the first file. A vertical component of another length,
        by a tenth at most, is cut or continued by zeros, with a remark.
    allow_unusual : bool, optional
        Accept a time step above 0.1 s, a PGA above 5 g, a PGV above 10 m/s, which usually are a wrong unit.

    Raises
    ------
    RecordFileError
        If a file is damaged, its layout is not stated, or the result is unusual: with the line, what was found, what
        was expected and, where that can be said, the arguments that would read it.
    InvalidArgumentError
        If a file cannot be read, an argument is out of range, or the components differ in step or length.
    """
    content, name = read_content("file", file), Path(file).name
    arguments: dict[str, Any] = {
        "format": format,
        "acceleration": acceleration,
        "time": time,
        "time_step": time_step,
        "time_unit": time_unit,
        "unit": unit,
        "skip": skip,
        "delimiter": delimiter,
        "decimal": decimal,
        "wrapped": wrapped,
        "allow_unusual": allow_unusual,
    }
    if isinstance(vertical, PathLike) or (isinstance(vertical, str) and Path(vertical).is_file()):
        record = parse_record(content, name, **arguments)
        upwards = parse_record(read_content("vertical", vertical), Path(vertical).name, **arguments)
        return with_vertical(record, upwards)
    return parse_record(content, name, **arguments, vertical=vertical)


def read_content(parameter: str, path: str | PathLike[str]) -> bytes:
    """Read the bytes of a file, one more than is allowed at most; an argument of this name if it cannot be read."""
    try:
        with Path(path).open("rb") as stream:
            return stream.read(MAX_BYTES + 1)
    except OSError as error:
        raise UnreadableFileError(parameter, str(path), error) from None


def parse_record(
    content: bytes,
    name: str,
    *,
    vertical: Column | None = None,
    allow_unusual: bool = False,
    stop: StopFlag | None = None,
    **arguments: Any,
) -> Record:
    """Read a recorded ground acceleration from the bytes of a file; `name` is its name for messages.

    `arguments` are the others of `read_record`; `vertical` is a column or channel of this file. `stop` cancels
    the work, which then raises `StoppedError`. Errors as for `read_record`.
    """
    layout = stated_layout(FORMATS, **arguments)
    if len(content) > MAX_BYTES:
        raise RecordFileError(name, None, "a larger file", f"at most {MAX_BYTES} bytes")
    record = _record(content, name, layout, stop)
    if vertical is not None:
        upwards = stated_layout(FORMATS, **{**arguments, "acceleration": vertical})
        try:
            record = with_vertical(record, _record(content, name, upwards, stop))
        except RecordFileError as error:
            raise InvalidArgumentError("vertical", vertical, f"a file, or a column of {name} ({error})") from None
    if not allow_unusual:
        _check_usual(record, name)
    return record


def _record(content: bytes, name: str, layout: Layout, stop: StopFlag | None) -> Record:
    """Read one component."""
    kind = layout.format or seismic.format_of(content)
    if kind in seismic.NAMES:
        file = TextFile(name, b"a", stop)  # for messages
        with file.guarded(kind):
            layout.refuse_columns(file, kind, channels=True)
            return _as_record(seismic.read(content, name, layout, kind))
    file = TextFile(name, content, stop)
    kind = kind or text_format_of(file)
    with file.guarded(kind):
        reader = columns.read if kind == "columns" else TEXT_FORMATS[kind].read
        return _as_record(reader(file, layout))


def text_format_of(file: TextFile) -> str:
    """The format whose signature a file of text has, else "columns"; others that are known are refused by name."""
    kind = next((name for name, form in TEXT_FORMATS.items() if form.recognises(file)), "columns")
    start = file.head[0].lstrip().upper()
    if kind == "columns":
        refused = next((text for prefix, text in REFUSED.items() if start.startswith(prefix)), None)
        if refused:
            raise file.error(0, refused, f"one of {', '.join(FORMATS)}: convert it")
    return kind


def _as_record(samples: Samples) -> Record:
    return Record(samples.values, samples.step, samples.unit, samples.name, samples.source, samples.remarks)


def _check_usual(record: Record, name: str) -> None:
    """Ask about a record that usually comes from a wrong unit or column."""
    peak = max(record.peak_acceleration, record.peak_vertical_acceleration)
    rises = np.diff(record.acceleration)
    questions = [
        (rises.min() > 0.98 * rises.max() > 0.0, "values that rise uniformly, as times do", "accelerations"),
        (record.time_step > MAX_USUAL_STEP, f"a time step of {record.time_step:g} s", f"at most {MAX_USUAL_STEP:g} s"),
        (peak > MAX_USUAL_PGA, f"a PGA of {peak / STANDARD_GRAVITY:.4g} g", "at most 5 g"),
        (
            record.peak_velocity > MAX_USUAL_PGV,
            f"a PGV of {record.peak_velocity:.4g} m/s",
            f"at most {MAX_USUAL_PGV:g} m/s without an offset of the acceleration",
        ),
    ]
    for unusual, description, limit in questions:
        if unusual:
            expected = f"{limit}, in the units and columns stated; or `allow_unusual=True`, if it is right"
            raise RecordFileError(name, None, description, expected)


def with_vertical(record: Record, upwards: Record) -> Record:
    """Add another record as the vertical component; raise `InvalidArgumentError` if step or length differ."""
    shift = abs(upwards.time_step / record.time_step - 1.0) * min(record.samples, upwards.samples)
    if shift > MAX_SHIFT:
        allowed = f"a component with the step of the horizontal one, {record.time_step:g} s"
        raise InvalidArgumentError("vertical", f"a time step of {upwards.time_step:g} s", allowed)
    counts = sorted((record.samples, upwards.samples))
    if counts[1] > MAX_LENGTH_RATIO * counts[0]:
        allowed = f"about as many samples as the horizontal component, {record.samples}"
        raise InvalidArgumentError("vertical", f"{upwards.samples} samples", allowed)
    remarks = [*record.remarks, *(f"vertical component: {remark}" for remark in upwards.remarks)]
    if upwards.samples != record.samples:
        done = "cut" if upwards.samples > record.samples else "continued by zeros"
        counted = f"has {upwards.samples} samples and the horizontal one {record.samples}"
        remarks.append(f"the vertical component {counted}: it is {done}")
    samples = np.zeros(record.samples)
    samples[: upwards.samples] = upwards.acceleration[: record.samples]
    texts = record.name, f"{record.source}; vertical: {upwards.name}, {upwards.source}", remarks
    return Record(record.acceleration, record.time_step, "m/s2", *texts, vertical=samples)
