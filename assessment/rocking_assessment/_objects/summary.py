"""An assessment in brief: one line an object, in cm, degrees and g, and the warnings by kind."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from rocking.extension import UNITS
from rocking_assessment._objects.columns import CLAUSES, CLOSE, RESTS_AT_FULL_STRENGTH, digits_apart
from rocking_assessment._objects.objects import Object
from rocking_assessment._objects.result import Assessment

PEOPLE = {"m": "cm", "rad": "deg", "m/s2": "g"}  # units that people use, by the SI unit
SMALL = {"m": 0.05, "rad": 0.05}  # numbers in such a unit below which they are written as 0, others below 0.0005

WITHIN = "within 20 %"

DETAILED = (
    WITHIN,
    RESTS_AT_FULL_STRENGTH,
    "slides before it rocks",
    "may slide while it rocks",
    "the hazard curve does not",
)
"""Beginnings of warnings whose numbers, behind a colon, differ from object to object."""

LONGEST = 40  # characters of a name on a screen, and in a warning [-]
WIDER = 1.5  # largest ratio of the base needed to the present one at which a wider base is proposed [-]


@dataclass(frozen=True)
class Line:
    """One object, with its rows of an assessment."""

    object: Object
    rows: list[int]  # of the assessment of this object, the worse direction first
    row: int  # that of this line
    values: dict[str, Any]  # that row, by the names of the columns
    pga: float | None  # peak ground acceleration from which it overturns [m/s2]
    base: float  # in this direction [m]
    events: int  # motions of the site, a pair of components as one [-]

    @property
    def is_close(self) -> bool:
        """Whether a change of the motion by less than 20 % changes the verdict."""
        return self.values["factor"] is not None and abs(self.values["factor"] - 1.0) < CLOSE

    @property
    def overturns(self) -> bool:
        return bool(self.values["share"] > 0.0)

    @property
    def at_full_strength(self) -> str:
        """How many motions overturn it at full strength, and how many only at a lower factor."""
        names = "share_at_full_strength", "share"
        full, counted = (round(self.events * self.values[name]) for name in names)
        return f"{full} of {self.events}" + (f", {counted - full} only below" if counted > full else "")

    @property
    def concerns(self) -> bool:
        """Whether it rocks, overturns, or is close to overturning."""
        return self.values["verdict"] != "stays" or self.is_close

    @property
    def wider(self) -> float | None:
        """Width that the base lacks [m], rounded up to a tenth of a millimetre."""
        needed = self.values["smallest_width"]
        if needed is None:
            return None
        return _rounded_up(needed - self.base) if needed > self.base else 0.0

    @property
    def base_needed(self) -> float | None:
        """Smallest base that suffices [m], rounded up: one that is rounded down could overturn."""
        needed = self.values["smallest_width"]
        return None if needed is None else _rounded_up(needed)

    @property
    def digits(self) -> int:
        """Significant digits of the factor and of the PGA that belongs to it."""
        factor = self.values["factor"]
        return 3 if factor is None else digits_apart(factor)

    @property
    def first_step(self) -> str:
        """What to do first."""
        if not self.object.depth_is_missing:
            return self._step_with_depth
        return f"measure the depth, then {self._step_with_depth}" if self.overturns else "measure the depth"

    @property
    def _step_with_depth(self) -> str:
        row = self.values
        if self.overturns and self.wider and row["smallest_width"] <= WIDER * self.base:
            return "widen the base, or fix it"
        if self.overturns:
            return "fix it, or widen the base" if self.wider is None else "fix it"
        if self.is_close:
            return "measure it again"
        if row["sliding"] is not None and rounded(row["sliding"], "m"):
            return f"keep {_clearance(row['sliding'])} clear: it slides"
        if rounded(row["displacement"], "m"):
            return f"keep {_clearance(row['displacement'])} clear"
        return "nothing"


def lines_of(found: Assessment, *, directions: bool = False, only: Line | None = None) -> list[Line]:
    """One line for each object, the worst first; with `directions` one for each of its rows, below each other.

    `only` is a line of the object that is wanted.
    """
    own: dict[int, list[int]] = {}
    for k, one in enumerate(found.objects):
        own.setdefault(id(one), []).append(k)
    all_values, motions = found.rows, found.site.motions
    lines = []
    for rows in own.values() if only is None else (only.rows,):
        for k in rows if directions else rows[:1]:
            one, values = found.objects[k], all_values[k]
            ground = None if values["factor"] is None else motions[int(np.nanargmin(found.factors[k]))].ground
            pga = None if ground is None else ground * values["factor"]
            lines.append(Line(one, rows, k, values, pga, one.planes[values["direction"]].base, found.events))
    return lines


def _rounded_up(length: float) -> float:
    """A length [m] rounded up to three digits, at most to a tenth of a millimetre [m]."""
    step = max(10.0 ** (math.floor(math.log10(length)) - 2), 1e-4)
    return math.ceil(length / step - 1e-9) * step


def _clearance(movement: float) -> str:
    """The distance to keep clear for a movement [m], rounded up to whole millimetres, from 10 cm on to centimetres."""
    step = 0.001 if movement < 0.1 else 0.01
    return f"{100.0 * step * math.ceil(movement / step - 1e-9):.10g} cm"


def rounded(value: Any, unit: str = "-", digits: int = 3) -> Any:
    """A number in the unit of the output, to three digits; a small one is 0. Other values are returned unchanged.

    A ratio is written as 1 only if it equals 1; a length in cm has two decimals at most.
    """
    if not isinstance(value, float):
        return value
    shown = value / UNITS[unit][PEOPLE[unit]] if unit in PEOPLE else value
    if abs(shown) < SMALL.get(unit, 5e-4):
        return 0.0
    if unit == "-":
        digits = max(digits, digits_apart(shown))
    short = float(f"{shown:.{digits}g}")
    return round(short, 2) if unit == "m" else short


def text_of(value: Any, unit: str = "-", digits: int = 3) -> str:
    """The same as text with its unit; a dash for what is not known."""
    sign = {"rad": "\u00b0"}.get(unit, f" {PEOPLE.get(unit, unit)}" if unit not in ("", "-") else "")
    return number_of(value, unit, digits) + (sign if isinstance(value, float) and value == value else "")


def number_of(value: Any, unit: str = "-", digits: int = 3) -> str:
    """The same without its unit."""
    if value is None or value != value:
        return "\u2013"
    return f"{rounded(value, unit, digits):.15g}" if isinstance(value, float) else str(value)


def table_of(found: Assessment, *, directions: bool = False) -> dict[str, list[Any]]:
    """The lines as columns, in the order of the questions."""
    lines = lines_of(found, directions=directions)
    top = f"> {found.highest_factor:g}"

    def column(name: str) -> list[Any]:
        return [one.values[name] for one in lines]

    columns: dict[str, list[Any]] = {}
    for label in dict.fromkeys(label for line in lines for label in line.object.details):
        columns[label] = [_shortened(line.object.details.get(label, "")) for line in lines]
    columns["object"] = [_shortened(name) for name in column("object")]
    if directions:
        columns["direction"] = column("direction")
    clauses = {
        clause.replace("_", " "): [rounded(one) for one in column(f"{clause}_ratio")]
        for clause in CLAUSES
        if any(one.values[f"{clause}_ratio"] is not None for one in lines)
    }
    return columns | {
        "verdict": column("verdict"),
        "overturns from factor": [top if one is None else rounded(one) for one in column("factor")],
        "at full strength by": [one.at_full_strength for one in lines],
        "PGA [g]": [None if one.pga is None else rounded(one.pga, "m/s2", one.digits) for one in lines],
        "governing motion": [one.replace("_", " ") or "-" for one in column("governing")],
        "moves by [cm]": ["overturns" if one is None else rounded(one, "m") for one in column("displacement")],
        "base needed [cm]": [rounded(one.base_needed, "m") for one in lines],
        "wider by [cm]": [rounded(one.wider, "m") for one in lines],
        "what to do first": [one.first_step for one in lines],
        **clauses,
    }


def counts_of(lines: Sequence[Line]) -> str:
    """How many objects the motions overturn at full strength, and how many only at a lower factor, in words."""
    overturned = [line.values["share_at_full_strength"] > 0.0 for line in lines if line.overturns]
    full, below = sum(overturned), len(overturned) - sum(overturned)
    return f"overturned at full strength: {full} of {len(lines)} objects; only at a lower factor: {below}"


def warnings_of(found: Assessment) -> list[tuple[str, list[str]]]:
    """Each kind of warning with the names of its objects, the most frequent first.

    Whether an object is within 20 % of overturning is that of its worse direction.
    """
    texts: dict[str, set[str]] = {}
    concerned: dict[str, dict[int, str]] = {}
    worst = {one.row for one in lines_of(found)}
    for k, (one, warnings) in enumerate(zip(found.objects, found.columns["warnings"].tolist(), strict=True)):
        for text in filter(None, warnings.split("; ")):
            kind = text.partition(": ")[0] if text.startswith(DETAILED) else text
            if k in worst or not text.startswith(WITHIN):
                texts.setdefault(kind, set()).add(text)
                concerned.setdefault(kind, {})[id(one)] = one.name
    found_kinds = [
        (texts[kind].pop() if len(texts[kind]) == 1 else kind, [*names.values()]) for kind, names in concerned.items()
    ]
    return sorted(found_kinds, key=lambda pair: -len(pair[1]))


def names_in_short(names: Sequence[str], most: int = 5) -> str:
    """The first names, and how many more there are."""
    return "; ".join(map(_shortened, names[:most])) + (f"; and {len(names) - most} more" if len(names) > most else "")


def _shortened(name: str) -> str:
    return name if len(name) <= LONGEST else f"{name[: LONGEST - 1].rstrip()}\u2026"
