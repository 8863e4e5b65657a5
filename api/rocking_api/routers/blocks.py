"""A block in metres under a pulse in m/s2 and seconds."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Annotated, Any
from urllib.parse import urlencode

import numpy as np
from fastapi import APIRouter, Query, Request, Response

from rocking._base.errors import InvalidArgumentError, SeveralArgumentsError, TableFileError
from rocking._base.quantities import GROUPS
from rocking._dimensional.problem import Problem
from rocking._dimensional.response import interpolated_response, respond
from rocking._dimensional.table import BlockTable, read_table, respond_table
from rocking._numba.cancellation import StopFlag
from rocking_api.execution.evaluation import evaluate
from rocking_api.http.encoding import JsonOrFile, body_form, body_of, csv_response, stated
from rocking_api.http.errors import TooLargeError
from rocking_api.models import blocks as m
from rocking_api.models.answer import Url
from rocking_api.models.params import ResponseParams
from rocking_api.models.pulses import digest_of, name_of
from rocking_api.models.quantity import FREQUENCY_RATIO, SLENDERNESS, WithUnit, served
from rocking_api.models.responses import point_response
from rocking_api.models.table import table_refusal
from rocking_api.service import SEARCH_SHARE, Service, ServiceDep

router = APIRouter(prefix="/v1/blocks", tags=["response"])

MAX_BODY = 4 * 1024 * 1024  # largest table of blocks [bytes]

_CSV = "name,width [m],height [cm],peak_acceleration [g],period [s]\nvase,0.2,80,0.4,0.5\n"

_JSON = {
    "pulse": "sine",
    "blocks": [
        {"name": "vase", "width": 0.2, "height": 0.8, "peak_acceleration": 4.0, "period": 0.5},
        {"name": "column", "width": 1.0, "height": 6.0, "peak_acceleration": 4.0, "period": 0.5},
    ],
}

BY_SOLVER = "no data set covers this block within the tolerance; the solver was used, with its own error bound"


@router.get("/response", summary="A block in SI units")
async def get_block(
    params: Annotated[m.BlockParams, Query()], request: Request, service: ServiceDep, url: Url
) -> m.BlockResponse | m.BodyResponse:
    """Outcome, rotation in degrees, displacement in metres, distance to another outcome, friction, by (2.2).

    A body with other edges than those of a block is solved by them, and has no response in groups.
    """
    return await service.solve_one(lambda stop: _block(service, params, url, stop), request)


@router.post(
    "/response",
    summary="Many blocks in SI units",
    response_model=m.BlocksResponse,
    responses={200: {"content": {"text/csv": {}}}},
    openapi_extra=body_of(_JSON, {"text/csv": _CSV}),
)
async def post_blocks(
    body: JsonOrFile[m.BlockRows],
    params: Annotated[m.BlocksParams, Query()],
    request: Request,
    service: ServiceDep,
    url: Url,
) -> Any:
    """JSON, or CSV with units in its header; the response has the same format, or that of `format`.

    Columns of CSV: width, height, peak_acceleration, period, each with its unit in brackets or in its cells, and
    optionally name and restitution; or the parameters of another kind of body. Others are not used, see `skipped`;
    `columns` states other headers.
    """
    given = body_form(request, ("json", "csv"))
    shared = stated(body, params)

    def work(stop: StopFlag) -> m.BlocksResponse | Response:
        table = _read_table(body, shared, stop)
        columns: dict[str, Any] = {**respond_table(table, stop)}
        if (shared.format or given) == "csv":
            return csv_response(columns, "blocks")
        columns |= {name: getattr(table.read, name) for name in ("columns", "skipped")}
        query = m.BlocksQuery.model_construct(  # the name of samples is no name of a pulse
            pulse=name_of(shared.pulse),
            restitution=shared.restitution,
            format=shared.format,
            pulse_digest=digest_of(shared.pulse),
        )
        answer = m.BlocksResponse.model_construct(query=query, url=url, **columns)
        return Response(answer.model_dump_json(), media_type="application/json")

    return await service.solve_one(work, request)


def _read_table(body: m.BlockRows | bytes, params: m.BlocksParams | m.BlockRows, stop: StopFlag) -> BlockTable:
    """The blocks of a body, each checked."""
    if params.pulse is None:
        raise InvalidArgumentError("pulse", None, "required in the query beside CSV, or in a JSON body")
    if isinstance(body, bytes):
        text = body.decode("utf-8-sig", "replace")
        options: dict[str, Any] = {"most": m.MAX_BLOCKS, "stop": stop, "limited": served, "layout": params.layout}
        try:
            table = read_table(text, params.pulse, params.restitution, **options)
        except TableFileError as error:
            raise table_refusal(error) from None
        table.check()
    else:
        if len(body.blocks) > m.MAX_BLOCKS:
            raise TooLargeError("blocks", len(body.blocks), f"at most {m.MAX_BLOCKS}")
        errors, problems = [], []
        for k, row in enumerate(body.blocks):
            try:
                eta = params.restitution if row.restitution is None else row.restitution
                made = row.made(restitution=eta)
                problems.append(Problem.of(made, params.pulse, row.peak_acceleration, row.period, eta))
            except InvalidArgumentError as error:
                errors.append(InvalidArgumentError(f"blocks[{k}].{error.parameter}", error.value, error.allowed))
        if errors:
            raise SeveralArgumentsError(errors)
        names = [row.name for row in body.blocks]
        table = BlockTable(problems, names if any(names) else [])
    if not table.problems:
        raise InvalidArgumentError("blocks", "none", "at least one block")
    return table


def _block(service: Service, params: m.BlockParams, url: str, stop: StopFlag) -> m.BlockResponse | m.BodyResponse:
    peak = params.peak_acceleration
    problem = Problem.of(params.rocking_body, params.pulse, peak, params.period, params.restitution)
    problem = replace(problem, unit_is_stated=isinstance(peak, WithUnit))
    if not problem.body.moves_as_block:
        if params.method == "cube":
            raise InvalidArgumentError("method", params.method, "auto or solver: data sets hold blocks only")
        found = respond(problem, stop=stop, error_bound=True)
        fields: dict[str, Any] = {"thresholds": found.changes, **found.summary()}
        return m.BodyResponse(query=params, url=url, **fields)
    groups = problem.groups
    for quantity in (SLENDERNESS, FREQUENCY_RATIO):
        quantity.convert(groups[quantity.name])
    values: dict[str, Any] = {name: value for name, value in groups.items() if name != "alpha"}
    values |= {name: getattr(params, name) for name in ("pulse", "method", "absolute_tolerance")}
    dimensionless = ResponseParams.model_construct(**values, alpha_deg=math.degrees(groups["alpha"]))
    looked_up = None
    versions: tuple[str, ...] = ()
    if params.method != "solver":
        points = np.array([groups[quantity.name] for quantity in GROUPS]).reshape(4, 1)
        looked_up, versions = evaluate(service.cubes, dimensionless, points, stop)
    from_cube = looked_up is not None and bool(looked_up.from_cube)
    if from_cube:
        found = interpolated_response(problem, looked_up, stop)
    else:
        found = respond(problem, stop=stop, error_bound=True)
    seconds = SEARCH_SHARE * service.settings.max_seconds
    found = replace(found, seconds=seconds, served=(FREQUENCY_RATIO.lower, FREQUENCY_RATIO.upper))
    fields = {"thresholds": found.changes, **found.summary()}
    fields["notes"] = [*([] if from_cube else [BY_SOLVER]), *fields["notes"]]
    fields["margins"] = found.margins and m.Margins.model_validate(found.margins, from_attributes=True)
    in_groups = f"/v1/response?{urlencode(dict(dimensionless))}"
    point = point_response(dimensionless, found, from_cube, versions, in_groups)
    return m.BlockResponse(query=params, url=url, response=point, data_version=point.data_version, **fields)
