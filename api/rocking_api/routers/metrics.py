"""Counts and times, for Prometheus."""

from __future__ import annotations

from fastapi import APIRouter, Response

from rocking_api.http.metrics import CONTENT_TYPE
from rocking_api.service import ServiceDep

router = APIRouter(tags=["health"])


@router.get(
    "/metrics",
    summary="Counts and times",
    response_class=Response,
    responses={200: {"content": {"text/plain": {"schema": {"type": "string"}}}}},
)
async def get_metrics(service: ServiceDep) -> Response:
    """Requests by route and status, their times, blocks by source, heavy work; of this process since it began."""
    return Response(service.metrics.text(), media_type=CONTENT_TYPE, headers={"Cache-Control": "no-store"})
