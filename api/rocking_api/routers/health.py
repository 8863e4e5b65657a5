"""What the service says of itself: state, model and limits of use."""

from __future__ import annotations

from fastapi import APIRouter, Response

from rocking_api.execution.kernels import NotReadyError
from rocking_api.http.errors import DamagedDatasetsError
from rocking_api.models.answer import Bare, Url
from rocking_api.models.metadata import GROUPS_METADATA, Metadata
from rocking_api.models.responses import Health
from rocking_api.service import ServiceDep

router = APIRouter()


@router.get("/health", summary="State and versions", tags=["health"])
async def get_health(service: ServiceDep, url: Url, response: Response) -> Health:
    """Always 200 while the process answers, whatever the state of the data sets: for what restarts it.

    Every data set is checked once per version of its file, in the background; this waits at most 0.1 s for it, and not
    for heavy work.
    """
    response.headers["Cache-Control"] = "no-store"
    names, unchecked, problems = await service.dataset_checker.state()
    status = "degraded" if problems else "ok"
    return Health(url=url, status=status, datasets=len(names), unchecked=unchecked, problems=problems)


@router.get("/ready", summary="Whether all of it can be served", tags=["health"])
async def get_ready(service: ServiceDep, url: Url, response: Response) -> Health:
    """503 while the solver is loaded, or while a data set that exists cannot be used: for what distributes requests.

    The damaged data sets are named. Data sets that are missing, or not yet checked, do not matter: the solver replaces
    the former, and the latter are checked before they are used.
    """
    health = await get_health(service, url, response)
    if not service.kernels.is_loaded:
        raise NotReadyError("the solver is being loaded; retry in a moment")
    if service.dataset_checker.damaged:
        raise DamagedDatasetsError(service.dataset_checker.damaged)
    return health


class MetadataResponse(Metadata, Bare):
    """The same as an answer."""


@router.get("/v1/metadata", tags=["response"], summary="Model, assumptions and limits of use")
async def get_metadata(url: Url) -> MetadataResponse:
    """Of the responses in dimensionless groups; those in SI units hold theirs."""
    return MetadataResponse(url=url, **dict(GROUPS_METADATA))
