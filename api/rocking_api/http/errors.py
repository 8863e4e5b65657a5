"""Errors as problem+json (RFC 9457): which parameter, its value, and what is allowed.

`STATUS` is the one table from exception to status code.
"""

from __future__ import annotations

import sys
from http import HTTPStatus
from typing import Any

import pydantic_core
from fastapi import FastAPI, Request, Response
from fastapi.exceptions import RequestValidationError
from pydantic import BaseModel, Field, ValidationError
from starlette.exceptions import HTTPException

from rocking.datasets.catalogue import UnknownDatasetError
from rocking.errors import DatasetError, InvalidArgumentError
from rocking_api.execution.executor import BusyError, TimeLimitError
from rocking_api.execution.kernels import NotReadyError

MEDIA_TYPE = "application/problem+json"


class TooLargeError(InvalidArgumentError):
    """The request exceeds a limit of the service."""


class UnsupportedBodyError(InvalidArgumentError):
    """The body has an unsupported media type or coding."""


class SlowBodyError(InvalidArgumentError):
    """The body does not arrive in time."""


STATUS: dict[type[Exception], int] = {
    InvalidArgumentError: HTTPStatus.UNPROCESSABLE_ENTITY,  # OutsideCubeError is one
    TooLargeError: HTTPStatus.REQUEST_ENTITY_TOO_LARGE,
    UnsupportedBodyError: HTTPStatus.UNSUPPORTED_MEDIA_TYPE,
    UnknownDatasetError: HTTPStatus.NOT_FOUND,
    SlowBodyError: HTTPStatus.REQUEST_TIMEOUT,
    DatasetError: HTTPStatus.SERVICE_UNAVAILABLE,
    BusyError: HTTPStatus.SERVICE_UNAVAILABLE,
    NotReadyError: HTTPStatus.SERVICE_UNAVAILABLE,
    TimeLimitError: HTTPStatus.GATEWAY_TIMEOUT,
    RequestValidationError: HTTPStatus.UNPROCESSABLE_ENTITY,
    ValidationError: HTTPStatus.UNPROCESSABLE_ENTITY,
}


NOSNIFF = (b"x-content-type-options", b"nosniff")
"""Of every response: no content sniffing by browsers."""

HEADERS: dict[type[Exception], dict[str, str]] = {
    BusyError: {"Retry-After": "2"},
    NotReadyError: {"Retry-After": "30"},
    SlowBodyError: {"Connection": "close"},  # the rest of the body is not read
}
"""Additional headers."""


MAX_TEXT = 400
"""Characters of a value that an error repeats."""


MAX_NUMBER = sys.float_info.max
"""Largest number that an error repeats; larger integers become text."""


class Problem(BaseModel):
    """RFC 9457, with the three parts of every error message."""

    type: str = Field("about:blank", description="always about:blank: the title says what the status means")
    title: str = Field(description="what the status code means")
    status: int = Field(description="HTTP status code")
    detail: str = Field(description="what is wrong, in one sentence")
    parameter: str | None = Field(None, description="which parameter")
    value: float | str | None = Field(None, description="what it was")
    allowed: str | None = Field(None, description="what is allowed")


RESPONSES: dict[int | str, dict[str, Any]] = {
    int(status): {"description": HTTPStatus(status).phrase, "content": {MEDIA_TYPE: {"schema": schema}}}
    for schema in [{"$ref": "#/components/schemas/Problem"}]
    for status in (404, 405, 408, 413, 415, 422, 500, 503, 504)
}
"""For the OpenAPI description: error responses of any route."""


def problem_response(status: int, detail: str, headers: dict[str, str] | None = None, **parts: Any) -> Response:
    """An error response."""
    value = _plain(parts.pop("value", None))
    texts = {name: text[:MAX_TEXT] for name, text in {"detail": detail, **parts}.items() if text is not None}
    content = Problem(title=HTTPStatus(status).phrase, status=status, value=value, **texts)
    return Response(content.model_dump_json(exclude_none=True), status, headers, MEDIA_TYPE)


def internal_error() -> Response:
    """The response to an internal error, without details."""
    return problem_response(
        HTTPStatus.INTERNAL_SERVER_ERROR, "internal error, not caused by the request; it was logged"
    )


def add_handlers(app: FastAPI) -> None:
    """Register a handler for each exception of the table; others are logged by `RequestLog`."""
    for kind in STATUS:
        app.add_exception_handler(kind, error_response)
    app.add_exception_handler(HTTPException, _handle_http)
    app.add_exception_handler(Exception, _handle_unknown)


async def error_response(_: Request, error: Exception) -> Response:
    """The response to an exception of the table."""
    status = next(STATUS[kind] for kind in type(error).__mro__ if kind in STATUS)
    headers = HEADERS.get(type(error))
    if isinstance(error, RequestValidationError):
        return _of_validation(status, error.errors()[0])
    if isinstance(error, ValidationError):
        return _of_validation(status, error.errors(include_url=False)[0])
    if isinstance(error, InvalidArgumentError):
        parts = {"parameter": error.parameter, "value": error.value, "allowed": error.allowed}
        return problem_response(status, str(error), headers, **parts)
    if isinstance(error, UnknownDatasetError):
        allowed = "a name that /v1/datasets lists"
        detail = f"there is no data set `{error.args[0]}`"
        return problem_response(status, detail, parameter="name", value=error.args[0], allowed=allowed)
    return problem_response(status, str(error), headers)


def _of_validation(status: int, error: pydantic_core.ErrorDetails | dict[str, Any]) -> Response:
    kind, context = str(error["type"]), error.get("ctx", {})
    where = [str(part) for part in error["loc"] if part not in ("query", "body", "path")]
    name = where[0] if where else "body"  # the rest is the position in an array
    if kind == "missing":
        return problem_response(status, f"`{name}` is missing", parameter=name, allowed="required")
    if kind == "extra_forbidden":
        detail = f"there is no parameter `{name}`"
        return problem_response(status, detail, parameter=name, value=error["input"], allowed="see /docs")
    if kind == "literal_error":
        allowed = f"one of {context['expected']}"
    elif kind.startswith("float"):
        allowed = "a number"
    else:
        allowed = str(error["msg"])
    text = str(InvalidArgumentError(name, _plain(error["input"]), allowed))
    return problem_response(status, text, parameter=name, value=error["input"], allowed=allowed)


async def _handle_http(request: Request, error: Exception) -> Response:
    assert isinstance(error, HTTPException)
    headers = dict(error.headers) if error.headers else None
    methods = request.app.openapi()["paths"].get(request.url.path)
    if error.status_code == HTTPStatus.METHOD_NOT_ALLOWED and methods:
        headers = {"Allow": ", ".join(method.upper() for method in methods)}  # methods of all routes of the path
    return problem_response(error.status_code, str(error.detail), headers)


async def _handle_unknown(_: Request, __: Exception) -> Response:
    return internal_error()


def _plain(value: Any) -> float | str | None:
    """A value that JSON can represent; nan and inf as text."""
    if value is None or (isinstance(value, (int, float)) and -MAX_NUMBER <= value <= MAX_NUMBER):
        return value
    if isinstance(value, (bytes, bytearray)):  # a body of any size
        return value[:MAX_TEXT].decode("utf-8", "backslashreplace")
    return str(value)[:MAX_TEXT]
