"""A measured free rocking: parameters, body and response."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from rocking_api.models.answer import InGroups
from rocking_api.models.params import Params
from rocking_api.models.quantity import TableFormat, TimeStep, between, said, with_intervals

MAX_SAMPLES = 20_000  # most samples of a trace [-]: a fit takes up to 18 s of processor time, and cannot be stopped

Samples = Annotated[list[float], Field(max_length=MAX_SAMPLES, fail_fast=True)]


class IdentifyParams(Params):
    """How a trace is read and fitted."""

    edges: int = between(1, 2, "1 for a body with equal edges, 2 for one with a right and a left edge [-]", default=1)
    degrees: bool = said("the rotations are in degrees, not in radians, where the header of CSV states no unit", False)
    time_step: TimeStep = said("time between the rows where CSV counts them in place of times [s]", None)
    confidence: float = said(
        "confidence of the intervals [-]", 0.95, json_schema_extra={"exclusiveMinimum": 0, "maximum": 0.999}
    )
    format: TableFormat = None


class Trace(IdentifyParams):
    """A trace in a JSON body, and how it is read and fitted."""

    time: Samples = said("times, ascending [s]")
    rotation: Samples = said("rotation; positive values turn on the right edge [rad]")


@with_intervals(
    restitution=(list[float], "eta of the impacts after which it turns on the edge", "-"),
    alpha=(list[float], "slenderness angle", "rad"),
    frequency_parameter=(list[float], "p", "rad/s"),
    drift=(float, "drift of the sensor", "rad/s"),
)
class IdentifyResponse(InGroups[IdentifyParams]):
    """The block that rocks as measured: one value for each edge, angles in radians, and the fitted trace."""

    edge: list[str] = said("both, or right and left")
    impact_time: list[float] = said("times of the impacts of the fit [s]")
    offset: float = said("rotation at rest, at the first impact [rad]")
    noise: float = said("standard deviation of the residual [rad]")
    sample_noise: float = said("standard deviation of independent errors of the samples [rad]")
    time: list[float] = said("times of the samples [s]")
    rotation: list[float] = said("rotation as given [rad]")
    fitted: list[float | None] = said("rotation of the block [rad]; null where nothing is fitted")
    warnings: list[str] = said("why the intervals are wider than the samples alone would have them")


TRACE_NUMBERS = ("offset", "drift", "drift_lower", "drift_upper", "noise", "sample_noise")
"""Fields with one value for the trace."""

EDGE_COLUMNS = [name for name in IdentifyResponse.model_fields if name.startswith(("edge", "rest", "alpha", "freq"))]
"""Fields with one value for each edge."""
