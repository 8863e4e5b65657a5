"""State of the service."""

from __future__ import annotations

from fastapi import APIRouter, Response

from rocking_api.http.encoding import json_response
from rocking_api.http.params_route import ParamsRoute
from rocking_api.models.responses import Health
from rocking_api.service import ServiceDep

router = APIRouter(tags=["health"], route_class=ParamsRoute)


@router.get("/health", summary="State and versions", response_model=Health)
async def get_health(service: ServiceDep) -> Response:
    """Every data set is checked once per version of its file, in the background; this waits at most 0.1 s for it.

    It does not wait for heavy work.
    """
    names, unchecked, problems = await service.dataset_checker.state()
    status = "degraded" if problems else "ok"
    health = Health(status=status, datasets=len(names), unchecked=unchecked, problems=problems)
    return json_response(health, {"Cache-Control": "no-store"})
