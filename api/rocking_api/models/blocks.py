"""A block in metres under a pulse in m/s2 and seconds: parameters and response."""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated, Literal

from pydantic import BaseModel

from rocking._dimensional.margins import MARGINS
from rocking._dimensional.table import RESPONSES
from rocking_api.models import quantity as q
from rocking_api.models.answer import BY_SOLVER, Echoed, InUnits
from rocking_api.models.body_params import BodyParams, BodyShape, JsonBody
from rocking_api.models.params import Params
from rocking_api.models.pulses import GivenPulse
from rocking_api.models.responses import PointResponse, declared, with_fields

MAX_BLOCKS = 10_000  # most blocks of a body [-]: each is an object, unlike the points of /v1/response


class BlockParams(BodyParams):
    """A body and a pulse in SI units."""

    pulse: q.PulseName
    peak_acceleration: q.PeakAcceleration
    period: q.Period
    method: q.Method = "auto"
    absolute_tolerance: q.AbsoluteTolerance = 1e-4


class BlocksParams(Params):
    """Values that many blocks of a body share."""

    pulse: q.PulseName | None = q.said("required unless a JSON body holds it", None, examples=["sine"])
    restitution: q.BodyRestitution = q.said("eta [-] where a block has none; momentum, kalliontzis(k=0.8)", "momentum")
    format: q.TableFormat = None


class BlockRow(BodyShape):
    """One of many bodies in JSON, in SI units."""

    body: JsonBody  # type: ignore[assignment]  # a text once it is read
    name: str = q.said("label", "", max_length=200)
    peak_acceleration: q.PeakAcceleration
    period: q.Period
    restitution: q.BodyRestitution | None = q.said("eta [-], or momentum; absent: the one for all blocks", None)


class BlockRows(BlocksParams):
    """Many blocks in a JSON body, and the values that they share."""

    blocks: list[BlockRow] = q.said("blocks, in the order of the response", json_schema_extra={"maxItems": MAX_BLOCKS})
    pulse: GivenPulse | None = q.said(  # type: ignore[assignment]
        "a pulse by its name, or by samples; absent: the pulse of the query", None
    )


_OF_TABLE = [
    one
    if one.missing or one.kinds >= {"edges"}
    else replace(one, missing="the edges of the body differ from those of a block")
    for one in RESPONSES
]
"""Columns of `respond_table`."""


@declared(_OF_TABLE, many=True)
class BlocksResponse(Echoed[BlocksParams], InUnits[BlocksParams]):
    """Many bodies: one value for each, in the order of the body; SI units, degrees and groups."""

    name: list[str] | None = q.said("labels; null without any", None)
    body: list[str] | None = q.said("kind of each body; null if all are blocks", None)
    columns: dict[str, str] = q.said("meaning of the columns of the table that were read, by header", {})
    skipped: list[str] = q.said(
        "columns of the table that were not read, such as a thickness: nothing depends on them", []
    )
    totals: list[str] = q.said("rows of totals of the table, which are no blocks, with their first cells", [])
    source: str = BY_SOLVER


AMPLITUDES = "all amplitudes at which the outcome changes"
NOTES = q.said("what else is worth knowing")

Edge = Annotated[
    Literal["right", "left"] | None,
    q.said("edge of the largest |theta|/alpha, or about which it overturns; null: no uplift"),
]


class _Change(BaseModel):
    overturns_above: bool = q.said("true: overturns just above and survives just below; false: the reverse")


class Threshold(_Change):
    """An amplitude at which the outcome changes."""

    peak_acceleration: float = q.said("a_g [m/s2]")


class PeriodThreshold(_Change):
    """A period at which the outcome changes, at this amplitude."""

    period: float = q.said("T_p [s]", validation_alias="value")


class SizeThreshold(_Change):
    """A size at which the outcome of blocks of this shape changes under this pulse."""

    half_diagonal: float = q.said("R [m]", validation_alias="value")


class ScaleThreshold(_Change):
    """A scale at which the outcome changes."""

    scale: float = q.said("factor of the record [-]")
    peak_acceleration: float = q.said("PGA of the scaled record [m/s2]")


@declared(MARGINS)
class Margins(BaseModel):
    """Distances of the block from another outcome, by the rigid equation."""

    periods: list[PeriodThreshold] = q.said("all periods at which the outcome changes, ascending")
    periods_searched: tuple[float, float] = q.said("smallest and largest period searched [s]")
    sizes: list[SizeThreshold] = q.said("all sizes of this shape at which the outcome changes, ascending")
    sizes_searched: tuple[float, float] = q.said("smallest and largest half-diagonal searched [m]")


@with_fields("pulse", "edges")
class BodyResponse(InUnits[BlockParams]):
    """What happens to a body under a pulse whose centre of mass is not that of the block."""

    edge: Edge
    thresholds: list[Threshold] | None = q.said(f"{AMPLITUDES}, this period, ascending")
    notes: list[str] = NOTES
    source: str = BY_SOLVER


@with_fields("pulse", "block")
class BlockResponse(InUnits[BlockParams]):
    """What happens to the block."""

    response: PointResponse = q.said("the same request and response in dimensionless groups")
    thresholds: list[Threshold] | None = q.said(
        f"{AMPLITUDES}, this period, ascending; null if not found in time, see `warnings`"
    )
    margins: Margins | None = q.said("null if they were not found in time, see `warnings`")
    notes: list[str] = NOTES
    data_version: str | None = q.said("sha256 of the data set that gave the response; null: the solver did")
