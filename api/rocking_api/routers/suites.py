"""Suites of records: catalogue, and the fragility of their blocks, from the data sets of the workflow."""

from __future__ import annotations

from functools import partial
from typing import Annotated

from fastapi import APIRouter, Path, Query, Request, Response

from rocking_api.http.caching import REVALIDATE
from rocking_api.http.encoding import MEDIA_TYPES, json_response, negotiated_form, text_response
from rocking_api.http.parameters import ParamsRoute
from rocking_api.models.params import ListParams
from rocking_api.models.suites import SuiteCatalogue, SuiteParams, SuiteResponse
from rocking_api.service import ServiceDep

router = APIRouter(prefix="/v1/suites", tags=["suites"], route_class=ParamsRoute)

SuiteName = Annotated[str, Path(description="name of a suite, see /v1/suites", examples=["demonstration"])]


@router.get("", summary="Catalogue", response_model=SuiteCatalogue)
async def get_suites(params: Annotated[ListParams, Query()], request: Request, service: ServiceDep) -> Response:
    """The suites in the results folder that can be read; `make reproduce CONFIG=...` makes one."""
    names, cursor = params.part(await service.run_io(service.suites.names))
    found = await service.run_io(partial(service.suites.summaries, names))
    catalogue = SuiteCatalogue(query=params, suites=found, next_cursor=cursor)
    return json_response(catalogue, request, {"Cache-Control": REVALIDATE})


@router.get(
    "/{name}",
    summary="Fragility of the blocks",
    response_model=SuiteResponse,
    responses={200: {"content": {MEDIA_TYPES["csv"]: {}}}},
)
async def get_suite(
    name: SuiteName, params: Annotated[SuiteParams, Query()], request: Request, service: ServiceDep
) -> Response:
    """Counts with intervals and fitted curves of each block and limit state, margins of each record, rotations.

    If the suite asks for it, also friction demand, and the effect of restitution and sampling. The data sets of the
    suite are under `links`. CSV has a row for each limit state, block and level.
    """
    form = negotiated_form(request, params.format, ("json", "csv"))
    if form == "json":
        found = await service.run_io(partial(service.suites.suite, name, params))
        return json_response(found, request, {"Cache-Control": REVALIDATE})
    text = await service.run_io(partial(service.suites.csv, name))
    return text_response(text, name, form, {"Cache-Control": REVALIDATE})
