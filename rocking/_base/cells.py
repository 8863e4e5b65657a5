"""How the header, the units and the cells of a table are read as declared quantities."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterator, Mapping

from rocking._base.errors import InvalidArgumentError
from rocking._base.quantity import Quantity
from rocking._base.units import MAX_LENGTH, UNITS, USUAL, quantities_of, unit_name

_UNIT = re.compile(r"[\[(]([^\[\]()]*)[\])]\s*$|[,/:]\s*([^\s,/:]{1,8})\s*$|\bin\s+([^\s,/]{1,12})\s*$")
_LAST = re.compile(r"[\s_]+([^\s_()\[\]]{1,12})\s*$")
_PARTS = re.compile(r"[/|,;:()\[\]=]")
_ROUND = re.compile(r"(?<!\w)[\u00d8\u00f8\u2300\u2205\u03a6\u03c6](?!\w)")
_SIGNS = re.compile('[%\u2030\u00b0"\u2033$\u20ac\u00a3]')
_GAP = r"[\s'\u2019]"
_NUMBER = re.compile(
    r"\s*([+-]?[0-9][0-9.,'\u2019 \u00a0\u202f]*|[+-]?[.,][0-9]+)((?:(?<=[0-9.,])e[+-]?[0-9]+)?)\s*(.*?)\s*",
    re.DOTALL | re.IGNORECASE,
)
_WIDE = {0x3000: " "} | {code: code - 0xFEE0 for code in range(0xFF01, 0xFF5F)}
_FRACTION_SIGN = re.compile("[\u00bc-\u00be\u2150-\u215e]")
_FEET = re.compile(r"(\d+)\s*(?:['\u2032\u2019]|ft\.?|feet|foot)[\s,-]*(\d.*)", re.ASCII | re.IGNORECASE)
_INCHES = re.compile(r"(\d\d?(?:\.\d+)?)\s*(\D+)", re.ASCII)
_FRACTION = re.compile(r"(?:(\d+)[\s-]+)?(\d+)/(\d+)\s*(\D*)", re.ASCII)
_THOUSANDS = re.compile(rf"[+-]?\d{{1,3}}(?:{_GAP}\d{{3}})+(?:[.,]\d*)?")
_ONE = ", and no other text; of a range or an estimate the value to assess"
_GROUPS = re.compile(r"[+-]?\d{1,3}(?:[.,]\d{3})+")


def rank(one: Quantity, header: str) -> int:
    """Place of the name in a header among the names of a quantity, the best one first."""
    names = one.names
    found = [plain_name(name) for name, _, _ in _splits(header)]
    return min((names.index(name) for name in found if name in names), default=len(names))


def read_cell(one: Quantity, cell: str, unit: str, decimal: str) -> float | str:
    """The value of a cell in SI units; the text of a column of texts as it stands.

    `unit`: of cells without one, as `unit_name` gives it; `decimal`: the decimal sign of the table, which settles
    "1,234"; each "" if unknown. Raises `InvalidArgumentError` if the cell is no number, its decimal sign is not
    certain, or its unit is unknown.
    """
    if not one.unit:
        return cell
    text = cell.strip().removeprefix("'")  # of a spreadsheet's text
    decimal = "" if text != cell.strip() else decimal
    text = _without_fraction(text, unit)
    if text.lower().partition("(")[0].rstrip() in one.words:
        return text.lower()
    found = _NUMBER.fullmatch(text) if len(text) <= MAX_LENGTH else None
    if not found:
        allowed = f"a number, with its unit or with one in the header{_ONE if re.search(r'[0-9]', text) else ''}"
        raise InvalidArgumentError(one.name, text[:MAX_LENGTH], allowed)
    number = _number(one.name, found[1].strip(), found[2], text, decimal)
    written = unit_name(found[3], one.unit) if found[3] else unit or one.assumed
    if written is None:
        more = _ONE if re.search(r"[0-9?~*(\u00b1]|\b(?:est|ca|max|min|approx)\b", found[3]) else ""
        raise InvalidArgumentError(one.name, text, f"a unit such as {', '.join(UNITS[one.unit])}{more}")
    if not written and one.unit in USUAL and number:
        usual = USUAL[one.unit][-1]
        allowed = f"a unit: write {one.name} [{usual}] in the header, or {text} {usual} in the cell"
        raise InvalidArgumentError(one.name, text, allowed)
    if written == "%" and not found[3] and 0.0 < abs(number) <= 1.0:
        raise InvalidArgumentError(one.name, text, f"a percentage above 1: is it {text} %, or {text}?")
    value = number * UNITS[one.unit].get(written, 1.0) * one.times
    if one.unit == "-" and value > one.upper:
        raise InvalidArgumentError(one.name, text, f"at most {one.upper:g}; a percentage has its sign, {text} %")
    return value


def _number(name: str, written: str, exponent: str, text: str, decimal: str) -> float:
    """The number of digits with signs, and of an exponent."""
    if re.search(_GAP, written) and not _THOUSANDS.fullmatch(written):
        allowed = "one number, with blanks between thousands only, or with its unit, as 31 1/2 in"
        raise InvalidArgumentError(name, text, allowed)
    digits = re.sub(_GAP, "", written)
    own = decimal_sign(digits) or ""
    if own.startswith("?") and not decimal:
        allowed = "a number whose decimal sign is certain, such as 1.2340 or 1234"
        raise InvalidArgumentError(name, text, allowed)
    point = decimal if own.startswith("?") else own or decimal or "."
    other = "," if point == "." else "."
    if not re.fullmatch(rf"[+-]?(\d*|\d{{1,3}}(?:{re.escape(other)}\d{{3}})+)(?:{re.escape(point)}\d*)?", digits):
        raise InvalidArgumentError(name, text, f"a number with the decimal sign {point!r}")
    return float(digits.replace(other, "").replace(point, ".") + exponent)


def decimal_sign(digits: str) -> str:
    """The decimal sign of a number without blanks: ".", ",", with "?" before it if it may separate thousands, or ""."""
    used = [sign for sign in digits if sign in ".,"]
    if not used:
        return ""
    last = used[-1]
    before, after = digits.rsplit(last, 1)
    if len(set(used)) == 2:
        return last
    if len(used) > 1:
        return ("," if last == "." else ".") if _GROUPS.fullmatch(digits) else ""
    return f"?{last}" if len(after) == 3 and re.fullmatch(r"[+-]?[1-9]\d{0,2}", before) else last


def split_number(cell: str, unit: str = "") -> tuple[str, str] | None:
    """The digits of a cell that starts with a number, without blanks, and what follows; None for other cells.

    `unit`: the unit of a fraction that states none.
    """
    found = _NUMBER.fullmatch(_without_fraction(cell, unit)) if len(cell) <= MAX_LENGTH else None
    return (re.sub(_GAP, "", found[1]), found[3]) if found else None


def half_width(text: str) -> str:
    """A text with the letters, digits and signs of ASCII in place of the wide ones of East Asian scripts."""
    return text.translate(_WIDE)


def _without_fraction(text: str, unit: str = "") -> str:
    """A text in half width, with feet and inches or a fraction of inches as decimal inches; `unit`: of its header.

    The sign \u00bd and its kin are fractions of any unit; 30/40 is no fraction.
    """
    text = half_width(text)
    plain = (
        _FRACTION_SIGN.sub(lambda one: f" {unicodedata.normalize('NFKC', one[0])}", text).replace("\u2044", "/").strip()
    )
    feet = _FEET.fullmatch(plain)
    rest = feet[2] if feet else plain
    if found := _FRACTION.fullmatch(rest):
        whole, upper, lower, written = int(found[1] or 0), int(found[2]), int(found[3]), found[4]
        of_inches = upper % 2 == 1 and lower in (2, 4, 8, 16, 32, 64) and unit_name(written or unit, "m") == "in"
        if not upper < lower or not (of_inches or _FRACTION_SIGN.search(text)):
            return text
        number = whole + upper / lower
    elif feet and (found := _INCHES.fullmatch(rest)):
        number, written = float(found[1]), found[2]
    else:
        return text
    if feet and not (number < 12.0 and unit_name(written, "m") == "in"):
        return text
    return f"{number + 12 * int(feet[1] if feet else 0):.10f} {written}"


def is_symbol(text: str) -> bool:
    """Whether a header is a letter with a unit of another quantity than a length, such as "p (1/s)"."""
    name, unit = name_and_unit(text)
    return len(plain_name(name)) == 1 and unit != "min" and bool(quantities_of(unit) - {"m"})


def plain_name(text: str) -> str:
    """A name in small letters, without accents, signs and doubled blanks; the sign of a diameter is its word."""
    text = _ROUND.sub(" diameter ", re.sub(r"\bma\u00dfe?\b", "abmessungen", text, flags=re.IGNORECASE)).replace(
        "\u00df", "ss"
    )
    bare = re.sub(r"[^0-9a-z\u0370-\u03ff\u3040-\u30ff\u4e00-\u9fff]+", " ", without_accents(text.lower()))
    return " ".join(bare.split())


def without_accents(text: str) -> str:
    """A text without the marks above and below its letters."""
    return "".join(one for one in unicodedata.normalize("NFKD", text) if not unicodedata.combining(one))


def name_and_unit(text: str) -> tuple[str, str]:
    """The parts of a header; "" without a unit."""
    text = half_width(text)
    found = _UNIT.search(text)
    return (text[: found.start()], next(filter(None, found.groups()), "").strip()) if found else (text, "")


def _splits(text: str) -> Iterator[tuple[str, str, bool]]:
    """Ways to divide a header into name and unit, and whether what follows the name must be a unit."""
    name, written = name_and_unit(text)
    text = half_width(text)
    if written or name != text:
        yield name, written, True
    if last := _LAST.search(text):
        yield text[: last.start()], last[1], False
    yield text, "", True


def named(text: str, names: Mapping[str, Quantity]) -> Quantity | None:
    """The column of a name, which may be there twice: "Breite / width", "Height (H)"."""
    plain = plain_name(text).removeprefix("dimensions ")
    if plain in names:
        return names[plain]
    first, _, last = plain.rpartition(" ")
    for parts in ([part for part in map(plain_name, _PARTS.split(text)) if part], [first, last]):
        found = [names.get(part) for part in parts]
        if len(parts) > 1 and found[0] is not None and all(one is found[0] for one in found):
            return found[0]
    return None


def read_header(text: str, names: Mapping[str, Quantity], argument: str) -> tuple[Quantity, str] | None:
    """The quantity that a header such as "Breite (cm)" or "depth_mm" names, and its unit or ""; None if it names none.

    `names`: quantities by their names and aliases, as `plain_name` gives them; `argument`: what an error calls the
    table. Raises `InvalidArgumentError` if the unit of a quantity is not understood.
    """
    for name, written, must in _splits(text):
        one = named(name, names)
        if one is None:
            continue
        if one.unit not in UNITS and must:
            return one, ""
        if one.unit not in UNITS:  # "room name" is no room
            continue
        stated = written or name if _SIGNS.search(name) else written
        known = unit_name(stated, one.unit) if stated else ""
        if known is None and named(stated, names) is one:  # its symbol, such as "friction (mu)"
            known = ""
        if known is not None:
            return one, known
        if is_symbol(text) or (must and named(stated, names)):  # the ratio "h/b"
            return None
        if must:
            raise InvalidArgumentError(f"{argument}, header", text, f"a unit such as {', '.join(UNITS[one.unit])}")
    return None


def stated_unit(text: str, unit: str) -> str | None:
    """The unit that a header states, of any name, if it is one of a quantity, such as "m"."""
    for _, written, must in _splits(text):
        known = unit_name(written, unit) if written else None
        if known and (must or written.lower() not in ("m", "in") or "_" in text):  # "Made in" has no unit
            return known
    return None
