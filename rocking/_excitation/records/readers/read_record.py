"""`read_record`: reads an accelerogram file; the format is recognised by the content, not by the name."""

from __future__ import annotations

from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking._base.errors import InvalidArgumentError, RecordFileError, UnreadableFileError, integer, number, one_of
from rocking._base.units import Scalar
from rocking._excitation.records.readers import columns, esm, knet, peer_at2, seismic, volumes
from rocking._excitation.records.readers.lines import MAX_LINE, TextFile
from rocking._excitation.records.record import TIME_STEP, UNITS, Record

if TYPE_CHECKING:  # loads the compiler
    from rocking._numba.cancellation import StopFlag

MAX_BYTES = 200_000_000  # largest file that is read [bytes]
MAX_SKIP = 100  # most rows of numbers above the samples [-]

MAX_SHIFT = 0.02
"""Largest distance in time of the last samples of two components whose steps differ by rounding, in steps [-]."""

MAX_LENGTH_RATIO = 1.1  # largest ratio of the numbers of samples of two components of one record [-]


def read_record(
    path: str | PathLike[str],
    *,
    unit: str | None = None,
    time_step: Scalar | None = None,
    component: str | None = None,
    vertical: str | PathLike[str] | None = None,
    skip: int | None = None,
) -> Record:
    """A record of ground acceleration from a file, or from two files if the vertical component has its own.

    The format is recognised by the content: PEER AT2, ESM ASCII, K-NET, COSMOS, CSMIP, GeoNet, SMC, TSPAIR, columns of
    times and accelerations or of accelerations alone (docs/records.md), SAC and miniSEED with the package obspy.
    Nothing is corrected or resampled, but for the offset of K-NET counts: their mean is removed.

    Parameters
    ----------
    path : str or path
        The file.
    unit : str, optional
        Unit of the samples: "m/s2", "cm/s2", "gal", "mm/s2", "g", "mg", "%g", "g/10", "in/s2" or "ft/s2". Required
        where the file states none, or one that is not understood; where it states another, this one is used, with a
        remark that names both.
    time_step : float, optional
        Time step [s], [1e-6, 10]; likewise.
    component : str, optional
        Name of the column or trace, where the file has several; "rows" for one series that is wrapped over several
        columns, where the file does not show it.
    vertical : str or path, optional
        File of the vertical component, upwards positive, with one component that starts at the same time; or, where
        there is no file of this name, its column or trace in the first file. `unit` and `time_step` count for both. A
        vertical component of another length, by a tenth at most, is cut or continued by zeros, with a remark.
    skip : int, optional
        Rows of numbers above the samples of a file of columns, such as a count, a step or a factor, [0, 100]. A column
        whose first numbers look like these is refused unless this is given.

    Raises
    ------
    RecordFileError
        If a file is damaged, ambiguous or of an unknown format: with the line, what was found and what was expected.
    InvalidArgumentError
        If a file cannot be read, an argument is out of range, or the components differ in step or length.
    """
    content, name = read_content("path", path), Path(path).name
    stated: dict[str, Any] = {"unit": unit, "time_step": time_step, "skip": skip}
    found = parse_record(content, name, **stated, component=component)
    if vertical is None:
        return found
    if isinstance(vertical, PathLike) or Path(vertical).is_file():
        upwards = parse_record(read_content("vertical", vertical), Path(vertical).name, **stated)
    else:
        upwards = _vertical(content, name, vertical, f"a file, or a component of {name}", **stated)
    return _with_vertical(found, upwards)


def read_content(parameter: str, path: str | PathLike[str]) -> bytes:
    """The bytes of a file, one more than is allowed at most; an argument of this name if it cannot be read."""
    try:
        with Path(path).open("rb") as stream:
            return stream.read(MAX_BYTES + 1)
    except OSError as error:
        raise UnreadableFileError(parameter, str(path), error) from None


def _with_vertical(found: Record, upwards: Record) -> Record:
    """A record with another one as its vertical component."""
    shift = abs(upwards.time_step / found.time_step - 1.0) * min(found.samples, upwards.samples)
    if shift > MAX_SHIFT:
        allowed = f"a component with the step of the horizontal one, {found.time_step:g} s"
        raise InvalidArgumentError("vertical", f"a time step of {upwards.time_step:g} s", allowed)
    counts = sorted((found.samples, upwards.samples))
    if counts[1] > MAX_LENGTH_RATIO * counts[0]:
        allowed = f"about as many samples as the horizontal component, {found.samples}"
        raise InvalidArgumentError("vertical", f"{upwards.samples} samples", allowed)
    remarks = [*found.remarks, *(f"vertical component: {remark}" for remark in upwards.remarks)]
    if upwards.samples != found.samples:
        done = "cut" if upwards.samples > found.samples else "continued by zeros"
        remarks.append(
            f"the vertical component has {upwards.samples} samples and the horizontal one {found.samples}: it is {done}"
        )
    samples = np.zeros(found.samples)
    samples[: upwards.samples] = upwards.acceleration[: found.samples]
    source = f"{found.source}; vertical: {upwards.name}, {upwards.source}"
    about = found.name, source, remarks
    return Record(found.acceleration, found.time_step, "m/s2", *about, vertical=samples)


def parse_record(
    content: bytes,
    name: str,
    *,
    unit: str | None = None,
    time_step: Scalar | None = None,
    component: str | None = None,
    vertical: str | None = None,
    skip: int | None = None,
    stop: StopFlag | None = None,
) -> Record:
    """Read a recorded ground acceleration from the bytes of a file; `name` is its name for messages.

    `vertical` is a column or trace of this file. `stop` cancels the work, which then raises `StoppedError`. Other
    parameters and errors as for `read_record`.
    """
    stated: dict[str, Any] = {"unit": unit, "time_step": time_step, "skip": skip, "stop": stop}
    found = _parsed(content, name, component=component, **stated)
    if vertical is None:
        return found
    return _with_vertical(found, _vertical(content, name, vertical, f"a component of {name}", **stated))


def _vertical(content: bytes, name: str, vertical: str, allowed: str, **stated: Any) -> Record:
    """The vertical component in the file of the horizontal one; `allowed` is what an error says of its name."""
    try:
        return _parsed(content, name, component=vertical, **stated)
    except RecordFileError as error:
        raise InvalidArgumentError("vertical", vertical, f"{allowed} ({error})") from None


def _parsed(
    content: bytes,
    name: str,
    unit: str | None,
    time_step: Scalar | None,
    component: str | None,
    skip: int | None,
    stop: StopFlag | None = None,
) -> Record:
    """One component."""
    if unit is not None:
        one_of("unit", unit, UNITS)
    step = None if time_step is None else number("time_step", time_step, *TIME_STEP, unit="s")
    passed = None if skip is None else integer("skip", skip, 0, MAX_SKIP)
    if len(content) > MAX_BYTES:
        raise RecordFileError(name, None, "a larger file", f"at most {MAX_BYTES} bytes")
    if seismic.is_seismic(content):
        return seismic.read(content, name, unit, step, component)
    file = TextFile(name, content, stop)
    _check_text(file.content, name)
    try:
        found = _read_text(file, unit, step, component, passed)
    except RecordFileError:
        raise
    except InvalidArgumentError as error:  # samples that make no record, such as zeros only
        raise file.error(None, f"{error.parameter} {error.value}", error.allowed) from None
    if not file.overruled:
        return found
    about = found.name, found.source, (*found.remarks, *file.overruled)
    return Record(found.acceleration, found.time_step, "m/s2", *about)


def _read_text(
    file: TextFile, unit: str | None, time_step: float | None, component: str | None, skip: int | None
) -> Record:
    kind = None
    if esm.is_esm(file):
        reader = esm.read
    elif knet.is_knet(file):
        reader = knet.read
    elif kind := volumes.format_of(file):
        if skip is None:
            return volumes.read(file, kind, unit, time_step, component)
    elif peer_at2.is_at2(file):
        reader = peer_at2.read
    else:
        return columns.read(file, unit, time_step, component, skip)
    if skip is not None:
        raise file.error(None, f"`skip` = {skip}", "no rows to skip in a file of a known format")
    if component is not None:
        raise file.error(None, "a file with one component", "no name of a component")
    return reader(file, unit, time_step)


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
