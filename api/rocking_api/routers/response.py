"""One block, or many: outcome and peak rotation with an error bound."""

from __future__ import annotations

import math
from typing import Annotated, Any

import numpy as np
from fastapi import APIRouter, Query, Request, Response

from rocking._base.errors import InvalidArgumentError
from rocking._lookup.cube import UnreadError
from rocking._numba.cancellation import StopFlag
from rocking_api.execution.evaluation import evaluate, evaluate_many
from rocking_api.http import encoding
from rocking_api.http.errors import TooLargeError
from rocking_api.models.answer import Url
from rocking_api.models.batch import Batch, Columns, batch_of, parse_csv, parse_netcdf
from rocking_api.models.params import GROUPS, LookupOptions, ResponseParams, TableParams
from rocking_api.models.pulses import BatchBody, digest_of, name_of
from rocking_api.models.responses import BatchQuery, BatchResponse, PointResponse, columns_of, point_response
from rocking_api.service import Service, ServiceDep

router = APIRouter(prefix="/v1", tags=["response"])

MAX_INLINE_RESTITUTION = 0.9
"""Restitution above which one block is computed in a thread [-]. Up to it a block has at most a few hundred impacts,
half a millisecond; an elastic one has up to `IMPACT_LIMIT` impacts, a third of a second."""

MAX_JSON_POINTS = 100_000
"""Most points of a response in JSON [-], which is held as a whole; CSV and netCDF have no such limit."""


@router.get("/response", summary="One block")
async def get_response(params: Annotated[ResponseParams, Query()], service: ServiceDep, url: Url) -> PointResponse:
    """Whether it overturns, and its peak rotation."""
    if not service.kernels.is_loaded:
        await service.kernels.wait()
    alpha = math.radians(params.alpha_deg or 0.0)
    points = np.array((params.slenderness, params.frequency_ratio, params.restitution, alpha)).reshape(4, 1)
    try:
        if params.restitution > MAX_INLINE_RESTITUTION:
            raise UnreadError
        found, versions = evaluate(service.cubes, params, points, may_read=False)
    except UnreadError:
        found, versions = await service.cheap.run(lambda stop: evaluate(service.cubes, params, points, stop))
    return point_response(params, found, bool(found.from_cube), versions, url)


_GROUPS_CSV = "slenderness,frequency_ratio,restitution\n0.4,5,0.85\n0.2,5,0.85\n"
_JSON = {"pulse": "sine", "slenderness": [0.4, 0.2, 1.2], "frequency_ratio": 5, "restitution": 0.85}
_BODY = encoding.body_of(_JSON, {"text/csv": _GROUPS_CSV})
_BODY["requestBody"]["content"]["application/x-netcdf"] = {"schema": {"type": "string", "format": "binary"}}


@router.post(
    "/response",
    summary="Many blocks",
    response_model=BatchResponse,
    responses=encoding.CONTENT,
    openapi_extra=_BODY,
)
async def post_response(
    body: encoding.JsonOrFile[BatchBody],
    params: Annotated[TableParams, Query()],
    request: Request,
    service: ServiceDep,
    url: Url,
) -> Any:
    """Arrays as JSON, CSV or netCDF-3; the response has the same format, or that of `format`.

    JSON holds all parameters; beside CSV and netCDF they are in the query, also groups that the table does not hold.
    """
    given = encoding.body_form(request, ("json", "csv", "nc"))
    shared = encoding.stated(body, params)
    if shared.pulse is None:
        raise InvalidArgumentError("pulse", None, "required in the query")

    def work(stop: StopFlag) -> BatchResponse | Response:
        batch = _batch(body, shared, given, service.settings.max_points, stop)
        return _answered(service, batch, shared.format or given, url, stop)

    return await service.solve_one(work, request)


def _batch(body: BatchBody | bytes, params: BatchBody | TableParams, given: str, most: int, stop: StopFlag) -> Batch:
    """The points of a request."""
    options = LookupOptions.model_construct(**{name: getattr(params, name) for name in LookupOptions.model_fields})
    columns: Columns = {}
    if isinstance(body, bytes):
        columns = parse_csv(body, most, stop) if given == "csv" else parse_netcdf(body, most)
    return batch_of(options, columns, {name: getattr(params, name) for name in GROUPS}, most)


def _answered(
    service: Service, batch: Batch, form: encoding.Form, url: str, stop: StopFlag
) -> BatchResponse | Response:
    if form == "json" and batch.points > MAX_JSON_POINTS:
        raise TooLargeError("points", batch.points, f"at most {MAX_JSON_POINTS} in JSON; ask for format csv or nc")
    result = evaluate_many(service.cubes, batch.options, batch.groups, stop)
    options = {name: getattr(batch.options, name) for name in LookupOptions.model_fields}
    columns = columns_of(result)
    if form == "csv":
        return encoding.csv_stream(encoding.columns_as_they_are(batch.groups) | columns, batch.points, "response")
    pulse = batch.options.pulse
    options |= {"pulse": name_of(pulse), "pulse_digest": digest_of(pulse), "points": batch.points}
    if form == "nc":
        attributes = {name: value for name, value in options.items() if value is not None}
        dataset = encoding.dataset_of(batch.groups, result, attributes)
        return encoding.netcdf_response(dataset, "response", "Response of blocks to a pulse", url)
    lists: dict[str, Any] = {name: column(slice(None)) for name, column in columns.items()}
    query = BatchQuery.model_construct(**options)
    answer = BatchResponse.model_construct(query=query, url=url, data_versions=list(result.versions), **lists)
    return Response(answer.model_dump_json(), media_type="application/json")
