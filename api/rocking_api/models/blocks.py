"""A block in metres under a pulse in m/s2 and seconds: parameters and response."""

from __future__ import annotations

from pydantic import BaseModel

from rocking_api.models import quantity as q
from rocking_api.models.answer import BY_SOLVER, InUnits
from rocking_api.models.body_params import BodyParams, BodyShape, JsonBody
from rocking_api.models.fields import OTHER_EDGES, Edge, InUnitsOfOne, OfBlock, UnderPulse, of
from rocking_api.models.pulses import GivenPulse
from rocking_api.models.responses import PointResponse
from rocking_api.models.table import TableParams

MAX_BLOCKS = 10_000  # most blocks of a body [-]: each is an object, unlike the points of /v1/response


class BlockParams(BodyParams):
    """A body and a pulse in SI units."""

    pulse: q.PulseName
    peak_acceleration: q.PeakAcceleration
    period: q.Period
    method: q.Method = "auto"
    absolute_tolerance: q.AbsoluteTolerance = 1e-4


class BlocksParams(TableParams):
    """Values that many blocks of a body share."""

    pulse: q.PulseName | None = q.said("required beside CSV; JSON holds it", None, examples=["sine"])
    restitution: q.BodyRestitution = q.said(
        "eta where a block has none; momentum, kalliontzis(k=0.8)", "momentum", unit="-"
    )
    format: q.TableFormat = None


class BlocksQuery(BlocksParams):
    """What the answer repeats of the values that many blocks share."""

    pulse_digest: str | None = q.said("sha256 of the samples of the pulse; null for a pulse by its name", None)


class BlockRow(BodyShape):
    """One of many bodies in JSON, in SI units."""

    body: JsonBody  # a text once it is read
    name: str = q.said("label", "", max_length=200)
    peak_acceleration: q.PeakAcceleration
    period: q.Period
    restitution: q.BodyRestitution | None = q.said("eta, or momentum; absent: the one for all blocks", None, unit="-")


class BlockRows(BlocksParams):
    """Many blocks in a JSON body, and the values that they share."""

    blocks: list[BlockRow] = q.said("blocks, in the order of the response", json_schema_extra={"maxItems": MAX_BLOCKS})
    pulse: GivenPulse = q.said("a pulse by its name, or by samples")


class BlocksResponse(InUnits[BlocksQuery]):
    """Many bodies: one value for each, in the order of the body; SI units, degrees and groups."""

    name: list[str] | None = q.said("labels; null without any", None)
    body: list[str] | None = q.said("kind of each body; null if all are blocks", None)
    peak_rotation_deg: list[float | None] = of("peak_rotation_deg")
    rotation_left_deg: list[float | None] = of("rotation_left_deg")
    rotation_right_deg: list[float | None] = of("rotation_right_deg")
    displacement: list[float | None] = of("displacement")
    overturned: list[bool] = of("overturned")
    outcome: list[str] = of("outcome")
    edge: list[Edge] = of("edge")
    impacts: list[int] = of("impacts")
    exceeded_alpha: list[bool] = of("exceeded_alpha")
    peak_rotation: list[float | None] = of("peak_rotation")
    uplift_time: list[float | None] = of("uplift_time")
    error_bound: list[float | None] = of("error_bound")
    residual_energy: list[float | None] = of("residual_energy")
    width: list[float | None] = of("width", missing=OTHER_EDGES)
    height: list[float | None] = of("height", missing=OTHER_EDGES)
    alpha_deg: list[float | None] = of("alpha_deg", missing=OTHER_EDGES)
    alpha_left_deg: list[float] = of("alpha_left_deg")
    alpha_right_deg: list[float] = of("alpha_right_deg")
    uplift_acceleration: list[float] = of("uplift_acceleration")
    peak_acceleration: list[float] = of("peak_acceleration")
    period: list[float] = of("period")
    slenderness: list[float | None] = of("slenderness", missing=OTHER_EDGES)
    frequency_ratio: list[float | None] = of("frequency_ratio", missing=OTHER_EDGES)
    restitution: list[float | None] = of("restitution", missing=OTHER_EDGES)
    columns: dict[str, str] = q.said("canonical header of each column of the table that was read, by header", {})
    skipped: list[str] = q.said("columns of the table that were not read: nothing depends on them", [])
    source: str = BY_SOLVER


AMPLITUDES = "all amplitudes at which the outcome changes"


class _Change(BaseModel):
    overturns_above: bool = q.said("true: overturns just above and survives just below; false: the reverse")


class Threshold(_Change):
    """An amplitude at which the outcome changes."""

    peak_acceleration: float = q.said("a_g", unit="m/s2")


class PeriodThreshold(_Change):
    """A period at which the outcome changes, at this amplitude."""

    period: float = q.said("T_p", validation_alias="value", unit="s")


class SizeThreshold(_Change):
    """A size at which the outcome of blocks of this shape changes under this pulse."""

    half_diagonal: float = q.said("R", validation_alias="value", unit="m")


class ScaleThreshold(_Change):
    """A scale at which the outcome changes."""

    scale: float = q.said("factor of the record", unit="-")
    peak_acceleration: float = q.said("PGA of the scaled record", unit="m/s2")


class Margins(BaseModel):
    """Distances of the block from another outcome, by the rigid equation."""

    nearest_acceleration: float | None = of("nearest_acceleration")
    acceleration_factor: float | None = of("acceleration_factor")
    nearest_period: float | None = of("nearest_period")
    period_factor: float | None = of("period_factor")
    smallest_surviving_half_diagonal: float | None = of("smallest_surviving_half_diagonal")
    surviving_from_half_diagonal: float | None = of("surviving_from_half_diagonal")

    periods: list[PeriodThreshold] = q.said("all periods at which the outcome changes, ascending")
    periods_searched: tuple[float, float] = q.said("smallest and largest period searched", unit="s")
    sizes: list[SizeThreshold] = q.said("all sizes of this shape at which the outcome changes, ascending")
    sizes_searched: tuple[float, float] = q.said("smallest and largest half-diagonal searched", unit="m")


class BodyResponse(UnderPulse, InUnitsOfOne, InUnits[BlockParams]):
    """What happens to a body under a pulse whose centre of mass is not that of the block."""

    thresholds: list[Threshold] | None = q.said(f"{AMPLITUDES}, this period, ascending")
    source: str = BY_SOLVER


class BlockResponse(UnderPulse, OfBlock, InUnits[BlockParams]):
    """What happens to the block."""

    frequency_ratio: float = of("frequency_ratio")
    largest_surviving_acceleration: float | None = of("largest_surviving_acceleration")
    largest_surviving_friction_demand: float | None = of("largest_surviving_friction_demand")
    nearest_acceleration: float | None = of("nearest_acceleration")
    nearest_period: float | None = of("nearest_period")
    response: PointResponse = q.said("the same request and response in dimensionless groups")
    thresholds: list[Threshold] | None = q.said(
        f"{AMPLITUDES}, this period, ascending; null if not found in time, see `warnings`"
    )
    margins: Margins | None = q.said("null if they were not found in time, see `warnings`")
    data_version: str | None = q.said("sha256 of the data set that gave the response; null: the solver did")
