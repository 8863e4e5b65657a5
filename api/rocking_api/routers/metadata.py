"""Model, assumptions and limits of use of the responses in groups, which refer to this route."""

from __future__ import annotations

from fastapi import APIRouter

from rocking_api.http.parameters import ParamsRoute
from rocking_api.models.metadata import GROUPS_METADATA, MetadataResponse

router = APIRouter(prefix="/v1", tags=["response"], route_class=ParamsRoute)


@router.get("/metadata", summary="Model, assumptions and limits of use")
async def get_metadata() -> MetadataResponse:
    """Of the responses in dimensionless groups; those in SI units hold theirs."""
    return MetadataResponse(**dict(GROUPS_METADATA))
