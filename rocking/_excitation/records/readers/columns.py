"""Columns of numbers: CSV, or separated by blanks; with times or without, also one series wrapped over several columns.

`layout.py` decides which rows hold the samples and what names the columns, `header.py` what the lines above state.
Times are in a column whose name says so or whose unit is one. What is not stated, or has two readings, has to be given
as an argument.
"""

import re
from array import array
from dataclasses import replace
from itertools import chain, islice

import numpy as np

from rocking._base.arrays import Array
from rocking._base.errors import RecordFileError
from rocking._base.units import UNITS
from rocking._excitation.records.readers.header import LONGEST_STEP, OTHER_SERIES
from rocking._excitation.records.readers.layout import (
    MAX_NAMES,
    Column,
    Layout,
    base_name,
    cells_of,
    count_rows,
    fields_of,
    find_layout,
    plain_name,
)
from rocking._excitation.records.readers.lines import (
    HEAD_LINES,
    MAX_LINE,
    MAX_SAMPLES,
    NUMBER,
    TextFile,
    agreed_step,
    agreed_unit,
    decoded,
    to_float,
    to_floats,
)
from rocking._excitation.records.record import Record

STEP_TOLERANCE = 0.02
"""Largest deviation of a time from the uniform grid, in steps [-]: times are often rounded to a few digits."""

LARGEST_ROUNDING = 0.3  # largest last place of times, in steps [-]: a missing row is off by more

MAX_TIME = 1e12  # largest time in a column of times [s]; times are often counted from an epoch
WRAPPED = "rows"  # the component that stands for the values of all columns, row by row
JUMP = 3.0  # a leading value this many times larger than all others is no sample [-]

SMOOTHER = 0.6
"""Sum of the steps along the rows over that down the columns below which the rows are one series [-]: of records of 100
and 200 samples a second in 3 to 10 columns it is 0.2 to 0.6, of three components of noise 0.66 and more."""

SMOOTHER_OF_FEW = 0.5  # the same for two or three columns, which usually are components


def read(file: TextFile, unit: str | None, time_step: float | None, component: str | None, skip: int | None) -> Record:
    """Read columns; arguments and errors as for `read_record`."""
    layout = find_layout(file, skip)
    header = layout.header
    names, above = [plain_name(one.name) for one in layout.columns], " ".join(file.head[: layout.first])
    spectrum = any(re.match(r"(natural )?period|freq", name) for name in names)
    if any(re.fullmatch(r"t ?[1n]?", name) for name in names):  # a time or a period
        spectrum |= any(re.search(r"\bp?s[adev]\b|respon", name) for name in names) or "spectr" in above.lower()
    if spectrum or re.search(r"response spectr|fourier", above, re.I):
        raise file.error(layout.line, "a spectrum", "a recorded ground acceleration against time")
    for k, line in enumerate(file.head[: layout.first]):
        if layout.width == 1 and OTHER_SERIES.search(line):
            raise file.error(k, line.strip(), "accelerations")
        if re.fullmatch(r"\s*\d\S*e[+-]?\d+ *\*\s*", line, re.I):
            raise file.error(k, f"a factor of all numbers below, {line.strip()}", "numbers in full")
    _check_thousands(layout)
    times = _time_columns(layout)
    if layout.line is None and layout.width > 1:
        times = [] if component == WRAPPED else _unnamed_times(layout)
        counted = layout.of_kind("counter")
        if not times and not counted and component in (None, WRAPPED) and _is_wrapped(layout, component):
            return _wrapped(layout, unit, time_step)
        times = [k for k in times if layout.columns[k].name != component]
    elif component == "T":  # transverse, if it does not rise
        times = [k for k in times if layout.columns[k].name != "T" or _rises(_table(layout, [k])[0])]
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
    try:
        in_seconds = _time_factor(layout, layout.columns[before[-1]]) if before else 1.0
    except RecordFileError as error:
        if time_step is None:
            raise file.error(layout.line, error.value, f"{error.expected}; or the argument `time_step`") from None
        before = []
    if before:
        found_times, values = _table(layout, [before[-1], chosen])
        known = time_step or header.step(time_step).value
        place = _last_place(layout, before[-1]) * in_seconds
        measured = _uniform_step(layout, found_times * in_seconds, place, known)
        if layout.columns[before[-1]].unit("s") is None:  # the step may say which one it is
            units = (
                scale for scale in (1.0, 1e-3, 1e-6) if known and abs(scale * measured / float(known) - 1.0) < 1e-3
            )
            measured *= next(units, 1.0)
            if measured > LONGEST_STEP and time_step is None:
                raise _no_unit_of_times(layout, measured)
    else:
        (values,) = _table(layout, [chosen])
        if layout.width > 1 and _is_uniform(values):
            raise file.error(layout.line, f"{column.shown}, which rises uniformly", "a column of accelerations")
    file.check_values(values)
    remarks = (*header.remarks(), *_check_count(layout, values))
    if not before and not layout.skipped and layout.counted is None:
        _check_leading(layout, values, time_step, slice(chosen, chosen + 1))
    step = _agreed_step(layout, values.size, measured, time_step)
    stem = file.name.rsplit(".", 1)[0]
    name = stem if component is None else f"{stem} {column.name}"
    left = f"; not used: {', '.join(unused)}" if unused else ""
    return Record(values, step, agreed, name=name, source=f"{file.name} (columns{left})", remarks=remarks)


def read_samples(file: TextFile, most: int) -> tuple[int, Array | None, Array]:
    """Index of the first row, times if there are two columns, and accelerations, in any units; at most `most` rows."""
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

    Raises `RecordFileError` if the file holds anything else, or rotations in another unit than `degrees` says.
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
    if column.unit("rad") is None and _NO_ROTATION.search(column.name):
        raise file.error(layout.line, f"the column {column.shown}", "a column of rotations")
    in_name = column.unit("rad") if given else _stated_unit(layout, column, "rad")
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
        if layout.file.overruled:
            raise layout.file.error(None, layout.file.overruled[0], "one time step")
        return step * np.arange(rotation.size, dtype=np.float64), rotation * UNITS["rad"][unit or given or "rad"]
    time, rotation = _table(layout, [times[0], chosen[0]], most)
    time *= _time_factor(layout, layout.columns[times[0]])
    if layout.columns[times[0]].unit("s") is None and layout.line is not None:
        if time_step is not None:
            time = time_step * np.arange(time.size, dtype=np.float64)
        elif time.size > 1 and (step := float(np.median(np.diff(time)))) > LONGEST_STEP:
            raise _no_unit_of_times(layout, step)
    elif time_step is not None and time.size > 1 and abs(np.median(np.diff(time)) / time_step - 1.0) > STEP_TOLERANCE:
        found = f"times with a step of {np.median(np.diff(time)):g} s"
        raise file.error(layout.line, found, f"the stated time step of {time_step:g} s")
    return time, rotation * UNITS["rad"][unit or given or "rad"]


_NO_ROTATION = re.compile(
    r"acc|veloc|\brate|speed|gyro|omega|[_ ]dot\b|counts\b|\b(?:cos|sin|tan)\b|\bx ?1", re.IGNORECASE
)
"""Names of columns of other quantities, or of a function or a multiple of the rotation."""


def _no_unit_of_times(layout: Layout, step: float) -> RecordFileError:
    expected = "a unit of times, such as time [ms], or the argument `time_step`"
    return layout.file.error(layout.line, f"a time step of {step:g}, without a unit", expected)


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
    if times := layout.of_kind("time"):  # of day
        return times
    cells = [cells_of(layout, row)[0] for row in layout.file.head[layout.first :] if row.strip()]
    if len(cells) > 2 and all(map(NUMBER.fullmatch, cells)) and not _rises(np.array([*map(to_float, cells[1:])])):
        return []  # perhaps one series, whose last row is shorter
    (values,) = _table(layout, [0])
    if not _rises(values):
        if _is_uniform(values[1:]):
            found = f"{layout.file.head[layout.first].strip()} above rows whose first numbers rise"
            more = "" if layout.skipped else ", or the argument `skip`"
            raise layout.file.error(layout.first, found, f"times from the first row on{more}")
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

    Raises `RecordFileError` if both readings are possible.
    """
    file, width = layout.file, layout.width
    if component == WRAPPED:
        return True
    counts = [one.value for one in layout.header.found.get("count", [])] + [layout.counted[0] if layout.counted else 0]
    rows = count_rows(file, layout.first)
    if any((rows - 1) * width < (count or 0) <= rows * width for count in counts) and rows not in counts:  # type: ignore[operator]
        return True
    whole = _whole_rows(layout)
    if len(whole) > 2 and rows not in counts and np.isfinite(whole).all():
        whole = whole / max(float(np.abs(whole).max()), 1.0)  # no sum overflows
        series = whole.ravel()
        along, down = np.abs(np.diff(series)), np.abs(np.diff(whole, axis=0)).mean()
        places = [along[k::width].mean() for k in range(width)]
        if along.mean() < (SMOOTHER if width > 3 else SMOOTHER_OF_FEW) * down and max(places) < 3.0 * min(places):
            return True
    names = ", ".join(one.name for one in layout.columns)
    expected = f"the argument `component`: one of them, or {WRAPPED} for one series along the rows"
    raise file.error(layout.line, f"{width} columns without names, {names}", expected)


def _wrapped(layout: Layout, unit: str | None, time_step: float | None) -> Record:
    """One series, several values a line."""
    file, header = layout.file, layout.header
    said = header.unit(unit)
    agreed = agreed_unit(file, said.line, None if said.value is None else str(said.value), unit)
    remarks, width, kept = list(header.remarks()), layout.width, slice(None)
    if (numbers := _numbers_of_rows(layout)) is not None:
        width, kept = width - 1, slice(None, -1) if numbers else slice(1, None)
        remarks.append(f"the {'last' if numbers else 'first'} column rises uniformly, and is no part of the series")
    if layout.separator is None and not layout.comma and numbers is None:
        values = file.values(layout.first)
    else:
        lines = chain.from_iterable(lines for _, lines in file.rows(layout.first))
        texts = chain.from_iterable(cells_of(layout, decoded(line))[kept] for line in lines if line)
        values = np.array([file.number(layout.first, text, "a number") for text in texts])
        file.check_values(values)
    rows = count_rows(file, layout.first)
    if not (rows - 1) * width < values.size <= rows * width:
        raise file.error(layout.first, f"{values.size} values in {rows} lines", f"{width} values in each line")
    if not layout.skipped and layout.counted is None:
        _check_leading(layout, values, time_step, kept)
    step = _agreed_step(layout, values.size, None, time_step)
    for one in header.found.get("count", []):
        remarks += file.checked_count(values, int(one.value or 0), one.line)
    source = f"{file.name} (columns, one series along the rows)"
    return Record(values, step, agreed, name=file.name.rsplit(".", 1)[0], source=source, remarks=remarks)


def _whole_rows(layout: Layout) -> Array:
    """The first rows that have as many numbers as the first one, shape (rows, columns)."""
    cells = (cells_of(layout, row) for row in layout.file.head[layout.first :])
    rows = [[*map(to_float, row)] for row in cells if len(row) == layout.width and all(map(NUMBER.fullmatch, row))]
    return np.array(rows).reshape(len(rows), layout.width)


def _numbers_of_rows(layout: Layout) -> int | None:
    """The first or the last of the columns of one series, if it numbers the rows or holds times."""
    table = _whole_rows(layout)
    found = [k for k in range(layout.width) if len(table) > 3 and _is_uniform(table[:, k])]
    if found and found not in ([0], [layout.width - 1]):
        names = ", ".join(layout.columns[k].name for k in found)
        raise layout.file.error(layout.first, f"{names}, which rise uniformly", "rows of samples only")
    return found[0] if found else None


def _rises(values: Array) -> bool:
    """Whether there are several values, each above the one before."""
    return values.size > 1 and bool((np.diff(values) > 0.0).all())


def _is_uniform(values: Array) -> bool:
    """Whether there are at least three values that rise by equal steps."""
    steps = np.diff(values)
    return _rises(values) and values.size > 2 and bool(np.ptp(steps) < STEP_TOLERANCE * steps.max())


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
            rows = f", or {WRAPPED} for one series along the rows" if layout.line is None and len(listed) > 3 else ""
            raise file.error(layout.line, f"components {names}", f"the argument `component`: one of them{rows}")
        return samples[0], [columns[k].shown for k in others if k != samples[0]]
    plain = plain_name(component)
    for key in (
        lambda name: [name.lower()] if component.strip().lower() == name.lower() else [],
        lambda name: [base_name(name), plain_name(name)],
        lambda name: plain_name(name).split()[:1],
        lambda name: plain_name(name).split(),
    ):
        found = [k for k in others if any(plain_name(part) == plain for part in key(columns[k].name))]
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


def _check_thousands(layout: Layout) -> None:
    """Refuse numbers such as 1,104 if all with this sign have three digits behind it: it may separate thousands."""
    content, start = layout.file.content, layout.file.start_of(layout.first)
    for sign in (b",", b".") if layout.separator in (";", "\t") else ():
        place = content.rfind(b"\n", 0, max(content.find(sign, start), start)) + 1
        numbers = re.compile(rb"(?<![^\s;])[^\s;%b]*+[%b][^\s;]*+" % (sign, sign))
        fields = [*islice(numbers.finditer(content, place), MAX_NAMES)]
        if fields and all(_THOUSANDS.fullmatch(field[0]) for field in fields):
            found = f"{decoded(fields[0][0])}, whose {decoded(sign)} may separate thousands"
            raise layout.file.error(None, found, "numbers without it, or with decimals that show what it is")


_THOUSANDS = re.compile(rb"[+-]?[1-9]\d{0,2}([.,]\d{3})+")


def _check_count(layout: Layout, values: Array) -> list[str]:
    """The remark on a number of values that the header does not state; several components one below the other."""
    remarks = []
    for one in layout.header.found.get("count", []):
        times = values.size / float(one.value or 1)
        if times in (2.0, 3.0) and layout.width == 1 and not layout.skipped:
            allowed = "one component; or the argument `skip`, 0 if all are samples of one"
            raise layout.file.error(one.line, f"{one.text}, and {values.size} values", allowed)
        if times != 1.0 and 0.1 < times < 10.0:
            remarks.append(f"the file holds {values.size} samples, its header states {one.text}")
    return remarks


def _check_leading(layout: Layout, values: Array, time_step: float | None, kept: slice) -> None:
    """Refuse some columns with a count, a step or a factor at the start, or a count at the end, by size and form."""
    if values[-1] == values.size - 1 and values[-1] > JUMP * np.abs(values[:-1]).max():
        found = f"{values[-1]:g} behind as many values"
        raise layout.file.error(None, found, "samples only; or the argument `skip`: 0")
    rows = (cells_of(layout, row)[kept] for row in layout.file.head[layout.first :] if row.strip())
    texts = [*chain.from_iterable(rows)][:HEAD_LINES]
    forms, digits = zip(*map(_form, texts), strict=True)
    uniform = len(texts) > 6 and len({*forms[3:]}) == 1
    exact = len(texts) > 12 and sum(count > 3 for count in digits[3:]) > 0.8 * (len(texts) - 3)
    stated = [one.value for one in layout.header.found.get("step", [])] + [time_step, *_GRAVITY]
    lead = 0
    for k in range(min(3, values.size - 2)):
        below = np.abs(values[k + 1 :])
        value, others = abs(values[k]), below.max()
        whole = value == round(value)
        counted = whole and value > 3.0 and values.size - 3 <= value <= values.size
        written = forms[k] != forms[-1] if uniform else exact and digits[k] <= 2 and (whole or value <= LONGEST_STEP)
        peak = value == others > 2.0 * below[0] and np.count_nonzero(below == others) == 1
        known = layout.width == 1 and values[k] in stated
        if value > 0.0 and (counted or peak or known or written or value > JUMP * others):
            lead = k + 1
    if lead:
        shown = ", ".join(texts[:lead])
        skip = -(-lead // len(range(layout.width)[kept]))
        allowed = f"samples only; or the argument `skip`: {skip} if these are a count, a step or a factor, 0 if samples"
        raise layout.file.error(layout.first, f"{shown} before {texts[lead]}", allowed)


_GRAVITY = (9.8, 9.81, 9.807, 9.80665, 980.0, 980.665, 981.0, 386.0, 386.09, 386.089, 386.4, 32.17, 32.174, 32.2)
"""Factors from g [-] that people write above the samples."""


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
    fields = fields_of(line, layout.separator)
    if not line:
        raise file.error(index, "a blank line", "a number")
    if len(fields) != layout.width:
        raise file.error(index, f"{len(fields)} columns", f"{layout.width}, as in line {layout.first + 1}")
    wrong = next((part for part in fields if not NUMBER.fullmatch(part)), None)
    if wrong is not None:
        skip = "; or the argument `skip`: so many rows of numbers above are no samples"
        text = not any(NUMBER.fullmatch(part) for part in fields)
        more = skip if text and index < layout.first + 4 and not layout.skipped else ""
        raise file.error(index, wrong or "an empty field", f"a number{more}")
    return [*map(to_float, fields)]


def _time_factor(layout: Layout, column: Column) -> float:
    """Seconds in the unit of the column of times, seconds if nothing states one."""
    unit = _stated_unit(layout, column, "s")
    tail = re.fullmatch(r"(?:time|t|zeit|temps|tempo|tiempo) (\w+)", plain_name(column.name))
    if unit is None and tail and tail[1] not in ("elapsed", "axis", "stamp", "vector", "relative"):  # such as time h
        raise _no_unit(layout, column, "s")
    return UNITS["s"][unit or "s"]


def _stated_unit(layout: Layout, column: Column, quantity: str) -> str | None:
    """The unit of times or rotations of a column, None without; other text in brackets or after a slash is refused."""
    unit = column.unit(quantity)
    if unit is None and re.search(r"[(\[/\u00b0]|deg|grad|milli", column.shown, re.IGNORECASE):
        raise _no_unit(layout, column, quantity)
    return unit


def _no_unit(layout: Layout, column: Column, quantity: str) -> RecordFileError:
    expected = f"one of the units {', '.join(UNITS[quantity])}"
    return layout.file.error(layout.line, f"the column {column.shown}", expected)


def _last_place(layout: Layout, column: int) -> float:
    """The unit of the last decimal of a column: in its first or its last rows, where numbers of as many digits are
    rounded more.
    """
    last = decoded(layout.file.content[-MAX_LINE:]).splitlines()[1:][-20:]
    found = []
    for lines in (layout.file.head[layout.first :], last):
        rows = (cells_of(layout, line) for line in lines)
        texts = [row[column].upper().replace("D", "E") for row in rows if len(row) == layout.width]
        found.append(min((_last_exponent(text) for text in texts if NUMBER.fullmatch(text)), default=-20.0))
    return float(10.0 ** min(max(found), 300.0))


def _last_exponent(number: str) -> float:
    """The power of ten of the last digit of a number, whose exponent may have any size."""
    mantissa, _, exponent = number.replace(",", ".").partition("E")
    return float(exponent or 0) - len(mantissa.partition(".")[2])


def _uniform_step(layout: Layout, times: Array, place: float, known: float | str | None) -> float:
    """The step of times that are uniform, as far as their last place says; the error names the first line that is not.

    Each time is off by half of the last place, and so are the two that give the step; `known` is more exact where few
    times do not settle it.
    """
    file, first = layout.file, layout.first
    if times.size < 2:
        raise file.error(first, "one row", "at least 2")
    if not np.abs(times).max() <= MAX_TIME:
        raise file.error(None, f"a time of {np.abs(times).max():g} s", f"times up to {MAX_TIME:g} s")
    known = None if known is None else float(known)
    if known and place > LARGEST_ROUNDING * known and np.ptp(times - known * np.arange(times.size)) <= 1.001 * place:
        return known  # several times are rounded to the same
    step = float((times[-1] - times[0]) / (times.size - 1))
    middle = float(np.median(np.diff(times), overwrite_input=True))
    if not (middle > 0.0 and np.isfinite(middle)):
        raise file.error(first + 1, f"times {times[0]:g} and {times[1]:g}", "times that increase")
    off = times[0] + step * np.arange(times.size) - times
    rounding = 1.001 * place if place <= LARGEST_ROUNDING * step else 0.0
    largest = max(off.max(), -off.min())
    if step > 0.0 and largest <= max(STEP_TOLERANCE * step, rounding):
        if largest > 0.01 * place and place > 1e-3 * step * (times.size - 1):
            if known is None:
                allowed = "times with more decimals, a step in the header, or the argument `time_step`"
                raise file.error(first, f"times rounded to {place:g} s, about {step:.3g} s apart", allowed)
            if abs(known - step) * (times.size - 1) <= place:
                return known
        return float(f"{step:.12g}")  # removes the rounding of the difference
    wrong = int(np.abs(np.diff(times) / middle - 1.0).argmax())
    more = "; or the argument `skip`" if wrong == 0 and not layout.skipped else ""
    found = f"a step of {times[wrong + 1] - times[wrong]:g} s"
    raise file.error(first + wrong + 1, found, f"uniform steps of {middle:g} s{more}")
