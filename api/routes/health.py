"""State of the service."""

from __future__ import annotations

from fastapi import APIRouter

from api.answers import Health
from api.service import ServiceDep

router = APIRouter(tags=["health"])


@router.get("/health", summary="State and versions")
async def get_health(service: ServiceDep) -> Health:
    """Every data set is read and checked, once per version of its file: the first call after a change takes longer."""
    names = await service.off_loop(service.atlas.catalogue.names)
    problems = await service.off_loop(service.atlas.problems)
    return Health(status="degraded" if problems else "ok", datasets=len(names), problems=problems)
