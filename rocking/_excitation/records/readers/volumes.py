"""Files with several blocks of numbers: COSMOS, CSMIP Volumes 1 and 2, GeoNet V1A and V2A, SMC, TSPAIR, SLIST.

Each channel has a header of text and numbers of fixed width, and a block of accelerations; Volume 2 also has velocities
and displacements. Sources: COSMOS Strong Motion Data Format v1.20 (COSMOS 2001); Shakal, Huang (1985), Standard tape
format for CSMIP strong-motion data tapes, OSMS 85-03; GeoNet strong-motion data file formats; SMC format of the U.S.
Geological Survey; `timeseries` service of IRIS, for TSPAIR and SLIST. Other files of this kind are refused by name.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice

import numpy as np

from rocking._base.arrays import Array
from rocking._base.units import quantities_of
from rocking._excitation.records.readers.header import units_in
from rocking._excitation.records.readers.layout import is_row
from rocking._excitation.records.readers.lines import (
    MAX_SAMPLES,
    NUMBER,
    TextFile,
    agreed_step,
    agreed_unit,
    decoded,
    to_float,
)
from rocking._excitation.records.record import Record

Lines = Iterator[tuple[int, bytes]]

FIRST_LINES = 5  # lines in which the format is named

REFUSED = {
    r"^\*? ?vol1ds": "a BHRC Volume 1 file",
    r"\Afile +\d+ of uncorrected accelerogram data of volume": "a USC Volume 1 file, with a time before each value",
    r"(?s)\A\s*uncorrected accelerogram.*\brenadic\b": "a RENADIC Volume 1 file",
    r"^\s*response\b.*\bspectr": "response spectra (Volume 3)",
    r"^raw acc\w* counts|^\s*raw data": "a file of raw counts (Volume 0)",
    r"^#?k-net csv": "a K-NET CSV file",
}
"""Names of formats that are not read, by the lines at the start."""

BLOCK = re.compile(
    r"^\s*(?P<count>\d+)\s+(?:points of\s+)?(?P<kind>accel|acc|veloc|vel|displ|disp)\w*\s*(?:points|pts|data)?", re.I
)
"""The line above a block of COSMOS and CSMIP."""

TRACE = re.compile(
    r"TIMESERIES (?P<name>\S+), (?P<count>\d+) samples, (?P<rate>\S+) sps, \S+, (?P<form>TSPAIR|SLIST)\w*"
    r"(?:, (?:INTEGER|FLOAT|DOUBLE))?(?:, *(?P<unit>[^,]*))?",
    re.I,
)
"""The line above a trace of TSPAIR and SLIST."""


@dataclass(eq=False)
class Channel:
    """One block of accelerations: name, step [s] and unit as stated, index of the line that states them."""

    name: str
    values: Array
    line: int
    step: float | None
    unit: str | None
    unit_text: str


def format_of(file: TextFile) -> str | None:
    """The name of the format; None if it is none of these; those that are not read are refused."""
    start = file.head[:FIRST_LINES]
    if any(re.match(r"(un)?corrected accelerogram \S+ +(GNS|GeoNet)", line, re.I) for line in start):
        return "GeoNet"
    if any(re.search(r"\(Format v0?\d", line) for line in start) and not re.search(r"spectr", start[0], re.I):
        return "COSMOS"
    if re.match(r"[0-9] (un)?corrected accel", file.head[0], re.I) or (
        re.match(r"[0-9] [A-Z]+", file.head[0]) and sum(line.startswith("*") for line in file.head[1:11]) > 2
    ):
        return "SMC"
    if TRACE.match(file.head[0]):
        return "TIMESERIES"
    for pattern, name in REFUSED.items():
        if re.search(pattern, "\n".join(file.head[:12]), re.I | re.M):
            raise file.error(0, name, "AT2, ESM, K-NET, COSMOS, CSMIP, GeoNet or SMC, or columns of numbers")
    if re.match(r"\s*(un)?corrected accelero", file.head[0], re.I):
        if any(BLOCK.match(line) for line in file.head):
            return "CSMIP"
        raise file.error(0, file.head[0].strip(), "a Volume 1 or 2 of COSMOS, CSMIP or GeoNet, or columns of numbers")
    return None


def read(file: TextFile, kind: str, unit: str | None, time_step: float | None, component: str | None) -> Record:
    """Read a channel; arguments and errors as for `read_record`."""
    lines = ((k, line) for first, rows in file.rows(0) for k, line in enumerate(rows, first))
    channels = [*{"GeoNet": _geonet, "SMC": _smc, "TIMESERIES": _traces}.get(kind, _blocks)(file, lines)]
    one = _chosen(file, channels, component)
    if one.unit is None and (unit is None or re.search(r"count|volt", one.unit_text, re.I)):
        raise file.error(one.line, one.unit_text or "no unit", "a unit of acceleration, such as cm/sec2")
    agreed = agreed_unit(file, one.line, one.unit, unit)
    if one.step is None and time_step is None:
        raise file.error(one.line, f"a {kind} file that states no time step", "the argument `time_step`")
    step = agreed_step(file, one.line, one.step, time_step)
    name = " ".join([file.name.rsplit(".", 1)[0], *([one.name] if len(channels) > 1 else [])])
    return Record(one.values, step, agreed, name=name, source=f"{file.name} ({kind}, {one.name or 'one channel'})")


def _chosen(file: TextFile, channels: list[Channel], component: str | None) -> Channel:
    """The channel of a name or a part of it."""
    if not channels:
        raise file.error(None, "no block of accelerations", "a file with accelerations")
    if component is None and len(channels) == 1:
        return channels[0]
    names = ", ".join(one.name for one in channels)
    if component is None:
        raise file.error(None, f"components {names}", "the argument `component`: one of them")
    plain = component.strip().lower()
    for found in (
        [one for one in channels if one.name.lower() == plain],
        [one for one in channels if plain in re.split(r"[\s:]+", one.name.lower())],
        [one for one in channels if plain in one.name.lower()],
    ):
        if len(found) == 1:
            return found[0]
    raise file.error(None, f"components {names}", f"component {component}")


def _blocks(file: TextFile, lines: Lines) -> Iterator[Channel]:
    """The blocks of accelerations of COSMOS and CSMIP."""
    name, reals, ended = "", np.zeros(0), False
    for k, raw in lines:
        line = decoded(raw)
        if ended and is_row(line):
            raise file.error(k, line, "the end of a block, as its number of values says")
        ended = False
        if found := re.match(r"(?:sta )?chan?:? +(\S+?) *: *(.*?)(?: {2,}|\(|$)", line, re.I):
            name = f"Chan {found[1]}: {found[2]}".strip()
        elif found := re.match(r"(\d+) +real-header values", line, re.I):
            reals = _numbers(file, k, lines, int(found[1]), _width(line))
        elif found := BLOCK.match(line):
            values, ended = _numbers(file, k, lines, int(found["count"]), _width(line)), True
            if not found["kind"].lower().startswith("acc"):
                continue
            text = re.search(r"units?(?: of)? *[:=]? *([^()\s,]+)|\bin +(?!units)([^()\s,]+)", line, re.I)
            stated = "" if text is None else (text[1] or text[2]).rstrip(".")
            yield Channel(name, values, k, _step(line, reals), units_in(stated), stated)


def _width(line: str) -> int | None:
    """Characters of a number, from a Fortran format such as (8f10.6)."""
    found = re.search(r"\(\d*[efgi](\d+)(?:\.\d+)?(?:e\d+)?\)", line, re.I)
    return int(found[1]) if found else None


def _step(line: str, reals: Array) -> float | None:
    """The time step [s] that the line above a block states; of COSMOS, real value 62 or 34 that fits the length."""
    if found := re.search(r"spaced at +([\d.]+) *sec", line, re.I):
        return to_float(found[1])
    if found := re.search(r"at +([\d.]+) *pts/sec", line, re.I):
        return 1.0 / to_float(found[1])
    length = re.search(r"^\s*(\d+).*approx +([\d.]+) *secs?", line, re.I)
    if length is None:
        return None
    for place, unit in ((61, 1e-3), (33, 1.0)):
        step = reals[place] * unit if reals.size > place else -1.0
        if step > 0.0 and abs(int(length[1]) * step - to_float(length[2])) <= 1.0 + 0.01 * to_float(length[2]):
            return float(step)
    return None


def _geonet(file: TextFile, lines: Lines) -> Iterator[Channel]:
    """The components of GeoNet: 16 lines of text, 10 of numbers, accelerations, velocities and displacements in mm."""
    name, text = "", ""
    for k, raw in lines:
        line = decoded(raw)
        if found := re.match(r"component +(\S.*?)(?: {2,}|$)", line, re.I):
            name = found[1].split()[0]
        elif found := re.search(r"\bintervals of ([\d.]+) *s|\bat ([\d.]+) *sec intervals", line):
            text = found[1] or found[2]
            if (unit := re.search(r"units of ([\d.]+) *mm/s/s", line)) and float(unit[1]) != 1.0:
                raise file.error(k, line, "readings in units of 1.00 mm/s/s")
        elif re.fullmatch(r"[-+\d. ]+", line) and raw:
            ints = [int(field) for _, row in [(k, raw), *islice(lines, 3)] for field in row.split()]
            reals = [field for j, row in islice(lines, 6) for field in _row(file, j, decoded(row), 8)]
            counts, step = ints[33:36], reals[25]
            if len(ints) != 40 or not text or abs(step / to_float(text) - 1.0) > 1e-3:
                raise file.error(k, f"a header with the interval {step:g} s", f"that of its text, {text or 'none'} s")
            blocks = [_numbers(file, k, lines, count, 8) for count in counts]
            yield Channel(name, blocks[0], k, step, "mm/s2", "mm/s2")


def _smc(file: TextFile, lines: Lines) -> Iterator[Channel]:
    """The one component of SMC: 11 lines of text, 48 integers, 50 reals, comments, accelerations in cm/s2."""
    title = decoded(next(lines)[1])
    if re.search(r"veloc|displ|spectr", title, re.I):
        raise file.error(0, title, "an accelerogram")
    *_, (k, _) = islice(lines, 10)
    ints = _numbers(file, k, lines, 48, None)
    reals = _numbers(file, k, lines, 50, None)
    *_, (k, _) = [(k, None), *islice(lines, int(max(0.0, ints[15])))]
    rate = reals[1]
    if not 0.0 < rate < 1e6 or ints[16] < 2:
        rates = f"{rate:g} samples a second" if 0.0 < rate < 1e6 else "uneven intervals"
        raise file.error(k, f"{ints[16]:g} values at {rates}", "uniform samples and their number")
    values = _numbers(file, k, lines, int(ints[16]), None)
    if any(row for _, row in lines):
        raise file.error(k, f"more than {ints[16]:g} values", "equal numbers")
    yield Channel(f"{ints[13]:g}", values, k, 1.0 / rate, "cm/s2", "cm/s2")


def _traces(file: TextFile, lines: Lines) -> Iterator[Channel]:
    """The traces of TSPAIR, a time and a value in each line, and of SLIST, several values."""
    names = set()
    for k, raw in lines:
        line = decoded(raw)
        found = TRACE.match(line)
        if not raw:
            continue
        if found is None or found["name"] in names:
            raise file.error(k, line, "the line TIMESERIES of another trace, each without gaps")
        names.add(found["name"])
        unit = (found["unit"] or "").strip()
        if quantities_of(unit) and not units_in(unit):
            raise file.error(k, unit, "a trace of accelerations")
        rate = file.positive(k, found["rate"], "samples in a second")
        rows = ((j, row.split(None, 1)[-1] if row else row) for j, row in lines)
        of_values = rows if found["form"].upper() == "TSPAIR" else lines
        values = _numbers(file, k, of_values, int(found["count"]), None)
        yield Channel(found["name"], values, k, 1.0 / rate, units_in(unit), unit)


def _numbers(file: TextFile, line: int, lines: Lines, count: int, width: int | None) -> Array:
    """As many numbers from the next lines, of a fixed width, or separated."""
    if count > MAX_SAMPLES:
        raise file.error(line, f"{count} values", f"at most {MAX_SAMPLES}")
    found: list[float] = []
    while len(found) < count:
        k, raw = next(lines, (line, b""))
        if not raw:
            raise file.error(k, f"{len(found)} values, and {count} stated in line {line + 1}", "equal numbers")
        found += _row(file, k, decoded(raw), width)
    if len(found) != count:
        raise file.error(line, f"{count} stated, {len(found)} values", "equal numbers")
    return np.array(found)


def _row(file: TextFile, index: int, line: str, width: int | None) -> list[float]:
    """The numbers of a line: separated by blanks or signs, or of a width, right-justified, where they may touch."""
    fields = line.split()
    if width is not None and not all(NUMBER.fullmatch(one) and "." in one for one in fields):
        padded = line.rjust(-(-len(line) // width) * width)
        fields = [padded[k : k + width].strip() for k in range(0, len(padded), width)]
        if all(map(NUMBER.fullmatch, fields)):
            return [*map(to_float, fields)]
    return file.numbers(index, line)
