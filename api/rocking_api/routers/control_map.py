"""A map of the control space: outcome and peak over a grid of frequency ratio and slenderness (figures 4 and 8)."""

from __future__ import annotations

import math
from typing import Annotated, Any

import numpy as np
import xarray as xr
from fastapi import APIRouter, Query, Request, Response
from numpy.typing import NDArray
from pydantic import Field

from rocking._datasets.cube import AXES
from rocking._model.checks import check_window
from rocking._model.response import Response as Found
from rocking._numba.cancellation import StopFlag
from rocking._solver.peak_response import peak_response
from rocking_api.http.encoding import (
    CONTENT,
    csv_response,
    json_response,
    negotiated_form,
    netcdf_response,
    solved_variable,
)
from rocking_api.http.errors import TooLargeError
from rocking_api.http.parameters import ParamsRoute
from rocking_api.models.answer import Echoed, Solved
from rocking_api.models.params import ShapeParams, alpha_of
from rocking_api.models.quantity import FREQUENCY_RATIO, SLENDERNESS, Format, FrequencyRatio, Slenderness, between, said
from rocking_api.models.responses import OUTCOMES
from rocking_api.routers.twin import pair
from rocking_api.service import Service, ServiceDep

router = APIRouter(prefix="/v1", tags=["curves"], route_class=ParamsRoute)

DIGITS = 4  # decimals of the peaks in JSON [-]: enough for a picture, at a third of the length
MAX_AGE = 600  # how long a client may store a map without revalidation [s]


class MapParams(ShapeParams):
    """A window of the control space: columns uniform in log frequency ratio, rows uniform in slenderness."""

    frequency_ratio_min: FrequencyRatio = Field(0.5, examples=[0.5])
    frequency_ratio_max: FrequencyRatio = Field(12.0, examples=[12.0])
    slenderness_min: Slenderness = Field(0.01, examples=[0.01])
    slenderness_max: Slenderness = Field(1.05, examples=[1.05])
    columns: int = between(2, math.inf, "frequency ratios [-]", default=120)
    rows: int = between(2, math.inf, "slendernesses [-]", default=90)
    format: Format = None


class MapResponse(Echoed[MapParams], Solved[MapParams]):
    """The map, row by row: the first row has the smallest slenderness and starts at the smallest frequency ratio."""

    frequency_ratio: list[float] = said("omega_g/p of the columns [-]")
    slenderness: list[float] = said("1/a of the rows [-]")
    peak_rotation: list[float | None] = said(
        f"max |theta|/alpha [-] to {DIGITS} decimals (CSV and netCDF hold all digits); null if overturned"
    )
    outcome: list[int] = said("final outcome as an index into `outcomes` [-]")
    outcomes: list[str] = said("names of the outcomes")


@pair(
    router,
    "/map",
    "Outcome and peak rotation over a window of frequency ratio and slenderness",
    response_model=MapResponse,
    responses=CONTENT,
)
async def get_map(params: Annotated[MapParams, Query()], request: Request, service: ServiceDep) -> Response:
    """Many blocks in few bytes, for pictures; always computed by the solver, without error bounds."""
    form = negotiated_form(request, params.format)
    axes = _axes(service, params)
    response = await service.run_heavy(params, lambda stop: _map(params, request, *axes, form, stop), request)
    if request.method == "GET":
        response.headers["Cache-Control"] = f"max-age={MAX_AGE}"
    return response


def _map(
    params: MapParams,
    request: Request,
    frequency_ratio: NDArray[np.float64],
    slenderness: NDArray[np.float64],
    form: str,
    stop: StopFlag,
) -> Response:
    found = peak_response(
        params.pulse,
        slenderness=slenderness[:, None],
        frequency_ratio=frequency_ratio,
        restitution=params.restitution,
        alpha=alpha_of(params.alpha_deg),
        stop=stop,
    )
    if form == "nc":
        return netcdf_response(_dataset(params, frequency_ratio, slenderness, found), "map")
    if form == "csv":
        s, w = np.meshgrid(slenderness, frequency_ratio, indexing="ij")
        columns: dict[str, NDArray[Any]] = {"slenderness": s, "frequency_ratio": w}
        columns |= {"peak_rotation": found.peak_rotation, "overturned": found.overturned}
        columns |= {"outcome": np.array(OUTCOMES)[found.outcome], "impacts": found.impacts}
        columns |= {"exceeded_alpha": found.exceeded_alpha}
        return csv_response({name: values.ravel().tolist() for name, values in columns.items()}, "map")
    return json_response(
        MapResponse.model_construct(
            query=params,
            frequency_ratio=frequency_ratio.tolist(),
            slenderness=slenderness.tolist(),
            peak_rotation=found.peak_rotation.ravel().round(DIGITS).tolist(),
            outcome=found.outcome.ravel().tolist(),
            outcomes=OUTCOMES,
        ),
        request,
    )


def _axes(service: Service, params: MapParams) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The columns and the rows, within the ranges of the service."""
    left, right = check_window(FREQUENCY_RATIO, params.frequency_ratio_min, params.frequency_ratio_max)
    low, high = check_window(SLENDERNESS, params.slenderness_min, params.slenderness_max)
    params.check()
    if params.columns * params.rows > service.settings.max_samples:
        larger = "columns" if params.columns >= params.rows else "rows"
        allowed = f"columns times rows at most {service.settings.max_samples}"
        raise TooLargeError(larger, getattr(params, larger), allowed)
    return np.geomspace(left, right, params.columns), np.linspace(low, high, params.rows)


def _dataset(
    params: MapParams, frequency_ratio: NDArray[np.float64], slenderness: NDArray[np.float64], found: Found
) -> xr.Dataset:
    """The map with the names, types and attributes of the data sets."""
    axes = ("slenderness", "frequency_ratio")
    names = ("peak_rotation", "outcome", "impacts", "exceeded_alpha")
    variables: dict[str, Any] = {name: solved_variable(name, axes, getattr(found, name)) for name in names}
    coordinates = {"slenderness": slenderness, "frequency_ratio": frequency_ratio}
    attributes = params.model_dump(exclude={"format"}, exclude_none=True)
    return xr.Dataset(
        variables,
        coords={name: (name, values, AXES[name]) for name, values in coordinates.items()},
        attrs={"Conventions": "CF-1.11", **attributes},
    )
