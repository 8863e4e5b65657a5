"""A block in metres under a recorded ground motion in the body, which is not stored."""

from __future__ import annotations

import math
from typing import Any, TypeVar

import numpy as np
import xarray as xr
from fastapi import APIRouter, Request, Response

from rocking._base.errors import InvalidArgumentError, RecordFileError, finite
from rocking._dimensional.curves import history
from rocking._dimensional.problem import Problem, record_groups
from rocking._dimensional.response import changes_of, respond
from rocking._dimensional.thresholds import block_thresholds, scale_window, thresholds_of
from rocking._excitation.records.readers.read_record import parse_record
from rocking._excitation.records.record import Record, summary_of
from rocking._excitation.records.vertical import reject_flight
from rocking._history.time_history import time_history
from rocking._model.outcome import Outcome
from rocking._numba.cancellation import StopFlag
from rocking._solver.records.record_response import record_response
from rocking.suites.body_arrays import as_block
from rocking.suites.configuration import LAYOUT
from rocking.suites.pulse_fit import fit_pulse
from rocking.suites.pulse_fit import summary_of as fitted_summary
from rocking_api.http import encoding
from rocking_api.http.errors import TooLargeError, refusal
from rocking_api.http.parameters import ParamsRoute
from rocking_api.models import records as m
from rocking_api.models.blocks import ScaleThreshold
from rocking_api.models.bodies import body_of, json_content, text_content
from rocking_api.models.responses import OUTCOMES
from rocking_api.routers.curves import motion_columns, motion_fields
from rocking_api.service import SEARCH_SHARE, Service, ServiceDep

P = TypeVar("P", bound=m.RecordFileParams)

router = APIRouter(prefix="/v1/records", tags=["response"], route_class=ParamsRoute)

_EXAMPLE = "time [s],acceleration [g]\n" + "".join(
    f"{0.05 * k:.2f},{0.6 * math.sin(math.pi * k / 10.0):.4f}\n" for k in range(21)
)
"""One full sine of 1 s and 0.6 g."""


def _about(kind: type[m.RecordFileParams]) -> dict[str, Any]:
    """The description of a route under a record."""
    example = {"record": _EXAMPLE, "width": 0.4, "height": 1.6}
    files = {
        name: text_content(name, _EXAMPLE)[name] for name in ("text/plain", "text/csv", "application/octet-stream")
    }
    description = (
        "file of the record: AT2, ESM, K-NET, COSMOS, CSMIP, GeoNet by their signatures, or columns in a stated layout"
    )
    return body_of({**files, **json_content(m.with_record(kind), example)}, kind, description)


@router.post("/response", summary="A block in SI units under a record", openapi_extra=_about(m.RecordResponseParams))
async def post_response(request: Request, service: ServiceDep) -> m.RecordResponse | m.RecordBodyResponse:
    """Outcome, rotation, displacement, friction, and all scales at which the outcome changes, by (2.2)."""
    params, record = await _read(m.RecordResponseParams, request, service)
    return await service.run_heavy(lambda stop: _response(service, params, record, stop), request)


@router.post(
    "/history",
    summary="Motion of a block in SI units under a record",
    response_model=m.RecordHistoryResponse | m.RecordBodyHistoryResponse,
    responses=encoding.CONTENT,
    openapi_extra=_about(m.RecordHistoryParams),
)
async def post_history(request: Request, service: ServiceDep) -> Response:
    """Rotation and angular velocity from the first sample through free rocking; with `contact` also reactions.

    In groups for a block; in SI units for a body with other edges.
    """
    limit = service.settings.max_samples
    params, record = await _read(m.RecordHistoryParams, request, service)
    if params.samples is not None and params.samples > limit:
        raise TooLargeError("samples", params.samples, f"at most {limit}")
    if record.samples > limit and params.samples is None:
        raise TooLargeError("samples", record.samples, f"at most {limit}; state `samples`")
    form = encoding.negotiated_form(request, params.format)
    return await service.run_heavy(lambda stop: _history(params, request, record, form, stop), request)


@router.post(
    "/scales",
    summary="A block in SI units under a record times many factors",
    response_model=m.RecordScalesResponse,
    responses=encoding.CONTENT,
    openapi_extra=_about(m.RecordScalesParams),
)
async def post_scales(request: Request, service: ServiceDep) -> Response:
    """Outcome and peak rotation over the scale of the record, and every scale at which the outcome changes."""
    params, record = await _read(m.RecordScalesParams, request, service)
    form = encoding.negotiated_form(request, params.format)
    return await service.run_heavy(lambda stop: _scales(params, request, record, form, stop), request)


@router.post("/pulse", summary="The pulse fitted to a record", openapi_extra=_about(m.RecordPulseParams))
async def post_pulse(request: Request, service: ServiceDep) -> m.RecordPulseResponse:
    """Parameters of the pulse, how both motions overturn the block, and their accelerations and velocities."""
    params, record = await _read(m.RecordPulseParams, request, service)
    return await service.run_heavy(lambda stop: _pulse(params, record, stop), request)


async def _read(kind: type[P], request: Request, service: Service) -> tuple[P, Record]:
    """The parameters, and the record in the body, parsed in a thread, one body at a time."""
    declared = request.headers.get("content-type", "").split(";")[0].strip().lower()
    form: encoding.Form = "json" if declared == encoding.MEDIA_TYPES["json"] else "csv"  # a file, whatever its type
    params, body = await service.read(request, kind, form, m.with_record(kind), service.settings.max_record_bytes)

    def read(stop: StopFlag) -> Record:
        raw = body if isinstance(body, bytes) else body.record.encode()
        stated = {name: getattr(params, name) for name in LAYOUT if name != "format"}
        try:
            record = parse_record(raw, params.name, format=params.file_format, **stated, stop=stop)
        except RecordFileError as error:
            raise refusal(error.message(m.as_parameter, "?", "&"), "record", error.value, error.expected) from None
        return record.baseline_corrected(order=params.baseline_order)

    record = await service.run_parser(read, request, large=True)
    kept = record.acceleration.nbytes * (1 if record.vertical is None else 2)
    service.reservation(request).replace(kept)  # the body is released
    return params, record


def _response(
    service: Service, params: m.RecordResponseParams, record: Record, stop: StopFlag
) -> m.RecordResponse | m.RecordBodyResponse:
    problem = _problem(params, record, params.scale)
    if params.fit and not problem.is_block:
        raise InvalidArgumentError("fit", params.fit, "a block whose centre of mass is in its middle")
    seconds = SEARCH_SHARE * service.settings.max_seconds
    found = respond(problem, stop=stop, thresholds=params.thresholds, seconds=seconds)
    about = {"query": params, "record": _description(record), "thresholds": found.changes}
    said: dict[str, Any] = about | found.summary()
    if not problem.is_block:
        return m.RecordBodyResponse(**said)
    return m.RecordResponse(
        **said,
        pulse=m.FittedPulse(**fitted_summary(fit_pulse(record, blocks=problem.block, stop=stop)))
        if params.fit
        else None,
    )


def _problem(params: m.RecordFileParams, record: Record, scale: Any, *, flies: bool = False) -> Problem:
    return Problem.of(params.rocking_body, record, scale=scale, restitution=params.restitution, flies=flies)


def _history(params: m.RecordHistoryParams, request: Request, record: Record, form: str, stop: StopFlag) -> Response:
    problem = _problem(params, record, params.scale)
    options: dict[str, Any] = {"samples": params.samples, "contact": params.contact, "stop": stop}
    motion = time_history(record, **problem.groups, **options) if problem.is_block else history(problem, **options)
    if form == "nc":
        return encoding.netcdf_response(motion, "history")
    columns, reactions = motion_columns(motion, "time")
    if form == "csv":
        return encoding.csv_response(columns | reactions, "history")
    kind = m.RecordHistoryResponse if problem.is_block else m.RecordBodyHistoryResponse
    found = motion_fields(motion, reactions)
    answer = kind.model_construct(query=params, record=_description(record), **found, **columns)
    return encoding.json_response(answer, request)


def _scales(params: m.RecordScalesParams, request: Request, record: Record, form: str, stop: StopFlag) -> Response:
    one = _problem(params, record, 1.0, flies=True)
    uplift, highest = scale_window(one)
    low = uplift if params.scale_min is None else params.scale_min
    high = highest if params.scale_max is None else params.scale_max
    if not low < high:
        raise InvalidArgumentError("scale_max", high, f"above scale_min, {low:g} [-]")
    reject_flight("scale_max", record, high, float(one.body.gravity))
    scale = np.geomspace(low, high, params.points)
    if one.is_block:
        groups = record_groups(record, one.block, scale, one.groups["restitution"])
        found: Any = record_response(record, **groups, stop=stop)
    else:
        found, _ = _problem(params, record, scale).solve(stop=stop)
    columns: dict[str, Any] = {
        "scale": scale.tolist(),
        "peak_acceleration": (scale * record.peak_acceleration).tolist(),
        "peak_rotation": [finite(value) for value in found.peak_rotation.tolist()],
        "overturned": found.overturned.tolist(),
        "outcome": [Outcome(code).name for code in found.outcome.tolist()],
        "impacts": found.impacts.tolist(),
        "exceeded_alpha": found.exceeded_alpha.tolist(),
    }
    if form == "csv":
        return encoding.csv_response(columns, "scales")
    if form == "nc":
        numbers = {**columns, "peak_rotation": found.peak_rotation, "outcome": found.outcome}
        units = {"peak_acceleration": "m s-2"}
        variables = {
            name: ("scale", np.asarray(values) + 0, {"units": units.get(name, "1")}) for name, values in numbers.items()
        }
        attributes = {"record": record.name, "record_digest": record.digest, "outcomes": " ".join(OUTCOMES)}
        return encoding.netcdf_response(xr.Dataset(variables, attrs=attributes), "scales")
    thresholds = (block_thresholds if one.is_block else thresholds_of)(one, high, stop)
    changes = [ScaleThreshold(**one) for one in changes_of(thresholds, record)]
    columns |= {"record": _description(record), "thresholds": changes}
    return encoding.json_response(m.RecordScalesResponse.model_construct(query=params, **columns), request)


def _pulse(params: m.RecordPulseParams, record: Record, stop: StopFlag) -> m.RecordPulseResponse:
    fit = fit_pulse(record, blocks=as_block(params.rocking_body), stop=stop)
    every = max(1, math.ceil(record.samples / params.samples))
    time = record.times[::every]
    drawn = {
        "record_acceleration": record.acceleration[::every],
        "pulse_acceleration": fit.acceleration(time),
        "record_velocity": record.velocity[::every],
        "pulse_velocity": fit.velocity.velocity(time),
    }
    return m.RecordPulseResponse(
        query=params,
        record=_description(record),
        pulse=m.FittedPulse(**fitted_summary(fit)),
        time=time.tolist(),
        **{name: (params.scale * values).tolist() for name, values in drawn.items()},
    )


def _description(record: Record) -> m.RecordDescription:
    return m.RecordDescription(**summary_of(record), remarks=list(record.remarks), digest=record.digest)
