"""One block, or many: fate and peak rotation with an error bound."""

from __future__ import annotations

from functools import partial
from typing import Annotated

from fastapi import APIRouter, Query, Request, Response

from rocking._numba.cancellation import StopFlag
from rocking_api.execution.evaluation import BYTES_PER_POINT, ask_many
from rocking_api.http.batch_body import Batch, body_form, limited_body, read_batch
from rocking_api.http.batch_response import batch_response
from rocking_api.http.formats import CONTENT, MEDIA_TYPES, Form, form_of
from rocking_api.http.in_flight import Holding, holding_of
from rocking_api.http.params_route import QuestionRoute, single_parameters
from rocking_api.models.params import ResponseQuestion
from rocking_api.models.responses import BatchAnswer, ResponseAnswer, response_answer
from rocking_api.service import Service, ServiceDep

router = APIRouter(prefix="/v1", tags=["response"], route_class=QuestionRoute)

LARGE_BODY = 1_000_000
"""Bytes beyond which a body is read alone: the numbers of JSON take five times its memory until they are an array."""


@router.get("/response", summary="One block")
async def get_response(question: Annotated[ResponseQuestion, Query()], service: ServiceDep) -> ResponseAnswer:
    """Whether it falls, and how far it rocks."""
    await service.kernels.wait()
    point = await service.together.ask(question)
    service.metrics.points(point.source, 1)
    return response_answer(question, point)


@router.post(
    "/response",
    summary="Many blocks",
    response_model=BatchAnswer,
    responses=CONTENT,
    openapi_extra={
        "requestBody": {
            "required": True,
            "content": {
                MEDIA_TYPES["json"]: {"schema": {"$ref": "#/components/schemas/BatchQuestion"}},
                MEDIA_TYPES["csv"]: {"schema": {"type": "string"}, "example": "slenderness,frequency_ratio\n0.4,5\n"},
                MEDIA_TYPES["nc"]: {"schema": {"type": "string", "format": "binary"}},
            },
        }
    },
)
async def post_response(request: Request, service: ServiceDep) -> Response:
    """Arrays as JSON, CSV or netCDF-3; the answer comes in the same form, or as the Accept header asks.

    With CSV and netCDF-3, `pulse`, `method`, `tolerance`, `alpha_deg` and any of the three groups that the body does
    not hold are parameters of the URL.
    """
    given = body_form(request)
    form = form_of(request, None, default=given)
    holding = holding_of(request)
    batch = await _read(request, service, given, holding)
    holding.replace(batch.nbytes + batch.points * BYTES_PER_POINT)  # the body is gone
    return await service.off_loop(batch.options, lambda stop: _answered(service, batch, form, stop), request)


async def _read(request: Request, service: Service, form: Form, holding: Holding) -> Batch:
    parameters = single_parameters(request)
    settings = service.settings
    body = await limited_body(request, settings.max_body_bytes, settings.arrival_seconds, holding)
    read = partial(read_batch, body, form, parameters, settings.max_points)
    return await service.reading(read, large=len(body) > LARGE_BODY)


def _answered(service: Service, batch: Batch, form: Form, stop: StopFlag) -> Response:
    result = ask_many(service.atlas, batch.options, batch.groups, stop)
    from_cubes = int(result.from_cube.sum())
    service.metrics.points("cube", from_cubes)
    service.metrics.points("solver", batch.points - from_cubes)
    return batch_response(batch, result, form)
