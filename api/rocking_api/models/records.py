"""A block in metres under a record in the body: parameters and responses."""

from __future__ import annotations

from typing import Annotated

from pydantic import BaseModel, Field

from rocking.constants import STANDARD_GRAVITY
from rocking.dimensional.record_scales import HIGHEST_SCALE
from rocking.errors import in_range, one_of
from rocking.excitation.records.processing import MAX_BASELINE_ORDER
from rocking.excitation.records.record import UNITS
from rocking_api.models.blocks import RANGES, HousnerOrNumber, quantity
from rocking_api.models.params import Format, Params, check_value
from rocking_api.models.responses import VERSION, ContactResponse

SMALLEST_SCALE = 1e-6
"""Smallest factor of a record [-]."""

Unit = Annotated[
    str | None,
    Field(description="unit of the samples, required if the file states none", json_schema_extra={"enum": [*UNITS]}),
]


class RecordParams(Params):
    """A block in SI units, and what the file of the record does not state."""

    half_width: float = quantity("half_width", "b; the base is 2b wide", examples=[0.2])
    half_height: float = quantity("half_height", "h", examples=[0.8])
    scale: float = Field(
        1.0,
        description="factor of the record [-]",
        json_schema_extra={"minimum": SMALLEST_SCALE, "maximum": HIGHEST_SCALE},
    )
    restitution: HousnerOrNumber = Field("housner", description="eta [-], or housner: (2.4), 0 where that is negative")
    gravity: float = quantity("gravity", "g", default=STANDARD_GRAVITY)
    name: str = Field("record", description="name of the file, for messages", max_length=200)
    unit: Unit = None
    time_step: float | None = Field(None, description="time step [s], required if the file states none")
    component: str | None = Field(None, description="column or trace of a file with several", max_length=200)
    baseline_order: int | None = Field(
        None,
        description="degree of the baseline that is removed from the acceleration; absent: none",
        json_schema_extra={"minimum": 0, "maximum": MAX_BASELINE_ORDER},
    )

    def check(self) -> None:
        for name, value in self:
            if name in RANGES:
                low, high, unit = RANGES[name]
                in_range(name, value, low, high, unit=unit)
            elif name == "restitution" and value != "housner":
                check_value(name, value)
        in_range("scale", self.scale, SMALLEST_SCALE, HIGHEST_SCALE)
        if self.unit is not None:
            one_of("unit", self.unit, UNITS)
        if self.baseline_order is not None:
            in_range("baseline_order", self.baseline_order, 0, MAX_BASELINE_ORDER)


class RecordResponseParams(RecordParams):
    """The same, and whether to search thresholds and to fit a pulse."""

    thresholds: bool = Field(False, description="find all scales at which the outcome changes")
    fit: bool = Field(False, description="fit a pulse, and compare how both overturn the block")


class RecordHistoryParams(RecordParams):
    """The same, and which samples are wanted."""

    samples: int | None = Field(
        None,
        description="uniform samples [-]; absent: those of the record; the events are added",
        json_schema_extra={"minimum": 2},
    )
    contact: bool = Field(False, description="add the reactions of the ground and the friction that they need")
    format: Format = None


class RecordDescription(BaseModel):
    """The record, as read; SI units."""

    name: str
    source: str = Field(description="file, format, and remarks of the reader")
    samples: int
    time_step: float = Field(description="[s]")
    peak_acceleration: float = Field(description="PGA [m/s2]")
    peak_velocity: float = Field(description="PGV [m/s]")
    peak_displacement: float = Field(description="PGD [m]")
    arias_intensity: float = Field(description="[m/s]")
    significant_duration: float = Field(description="between 5 % and 95 % of the Arias intensity [s]")
    mean_period: float | None = Field(description="[s]; null if no frequency lies between 0.25 and 20 Hz")
    final_velocity: float = Field(description="velocity at the last sample, which an offset leaves [m/s]")
    digest: str = Field(description="sha256 of the time step and the samples")


class ScaleThreshold(BaseModel):
    """A scale at which the outcome changes."""

    scale: float = Field(description="factor of the record [-]")
    peak_acceleration: float = Field(description="PGA of the scaled record [m/s2]")
    overturns_above: bool = Field(description="true: overturns just above and survives just below; false: the reverse")


class FittedPulse(BaseModel):
    """A pulse fitted to the velocity of the record: a description, not a substitute."""

    pulse: str = Field(description="kind of pulse")
    period: float = Field(description="T_p [s]")
    peak_acceleration: float = Field(description="a_g [m/s2]")
    centre: float = Field(description="time of its centre from the first sample [s]")
    cycles: float | None = Field(description="gamma of Mavroeidis & Papageorgiou [-]; null for others")
    phase: float | None = Field(description="nu of Mavroeidis & Papageorgiou [rad]; null for others")
    explained: float = Field(description="share of the sum of squares of the velocity that it takes away [-]")
    scale_ratio: float | None = Field(
        description="lowest scale at which the pulse overturns the block over that of the record [-]; above 1 the "
        "pulse is unconservative; null: one of them does not overturn it"
    )


class RecordResponse(BaseModel):
    """What happens to the block; the fields of /v1/blocks/response have the same meaning."""

    query: RecordResponseParams
    record: RecordDescription
    overturned: bool = Field(description="by the rocking model: of a block that neither slides nor lifts off")
    exceeded_alpha: bool = Field(description="whether the rotation passes alpha; the ground can bring a block back")
    outcome: str
    rocking_model_applies: bool = Field(
        description="false: pure rocking needs a coefficient of friction beyond 1, or the block lifts off"
    )
    meaning: str = Field(description="the outcome in words; where the rocking model does not apply, that and why")
    impacts: int
    peak_rotation: float | None = Field(description="max |theta|/alpha [-]; null if overturned")
    peak_rotation_deg: float | None = Field(description="max |theta| [deg]; null if overturned")
    top_displacement: float | None = Field(description="largest horizontal displacement of the top corner [m]")
    alpha_deg: float = Field(description="slenderness angle [deg]")
    half_diagonal: float = Field(description="R [m]")
    frequency_parameter: float = Field(description="p [rad/s]")
    restitution: float = Field(description="eta [-]; with housner 0 where (2.4) is negative")
    uplift_acceleration: float = Field(description="smallest ground acceleration that starts rocking [m/s2]")
    slenderness: float = Field(description="g tan(alpha)/PGA of the scaled record [-]")
    overturned_resampled: bool | None = Field(
        description="the same under the record interpolated band-limited at an eighth of its step; null: it is too long"
    )
    peak_rotation_resampled: float | None = Field(description="the same [-]; null if overturned, or too long")
    thresholds: list[ScaleThreshold] | None = Field(description="ascending; null unless requested")
    friction_at_uplift: float = Field(
        description="coefficient of friction below which it slides instead of rocking [-]"
    )
    friction_demand: float | None = Field(description="the same through the whole motion [-]; null: it lifts off")
    friction_at_impact: float = Field(description="horizontal over vertical impulse at its impacts [-]")
    smallest_normal_reaction: float = Field(description="over its weight [-]; 0 and below: it lifts off")
    pulse: FittedPulse | None = Field(None, description="null unless requested")
    warnings: list[str] = Field(description="where the answer is in doubt")
    source: str = "solver"
    version: str = VERSION


class RecordHistoryResponse(BaseModel):
    """A motion under a record."""

    query: RecordHistoryParams
    record: RecordDescription
    overturned: bool
    outcome: str
    peak_rotation: float | None = Field(description="max |theta|/alpha [-]; null if overturned")
    impacts: int
    time: list[float] = Field(description="from the first sample [s]")
    rotation: list[float] = Field(description="theta/alpha [-]")
    angular_velocity: list[float] = Field(description="theta'/(p alpha) [-]")
    ground_acceleration: list[float] = Field(description="u_g/(g tan alpha) [-]")
    impact_time: list[float] = Field(description="times of the impacts [s]")
    contact: ContactResponse | None = Field(None, description="null unless requested")
    source: str = "solver"
    version: str = VERSION
