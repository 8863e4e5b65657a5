"""A map of the control space: fate and peak over a grid of frequency ratio and slenderness (figures 4 and 8 in one)."""

from __future__ import annotations

import hashlib
from typing import Annotated, Any

import numpy as np
import xarray as xr
from fastapi import APIRouter, Query, Request, Response
from numpy.typing import NDArray
from pydantic import BaseModel, Field

from rocking._numba.cancellation import StopFlag
from rocking.datasets.cube import AXES, MODEL_RESULT, VARIABLES
from rocking.errors import in_range
from rocking.model.response import Response as Found
from rocking.solver.peak_response import peak_response
from rocking_api.http.caching import not_modified
from rocking_api.http.formats import CONTENT, csv_response, form_of, json_response, netcdf_response
from rocking_api.http.problems import TooLargeError
from rocking_api.models.params import (
    FREQUENCY_RATIOS,
    SMALLEST_SLENDERNESS,
    AlphaDeg,
    Format,
    FrequencyRatio,
    PulseName,
    Question,
    Restitution,
    Slenderness,
    alpha_of,
)
from rocking_api.models.responses import OUTCOMES, VERSION
from rocking_api.service import Service, ServiceDep

router = APIRouter(prefix="/v1", tags=["curves"])

DIGITS = 4
"""Decimals of the peaks in JSON: a picture shows no more, and the text is a third as long [-]."""

MAX_AGE = 600
"""How long a client may keep a map without asking again [s]; the same question has the same answer."""


class MapQuestion(Question):
    """A window of the control space: columns even in the logarithm of the frequency ratio, rows even in slenderness."""

    pulse: PulseName
    restitution: Restitution
    alpha_deg: AlphaDeg = None
    frequency_ratio_min: FrequencyRatio = 0.5
    frequency_ratio_max: FrequencyRatio = 12.0
    slenderness_min: Slenderness = 0.01
    slenderness_max: Slenderness = 1.05
    columns: int = Field(120, description="frequency ratios [-]", json_schema_extra={"minimum": 2})
    rows: int = Field(90, description="slendernesses [-]", json_schema_extra={"minimum": 2})
    format: Format = None


class MapAnswer(BaseModel):
    """The map, row after row: the first row is the smallest slenderness, and begins at the smallest frequency ratio."""

    query: dict[str, Any]
    frequency_ratio: list[float] = Field(description="omega_g/p of the columns [-]")
    slenderness: list[float] = Field(description="1/a of the rows [-]")
    peak_rotation: list[float | None] = Field(
        description=f"max |theta|/alpha [-] to {DIGITS} decimals (CSV and netCDF hold all digits); null if overturned"
    )
    outcome: list[int] = Field(description="final fate as an index into `outcomes`")
    outcomes: list[str] = Field(description="names of the fates")
    source: str = "solver"
    version: str = VERSION


@router.get(
    "/map",
    summary="Fate and peak rotation over a window of frequency ratio and slenderness",
    response_model=MapAnswer,
    responses=CONTENT | {304: {"description": "not modified"}},
)
async def get_map(question: Annotated[MapQuestion, Query()], request: Request, service: ServiceDep) -> Response:
    """Many blocks in few bytes, for pictures; the solver always answers, and without error bounds."""
    form = form_of(request, question.format)
    axes = _axes(service, question)
    answer = await service.off_loop(question, lambda stop: _map(question, *axes, form, stop), request)
    digest = hashlib.sha256(answer.body).hexdigest()
    known = not_modified(request, digest)
    response = answer if known is None else known
    response.headers["ETag"] = f'"{digest}"'
    response.headers["Cache-Control"] = f"max-age={MAX_AGE}"
    return response


def _map(
    question: MapQuestion,
    frequency_ratio: NDArray[np.float64],
    slenderness: NDArray[np.float64],
    form: str,
    stop: StopFlag,
) -> Response:
    found = peak_response(
        question.pulse,
        slenderness=slenderness[:, None],
        frequency_ratio=frequency_ratio,
        restitution=question.restitution,
        alpha=alpha_of(question.alpha_deg),
        stop=stop,
    )
    query = question.model_dump(exclude={"format"})
    if form == "nc":
        return netcdf_response(_dataset(query, frequency_ratio, slenderness, found), "map")
    if form == "csv":
        s, w = np.meshgrid(slenderness, frequency_ratio, indexing="ij")
        columns: dict[str, NDArray[Any]] = {"slenderness": s, "frequency_ratio": w}
        columns |= {"peak_rotation": found.peak_rotation, "overturned": found.overturned}
        columns |= {"outcome": np.array(OUTCOMES)[found.outcome], "impacts": found.impacts}
        columns |= {"exceeded_alpha": found.exceeded_alpha}
        return csv_response({name: values.ravel().tolist() for name, values in columns.items()}, "map")
    return json_response(
        MapAnswer.model_construct(
            query=query,
            frequency_ratio=frequency_ratio.tolist(),
            slenderness=slenderness.tolist(),
            peak_rotation=found.peak_rotation.ravel().round(DIGITS).tolist(),
            outcome=found.outcome.ravel().tolist(),
            outcomes=OUTCOMES,
        )
    )


def _axes(service: Service, question: MapQuestion) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The columns and the rows, both inside the border of the service."""
    least, most = FREQUENCY_RATIOS
    left = float(in_range("frequency_ratio_min", question.frequency_ratio_min, least, most))
    right = float(in_range("frequency_ratio_max", question.frequency_ratio_max, left, most, closed="right"))
    low = float(in_range("slenderness_min", question.slenderness_min, SMALLEST_SLENDERNESS, np.inf, closed="left"))
    high = float(in_range("slenderness_max", question.slenderness_max, low, np.inf, closed="neither"))
    in_range("columns", question.columns, 2, np.inf, closed="left")
    in_range("rows", question.rows, 2, np.inf, closed="left")
    if question.columns * question.rows > service.settings.max_samples:
        larger = "columns" if question.columns >= question.rows else "rows"
        allowed = f"columns times rows at most {service.settings.max_samples}"
        raise TooLargeError(larger, getattr(question, larger), allowed)
    return np.geomspace(left, right, question.columns), np.linspace(low, high, question.rows)


def _dataset(
    query: dict[str, Any], frequency_ratio: NDArray[np.float64], slenderness: NDArray[np.float64], found: Found
) -> xr.Dataset:
    """The map with the names, types and attributes of the data sets."""
    variables: dict[str, Any] = {}
    for name in ("peak_rotation", "outcome", "impacts", "exceeded_alpha"):
        dtype, about = VARIABLES[name]
        kept = {key: value for key, value in about.items() if key != "ancillary_variables"}
        values = getattr(found, name).astype(dtype)
        variables[name] = (("slenderness", "frequency_ratio"), values, MODEL_RESULT | kept)
    coordinates = {"slenderness": slenderness, "frequency_ratio": frequency_ratio}
    attributes = {name: value for name, value in query.items() if value is not None}
    return xr.Dataset(
        variables,
        coords={name: (name, values, AXES[name]) for name, values in coordinates.items()},
        attrs={"Conventions": "CF-1.11", **attributes},
    )
