"""Many objects at a site: which of them its motions overturn."""

from __future__ import annotations

import json

from fastapi import APIRouter, Request, Response
from rocking_api.http.body import body_form
from rocking_api.http.encoding import MEDIA_TYPES, TABLE_FORMS, Form, json_response, negotiated_form, text_response
from rocking_api.http.errors import TooLargeError
from rocking_api.http.parameters import ParamsRoute
from rocking_api.models.bodies import body_of, json_content, text_content
from rocking_api.service import ServiceDep

from rocking.extension import InvalidArgumentError, StopFlag
from rocking_assessment._objects.assess import assess
from rocking_assessment._objects.site import Site
from rocking_assessment._objects.tables import ObjectTable, objects_of_text
from rocking_assessment.service.models import MAX_OBJECTS, AssessBody, AssessParams, AssessResponse

router = APIRouter(prefix="/v1", tags=["response"], route_class=ParamsRoute)

MAX_BODY = 8 * 1024 * 1024  # largest table with records [bytes]
MAX_PAIRS = 500_000  # most objects times motions, a pair of components being twelve [-]

_ROW = {"name": "bust", "width": 0.4, "depth": 0.3, "height": 1.6, "friction": 0.5}


@router.post(
    "/assess",
    summary="Many objects at a site",
    response_model=AssessResponse,
    responses={200: {"content": {MEDIA_TYPES["csv"]: {}}}},
    openapi_extra=body_of(
        {
            **json_content(
                AssessBody,
                {"objects": [_ROW], "pga": 3.0, "pgv": 0.3, "shapes": "sine,ricker"},
                {"type": "array", "items": {"type": "object"}, "maxItems": MAX_OBJECTS},
            ),
            **text_content(MEDIA_TYPES["csv"], "name,width [cm],depth [cm],height [m],friction\nbust,40,30,1.6,0.5\n"),
        },
        AssessParams,
        "table of objects; the columns are those of `rocking_assessment.Object`",
    ),
)
async def post_assess(request: Request, service: ServiceDep) -> Response:
    """Which objects the motions of a site overturn, each with the lowest factor that does so, the worst first.

    The table is CSV with units in its header or cells, or a JSON list of objects in SI units; or a JSON object with
    that list, records of the site and a hazard curve. The response has the format of the body, or that of `format` or
    `Accept`; CSV ends with the rows that were not read.
    """
    given = body_form(request, TABLE_FORMS)
    params, body = await service.read(request, AssessParams, given, AssessBody, MAX_BODY)
    table, site = await service.run_parser(lambda stop: _read(body, given, params, stop), request, large=True)
    form = negotiated_form(request, params.format, TABLE_FORMS, default=given)
    return await service.run_heavy(lambda stop: _assess(params, request, site, table, form, stop), request)


def _read(body: AssessBody | bytes, form: Form, params: AssessParams, stop: StopFlag) -> tuple[ObjectTable, Site]:
    given, raw = (None, body) if isinstance(body, bytes) else (body, json.dumps(body.objects).encode())
    table = objects_of_text(raw, json=form == "json", most=MAX_OBJECTS, stop=stop)
    check_table(table, "objects")
    return table, params.site(given)


def check_table(table: ObjectTable, name: str) -> None:
    """Refuse a table without an object."""
    if not table.objects:
        reasons = "; ".join(map(str, table.bad_rows)) or "an empty table"
        raise InvalidArgumentError(name, reasons, "one object or more")


def _assess(
    params: AssessParams, request: Request, site: Site, table: ObjectTable, form: Form, stop: StopFlag
) -> Response:
    size = sum(len(one.planes) for one in table.objects) * len(site.find_motions(stop))
    if size > MAX_PAIRS:
        raise TooLargeError("objects", f"{size} objects and directions times motions", f"at most {MAX_PAIRS}")
    kept = {name: getattr(params, name) for name in ("sensitivity", "samples", "seed", "resolution", "standards")}
    found = assess(table.objects, site, **kept, stop=stop)
    if form == "csv":
        return text_response(found.to_csv(bad_rows=table.bad_rows), "assessment")
    unread = len(table.bad_rows)
    return json_response(
        AssessResponse.model_validate(
            {
                "query": params,
                "warnings": [f"rows that were not read: {unread}, see `bad_rows`"] if unread else [],
                "rows": found.rows,
                "details": found.details,
                "motions": found.motions,
                "highest_factor": found.highest_factor,
                "resolution": found.resolution,
                "bad_rows": [vars(one) for one in table.bad_rows],
                "columns": table.columns,
                "skipped": table.skipped,
                "totals": table.totals,
            }
        ),
        request,
    )
