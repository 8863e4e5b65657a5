"""One block, or many: outcome and peak rotation with an error bound."""

from __future__ import annotations

import math
from typing import Annotated, Any

import numpy as np
from fastapi import APIRouter, Query, Request, Response

from rocking._lookup.cube import UnreadError
from rocking._numba.cancellation import StopFlag
from rocking_api.execution.evaluation import BYTES_PER_POINT, evaluate, evaluate_many
from rocking_api.http import encoding
from rocking_api.http.body import body_form
from rocking_api.http.parameters import ParamsRoute
from rocking_api.models.batch import Batch, Columns, batch_of, parse_csv, parse_netcdf
from rocking_api.models.bodies import body_of, json_content, text_content
from rocking_api.models.params import BatchOptions, BatchParams, LookupOptions, ResponseParams, TableParams
from rocking_api.models.pulses import options_of, with_samples
from rocking_api.models.responses import SOURCES, BatchResponse, PointResponse, columns_of, point_response
from rocking_api.service import Service, ServiceDep

router = APIRouter(prefix="/v1", tags=["response"], route_class=ParamsRoute)

MAX_JSON = 2 * 1024 * 1024
"""Largest JSON body [bytes], fifty thousand blocks: pydantic holds the interpreter lock for 0.015 s to read it."""


MAX_INLINE_RESTITUTION = 0.9
"""Restitution above which one block is computed in a thread [-]. Up to it a block has at most a few hundred impacts,
half a millisecond; an elastic one has up to `IMPACT_LIMIT` impacts, a third of a second."""


@router.get("/response", summary="One block")
async def get_response(params: Annotated[ResponseParams, Query()], service: ServiceDep) -> PointResponse:
    """Whether it overturns, and its peak rotation."""
    if not service.kernels.is_loaded:
        await service.kernels.wait()
    alpha = math.radians(params.alpha_deg or 0.0)
    points = np.array((params.slenderness, params.frequency_ratio, params.restitution, alpha)).reshape(4, 1)
    try:
        if params.restitution > MAX_INLINE_RESTITUTION:
            raise UnreadError
        found = evaluate(service.cubes, params, points, may_read=False)
    except UnreadError:
        found = await service.single.run(lambda stop: evaluate(service.cubes, params, points, stop))
    service.metrics.points(SOURCES[found[0].from_cube.item()], 1)
    return point_response(params, *found)


@router.post(
    "/response",
    summary="Many blocks",
    response_model=BatchResponse,
    responses=encoding.CONTENT,
    openapi_extra=body_of(
        {
            **json_content(
                with_samples(BatchParams),
                {"pulse": "sine", "slenderness": [0.4, 0.2, 1.2], "frequency_ratio": 5, "restitution": 0.85},
            ),
            **text_content(
                encoding.MEDIA_TYPES["csv"], "slenderness,frequency_ratio,restitution\n0.4,5,0.85\n0.2,5,0.85\n"
            ),
            encoding.MEDIA_TYPES["nc"]: {"schema": {"type": "string", "format": "binary"}},
        },
        BatchOptions,
    ),
)
async def post_response(request: Request, service: ServiceDep) -> Response:
    """Arrays as JSON, CSV or netCDF-3; the response has the same format, or that of `format` or `Accept`.

    The three groups, where the body does not hold them, are query parameters, too.
    """
    batch, form = await _read(request, service)
    service.reservation(request).replace(batch.nbytes + batch.points * BYTES_PER_POINT)  # the body is released
    return await service.run_heavy(lambda stop: _answered(service, batch, request, form, stop), request)


async def _read(request: Request, service: Service) -> tuple[Batch, encoding.Form]:
    """The points of a request, and the format of its response."""
    given, most = body_form(request, ("json", "csv", "nc")), service.settings.max_points
    limit, hint = service.settings.max_body_bytes, ""
    if given == "json":
        limit, hint = min(limit, MAX_JSON), " in JSON; send larger tables as CSV or netCDF"
    params, body = await service.read(request, TableParams, given, with_samples(BatchParams), limit, hint)

    def read(stop: StopFlag) -> Batch:
        columns: Columns = {}
        if isinstance(body, bytes):
            columns = parse_csv(body, most, stop) if given == "csv" else parse_netcdf(body, most)
        return batch_of(options_of(params, LookupOptions), columns, dict(params), most)

    batch = await service.run_parser(read, request)
    return batch, encoding.negotiated_form(request, params.format, default=given)


def _answered(service: Service, batch: Batch, request: Request, form: encoding.Form, stop: StopFlag) -> Response:
    result = evaluate_many(service.cubes, batch.options, batch.groups, stop)
    from_cubes = int(result.from_cube.sum())
    service.metrics.points("cube", from_cubes)
    service.metrics.points("solver", batch.points - from_cubes)
    query: dict[str, Any] = batch.options.model_dump() | {"points": batch.points}
    if form == "nc":
        attributes = {name: value for name, value in query.items() if value is not None}
        return encoding.netcdf_response(encoding.dataset_of(batch.groups, result, attributes), "response")
    columns = columns_of(result)  # JSON and CSV are written while they are sent
    if form == "csv":
        return encoding.csv_stream(encoding.columns_as_they_are(batch.groups) | columns, batch.points, "response")
    answer = BatchResponse.model_construct(query=query, data_versions=list(result.versions))
    return encoding.json_stream(answer, request, columns, batch.points)
