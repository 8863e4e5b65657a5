"""The block from a measured free rocking."""

from __future__ import annotations

import math
from typing import Annotated, Any

import numpy as np
from fastapi import APIRouter, Query, Request, Response
from pydantic import Field
from rocking_api.http.encoding import JsonOrFile, body_form, body_of, csv_response, stated
from rocking_api.http.errors import refusal
from rocking_api.models.answer import InGroups, Url
from rocking_api.models.params import Params
from rocking_api.models.quantity import (
    Column,
    Decimal,
    Delimiter,
    RotationUnit,
    Skip,
    TableFormat,
    TimeStep,
    TimeUnit,
    between,
    said,
)
from rocking_api.models.records import as_parameter
from rocking_api.routers.curves import json_of
from rocking_api.service import ServiceDep

from rocking.extension import (
    UNITS,
    Array,
    InvalidArgumentError,
    RecordFileError,
    StopFlag,
    TextFile,
    finite,
    read_rotations,
)

router = APIRouter(prefix="/v1", tags=["response"])

MAX_SAMPLES = 20_000  # most samples of a trace [-]: a fit takes up to 18 s of processor time, and cannot be stopped

Samples = Annotated[list[float], Field(max_length=MAX_SAMPLES, fail_fast=True)]


class IdentifyParams(Params):
    """Layout of a trace as columns, and options of its fit."""

    edges: int = between(
        1, 2, "1 for a body with equal edges, 2 for one with a right and a left edge", default=1, unit="-"
    )
    confidence: float = said("confidence of the intervals", 0.95, gt=0, le=0.999, unit="-")
    format: TableFormat = None
    rotation: Column = said("column of the rotations: its name, or its number from 1", None)
    time: Column = said("column of the times: its name, or its number from 1", None)
    time_step: TimeStep = None
    time_unit: TimeUnit = None
    unit: RotationUnit | None = said("unit of the rotations; of JSON rad by default", None, title="Rotation_unit")
    skip: Skip = 0
    delimiter: Delimiter = None
    decimal: Decimal = "."


LAYOUT = IdentifyParams.model_fields.keys() - {"edges", "confidence", "format"}


class Trace(IdentifyParams):
    """A trace in a JSON body, and options of its fit."""

    time: Samples = said("times, ascending", unit="s", exclude=True)  # type: ignore[assignment]  # samples in place of a column
    rotation: Samples = said("rotation; positive values turn on the right edge", unit="rad", exclude=True)  # type: ignore[assignment]


class IdentifyResponse(InGroups[IdentifyParams]):
    """The block that rocks as measured: one value for each edge, angles in radians, and the fitted trace."""

    restitution: list[float] = said("eta of the impacts after which it turns on the edge", unit="-")
    restitution_lower: list[float] = said("lower end of its interval", unit="-")
    restitution_upper: list[float] = said("upper end of its interval", unit="-")
    alpha: list[float] = said("slenderness angle", unit="rad")
    alpha_lower: list[float] = said("lower end of its interval", unit="rad")
    alpha_upper: list[float] = said("upper end of its interval", unit="rad")
    frequency_parameter: list[float] = said("p", unit="rad/s")
    frequency_parameter_lower: list[float] = said("lower end of its interval", unit="rad/s")
    frequency_parameter_upper: list[float] = said("upper end of its interval", unit="rad/s")
    drift: float = said("drift of the sensor", unit="rad/s")
    drift_lower: float = said("lower end of its interval", unit="rad/s")
    drift_upper: float = said("upper end of its interval", unit="rad/s")
    edge: list[str] = said("both, or right and left")
    impact_time: list[float] = said("times of the impacts of the fit", unit="s")
    offset: float = said("rotation at rest, at the first impact", unit="rad")
    noise: float = said("standard deviation of the residual", unit="rad")
    sample_noise: float = said("standard deviation of independent errors of the samples", unit="rad")
    time: list[float] = said("times of the samples", unit="s")
    rotation: list[float] = said("rotation as given", unit="rad")
    fitted: list[float | None] = said("rotation of the block; null where nothing is fitted", unit="rad")
    warnings: list[str] = said("why the intervals are wider than the samples alone would have them")


TRACE_NUMBERS = ("offset", "drift", "drift_lower", "drift_upper", "noise", "sample_noise")
"""Fields with one value for the trace."""

EDGE_COLUMNS = [name for name in IdentifyResponse.model_fields if name.startswith(("edge", "rest", "alpha", "freq"))]
"""Fields with one value for each edge."""


MAX_BODY = 1024 * 1024  # largest trace [bytes]


def _example() -> dict[str, list[float]]:
    """Six flights of a slender block, alpha = 0.2 rad, p = 2.5 rad/s, eta = 0.9, released at alpha/2, each 0.02 s."""
    alpha, p, eta, step = 0.2, 2.5, 0.9, 0.02
    start, gap, sign = 0.0, 0.5, 1.0  # gap: 1 - peak/alpha
    rotation: list[float] = []
    ends = []
    for flight in range(6):
        half = math.acosh(1.0 / gap) / p
        top = start if flight == 0 else start + half
        start = top + half
        ends.append((top, gap, sign, start))
        gap, sign = math.sqrt(1.0 - eta**2 * (1.0 - gap**2)), -sign
    times = [k * step for k in range(int(start / step))]
    for time in times:
        top, gap, sign, _ = next(flight for flight in ends if time < flight[-1])
        rotation.append(round(sign * alpha * (1.0 - gap * math.cosh(p * (time - top))), 5))
    return {"time": [round(time, 2) for time in times], "rotation": rotation}


EXAMPLE = _example()  # A trace for the description of the route

_CSV = "time [s],rotation [rad]\n" + "".join(f"{t},{r}\n" for t, r in zip(*EXAMPLE.values(), strict=True))


@router.post(
    "/identify",
    summary="The block from a measured free rocking",
    response_model=IdentifyResponse,
    responses={200: {"content": {"text/csv": {}}}},
    openapi_extra=body_of(
        EXAMPLE, {"text/csv": _CSV}, "times and rotations of a sensor or a video, with noise and an offset"
    ),
)
async def post_identify(
    body: JsonOrFile[Trace],
    query: Annotated[IdentifyParams, Query()],
    request: Request,
    service: ServiceDep,
    url: Url,
) -> Any:
    """Restitution, slenderness angle and frequency parameter with intervals, as `identify_free_rocking`.

    The body is JSON, or CSV with the columns `time [s],rotation [rad]`, or in a layout that the parameters state.
    The response has the format of the body, or that of `format`. CSV has a row for each edge.
    """
    form_of_body = body_form(request, ("json", "csv"))
    params = stated(body, query)

    def work(stop: StopFlag) -> Response:
        time, rotation = _read(params, body, stop)
        return _identified(params, time, rotation, params.format or form_of_body, url, stop)

    return await service.solve(work, request)


def _read(params: IdentifyParams, body: Trace | bytes, stop: StopFlag) -> tuple[Array, Array]:
    """Times [s] and rotations [rad]."""
    if isinstance(body, Trace):
        for name in sorted(LAYOUT - {"time", "rotation", "unit"}):
            value = getattr(params, name)
            if value != IdentifyParams.model_fields[name].default:
                raise InvalidArgumentError(name, value, "nothing about columns beside JSON, whose times are in s")
        return np.array(body.time), UNITS["rad"][params.unit or "rad"] * np.array(body.rotation)
    layout = {name: getattr(params, name) for name in LAYOUT}
    try:
        return read_rotations(TextFile("trace", body, stop), MAX_SAMPLES, **layout)
    except RecordFileError as error:
        raise refusal(error.message(as_parameter, "?", "&"), "record", error.value, error.expected) from None


def _identified(params: IdentifyParams, time: Array, rotation: Array, form: str, url: str, stop: StopFlag) -> Response:
    # scipy.stats takes longer to import than the service to start
    from rocking_assessment._evidence.free_rocking import identify_free_rocking  # noqa: PLC0415

    block = identify_free_rocking(time, rotation, edges=params.edges, confidence=params.confidence, stop=stop)
    edges = {name: block[name].values.tolist() for name in EDGE_COLUMNS}
    if form == "csv":
        return csv_response(edges, "identified")
    columns: dict[str, Any] = {name: block[name].values.tolist() for name in ("time", "rotation", "impact_time")}
    columns["fitted"] = [finite(value) for value in block["fitted"].values.tolist()]
    columns |= {name: block[name].item() for name in TRACE_NUMBERS}
    columns["warnings"] = list(filter(None, block.attrs["warnings"].split("; ")))
    return json_of(IdentifyResponse.model_construct(query=params, url=url, **edges, **columns))
