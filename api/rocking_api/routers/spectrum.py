"""A rocking spectrum: the peak against the frequency ratio (figure 8)."""

from __future__ import annotations

from typing import Annotated, Any

import numpy as np
from fastapi import APIRouter, Query, Request, Response
from numpy.typing import NDArray

from rocking._model.checks import check_window
from rocking._numba.cancellation import StopFlag
from rocking_api.execution.evaluation import evaluate_many
from rocking_api.http.encoding import (
    CONTENT,
    columns_as_they_are,
    csv_stream,
    dataset_of,
    json_response,
    negotiated_form,
    netcdf_response,
)
from rocking_api.http.errors import TooLargeError
from rocking_api.http.parameters import ParamsRoute
from rocking_api.models.params import SpectrumParams
from rocking_api.models.quantity import FREQUENCY_RATIO
from rocking_api.models.responses import SpectrumResponse, columns_of
from rocking_api.routers.twin import pair
from rocking_api.service import Service, ServiceDep

router = APIRouter(prefix="/v1", tags=["curves"], route_class=ParamsRoute)


@pair(router, "/spectrum", "Peak rotation against frequency ratio", response_model=SpectrumResponse, responses=CONTENT)
async def get_spectrum(params: Annotated[SpectrumParams, Query()], request: Request, service: ServiceDep) -> Response:
    """Blocks of one slenderness over a window of the frequency ratio."""
    form = negotiated_form(request, params.format)
    frequency_ratio = _axis(service, params)
    return await service.run_heavy(
        params, lambda stop: _spectrum(service, params, request, frequency_ratio, form, stop), request
    )


def _axis(service: Service, params: SpectrumParams) -> NDArray[np.float64]:
    """The frequency ratios of the curve, within the range of the service."""
    low, high = check_window(FREQUENCY_RATIO, params.frequency_ratio_min, params.frequency_ratio_max)
    params.check()
    if params.points > service.settings.max_samples:
        raise TooLargeError("points", params.points, f"at most {service.settings.max_samples}")
    return np.geomspace(low, high, params.points)


def _spectrum(
    service: Service,
    params: SpectrumParams,
    request: Request,
    frequency_ratio: NDArray[np.float64],
    form: str,
    stop: StopFlag,
) -> Response:
    shape = frequency_ratio.shape
    groups = {
        "slenderness": np.broadcast_to(np.float64(params.slenderness), shape),
        "frequency_ratio": frequency_ratio,
        "restitution": np.broadcast_to(np.float64(params.restitution), shape),
    }
    result = evaluate_many(service.cubes, params, groups, stop)
    if form == "nc":
        attributes = params.model_dump(exclude={"format"}, exclude_none=True)
        return netcdf_response(dataset_of({"frequency_ratio": frequency_ratio}, result, attributes), "spectrum")
    curve = columns_as_they_are({"frequency_ratio": frequency_ratio}) | columns_of(result)
    if form == "csv":
        return csv_stream(curve, frequency_ratio.size, "spectrum")
    lists: dict[str, Any] = {name: column(slice(None)) for name, column in curve.items()}
    return json_response(
        SpectrumResponse.model_construct(query=params, data_versions=list(result.versions), **lists), request
    )
