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
from rocking_api.models.responses import BY_SOLVER, PointResponse

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
        raise PydanticCustomError("restitution", "momentum, or a number in [0, 1] [-]") from None


MomentumOrNumber = Annotated[Literal["momentum"] | float, WrapValidator(_momentum_or_number)]

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
        "momentum", description="eta [-], or momentum: (2.4), 0 where that is negative"
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
        "momentum", description="eta [-] of the blocks that state none, or momentum: (2.4), 0 where that is negative"
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


class BodySummary(Answer):
    """What happens to a body whose centre of mass is not that of the block, under any motion."""

    meaning: str = Field(description="the outcome in words; where the rocking model does not apply, that and why")
    margin: str | None = Field(description="from which strength of the motion it overturns, in words; null: not asked")
    outcome: str = Field(description="final outcome by name")
    overturned: bool = Field(description="by the rocking model: of a body that neither slides nor lifts off")
    rocking_model_applies: bool = Field(
        description="false: pure rocking needs a coefficient of friction beyond 1, or the body lifts off"
    )
    edge: Literal["right", "left"] | None = Field(
        description="edge of the largest |theta|/alpha, or about which it overturns; null: no uplift"
    )
    peak_rotation_deg: float | None = Field(description="max |theta| [deg]; null if overturned")
    rotation_left_deg: float | None = Field(description="largest rotation about the left edge [deg]; likewise")
    rotation_right_deg: float | None = Field(description="largest rotation about the right edge [deg]; likewise")
    top_displacement: float | None = Field(description="largest horizontal displacement of the top [m]; likewise")
    peak_rotation: float | None = Field(description="max |theta|/alpha, alpha of the edge [-]; likewise")
    exceeded_alpha: bool = Field(description="whether the rotation passes alpha; the ground can bring a body back")
    impacts: int = Field(description="number of impacts until the outcome is certain [-]")
    uplift_time: float | None = Field(description="time of the first uplift [s]; null: no uplift")
    uplift_acceleration: float = Field(description="smallest ground acceleration that starts rocking [m/s2]")
    alpha_left_deg: float = Field(description="slenderness angle of the left edge [deg]")
    alpha_right_deg: float = Field(description="slenderness angle of the right edge [deg]")
    friction_demand: float | None = Field(
        description="coefficient of friction that pure rocking needs, impacts excluded [-]; null: it lifts off"
    )
    lifts_off: bool = Field(description="whether pure rocking would need a tensile reaction of the ground")
    source: str = BY_SOLVER
    metadata: Metadata = METADATA_FIELD


class BodyResponse(BodySummary):
    """What happens to a body under a pulse."""

    query: BlockParams = QUERY
    thresholds: list[Threshold] = Field(
        description="all amplitudes at which the outcome changes, this period, ascending"
    )


class BlockSummary(Answer):
    """What happens to a block, under any motion."""

    overturned: bool = Field(description="by the rocking model: of a block that neither slides nor lifts off")
    peak_rotation_deg: float | None = Field(description="max |theta| [deg]; null if overturned")
    top_displacement: float | None = Field(description="largest horizontal displacement of the top corner [m]")
    alpha_deg: float = Field(description="slenderness angle [deg]")
    half_diagonal: float = Field(description="R [m]")
    frequency_parameter: float = Field(description="p [rad/s]")
    restitution: float = Field(description="eta [-]; with momentum 0 where (2.4) is negative")
    uplift_acceleration: float = Field(description="smallest ground acceleration that starts rocking [m/s2]")
    friction_at_uplift: float = Field(
        description="coefficient of friction below which it slides instead of rocking [-]"
    )
    metadata: Metadata = METADATA_FIELD


class BlockResponse(BlockSummary):
    """What happens to the block."""

    query: BlockParams = QUERY
    response: PointResponse = Field(description="the same request and response in dimensionless groups")
    rocking_model_applies: bool = Field(
        description="false: pure rocking needs a coefficient of friction beyond 1, or the block lifts off; what is "
        "said of its rocking and overturning then does not hold for a block that is free to do so"
    )
    meaning: str = Field(
        description="the outcome in words; where the rocking model does not apply, first of all that and why"
    )
    thresholds: list[Threshold] | None = Field(
        description="all amplitudes at which the outcome changes, this period, ascending; null if not found in time, "
        "see `warnings`"
    )
    largest_safe_acceleration: float | None = Field(
        description="peak acceleration below which this block, of this size, does not overturn under this pulse at "
        "this period [m/s2]; a smaller block of the same shape may; null: no change of outcome was found, or the "
        "rocking model does not apply just below the lowest of `thresholds`, see `warnings`"
    )
    largest_safe_friction_demand: float | None = Field(
        description="coefficient of friction that it needs to be safe just below that acceleration [-]; null likewise"
    )
    margin: str = Field(description="below which peak acceleration it does not overturn at this period, in words")
    margins: Margins | None = Field(description="null if they were not found in time, see `warnings`")
    friction_demand: float | None = Field(
        description="the same through the whole motion, impacts excluded; if it overturns, until it passes alpha for "
        "good [-]; null: it lifts off"
    )
    friction_at_impact: float = Field(
        description="ratio of the horizontal to the vertical impulse at its impacts, 0 without impacts [-]"
    )
    smallest_normal_reaction: float = Field(description="over its weight, for as long [-]; 0 and below: it lifts off")
    notes: list[str] = Field(description="what else is worth knowing")
    data_version: str | None = Field(description="sha256 of the data set that gave the response; null: the solver did")
