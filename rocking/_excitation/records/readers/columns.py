"""Columns of numbers: CSV, or separated by blanks; with times or without, also one series wrapped over several columns.

Lines before the first row of numbers are the header (`header.py`). One function, `find_layout`, decides which rows hold
the samples, how they are separated, and which line names the columns: one whose fields agree with the rows in number
and are names of quantities. A title is none, whatever separators it holds. Times are in a column whose name says so or
whose unit is one. What is not stated, or has two readings, has to be given as an argument.
"""

from __future__ import annotations

import re
from array import array
from dataclasses import dataclass, replace
from itertools import chain

import numpy as np
from numpy.typing import NDArray

from rocking._base.errors import RecordFileError
from rocking._base.units import UNITS, unit_name
from rocking._excitation.records.readers.header import Header, read_header, units_in
from rocking._excitation.records.readers.lines import (
    MAX_SAMPLES,
    NUMBER,
    TOUCHING,
    TextFile,
    agreed_step,
    agreed_unit,
    decoded,
    to_float,
    to_floats,
)
from rocking._excitation.records.record import Record

Array = NDArray[np.float64]

STEP_TOLERANCE = 0.02
"""Largest deviation of a time from the uniform grid, in steps [-]: times are often rounded to a few digits."""

MAX_TIME = 1e12
"""Largest time in a column of times [s]; times are often counted from an epoch."""

LONGEST_STEP = 0.5
"""Longest step of a record [s] that is taken from times without a unit."""

MAX_UNIT_PARTS = 8
"""Most parts, separated by blanks, of a unit in a column name, such as m / s ^ 2."""

MAX_NAME = 60
"""Most characters of the name of a column; longer ones are sentences."""

WRAPPED = "rows"
"""The component that stands for the values of all columns, row by row."""

JUMP = 3.0
"""A leading value so many times as large as all others is no sample [-]."""

SMOOTHER = 0.8
"""Sum of the steps along the rows over that down the columns below which the rows are one series [-]: of records of 100
and 200 samples a second in 3 to 10 columns it is 0.2 to 0.6, of three components about 1.5 and more."""

_COMMENT = "#%!*/\"'"

_DECIMAL_COMMA = (";", "\t")
"""Separators of columns beside which a comma is the decimal sign."""

_UNSIGNED_PAIRS = re.compile(r"\s*+[+-]?\d++,\d++(?:[Ee][+-]?\d++)?+(?:,[+-]?\d++,\d++(?:[Ee][+-]?\d++)?+)*+\s*+")
"""A row that may be of numbers with decimal commas only."""

_COMMA_NUMBERS = re.compile(
    r"\s*+[+-]?\d++(?:,\d++)?+(?:[Ee][+-]?\d++)?+(?:[ ]++[+-]?\d++(?:,\d++)?+(?:[Ee][+-]?\d++)?+)++\s*+"
)
"""A row of several numbers, separated by blanks, whose commas are decimal signs."""

_BRACKETS = re.compile(r"(?:(?<!\s)\s++)?[(\[][^()\[\]]*+[)\]]")

KINDS = {
    "time": r"((elapsed|relative|rel|record|recording|running|sample|sampling) ?)?"
    r"(time|zeit|temps|tempo|tiempo|tid|tijd|zaman|czas|t)\b.*|timestamps?|seconds?|sekunden",
    "counter": r"(frame|frames|index|idx|samples?|data ?points?|points?|pt|row|line|zeile|record|item|step|bild|punkt|"
    r"messwert|muestra|campione|echantillon|échantillon|numero|número|no|nr|num|number|nummer|n|i|k|j|id|count|counter|zähler|lfd)"
    r"( ?(no|nr|num|number|nummer|id|index|idx|count|counter|#|№))?|(#|№|n°|nº)",
    "other": r"(vel|dis(?!t)|geschw|versch|spost|depl|spectr|fourier|psa\b|psv\b|period\b|freq|temp(erat|\b)|press|"
    r"strain|arias|cav\b).*",
}
"""Names of columns that hold no samples, in lower case, without signs and units, by what they hold."""

SAMPLES = (
    r"(ground |base |table |input |shock |measured |corrected |uncorrected |raw )?"
    r"(a|ag|üg|acc|accel|acceler\w*|accn|beschl\w*|aceler\w*|accélér\w*|ivme)( ?(time )?(history|series|values?|data))?"
    r"( ?(x|y|z|ns|ew|ud|n s|e w|u d|n|e|u|v|h\d?|\d+))?|"
    r"ns|ew|ud|n s|e w|u d|n|s|e|w|u|z|x|y|v|h\d?|[bh][hnl][enz123]|long|longitudinal|trans|transverse|vert\w*|up|"
    r"north|south|east|west|(chan|channel|ch|col|column) ?\d+|rotations?|angle|theta|θ|phi|winkel|rotación|rotazione"
)
"""Names of columns of samples, as `KINDS`: a line of them alone names columns."""

COUNTS = r"\d+"


@dataclass(frozen=True)
class Column:
    """A column: its name, the text of its unit in a row of units, and its kind by name.

    The kind is a key of `KINDS`, "samples", or "" if it is not known.
    """

    name: str
    unit_text: str = ""
    kind: str = ""

    @property
    def shown(self) -> str:
        return f"{self.name} {self.unit_text}".strip()

    def unit(self, quantity: str) -> str | None:
        """The unit of a quantity that the name or the row of units states."""
        own = units_in(self.unit_text.strip(" .[]"), quantity) if self.unit_text else None
        return own or unit_in_name(self.name, quantity)


@dataclass(frozen=True)
class Layout:
    """How a file holds its numbers.

    Attributes
    ----------
    first : int
        Index of the line of the first sample.
    separator : str or None
        Of columns; None for blanks.
    comma : bool
        Whether commas are decimal signs.
    line : int or None
        Index of the line of the names; None if the columns have none.
    columns : list of Column
        From the left.
    header : Header
        What the lines above state.
    counted : (count, step) or None
        Of a line above the samples with these two numbers, which the number of values has to confirm.
    """

    file: TextFile
    first: int
    separator: str | None
    comma: bool
    line: int | None
    columns: list[Column]
    header: Header
    counted: tuple[int, float] | None = None
    skipped: bool = False

    @property
    def width(self) -> int:
        """Number of columns."""
        return len(self.columns)

    def of_kind(self, *kinds: str) -> list[int]:
        """Indices of the columns of some kinds."""
        return [k for k, one in enumerate(self.columns) if one.kind in kinds]


def read(file: TextFile, unit: str | None, time_step: float | None, component: str | None, skip: int | None) -> Record:
    """Read columns; arguments and errors as for `read_record`."""
    layout = find_layout(file, skip)
    header = layout.header
    spectrum = any(re.match(r"(natural )?period|freq", _plain(one.name)) for one in layout.columns)
    if spectrum or any(re.search(r"response spectr|fourier", line, re.I) for line in file.head[: layout.first]):
        raise file.error(layout.line, "a spectrum", "a recorded ground acceleration against time")
    times = _time_columns(layout)
    if layout.line is None and layout.width > 1:
        times = [] if component == WRAPPED else _unnamed_times(layout)
        counted = layout.of_kind("counter")
        if not times and not counted and component in (None, WRAPPED) and _is_wrapped(layout, component):
            return _wrapped(layout, unit, time_step)
        times = [k for k in times if layout.columns[k].name != component]
    chosen, unused = _chosen(layout, times, component)
    column = layout.columns[chosen]
    _check_name(layout, column)
    stated = header.unit(unit)
    in_name = column.unit("m/s2")
    if in_name and stated.value and UNITS["m/s2"][in_name] != UNITS["m/s2"][str(stated.value)] and unit is None:
        found = f"the unit {in_name} in a column name"
        raise file.error(layout.line, found, f"{stated.value}, as the header says in line {(stated.line or 0) + 1}")
    if unit is None and in_name is None and stated.value is None:
        _check_unit_text(layout, column)
    said = in_name or stated.value
    agreed = agreed_unit(file, layout.line if in_name else stated.line, None if said is None else str(said), unit)
    before = [k for k in times if k < chosen] or times
    measured = None
    if before:
        found_times, values = _table(layout, [before[-1], chosen])
        measured = _uniform_step(layout, found_times * _time_factor(layout, layout.columns[before[-1]]))
        known = time_step or header.step(time_step).value
        if layout.columns[before[-1]].unit("s") is None:  # the step may say which one it is
            units = (
                scale for scale in (1.0, 1e-3, 1e-6) if known and abs(scale * measured / float(known) - 1.0) < 1e-3
            )
            measured *= next(units, 1.0)
            if measured > LONGEST_STEP and time_step is None:
                found = f"a time step of {measured:g}, without a unit"
                raise file.error(layout.line, found, "a unit of times, such as time [ms], or the argument `time_step`")
    else:
        (values,) = _table(layout, [chosen])
    file.check_values(values)
    if layout.width == 1 and not layout.skipped and layout.counted is None:
        _check_leading(layout, values, time_step)
    step = _agreed_step(layout, values.size, measured, time_step)
    stem = file.name.rsplit(".", 1)[0]
    name = stem if component is None else f"{stem} {column.name}"
    left = f"; not used: {', '.join(unused)}" if unused else ""
    return Record(values, step, agreed, name=name, source=f"{file.name} (columns{left})", remarks=header.remarks())


def read_samples(file: TextFile, most: int) -> tuple[int, Array | None, Array]:
    """Index of the first row, times if there are two columns, and accelerations, in any units; at most `most` rows.

    Raises
    ------
    RecordFileError
        If the file holds anything else.
    """
    expected = "one column of accelerations, or two of times and accelerations"
    layout = find_layout(file, 0, expected=expected)
    if layout.width > 2:
        raise file.error(layout.first, f"{layout.width} columns", expected)
    named = layout.of_kind("time")
    if layout.width == 1:
        if named:
            raise file.error(layout.first, "a column of times only", "a column of accelerations")
        _check_name(layout, layout.columns[0])
        return layout.first, None, _table(layout, [0], most)[0]
    times = (named or [0])[0]
    _check_name(layout, layout.columns[1 - times])
    time, values = _table(layout, [times, 1 - times], most)
    return layout.first, time, values


def read_rotations(
    file: TextFile, most: int, degrees: bool | None, time_step: float | None = None
) -> tuple[Array, Array]:
    """Times [s] and rotations [rad], at most `most` rows, in the units that the header states.

    Without units these are seconds, and degrees or radians as `degrees` says; None: radians, unless the file states
    another unit. A counter, such as the number of a frame, is no time: `time_step` [s], or a rate in the header, gives
    the times then.

    Raises
    ------
    RecordFileError
        If the file holds anything else, or rotations in another unit than `degrees` says.
    """
    layout = find_layout(file, 0, "rad", "one column of rotations, or two of times and rotations")
    times = _time_columns(layout)
    if layout.line is None and layout.width > 1:
        times = _unnamed_times(layout)
    chosen = [k for k in range(layout.width) if k not in times and layout.columns[k].kind not in ("counter", "other")]
    if not chosen and len(rest := [k for k in range(layout.width) if k not in times]) == 1:
        chosen = rest
    if len(times) > 1 or len(chosen) != 1:
        found = f"columns {', '.join(one.shown for one in layout.columns)}"
        raise file.error(layout.line, found, "one column of times and one of rotations")
    column = layout.columns[chosen[0]]
    _check_name(layout, column, "rotations")
    given = None if degrees is None else "deg" if degrees else "rad"
    in_name = _stated_unit(layout, column, "rad")
    stated = layout.header.unit(given, "a unit of rotation: rad, deg, mrad")
    if in_name and stated.value and in_name != stated.value:
        raise file.error(layout.line, f"the column {column.shown}", f"{stated.value}, as the header says")
    unit = in_name or (None if stated.value is None else str(stated.value))
    if unit is not None and given is not None and unit != given:
        raise file.error(layout.line, f"the column {column.shown}", f"rotations in {given}, as `degrees` says")
    if not times:
        if layout.width == 1 and time_step is None and not layout.header.found.get("step"):
            expected = "a column of times and one of rotations, or the argument `time_step`"
            raise file.error(layout.first, "one column", expected)
        (rotation,) = _table(layout, chosen, most)
        step = _agreed_step(layout, rotation.size, None, time_step)
        return step * np.arange(rotation.size, dtype=np.float64), rotation * UNITS["rad"][unit or given or "rad"]
    time, rotation = _table(layout, [times[0], chosen[0]], most)
    return time * _time_factor(layout, layout.columns[times[0]]), rotation * UNITS["rad"][unit or given or "rad"]


RECORDS = "the header of a known format (AT2, ESM, K-NET, COSMOS, CSMIP, GeoNet, SMC), or rows of numbers"


def find_layout(file: TextFile, skip: int | None, quantity: str = "m/s2", expected: str = RECORDS) -> Layout:
    """Decide how a file holds its numbers; `skip` rows of numbers are passed over, None: it may have to be asked for.

    Raises
    ------
    RecordFileError
        If there are no rows of numbers, or two readings.
    """
    rows = [k for k, line in enumerate(file.head) if _is_row(line)]
    if not rows:
        shown = next((line.strip() for line in file.head if line.strip()), "blank lines")
        raise file.error(None, shown, expected)
    if skip is not None and skip >= len(rows):
        raise file.error(None, f"{len(rows)} rows of numbers in the first lines", f"more than `skip` = {skip} of them")
    first, counted = rows[skip or 0], None
    following = rows[(skip or 0) + 1 :]
    sizes = [len(_split(file.head[k])) for k in (first, *following[:2])]
    if skip is None and len(sizes) == 3 and sizes[0] != sizes[1] == sizes[2]:
        counted = _counted(file.head[first])
        if counted is None or following[0] != first + 1:
            shown = file.head[first].strip()
            width = len(_split(file.head[following[0]]))
            allowed = f"rows of {width} numbers, as in line {following[0] + 1}; or the argument `skip`"
            raise file.error(first, shown, allowed)
        first = following[0]
    elif skip is None and following and (counted := _counted(file.head[first])):
        if len(_split(file.head[first])) == 2 and _count_rows(file, following[0]) == counted[0]:
            first = following[0]
        else:
            counted = None
    separator, comma = _separator(file.head[first])
    width = len(_fields(file.head[first], separator))
    line, columns = _columns(file, first, separator, width, quantity)
    if separator == "," and (line is None or "," not in file.head[line]):
        _check_commas(file, first)
    if line is None:
        _check_unnamed(file, first, width)
    header = read_header(file, file.head[:first], quantity)
    return Layout(file, first, separator, comma, line, columns, header, counted, skip is not None)


def names_below(file: TextFile, line: int) -> bool:
    """Whether a line between this one and the next row of several numbers names them."""
    first = next((k for k, text in enumerate(file.head) if k > line and _is_row(text)), None)
    if first is None:
        return False
    separator, _ = _separator(file.head[first])
    width = len(_fields(file.head[first], separator))
    return width > 1 and any(_names(text.strip(), separator, width, "m/s2") for text in file.head[line + 1 : first])


def _counted(line: str) -> tuple[int, float] | None:
    """The number of values and the time step [s] in a line of these two numbers, in either order."""
    fields = _split(line)
    if len(fields) != 2:
        return None
    for count, step in (fields, fields[::-1]):
        if re.fullmatch(COUNTS, count) and int(count) > 1 and 0.0 < to_float(step) <= LONGEST_STEP:
            return int(count), to_float(step)
    return None


def _count_rows(file: TextFile, first: int) -> int:
    """Number of lines from one on that are not blank."""
    return sum(sum(map(bool, lines)) for _, lines in file.rows(first))


def _separator(line: str) -> tuple[str | None, bool]:
    """The separator of a row of numbers, None for blanks, and whether commas are decimal signs."""
    if "," in line and _COMMA_NUMBERS.fullmatch(line):
        return None, True
    mark = next((mark for mark in (";", "\t", ",") if mark in line.strip()), None)
    return mark, mark in _DECIMAL_COMMA


def _fields(line: str, separator: str | None) -> list[str]:
    """The fields of a line; a separator at its end adds none."""
    fields = [part.strip().strip("\"'") for part in line.strip().split(separator)]
    return fields[:-1] if len(fields) > 1 and fields[-1] == "" else fields


def _split(line: str) -> list[str]:
    """The texts of the numbers of a row, with decimal points."""
    separator, comma = _separator(line)
    fields = _fields(line.replace(",", ".") if comma else line, separator)
    return fields if separator is not None else [*chain.from_iterable(map(TOUCHING.split, fields))]


def _cells(layout: Layout, line: str) -> list[str]:
    """The texts of the numbers of a row, as the first row separates them."""
    fields = _fields(line.replace(",", ".") if layout.comma else line, layout.separator)
    return fields if layout.separator is not None else [*chain.from_iterable(map(TOUCHING.split, fields))]


def _is_row(line: str) -> bool:
    """Whether all fields of a line are numbers."""
    return bool(line.strip()) and all(map(NUMBER.fullmatch, _split(line)))


def _columns(
    file: TextFile, first: int, separator: str | None, width: int, quantity: str
) -> tuple[int | None, list[Column]]:
    """Line of the names, and the columns: of the nearest line above the rows that names as many; else numbered.

    Raises
    ------
    RecordFileError
        If two lines name as many columns in different units.
    """
    found: list[tuple[int, list[Column]]] = []
    units: list[str] = []
    nearest = True
    for k in range(first - 1, -1, -1):
        whole = file.head[k].strip()
        line = whole.strip(_COMMENT).strip() if whole[:1] in "#%!*/" else whole
        parts = _row_of_units(line, separator, width, quantity)
        if parts and not units and not found:
            units = parts
            continue
        surely, direct = bool(units) and not found, nearest  # of one column, a line further above may be a title
        nearest = nearest and not re.search(r"\w", line)
        names = _names(line, separator, width, quantity, surely) or _names(whole, separator, width, quantity)
        if names and (width > 1 or direct or _known(_base(names[0]))):
            texts = units if not found and units else [""] * width
            found.append((k, [_column(name, text, quantity) for name, text in zip(names, texts, strict=True)]))
    if not found:
        return None, [Column(f"column {k + 1}", text) for k, text in enumerate(units or [""] * width)]
    place, columns = found[0]
    for other, theirs in found[1:]:
        for one, another in zip(columns, theirs, strict=True):
            stated = one.unit(quantity), another.unit(quantity)
            if None not in stated and stated[0] != stated[1]:
                allowed = f"one line of names, not also {file.head[other].strip()!r} in line {other + 1}"
                raise file.error(place, file.head[place].strip(), allowed)
    return place, columns


def _row_of_units(line: str, separator: str | None, width: int, quantity: str) -> list[str]:
    """The texts of a line of units, one of each column; empty if it is none."""
    fields = _fields(line, separator)
    fields = fields if len(fields) == width else line.split()
    known = [
        units_in(part.strip(" .[]"), quantity) is not None or any(unit_name(part.strip(" ."), one) for one in UNITS)
        for part in fields
    ]
    blank = [part in ("", "-", "[-]", "(-)") for part in fields]
    return fields if len(fields) == width > 1 and any(known) and all(map(max, known, blank)) else []


def _names(line: str, separator: str | None, width: int, quantity: str, surely: bool = False) -> list[str]:
    """The names of as many columns in a line; empty if it is none of names. `surely`: a line of units is below it."""
    joined = _BRACKETS.sub(lambda found: "".join(found[0].split()), line)  # blanks in brackets separate no columns
    for mark in (separator, ",", ";", "\t", None):
        names = _fields(joined if mark is None else line, mark)
        if mark is None and len(names) != width:
            names = re.split(r"\s{2,}", line)
        if len(names) != width or not all(map(_is_name, names)):
            continue
        columns = [_column(name, "", quantity) for name in names]
        known = [one.kind != "" for one in columns]
        words = max(len(name.split()) for name in names)
        alike = mark is not None and mark == separator and width > 1 and (any(known) or words <= 3)
        if surely or alike or (all(known) and (width > 1 or words <= 3)):
            return names
    return []


def _is_name(text: str) -> bool:
    """Whether a text can name a column: it has letters, no colon or equals sign, and no number of a title."""
    plain = re.sub(r"[(\[][^()\[\]]*[)\]]", "", text)
    return (
        0 < len(text) <= MAX_NAME
        and not NUMBER.fullmatch(text)
        and re.search(r"[^\W\d_]|[#№]", text) is not None
        and not re.search(r"[:=]", text)
        and not re.search(r"(?<![\w.])(\d*\.\d+|\d{4,})(?![\w.])|\b(peak|pga|max\w*|scaled|factor)\b", plain, re.I)
    )


def _plain(name: str) -> str:
    """A name in lower case, without brackets and signs but those of numbers."""
    without = re.sub(r"[(\[][^()\[\]]*[)\]]?", " ", name.lower())
    return " ".join(re.findall(r"[^\W_]+|[#№°º]", without.partition("/")[0] or without))


def _base(name: str) -> str:
    """A plain name without the unit behind it, if what is left is known; else the plain name."""
    words = re.split(r"[\s_]+", name.strip())
    for k in range(1, len(words)):
        if any(unit_name("".join(words[k:]), one) for one in UNITS) and _known(base := _plain(" ".join(words[:k]))):
            return base
    return _plain(name)


def _known(plain: str) -> str:
    """The kind of a plain name; "" for an unknown one."""
    if re.fullmatch(SAMPLES, plain):
        return "samples"
    return next((kind for kind, names in KINDS.items() if re.fullmatch(names, plain)), "")


def _column(name: str, unit_text: str, quantity: str) -> Column:
    """A column by its name and the text of its unit."""
    bare = Column(name, unit_text)
    plain = _plain(name)
    kind = next((kind for kind in ("time", "counter", "other") if re.fullmatch(KINDS[kind], plain)), "")
    kind = kind or _known(_base(name))
    brackets = " ".join(re.findall(r"[(\[]([^()\[\]]*)[)\]]", name + unit_text)).lower()
    if re.fullmatch(r"frames?|samples?|points?|counts? of frames", brackets):
        kind = "counter"
    elif bare.unit(quantity):  # T [g] is a component, time_g an error
        kind = kind if kind == "other" or (kind == "time" and _base(name) != "t") else "samples"
    elif kind in ("", "counter") and (unit_name(brackets, "s") or (len(name) > 1 and unit_name(name, "s"))):
        kind = "time"
    elif kind in ("", "samples") and brackets and any(unit_name(brackets, one) for one in UNITS if one != quantity):
        kind = "other"
    return Column(name, unit_text, kind)


def unit_in_name(name: str, quantity: str) -> str | None:
    """The unit of a quantity in a column name: in brackets, after a slash or an underscore, or its last words."""
    texts = re.findall(r"[(\[]([^()\[\]]*)[)\]]", name)
    if texts:
        return next((unit for text in texts if (unit := units_in(text.strip(" ."), quantity))), None)
    parts = re.split(r"_+", name.strip())[-MAX_UNIT_PARTS:]
    words = name.split()[-MAX_UNIT_PARTS:]
    texts = ["".join(parts[k:]) for k in range(1, len(parts))] + [name.partition("/")[2]]
    texts += ["".join(words[k:]) for k in range(1, len(words)) if _known(_plain(" ".join(words[:k])))]
    return next((unit for text in texts if (unit := unit_name(text.strip(" ."), quantity))), None)


def _check_commas(file: TextFile, first: int) -> None:
    """Refuse rows that may be of numbers with decimal commas."""
    if all(_UNSIGNED_PAIRS.fullmatch(row) for row in file.head[first:] if row.strip()):
        allowed = "semicolons or tabs between columns with decimal commas, or names of the columns with commas"
        raise file.error(first, file.head[first].strip(), allowed)


def _check_unnamed(file: TextFile, first: int, width: int) -> None:
    """Refuse rows whose last header line names columns in another number.

    Titles are such lines as well. It names columns if it states a unit of times other than seconds.
    """
    k = next((k for k in range(first - 1, -1, -1) if file.head[k].strip()), first)
    line = file.head[k].strip()
    if k == first or re.search(r"[:=]", line) or line.startswith(tuple("#%!*/")):
        return
    if any(unit_name(text, "s") not in (None, "s") for text in re.findall(r"[(\[]([^()\[\]]*)[)\]]", line)):
        raise file.error(k, line, f"names of {width} columns, as in line {first + 1}")


def _time_columns(layout: Layout) -> list[int]:
    """The columns of times by their names; a bare T in a later place is a component."""
    found = layout.of_kind("time")
    if len(found) == layout.width:
        raise layout.file.error(layout.first, "a column of times only", "a column of samples")
    bare = [k for k in found if layout.columns[k].name == "T" and k > 0]
    return [k for k in found if k not in bare]


def _unnamed_times(layout: Layout) -> list[int]:
    """The first of several columns without names, if its values are uniform times in s.

    Whole numbers and long steps may also be a counter, or times in another unit: the column is marked as a counter.
    """
    cells = [_cells(layout, row)[0] for row in layout.file.head[layout.first :] if row.strip()]
    if all(map(NUMBER.fullmatch, cells)) and not _rises(np.array([*map(to_float, cells)])):
        return []  # perhaps one series, whose last row is shorter
    (values,) = _table(layout, [0])
    if not _rises(values):
        return []
    step = (values[-1] - values[0]) / (values.size - 1)
    if step <= LONGEST_STEP and (values != np.round(values)).any():
        return [0]
    layout.columns[0] = replace(layout.columns[0], kind="counter")
    return []


def _is_wrapped(layout: Layout, component: str | None) -> bool:
    """Whether the rows of unnamed columns are one series.

    The header may count the values, or the rows. Else neighbours along the rows, and from the end of a row to the start
    of the next one, have to differ less than those down the columns, and alike.

    Raises
    ------
    RecordFileError
        If both readings are possible.
    """
    file, width = layout.file, layout.width
    if component == WRAPPED:
        return True
    cells = [_cells(layout, row) for row in file.head[layout.first :] if row.strip()]
    lines = [[*map(to_float, row)] for row in cells if all(map(NUMBER.fullmatch, row))]
    counts = [one.value for one in layout.header.found.get("count", [])] + [layout.counted[0] if layout.counted else 0]
    rows = _count_rows(file, layout.first)
    if any((rows - 1) * width < (count or 0) <= rows * width for count in counts) and rows not in counts:  # type: ignore[operator]
        return True
    whole = np.array([row for row in lines if len(row) == width])
    if len(whole) > 2 and rows not in counts:
        series = whole.ravel()
        along, down = np.abs(np.diff(series)), np.abs(np.diff(whole, axis=0)).mean()
        places = [along[k::width].mean() for k in range(width)]
        if along.mean() < SMOOTHER * down and max(places) < 3.0 * min(places):
            return True
    names = ", ".join(one.name for one in layout.columns)
    expected = f"the argument `component`: one of them, or {WRAPPED} for one series along the rows"
    raise file.error(layout.line, f"{width} columns without names, {names}", expected)


def _wrapped(layout: Layout, unit: str | None, time_step: float | None) -> Record:
    """One series, several values a line."""
    file, header = layout.file, layout.header
    said = header.unit(unit)
    agreed = agreed_unit(file, said.line, None if said.value is None else str(said.value), unit)
    if layout.separator is None and not layout.comma:
        values = file.values(layout.first)
    else:
        lines = chain.from_iterable(lines for _, lines in file.rows(layout.first))
        texts = chain.from_iterable(_cells(layout, decoded(line)) for line in lines if line)
        values = np.array([file.number(layout.first, text, "a number") for text in texts])
        file.check_values(values)
    rows = _count_rows(file, layout.first)
    if not (rows - 1) * layout.width < values.size <= rows * layout.width:
        raise file.error(layout.first, f"{values.size} values in {rows} lines", f"{layout.width} values in each line")
    step = _agreed_step(layout, values.size, None, time_step)
    remarks = list(header.remarks())
    for one in header.found.get("count", []):
        remarks += file.checked_count(values, int(one.value or 0), one.line)
    source = f"{file.name} (columns, one series along the rows)"
    return Record(values, step, agreed, name=file.name.rsplit(".", 1)[0], source=source, remarks=remarks)


def _rises(values: Array) -> bool:
    """Whether there are several values, each above the one before."""
    return values.size > 1 and bool((np.diff(values) > 0.0).all())


def _chosen(layout: Layout, times: list[int], component: str | None) -> tuple[int, list[str]]:
    """The column of the component, by its name or a part of it, and the names of those that are not used."""
    columns, file = layout.columns, layout.file
    others = [k for k in range(layout.width) if k not in times]
    if component is None:
        samples = [k for k in others if columns[k].kind not in ("counter", "other")]
        if len(samples) != 1:
            listed = samples or others
            if not listed:
                raise file.error(layout.first, "a column of times only", "a column of accelerations")
            if len(listed) == 1:
                return listed[0], []
            names = ", ".join(columns[k].shown for k in listed)
            raise file.error(layout.line, f"components {names}", "the argument `component`: one of them")
        return samples[0], [columns[k].shown for k in others if k != samples[0]]
    plain = _plain(component)
    for key in (
        lambda name: [name.lower()] if component.strip().lower() == name.lower() else [],
        lambda name: [_base(name), _plain(name)],
        lambda name: _plain(name).split()[:1],
        lambda name: _plain(name).split(),
    ):
        found = [k for k in others if any(_plain(part) == plain for part in key(columns[k].name))]
        if len(found) == 1:
            return found[0], []
    numbered = re.fullmatch(r"column (\d+)", plain)  # whatever a line above says
    if numbered and int(numbered[1]) - 1 in others:
        return int(numbered[1]) - 1, []
    names = ", ".join(columns[k].shown for k in others)
    raise file.error(layout.line, f"components {names}", f"component {component}")


def _check_name(layout: Layout, column: Column, kind: str = "accelerations") -> None:
    """Refuse a column of other quantities, by its name or unit."""
    if column.kind in ("other", "counter"):
        raise layout.file.error(layout.line, f"the column {column.shown}", f"a column of {kind}")


def _check_unit_text(layout: Layout, column: Column) -> None:
    """Refuse a column whose name has something else than a unit of acceleration in brackets."""
    texts = re.findall(r"[(\[]([^()\[\]]*)[)\]]", column.shown)
    if any(not re.fullmatch(r"[a-z]{1,3}\d?|\d+", text, re.I) for text in texts):  # components, such as (NS)
        raise layout.file.error(
            layout.line, f"the column {column.shown}", "a unit of acceleration, such as cm/s2; or the argument `unit`"
        )


def _agreed_step(layout: Layout, count: int, measured: float | None, given: float | None) -> float:
    """The time step [s] that the column of times, the header, a line of count and step, and the argument agree in."""
    file, counted = layout.file, layout.counted
    if counted is not None:
        if counted[0] != count:
            shown = file.head[layout.first - 1].strip()
            allowed = f"the number of values, {count}, and a time step; or the argument `skip`"
            raise file.error(layout.first - 1, shown, allowed)
        measured = measured or counted[1]
    said = layout.header.step(given)
    stated = None if said.value is None else float(said.value)
    if measured is None:
        if stated is None and given is None and (counters := layout.of_kind("counter")):
            shown = f"the column {layout.columns[counters[0]].shown}, a counter or times in no known unit"
            raise file.error(layout.line, shown, "times, a step or rate in the header, or the argument `time_step`")
        return agreed_step(file, said.line, stated, given)
    if stated is not None and given is None and abs(measured / stated - 1.0) > 1e-3:
        raise file.error(said.line, f"a time step of {stated:g} s", f"{measured:g} s, as the column of times says")
    return agreed_step(file, layout.first, measured, given)


def _check_leading(layout: Layout, values: Array, time_step: float | None) -> None:
    """Refuse one column whose first numbers are a count, a step or a factor, by their size and their form.

    Raises
    ------
    RecordFileError
        With the argument `skip`, which says how many of them are no samples, 0 included.
    """
    texts = [row.strip() for row in layout.file.head[layout.first :] if row.strip()]
    forms, digits = zip(*map(_form, texts), strict=True)
    uniform = len(texts) > 6 and len({*forms[3:]}) == 1
    exact = len(texts) > 12 and sum(count > 4 for count in digits[3:]) > 0.8 * (len(texts) - 3)
    said = layout.header.found.get("step", [])
    steps = [one.value for one in said] + [time_step]
    lead = 0
    for k in range(min(3, values.size - 2)):
        value, others = abs(values[k]), np.abs(values[k + 1 :]).max()
        counted = value > 3.0 and values.size - 3 <= value <= values.size
        known = value == round(value) or value <= LONGEST_STEP or any(abs(value / g - 1.0) < 1e-3 for g in _FACTORS)
        written = (uniform and forms[k] != forms[-1]) or (exact and digits[k] <= 2)
        if value > 0.0 and (counted or value > JUMP * others or value in steps or (written and known)):
            lead = k + 1
    if lead:
        shown = ", ".join(texts[:lead])
        allowed = f"samples only; or the argument `skip`: {lead} if these are a count, a step or a factor, 0 if samples"
        raise layout.file.error(layout.first, f"{shown} before {texts[lead]}", allowed)


_FACTORS = (9.80665, 980.665, 386.089, 32.174, 9.81, 981.0)


def _form(text: str) -> tuple[tuple[int, bool], int]:
    """The number of decimals of a number, whether it has an exponent, and its number of significant digits."""
    mantissa, *exponent = re.split(r"[EeDd]", text.rstrip(",;"))
    decimals = mantissa.replace(",", ".").partition(".")[2]
    return (len(decimals), bool(exponent)), len(re.sub(r"\D", "", mantissa).lstrip("0"))


def _table(layout: Layout, columns: list[int], most: int = MAX_SAMPLES) -> list[Array]:
    """Some columns of all rows; each row has the columns of the first."""
    file, width = layout.file, layout.width
    mark = None if layout.separator is None else layout.separator.encode()
    found = [array("d") for _ in columns]
    for k, raw in file.rows(layout.first):
        lines = [line.replace(b",", b".") for line in raw] if layout.comma else raw
        # blank lines between rows of several columns are left out: the times show whether a row is missing
        rows = [line.split(mark) for line in lines if line or width == 1]
        try:
            if any(len(row) != width for row in rows):
                raise ValueError("not only whole rows")
            numbers = to_floats([*chain.from_iterable(rows)])
        except ValueError:
            numbers = []
            for j, line in enumerate(lines, k):
                if line or width == 1:
                    numbers += _row(layout, j, decoded(line))
        for values, column in zip(found, columns, strict=True):
            values.extend(numbers[column::width])
        if len(found[0]) > most:
            raise file.error(k, f"more than {most} rows", f"at most {most}")
    return [np.frombuffer(values) for values in found]


def _row(layout: Layout, index: int, line: str) -> list[float]:
    """The numbers of a line."""
    file = layout.file
    if line.startswith(("#", "%", "!")):  # it may stand for rows that are missing
        raise file.error(index, f"the comment {line}", "comments only above the first row")
    fields = _fields(line, layout.separator)
    if len(fields) != layout.width:
        raise file.error(index, f"{len(fields)} columns", f"{layout.width}, as in line {layout.first + 1}")
    wrong = next((part for part in fields if not NUMBER.fullmatch(part)), None)
    if wrong is not None:
        skip = "; or the argument `skip`: so many rows of numbers above are no samples"
        more = skip if index < layout.first + 4 and not layout.skipped else ""
        raise file.error(index, wrong or "an empty field", f"a number{more}")
    return [*map(to_float, fields)]


def _time_factor(layout: Layout, column: Column) -> float:
    """Seconds in the unit of the column of times, seconds if nothing states one."""
    unit = _stated_unit(layout, column, "s")
    tail = re.fullmatch(r"(?:time|t|zeit|temps|tempo|tiempo) (\w+)", _plain(column.name))
    if unit is None and tail and tail[1] not in ("elapsed", "axis", "stamp", "vector", "relative"):  # such as time h
        raise _no_unit(layout, column, "s")
    return UNITS["s"][unit or "s"]


def _stated_unit(layout: Layout, column: Column, quantity: str) -> str | None:
    """The unit of times or rotations of a column; None if there is none.

    Raises
    ------
    RecordFileError
        If anything else is in brackets or after a slash.
    """
    unit = column.unit(quantity)
    if unit is None and re.search(r"[(\[/]", column.shown):
        raise _no_unit(layout, column, quantity)
    return unit


def _no_unit(layout: Layout, column: Column, quantity: str) -> RecordFileError:
    expected = f"one of the units {', '.join(UNITS[quantity])}"
    return layout.file.error(layout.line, f"the column {column.shown}", expected)


def _uniform_step(layout: Layout, times: Array) -> float:
    """The step of times that are uniform; the error names the first line that is not."""
    file, first = layout.file, layout.first
    if times.size < 2:
        raise file.error(first, "one row", "at least 2")
    if not np.abs(times).max() <= MAX_TIME:
        raise file.error(None, f"a time of {np.abs(times).max():g} s", f"times up to {MAX_TIME:g} s")
    step = float((times[-1] - times[0]) / (times.size - 1))
    middle = float(np.median(np.diff(times), overwrite_input=True))
    if not (middle > 0.0 and np.isfinite(middle)):
        raise file.error(first + 1, f"times {times[0]:g} and {times[1]:g}", "times that increase")
    off = times[0] + step * np.arange(times.size) - times
    if step > 0.0 and max(off.max(), -off.min()) <= STEP_TOLERANCE * step:
        return float(f"{step:.12g}")  # removes the rounding of the difference
    wrong = int(np.abs(np.diff(times) / middle - 1.0).argmax())
    more = "; or the argument `skip`" if wrong == 0 and not layout.skipped else ""
    found = f"a step of {times[wrong + 1] - times[wrong]:g} s"
    raise file.error(first + wrong + 1, found, f"uniform steps of {middle:g} s{more}")
