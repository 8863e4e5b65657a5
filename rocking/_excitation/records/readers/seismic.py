"""SAC, miniSEED, and TSPAIR and SLIST of the `timeseries` service of EarthScope, through ObsPy, an optional package."""

from __future__ import annotations

import io
import struct
import warnings
from typing import Any

import numpy as np

from rocking._base.errors import RecordFileError
from rocking._base.units import quantities_of, unit_name
from rocking._excitation.records.readers.layout import Layout, Samples

SAC_VERSION_PLACE = 304
SAC_VERSIONS = 6, 7  # values of the header version of a binary SAC file, at that byte
NAMES = {"SAC": "SAC", "miniSEED": "MSEED", "TSPAIR": "TSPAIR", "SLIST": "SLIST"}
"""The names of the formats in ObsPy."""


def format_of(content: bytes) -> str | None:
    """Return the format of the signature; None for other files."""
    mini_seed = len(content) > 48 and content[:6].isdigit() and content[6:7] in b"DRQM" and content[7:8] in b" \0"
    if mini_seed or content[:3] == b"MS\x03":
        return "miniSEED"
    if content.startswith(b"TIMESERIES "):
        words = content[:500].partition(b"\n")[0].upper()
        return next((name for name in ("TSPAIR", "SLIST") if name.encode() in words), None)
    version = slice(SAC_VERSION_PLACE, SAC_VERSION_PLACE + 4)
    if len(content) >= 632 and any(struct.unpack(order + "i", content[version])[0] in SAC_VERSIONS for order in "<>"):
        return "SAC"
    return None


def traces_of(content: bytes, name: str, kind: str) -> list[Any]:
    """The traces of a file, as ObsPy has them."""
    if kind in ("TSPAIR", "SLIST"):  # before ObsPy: some of the units of counts it does not read
        title = content[:500].partition(b"\n")[0].decode(errors="replace")
        _check_unit(name, title.rpartition(",")[2].strip())
    try:
        import obspy  # type: ignore[import-not-found]  # noqa: PLC0415  # optional
    except ImportError:
        raise RecordFileError(
            name, None, f"a file of {kind}", "the package obspy to read it: pip install 'rocking[seismic]'"
        ) from None
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error", UserWarning)  # obspy warns where it reads a part of a damaged file
            return list(obspy.read(io.BytesIO(content), format=NAMES[kind]).merge())
    except Exception as error:  # noqa: BLE001  # obspy raises many kinds for damaged files
        raise RecordFileError(name, None, str(error) or type(error).__name__, f"a file of {kind}") from None


def read(content: bytes, name: str, layout: Layout, kind: str) -> Samples:
    """Read one trace of accelerations."""
    trace = _chosen(name, layout, traces_of(content, name, kind))
    if np.ma.is_masked(trace.data):
        raise RecordFileError(name, None, "a gap in the trace", "samples without gaps")
    text = trace.stats.get("ascii", {}).get("unit", "")
    _check_unit(name, text)
    if trace.data.dtype.kind != "f":
        expected = "accelerations; remove the response of the instrument with ObsPy, and write numbers with decimals"
        raise RecordFileError(name, None, "whole numbers, which are counts", expected)
    remarks: list[str] = []
    unit = layout.agreed_unit(unit_name(text, "m/s2") or text or None, remarks)
    if unit is None or (layout.unit is None and unit_name(text, "m/s2") is None):
        raise RecordFileError(name, None, text or "no unit of acceleration", "the argument `unit`")
    step = float(trace.stats.delta)
    values = np.asarray(trace.data, dtype=np.float64)
    if not np.isfinite(values).all():
        raise RecordFileError(name, None, "a number beyond the range of doubles", "finite numbers")
    return Samples(values, layout.agreed_step(step, remarks) or step, unit, trace.id, f"{name} ({kind})", remarks)


def _check_unit(name: str, text: str) -> None:
    if "count" in text.lower() or (quantities_of(text) and unit_name(text, "m/s2") is None):
        raise RecordFileError(name, None, text, "a trace of accelerations; counts are not converted")


def _chosen(name: str, layout: Layout, traces: list[Any]) -> Any:
    """Return the trace of a number, an identifier or the code of its channel."""
    name_or_number = layout.acceleration
    if name_or_number is None and len(traces) == 1:
        return traces[0]
    matching = [
        trace for k, trace in enumerate(traces) if str(name_or_number) in (str(k + 1), trace.id, trace.stats.channel)
    ]
    if len(matching) != 1:
        identifiers = ", ".join(trace.id for trace in traces)
        raise RecordFileError(name, None, f"traces {identifiers}", "the argument `acceleration`: one of them")
    return matching[0]
