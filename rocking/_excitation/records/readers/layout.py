"""How a file of columns holds its numbers: which rows are the samples, how they are separated, what names the columns.

`find_layout` decides. A line names the columns if its fields agree with the rows in number and are names of quantities
(`KINDS`, `SAMPLES`); a title is none, whatever separators it holds.
"""

import re
from dataclasses import dataclass, replace
from itertools import chain

from rocking._base.units import UNITS, quantities_of, unit_name
from rocking._excitation.records.readers.clock import CLOCK, in_seconds
from rocking._excitation.records.readers.header import LONGEST_STEP, Header, read_header, units_in
from rocking._excitation.records.readers.lines import NUMBER, TOUCHING, TextFile, to_float

MAX_UNIT_PARTS = 8  # most parts, separated by blanks, of a unit in a column name, such as m / s ^ 2
MAX_NAMES = 512  # most columns whose names are searched: more numbers in a row are one series
MAX_NAME = 60  # most characters of the name of a column; longer ones are sentences

_COMMENT = "#%!*/\"'"

_UNSIGNED_PAIRS = re.compile(r"\s*+[+-]?\d++,\d++(?:[Ee][+-]?\d++)?+(?:, *+[+-]?\d++,\d++(?:[Ee][+-]?\d++)?+)*+\s*+")
"""A row that may be of numbers with decimal commas only."""

_COMMA_NUMBERS = re.compile(
    r"\s*+[+-]?\d++(?:,\d++)?+(?:[Ee][+-]?\d++)?+(?:[ ]++[+-]?\d++(?:,\d++)?+(?:[Ee][+-]?\d++)?+)++\s*+"
)
"""A row of several numbers, separated by blanks, whose commas are decimal signs."""

_DECIMAL = re.compile(r"[+-]?\d+,\d+(?:[Ee][+-]?\d+)?")
_MISSING = re.compile(r"-*|\*+|#?n/?a|nan|null|none", re.I)  # texts in place of a number

_BRACKETS = re.compile(r"(?:(?<!\s)\s++)?[(\[](?:[^()\[\]]++|\([^()\[\]]*+\))*+[)\]]")

KINDS = {
    "time": r"((elapsed|relative|rel|record|recording|running|sample|sampling) ?)?"
    r"(time(?! (history|series))|zeit|temps|tempo|tiempo|tid|tijd|zaman|czas|t)"
    r"( (since|from|after|seit|depuis|desde)\b.*| \w+)?|timestamps?|seconds?( elapsed)?|sekunden|x value",
    "counter": r"(?!record$)(frames?|scan|tick|index|idx|samples?|data ?points?|points?|pt|row|line|zeile|record|item|"
    r"step|bild|punkt|messwert|muestra|campione|echantillon|échantillon|numero|número|no|nr|num|number|nummer|n|i|k|j|id|"
    r"count|counter|zähler|lfd)( ?(no|nr|num|number|nummer|id|index|idx|count|counter|#|№))?|(#|№|n°|nº)|(s|sr|sl) no",
    "other": r"(vel|dis(?!t)|geschw|versch|spost|depl|spectr|fourier|psa\b|psv\b|period\b|freq|temp(erat|\b)|press|"
    r"strain|arias|cav\b).*|d",
}
"""Names of columns that hold no samples, in lower case, without signs and units, by what they hold."""

SAMPLES = (
    r"(ground |base |table |input |shock |measured |corrected |uncorrected |raw )?"
    r"(a|ag|üg|acc|accel|acceler\w*|accn|beschl\w*|aceler\w*|accélér\w*|ivme)( ?(time )?(history|series|values?|data))?"
    r"( ?(x|y|z|ns|ew|ud|n s|e w|u d|n|e|u|v|h\d?|\d+))?|"
    r"ns|ew|ud|eo|n s|e w|u d|e o|n|s|e|w|u|z|x|y|v|h\d?|[ns]\d\d?[ewo]|[bh][hnl][enz123]|long|"
    r"longitudinal|trans|transverse|vert\w*|up|north|south|east|west|(chan|channel|canal|ch|col|column) ?\d+|"
    r"rotations?|angle|theta|θ|phi|winkel|rotación|rotazione|time (history|series)"
)
"""Names of columns of samples, as `KINDS`: a line of them alone names columns."""


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
    """How a file holds its numbers."""

    file: TextFile
    first: int  # index of the line of the first sample
    separator: str | None  # of columns; None for blanks
    comma: bool  # whether commas are decimal signs
    line: int | None  # index of the line of the names; None if the columns have none
    columns: list[Column]  # from the left
    header: Header  # what the lines above state
    # (count, step) of a line above the samples with these two numbers, which the number of values has to confirm
    counted: tuple[int, float] | None = None
    skipped: bool = False

    @property
    def width(self) -> int:
        """Number of columns."""
        return len(self.columns)

    def of_kind(self, *kinds: str) -> list[int]:
        """Indices of the columns of some kinds."""
        return [k for k, one in enumerate(self.columns) if one.kind in kinds]


RECORDS = "the header of a known format (AT2, ESM, K-NET, COSMOS, CSMIP, GeoNet, SMC, TSPAIR), or rows of numbers"


def find_layout(file: TextFile, skip: int | None, quantity: str = "m/s2", expected: str = RECORDS) -> Layout:
    """Decide how a file holds its numbers; `skip` rows of them are passed over, None: it may have to be asked for."""
    timed = next((k for k, line in enumerate(file.head) if CLOCK.search(line) and len(_of_times(line)) > 1), None)
    clocks = file.head[timed] if timed is not None else ""
    file = file if timed is None else in_seconds(file, timed)
    rows = [k for k, line in enumerate(file.head) if is_row(line) and (skip or k >= (timed or 0))]
    if not rows:
        lines = [line.strip() for line in file.head if line.strip()]
        shown = next((line for line in lines if NUMBER.match(line)), lines[0] if lines else "blank lines")
        raise file.error(None, shown, expected)
    if skip is not None and skip >= len(rows):
        raise file.error(None, f"{len(rows)} rows of numbers in the first lines", f"more than `skip` = {skip} of them")
    first, counted = rows[skip or 0], None
    following = rows[(skip or 0) + 1 :]
    sizes = [len(split_row(file.head[k])) for k in (first, *following[:2])]
    if skip is None and len(sizes) == 3 and sizes[0] != sizes[1] == sizes[2]:
        counted = _counted(file.head[first])
        if counted is None or following[0] != first + 1:
            shown = file.head[first].strip()
            width = len(split_row(file.head[following[0]]))
            allowed = f"rows of {width} numbers, as in line {following[0] + 1}; or the argument `skip`"
            raise file.error(first, shown, allowed)
        first = following[0]
    elif skip is None and following and (counted := _counted(file.head[first])):
        count = count_rows(file, following[0])
        if len(split_row(file.head[first])) == 2 and counted[0] in (count, 2 * count - 1, 2 * count):
            first = following[0]
        else:
            counted = None
    separator, comma = _separator(file.head[first])
    width = len(fields_of(file.head[first], separator))
    above = fields_of(file.head[first - 1], separator) if first and skip is None else []
    texts = [field for field in above if not NUMBER.fullmatch(field)]
    missing = len(above) == width and above[0] != "" and texts and all(map(_MISSING.fullmatch, texts))
    if missing and (len(texts) < width or texts[0].isalpha()):
        raise file.error(first - 1, file.head[first - 1].strip(), "a number in each column; or the argument `skip`")
    line, columns = _columns(file, first, separator, width, quantity)
    for k in (k for k, field in enumerate(fields_of(CLOCK.sub(":", clocks), separator)) if field == ":"):
        columns[k] = replace(columns[k], unit_text="s", kind="time")
    if separator == "," and (line is None or "," not in file.head[line]) and _is_decimal(file, first):
        separator, comma, width = None, True, 1
        line, columns = _columns(file, first, separator, width, quantity)
    if line is None:
        _check_unnamed(file, first, width)
    header = read_header(file, file.head[:first], quantity)
    return Layout(file, first, separator, comma, line, columns, header, counted, skip is not None)


def _of_times(line: str) -> list[str]:
    """The texts of the numbers of a row with times of day; none of any other line."""
    plain = CLOCK.sub("0", line)
    return split_row(plain) if is_row(plain) else []


def names_below(file: TextFile, line: int) -> bool:
    """Whether a line between this one and the next row of several numbers names them."""
    first = next((k for k, text in enumerate(file.head) if k > line and is_row(text)), None)
    if first is None:
        return False
    separator, _ = _separator(file.head[first])
    width = len(fields_of(file.head[first], separator))
    return width > 1 and any(_names(text.strip(), separator, width, "m/s2") for text in file.head[line + 1 : first])


def _counted(line: str) -> tuple[int, float] | None:
    """The number of values and the time step [s] in a line of these two numbers, in either order."""
    fields = split_row(line)
    if len(fields) != 2:
        return None
    for count, step in (fields, fields[::-1]):
        if count.isdecimal() and int(count) > 1 and 0.0 < to_float(step) <= LONGEST_STEP:
            return int(count), to_float(step)
    return None


def count_rows(file: TextFile, first: int) -> int:
    """Number of lines from one on that are not blank."""
    return sum(sum(map(bool, lines)) for _, lines in file.rows(first))


def _separator(line: str) -> tuple[str | None, bool]:
    """The separator of a row of numbers, None for blanks, and whether commas are decimal signs."""
    if "," in line and _COMMA_NUMBERS.fullmatch(line):
        return None, True
    if "\t\t" in line.strip():
        return None, "," in line
    mark = next((mark for mark in (";", "\t", ",") if mark in line.strip()), None)
    return mark, mark in (";", "\t")  # beside which a comma is the decimal sign


def fields_of(line: str, separator: str | None) -> list[str]:
    """The fields of a line; separators at its end add none."""
    fields = [part.strip().strip("\"'") for part in line.strip().split(separator)]
    while len(fields) > 1 and fields[-1] == "":
        fields.pop()
    return fields


def split_row(line: str) -> list[str]:
    """The texts of the numbers of a row, with decimal points."""
    separator, comma = _separator(line)
    fields = fields_of(line.replace(",", ".") if comma else line, separator)
    return fields if separator is not None else [*chain.from_iterable(map(TOUCHING.split, fields))]


def cells_of(layout: Layout, line: str) -> list[str]:
    """The texts of the numbers of a row, as the first row separates them."""
    fields = fields_of(line.replace(",", ".") if layout.comma else line, layout.separator)
    return fields if layout.separator is not None else [*chain.from_iterable(map(TOUCHING.split, fields))]


def is_row(line: str) -> bool:
    """Whether all fields of a line are numbers."""
    return bool(line.strip()) and all(map(NUMBER.fullmatch, split_row(line)))


def _columns(
    file: TextFile, first: int, separator: str | None, width: int, quantity: str
) -> tuple[int | None, list[Column]]:
    """Line of the names, and the columns: of the nearest line above the rows that names as many; else numbered."""
    found: list[tuple[int, list[Column]]] = []
    units: list[str] = []
    for k in range(first - 1, -1, -1) if width <= MAX_NAMES else ():
        if file.stop is not None:
            file.stop.check()
        whole = file.head[k].strip()
        line = whole.strip(_COMMENT).strip() if whole[:1] in "#%!*/" else whole
        parts = _row_of_units(line, separator, width)
        if parts and not units and not found:
            units = parts
            continue
        surely = bool(units) and not found
        names = _names(line, separator, width, quantity, surely)
        if not names and width > 1 and whole.startswith("#"):  # the name of a counter, not the sign of a comment
            names = _names(whole, separator, width, quantity)
            names = names if all(kind_of(base_name(name)) for name in names[1:]) else []
        if names and (width > 1 or kind_of(base_name(names[0]))):  # of one column, any other line may be a title
            texts = units if not found and units else [""] * width
            columns = [_column(name, text, quantity) for name, text in zip(names, texts, strict=True)]
            plain = {plain_name(one.name) for one in columns}
            kinds = {"n": "samples"} if "e" in plain else {"v": "other"} if {"a", "d"} <= plain else {}
            columns = [replace(one, kind=kinds.get(plain_name(one.name), one.kind)) for one in columns]
            found.append((k, columns))
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


def _row_of_units(line: str, separator: str | None, width: int) -> list[str]:
    """The texts of a line of units, one of each column; empty if it is none."""
    joined = _BRACKETS.sub(lambda found: "".join(found[0].split()), line)
    for fields in (fields_of(line, separator), joined.split(), re.split(r"\s{2,}", line)):
        if len(fields) == width > 1:
            known = [_is_unit(part) for part in fields]
            if any(known) and all(k or part in ("", "-", "[-]", "(-)") for k, part in zip(known, fields, strict=True)):
                return fields
    return []


def _is_unit(text: str) -> bool:
    """Whether a text is a unit, or two names of one, such as gal(cm/s/s)."""
    pair = re.fullmatch(r"([^()\[\]]+)\(([^()]+)\)", text.strip(" .[]"))
    parts = (pair[1], pair[2]) if pair else (text,)
    return bool(frozenset.intersection(*(quantities_of(part.strip(" .")) for part in parts)))


def _names(line: str, separator: str | None, width: int, quantity: str, surely: bool = False) -> list[str]:
    """The names of as many columns in a line; empty if it is none of names. `surely`: a line of units is below it."""
    joined = _BRACKETS.sub(lambda found: "".join(found[0].split()), line)  # blanks in brackets separate no columns
    for mark in (separator, ",", ";", "\t", None):
        names = fields_of(joined if mark is None else line, mark)
        if mark is not None and names[0] == "":  # as pandas writes a counter
            names[0] = "index"
        if len(names) == width + 1:  # dates are read with the times; comments are often empty
            names = [name for name in names if name.lower() not in ("date", "datum", "fecha", "comment")]
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
    plain = _BRACKETS.sub("", text)
    return (
        0 < len(text) <= MAX_NAME
        and not NUMBER.fullmatch(text)
        and re.search(r"[^\W\d_]|[#№]", plain) is not None
        and not re.search(r"[:=]", plain)
        and not re.search(r"(?<![\w.])(\d*\.\d+|\d{4,})(?![\w.])|\b(peak|pga|max\w*|scaled|factor)\b", plain, re.I)
    )


def plain_name(name: str) -> str:
    """A name in lower case, without brackets and signs but those of numbers."""
    without = re.sub(r"[(\[][^()\[\]]*[)\]]?", " ", name.lower())
    return " ".join(re.findall(r"[^\W_]+|[#№°º]", without.partition("/")[0] or without))


def base_name(name: str) -> str:
    """A plain name without the unit behind it, if what is left is known; else the plain name."""
    words = re.split(r"[\s_]+", name.strip())
    for k in range(1, len(words)):
        if any(unit_name("".join(words[k:]), one) for one in UNITS) and _is_quantity(words[:k]):
            return plain_name(" ".join(words[:k]))
    return plain_name(name)


def kind_of(plain: str) -> str:
    """The kind of a plain name; "" for an unknown one."""
    if re.fullmatch(SAMPLES, plain):
        return "samples"
    return next((kind for kind, names in KINDS.items() if re.fullmatch(names, plain)), "")


def _is_quantity(words: list[str]) -> bool:
    """Whether words name a quantity that has a unit."""
    return kind_of(plain_name(" ".join(words))) in ("samples", "time", "other")


def _column(name: str, unit_text: str, quantity: str) -> Column:
    """A column by its name and the text of its unit."""
    bare = Column(name, unit_text)
    plain = plain_name(name)
    kind = next((kind for kind in ("time", "counter", "other") if re.fullmatch(KINDS[kind], plain)), "")
    kind = kind or kind_of(base_name(name))
    texts = re.findall(r"[(\[]([^()\[\]]*)[)\]]", name + unit_text) or [unit_text.strip(" -")]
    brackets = " ".join(texts).lower()
    if re.fullmatch(r"frames?|samples?|points?|counts? of frames", brackets):
        kind = "counter"
    elif bare.unit(quantity):  # T [g] is a component, time_g an error
        kind = kind if kind == "other" or (kind == "time" and base_name(name) != "t") else "samples"
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
    words = re.sub(r"(?<=\w) in (?=\S+$)", " ", name).split()[-MAX_UNIT_PARTS:]  # "angle in degrees"
    texts = [name, *("".join(parts[k:]) for k in range(1, len(parts))), name.partition("/")[2]]
    texts += ["".join(words[k:]) for k in range(1, len(words)) if _is_quantity(words[:k])]
    return next((unit for text in texts if (unit := unit_name(text.strip(" ."), quantity))), None)


def _is_decimal(file: TextFile, first: int) -> bool:
    """Whether each row is one number with a decimal comma; rows that may be of such numbers are refused."""
    rows = [row.strip() for row in file.head[first:] if row.strip()]
    if all(map(_DECIMAL.fullmatch, rows)) and any(re.search(r",0\d", row) for row in rows):
        return True  # 0,05 is no pair of whole numbers
    if all(map(_UNSIGNED_PAIRS.fullmatch, rows)):
        allowed = "semicolons or tabs between columns with decimal commas, or names of the columns with commas"
        raise file.error(first, file.head[first].strip(), allowed)
    return False


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
