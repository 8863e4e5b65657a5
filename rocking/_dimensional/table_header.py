"""The header of a table as people keep it: which line it is, what its columns are, and in which units."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from typing import Any, Generic, TypeVar

from rocking._base.cells import is_symbol, name_and_unit, named, plain_name, rank, read_header, stated_unit
from rocking._base.errors import InvalidArgumentError
from rocking._base.quantity import Quantity
from rocking._base.units import UNITS, unit_name

Item = TypeVar("Item")

HEADER_ROWS = 12  # the header is searched in this many rows at the top
MAX_COLUMNS = 1000  # most columns of a table
MAX_NAME = 200  # longest name of a column with its unit [characters]

EMPTY = {
    *("", "-", "--", "\u2013", "\u2014", "?", "n/a", "na", "n.a.", "#n/a", "none", "null", "nan", "nil"),
    *("k.a.", "k. a.", "unknown", "unbekannt", "sconosciuto", "inconnu", "desconocido"),
}
"""Cells without a value, in small letters."""

UNIT_NAMES = {
    *("unit", "units", "uom", "unit of measure", "unit of measurement", "measurement unit", "units of measure"),
    *("einheit", "einheiten", "masseinheit", "unita", "unita di misura", "unite", "unites", "unite de mesure"),
    *("unidad", "unidades", "unidad de medida", "monada", "\u03bc\u03bf\u03bd\u03b1\u03b4\u03b1"),
}
"""Headers of a column with the units of the others."""

SIZE_NAMES = {
    *("dimension", "dimensions", "size", "sizes", "measurement", "measurements", "measure", "measures", "length"),
    *("lengths", "dim", "dims", "masse", "abmessung", "abmessungen", "dimensioni", "misure", "mesures", "medidas"),
    *("dimensiones", "diastaseis", "\u03b4\u03b9\u03b1\u03c3\u03c4\u03b1\u03c3\u03b5\u03b9\u03c2"),
}
"""Words for all lengths of a table."""

_WITH_SIZES = {*("all", "in", "of", "the", "overall", "outer", "external", "object", "objects", "alle", "tutte", "le")}

LENGTH_WORD = re.compile(
    r"width|breadth|depth|length|height|thick|diam|radius|girth|circumf|\bside\b|\bbase\b|footprint|dimension|\bsize\b"
    r"|breit|tief|lange|hoh|hoeh|dick|stark|largh|profond|lungh|altez|spess|largeur|longueur|hauteur|epais|ancho|altura"
    r"|largo|espes|grosor|fondo|platos|ypsos|vathos|pachos|mikos|^[a-z][12]?$"
)

NO_LENGTH = re.compile(
    r"year|date|period|found|acquired|signed|gallery|hall|saal|sala|condition|zustand|stato|etat|rank|priority|class|categor"
    r"|century|jahr|anno|annee|\bano\b|made|qty|quantit|count|pieces|anzahl|stuck|value|price|cost|wert|preis"
    r"|valore|prezzo|valeur|prix|valor|precio|room|raum|floor|level|stockwerk|shelf|case|page|number|\bno\b|\bnr\b|id$"
    r"|code|index|age|\blot\b|weight|mass|score|rating|angle|percent"
)

LAST_UNIT = re.compile(r"\s(?:in|m)\s*$", re.IGNORECASE)

OTHER_NUMBER = re.compile(
    r"friction|reib|attrit|frottement|restitu|stosszahl|toleran|\b(?:cog|cg|com)\b|cent(?:re|er) of|centroid"
    r"|schwerpunkt|baricent|inclin|\btilt|eccentric|\boffset"
    r"|^(?:mass|weight|gewicht|peso|poids) (?!class|categ|rank)\w+$"
)
"""Names of numbers other than lengths that are a question where they are not read."""

AMOUNT = re.compile(r"\W*(?:c|ca|circa|approx\w*|about|um|env\w*|max|min)?[\s.:]*\d", re.IGNORECASE)

_UNUSED = ("unused", "not used")


@dataclass(frozen=True)
class Schema(Generic[Item]):
    """What a table holds."""

    argument: str  # what errors call the table
    columns: tuple[Quantity, ...]  # the columns that are read; others are passed through
    required: tuple[tuple[str, ...], ...]  # quantities that the header has; one of each group
    # the item of a row, from its number, the values of the cells that are not empty: texts as they stand,
    # numbers in SI units; and the cells of all other columns, texts that are read included, by their headers.
    # It raises `InvalidArgumentError`, with the name of a column
    make: Callable[[int, dict[str, Any], dict[str, str]], Item]
    every_length: bool = False  # whether a length in a column that is not read refuses its row
    # names of columns that replace those of the header, whose units remain
    renamed: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class HeaderLine:
    """A line that may be the header."""

    number: int  # from 0
    cells: list[str]  # its cells as they stand
    labels: list[str]  # completed by the line above, with their number where one is empty or not the first
    texts: list[str]  # completed, under the names that were given to them
    columns: dict[int, tuple[Quantity, str]]  # quantities that are read, with their units
    grouped: set[int]  # columns in a group of lengths that are not read
    complete: bool  # whether it has all columns that a header needs
    error: InvalidArgumentError | None  # its first unit that is not understood


@dataclass(frozen=True)
class Header:
    """What the header says."""

    last: int  # its last line
    labels: list[str]  # its cells as they stand, with their number where one is empty or not the first
    texts: list[str]  # its cells, under the names that were given to them
    columns: dict[int, tuple[Quantity, str]]  # quantities that are read, with their units, "" in the cells
    units: dict[int, int]  # column with the units of another one, by the place of that
    lengths: dict[int, bool]  # columns that are not read and may hold a length; whether it says so by its unit


def header_lines(rows: Sequence[Sequence[str]], schema: Schema[Any]) -> Iterator[HeaderLine]:
    """The first lines, which may be the header. Of a header of two lines the upper one completes the lower one."""
    known = {plain_name(name): one for one in schema.columns for name in one.names}
    for number, row in enumerate(rows[:HEADER_ROWS]):
        if len(row) > MAX_COLUMNS:
            continue
        own = [*rows[number - 1], *[""] * len(row)][: len(row)] if number else [""] * len(row)
        if not all(map(is_unit, filter(None, map(str.strip, own)))):
            own = ["" if is_unit(text) else text for text in own]
        above = zip(_merged(own), own, row, strict=True)
        pairs = [_joined(*one, known) if max(map(len, one)) <= MAX_NAME else ("", False) for one in above]
        labels = labels_of([text for text, _ in pairs])
        texts = [_renamed(*one, schema.renamed) for one in zip(labels, (text for text, _ in pairs), strict=True)]
        found: dict[int, tuple[Quantity, str]] = {}
        error = None
        for place, text in enumerate(texts):
            try:
                one = read_header(text, known, schema.argument) if is_used(text) else None
            except InvalidArgumentError as wrong:
                column = named(name_and_unit(text)[0], known)
                error, one = error or wrong, (column, "") if column else None
            if one and (one[0].unit or one[0].name in ("name", "number") or not stated_unit(text, "m")):
                found[place] = one  # "pedestal (cm)" is a length
        found = _assigned(found, texts, schema)
        names = {one.name for one, _ in found.values()}
        complete = all(any(name in names for name in group) for group in schema.required)
        groups = {k for k, (_, group) in enumerate(pairs) if group and any(map(str.strip, own[1:]))}  # not by a title
        yield HeaderLine(number, [*row], labels, texts, found, groups, complete, error)


def find_header(rows: Sequence[Sequence[str]], schema: Schema[Any]) -> Header:
    """The header among the first rows."""
    lines = list(header_lines(rows, schema))
    line = next((line for line in lines if line.complete), None)
    if line is None:
        raise _without_header(lines, schema)
    if line.error is not None:
        raise line.error
    for name in schema.renamed.keys() - set(map(str.strip, line.labels)):
        raise InvalidArgumentError("columns", name, f"a column of the table: {'; '.join(line.labels)[:MAX_NAME]}")
    # b and h are half sizes in papers on rocking, and full ones in other tables
    best = {one.name: (*one.names, "")[rank(one, line.texts[place])] for place, (one, _) in line.columns.items()}
    symbols = [best.get("width") == "b", best.get("height") == "h"]
    half = any(one.times != 1.0 for one, _ in line.columns.values())
    if any(symbols) if half else all(symbols) and "depth" not in best:
        allowed = "width and height, or 2b and 2h, or half width and half height: b and h may be either"
        raise InvalidArgumentError(f"{schema.argument}, header", "b; h", allowed)
    count = Counter(one.name for one, _ in line.columns.values() if one.unit)
    for name in (name for name, several in count.items() if several > 1):
        same = "; ".join(line.labels[place] for place, (one, _) in line.columns.items() if one.name == name)
        allowed = f'one column {name}; the name of a column that is not read begins with "unused"'
        raise InvalidArgumentError(f"{schema.argument}, header", same[:MAX_NAME], allowed)
    columns, lengths, after = _with_units(line, rows, schema)
    units = _unit_columns(line.texts, columns)
    lengths = dict.fromkeys(sorted(_beside(line, columns, units)), False) | lengths
    return Header(after, line.labels, line.texts, columns, units, lengths)


def _without_header(lines: Sequence[HeaderLine], schema: Schema[Any]) -> InvalidArgumentError:
    """The columns that the best candidate for a header lacks, and its column that may be one of them."""
    best = max(lines, key=lambda line: len(line.columns), default=None)
    texts, columns = (best.texts, best.columns) if best else ([], {})
    names = {one.name for one, _ in columns.values()}
    needed = {" or ".join(group): names.isdisjoint(group) for group in schema.required}
    missing = ", ".join(group for group, lacks in needed.items() if lacks)
    rest = [text for place, text in enumerate(texts) if place not in columns and is_used(text)]
    near = [text for text in rest if stated_unit(text, "m") or LENGTH_WORD.search(plain_name(text))]
    near = [text for text in near if not re.search(r"radi|circumf|umfang|girth", plain_name(text))]
    allowed = f"columns {', '.join(needed)}, of at most {MAX_COLUMNS}; missing: {missing}"
    if any(is_sizes(name_and_unit(text)[0]) for text in rest):
        allowed += '; where a column has several dimensions, its header says the order: "W x D x H (cm)"'
    elif near and columns:
        allowed += f"; if that is {near[0][:MAX_NAME]!r}, name the column so"
    return InvalidArgumentError(f"{schema.argument}, header", "; ".join(texts)[:MAX_NAME] or "nothing", allowed)


def is_used(text: str) -> bool:
    return bool(text.strip()) and not plain_name(text).startswith(_UNUSED)


def _renamed(label: str, text: str, renamed: Mapping[str, str]) -> str:
    """A header text replaced by the name given for its label, with its own unit."""
    if label.strip() not in renamed:
        return text
    name, (_, unit) = renamed[label.strip()], name_and_unit(text)
    if name in _UNUSED:
        return f"{name}: {text}"
    return f"{name} [{unit}]" if unit and not name_and_unit(name)[1] else name


def _assigned(
    found: dict[int, tuple[Quantity, str]], texts: Sequence[str], schema: Schema[Any]
) -> dict[int, tuple[Quantity, str]]:
    """The columns under the names that are read: stand-ins replaced, and the best one of several with names."""
    known = {one.name: one for one in schema.columns}
    for column in schema.columns:
        places = [place for place, (one, _) in found.items() if one is column]
        if not column.unit and not column.joined and places:
            best = min(places, key=lambda place: rank(column, texts[place]))
            found = {place: pair for place, pair in found.items() if place == best or place not in places}
            places = [best]
        if not column.stands_for:
            continue
        taken = {one.name for one, _ in found.values()}
        target = next((name for name in column.stands_for if name not in taken), None)
        if target is None:
            found = {place: pair for place, pair in found.items() if place not in places}
        else:
            found |= {place: (replace(known[target], times=column.times), found[place][1]) for place in places}
    return found


def _joined(upper: str, own: str, lower: str, known: Mapping[str, Quantity]) -> tuple[str, bool]:
    """The name of a column from two lines, and whether it is in a group of lengths.

    `upper` is the cell of the upper line or of the group to its left, `own` that cell itself.
    """
    if not lower.strip():
        return own, False
    with suppress(InvalidArgumentError):
        one = read_header(own, known, "")
        bare = lower.strip("[]() ")
        if one and one[0].unit in UNITS and not one[1] and unit_name(bare, one[0].unit):
            return f"{own} [{bare}]", False
        unit = _group_unit(upper, known)
        below = read_header(lower, known, "") if unit else None
        if below and not below[1] and unit_name(unit, below[0].unit if below[0].unit in UNITS else "m"):
            return (f"{lower} [{unit}]" if below[0].unit in UNITS else lower), False
        return lower, below is None and unit_name(unit, "m") is not None
    return lower, False


def _group_unit(text: str, known: Mapping[str, Quantity]) -> str:
    """The unit that an upper line states for the columns below: "Dimensions (cm)", "[cm]"; "" for a title."""
    if is_unit(text):
        return text.strip("[]() ")
    name, unit = name_and_unit(text)
    return unit if plain_name(name) in known or is_sizes(name) else ""


def is_sizes(name: str) -> bool:
    """Whether a name is a word for all lengths, such as "Overall dimensions"."""
    words = set(plain_name(name).split())
    return bool(words & SIZE_NAMES) and words <= SIZE_NAMES | _WITH_SIZES


def is_unit(text: str) -> bool:
    """Whether a text is a unit of a quantity."""
    return any(unit_name(text.strip("[]() "), unit) for unit in UNITS)


def _merged(row: Sequence[str]) -> list[str]:
    """A header line with merged cells, which leave empty cells to their right."""
    found: list[str] = []
    for text in row:
        found.append(text.strip() or (found[-1] if found and not is_unit(found[-1]) else ""))
    return found


def _with_units(
    line: HeaderLine, rows: Sequence[Sequence[str]], schema: Schema[Any]
) -> tuple[dict[int, tuple[Quantity, str]], dict[int, bool], int]:
    """The columns with the units of a line of its own below the header, if there is one; lengths that are not read."""
    columns, last = dict(line.columns), line.number
    others = [place for place, text in enumerate(line.texts) if place not in columns and is_used(text)]
    lengths = {place: True for place in others if stated_unit(line.texts[place], "m")}
    below = [text.strip("[]() ") for text in rows[last + 1]] if last + 1 < len(rows) else []
    units = {
        place: below[place]
        for place, (one, _) in columns.items()
        if one.unit in UNITS and place < len(below) and below[place] not in ("", "-")
    }
    known = {place: unit_name(text, columns[place][0].unit) for place, text in units.items()}
    if all(map(is_unit, units.values())) and any(text != "1" for text in units.values()):
        last += 1
        for place, unit in known.items():
            one, stated = columns[place]
            if not unit or stated not in ("", unit):
                allowed = f"a unit of {one.name}, the one of its header"
                raise InvalidArgumentError(
                    f"{schema.argument}, header", f"{line.texts[place]}; {units[place]}", allowed
                )
            columns[place] = one, unit
        lengths |= {place: True for place in others if place < len(below) and unit_name(below[place], "m")}
    named = (place for place in others if not is_symbol(line.texts[place]))
    names = {place: plain_name(name_and_unit(line.texts[place])[0]) for place in named}
    weak = set()
    for place, name in names.items():
        found = LENGTH_WORD.search(name)
        exempt = NO_LENGTH.search(name) and (found is None or found[0] in ("base", "side", "size"))  # "base price"
        if (
            is_sizes(name)
            or OTHER_NUMBER.search(name)
            or ((found or LAST_UNIT.search(line.texts[place])) and not exempt)
        ):
            weak.add(place)
    weak |= line.grouped & set(others)
    return columns, dict.fromkeys(sorted(weak), False) | lengths, last


def _beside(line: HeaderLine, columns: Mapping[int, tuple[Quantity, str]], units: Mapping[int, int]) -> set[int]:
    """Columns that are not read and may be a length without a unit: between those of lengths, anywhere beside headers
    without units.
    """
    measured = [place for place, (one, _) in columns.items() if one.unit == "m"]
    first, last = min(measured, default=0), max(measured, default=0)
    if not all(stated_unit(line.cells[place], "m") for place in measured):
        first, last = 0, len(line.texts)
    flat = {"depth", "diameter"}.isdisjoint(one.name for one, _ in columns.values())
    found = set()
    for place, text in enumerate(line.texts[: last + 2]):
        name = plain_name(name_and_unit(text)[0])
        is_read = place in columns or place in units.values() or is_symbol(text)
        says_no = name.startswith(_UNUSED) or NO_LENGTH.search(name)
        near = place <= last and (text.strip() or 0 < place < last)
        near = near or (flat and place == last + 1 and not text.strip())  # may be the depth
        if place >= first and not is_read and not says_no and near:
            found.add(place)
    return found


def _unit_columns(texts: Sequence[str], columns: Mapping[int, tuple[Quantity, str]]) -> dict[int, int]:
    """The place of the column that has the units of each column of numbers, where there is one."""
    found: dict[int, int] = {}
    plain = {place: plain_name(text) for place, text in enumerate(texts) if place not in columns}
    bare = [place for place, text in plain.items() if text in UNIT_NAMES]
    numeric = [place for place, (one, _) in columns.items() if one.unit in UNITS]
    for place, text in plain.items():
        of = re.sub(r"\b(?:units?|einheit|unita|unite|unidad)\b(?: of| de| di)?", "", text).strip()
        if place in bare or of == text:
            continue
        named = [k for k in numeric if plain_name(columns[k][0].name) == of or plain_name(texts[k]) == of]
        if of in SIZE_NAMES:
            named = [k for k in numeric if columns[k][0].unit == "m"]
        found |= dict.fromkeys(named, place)
    start = -1
    for place in bare:  # of several, each states those of the columns between it and the one before
        found |= {k: place for k in numeric if k not in found and (len(bare) == 1 or start < k < place)}
        start = place
    return found


def labels_of(texts: Sequence[str]) -> list[str]:
    """The texts of a header, with its number where one is empty or not the first."""
    first: dict[str, int] = {}
    return [
        text if text.strip() and first.setdefault(text, place) == place else f"{text}#{place + 1}"
        for place, text in enumerate(texts)
    ]
