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
        """True if a change of the motion by less than 20 % changes the verdict."""
        return self.values["factor"] is not None and abs(self.values["factor"] - 1.0) < CLOSE

    @property
    def overturns(self) -> bool:
        """True if a motion of the site overturns it."""
        return bool(self.values["share"] > 0.0)

    @property
    def at_full_strength(self) -> str:
        """Number of motions that overturn it at full strength, and of those that do so only at a lower factor."""
        full = round(self.events * self.values["share_at_full_strength"])
        below = round(self.events * self.values["share"]) - full
        text = f"{full} of {self.events}"
        return f"{text}, {below} only below" if below > 0 else text

    @property
    def concerns(self) -> bool:
        """True if it rocks, overturns, or is close to overturning."""
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
        """First step to take: fix or widen what overturns, measure what is in doubt, keep clear of what moves."""
        values = self.values
        if self.overturns:
            if self.wider is None:
                step = "fix it, or widen the base"
            elif self.wider > 0.0 and values["smallest_width"] <= WIDER * self.base:
                step = "widen the base, or fix it"
            else:
                step = "fix it"
            return f"measure the depth, then {step}" if self.object.depth_is_missing else step
        if self.object.depth_is_missing:
            return "measure the depth"
        if self.is_close:
            return "measure it again"
        if values["sliding"] is not None and rounded(values["sliding"], "m"):
            return f"keep {_clearance(values['sliding'])} clear: it slides"
        if rounded(values["displacement"], "m"):
            return f"keep {_clearance(values['displacement'])} clear"
        return "nothing"


def lines_of(assessment: Assessment, *, directions: bool = False, only: Line | None = None) -> list[Line]:
    """Lines of the objects, the worst first; with `directions` a line for each row of an object, below each other.

    With `only`, a line of an object, those of this object.
    """
    rows_of_objects: dict[int, list[int]] = {}
    for row, obj in enumerate(assessment.objects):
        rows_of_objects.setdefault(id(obj), []).append(row)
    all_values, motions = assessment.rows, assessment.site.motions
    lines = []
    for rows in rows_of_objects.values() if only is None else (only.rows,):
        for row in rows if directions else rows[:1]:
            obj, values = assessment.objects[row], all_values[row]
            pga = None
            if values["factor"] is not None:
                pga = motions[int(np.nanargmin(assessment.factors[row]))].ground * values["factor"]
            base = obj.planes[values["direction"]].base
            lines.append(Line(obj, rows, row, values, pga, base, assessment.events))
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
    if unit in PEOPLE:
        value /= UNITS[unit][PEOPLE[unit]]
    if abs(value) < SMALL.get(unit, 5e-4):
        return 0.0
    if unit == "-":
        digits = max(digits, digits_apart(value))
    short = float(f"{value:.{digits}g}")
    return round(short, 2) if unit == "m" else short


def text_of(value: Any, unit: str = "-", digits: int = 3) -> str:
    """A number, rounded, as text with its unit; a dash for what is not known."""
    text = number_of(value, unit, digits)
    if not isinstance(value, float) or value != value or unit in ("", "-"):
        return text
    return f"{text}\u00b0" if unit == "rad" else f"{text} {PEOPLE.get(unit, unit)}"


def number_of(value: Any, unit: str = "-", digits: int = 3) -> str:
    """A number, rounded, as text without its unit; a dash for what is not known."""
    if value is None or value != value:
        return "\u2013"
    return f"{rounded(value, unit, digits):.15g}" if isinstance(value, float) else str(value)


def table_of(assessment: Assessment, *, directions: bool = False) -> dict[str, list[Any]]:
    """The lines as columns, in the order of the questions."""
    lines = lines_of(assessment, directions=directions)
    labels: dict[str, None] = {}
    for line in lines:
        labels |= dict.fromkeys(line.object.details)
    columns: dict[str, list[Any]] = {}
    for label in labels:
        columns[label] = [_shortened(line.object.details.get(label, "")) for line in lines]

    def values_of(name: str) -> list[Any]:
        return [line.values[name] for line in lines]

    def rounded_or(missing: str, name: str, unit: str) -> list[Any]:
        return [missing if value is None else rounded(value, unit) for value in values_of(name)]

    columns["object"] = [_shortened(name) for name in values_of("object")]
    if directions:
        columns["direction"] = values_of("direction")
    columns["verdict"] = values_of("verdict")
    columns["overturns from factor"] = rounded_or(f"> {assessment.highest_factor:g}", "factor", "-")
    columns["at full strength by"] = [line.at_full_strength for line in lines]
    columns["PGA [g]"] = [rounded(line.pga, "m/s2", line.digits) for line in lines]
    columns["governing motion"] = [name.replace("_", " ") or "-" for name in values_of("governing")]
    columns["moves by [cm]"] = rounded_or("overturns", "displacement", "m")
    columns["base needed [cm]"] = [rounded(line.base_needed, "m") for line in lines]
    columns["wider by [cm]"] = [rounded(line.wider, "m") for line in lines]
    columns["what to do first"] = [line.first_step for line in lines]
    for clause in CLAUSES:
        ratios = [rounded(ratio) for ratio in values_of(f"{clause}_ratio")]
        if ratios != [None] * len(ratios):
            columns[f"{clause} ratio".replace("_", " ")] = ratios
    return columns


def counts_of(lines: Sequence[Line]) -> str:
    """Numbers of objects that the motions overturn at full strength, and only at a lower factor, in words."""
    full = sum(line.values["share_at_full_strength"] > 0.0 for line in lines)
    below = sum(line.overturns for line in lines) - full
    return f"overturned at full strength: {full} of {len(lines)} objects; only at a lower factor: {below}"


def warnings_of(assessment: Assessment) -> list[tuple[str, list[str]]]:
    """Kinds of warnings with the names of their objects, the most frequent first.

    The worse direction of an object decides if it is within 20 % of overturning.
    """
    texts: dict[str, set[str]] = {}
    concerned: dict[str, dict[int, str]] = {}
    worst = {line.row for line in lines_of(assessment)}
    for row, obj in enumerate(assessment.objects):
        for text in filter(None, assessment.columns["warnings"][row].split("; ")):
            kind = text.partition(": ")[0] if text.startswith(DETAILED) else text
            if row in worst or not text.startswith(WITHIN):
                texts.setdefault(kind, set()).add(text)
                concerned.setdefault(kind, {})[id(obj)] = obj.name
    warnings = []
    for kind, names in concerned.items():
        text = texts[kind].pop() if len(texts[kind]) == 1 else kind
        warnings.append((text, [*names.values()]))
    return sorted(warnings, key=lambda warning: -len(warning[1]))


def names_in_short(names: Sequence[str], limit: int = 5) -> str:
    """The first names, and the number of the others."""
    text = "; ".join(_shortened(name) for name in names[:limit])
    return f"{text}; and {len(names) - limit} more" if len(names) > limit else text


def _shortened(name: str) -> str:
    return name if len(name) <= LONGEST else f"{name[: LONGEST - 1].rstrip()}\u2026"
