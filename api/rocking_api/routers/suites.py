"""Suites of records: catalogue, and the fragility of their blocks, from the data sets of the workflow."""

from __future__ import annotations

from typing import Annotated, Any

from fastapi import APIRouter, Path, Query

from rocking_api.http.encoding import MEDIA_TYPES, text_response
from rocking_api.models.answer import Url
from rocking_api.models.params import ListParams
from rocking_api.models.suites import SuiteCatalogue, SuiteParams, SuiteResponse
from rocking_api.service import ServiceDep

router = APIRouter(prefix="/v1/suites", tags=["suites"])

SuiteName = Annotated[str, Path(description="name of a suite, see /v1/suites", examples=["demonstration"])]


@router.get("", summary="Catalogue")
async def get_suites(params: Annotated[ListParams, Query()], service: ServiceDep, url: Url) -> SuiteCatalogue:
    """The suites in the results folder that can be read; `make reproduce CONFIG=...` makes one."""
    names, cursor = params.part(await service.read(lambda _: service.suites.names()))
    suites = await service.read(lambda _: service.suites.summaries(names))
    return SuiteCatalogue(query=params, url=url, suites=suites, next_cursor=cursor)


@router.get(
    "/{name}",
    summary="Fragility of the blocks",
    response_model=SuiteResponse,
    responses={200: {"content": {MEDIA_TYPES["csv"]: {}}}},
)
async def get_suite(name: SuiteName, params: Annotated[SuiteParams, Query()], service: ServiceDep, url: Url) -> Any:
    """Counts with intervals and fitted curves of each block and limit state, margins of each record, rotations.

    If the suite asks for it, also friction demand, and the effect of restitution and sampling. The data sets of the
    suite are under `links`. CSV has a row for each limit state, block and level.
    """
    if params.format == "csv":
        return text_response(await service.read(lambda _: service.suites.csv(name)), name)
    return await service.read(lambda _: service.suites.suite(name, params, url))
