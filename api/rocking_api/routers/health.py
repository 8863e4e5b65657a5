"""State of the service."""

from __future__ import annotations

from fastapi import APIRouter

from rocking_api.models.responses import Health
from rocking_api.service import ServiceDep

router = APIRouter(tags=["health"])


@router.get("/health", summary="State and versions")
async def get_health(service: ServiceDep) -> Health:
    """Every data set is read and checked, once per version of its file, in the background; this waits 0.1 s for it.

    It does not wait behind heavy work.
    """
    names, unchecked, problems = await service.inspection.state()
    status = "degraded" if problems else "ok"
    return Health(status=status, datasets=len(names), unchecked=unchecked, problems=problems)
