"""The motion of one block against time (figures 2 and 7)."""

from __future__ import annotations

from typing import Annotated, Any

import xarray as xr
from fastapi import APIRouter, Query, Request, Response

from rocking._numba.cancellation import StopFlag
from rocking.history.contact import ATTRIBUTES, COLUMNS
from rocking.history.time_history import time_history
from rocking_api.http.encoding import CONTENT, csv_response, json_response, negotiated_form, netcdf_response
from rocking_api.http.errors import TooLargeError
from rocking_api.http.params_route import ParamsRoute
from rocking_api.models.params import HistoryParams, alpha_of
from rocking_api.models.responses import ContactResponse, HistoryResponse, finite
from rocking_api.service import ServiceDep

router = APIRouter(prefix="/v1", tags=["curves"], route_class=ParamsRoute)


@router.get("/history", summary="Motion of one block", response_model=HistoryResponse, responses=CONTENT)
async def get_history(params: Annotated[HistoryParams, Query()], request: Request, service: ServiceDep) -> Response:
    """Rotation and angular velocity from the start of the pulse through free rocking, always computed by the solver.

    With `contact`, also the reactions of the ground and the friction demand.
    """
    if params.samples > service.settings.max_samples:
        raise TooLargeError("samples", params.samples, f"at most {service.settings.max_samples}")
    form = negotiated_form(request, params.format)
    return await service.run_heavy(params, lambda stop: _history(params, form, stop), request)


def _history(params: HistoryParams, form: str, stop: StopFlag) -> Response:
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
    sampled = ("tau", "rotation", "angular_velocity", "ground_acceleration")
    columns: dict[str, Any] = {name: motion[name].values.tolist() for name in sampled}
    reactions: dict[str, Any] = {name: motion[name].values.tolist() for name in COLUMNS if params.contact}
    if form == "csv":
        return csv_response(columns | reactions, "history")
    contact = contact_response(motion, reactions) if params.contact else None
    return json_response(_answer(params, motion, columns, contact))


def contact_response(motion: xr.Dataset, reactions: dict[str, Any]) -> ContactResponse:
    """Reactions of a motion, by sample, and their extremes."""
    fields: dict[str, Any] = {name: [finite(value) for value in column] for name, column in reactions.items()}
    fields |= {name: finite(float(motion.attrs[name])) for name in ATTRIBUTES}
    return ContactResponse.model_construct(
        **fields, lifts_off=bool(motion.attrs["lifts_off"]), warnings=motion.attrs["warnings"]
    )


def _answer(
    params: HistoryParams, motion: xr.Dataset, columns: dict[str, Any], contact: ContactResponse | None
) -> HistoryResponse:
    return HistoryResponse.model_construct(
        query=params,
        overturned=bool(motion.attrs["overturned"]),
        outcome=motion.attrs["outcome"],
        peak_rotation=finite(float(motion.attrs["peak_rotation"])),
        impacts=int(motion.attrs["impacts"]),
        impact_time=motion["impact_time"].values.tolist(),
        contact=contact,
        **columns,
    )
