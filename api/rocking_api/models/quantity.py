"""Fields of pydantic from the declarations of quantities, and the inputs that several routes share.

The ranges of the service lie inside those of the library, far outside of practice: searches around a point, and points
shifted by rounding for the error bound, stay in the latter.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Annotated, Any, Literal

from pydantic import (
    AfterValidator,
    BeforeValidator,
    Field,
    ValidationError,
    ValidatorFunctionWrapHandler,
    WrapValidator,
)
from pydantic.fields import FieldInfo
from pydantic_core import PydanticCustomError

import rocking._base.quantities as q
from rocking._base.quantity import Quantity
from rocking._base.units import UNITS as QUANTITIES
from rocking._base.units import split_quantity
from rocking._excitation.pulses import PULSE_NAMES, as_pulse, pulse_names, pulse_parameters
from rocking._excitation.records.processing import MAX_BASELINE_ORDER
from rocking._excitation.records.readers.layout import MAX_SKIP
from rocking._excitation.records.readers.read_record import FORMATS
from rocking._excitation.records.record import TIME_STEP, UNITS
from rocking._model.checks import impact_share

SLENDERNESS = q.SLENDERNESS.restricted(1e-9, math.inf)
FREQUENCY_RATIO = q.FREQUENCY_RATIO.restricted(1e-6, 1e6)
ALPHA_DEG = q.ALPHA.in_degrees().restricted(1e-6, 89.9)

SCALES = 1e-6, q.HIGHEST_SCALE  # smallest and largest factor of a record [-]


def described(quantity: Quantity, text: str = "", *, unit: str = "", **more: Any) -> Any:
    """What the declaration says of a field: meaning, unit and range in the schema; `more` are those of `Field`."""
    text = f"{text} [{unit or quantity.unit}]" if text else quantity.help
    extra: dict[str, Any] = {"unit": unit or quantity.unit, **quantity.limits}
    return Field(description=text, json_schema_extra=extra, **more)


def read_as(quantity: Quantity, text: str = "", kind: Any = float, **more: Any) -> Any:
    """A field that is read and checked by a declaration: a number in its unit, or a text with another one."""

    def read(value: Any) -> Any:
        return value if value is None else quantity.read(value, si=True)

    return Annotated[kind, BeforeValidator(read), described(quantity, text, **more)]


def said(text: str, default: Any = ..., *, unit: str = "", **more: Any) -> Any:
    """A field with its description and its unit, "-" of a number, "" of others; `more` are those of `Field`."""
    if unit:
        more["json_schema_extra"] = {"unit": unit}
    return Field(default, description=f"{text} [{unit}]" if unit else text, **more)


def unit_of(field: FieldInfo) -> str:
    """The unit of a field, "" if it has none."""
    extra = field.json_schema_extra
    return str(extra.get("unit", "")) if isinstance(extra, dict) else ""


_ENDS = {
    "m": (1e-4, 1e4),
    "m/s2": (1e-6, 1e6),
    "s": (1e-4, 1e4),
    "-": (1e-6, 1e6),
    "kg": (1e-6, 1e12),
    "kg m2": (1e-9, 1e15),
}
_OWN_ENDS = {"gravity": (1e-3, 1e3)}
"""Smallest and largest values that the service takes, by unit or by name, where a quantity has an open end there."""


def served(quantity: Quantity) -> Quantity:
    """The quantity on the range of the service."""
    ends = _OWN_ENDS.get(quantity.name) or _ENDS.get(quantity.unit)
    if ends is None:
        return quantity
    low = -ends[1] if quantity.lower == -math.inf else max(quantity.lower, ends[0])
    low = quantity.lower if quantity.closed in ("both", "left") and math.isfinite(quantity.lower) else low
    return quantity.restricted(low, min(quantity.upper, ends[1]))


def si(quantity: Quantity, text: str = "", kind: Any = float, **more: Any) -> Any:
    """A field in SI units within the range of the service; a text may state another unit, as "40 cm"."""
    return read_as(served(quantity), text, kind, **more)


class WithUnit(float):
    """A number from a text that states its unit."""


def _keep_unit(value: Any, read: ValidatorFunctionWrapHandler) -> float:
    found: float = read(value)
    stated = isinstance(value, str) and (split_quantity(value) or (0.0, ""))[1]
    return WithUnit(found) if stated else found


def between(low: float, high: float, text: str, *, unit: str, **more: Any) -> Any:
    """A field with a unit and a range that includes its finite ends."""
    highest = high if math.isfinite(high) else None
    extra: dict[str, Any] = {"unit": unit}
    return Field(description=f"{text} [{unit}]", ge=low, le=highest, json_schema_extra=extra, **more)


def _list_pulses(schema: dict[str, Any]) -> None:
    """Add the names of all pulses, those that were registered until the schema is made among them."""
    names = pulse_names()
    varied = "|".join(name for name in names if pulse_parameters(name))
    schema["anyOf"] = [
        {"title": "Pulse_name", "type": "string", "enum": [*names, *(f"-{name}" for name in names)]},
        {"type": "string", "pattern": rf"^-?({varied})\([a-z]+=[^(),]+(,[a-z]+=[^(),]+)*\)$"},
    ]


def _known_pulse(text: str) -> str:
    if text.removeprefix("-") not in PULSE_NAMES:
        as_pulse(text)
    return text


def _momentum_or_number(value: Any, read: ValidatorFunctionWrapHandler) -> Any:
    """One error message for both alternatives."""
    try:
        found = read(value)
        impact_share(found)
        return found
    except ValidationError:
        raise PydanticCustomError("restitution", "momentum, kalliontzis(k=0.8), or a number in [0, 1] [-]") from None


def _format(*forms: str, default: str) -> Any:
    text = f"format of the response; absent: {default}"
    return Annotated[Literal[forms] | None, Field(description=text + (" (nc: netCDF-3)" if "nc" in forms else ""))]


# the groups of a response

Pulse = Field(
    description="pulse, with its parameters in brackets if it has any; a leading minus mirrors it",
    examples=["sine", "mavroeidis_papageorgiou(cycles=3, phase=90deg)"],
    json_schema_extra=_list_pulses,
)
PulseName: Any = Annotated[str, AfterValidator(_known_pulse), Pulse]
Slenderness: Any = read_as(SLENDERNESS, f"{SLENDERNESS.named}; from 1 on the block does not uplift", examples=[0.4])
FrequencyRatio: Any = read_as(FREQUENCY_RATIO, examples=[5.0])
RESTITUTION = replace(q.RESTITUTION, words=())  # a number: there is no shape
Restitution: Any = read_as(RESTITUTION, examples=[0.85])
AlphaDeg = Annotated[
    float | None,
    AfterValidator(lambda given: given and float(ALPHA_DEG.convert(given))),
    said("slenderness angle alpha; absent or 0: the slender limit", unit="deg", examples=[0.0]),
]

# blocks and motions in SI units

Gravity = si(q.GRAVITY)
PeakAcceleration: Any = Annotated[si(q.PEAK_ACCELERATION, examples=[4.0]), WrapValidator(_keep_unit)]
Period = si(q.PERIOD, examples=[0.5])
Scale: Any = read_as(q.SCALE.restricted(*SCALES))
Spread = Annotated[str, Field(pattern=r"^kalliontzis\(k=[0-9.eE+-]{1,30}\)$")]
"""An impact at a share k of the half base."""
BodyRestitution = Annotated[
    Literal["momentum"] | Spread | Annotated[float, Field(ge=0.0, le=1.0)],
    WrapValidator(_momentum_or_number),
    said("eta; momentum: (2.4), 0 where that is negative; kalliontzis(k=0.8): impact at that share of b", unit="-"),
]

# files of records

Unit: Any = Annotated[Literal[tuple(UNITS)] | None, Field(description="unit of the samples")]
RecordFormat: Any = Annotated[
    Literal[FORMATS] | None,
    Field(description="format of the file; absent: the one whose signature the file has, else columns"),
]
Column = Annotated[str | None, Field(max_length=200)]
RotationUnit: Any = Literal[tuple(QUANTITIES["rad"])]
TimeUnit: Any = Annotated[Literal[tuple(QUANTITIES["s"])] | None, Field(description="unit of the column of times")]
TimeStep = Annotated[float | None, between(*TIME_STEP, "time between samples, in place of a column of times", unit="s")]
Skip = Annotated[int, between(0, MAX_SKIP, "lines above the names of the columns, or above the rows", unit="-")]
Delimiter = Annotated[
    str | None,
    Field(
        description="comma, semicolon, tab, blank; several signs if each separates; or the Fortran format of numbers "
        "of fixed width, such as 8f10.6; absent: the sign that the first row has, else blanks",
        max_length=20,
    ),
]
Decimal = Annotated[Literal[".", ","], Field(description="decimal sign")]
BaselineOrder = Annotated[
    int | None,
    between(0, MAX_BASELINE_ORDER, "degree of the baseline to remove; absent: only the mean of K-NET counts", unit="-"),
]
Contact = Annotated[bool, Field(description="add the reactions of the ground and the friction that they need")]

Mass: Any = si(q.MASS, "mass of the body, for the reactions in newtons", float | None)

# options of the answer

Method = Annotated[
    Literal["auto", "cube", "solver"],
    Field(description="auto: the data set where it meets the tolerance, else the solver; cube, solver: only this one"),
]
AbsoluteTolerance = Annotated[
    float, said("largest absolute error of an interpolated peak_rotation", unit="-", ge=0, allow_inf_nan=False)
]
Format = _format("json", "csv", "nc", default="JSON")
BodyFormat = _format("json", "csv", "nc", default="that of the body")
TableFormat = _format("json", "csv", default="that of the body")
FileFormat = _format("csv", "nc", default="nc")
