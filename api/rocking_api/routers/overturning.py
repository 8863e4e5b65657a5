"""Boundary curves of overturning (figure 4)."""

from __future__ import annotations

from functools import lru_cache
from typing import Annotated, Any
from urllib.parse import urlencode

import numpy as np
import xarray as xr
from fastapi import APIRouter, Depends, Query, Request, Response
from numpy.typing import NDArray

from rocking._base.errors import DatasetError
from rocking._boundary.curves import curves_at, points_of
from rocking._boundary.tracing import overturning_boundary
from rocking._datasets.catalogue import UnknownDatasetError
from rocking._numba.cancellation import StopFlag, run_with_timeout
from rocking_api.execution.work import TimeLimitError
from rocking_api.http.encoding import CONTENT, csv_response, netcdf_response
from rocking_api.models.answer import Url, no_query
from rocking_api.models.fields import OUTCOMES
from rocking_api.models.params import OverturningParams, alpha_of
from rocking_api.models.pulses import OverturningBody
from rocking_api.models.responses import Curve, OverturningResponse
from rocking_api.service import Service, ServiceDep

router = APIRouter(prefix="/v1", tags=["curves"])

NODES = 201
"""Nodes of the grid on which curves are traced on request [-]: half as fine as the workflow, seconds for wavelets."""

NEARLY_ELASTIC, ELASTIC_SHARE = 0.98, 1 / 6
"""Above this restitution [-] rigid blocks have this share of the time limit [-]: 10 s of 60 s.

Where a wavelet hardly uplifts them they strike up to 200,000 times. The curves of c2 at 10 degrees take 10 s of
processor time with 0.98 and 50 s with 1: four fifths of the impacts are those of four blocks of a thousand.
"""

MAX_KEPT = 64  # requests whose traced curves are cached [-]: some tens of kB each


@router.get("/overturning", summary="Boundary curves", response_model=OverturningResponse, responses=CONTENT)
async def get_overturning(
    params: Annotated[OverturningParams, Query()], request: Request, service: ServiceDep, url: Url
) -> Any:
    """The curves of the workflow; without those for this restitution they are traced, and cached."""
    try:
        return await service.solve(lambda stop: _overturning(service, params, url, stop), request)
    except TimeLimitError as error:
        parts = params.model_dump(include={"pulse", "restitution", "alpha_deg"}, exclude_none=True)
        where = f"/v1/map?{urlencode(parts)}" if isinstance(params.pulse, str) else "POST /v1/map"
        instead = f"ask for the outcomes on a grid, {where}, or for another restitution"
        raise TimeLimitError(error.seconds, instead) from None


@router.post(
    "/overturning",
    summary="Boundary curves, under a pulse given by samples",
    response_model=OverturningResponse,
    responses=CONTENT,
    dependencies=[Depends(no_query)],
)
async def post_overturning(params: OverturningBody, request: Request, service: ServiceDep, url: Url) -> Any:
    """The same with the parameters in a JSON body."""
    return await get_overturning(params, request, service, url)


def _overturning(
    service: Service, params: OverturningParams, url: str, stop: StopFlag
) -> OverturningResponse | Response:
    curves, version = _read(service, params)
    if curves is None:
        curves = _traced(service, params, stop)
    if params.format == "nc":
        return netcdf_response(curves, "overturning", "Boundary curves of overturning under a pulse", url)
    if params.format == "csv":
        return csv_response(points_of(curves), "overturning")
    source = "dataset" if version else "solver"
    return OverturningResponse(query=params, url=url, curves=_curves(curves), source=source, data_version=version)


def _read(service: Service, params: OverturningParams) -> tuple[xr.Dataset | None, str | None]:
    """The curves for the parameters from the data set, and its sha256; None if there are none."""
    if not isinstance(params.pulse, str):
        return None, None
    # a mirrored pulse overturns the same blocks
    name = f"overturning/{params.pulse.removeprefix('-')}/eta-{params.restitution:.2f}"
    catalogue = service.cubes.catalogue
    try:
        product, stored = catalogue.dataset(name)
    except (UnknownDatasetError, DatasetError):
        return None, None  # see /health for a damaged or unreadable one
    found = curves_at(stored, alpha_of(params.alpha_deg) or 0.0)
    if float(stored["restitution"]) != params.restitution or not found.sizes["curve"]:
        return None, None
    return found, product.sha256


def _traced(service: Service, params: OverturningParams, stop: StopFlag) -> xr.Dataset:
    """Traced curves, cached."""
    pulse, eta, alpha = params.pulse, params.restitution, alpha_of(params.alpha_deg)
    kept = _kept(pulse if isinstance(pulse, str) else (pulse.name, pulse.digest), eta, alpha)
    if not kept:
        seconds = service.settings.max_seconds * (ELASTIC_SHARE if alpha and eta > NEARLY_ELASTIC else 1.0)
        curves = run_with_timeout(
            lambda part: overturning_boundary(pulse, restitution=eta, alpha=alpha, nodes=NODES, stop=part),
            seconds,
            stop,
        )
        if curves is None:
            raise TimeLimitError(seconds)
        kept.append(curves)
    return kept[0]


@lru_cache(maxsize=MAX_KEPT)
def _kept(_pulse: str | tuple[str, str], _restitution: float, _alpha: float | None) -> list[xr.Dataset]:
    """The cache entry of traced curves, empty at first."""
    return []


def _names(curves: xr.Dataset) -> NDArray[np.str_]:
    return np.asarray(np.array(OUTCOMES)[curves["outcome"].values])


def _curves(curves: xr.Dataset) -> list[Curve]:
    ends = np.cumsum(curves["row_size"].values)
    parts = zip(
        np.split(curves["slenderness"].values, ends)[:-1],
        np.split(curves["frequency_ratio"].values, ends)[:-1],
        _names(curves).tolist(),
        curves["impacts"].values.tolist(),
        strict=True,
    )
    return [
        Curve(outcome=outcome, impacts=impacts, slenderness=s.tolist(), frequency_ratio=w.tolist())
        for s, w, outcome, impacts in parts
        if s.size
    ]
