"""Blocks in groups along a curve, over a window or against time: spectrum, history, thresholds, map.

Each has a GET with the parameters in the query, and a POST with the same in a JSON body, where the pulse may be
given by samples.
"""

from __future__ import annotations

from typing import Annotated, Any

import numpy as np
import xarray as xr
from fastapi import APIRouter, Depends, Query, Request, Response
from numpy.typing import NDArray
from pydantic import BaseModel

from rocking._base.arrays import Array
from rocking._base.errors import finite
from rocking._boundary.amplitude import thresholds
from rocking._datasets.cube import AXES
from rocking._dimensional.fields import CONTACT_FORCES
from rocking._history.contact import ATTRIBUTES, COLUMNS
from rocking._history.time_history import time_history
from rocking._model.checks import check_window
from rocking._model.outcome import Outcome
from rocking._model.response import Response as SolverResponse
from rocking._numba.cancellation import StopFlag
from rocking._solver.peak_response import peak_response
from rocking_api.execution.evaluation import evaluate_many
from rocking_api.http import encoding
from rocking_api.http.errors import TooLargeError
from rocking_api.models.answer import Solved, Url, no_query
from rocking_api.models.fields import OUTCOMES
from rocking_api.models.params import HistoryParams, MapParams, SpectrumParams, ThresholdsParams, alpha_of
from rocking_api.models.pulses import HistoryBody, MapBody, SpectrumBody, ThresholdsBody
from rocking_api.models.quantity import FREQUENCY_RATIO, SLENDERNESS, said
from rocking_api.models.responses import ContactResponse, HistoryResponse, SpectrumResponse, columns_of
from rocking_api.service import Service, ServiceDep

router = APIRouter(prefix="/v1", tags=["curves"])

SAMPLED = ", under a pulse given by samples"  # what the summaries of POST add to those of GET


@router.get(
    "/spectrum",
    summary="Peak rotation against frequency ratio",
    response_model=SpectrumResponse,
    responses=encoding.CONTENT,
)
async def get_spectrum(
    params: Annotated[SpectrumParams, Query()], request: Request, service: ServiceDep, url: Url
) -> Any:
    """Blocks of one slenderness over a window of the frequency ratio."""
    ratio = _axis(service, params)
    return await service.solve(lambda stop: _spectrum(service, params, ratio, url, stop), request)


@router.post(
    "/spectrum",
    summary=f"Peak rotation against frequency ratio{SAMPLED}",
    response_model=SpectrumResponse,
    responses=encoding.CONTENT,
    dependencies=[Depends(no_query)],
)
async def post_spectrum(params: SpectrumBody, request: Request, service: ServiceDep, url: Url) -> Any:
    """The same with the parameters in a JSON body."""
    return await get_spectrum(params, request, service, url)


def _axis(service: Service, params: SpectrumParams) -> Array:
    """The frequency ratios of the curve, within the range of the service."""
    low, high = check_window(FREQUENCY_RATIO, params.frequency_ratio_min, params.frequency_ratio_max)
    if params.points > service.settings.max_samples:
        raise TooLargeError("points", params.points, f"at most {service.settings.max_samples}")
    return np.geomspace(low, high, params.points)


def _spectrum(
    service: Service, params: SpectrumParams, frequency_ratio: Array, url: str, stop: StopFlag
) -> SpectrumResponse | Response:
    shape = frequency_ratio.shape
    groups = {
        "slenderness": np.broadcast_to(np.float64(params.slenderness), shape),
        "frequency_ratio": frequency_ratio,
        "restitution": np.broadcast_to(np.float64(params.restitution), shape),
    }
    result = evaluate_many(service.cubes, params, groups, stop)
    if params.format == "nc":
        attributes = params.model_dump(exclude={"format"}, exclude_none=True)
        dataset = encoding.dataset_of({"frequency_ratio": frequency_ratio}, result, attributes)
        return encoding.netcdf_response(dataset, "spectrum", "Peak rotation of blocks over the frequency ratio", url)
    curve = encoding.columns_as_they_are({"frequency_ratio": frequency_ratio}) | columns_of(result)
    if params.format == "csv":
        return encoding.csv_stream(curve, frequency_ratio.size, "spectrum")
    lists: dict[str, Any] = {name: column(slice(None)) for name, column in curve.items()}
    return json_of(
        SpectrumResponse.model_construct(query=params, url=url, data_versions=list(result.versions), **lists)
    )


def json_of(answer: BaseModel) -> Response:
    """An answer with long lists as JSON, which FastAPI would validate number by number."""
    return Response(answer.model_dump_json(), media_type="application/json")


SERIES = ("rotation", "angular_velocity", "edge", "ground_acceleration", "vertical_acceleration", "displacement")
"""Variables of motions that are sent where they are known."""


@router.get("/history", summary="Motion of one block", response_model=HistoryResponse, responses=encoding.CONTENT)
async def get_history(
    params: Annotated[HistoryParams, Query()], request: Request, service: ServiceDep, url: Url
) -> Any:
    """Rotation and angular velocity from the start of the pulse through free rocking, always computed by the solver.

    With `contact`, also the reactions of the ground and the friction demand.
    """
    if params.samples > service.settings.max_samples:
        raise TooLargeError("samples", params.samples, f"at most {service.settings.max_samples}")
    return await service.solve(lambda stop: _history(params, url, stop), request)


@router.post(
    "/history",
    summary=f"Motion of one block{SAMPLED}",
    response_model=HistoryResponse,
    responses=encoding.CONTENT,
    dependencies=[Depends(no_query)],
)
async def post_history(params: HistoryBody, request: Request, service: ServiceDep, url: Url) -> Any:
    """The same with the parameters in a JSON body."""
    return await get_history(params, request, service, url)


def _history(params: HistoryParams, url: str, stop: StopFlag) -> Response:
    motion = time_history(
        params.pulse,
        slenderness=params.slenderness,
        **params.groups,
        duration=params.duration,
        samples=params.samples,
        contact=params.contact,
        stop=stop,
    )
    if params.format == "nc":
        return encoding.netcdf_response(motion, "history", "Motion of a block under a pulse", url)
    columns, reactions = motion_columns(motion, "tau")
    if params.format == "csv":
        return encoding.csv_response(columns | reactions, "history")
    fields = motion_fields(motion, reactions)
    return json_of(HistoryResponse.model_construct(query=params, url=url, **fields, **columns))


def motion_columns(motion: xr.Dataset, time: str) -> tuple[dict[str, Any], dict[str, Any]]:
    """The samples of a motion against its variable of time, and of the reactions, if it has any."""
    columns = {name: motion[name].values.tolist() for name in (time, *SERIES) if name in motion}
    reactions = (*COLUMNS, *CONTACT_FORCES)
    return columns, {name: motion[name].values.tolist() for name in reactions if name in motion}


def motion_fields(motion: xr.Dataset, reactions: dict[str, Any]) -> dict[str, Any]:
    """The fields of `Motion` beside the samples; of another body without a peak."""
    attributes = motion.attrs
    peak = {"peak_rotation": finite(float(attributes["peak_rotation"]))} if "peak_rotation" in attributes else {}
    return peak | {
        "overturned": Outcome[attributes["outcome"]] >= Outcome.OVERTURNED_DIRECTLY,
        "outcome": attributes["outcome"],
        "impacts": int(attributes["impacts"]),
        "warnings": [attributes["warnings"]] if reactions and attributes["warnings"] else [],
        "impact_time": motion["impact_time"].values.tolist(),
        "contact": _contact(motion, reactions) if reactions else None,
    }


def _contact(motion: xr.Dataset, reactions: dict[str, Any]) -> ContactResponse:
    """Reactions of a motion, by sample, and their extremes."""
    fields: dict[str, Any] = {name: [finite(value) for value in column] for name, column in reactions.items()}
    fields |= {name: finite(float(motion.attrs[name])) for name in ATTRIBUTES if name in motion.attrs}
    return ContactResponse.model_construct(
        **fields, lifts_off=bool(motion.attrs["lifts_off"]), warnings=motion.attrs["warnings"]
    )


class AmplitudeThreshold(BaseModel):
    """An amplitude at which the outcome changes."""

    amplitude: float = said("a = a_g/(g tan alpha)", unit="-")
    slenderness: float = said("1/a", unit="-")
    overturns_above: bool = said("true: overturns just above and survives just below it; false: the reverse")
    outcome: str = said("outcome on the side where it overturns")
    meaning: str = said("that outcome in words")
    impacts: int = said("impacts before it overturns there", unit="-")


class AmplitudeResponse(Solved[ThresholdsParams]):
    """All amplitudes at which the outcome changes."""

    thresholds: list[AmplitudeThreshold] = said("ascending in amplitude")
    largest_surviving_amplitude: float | None = said(
        "amplitude below which it does not overturn; null: none found", unit="-"
    )


@router.get("/thresholds", summary="Amplitudes at which the outcome of a block changes", tags=["response"])
async def get_thresholds(
    params: Annotated[ThresholdsParams, Query()], request: Request, service: ServiceDep, url: Url
) -> AmplitudeResponse:
    """Every threshold between survival and overturning, by the solver, each accurate to 1e-12 in 1/a.

    Where a block of restitution 1 overturns after more than 200 impacts, they are accurate to 1e-6.
    """
    return await service.solve(lambda stop: _thresholds(params, url, stop), request)


@router.post(
    "/thresholds",
    summary=f"Amplitudes at which the outcome of a block changes{SAMPLED}",
    tags=["response"],
    dependencies=[Depends(no_query)],
)
async def post_thresholds(params: ThresholdsBody, request: Request, service: ServiceDep, url: Url) -> AmplitudeResponse:
    """The same with the parameters in a JSON body."""
    return await get_thresholds(params, request, service, url)


def _thresholds(params: ThresholdsParams, url: str, stop: StopFlag) -> AmplitudeResponse:
    found = thresholds(params.pulse, **params.groups, highest=params.highest, stop=stop)
    listed = [
        AmplitudeThreshold(
            amplitude=amplitude,
            slenderness=1.0 / amplitude,
            overturns_above=above,
            outcome=Outcome(code).name,
            meaning=Outcome(code).sentence,
            impacts=impacts,
        )
        for amplitude, above, code, impacts in zip(
            found.amplitude.tolist(),
            found.overturns_above.tolist(),
            found.outcome.tolist(),
            found.impacts.tolist(),
            strict=True,
        )
    ]
    lowest = listed[0].amplitude if listed else None
    return AmplitudeResponse(query=params, url=url, thresholds=listed, largest_surviving_amplitude=lowest)


DIGITS = 4  # decimals of the peaks in JSON [-]: enough for a picture, at a third of the length
MAX_AGE = {"Cache-Control": "max-age=600"}  # how long a client may store a map


class MapResponse(Solved[MapParams]):
    """The map, row by row: the first row has the smallest slenderness and starts at the smallest frequency ratio."""

    frequency_ratio: list[float] = said("omega_g/p of the columns", unit="-")
    slenderness: list[float] = said("1/a of the rows", unit="-")
    peak_rotation: list[float | None] = said(
        f"max |theta|/alpha to {DIGITS} decimals (CSV and netCDF hold all digits); null if overturned", unit="-"
    )
    outcome: list[int] = said("final outcome as an index into `outcomes`", unit="-")
    outcomes: list[str] = said("names of the outcomes")


@router.get(
    "/map",
    summary="Outcome and peak rotation over a window of frequency ratio and slenderness",
    response_model=MapResponse,
    responses=encoding.CONTENT,
)
async def get_map(params: Annotated[MapParams, Query()], request: Request, service: ServiceDep, url: Url) -> Any:
    """Many blocks in few bytes, for pictures; always computed by the solver, without error bounds."""
    response = await _solved_map(params, request, service, url)
    response.headers.update(MAX_AGE)
    return response


@router.post(
    "/map",
    summary=f"Outcome and peak rotation over a window of frequency ratio and slenderness{SAMPLED}",
    response_model=MapResponse,
    responses=encoding.CONTENT,
    dependencies=[Depends(no_query)],
)
async def post_map(params: MapBody, request: Request, service: ServiceDep, url: Url) -> Any:
    """The same with the parameters in a JSON body."""
    return await _solved_map(params, request, service, url)


async def _solved_map(params: MapParams, request: Request, service: Service, url: str) -> Response:
    axes = _axes(service, params)
    return await service.solve(lambda stop: _map(params, *axes, url, stop), request)


def _map(params: MapParams, frequency_ratio: Array, slenderness: Array, url: str, stop: StopFlag) -> Response:
    found = peak_response(
        params.pulse,
        slenderness=slenderness[:, None],
        frequency_ratio=frequency_ratio,
        restitution=params.restitution,
        alpha=alpha_of(params.alpha_deg),
        stop=stop,
    )
    if params.format == "nc":
        dataset = _dataset(params, frequency_ratio, slenderness, found)
        return encoding.netcdf_response(dataset, "map", "Outcome and peak rotation of blocks under a pulse", url)
    if params.format == "csv":
        s, w = np.meshgrid(slenderness, frequency_ratio, indexing="ij")
        columns: dict[str, NDArray[Any]] = {"slenderness": s, "frequency_ratio": w}
        columns |= {"peak_rotation": found.peak_rotation, "overturned": found.overturned}
        columns |= {"outcome": np.array(OUTCOMES)[found.outcome], "impacts": found.impacts}
        columns |= {"exceeded_alpha": found.exceeded_alpha}
        return encoding.csv_response({name: values.ravel().tolist() for name, values in columns.items()}, "map")
    return json_of(
        MapResponse.model_construct(
            query=params,
            url=url,
            frequency_ratio=frequency_ratio.tolist(),
            slenderness=slenderness.tolist(),
            peak_rotation=found.peak_rotation.ravel().round(DIGITS).tolist(),
            outcome=found.outcome.ravel().tolist(),
            outcomes=OUTCOMES,
        )
    )


def _axes(service: Service, params: MapParams) -> tuple[Array, Array]:
    """The columns and the rows, within the ranges of the service."""
    left, right = check_window(FREQUENCY_RATIO, params.frequency_ratio_min, params.frequency_ratio_max)
    low, high = check_window(SLENDERNESS, params.slenderness_min, params.slenderness_max)
    if params.columns * params.rows > service.settings.max_samples:
        larger = "columns" if params.columns >= params.rows else "rows"
        allowed = f"columns times rows at most {service.settings.max_samples}"
        raise TooLargeError(larger, getattr(params, larger), allowed)
    return np.geomspace(left, right, params.columns), np.linspace(low, high, params.rows)


def _dataset(params: MapParams, frequency_ratio: Array, slenderness: Array, found: SolverResponse) -> xr.Dataset:
    """The map with the names, types and attributes of the data sets."""
    axes = ("slenderness", "frequency_ratio")
    coordinates = {"slenderness": slenderness, "frequency_ratio": frequency_ratio}
    return xr.Dataset(
        encoding.solved_variables(axes, vars(found)),
        coords={name: (name, values, AXES[name]) for name, values in coordinates.items()},
        attrs=params.model_dump(exclude={"format"}, exclude_none=True),
    )
