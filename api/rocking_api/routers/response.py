"""One block, or many: outcome and peak rotation with an error bound."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Query, Request, Response

from rocking._numba.cancellation import StopFlag
from rocking_api.execution.evaluation import BYTES_PER_POINT, evaluate_many
from rocking_api.http.batch import Batch, batch_response, body_form, read_batch
from rocking_api.http.encoding import CONTENT, MEDIA_TYPES, Form, negotiated_form
from rocking_api.http.memory_budget import reservation_of
from rocking_api.http.params_route import ParamsRoute, query_parameters
from rocking_api.models.params import BatchParams, ResponseParams
from rocking_api.models.pulses import schema_of
from rocking_api.models.responses import BatchResponse, PointResponse, point_response
from rocking_api.service import Service, ServiceDep

router = APIRouter(prefix="/v1", tags=["response"], route_class=ParamsRoute)

LARGE_BODY = 1_000_000
"""Bytes beyond which bodies are parsed one at a time. Smaller ones take some hundredths of a second."""


@router.get("/response", summary="One block")
async def get_response(params: Annotated[ResponseParams, Query()], service: ServiceDep) -> PointResponse:
    """Whether it overturns, and its peak rotation."""
    await service.kernels.wait()
    point = await service.batcher.evaluate(params)
    service.metrics.points(point.source, 1)
    return point_response(params, point)


@router.post(
    "/response",
    summary="Many blocks",
    response_model=BatchResponse,
    responses=CONTENT,
    openapi_extra={
        "parameters": [
            {
                "name": "pulse",
                "in": "query",
                "description": "pulse, required for CSV and netCDF-3; a JSON body holds it",
                "schema": {"type": "string", "examples": ["sine"]},
            }
        ],
        "requestBody": {
            "required": True,
            "content": {
                MEDIA_TYPES["json"]: {
                    "schema": schema_of(BatchParams),
                    "example": {
                        "pulse": "sine",
                        "slenderness": [0.4, 0.2, 1.2],
                        "frequency_ratio": 5,
                        "restitution": 0.85,
                    },
                },
                MEDIA_TYPES["csv"]: {
                    "schema": {"type": "string"},
                    "example": "slenderness,frequency_ratio,restitution\n0.4,5,0.85\n0.2,5,0.85\n",
                },
                MEDIA_TYPES["nc"]: {"schema": {"type": "string", "format": "binary"}},
            },
        },
    },
)
async def post_response(request: Request, service: ServiceDep) -> Response:
    """Arrays as JSON, CSV or netCDF-3; the response has the same format, or that of the Accept header.

    With CSV and netCDF-3, `pulse`, `method`, `absolute_tolerance`, `alpha_deg` and any of the three groups that the
    body does not hold are query parameters.
    """
    given = body_form(request)
    form = negotiated_form(request, None, default=given)
    batch = await _read(request, service, given)
    reservation_of(request).replace(batch.nbytes + batch.points * BYTES_PER_POINT)  # the body is released
    return await service.run_heavy(batch.options, lambda stop: _answered(service, batch, request, form, stop), request)


async def _read(request: Request, service: Service, given: Form) -> Batch:
    parameters = query_parameters(request)
    settings = service.settings
    body = await service.read_body(request, settings.max_body_bytes)

    def read(stop: StopFlag) -> Batch:
        return read_batch(body, given, parameters, settings.max_points, stop)

    return await service.run_parser(read, request, large=len(body) > LARGE_BODY)


def _answered(service: Service, batch: Batch, request: Request, form: Form, stop: StopFlag) -> Response:
    result = evaluate_many(service.cubes, batch.options, batch.groups, stop)
    from_cubes = int(result.from_cube.sum())
    service.metrics.points("cube", from_cubes)
    service.metrics.points("solver", batch.points - from_cubes)
    return batch_response(batch, request, result, form)
