"""K-NET and KiK-net ASCII: 17 header lines, then counts, eight on a line, with a scale such as 2000(gal)/8388608.

The counts include the offset of the instrument, in real files 1.3 to 665 times the largest acceleration about it: their
mean is removed, as in the `Max. Acc.` of the header, and the record says so.
"""

import numpy as np

from rocking._base.units import unit_name
from rocking._excitation.records.processing import OFFSET_SHARE
from rocking._excitation.records.readers.layout import Layout, Samples
from rocking._excitation.records.readers.text_file import TextFile

HEADER_LINES = 17
KEYS = {
    "Origin Time": 0,
    "Station Code": 5,
    "Sampling Freq(Hz)": 10,
    "Duration Time": 11,
    "Dir.": 12,
    "Scale Factor": 13,
}
"""The keys that are read, by the index of their line."""


def is_knet(file: TextFile) -> bool:
    """Return True if the first and the fourteenth line have the keys of the format."""
    if len(file.head) <= HEADER_LINES:
        return False
    return all(file.head[KEYS[key]].startswith(key) for key in ("Origin Time", "Scale Factor"))


def read(file: TextFile, layout: Layout) -> Samples:
    """Read a K-NET file."""
    layout.refuse_columns(file, "K-NET")
    texts: dict[str, str] = {}
    for key, line in KEYS.items():
        if len(file.head) <= HEADER_LINES or not file.head[line].startswith(key):
            raise file.error(line, "another line", f"the header line {key} of K-NET")
        texts[key] = file.head[line].removeprefix(key).strip()
    duration_line, scale_line = KEYS["Duration Time"], KEYS["Scale Factor"]
    rate = file.number(
        KEYS["Sampling Freq(Hz)"], texts["Sampling Freq(Hz)"].removesuffix("Hz"), "the sampling frequency [Hz]"
    )
    duration = file.number(duration_line, texts["Duration Time"].removeprefix("(s)"), "the duration [s]")
    amplitude_text, _, unit_and_counts = texts["Scale Factor"].partition("(")
    unit_text, _, counts_text = unit_and_counts.partition(")")
    scale = "a scale such as 2000(gal)/8388608"
    amplitude = file.number(scale_line, amplitude_text, scale)
    counts = file.number(scale_line, counts_text.strip().removeprefix("/"), scale)
    remarks: list[str] = []
    unit = layout.agreed_unit(unit_name(unit_text, "m/s2"), remarks)
    if unit is None:
        raise file.error(scale_line, unit_text, "a unit of acceleration, such as gal; or `unit`")
    step = layout.agreed_step(1.0 / rate, remarks) or 1.0 / rate
    values = file.values(HEADER_LINES)
    file.line = scale_line
    with np.errstate(over="ignore", invalid="ignore"):
        accelerations = file.checked(values * (amplitude / counts))
    file.line = duration_line
    remarks += file.count_remarks(values, round(duration * rate), duration_line)
    offset = float(accelerations.mean())
    shaking = accelerations - offset
    largest = float(np.abs(shaking).max())
    removed = f"the offset of the counts, their mean of {offset:.5g} {unit}, is removed"
    if abs(offset) > OFFSET_SHARE * largest:
        remarks.append(f"{removed}; the largest acceleration about it is {largest:.5g} {unit}")
    name = " ".join(filter(None, [texts["Station Code"], texts["Dir."]])) or file.name
    source = "; ".join(filter(None, [f"{file.name} (K-NET)", texts["Origin Time"], removed]))
    return Samples(shaking, step, unit, name, source, remarks)
