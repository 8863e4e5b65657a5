"""SAC and miniSEED files through ObsPy, an optional package."""

import io
import struct
import warnings

import numpy as np

from rocking._base.errors import RecordFileError
from rocking._excitation.records.readers.lines import overruled
from rocking._excitation.records.record import Record

SAC_VERSION_PLACE, SAC_VERSIONS = 304, (6, 7)  # byte and values of the header version of a binary SAC file


def is_seismic(content: bytes) -> bool:
    """Whether the bytes start like a SAC or miniSEED file."""
    mini_seed = len(content) > 48 and content[:6].isdigit() and content[6:7] in b"DRQM" and content[7:8] in b" \0"
    if mini_seed or content[:3] == b"MS\x03":
        return True
    if len(content) < 632:
        return False
    place = slice(SAC_VERSION_PLACE, SAC_VERSION_PLACE + 4)
    return any(struct.unpack(order + "i", content[place])[0] in SAC_VERSIONS for order in "<>")


def read(content: bytes, file: str, unit: str | None, time_step: float | None, component: str | None) -> Record:
    """Read one trace; the unit has to be given, since these formats hold none."""
    try:
        import obspy  # type: ignore[import-not-found]  # noqa: PLC0415  # optional
    except ImportError:
        raise RecordFileError(
            file, None, "a SAC or miniSEED file", "the package obspy to read it: pip install obspy"
        ) from None
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error", UserWarning)  # obspy warns where it reads a part of a damaged file
            stream = obspy.read(io.BytesIO(content)).merge()
    except Exception as error:  # noqa: BLE001  # obspy raises many kinds for damaged files
        raise RecordFileError(file, None, str(error) or type(error).__name__, "a SAC or miniSEED file") from None
    traces = {trace.id: trace for trace in stream}
    found = [key for key in traces if component is None or key == component or key.endswith(f".{component}")]
    if len(found) != 1:
        expected = f"component {component}" if component else "the argument `component`: one of them"
        raise RecordFileError(file, None, f"components {', '.join(traces)}", expected)
    trace = traces[found[0]]
    if np.ma.is_masked(trace.data):
        raise RecordFileError(file, None, "a gap in the trace", "samples without gaps")
    if unit is None:
        raise RecordFileError(file, None, "no unit of acceleration", "the argument `unit`")
    step = float(trace.stats.delta)
    remarks: tuple[str, ...] = ()
    if time_step is not None and abs(time_step / step - 1.0) > 1e-3:
        remarks, step = (overruled(f"a time step of {step:g} s", "time_step", f"{time_step:g} s"),), time_step
    about = found[0], f"{file} (ObsPy)", remarks
    return Record(np.asarray(trace.data, dtype=np.float64), step, unit, *about)
