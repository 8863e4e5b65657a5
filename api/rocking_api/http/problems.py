"""Errors as problem+json (RFC 9457): what was wrong, with which value, and what is allowed.

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
    """More than the service takes at once."""


class UnsupportedBodyError(InvalidArgumentError):
    """The body is in a form that the service does not read."""


class SlowBodyError(InvalidArgumentError):
    """The body does not arrive."""


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
"""Of every answer: it is what its type says, and no browser is to guess."""

HEADERS: dict[type[Exception], dict[str, str]] = {
    BusyError: {"Retry-After": "2"},
    NotReadyError: {"Retry-After": "30"},
    SlowBodyError: {"Connection": "close"},  # what still arrives is not read
}
"""What else is said."""


LONGEST = 400
"""Characters of what is repeated to the client: a question of megabytes is not sent back."""


LARGEST = sys.float_info.max
"""Of the numbers that are repeated; integers beyond become text."""


class Problem(BaseModel):
    """RFC 9457, with the three parts of every message of ours."""

    type: str = "about:blank"
    title: str = Field(description="what the status code means")
    status: int
    detail: str
    parameter: str | None = Field(None, description="which parameter")
    value: float | str | None = Field(None, description="what it was")
    allowed: str | None = Field(None, description="what is allowed")


RESPONSES: dict[int | str, dict[str, Any]] = {
    int(status): {"description": HTTPStatus(status).phrase, "content": {MEDIA_TYPE: {"schema": schema}}}
    for schema in [{"$ref": "#/components/schemas/Problem"}]
    for status in (404, 405, 408, 413, 415, 422, 500, 503, 504)
}
"""For the OpenAPI description: what any route may answer instead."""


def problem(status: int, detail: str, headers: dict[str, str] | None = None, **parts: Any) -> Response:
    """The answer to a request that cannot be met."""
    value = _plain(parts.pop("value", None))
    said = {name: text[:LONGEST] for name, text in {"detail": detail, **parts}.items() if text is not None}
    content = Problem(title=HTTPStatus(status).phrase, status=status, value=value, **said)
    return Response(content.model_dump_json(exclude_none=True), status, headers, MEDIA_TYPE)


def internal_error() -> Response:
    """The answer when the service itself is at fault; it tells nothing of the inside."""
    return problem(HTTPStatus.INTERNAL_SERVER_ERROR, "an error of the service, not of the question; it was logged")


def add_handlers(app: FastAPI) -> None:
    """Answer every exception by its line in the table; one that is not in it is logged by the observer."""
    for kind in STATUS:
        app.add_exception_handler(kind, answer_problem)
    app.add_exception_handler(HTTPException, _handle_http)
    app.add_exception_handler(Exception, _handle_unknown)


async def answer_problem(_: Request, error: Exception) -> Response:
    """The answer to an exception of the table."""
    status = next(STATUS[kind] for kind in type(error).__mro__ if kind in STATUS)
    headers = HEADERS.get(type(error))
    if isinstance(error, RequestValidationError):
        return _of_validation(status, error.errors()[0])
    if isinstance(error, ValidationError):
        return _of_validation(status, error.errors(include_url=False)[0])
    if isinstance(error, InvalidArgumentError):
        parts = {"parameter": error.parameter, "value": error.value, "allowed": error.allowed}
        return problem(status, str(error), headers, **parts)
    if isinstance(error, UnknownDatasetError):
        allowed = "a name that /v1/datasets lists"
        detail = f"there is no data set `{error.args[0]}`"
        return problem(status, detail, parameter="name", value=error.args[0], allowed=allowed)
    return problem(status, str(error), headers)


def _of_validation(status: int, error: pydantic_core.ErrorDetails | dict[str, Any]) -> Response:
    kind, context = str(error["type"]), error.get("ctx", {})
    where = [str(part) for part in error["loc"] if part not in ("query", "body", "path")]
    name = where[0] if where else "body"  # what follows is the place inside an array
    if kind == "missing":
        return problem(status, f"`{name}` is missing", parameter=name, allowed="required")
    if kind == "extra_forbidden":
        detail = f"there is no parameter `{name}`"
        return problem(status, detail, parameter=name, value=error["input"], allowed="see /docs")
    if kind == "literal_error":
        allowed = f"one of {context['expected']}"
    elif kind.startswith("float"):
        allowed = "a number"
    else:
        allowed = str(error["msg"])
    text = str(InvalidArgumentError(name, _plain(error["input"]), allowed))
    return problem(status, text, parameter=name, value=error["input"], allowed=allowed)


async def _handle_http(request: Request, error: Exception) -> Response:
    assert isinstance(error, HTTPException)
    headers = dict(error.headers) if error.headers else None
    methods = request.app.openapi()["paths"].get(request.url.path)
    if error.status_code == HTTPStatus.METHOD_NOT_ALLOWED and methods:
        headers = {"Allow": ", ".join(method.upper() for method in methods)}  # of all routes of the path
    return problem(error.status_code, str(error.detail), headers)


async def _handle_unknown(_: Request, __: Exception) -> Response:
    return internal_error()


def _plain(value: Any) -> float | str | None:
    """A value that JSON can carry; nan and inf as words."""
    if value is None or (isinstance(value, (int, float)) and -LARGEST <= value <= LARGEST):
        return value
    if isinstance(value, (bytes, bytearray)):  # a body, of any size
        return value[:LONGEST].decode("utf-8", "backslashreplace")
    return str(value)[:LONGEST]
