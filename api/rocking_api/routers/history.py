"""The motion of one block against time (figures 2 and 7)."""

from __future__ import annotations

from typing import Annotated, Any

import xarray as xr
from fastapi import APIRouter, Query, Request, Response

from rocking._base.errors import finite
from rocking._history.contact import ATTRIBUTES, COLUMNS
from rocking._history.time_history import time_history
from rocking._model.outcome import Outcome
from rocking._numba.cancellation import StopFlag
from rocking_api.http.encoding import CONTENT, csv_response, json_response, negotiated_form, netcdf_response
from rocking_api.http.errors import TooLargeError
from rocking_api.http.parameters import ParamsRoute
from rocking_api.models.params import HistoryParams, alpha_of
from rocking_api.models.responses import ContactResponse, HistoryResponse
from rocking_api.routers.twin import pair
from rocking_api.service import ServiceDep

SAMPLED = ("rotation", "angular_velocity", "edge", "ground_acceleration", "vertical_acceleration", "top_displacement")
"""Variables of motions that are sent where they are known."""

router = APIRouter(prefix="/v1", tags=["curves"], route_class=ParamsRoute)


@pair(router, "/history", "Motion of one block", response_model=HistoryResponse, responses=CONTENT)
async def get_history(params: Annotated[HistoryParams, Query()], request: Request, service: ServiceDep) -> Response:
    """Rotation and angular velocity from the start of the pulse through free rocking, always computed by the solver.

    With `contact`, also the reactions of the ground and the friction demand.
    """
    if params.samples > service.settings.max_samples:
        raise TooLargeError("samples", params.samples, f"at most {service.settings.max_samples}")
    form = negotiated_form(request, params.format)
    return await service.run_heavy(params, lambda stop: _history(params, request, form, stop), request)


def _history(params: HistoryParams, request: Request, form: str, stop: StopFlag) -> Response:
    motion = time_history(
        params.pulse,
        slenderness=params.slenderness,
        frequency_ratio=params.frequency_ratio,
        restitution=params.restitution,
        alpha=alpha_of(params.alpha_deg),
        duration=params.duration,
        samples=params.samples,
        contact=params.contact,
        stop=stop,
    )
    if form == "nc":
        return netcdf_response(motion, "history")
    columns, reactions = motion_columns(motion, "tau")
    if form == "csv":
        return csv_response(columns | reactions, "history")
    return json_response(
        HistoryResponse.model_construct(query=params, **motion_fields(motion, reactions), **columns), request
    )


def motion_columns(motion: xr.Dataset, time: str) -> tuple[dict[str, Any], dict[str, Any]]:
    """The samples of a motion against its variable of time, and of the reactions, if it has any."""
    columns = {name: motion[name].values.tolist() for name in (time, *SAMPLED) if name in motion}
    return columns, {name: motion[name].values.tolist() for name in COLUMNS if name in motion}


def motion_fields(motion: xr.Dataset, reactions: dict[str, Any]) -> dict[str, Any]:
    """The fields of `Motion` beside the samples; of another body without a peak."""
    about = motion.attrs
    peak = {"peak_rotation": finite(float(about["peak_rotation"]))} if "peak_rotation" in about else {}
    return peak | {
        "overturned": Outcome[about["outcome"]] >= Outcome.OVERTURNED_DIRECTLY,
        "outcome": about["outcome"],
        "impacts": int(about["impacts"]),
        "warnings": [about["warnings"]] if reactions and about["warnings"] else [],
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
