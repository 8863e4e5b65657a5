"""Request bodies and responses of POST /v1/response: JSON, CSV or netCDF-3."""

from __future__ import annotations

import io
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import anyio
import anyio.lowlevel
import numpy as np
import xarray as xr
from fastapi import Request, Response
from numpy.typing import NDArray
from pydantic import ValidationError

from rocking._base.errors import InvalidArgumentError
from rocking._numba.cancellation import StopFlag
from rocking_api.execution.evaluation import BatchResult
from rocking_api.execution.executor import BusyError
from rocking_api.http.encoding import MEDIA_TYPES, Form, csv_stream, dataset_of, json_stream, netcdf_response
from rocking_api.http.errors import InvalidQueryError, SlowBodyError, TooLargeError, UnsupportedBodyError
from rocking_api.http.memory_budget import Reservation
from rocking_api.http.number_columns import GROUPS, Columns, check_columns, cut_arrays, parse_array, parse_csv
from rocking_api.models.params import BatchParams, LookupOptions, check_value
from rocking_api.models.pulses import sampled_pulse, with_samples
from rocking_api.models.responses import BatchResponse, columns_of

_BODY, _OPTIONS = with_samples(BatchParams), with_samples(LookupOptions)

TURN_BYTES = 64 * 1024
"""Bytes of a body that arrive without waiting for other bodies.

With 64 connections that are read in one iteration of the event loop, 16 MB of bodies pass between two steps of any
other request, and `/health` took 1.4 to 2.7 s.
"""


@dataclass(frozen=True)
class Batch:
    """Points to evaluate, arrays of shape (points,), and the options."""

    options: LookupOptions
    groups: dict[str, NDArray[np.float64]]

    @property
    def points(self) -> int:
        return self.groups["slenderness"].size

    @property
    def nbytes(self) -> int:
        """Memory of the arrays [bytes]; a group given as one number takes none."""
        return sum(column.size * abs(column.strides[0]) for column in self.groups.values() if any(column.strides))


def body_form(request: Request, accepted: Sequence[Form] = ("json", "csv", "nc")) -> Form:
    """Format of the body by its Content-Type; JSON without one.

    Raises
    ------
    UnsupportedBodyError
        For a type that is not accepted.
    """
    declared = request.headers.get("content-type", MEDIA_TYPES["json"]).split(";")[0].strip().lower()
    for form in accepted:
        if declared in (MEDIA_TYPES[form], "application/netcdf" if form == "nc" else MEDIA_TYPES[form]):
            return form
    types = ", ".join(MEDIA_TYPES[form] for form in accepted)
    raise UnsupportedBodyError("Content-Type", declared, f"one of {types}")


async def limited_body(
    request: Request, limit: int, seconds: float, reservation: Reservation, turns: anyio.Lock
) -> bytes:
    """The body, of at most `limit` bytes, within `seconds`; its bytes are counted in `reservation`.

    Beyond `TURN_BYTES` bodies arrive in turns: one connection is read in each iteration of the event loop. A body that
    exceeds the bytes in flight is read to its end and dropped, also in turns, before it is refused.

    Raises
    ------
    TooLargeError, SlowBodyError
        If it is larger, or takes longer.
    UnsupportedBodyError
        If it is compressed: a few bytes could expand to any number.
    BusyError
        If the bytes in flight exceed their limit.
    """
    coding = request.headers.get("content-encoding", "identity")
    if coding != "identity":
        raise UnsupportedBodyError("Content-Encoding", coding, "none: bodies are not compressed")
    declared = request.headers.get("content-length", "")
    if declared.isdecimal() and int(declared[:20]) > limit:  # more digits exceed any limit
        raise TooLargeError("body", declared[:20], f"at most {limit} bytes")
    body = io.BytesIO()  # getvalue() does not copy
    size, refusal = 0, None
    with anyio.move_on_after(seconds) as patience:
        async for chunk in request.stream():
            size += len(chunk)
            if size > limit:
                raise TooLargeError("body", size, f"at most {limit} bytes")
            if refusal is None:
                try:
                    reservation.add(len(chunk))
                    body.write(chunk)
                except BusyError as error:
                    refusal, body = error, io.BytesIO()
                    reservation.replace(0)
            if size > TURN_BYTES:  # no more of it is read before the next request for a chunk
                async with turns:
                    await anyio.lowlevel.checkpoint()
    if refusal is not None:
        raise refusal
    if patience.cancelled_caught:
        raise SlowBodyError("body", f"{size} bytes", f"all of it within {seconds:g} s")
    return body.getvalue()


def read_batch(body: bytes, form: Form, parameters: Mapping[str, str], max_points: int, stop: StopFlag) -> Batch:
    """Parse a batch. JSON holds everything; for the other formats, options and missing groups are query parameters.

    Raises
    ------
    InvalidArgumentError
        If the body cannot be parsed, a parameter is unknown, the groups differ in length, or one is out of range.
    ValidationError, InvalidQueryError
        If JSON does not fit `BatchParams`, or options in the URL do not fit `LookupOptions`.
    TooLargeError
        For more than `max_points` points.
    StoppedError
        If `stop` was set.
    """
    if form == "json":
        columns, options = _read_json(body, max_points, stop)
        for name, value in parameters.items():
            if name not in ("pulse", "method") or getattr(options, name) != value:
                raise InvalidArgumentError(name, value, "nothing in the URL that the JSON body does not hold as well")
    else:
        columns = parse_csv(body, max_points, stop) if form == "csv" else _read_netcdf(body, max_points)
        given = {name: value for name, value in parameters.items() if name != "format"}
        for name in GROUPS:
            if name in given:
                if name in columns:
                    raise InvalidArgumentError(name, given[name], "either in the body or in the URL")
                columns[name] = np.atleast_1d(_number(name, given.pop(name)))
        try:
            options = LookupOptions.model_validate_strings(given)
        except ValidationError as error:
            raise InvalidQueryError(error, []) from None
    for name in GROUPS:
        if name not in columns:
            raise InvalidArgumentError(name, None, "required: a column of the body or a parameter in the URL")
    sizes = {name: column.size for name, column in columns.items()}
    points = max(sizes.values()) if min(sizes.values()) else 0
    for name, size in sizes.items():
        if size not in (1, points):
            raise InvalidArgumentError(name, f"{size} values", f"one value, or as many as the others: {points}")
    if points > max_points:
        raise TooLargeError("points", points, f"at most {max_points}")
    options.check()
    for name, column in columns.items():
        check_value(name, column)
    return Batch(options, {name: np.broadcast_to(columns[name], (points,)) for name in GROUPS})


def _number(name: str, text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise InvalidArgumentError(name, text, "a number") from None


def _read_json(body: bytes, max_points: int, stop: StopFlag) -> tuple[Columns, LookupOptions]:
    rest, arrays = cut_arrays(body)
    params = _BODY.model_validate_json(rest)
    columns = {}
    for name in GROUPS:
        value = getattr(params, name)
        if value == [] and name in arrays:
            columns[name] = parse_array(name, body, arrays[name], max_points, stop)
        else:
            columns[name] = np.atleast_1d(np.array(value, dtype=np.float64))
    options = {name: getattr(params, name) for name in LookupOptions.model_fields}
    kind = LookupOptions if sampled_pulse(params) is None else _OPTIONS
    return columns, kind.model_construct(**options)  # validated


def _read_netcdf(body: bytes, max_points: int) -> Columns:
    """Variables of any dimensions broadcast by dimension name; points follow in C order of the dimensions."""
    if not body.startswith((b"CDF\x01", b"CDF\x02")):
        raise InvalidArgumentError("body", repr(body[:4]), "netCDF-3, as written by Dataset.to_netcdf(engine='scipy')")
    try:
        with xr.open_dataset(io.BytesIO(body), engine="scipy", decode_times=False) as opened:
            dataset = opened.load()
        names = [str(name) for name in dataset.variables]
        columns = [dataset[name].astype(np.float64) for name in names]
    except Exception as error:  # noqa: BLE001  (whatever scipy and xarray meet in a damaged file)
        raise InvalidArgumentError("body", repr(error)[:100], "an undamaged netCDF-3 file of numbers") from None
    check_columns(names)
    points = math.prod(dataset.sizes.values())
    if points > max_points:  # before broadcasting
        raise TooLargeError("points", points, f"at most {max_points}")
    return {str(column.name): np.ravel(column.values) for column in xr.broadcast(*columns)}


def batch_response(batch: Batch, request: Request, result: BatchResult, form: Form) -> Response:
    """The response in a format; JSON and CSV are written while they are sent."""
    query: dict[str, Any] = batch.options.model_dump() | {"points": batch.points}
    if form == "nc":
        attributes = {name: value for name, value in query.items() if value is not None}
        return netcdf_response(dataset_of(batch.groups, result, attributes), "response")
    columns = columns_of(result)
    if form == "csv":
        return csv_stream(batch.groups | columns, "response")
    answer = BatchResponse.model_construct(query=query, data_versions=list(result.versions))
    return json_stream(answer, request, columns)
