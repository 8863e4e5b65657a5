"""Names of units, for quantities that people type and for the headers of files.

A unit is looked up by its name and never evaluated. The case of its letters does not matter: no two units of one
quantity differ by it. Blanks, brackets, underscores and the signs of a power may be written or left out, so that
"m/s^2", "m/s**2", "M/S2", "m s-2" and "(m/s²)" are one unit.
"""

from __future__ import annotations

import math
import re
from typing import Any, Protocol

from numpy.typing import ArrayLike

from rocking._base.constants import STANDARD_GRAVITY


class WithUnit(Protocol):
    """A number with a unit, or several, as the library pint has them."""

    def to(self, unit: Any, /) -> Any:
        """Convert to another unit."""


Scalar = float | str | WithUnit
"""A number in the SI unit, a text such as "40 cm", or a quantity."""
Values = ArrayLike | WithUnit  # the same, or an array

UNITS: dict[str, dict[str, float]] = {
    "m": {"m": 1.0, "cm": 0.01, "mm": 0.001, "km": 1000.0, "in": 0.0254, "ft": 0.3048},
    "m/s": {"m/s": 1.0, "cm/s": 0.01, "mm/s": 0.001, "in/s": 0.0254, "ft/s": 0.3048},
    "m/s2": {
        "m/s2": 1.0,
        "cm/s2": 0.01,
        "gal": 0.01,
        "mm/s2": 0.001,
        "g": STANDARD_GRAVITY,
        "mg": STANDARD_GRAVITY / 1000.0,
        "%g": STANDARD_GRAVITY / 100.0,
        "g/10": STANDARD_GRAVITY / 10.0,
        "in/s2": 0.0254,
        "ft/s2": 0.3048,
    },
    "s": {"s": 1.0, "ms": 0.001, "us": 1e-6, "min": 60.0},
    "rad": {"rad": 1.0, "deg": math.pi / 180.0, "mrad": 0.001},
    "rad/s": {"rad/s": 1.0, "deg/s": math.pi / 180.0},
    "-": {"-": 1.0, "%": 0.01},
    "N": {"N": 1.0, "kN": 1000.0},
    "N/m": {"N/m": 1.0, "N/mm": 1000.0, "kN/m": 1000.0, "MN/m": 1e6},
    "N s/m": {"N s/m": 1.0, "kN s/m": 1000.0, "MN s/m": 1e6},
    "kg": {
        "kg": 1.0,
        "g": 0.001,
        "t": 1000.0,
        "lb": 0.45359237,
        "oz": 0.45359237 / 16.0,
        "N": 1.0 / STANDARD_GRAVITY,
        "kN": 1000.0 / STANDARD_GRAVITY,
    },
}
"""Units of each quantity, by its SI unit, with their values in that unit; a weight is that of a mass under g."""

EXAMPLES = {
    "m": "0.3 m, 30 cm",
    "m/s": "0.5 m/s, 50 cm/s",
    "m/s2": "4 m/s^2, 0.4 g, 400 gal",
    "s": "0.5 s, 500 ms",
    "rad": "20 deg, 0.35 rad",
    "rad/s": "2.5 rad/s",
    "kg": "45 kg, 100 lb",
    "N": "500 N, 2 kN",
    "N/m": "50 kN/m, 5e4 N/m",
    "N s/m": "4 kN s/m, 4000 N s/m",
}
"""Quantities that an error proposes."""

USUAL = {
    "m": ("m",),
    "m/s": ("m/s",),
    "m/s2": ("m/s2", "g"),
    "s": ("s",),
    "rad": ("deg",),
    "rad/s": ("rad/s",),
    "kg": ("kg",),
    "N": ("N",),
    "N/m": ("N/m",),
    "N s/m": ("N s/m",),
}
"""The units that an error proposes where there is none."""

MAX_LENGTH = 64  # longest text that is read as a quantity or a unit [characters]

_OTHER_NAMES = {  # as `_plain` leaves them: millis are milliseconds
    "m": ("metre", "metres", "meter", "meters", "metri", "metros"),
    "cm": ("centimetre", "centimetres", "centimeter", "centimeters", "cms", "zentimeter", "centimetri", "centimetros"),
    "mm": ("millimetre", "millimetres", "millimeter", "millimeters", "millimetri", "milimetros"),
    "km": ("kilometre", "kilometres", "kilometer", "kilometers"),
    "in": ("inch", "inches", "zoll", "pouces", "pollici", "pulgadas", '"', "''", "\u2033", "\u201d"),
    "ft": ("foot", "feet", "'", "\u2032", "\u2019"),
    "gal": ("gals",),
    "g": ("gs", "gravity"),  # of accelerations
    "mg": ("milli-g", "millig"),
    "%g": ("percentg", "%ofg", "percentofg"),
    "ms": ("millis",),
    "us": ("\u00b5s", "\u03bcs", "micros"),
    "min": ("minute", "minutes"),
    "rad": ("radian", "radians"),
    "deg": ("degree", "degrees", "°"),
    "%": ("percent", "prozent", "pct"),
    "-": ("1", "\u2013", "dimensionless"),
    "kg": ("kgs", "kilo", "kilos", "kilogram", "kilograms", "kilogramme", "kilogrammes", "kilogramm"),
    "t": ("tonne", "tonnes", "tonnen"),
    "lb": ("lbs", "pound", "pounds"),
    "oz": ("ounce", "ounces"),
    "N": ("newton", "newtons"),
    "kN": ("kilonewton", "kilonewtons"),
}
_NUMBER = re.compile(r"[+-]?(?:\d+(?:\.\d*)?|\.\d+)(?:e[+-]?\d+)?", re.ASCII | re.IGNORECASE)


def _forms(name: str) -> tuple[str, ...]:
    """Return the ways to write a unit, as `_plain` leaves them."""
    if " " in name:
        return (name.replace(" ", ""),)
    length, _, time = name.partition("/")
    if time == "s2":
        return (name, f"{length}/s/s", f"{length}s-2", f"{length}/s-2", f"{length}s2")
    if name == "rad/s":
        return (name, "rads-1", "1/s", "s-1")
    return (name, f"{length}s-1") if time == "s" else (name, *_OTHER_NAMES.get(name, ()))


_SIGNS = str.maketrans("¹²⁻−", "12--")  # signs of powers, and the minus sign of mathematics


def _plain(text: str) -> str:
    """Return a unit in lower case without what may be left out, a full stop included; second is s."""
    plain = re.sub(r"\*\*|\*(?=\s*s-)|[\s_^()\[\]·⋅]", "", text.lower().translate(_SIGNS))
    return re.sub(r"sec(?:ond)?s?", "s", plain).rstrip(".")


def _names(unit: str) -> dict[str, str]:
    """Return the names of the units of a quantity by the ways to write them."""
    names: dict[str, str] = {}
    for name in UNITS[unit]:
        names |= dict.fromkeys(map(str.lower, _forms(name)), name)
    return names


_NAMES = {unit: _names(unit) for unit in UNITS}
_NAMES["kg"] |= dict.fromkeys(("gram", "grams", "gramme", "grammes", "gramm"), "g")


def unit_name(text: str, unit: str) -> str | None:
    """Return the name in `UNITS` of a unit such as "M/S^2"; None if the quantity with the SI unit `unit` lacks it."""
    return _NAMES[unit].get(_plain(text)) if len(text) <= MAX_LENGTH else None


def quantities_of(text: str) -> frozenset[str]:
    """Return the SI units of the quantities that have a unit such as "M/S^2"."""
    if len(text) > MAX_LENGTH:
        return frozenset()
    form = _plain(text)
    return frozenset(unit for unit, names in _NAMES.items() if form in names)


def split_quantity(text: str) -> tuple[float, str] | None:
    """Return the number that a text starts with, and what follows; None if it starts with none, or is too long."""
    text = text.strip()
    match = _NUMBER.match(text) if len(text) <= MAX_LENGTH else None
    if match is None:
        return None
    return float(match[0]), text[match.end() :].strip()
