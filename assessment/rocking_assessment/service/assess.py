"""Many objects at a site: which of them its motions overturn."""

from __future__ import annotations

import json
from typing import Annotated, Any

from fastapi import APIRouter, Query, Request, Response
from fastapi.responses import PlainTextResponse
from rocking_api.http.encoding import JsonOrFile, body_form, body_of, stated, text_response
from rocking_api.http.errors import TooLargeError
from rocking_api.models.answer import Url
from rocking_api.models.table import table_refusal
from rocking_api.routers.curves import json_of
from rocking_api.service import ServiceDep

from rocking.extension import InvalidArgumentError, StopFlag, TableFileError, text_of
from rocking_assessment._objects.assess import assess
from rocking_assessment._objects.site import Site
from rocking_assessment._objects.tables import ObjectTable, objects_of_csv, objects_of_json, table_template
from rocking_assessment.service.models import MAX_OBJECTS, AssessBody, AssessParams, AssessResponse
from rocking_assessment.service.workbooks import MEDIA_TYPES, text_of_workbook

router = APIRouter(prefix="/v1", tags=["response"])

MAX_BODY = 8 * 1024 * 1024  # largest table with records [bytes]
MAX_PAIRS = 500_000  # most objects times motions, a pair of components being twelve [-]

_JSON = {
    "objects": [{"name": "bust", "width": 0.4, "depth": 0.3, "height": 1.6, "friction": 0.5}],
    "pga": 3.0,
    "pgv": 0.3,
    "shapes": "sine,ricker",
}
_CSV = "name,width [cm],depth [cm],height [m],friction\nbust,40,30,1.6,0.5\n"


@router.post(
    "/assess",
    summary="Many objects at a site",
    response_model=AssessResponse,
    responses={200: {"content": {"text/csv": {}}}},
    openapi_extra=body_of(_JSON, {"text/csv": _CSV}, "table of objects; the columns are those of `Object`"),
)
async def post_assess(
    body: JsonOrFile[AssessBody],
    query: Annotated[AssessParams, Query()],
    request: Request,
    service: ServiceDep,
    url: Url,
) -> Any:
    """Which objects the motions of a site overturn, each with the lowest factor that does so, the worst first.

    The table is CSV or a workbook with units in its header or cells, or a JSON list of objects in SI units, with the
    site in the query; or a JSON object with that list, the site, its records and a hazard curve. The response has the
    format of the body, or that of `format`; CSV ends with the rows that were not read.
    """
    workbook = MEDIA_TYPES.get(request.headers.get("content-type", ""))
    form_of_body = body_form(request, ("json", "csv")) if workbook is None else "json"
    is_list = isinstance(body, AssessBody) and body.model_fields_set <= {"objects"}
    params = query if is_list else stated(body, query)
    if isinstance(body, bytes) and workbook is not None:
        text = await text_of_workbook(service, body, "objects", workbook, params.sheet, params.decimal)
        body = text.encode()

    def work(stop: StopFlag) -> Response:
        table = _table(body, params, stop)
        check_table(table, "objects")
        site = params.site(None if isinstance(body, bytes) else body)
        return _assessed(params, site, table, params.format or form_of_body, url, stop)

    return await service.solve_one(work, request)


def _table(body: AssessBody | bytes, params: AssessParams, stop: StopFlag) -> ObjectTable:
    """The objects of a body."""
    if not isinstance(body, bytes):
        return objects_of_json(json.dumps(body.objects), MAX_OBJECTS, params.layout)
    try:
        return objects_of_csv(text_of(body, "objects"), MAX_OBJECTS, stop, params.layout)
    except TableFileError as error:
        raise table_refusal(error) from None


@router.get("/assess/template", summary="A table of objects to fill in", response_class=PlainTextResponse)
async def get_template() -> Response:
    """CSV with comments above its header."""
    return text_response(table_template(), "objects")


def check_table(table: ObjectTable, name: str) -> None:
    """Refuse a table without an object."""
    if not table.objects:
        reasons = "; ".join(map(str, table.bad_rows)) or "an empty table"
        raise InvalidArgumentError(name, reasons, "one object or more")


def _assessed(params: AssessParams, site: Site, table: ObjectTable, form: str, url: str, stop: StopFlag) -> Response:
    size = sum(len(obj.planes) for obj in table.objects) * len(site.find_motions(stop))
    if size > MAX_PAIRS:
        raise TooLargeError("objects", f"{size} objects and directions times motions", f"at most {MAX_PAIRS}")
    options = {name: getattr(params, name) for name in ("sensitivity", "samples", "seed", "resolution", "standards")}
    assessment = assess(table.objects, site, **options, stop=stop)
    if form == "csv":
        return text_response(assessment.to_csv(bad_rows=table.bad_rows), "assessment")
    unread = len(table.bad_rows)
    bad_rows = [
        {"row": bad_row.row, "columns": bad_row.columns, "reasons": bad_row.reasons, "cells": bad_row.cells}
        for bad_row in table.bad_rows
    ]
    return json_of(
        AssessResponse.model_validate(
            {
                "query": params,
                "url": url,
                "warnings": [f"rows that were not read: {unread}, see `bad_rows`"] if unread else [],
                "rows": assessment.rows,
                "details": assessment.details,
                "motions": assessment.motions,
                "highest_factor": assessment.highest_factor,
                "resolution": assessment.resolution,
                "bad_rows": bad_rows,
                "columns": table.columns,
                "skipped": table.skipped,
                "remarks": table.remarks,
            }
        )
    )
