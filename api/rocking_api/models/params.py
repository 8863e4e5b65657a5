"""Parameters of the routes and their ranges."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Sequence
from functools import cache, partial
from typing import Annotated, Any, ClassVar, Literal

from pydantic import BaseModel, ConfigDict, Field

from rocking._base.errors import InvalidArgumentError, SeveralArgumentsError, in_range, one_of
from rocking._base.quantities import ALPHA, RESTITUTION
from rocking._base.quantities import FREQUENCY_RATIO as ANY_FREQUENCY_RATIO
from rocking._base.quantities import SLENDERNESS as ANY_SLENDERNESS
from rocking._excitation.pulses import PULSE_NAMES, as_pulse, pulse_names, pulse_parameters
from rocking._model.checks import impact_share

# Ranges of the service, far outside of practice and inside those of the library: searches around a point, and points
# shifted by rounding for the error bound, stay in the latter.
SLENDERNESS = ANY_SLENDERNESS.restricted(1e-9, math.inf)
FREQUENCY_RATIO = ANY_FREQUENCY_RATIO.restricted(1e-6, 1e6)
ALPHA_DEG = ALPHA.in_degrees().restricted(1e-6, 89.9)

GROUPS = ("slenderness", "frequency_ratio", "restitution")

MAX_NUMBERS = 1_000_000
"""Most numbers of a list in JSON [-]; the points of a batch have a limit of their own, see `Settings`."""

_FAIL_FAST = Field(fail_fast=True, max_length=MAX_NUMBERS)  # one error for an array, not one for each entry

_KNOWN = frozenset([*PULSE_NAMES, *(f"-{name}" for name in PULSE_NAMES)])
"""Names that need no look at the registered pulses."""

MAX_DURATION = 1e9
"""Duration of a history, tau = p t [-]."""


def _list_pulses(schema: dict[str, Any]) -> None:
    """Add the names of all pulses, those that were registered until the schema is made among them."""
    names = pulse_names()
    varied = "|".join(name for name in names if pulse_parameters(name))
    schema["anyOf"] = [
        {"title": "Pulse_name", "type": "string", "enum": [*names, *(f"-{name}" for name in names)]},
        {"type": "string", "pattern": rf"^-?({varied})\([a-z]+=[^(),]+(,[a-z]+=[^(),]+)*\)$"},
    ]


PulseName = Annotated[
    str,
    Field(
        description="pulse, with its parameters in brackets if it has any; a leading minus mirrors it",
        examples=["sine", "mavroeidis_papageorgiou(cycles=3, phase=90deg)"],
        json_schema_extra=_list_pulses,
    ),
]
Slenderness = Annotated[
    float,
    Field(
        description=f"{SLENDERNESS.help}; from 1 on the block does not uplift",
        examples=[0.4],
        json_schema_extra=SLENDERNESS.limits,
    ),
]
FrequencyRatio = Annotated[
    float, Field(description=FREQUENCY_RATIO.help, examples=[5.0], json_schema_extra=FREQUENCY_RATIO.limits)
]
Restitution = Annotated[
    float, Field(description=RESTITUTION.help, examples=[0.85], json_schema_extra=RESTITUTION.limits)
]
AlphaDeg = Annotated[
    float | None,
    Field(description="slenderness angle alpha [deg]; absent or 0: the slender limit", examples=[0.0]),
]
Method = Annotated[
    Literal["auto", "cube", "solver"],
    Field(description="auto: the data set where it keeps the tolerance, else the solver; cube, solver: only that"),
]
AbsoluteTolerance = Annotated[
    float,
    Field(description="largest absolute error of an interpolated peak_rotation [-]", json_schema_extra={"minimum": 0}),
]
Format = Annotated[
    Literal["json", "csv", "nc"] | None,
    Field(description="format of the response; absent: by the Accept header, else JSON (nc: netCDF-3)"),
]
BodyFormat = Annotated[
    Literal["json", "csv", "nc"] | None,
    Field(description="format of the response; absent: by the Accept header, else that of the body (nc: netCDF-3)"),
]
TableFormat = Annotated[
    Literal["json", "csv"] | None,
    Field(description="format of the response; absent: by the Accept header, else that of the body"),
]
FileFormat = Annotated[
    Literal["csv", "nc"] | None,
    Field(description="format of the response; absent: by the Accept header, else nc, which is netCDF-3"),
]


class Params(BaseModel):
    """Base of all parameter models. Unknown parameters are refused."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    takes_lists: ClassVar[bool] = False
    """Whether a JSON body may be a list as well: content without parameters."""

    @classmethod
    def check_field(cls, name: str, value: Any) -> None:
        """Refuse a value that is out of the range that the schema of its field states, whatever the others are.

        Raises
        ------
        InvalidArgumentError
            If it is.
        """
        check = _checks_of(cls).get(name)
        if check is not None and value is not None:
            check(value)

    @classmethod
    def out_of_range(cls, values: Iterable[tuple[str, Any]]) -> list[InvalidArgumentError]:
        """The errors of `check_field` for names and values."""
        found = []
        for name, value in values:
            try:
                cls.check_field(name, value)
            except InvalidArgumentError as error:
                found.append(error)
        return found

    def check(self) -> None:
        """Refuse values out of range, before any work is queued.

        Raises
        ------
        InvalidArgumentError
            If some are; `SeveralArgumentsError` if several are.
        """
        errors = self.out_of_range(self)
        if errors:
            raise SeveralArgumentsError(errors) if len(errors) > 1 else errors[0]


class ListParams(Params):
    """A part of a list."""

    limit: int | None = Field(
        None,
        description="most entries [-]; absent: all",
        examples=[10],
        json_schema_extra={"minimum": 1, "maximum": 10_000},
    )
    cursor: str | None = Field(
        None, description="where the list goes on: `next_cursor` of the answer before; absent: at its start"
    )

    def part(self, names: Sequence[str]) -> tuple[list[str], str | None]:
        """The names of this part, of ascending names, and the cursor of the next one; None at the end."""
        self.check()
        rest = [name for name in names if self.cursor is None or name > self.cursor]
        part = rest[: self.limit]
        return part, part[-1] if len(part) < len(rest) else None


class LookupOptions(Params):
    """Options of a lookup."""

    pulse: PulseName
    alpha_deg: AlphaDeg = None
    method: Method = "auto"
    absolute_tolerance: AbsoluteTolerance = 1e-4


class ResponseParams(LookupOptions):
    """One block."""

    slenderness: Slenderness
    frequency_ratio: FrequencyRatio
    restitution: Restitution


class BatchOptions(LookupOptions):
    """Options of many blocks."""

    format: BodyFormat = None


class TableParams(BatchOptions):
    """The same, and those of the groups that a table does not hold."""

    slenderness: Slenderness | None = None
    frequency_ratio: FrequencyRatio | None = None
    restitution: Restitution | None = None


class BatchParams(BatchOptions):
    """Many blocks: numbers, or arrays of one length."""

    slenderness: Slenderness | Annotated[list[Slenderness], _FAIL_FAST] = Field(description=SLENDERNESS.help)
    frequency_ratio: FrequencyRatio | Annotated[list[FrequencyRatio], _FAIL_FAST] = Field(
        description=FREQUENCY_RATIO.help
    )
    restitution: Restitution | Annotated[list[Restitution], _FAIL_FAST] = Field(description=RESTITUTION.help)


class SpectrumParams(LookupOptions):
    """Blocks of one slenderness over a window of the frequency ratio, spaced evenly in its logarithm."""

    slenderness: Slenderness
    restitution: Restitution
    frequency_ratio_min: FrequencyRatio = Field(0.5, examples=[0.5])
    frequency_ratio_max: FrequencyRatio = Field(12.0, examples=[12.0])
    points: int = Field(200, description="points of the curve [-]", json_schema_extra={"minimum": 2})
    format: Format = None


class OverturningParams(Params):
    """Boundary curves of overturning."""

    pulse: PulseName
    restitution: Restitution
    alpha_deg: AlphaDeg = None
    format: Format = None


class HistoryParams(Params):
    """The motion of one block."""

    pulse: PulseName
    slenderness: Slenderness
    frequency_ratio: FrequencyRatio
    restitution: Restitution
    alpha_deg: AlphaDeg = None
    duration: float | None = Field(
        None,
        description="length tau = p t [-]; absent: the pulse and some free rocking",
        json_schema_extra={"exclusiveMinimum": 0, "maximum": MAX_DURATION},
    )
    samples: int = Field(
        400,
        description="uniform samples [-]; the events are added",
        json_schema_extra={"minimum": 2, "maximum": 1_000_000},
    )
    contact: bool = Field(False, description="add the reactions of the ground and the friction that they need")
    format: Format = None


def alpha_of(alpha_deg: float | None) -> float | None:
    """Slenderness angle [rad], None for the slender limit.

    Raises
    ------
    InvalidArgumentError
        If it is neither 0 nor in the range of `ALPHA_DEG`.
    """
    return math.radians(float(ALPHA_DEG.convert(alpha_deg))) if alpha_deg else None


_CHECKS: dict[str, Callable[[Any], object]] = {
    "pulse": as_pulse,
    "slenderness": SLENDERNESS.convert,
    "frequency_ratio": FREQUENCY_RATIO.convert,
    "restitution": lambda value: impact_share(value) is not None or RESTITUTION.convert(value),
    "alpha_deg": alpha_of,
}
"""Checks of parameters whose range is not all of what is allowed, or which may be arrays."""


@cache
def _checks_of(kind: type[Params]) -> dict[str, Callable[[Any], object]]:
    """Checks of the fields of a model: of `_CHECKS`, or of the range or the values that their schema states."""
    found = {name: check for name, check in _CHECKS.items() if name in kind.model_fields}
    for name, field in kind.model_fields.items():
        schema: Any = field.json_schema_extra
        if name in found or not isinstance(schema, dict):
            continue
        if "enum" in schema:
            found[name] = partial(one_of, name, choices=[one for one in schema["enum"] if one is not None])
        else:
            ends = {
                "low": schema.get("minimum", schema.get("exclusiveMinimum")),
                "high": schema.get("maximum", math.inf),
            }
            closed = "both" if "minimum" in schema else "right"
            unit = re.search(r"\[([^]]+)\]", field.description or "")
            found[name] = partial(in_range, name, **ends, closed=closed, unit=unit[1] if unit else "-")
    return found


def check_point(params: ResponseParams) -> None:
    """Refuse an unknown pulse and a block outside the ranges of the service; takes a microsecond.

    Raises
    ------
    InvalidArgumentError
        As `Params.check`, which is slower.
    """
    if not (
        params.pulse in _KNOWN
        and SLENDERNESS.lower <= params.slenderness < SLENDERNESS.upper
        and FREQUENCY_RATIO.lower <= params.frequency_ratio <= FREQUENCY_RATIO.upper
        and RESTITUTION.lower <= params.restitution <= RESTITUTION.upper
        and (not params.alpha_deg or ALPHA_DEG.lower <= params.alpha_deg <= ALPHA_DEG.upper)
        and 0.0 <= params.absolute_tolerance < math.inf
    ):
        params.check()
