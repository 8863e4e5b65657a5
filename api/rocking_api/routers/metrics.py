"""Metrics for Prometheus."""

from __future__ import annotations

from fastapi import APIRouter, Response

from rocking_api.http.parameters import ParamsRoute
from rocking_api.metrics import CONTENT_TYPE
from rocking_api.service import ServiceDep

router = APIRouter(tags=["health"], route_class=ParamsRoute)


@router.get(
    "/metrics",
    summary="Counts and times",
    response_class=Response,
    responses={200: {"content": {"text/plain": {"schema": {"type": "string"}}}}},
)
async def get_metrics(service: ServiceDep) -> Response:
    """Requests by route and status, times, blocks by source, heavy work, of all workers; damaged data sets.

    The data sets are checked as for `/health`.
    """
    await service.dataset_checker.state()
    return Response(service.metrics.text(), media_type=CONTENT_TYPE, headers={"Cache-Control": "no-store"})
