"""K-NET and KiK-net ASCII files: 17 header lines, then counts, eight on a line, with a scale such as 2000(gal)/8388608.

The counts include the offset of the instrument, in real files 1.3 to 665 times the largest acceleration about it: their
mean is removed, as in the `Max. Acc.` of the header, and the record says so.
"""

import math
import re

import numpy as np

from rocking._excitation.records.processing import OFFSET_SHARE
from rocking._excitation.records.readers.lines import NUMBER, TextFile, agreed_step, agreed_unit, joined, parse_unit
from rocking._excitation.records.record import Record

HEADER_LINES = 17


def is_knet(file: TextFile) -> bool:
    """Whether the header has the keys of the format."""
    header = "\n".join(file.head[:HEADER_LINES]).lower()
    return "scale factor" in header and ("sampling freq" in header or "origin time" in header)


def read(file: TextFile, unit: str | None, time_step: float | None) -> Record:
    """Read a K-NET file; arguments and errors as for `read_record`."""
    if len(file.head) <= HEADER_LINES:
        raise file.error(None, f"{len(file.head)} lines", f"{HEADER_LINES} header lines and counts")

    def entry(key: str) -> tuple[int, str]:
        for k, line in enumerate(file.head[:HEADER_LINES]):
            if line.lower().startswith(key.lower()):
                return k, line[len(key) :].strip()
        raise file.error(None, f"no header line {key}", f"one within the first {HEADER_LINES} lines")

    line, text = entry("Sampling Freq(Hz)")
    frequency = file.positive(line, re.sub(r"(?i)hz$", "", text), "the sampling frequency [Hz]")
    step = agreed_step(file, line, 1.0 / frequency, time_step)
    line, text = entry("Scale Factor")
    scale = re.fullmatch(rf"({NUMBER.pattern})\s*\(([^)]+)\)\s*/\s*({NUMBER.pattern})", text)
    if scale is None:
        raise file.error(line, text, "a scale such as 2000(gal)/8388608")
    stated = parse_unit(scale[2])
    if stated is None and unit is None:
        raise file.error(line, scale[2], "a unit of acceleration, such as gal")
    agreed = agreed_unit(file, line, stated, unit)
    scale_line, scale_text = line, text
    most, counts = (file.positive(line, scale[part], "a positive number in the scale") for part in (1, 3))
    duration_line, text = entry("Duration Time")
    duration_text = text.removeprefix("(s)").strip()
    duration = file.positive(duration_line, duration_text, "the duration [s]")
    values = file.values(HEADER_LINES)
    with np.errstate(over="ignore", invalid="ignore"):
        accelerations = values * (most / counts)
    if not np.isfinite(accelerations).all():
        raise file.error(scale_line, scale_text, "a scale with which the accelerations are finite")
    samples = duration * frequency
    if not math.isfinite(samples):
        raise file.error(duration_line, duration_text, "a duration [s] that agrees with the number of values")
    remarks = file.checked_count(values, round(samples), duration_line)
    station, direction = entry("Station Code")[1], entry("Dir.")[1]
    name = " ".join(part for part in (station, direction) if part) or file.name
    event = entry("Origin Time")[1]
    offset = float(accelerations.mean())
    shaking = accelerations - offset
    largest = float(np.abs(shaking).max())
    removed = f"the offset of the counts, their mean of {offset:.5g} {agreed}, is removed"
    if abs(offset) > OFFSET_SHARE * largest:
        remarks += (f"{removed}; the largest acceleration about it is {largest:.5g} {agreed}",)
    source = joined([f"{file.name} (K-NET)", event, removed])
    return Record(shaking, step, agreed, name=name, source=source, remarks=remarks)
