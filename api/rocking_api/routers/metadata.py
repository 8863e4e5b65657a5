"""What the answers refer to: model, assumptions and limits of use; the description of all routes."""

from __future__ import annotations

from fastapi import APIRouter, Request
from fastapi.responses import JSONResponse

from rocking_api.http.parameters import ParamsRoute
from rocking_api.models.answer import Bare
from rocking_api.models.metadata import GROUPS_METADATA, Metadata
from rocking_api.service import ServiceDep

router = APIRouter(tags=["response"], route_class=ParamsRoute)


class MetadataResponse(Metadata, Bare):
    """The same as an answer."""


@router.get("/v1/metadata", summary="Model, assumptions and limits of use")
async def get_metadata() -> MetadataResponse:
    """Of the responses in dimensionless groups; those in SI units hold theirs."""
    return MetadataResponse(**dict(GROUPS_METADATA))


@router.get("/openapi.json", include_in_schema=False)
async def get_openapi(request: Request, service: ServiceDep) -> JSONResponse:
    """The OpenAPI document. To make it takes a second when it is first asked for: in a thread."""
    return JSONResponse(await service.run_io(request.app.openapi))
