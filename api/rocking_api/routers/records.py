"""A block in metres under a recorded ground motion in the body, which is not stored."""

from __future__ import annotations

import math
from contextlib import suppress
from typing import Annotated, Any

import numpy as np
import xarray as xr
from fastapi import APIRouter, Query, Request, Response

from rocking._base.arrays import Array
from rocking._base.errors import InvalidArgumentError, RecordFileError, finite
from rocking._base.quantities import MASS
from rocking._dimensional.curves import history, with_forces
from rocking._dimensional.problem import Problem
from rocking._dimensional.response import changes_of, respond
from rocking._dimensional.thresholds import scale_window, thresholds_of
from rocking._excitation.records.readers.columns import Choice
from rocking._excitation.records.readers.preview import preview_record
from rocking._excitation.records.readers.read_record import parse_record, with_vertical
from rocking._excitation.records.record import Record
from rocking._excitation.records.record import summary_of as record_summary
from rocking._excitation.records.vertical import reject_flight
from rocking._history.time_history import time_history
from rocking._model.fields import OVERTURNED
from rocking._model.labelled import variable
from rocking._model.outcome import Outcome
from rocking._numba.cancellation import StopFlag
from rocking.suites.body_arrays import as_block
from rocking.suites.configuration import LAYOUT
from rocking_api.http import encoding
from rocking_api.http.errors import TooLargeError, refusal
from rocking_api.models import records as m
from rocking_api.models.answer import Url
from rocking_api.models.blocks import ScaleThreshold
from rocking_api.routers.curves import json_of, motion_columns, motion_fields
from rocking_api.service import SEARCH_SHARE, Service, ServiceDep

router = APIRouter(prefix="/v1/records", tags=["response"])

_EXAMPLE = "time [s],acceleration [g]\n" + "".join(
    f"{0.05 * k:.2f},{0.6 * math.sin(math.pi * k / 10.0):.4f}\n" for k in range(21)
)
"""One full sine of 1 s and 0.6 g."""

STATED_OF_FILE = [name for name in LAYOUT if name not in ("vertical", "allow_unusual")]
"""Arguments of `read_record` about one component."""

_MEDIA = dict.fromkeys(("text/plain", "text/csv", "application/octet-stream"), _EXAMPLE)

FILE = encoding.body_of(
    {"record": _EXAMPLE, "width": 0.4, "height": 1.6},
    _MEDIA,
    "file of the record: AT2, ESM, K-NET, COSMOS, CSMIP, GeoNet by their signatures, or columns in a stated layout, "
    "with the parameters in the query; or JSON that holds them all",
)
"""The OpenAPI description of the body of routes that answer for a block."""

FILE_ALONE = encoding.body_of({"record": _EXAMPLE}, _MEDIA, "file of the record, or JSON that holds its text")
"""That of the route that shows what the file holds."""


@router.post("/preview", summary="What a file of a record holds, and how it would be read", openapi_extra=FILE_ALONE)
async def post_preview(
    body: encoding.JsonOrFile[m.RecordPreviewBody],
    query: Annotated[m.RecordPreviewParams, Query()],
    request: Request,
    service: ServiceDep,
    url: Url,
) -> m.RecordPreviewResponse:
    """First lines, columns, what is missing, and the record that would be read. Nothing is solved.

    A file that is not read is no error: `problem` says what is wrong, or what is asked.
    """
    params = encoding.stated(body, query)
    return await service.read_body(lambda stop: _preview(body, params, url, stop), request)


@router.post("/response", summary="A block in SI units under a record", openapi_extra=FILE)
async def post_response(
    body: encoding.JsonOrFile[m.RecordResponseBody],
    query: Annotated[m.RecordResponseParams, Query()],
    request: Request,
    service: ServiceDep,
    url: Url,
) -> m.RecordResponse | m.RecordBodyResponse:
    """Outcome, rotation, displacement, friction, and all scales at which the outcome changes, by (2.2)."""
    params = encoding.stated(body, query)

    def work(stop: StopFlag) -> m.RecordResponse | m.RecordBodyResponse:
        return _response(service, params, _record(body, params, stop), url, stop)

    return await service.solve_one(work, request)


@router.post(
    "/history",
    summary="Motion of a block in SI units under a record",
    response_model=m.RecordHistoryResponse | m.RecordBodyHistoryResponse,
    responses=encoding.CONTENT,
    openapi_extra=FILE,
)
async def post_history(
    body: encoding.JsonOrFile[m.RecordHistoryBody],
    query: Annotated[m.RecordHistoryParams, Query()],
    request: Request,
    service: ServiceDep,
    url: Url,
) -> Any:
    """Rotation and angular velocity from the first sample through free rocking; with `contact` also reactions.

    In groups for a block; in SI units for a body with other edges. With `mass` the reactions also in newtons.
    """
    params = encoding.stated(body, query)
    limit = service.settings.max_samples
    if params.samples is not None and params.samples > limit:
        raise TooLargeError("samples", params.samples, f"at most {limit}")

    def work(stop: StopFlag) -> Response:
        record = _record(body, params, stop)
        if record.samples > limit and params.samples is None:
            raise TooLargeError("samples", record.samples, f"at most {limit}; state `samples`")
        return _history(params, record, url, stop)

    return await service.solve_one(work, request)


@router.post(
    "/scales",
    summary="A block in SI units under a record times many factors",
    response_model=m.RecordScalesResponse,
    responses=encoding.CONTENT,
    openapi_extra=FILE,
)
async def post_scales(
    body: encoding.JsonOrFile[m.RecordScalesBody],
    query: Annotated[m.RecordScalesParams, Query()],
    request: Request,
    service: ServiceDep,
    url: Url,
) -> Any:
    """Outcome and peak rotation over the scale of the record, and every scale at which the outcome changes."""
    params = encoding.stated(body, query)
    return await service.solve(lambda stop: _scales(params, _record(body, params, stop), url, stop), request)


@router.post("/pulse", summary="The pulse fitted to a record", openapi_extra=FILE)
async def post_pulse(
    body: encoding.JsonOrFile[m.RecordPulseBody],
    query: Annotated[m.RecordPulseParams, Query()],
    request: Request,
    service: ServiceDep,
    url: Url,
) -> m.RecordPulseResponse:
    """Parameters of the pulse, how both motions overturn the block, and their accelerations and velocities."""
    params = encoding.stated(body, query)
    return await service.solve(lambda stop: _pulse(params, _record(body, params, stop), url, stop), request)


def _record(body: m.RecordText | bytes, params: m.RecordLayoutParams, stop: StopFlag) -> Record:
    """The record in a body."""
    try:
        return _read(body, params, stop)
    except RecordFileError as error:
        raise refusal(error.message(m.as_parameter, "?", "&"), "record", error.value, error.expected) from None


def _read(body: m.RecordText | bytes, params: m.RecordLayoutParams, stop: StopFlag, **stated: Any) -> Record:
    """The record in a body; `stated` take the place of parameters."""
    layout = {**_layout(params), **stated}
    record = parse_record(_content(body), params.name, **layout, stop=stop)
    if isinstance(body, m.RecordText) and body.vertical_record is not None:
        if params.vertical is not None:
            raise InvalidArgumentError("vertical", params.vertical, "absent beside the file of `vertical_record`")
        upwards = parse_record(body.vertical_record.encode(), f"{params.name}, vertical", **layout, stop=stop)
        record = with_vertical(record, upwards)
    record = record.baseline_corrected(order=params.baseline_order)
    return record.mirrored() if params.mirrored else record


def _content(body: m.RecordText | bytes) -> bytes:
    return body if isinstance(body, bytes) else body.record.encode()


def _layout(params: m.RecordLayoutParams) -> dict[str, Any]:
    """Arguments of `read_record`."""
    return {name: getattr(params, "file_format" if name == "format" else name) for name in LAYOUT}


def _preview(
    body: m.RecordText | bytes, params: m.RecordPreviewParams, url: str, stop: StopFlag
) -> m.RecordPreviewResponse:
    layout = _layout(params)
    preview = preview_record(_content(body), params.name, **{name: layout[name] for name in STATED_OF_FILE}, stop=stop)
    problem = None
    record: Record | None = None
    try:
        record = _read(body, params, stop)
    except RecordFileError as error:
        problem = m.RecordProblem(line=error.line, was=str(error.value)[:200], expected=error.expected)
        with suppress(RecordFileError):  # what is unusual is shown beside the question
            record = _read(body, params, stop, allow_unusual=True)
    time, acceleration = (np.zeros(0), np.zeros(0)) if record is None else _drawn(record, params.samples)
    return m.RecordPreviewResponse(
        query=params,
        url=url,
        file_format=preview.format,
        encoding=preview.encoding,
        lines=[m.RecordLine(**vars(line)) for line in preview.lines],
        columns=preview.columns,
        names_line=preview.names_line,
        in_file=_columns(preview.in_file),
        chosen=_columns(preview.choice),
        missing=list(preview.missing),
        problem=problem,
        record=None if record is None else _description(record),
        time=time.tolist(),
        acceleration=acceleration.tolist(),
    )


def _columns(choice: Choice) -> m.RecordColumns:
    samples = None if choice.samples is None else choice.samples + 1
    time = None if choice.time is None else choice.time + 1
    return m.RecordColumns(acceleration=samples, unit=choice.unit, time=time, time_unit=choice.time_unit)


def _drawn(record: Record, most: int) -> tuple[Array, Array]:
    """Times [s] and accelerations [m/s2], or the least and the largest acceleration of every few samples."""
    if record.samples <= most:
        return record.times, record.acceleration
    starts = np.arange(0, record.samples, math.ceil(2 * record.samples / most))
    least = np.minimum.reduceat(record.acceleration, starts)
    largest = np.maximum.reduceat(record.acceleration, starts)
    return np.repeat(record.times[starts], 2), np.column_stack([least, largest]).ravel()


def _response(
    service: Service, params: m.RecordResponseParams, record: Record, url: str, stop: StopFlag
) -> m.RecordResponse | m.RecordBodyResponse:
    problem = _problem(params, record, params.scale)
    if params.fit and not problem.body.moves_as_block:
        raise InvalidArgumentError("fit", params.fit, "a block whose centre of mass is in its middle")
    seconds = SEARCH_SHARE * service.settings.max_seconds
    found = respond(problem, stop=stop, error_bound=True, thresholds=params.thresholds, seconds=seconds)
    fields: dict[str, Any] = {"thresholds": found.changes, **found.summary()}
    fields |= {"query": params, "url": url, "record": _description(record)}
    if not problem.body.moves_as_block:
        return m.RecordBodyResponse(**fields)
    if params.fit:
        from rocking.suites.pulse_fit import fit_pulse, summary_of  # noqa: PLC0415  (scipy.optimize: half a second)

        fields["pulse"] = m.FittedPulse(**summary_of(fit_pulse(record, blocks=problem.block, stop=stop)))
    return m.RecordResponse(**fields)


def _problem(params: m.RecordFileParams, record: Record, scale: Any) -> Problem:
    return Problem.of(params.rocking_body, record, scale=scale, restitution=params.restitution)


def _history(params: m.RecordHistoryParams, record: Record, url: str, stop: StopFlag) -> Response:
    problem = _problem(params, record, params.scale)
    problem.reject_flight()
    contact = params.contact or params.mass is not None
    options: dict[str, Any] = {"samples": params.samples, "contact": contact, "stop": stop}
    in_groups = problem.body.moves_as_block
    motion = time_history(record, **problem.groups, **options) if in_groups else history(problem, **options)
    if params.mass is not None:
        motion = with_forces(motion, MASS.number(params.mass), float(problem.body.gravity))
    if params.format == "nc":
        return encoding.netcdf_response(motion, "history", "Motion of a block under a record", url)
    columns, reactions = motion_columns(motion, "time")
    if params.format == "csv":
        return encoding.csv_response(columns | reactions, "history")
    kind = m.RecordHistoryResponse if in_groups else m.RecordBodyHistoryResponse
    fields = motion_fields(motion, reactions)
    return json_of(kind.model_construct(query=params, url=url, record=_description(record), **fields, **columns))


def _scales(params: m.RecordScalesParams, record: Record, url: str, stop: StopFlag) -> Response:
    one = _problem(params, record, 1.0)
    uplift, highest = scale_window(one)
    low = uplift if params.scale_min is None else params.scale_min
    high = highest if params.scale_max is None else params.scale_max
    if not low < high:
        raise InvalidArgumentError("scale_max", high, f"above scale_min, {low:g} [-]")
    reject_flight("scale_max", record, high, float(one.body.gravity))
    scale = np.geomspace(low, high, params.points)
    found = respond(_problem(params, record, scale), stop=stop)
    columns: dict[str, Any] = {
        "scale": scale.tolist(),
        "peak_acceleration": (scale * record.peak_acceleration).tolist(),
        "peak_rotation": [finite(value) for value in found.peak_rotation.tolist()],
        "overturned": found.overturned.tolist(),
        "outcome": [Outcome(code).name for code in found.outcome.tolist()],
        "impacts": found.impacts.tolist(),
        "exceeded_alpha": found.exceeded_alpha.tolist(),
    }
    if params.format == "csv":
        return encoding.csv_response(columns, "scales")
    if params.format == "nc":
        dataset = xr.Dataset(
            encoding.solved_variables("scale", {one.name: getattr(found, one.name) for one in found.fields}),
            {"scale": variable("scale", scale, "1", "factor of the record")},
            {"record": record.name, "record_digest": record.digest},
        )
        dataset["overturned"] = OVERTURNED.variable("scale", found.overturned.astype("i1"))
        peak = scale * record.peak_acceleration
        dataset["peak_acceleration"] = variable("scale", peak, "m s-2", "peak acceleration of the scaled record")
        return encoding.netcdf_response(dataset, "scales", "Response of a block over the scale of a record", url)
    changes = [ScaleThreshold(**change) for change in changes_of(thresholds_of(one, high, stop), record)]
    columns |= {"record": _description(record), "thresholds": changes}
    return json_of(m.RecordScalesResponse.model_construct(query=params, url=url, **columns))


def _pulse(params: m.RecordPulseParams, record: Record, url: str, stop: StopFlag) -> m.RecordPulseResponse:
    from rocking.suites.pulse_fit import fit_pulse, summary_of  # noqa: PLC0415  (scipy.optimize: half a second)

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
        url=url,
        record=_description(record),
        pulse=m.FittedPulse(**summary_of(fit)),
        time=time.tolist(),
        **{name: (params.scale * values).tolist() for name, values in drawn.items()},
    )


def _description(record: Record) -> m.RecordDescription:
    return m.RecordDescription(**record_summary(record), remarks=list(record.remarks), digest=record.digest)
