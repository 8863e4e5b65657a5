"""PEER AT2 files: four header lines, then values in g, five on a line.

The fourth line has one of the forms `NPTS=  4000, DT= .01000 SEC`, `NPTS=  4000, DT= .01000`, `NPTS 4000 DT 0.01`,
`DT= .01 SEC, NPTS= 4000` or, in older files, `4000 0.0100 NPTS, DT`; the comma may be missing. Some files have more or
fewer lines of text before it.
"""

import re

from rocking._base.units import UNITS, unit_name
from rocking._excitation.records.readers.header import OTHER_SERIES, Statement, read_header
from rocking._excitation.records.readers.layout import names_below
from rocking._excitation.records.readers.lines import NUMBER, TextFile, agreed_step, agreed_unit, parse_unit
from rocking._excitation.records.record import Record

HEADER_LINES = 12  # largest number of lines before the line with NPTS and DT

_NAMED = r"\s*+[=:]?\s*+([^\s,;=]+)"


def header_line(file: TextFile) -> int | None:
    """Index of the line with NPTS and DT, None if the file is no AT2 file."""
    for k, line in enumerate(file.head[:HEADER_LINES]):
        if all(re.search(pattern, line, re.I) for pattern in (r"\bNPTS\b", r"\bDT\b", r"\d")):
            return k
    return None


def is_at2(file: TextFile) -> bool:
    """Whether it is an AT2 file: it has a line with NPTS and DT, and below it no names of columns."""
    place = header_line(file)
    return place is not None and not names_below(file, place)


def read(file: TextFile, unit: str | None, time_step: float | None) -> Record:
    """Read an AT2 file; arguments and errors as for `read_record`."""
    place = header_line(file) or 0  # there is one in what `is_at2` accepts
    count_text, step_text, unit_text = _count_and_step(file, place)
    stated_count = file.count(place, count_text, "the number of points NPTS")
    stated_step = file.positive(place, step_text, "the time step DT [s]") * UNITS["s"][unit_name(unit_text, "s") or "s"]
    for k, line in enumerate(file.head[:place]):
        if OTHER_SERIES.search(line):
            raise file.error(k, line.strip(), "an acceleration time history")
    title = file.head[1].strip() if place > 1 else ""
    header = read_header(file, file.head[:place])
    for k, line in enumerate(file.head[:place]):
        last = re.search(r"[(\[]([^()\[\]]+)[)\]]$", line.rstrip())
        if not header.found.get("unit") and last and parse_unit(last[1]):
            header.found["unit"] = [Statement(k, last[1], parse_unit(last[1]))]
    said = header.unit(unit, "a unit of acceleration, such as G")
    agreed = agreed_unit(file, place, None if said.value is None else str(said.value), unit)
    step = agreed_step(file, place, stated_step, time_step)
    values = file.values(place + 1)
    remarks = file.checked_count(values, stated_count, place) + header.remarks()
    return Record(values, step, agreed, title or file.name, f"{file.name} (PEER AT2)", remarks)


def _count_and_step(file: TextFile, place: int) -> tuple[str, str, str]:
    """The texts of NPTS and DT on the header line, and the word behind DT, which may be its unit."""
    line = file.head[place]
    leading = re.split(r"[\s,]+", line.strip(), maxsplit=2)
    if len(leading) > 2 and all(map(NUMBER.fullmatch, leading[:2])) and re.match(r"NPTS\b", leading[2], re.I):
        return leading[0], leading[1], "s"  # values before their names, in the order of these
    count, step = re.search(r"\bNPTS\b" + _NAMED, line, re.I), re.search(r"\bDT\b" + _NAMED + r"\s*(\w*)", line, re.I)
    if count is None or step is None:
        raise file.error(place, line.strip(), "a form such as NPTS=  4000, DT= .01000 SEC")
    return count[1], re.sub(r"(?i)s(ec)?\.?$", "", step[1]), step[2]
