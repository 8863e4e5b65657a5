"""What the service says of itself: state, metrics, model and limits of use, the description of all routes."""

from __future__ import annotations

from fastapi import APIRouter, Request, Response
from fastapi.responses import JSONResponse

from rocking_api.execution.kernels import NotReadyError
from rocking_api.http.encoding import json_response
from rocking_api.http.errors import DamagedDatasetsError
from rocking_api.http.parameters import ParamsRoute
from rocking_api.metrics import CONTENT_TYPE
from rocking_api.models.answer import Bare
from rocking_api.models.metadata import GROUPS_METADATA, Metadata
from rocking_api.models.responses import Health
from rocking_api.service import Service, ServiceDep

router = APIRouter(route_class=ParamsRoute)


@router.head("/health", include_in_schema=False)
@router.get("/health", summary="State and versions", tags=["health"], response_model=Health)
async def get_health(request: Request, service: ServiceDep) -> Response:
    """Always 200 while the process answers, whatever the state of the data sets: for what restarts it.

    Every data set is checked once per version of its file, in the background; this waits at most 0.1 s for it, and not
    for heavy work.
    """
    return await _health(request, service)


@router.head("/ready", include_in_schema=False)
@router.get("/ready", summary="Whether all of it can be served", tags=["health"], response_model=Health)
async def get_ready(request: Request, service: ServiceDep) -> Response:
    """503 while the solver is loaded, or while a data set that exists cannot be used: for what distributes requests.

    The damaged data sets are named. Data sets that are missing, or not yet checked, do not matter: the solver replaces
    the former, and the latter are checked before they are used.
    """
    answer = await _health(request, service)
    if not service.kernels.is_loaded:
        raise NotReadyError("the solver is being loaded; retry in a moment")
    if service.dataset_checker.damaged:
        raise DamagedDatasetsError(service.dataset_checker.damaged)
    return answer


async def _health(request: Request, service: Service) -> Response:
    names, unchecked, problems = await service.dataset_checker.state()
    status = "degraded" if problems else "ok"
    health = Health(status=status, datasets=len(names), unchecked=unchecked, problems=problems)
    return json_response(health, request, {"Cache-Control": "no-store"})


@router.get(
    "/metrics",
    summary="Counts and times",
    tags=["health"],
    response_class=Response,
    responses={200: {"content": {"text/plain": {"schema": {"type": "string"}}}}},
)
async def get_metrics(service: ServiceDep) -> Response:
    """Requests by route and status, times, blocks by source, heavy work, of all workers; damaged data sets.

    The data sets are checked as for `/health`.
    """
    await service.dataset_checker.state()
    return Response(service.metrics.text(), media_type=CONTENT_TYPE, headers={"Cache-Control": "no-store"})


class MetadataResponse(Metadata, Bare):
    """The same as an answer."""


@router.get("/v1/metadata", tags=["response"], summary="Model, assumptions and limits of use")
async def get_metadata() -> MetadataResponse:
    """Of the responses in dimensionless groups; those in SI units hold theirs."""
    return MetadataResponse(**dict(GROUPS_METADATA))


@router.get("/openapi.json", include_in_schema=False)
async def get_openapi(request: Request, service: ServiceDep) -> JSONResponse:
    """The OpenAPI document. To make it takes a second when it is first asked for: in a thread."""
    return JSONResponse(await service.run_io(request.app.openapi))
