"""COSMOS 1.20, CSMIP Volumes 1 and 2, GeoNet V1A and V2A: channels with a header of fixed width and blocks of numbers.

Volume 2 also has velocities and displacements, which are passed over. Sources: COSMOS Strong Motion Data Format v1.20
(COSMOS 2001); Shakal, Huang (1985), Standard tape format for CSMIP strong-motion data tapes, OSMS 85-03; GeoNet
strong-motion data file formats.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from rocking._base.arrays import Array
from rocking._base.units import unit_name
from rocking._excitation.records.readers.layout import Layout, Samples
from rocking._excitation.records.readers.text_file import TextFile, fortran_widths, is_number, numbers

KINDS = ("accel", "veloc", "displ")

Lines = Iterator[tuple[int, str]]


@dataclass(eq=False)
class Channel:
    """One block of accelerations: name, number as a text, step [s] and unit as stated, the line that states them."""

    name: str
    number: str
    values: Array
    line: int
    step: float | None
    unit_text: str


def is_cosmos(file: TextFile) -> bool:
    """Return True if the first line states the format, such as `(Format v01.20 with 13 text lines)`."""
    return "(format v" in file.head[0].lower()


def is_csmip(file: TextFile) -> bool:
    """Return True if the first line starts with the name of Volume 1 or 2."""
    return file.head[0].lower().split()[:2] in (["corrected", "accelerogram"], ["uncorrected", "accelerogram"])


def is_geonet(file: TextFile) -> bool:
    """Return True if the first line is that of an accelerogram of GNS Science."""
    words = file.head[0].lower().split()
    return words[1:2] == ["accelerogram"] and not {"gns", "geonet"}.isdisjoint(words)


def read_cosmos(file: TextFile, layout: Layout) -> Samples:
    """Read a channel of a COSMOS file."""
    title = file.head[0].lower()
    if title.startswith("raw"):
        raise file.error(0, "raw counts (Volume 0)", "accelerations")
    file.check_words(0, title)
    return _read(file, layout, "COSMOS", _blocks)


def read_csmip(file: TextFile, layout: Layout) -> Samples:
    """Read a channel of a CSMIP file."""
    return _read(file, layout, "CSMIP", _blocks)


def read_geonet(file: TextFile, layout: Layout) -> Samples:
    """Read a component of a GeoNet file."""
    return _read(file, layout, "GeoNet", _geonet)


def channel_names(file: TextFile) -> list[str]:
    """Names of the channels of a COSMOS or CSMIP file, which `acceleration` may have."""
    return [channel.name for channel in _blocks(file, file.lines(0))]


def component_names(file: TextFile) -> list[str]:
    """Names of the components of a GeoNet file, which `acceleration` may have."""
    return [channel.name for channel in _geonet(file, file.lines(0))]


def _read(
    file: TextFile, layout: Layout, kind: str, channels_of: Callable[[TextFile, Lines], Iterator[Channel]]
) -> Samples:
    layout.refuse_columns(file, kind, channels=True)
    channels = [*channels_of(file, file.lines(0))]
    channel = _chosen(file, layout, channels, kind)
    unit = unit_name(channel.unit_text, "m/s2")
    if "count" in channel.unit_text.lower():
        raise file.error(channel.line, channel.unit_text, "accelerations; counts are not converted")
    remarks: list[str] = []
    agreed = layout.agreed_unit(unit or channel.unit_text or None, remarks)
    if unit is None and layout.unit is None:
        raise file.error(channel.line, channel.unit_text or "no unit", "a unit of acceleration; or `unit`")
    step = layout.agreed_step(channel.step, remarks)
    if step is None:
        raise file.error(channel.line, f"a {kind} file that states no time step", "the argument `time_step`")
    stem = file.name.rsplit(".", 1)[0]
    name = f"{stem} {channel.name}" if len(channels) > 1 else stem
    source = f"{file.name} ({kind}, {channel.name or 'one channel'})"
    return Samples(channel.values, step, str(agreed), name, source, remarks)


def _chosen(file: TextFile, layout: Layout, channels: list[Channel], kind: str) -> Channel:
    """Return the channel of a number, a name such as `Chan 1: 90 Deg`, or its part behind the colon."""
    if not channels:
        raise file.error(0, "no block of accelerations", f"a Volume 1 or 2 of {kind}; others are not read")
    if layout.acceleration is None:
        if len(channels) == 1:
            return channels[0]
        names = ", ".join(channel.name for channel in channels)
        raise file.error(None, f"channels {names}", "the argument `acceleration`: one of them")
    name_or_number = str(layout.acceleration).strip().casefold()
    matching = []
    for channel in channels:
        name = channel.name.casefold()
        if name_or_number in (channel.number, name, name.partition(": ")[2]):
            matching.append(channel)
    if len(matching) != 1:
        names = ", ".join(channel.name for channel in channels)
        raise file.error(None, f"channels {names}", f"one of them, not {layout.acceleration}, for `acceleration`")
    return matching[0]


def _blocks(file: TextFile, lines: Lines) -> Iterator[Channel]:
    """Yield the blocks of accelerations of COSMOS and CSMIP."""
    name = ""
    number = ""
    reals = np.zeros(0)
    ended = False
    for k, line in lines:
        words = line.replace("(", " ").replace(")", " ").replace(",", " ").replace("=", " ").lower().split()
        if ended and words and all(map(is_number, words)):
            raise file.error(k, line.strip(), "the end of a block, as its number of values says")
        ended = False
        channel = [word.rstrip(":") for word in words[:2] if word.rstrip(":") in ("chan", "cha")]
        if channel and ":" in line:
            after = line[line.lower().index(channel[0]) + len(channel[0]) :].lstrip(": ")
            number, _, text = after.partition(":")
            number = number.strip()
            name = f"Chan {number}: {text.partition('(')[0].strip().partition('  ')[0]}"
        elif words[1:3] == ["real-header", "values"]:
            reals = _block(file, k, lines, words[0], line)
        elif kind := _kind(words):
            values = _block(file, k, lines, words[0], line)
            ended = True
            if kind == "accel":
                unit = _after(words, "units", "in").strip(".:")
                yield Channel(name, number, values, k, _step(words, reals), unit)


def _kind(words: list[str]) -> str | None:
    """Return the quantity of the block below a line such as `40 acceleration pts` or `40 points of accel data`."""
    if not words or not words[0].isdecimal():
        return None
    named = words[3:4] if words[1:3] == ["points", "of"] else words[1:2]
    return next((kind for kind in KINDS if named and named[0].startswith(kind[:5])), None)


def _after(words: list[str], *keys: str) -> str:
    """Return the word behind the first of the keys that is there, but for small words between."""
    plain = [word.rstrip(":") for word in words]
    for key in keys:
        if key in plain:
            following = [word for word in words[plain.index(key) + 1 :] if word not in ("of", "units", "in")]
            return following[0] if following else ""
    return ""


def _step(words: list[str], reals: Array) -> float | None:
    """Return the time step [s] stated above a block; of COSMOS, real value 62 or 34 that fits the length."""
    if "at" in words:
        text, unit = words[words.index("at") + 1 :][:2]
        (value,) = numbers([text])
        step = 1.0 / value if unit.startswith("pts/") else value
        if not 0.0 < step < np.inf:
            raise ValueError(f"a time step of {text} {unit}")
        return step
    if "approx" not in words:
        return None
    count, seconds = numbers([words[0], words[words.index("approx") + 1]])
    for index, factor in ((61, 1e-3), (33, 1.0)):
        step = reals[index] * factor if reals.size > index else -1.0
        if step > 0.0 and abs(count * step - seconds) <= 1.0 + 0.01 * seconds:
            return float(step)
    return None


def _block(file: TextFile, line: int, lines: Lines, count: str, format_line: str) -> Array:
    """Read the numbers below a line that states how many they are, and perhaps a Fortran format."""
    width = None
    for part in format_line.split("(")[1:]:
        widths = fortran_widths(part.partition(")")[0])
        if widths is not None:
            width = widths[1]
            break
    return _numbers(file, line, lines, file.size(line, count, "the number of values"), width)


def _numbers(file: TextFile, line: int, lines: Lines, count: int, width: int | None) -> Array:
    """Read as many numbers from the next lines."""
    values: list[float] = []
    while len(values) < count:
        k, text = next(lines, (line, ""))
        if not text.strip():
            raise file.error(k, f"{len(values)} values, and {count} stated in line {line + 1}", "equal numbers")
        values += _row(file, k, text, width)
    if len(values) != count:
        raise file.error(line, f"{count} stated, {len(values)} values", "equal numbers")
    return file.checked(np.array(values)) if count > 1 else np.array(values)


def _row(file: TextFile, index: int, line: str, width: int | None) -> list[float]:
    """Read the numbers of a line: separated by blanks, or of a width, right-justified, where they may touch."""
    cells = line.split()
    if width is not None and not all("." in cell and is_number(cell) for cell in cells):
        cells = [line[k : k + width].strip() for k in range(0, len(line.rstrip()), width)]
    return file.line_of_numbers(index, cells)


def _geonet(file: TextFile, lines: Lines) -> Iterator[Channel]:
    """Yield the components of GeoNet: 16 lines of text, 4 of integers, 6 of reals, then three blocks in mm and s."""
    position = 0
    for k, first in lines:
        if not first.strip():
            continue
        text = [first, *(next(lines)[1] for _ in range(15))]
        integers, reals = [], []
        for _ in range(4):
            integers += _row(file, *next(lines), 8)
        for _ in range(6):
            reals += _row(file, *next(lines), 8)
        numbers_in_text = [word for word in text[10].split() if is_number(word)]
        if "units of" in text[10] and float(numbers_in_text[0]) != 1.0:
            raise file.error(k + 10, text[10].strip(), "readings in units of 1.00 mm/s/s")
        step = reals[25]
        if not numbers_in_text or not 0.0 < step < np.inf or abs(step / float(numbers_in_text[-1]) - 1.0) > 1e-3:
            raise file.error(k + 10, text[10].strip(), f"an interval of {step:g} s, as the numbers of the header say")
        counts = [int(value) for value in integers[33:36]]
        if counts != integers[33:36] or counts[0] < 2 or max(counts) > len(file.content):
            raise file.error(k + 19, f"{integers[33]:g} accelerations", "their number in a file of this size")
        blocks = [_numbers(file, k + 19, lines, count, 8) for count in counts]
        position += 1
        component = text[12].split()
        if component[:1] != ["Component"] or len(component) < 2:
            raise file.error(k + 12, text[12].strip(), "the line of the component")
        yield Channel(component[1], str(position), blocks[0], k + 10, step, "mm/s2")
