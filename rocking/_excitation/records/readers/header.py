"""What the lines above the numbers of a file state: unit, time step, number of values, scale factor.

Settings are `key: value` or `key = value` with the full name of a key: `sampling rate: 100 Hz` is one, `Frequency
range: 0.2-25 Hz` and `original dt = 0.02` are none. Some sentences count as well, such as `IN UNITS OF G`. Where two
statements differ, neither is taken.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from rocking._base.cells import without_accents
from rocking._base.units import UNITS, unit_name
from rocking._excitation.records.readers.lines import NUMBER, TextFile, overruled

_SAMPLING = "muestreo|campionamento|amostragem|echantillonnage"

KEYS = {
    "unit": r"(the )?((data|accel\w*?|acc|amplitude|y|sample|record|signal|rotation|angle) ?)?"
    r"(units?|einheit(en)?|unites?|unita|unidad(e|es)?|eenheid|birim)"
    r"( (of|de|der|des|di) (the |los |las )?(ac[ce]el\w*|beschleunigung\w*|data|datos|samples|record|rotations?))?",
    "quantity": r"acc|accel|accelerations?|beschleunigung|rotations?",
    "step": r"dt|δt|d t|delta|delta t|step|"
    r"(time|sampling|sample|digiti[sz]ation) ?(step|interval|increment|spacing|period)s?|"
    r"(time )?interval between (samples|points)|equal(ly)? spac(ed|ing)( intervals?)?( of| at)?|equal intervals of|"
    r"(zeit|abtast)(schritt|intervall|schrittweite|periode)|passo temporale|ornekleme aral[iı]g[iı]|"
    rf"(pas|passo|paso|intervall?[eo]|period[eo]) (d |de |di )?(temps|tempo|tiempo|{_SAMPLING})",
    "rate": r"(sampling|samples?|frame|scan|acquisition|digiti[sz]ing|recording) ?(rate|freq|frequency)|fs|fps|sps|"
    r"(samples|frames|points) (per|/) ?(s|sec|second)|abtast(rate|frequenz)|bildrate|"
    r"ornekleme (frekans[iı]|h[iı]z[iı])|"
    rf"(fre[cq]uen[cz](e|a|ia)|tasa|taxa|taux|tasso|cadence|velocidad) (d |de |di )?({_SAMPLING})",
    "count": r"npts|npt|ndata|np|n|(number|num|no|nr|n°) ?(of|de|di)? ?(the )?"
    r"(points|samples|data( points)?|values|puntos|punti|muestras|campioni)|points|samples|"
    r"anzahl( der)? (werte|punkte|messwerte|abtastwerte)|nombre de (points|valeurs)|numero de (puntos|muestras)",
    "factor": r"((scale|scaling|calibration|conversion|multiplication) ?)?factor|scale|skalierungsfaktor|facteur",
}
"""Full names of settings, in lower case, without accents, signs, a unit in brackets and a symbol behind the words."""

_UNIT_TEXT = r"(?P<unit>[^\s,;:]+(?: ?/ ?[^\s,;:]+)*(?: ?[(\[][^()\[\]]*[)\]])?)"

SENTENCES = tuple(
    re.compile(pattern.replace(" ", " +").replace(" +?", " *"), re.I)
    for pattern in (
        r"\bunits? of (?!.*\b(?:is|are)\b)" + _UNIT_TEXT,
        r"\bunits?(?: of(?: \w+){1,3})? (?:is|are) (?P<unit>(?:(?:s|sec|seconds) and )?[^\s,;]+)",
        r"\bacc\w*\.?(?: (?:time|history|histories|series|values?|data|record))* (?:is |are |given )?in " + _UNIT_TEXT,
        r"\bequal(?:ly)?[ -]spac(?:ed|ing)(?: intervals?)?(?: (?:of|at))? (?P<step>[\d.]+ ?[a-z]+)",
        r"^(?P<count>\d+) points\b",
    )
)
"""Sentences with a setting."""

OTHER_SERIES = re.compile(r"^(?!.*\bacc).*\b(velocity|displacement)\s+(time|history|histories|series)\b", re.I)
"""A line that says what the numbers are if they are no accelerations."""

LONGEST_STEP = 0.5  # longest step of a record [s] that is taken without a unit
MAX_STATEMENT = 400  # characters at the start of a line in which settings are searched

_RATES = {"": 1.0, "hz": 1.0, "sps": 1.0, "fps": 1.0, "1/s": 1.0, "samples/s": 1.0, "samples/sec": 1.0, "khz": 1000.0}
_RATES |= dict.fromkeys(("muestras/s", "muestras por segundo", "campioni/s", "amostras/s", "samples/second"), 1.0)

_DECIMAL_COMMA = re.compile(r"[+-]?(?:0,\d+|\d+,(?:\d{1,2}|\d{4,}))", re.ASCII)
"""A number with a decimal comma that is no separator of thousands."""


class Statement(NamedTuple):
    """One statement: index of its line, its text, and what it says; None if it is not understood."""

    line: int
    text: str
    value: float | str | None


@dataclass(frozen=True)
class Header:
    """The statements of some lines, by what they state: unit, step [s], count, factor."""

    file: TextFile
    found: dict[str, list[Statement]] = field(default_factory=dict)

    def unit(self, given: str | None, expected: str = "a unit of acceleration: m/s2, cm/s2, gal, mm/s2 or g") -> Said:
        """The unit that is stated, without contradiction or with an argument that decides."""
        return self._agreed("unit", given, expected, "unit")

    def step(self, given: float | None) -> Said:
        """The time step [s], likewise."""
        return self._agreed("step", given, "a time step in s, or a rate in Hz", "time_step")

    def _agreed(self, name: str, given: object, expected: str, argument: str) -> Said:
        said = self.found.get(name, [])
        unknown = next((one for one in said if one.value is None), None)
        values = {*(_SAME.get(one.value, one.value) if isinstance(one.value, str) else one.value for one in said)}
        if given is not None and (unknown or len(values) > 1):
            if unknown and name == "unit":
                self.file.overruled.append(overruled(unknown.text, "unit", str(given)))
            return Said(None, None)  # the argument decides
        if unknown is not None:
            raise self.file.error(unknown.line, unknown.text, f"{expected}; or the argument `{argument}`")
        if len(values) > 1:
            other = next(one for one in said if one.value != said[0].value)
            first = f"{said[0].text!r} in line {said[0].line + 1}"
            allowed = f"one statement; or the argument `{argument}`"
            raise self.file.error(other.line, f"{other.text!r} and {first}", allowed)
        return Said(said[0].line, said[0].value) if said else Said(None, None)

    def remarks(self) -> tuple[str, ...]:
        """What is stated and not used."""
        factors = [one for one in self.found.get("factor", []) if one.value not in (1.0, None)]
        return tuple(f"the header states a factor, {one.text!r}, which is not applied" for one in factors)


class Said(NamedTuple):
    """The line and the value of an agreed statement; None if there is none."""

    line: int | None
    value: float | str | None


_SAME = {"gal": "cm/s2"}


def read_header(file: TextFile, lines: Sequence[str], quantity: str = "m/s2") -> Header:
    """What some lines from the first one state; `quantity` is that of the samples."""
    found = Header(file)
    for k, line in enumerate(lines):
        for name, text, value in _statements(line[:MAX_STATEMENT], quantity):
            found.found.setdefault(name, []).append(Statement(k, text, value))
    return found


def _statements(line: str, quantity: str) -> Iterator[tuple[str, str, float | str | None]]:
    """Name, text and value of what a line states."""
    for key, text in _pairs(line):
        key_unit = re.search(r"[(\[]([^()\[\]]*)[)\]]$", key)
        bare = without_accents((key[: key_unit.start()] if key_unit else key).lower())
        plain = re.sub(r"(?<=\w) (dt|fs)$", "", " ".join(re.findall(r"[^\W_]+|[/#°]", bare)))
        words, _, last = plain.rpartition(" ")
        for name, names in KEYS.items():
            in_key = key_unit[1] if key_unit else ""
            of_time = name in ("step", "rate") and (unit_name(last, "s") or last in _RATES)
            if of_time and re.fullmatch(names, words):  # such as time_step_ms
                plain, in_key = words, last
            if re.fullmatch(names, plain):
                yield from _setting(name, f"{key}: {text}", text, in_key, quantity)
    plain = line.strip("#%!*/\"' ")
    for pattern in SENTENCES:
        found = pattern.search(plain)
        if found and not re.search(r"[:=]", plain[: found.start()]):
            ((name, text),) = found.groupdict().items()
            if name != "unit" or (quantity == "m/s2" and (pattern in SENTENCES[:2] or units_in(text))):
                yield from _setting(name, text, text, "", quantity)


def _setting(
    name: str, shown: str, text: str, in_key: str, quantity: str
) -> Iterator[tuple[str, str, float | str | None]]:
    """The statement of a setting whose name is known."""
    if name in ("unit", "quantity"):
        value = units_in(text, quantity)
        if value is not None or (name == "unit" and unit_name(text.strip(" ."), "s") is None):
            yield "unit", shown, value
    elif name in ("step", "rate"):
        number, unit = _number(text)
        agree = not in_key or not unit or unit.lower() == in_key.lower()
        unit = unit or in_key
        scale = (_RATES.get(unit.lower().strip(" .")) if name == "rate" else _seconds(unit)) if number else None
        step = 0.0
        if number and scale and agree:
            step = number * scale if name == "step" else 1.0 / (number * scale)
        if not re.search(r"\((raw|orig\w*|before\b.*)\)", text, re.I):
            yield "step", shown, step if step and (unit or step <= LONGEST_STEP) else None
    else:
        number, unit = _number(text)
        if number and not unit:
            yield name, shown, number


def _seconds(unit: str) -> float | None:
    name = unit_name(unit or "s", "s")
    return None if name is None else UNITS["s"][name]


def _number(text: str) -> tuple[float | None, str]:
    """A positive number and what follows it up to a sign of separation; None if it does not start with one."""
    found = re.match(rf"({_DECIMAL_COMMA.pattern}|{NUMBER.pattern})(?![\d.,]*\d|[+-])", text.strip(), re.ASCII)
    if found is None:
        return None, ""
    value = float(found[1].replace(",", ".").translate(str.maketrans("Dd", "Ee")))
    unit = re.split(r"[,;|(\t]", text.strip()[found.end() :])[0]
    return (value if 0.0 < value < float("inf") else None), unit.strip().strip("[].")


def _pairs(line: str) -> Iterator[tuple[str, str]]:
    """Keys and values of a line such as `station: ABC, dt = 0.01 s unit: g`.

    Between two colons or equals signs are a value and the next key: after a separator or several blanks, or after one
    word or a number with its unit.
    """
    key, *rest = re.split(r"[:=]", line.strip("#%!*/\"' ,;"))
    key = re.split(r"[,;|\t]| {2,}", key.strip())[-1]
    for k, part in enumerate(rest, 1):
        value, following = part.strip(), ""
        if k < len(rest):
            parts = [*filter(None, re.split(r"[;|\t]|,(?!\d)| {2,}", value))]
            if len(parts) > 1:
                value, following = parts[0], parts[-1]
            elif found := re.fullmatch(rf"({NUMBER.pattern} ?(?:s|sec|ms|hz|sps)?|\S+) (\D.*)", value, re.I | re.ASCII):
                value, following = found[1], found[2]
        if key.strip() and value:
            yield key.strip(), value.strip()
        key = following


def units_in(text: str, quantity: str = "m/s2") -> str | None:
    """The one unit of a quantity in a text such as `G`, `gal(cm/s/s)`, `sec and g .`; None for none or for several."""
    whole = unit_name(text.strip(" .;,"), quantity)
    if whole or re.search(r"\d\s*[*x×]|[*x×]\s*\d|\b(per|times|counts?|volts?)\b", text, re.I):
        return whole
    parts = [part.strip(" .()[]") for part in _BETWEEN_UNITS.split(text)]
    names = {part: unit_name(part, quantity) for part in parts if part}
    values = {UNITS[quantity][name] for name in names.values() if name}
    unknown = [part for part, name in names.items() if not name and not unit_name(part, "s")]
    harmless = all(re.fullmatch(r"(?!\s*[\d.+-])[^/*×]*", part) for part in unknown)
    return next(filter(None, names.values())) if len(values) == 1 and harmless else None


_BETWEEN_UNITS = re.compile(r"[,;|&]|\.\s|\b(?:and|und|et|e|y|or)\b|(?<=\w)(?=[(\[])|\s{2,}|\s(?=[(\[])|[)\]]\s*", re.I)
