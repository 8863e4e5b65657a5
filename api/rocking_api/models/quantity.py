"""Fields of pydantic from the declarations of quantities, and the inputs that several routes share.

The ranges of the service lie inside those of the library, far outside of practice: searches around a point, and points
shifted by rounding for the error bound, stay in the latter.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Annotated, Any, Literal, TypeVar

from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    Field,
    ValidationError,
    ValidatorFunctionWrapHandler,
    WrapValidator,
    create_model,
)
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

Model = TypeVar("Model", bound=BaseModel)

SLENDERNESS = q.SLENDERNESS.restricted(1e-9, math.inf)
FREQUENCY_RATIO = q.FREQUENCY_RATIO.restricted(1e-6, 1e6)
ALPHA_DEG = q.ALPHA.in_degrees().restricted(1e-6, 89.9)

SCALES = 1e-6, q.HIGHEST_SCALE  # smallest and largest factor of a record [-]


_ENDS_OF_FIELDS = {"minimum": "ge", "exclusiveMinimum": "gt", "maximum": "le", "exclusiveMaximum": "lt"}


def described(quantity: Quantity, text: str = "", *, unit: str = "", **more: Any) -> Any:
    """What the declaration says of a field: meaning, unit and range in the schema; `more` are those of `Field`."""
    text = f"{text} [{unit or quantity.unit}]" if text else quantity.help
    return Field(description=text, json_schema_extra=dict(quantity.limits), **more)


def plain(quantity: Quantity, text: str = "", **more: Any) -> Any:
    """A field that is a number in the unit of the quantity, within its range."""
    ends: dict[str, Any] = {_ENDS_OF_FIELDS[name]: end for name, end in quantity.limits.items()}
    text = f"{text} [{quantity.unit}]" if text else quantity.help
    return Field(description=text, allow_inf_nan=False, **ends, **more)


def said(text: str, default: Any = ..., **more: Any) -> Any:
    """A field with its description; `more` are those of `Field`."""
    return Field(default, description=text, **more)


def with_intervals(**estimates: tuple[Any, str, str]) -> Callable[[type[Model]], type[Model]]:
    """A decorator that adds estimates to a model, by type, meaning and unit, and the ends of their intervals."""
    found: dict[str, Any] = {}
    for name, (kind, meaning, unit) in estimates.items():
        ends = {name: meaning} | {f"{name}_{end}": f"{end} end of its interval" for end in ("lower", "upper")}
        found |= {key: (kind, said(f"{text} [{unit}]")) for key, text in ends.items()}
    return lambda model: create_model(model.__name__, __base__=model, __doc__=model.__doc__, **found)


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
    own = served(quantity)

    def read(value: Any) -> Any:
        return value if value is None else own.read(value, si=True)

    return Annotated[kind, BeforeValidator(read), described(own, text, **more)]


class WithUnit(float):
    """A number from a text that states its unit."""


def _keep_unit(value: Any, read: ValidatorFunctionWrapHandler) -> float:
    found: float = read(value)
    stated = isinstance(value, str) and (split_quantity(value) or (0.0, ""))[1]
    return WithUnit(found) if stated else found


def between(low: float, high: float, text: str, **more: Any) -> Any:
    """A field with a range that includes its finite ends."""
    return Field(description=text, ge=low, le=high if math.isfinite(high) else None, **more)


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
    text = f"format of the response; absent: by the Accept header, else {default}"
    return Annotated[Literal[forms] | None, Field(description=text + (" (nc: netCDF-3)" if "nc" in forms else ""))]


# the groups of a response

Pulse = Field(
    description="pulse, with its parameters in brackets if it has any; a leading minus mirrors it",
    examples=["sine", "mavroeidis_papageorgiou(cycles=3, phase=90deg)"],
    json_schema_extra=_list_pulses,
)
PulseName = Annotated[str, AfterValidator(_known_pulse), Pulse]
Slenderness = Annotated[
    float, plain(SLENDERNESS, f"{SLENDERNESS.help[:-4]}; from 1 on the block does not uplift", examples=[0.4])
]
FrequencyRatio = Annotated[float, plain(FREQUENCY_RATIO, examples=[5.0])]
Restitution = Annotated[float, plain(q.RESTITUTION, examples=[0.85])]
AlphaDeg = Annotated[
    float | None,
    AfterValidator(lambda given: given and float(ALPHA_DEG.convert(given))),
    Field(description="slenderness angle alpha [deg]; absent or 0: the slender limit", examples=[0.0]),
]

# blocks and motions in SI units

Gravity = si(q.GRAVITY)
PeakAcceleration: Any = Annotated[si(q.PEAK_ACCELERATION, examples=[4.0]), WrapValidator(_keep_unit)]
Period = si(q.PERIOD, examples=[0.5])
Scale = Annotated[float, plain(q.SCALE.restricted(*SCALES))]
Spread = Annotated[str, Field(pattern=r"^kalliontzis\(k=[0-9.eE+-]{1,30}\)$")]
"""An impact at a share k of the half base."""
BodyRestitution = Annotated[
    Literal["momentum"] | Spread | Annotated[float, Field(ge=0.0, le=1.0)],
    WrapValidator(_momentum_or_number),
    said("eta [-]; momentum: (2.4), 0 where that is negative; kalliontzis(k=0.8): impact at that share of b"),
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
TimeStep = Annotated[float | None, between(*TIME_STEP, "time between samples [s], in place of a column of times")]
Skip = Annotated[int, between(0, MAX_SKIP, "lines above the names of the columns, or above the rows [-]")]
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
    between(0, MAX_BASELINE_ORDER, "degree of the baseline to remove [-]; absent: only the mean of K-NET counts"),
]
Contact = Annotated[bool, Field(description="add the reactions of the ground and the friction that they need")]

# options of the answer

Method = Annotated[
    Literal["auto", "cube", "solver"],
    Field(description="auto: the data set where it meets the tolerance, else the solver; cube, solver: only this one"),
]
AbsoluteTolerance = Annotated[
    float, Field(description="largest absolute error of an interpolated peak_rotation [-]", ge=0, allow_inf_nan=False)
]
Format = _format("json", "csv", "nc", default="JSON")
BodyFormat = _format("json", "csv", "nc", default="that of the body")
TableFormat = _format("json", "csv", default="that of the body")
FileFormat = _format("csv", "nc", default="nc")
