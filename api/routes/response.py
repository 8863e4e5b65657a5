"""One block, or many: fate and peak rotation with an error bound."""

from __future__ import annotations

from functools import partial
from typing import Annotated

from fastapi import APIRouter, Query, Request, Response
from numpy.typing import ArrayLike

from api.answers import BatchAnswer, ResponseAnswer, columns_of, response_answer
from api.batch import Batch, body_form, limited_body, read_batch
from api.formats import CONTENT, MEDIA_TYPES, Form, csv_response, dataset_of, form_of, json_response, netcdf_response
from api.questions import LookupOptions, ResponseQuestion, alpha_of, checked
from api.service import Service, ServiceDep
from rocking.bounded_response import BoundedResponse
from rocking.lookup_atlas import Atlas

router = APIRouter(prefix="/v1", tags=["response"])


@router.get("/response", summary="One block")
async def get_response(question: Annotated[ResponseQuestion, Query()], service: ServiceDep) -> ResponseAnswer:
    """Whether it falls, and how far it rocks."""
    work = partial(
        ask,
        service.atlas,
        question,
        slenderness=question.slenderness,
        frequency_ratio=question.frequency_ratio,
        restitution=question.restitution,
    )
    # well below a millisecond, unless a cube has to be read first
    at_once = question.method == "solver" or service.atlas.is_open(question.pulse, question.restitution)
    found, versions = work() if at_once else await service.off_loop(work)
    return response_answer(question, found, versions)


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
    body = await limited_body(request, service.settings.max_body_bytes)
    parameters = dict(request.query_params)
    return await service.off_loop(lambda: _answer(service, body, given, form, parameters))


def ask(
    atlas: Atlas,
    options: LookupOptions,
    *,
    slenderness: ArrayLike,
    frequency_ratio: ArrayLike,
    restitution: ArrayLike,
) -> tuple[BoundedResponse, tuple[str, ...]]:
    """Ask the atlas with the options of a question."""
    return atlas.response(
        options.pulse,
        slenderness=checked("slenderness", slenderness),
        frequency_ratio=checked("frequency_ratio", frequency_ratio),
        restitution=restitution,
        alpha=alpha_of(options.alpha_deg),
        tolerance=options.tolerance,
        method=options.method,
    )


def _answer(service: Service, body: bytes, given: Form, form: Form, parameters: dict[str, str]) -> Response:
    batch: Batch = read_batch(body, given, parameters, service.settings.max_points)
    found, versions = ask(service.atlas, batch.options, **batch.groups)
    query = batch.options.model_dump() | {"points": batch.points}
    if form == "json":
        columns = columns_of(found)
        return json_response(BatchAnswer.model_construct(query=query, data_versions=list(versions), **columns))
    if form == "csv":
        groups = {name: values.tolist() for name, values in batch.groups.items()}
        return csv_response(groups | columns_of(found), "response")
    attributes = {name: value for name, value in query.items() if value is not None}
    return netcdf_response(dataset_of(batch.groups, found, attributes), "response")
