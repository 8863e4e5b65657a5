"""A block in metres under a pulse in m/s2 and seconds: parameters and response."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BaseModel, Field, SerializeAsAny, ValidationError, ValidatorFunctionWrapHandler, WrapValidator
from pydantic_core import PydanticCustomError

from rocking._base.constants import STANDARD_GRAVITY
from rocking_api.models.answer import ECHO, QUERY, Answer
from rocking_api.models.metadata import METADATA_FIELD, Metadata
from rocking_api.models.params import AbsoluteTolerance, Method, Params, PulseName, TableFormat
from rocking_api.models.pulses import GivenPulse
from rocking_api.models.responses import BY_SOLVER, PointResponse, with_derived_fields, with_fields

MAX_BLOCKS = 10_000
"""Most blocks of a body [-]: each is an object, unlike the points of /v1/response."""

RANGES = {
    "width": (1e-4, 1e4, "m"),
    "height": (1e-4, 1e4, "m"),
    "offset": (-1e4, 1e4, "m"),
    "mass_height": (1e-4, 1e4, "m"),
    "peak_acceleration": (1e-6, 1e6, "m/s2"),
    "period": (1e-4, 1e4, "s"),
    "gravity": (1e-3, 1e3, "m/s2"),
}
"""Ranges of the service, far outside of practice, within which all numbers are representable as doubles."""


def quantity(name: str, text: str, **more: Any) -> Any:
    """The field of a quantity with its range."""
    low, high, unit = RANGES[name]
    return Field(description=f"{text} [{unit}]", json_schema_extra={"minimum": low, "maximum": high}, **more)


def _momentum_or_number(value: Any, read: ValidatorFunctionWrapHandler) -> Any:
    """One error message for both alternatives."""
    try:
        return read(value)
    except ValidationError:
        raise PydanticCustomError("restitution", "momentum, kalliontzis(k=0.8), or a number in [0, 1] [-]") from None


Spread = Annotated[str, Field(pattern=r"^kalliontzis\(k=[0-9.eE+-]{1,30}\)$")]
"""An impact at a share k of the half base."""

MomentumOrNumber = Annotated[Literal["momentum"] | Spread | float, WrapValidator(_momentum_or_number)]

Offset = Annotated[
    float,
    quantity(
        "offset",
        "distance of the centre of mass from the middle of the width, less than half of it; positive to the right",
    ),
]
MassHeight = Annotated[float | None, quantity("mass_height", "height of the centre of mass; absent: half the height")]


class SizeParams(Params):
    """A block in SI units."""

    width: float = quantity("width", "width 2b of the base", examples=[0.4])
    height: float = quantity("height", "height 2h", examples=[1.6])
    restitution: MomentumOrNumber = Field(
        "momentum",
        description="eta [-]; momentum: (2.4), 0 where that is negative; kalliontzis(k=0.8): impact at that share of b",
    )
    gravity: float = quantity("gravity", "g", default=STANDARD_GRAVITY)


class BlockParams(SizeParams):
    """A block and a pulse in SI units."""

    pulse: PulseName
    offset: Offset = 0.0
    mass_height: MassHeight = None
    peak_acceleration: float = quantity("peak_acceleration", "a_g", examples=[4.0])
    period: float = quantity(
        "period", "T_p = 2 pi/omega_g; a half sine or rectangular pulse lasts half of it", examples=[0.5]
    )
    method: Method = "auto"
    absolute_tolerance: AbsoluteTolerance = 1e-4


class BlocksParams(Params):
    """What many blocks in a body have in common."""

    pulse: PulseName | None = Field(None, description="pulse, required unless a JSON body holds it", examples=["sine"])
    restitution: MomentumOrNumber = Field(
        "momentum", description="eta [-] of the blocks that state none, momentum or kalliontzis(k=0.8), as of one block"
    )
    format: TableFormat = None


class BlockRow(Params):
    """One of many blocks in a JSON body, in SI units."""

    name: str = Field("", description="label", max_length=200)
    width: float = quantity("width", "width 2b of the base")
    height: float = quantity("height", "height 2h")
    peak_acceleration: float = quantity("peak_acceleration", "a_g")
    period: float = quantity("period", "T_p = 2 pi/omega_g")
    restitution: MomentumOrNumber | None = Field(None, description="eta [-], or momentum; absent: that of all")


class BlockRows(BlocksParams):
    """Many blocks in a JSON body, and what they have in common."""

    blocks: list[BlockRow] = Field(
        description="blocks, in the order of the response", json_schema_extra={"maxItems": MAX_BLOCKS}
    )
    pulse: GivenPulse | None = Field(  # type: ignore[assignment]
        None, description="a pulse by its name, or by samples; absent: that of the query"
    )


@with_derived_fields(list[float | None])
class BlocksResponse(Answer):
    """Many blocks: one value for each, in the order of the body; SI units, degrees and groups."""

    query: Annotated[SerializeAsAny[BlocksParams], ECHO] = QUERY
    name: list[str] | None = Field(None, description="labels; null without any")
    width: list[float] = Field(description="width 2b [m]")
    height: list[float] = Field(description="height 2h [m]")
    peak_acceleration: list[float] = Field(description="a_g [m/s2]")
    period: list[float] = Field(description="T_p [s]")
    uplift_acceleration: list[float] = Field(description="smallest ground acceleration that starts rocking [m/s2]")
    alpha_deg: list[float] = Field(description="slenderness angle [deg]")
    slenderness: list[float] = Field(description="g tan(alpha)/a_g [-]")
    frequency_ratio: list[float] = Field(description="omega_g/p [-]")
    restitution: list[float] = Field(description="eta [-]")
    peak_rotation_deg: list[float | None] = Field(description="max |theta| [deg]; null if overturned")
    top_displacement: list[float | None] = Field(description="displacement of the top corner [m]; null likewise")
    peak_rotation: list[float | None] = Field(description="max |theta|/alpha [-]; null if overturned")
    overturned: list[bool] = Field(description="final outcome")
    outcome: list[str] = Field(description="final outcome by name")
    impacts: list[int] = Field(description="number of impacts before the pulse ends [-]")
    exceeded_alpha: list[bool] = Field(description="whether the rotation passes alpha")
    error_bound: list[float | None] = Field(description="bound of the error of peak_rotation [-]; null if overturned")
    metadata: Metadata = METADATA_FIELD
    source: str = BY_SOLVER


OVERTURNS_ABOVE = Field(description="true: overturns just above and survives just below; false: the reverse")


AMPLITUDES = "all amplitudes at which the outcome changes"
NOTES = Field(description="what else is worth knowing")

Edge = Annotated[
    Literal["right", "left"] | None,
    Field(description="edge of the largest |theta|/alpha, or about which it overturns; null: no uplift"),
]


class Threshold(BaseModel):
    """An amplitude at which the outcome changes."""

    peak_acceleration: float = Field(description="a_g [m/s2]")
    overturns_above: bool = OVERTURNS_ABOVE


class PeriodThreshold(BaseModel):
    """A period at which the outcome changes, the amplitude being what it is."""

    period: float = Field(description="T_p [s]")
    overturns_above: bool = OVERTURNS_ABOVE


class SizeThreshold(BaseModel):
    """A size at which the outcome of blocks of this shape changes under this pulse."""

    half_diagonal: float = Field(description="R [m]")
    overturns_above: bool = OVERTURNS_ABOVE


class Margins(BaseModel):
    """How far the block is from another outcome, by the rigid equation itself."""

    nearest_acceleration: float | None = Field(
        description="amplitude nearest in its logarithm at which the outcome changes [m/s2]; null: none found"
    )
    acceleration_factor: float | None = Field(description="that over the peak acceleration of the request [-]")
    nearest_period: float | None = Field(
        description="period nearest in its logarithm at which the outcome changes, this amplitude [s]; null: none found"
    )
    period_factor: float | None = Field(description="that over the period of the request [-]")
    periods: list[PeriodThreshold] = Field(description="all periods at which the outcome changes, ascending")
    periods_searched: tuple[float, float] = Field(description="smallest and largest period searched [s]")
    smallest_surviving_half_diagonal: float | None = Field(
        description="smallest R of this shape searched that survives this pulse [m]; a larger one may overturn"
    )
    surviving_from_half_diagonal: float | None = Field(
        description="R from which every larger size searched survives [m]; null: the largest overturns"
    )
    sizes: list[SizeThreshold] = Field(description="all sizes of this shape at which the outcome changes, ascending")
    sizes_searched: tuple[float, float] = Field(description="smallest and largest half-diagonal searched [m]")


@with_fields("pulse", "edges")
class BodyResponse(Answer):
    """What happens to a body under a pulse whose centre of mass is not that of the block."""

    query: BlockParams = QUERY
    edge: Edge
    thresholds: list[Threshold] | None = Field(description=f"{AMPLITUDES}, this period, ascending")
    notes: list[str] = NOTES
    source: str = BY_SOLVER
    metadata: Metadata = METADATA_FIELD


@with_fields("pulse", "block")
class BlockResponse(Answer):
    """What happens to the block."""

    query: BlockParams = QUERY
    response: PointResponse = Field(description="the same request and response in dimensionless groups")
    thresholds: list[Threshold] | None = Field(
        description=f"{AMPLITUDES}, this period, ascending; null if not found in time, see `warnings`"
    )
    margins: Margins | None = Field(description="null if they were not found in time, see `warnings`")
    notes: list[str] = NOTES
    data_version: str | None = Field(description="sha256 of the data set that gave the response; null: the solver did")
    metadata: Metadata = METADATA_FIELD
