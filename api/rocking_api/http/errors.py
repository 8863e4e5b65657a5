"""Errors as problem+json (RFC 9457): which parameter, its value, and what is allowed.

`KINDS` is the one table from exception to status code and type.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping
from dataclasses import dataclass
from http import HTTPMethod
from http import HTTPStatus as S
from typing import Any

from fastapi import FastAPI, Request, Response
from pydantic import BaseModel, Field
from starlette.exceptions import HTTPException
from starlette.routing import BaseRoute, Match, Mount

from rocking._base.errors import DatasetError, InvalidArgumentError, SeveralArgumentsError
from rocking._datasets.catalogue import UnknownDatasetError
from rocking._dimensional.table_reader import TooManyRowsError
from rocking_api.execution.executor import BusyError, TimeLimitError
from rocking_api.execution.kernels import NotReadyError

MEDIA_TYPE = "application/problem+json"


class TooLargeError(InvalidArgumentError):
    """The request exceeds a limit of the service."""


class MalformedBodyError(InvalidArgumentError):
    """The body is not JSON; the value is what is wrong, and where."""


class UnsupportedBodyError(InvalidArgumentError):
    """The body has an unsupported media type or coding."""


class SlowBodyError(InvalidArgumentError):
    """The body does not arrive in time."""


class DamagedDatasetsError(DatasetError):
    """Data sets exist and cannot be used."""

    def __init__(self, damaged: Mapping[str, str]) -> None:
        super().__init__(damaged)
        self.damaged = dict(sorted(damaged.items()))


@dataclass(frozen=True)
class Kind:
    """A kind of error."""

    name: str
    status: S
    meaning: str

    @property
    def type(self) -> str:
        """The `type` of RFC 9457: a reference relative to the service."""
        return f"{PROBLEMS}#{self.name}"


PROBLEMS = "/problems"  # the page that explains the kinds of errors

KINDS: dict[type[Exception], Kind] = {
    InvalidArgumentError: Kind(  # OutsideCubeError is one
        "invalid-parameter", S.UNPROCESSABLE_ENTITY,
        "A parameter is missing, unknown, given twice, not of its type or out of range; `errors` lists all of them.",
    ),
    MalformedBodyError: Kind("malformed-json", S.BAD_REQUEST, "The body is not JSON; `value` says why and where."),
    TooLargeError: Kind(
        "too-large", S.REQUEST_ENTITY_TOO_LARGE, "The request exceeds a limit of the service: divide it."
    ),
    TooManyRowsError: Kind("too-many-rows", S.REQUEST_ENTITY_TOO_LARGE, "The table has too many rows: divide it."),
    UnsupportedBodyError: Kind(
        "unsupported-body", S.UNSUPPORTED_MEDIA_TYPE, "The route does not read this media type, or it is compressed."
    ),
    UnknownDatasetError: Kind("unknown-data-set", S.NOT_FOUND, "No data set has this name; /v1/datasets lists them."),
    SlowBodyError: Kind("slow-body", S.REQUEST_TIMEOUT, "The body did not arrive in time."),
    DatasetError: Kind("damaged-data-set", S.SERVICE_UNAVAILABLE, "A data set cannot be used; it was logged."),
    BusyError: Kind("busy", S.SERVICE_UNAVAILABLE, "Queue or memory are full: repeat it after `Retry-After`."),
    NotReadyError: Kind("not-ready", S.SERVICE_UNAVAILABLE, "The solver is being loaded: repeat after `Retry-After`."),
    TimeLimitError: Kind("time-limit", S.GATEWAY_TIMEOUT, "The work exceeds the time limit of a request: reduce it."),
}  # fmt: skip
"""Kinds of errors by exception."""

OTHERS = (
    Kind("bad-request", S.BAD_REQUEST, "A header is missing, given twice or malformed: Host, Range."),
    Kind("not-found", S.NOT_FOUND, "There is nothing at this address, or no longer this version of it."),
    Kind("method-not-allowed", S.METHOD_NOT_ALLOWED, "The route has other methods, which `Allow` lists."),
    Kind("range", S.REQUESTED_RANGE_NOT_SATISFIABLE, "The Range is outside the file."),
    Kind("internal", S.INTERNAL_SERVER_ERROR, "A fault of the service, not of the request; it was logged."),
)
"""Those without an exception, by their status codes."""

NOSNIFF = (b"x-content-type-options", b"nosniff")  # of every response: no content sniffing by browsers

HEADERS: dict[type[Exception], dict[str, str]] = {
    BusyError: {"Retry-After": "2"},
    NotReadyError: {"Retry-After": "30"},
    SlowBodyError: {"Connection": "close"},  # the rest of the body is not read
}
"""Additional headers."""

MAX_TEXT = 400  # characters of a value that an error repeats
MAX_DETAIL = 2000  # characters of the detail of an error, which may show the first lines of a file
MAX_NUMBER = sys.float_info.max  # largest number that an error repeats; larger integers become text
MAX_ERRORS = 20  # parameters that an error names at most


class InvalidParameter(BaseModel):
    """A parameter that is missing or wrong."""

    name: str = Field(description="which parameter")
    value: float | str | None = Field(None, description="what it was")
    allowed: str = Field(description="what is allowed")


class Problem(BaseModel):
    """RFC 9457, with the three parts of every error message."""

    type: str = Field(description="kind of the error: address and anchor of its explanation, relative to the service")
    title: str = Field(description="what the status code means")
    status: int = Field(description="HTTP status code")
    detail: str = Field(description="what is wrong, in one sentence")
    parameter: str | None = Field(None, description="which parameter")
    value: float | str | None = Field(None, description="what it was")
    allowed: str | None = Field(None, description="what is allowed")
    errors: list[InvalidParameter] | None = Field(
        None,
        description="where several parameters are missing or wrong, all of them, at most 20; `parameter`, "
        "`value` and `allowed` are those of the first; of /ready the damaged data sets",
    )


RESPONSES: dict[int | str, dict[str, Any]] = {
    int(status): {"description": S(status).phrase, "content": {MEDIA_TYPE: {"schema": schema}}}
    for schema in [{"$ref": "#/components/schemas/Problem"}]
    for status in sorted({kind.status for kind in (*KINDS.values(), *OTHERS)} - {416})
}
"""For the OpenAPI description: error responses of any route."""


def problem_response(kind: Kind | int, detail: str, headers: Mapping[str, str] | None = None, **parts: Any) -> Response:
    """An error response of a kind, or of one of `OTHERS` by its status; `parts` are other fields of `Problem`."""
    if not isinstance(kind, Kind):
        status = kind
        kind = next((one for one in OTHERS if one.status == status), Kind("other", S(status), ""))
    parts = {name: _text(part) if isinstance(part, str) else part for name, part in parts.items()}
    parts["value"] = plain(parts.get("value"))
    content = Problem(
        type=kind.type, title=kind.status.phrase, status=kind.status, detail=_text(detail, MAX_DETAIL), **parts
    )
    return Response(content.model_dump_json(exclude_none=True), kind.status, headers, MEDIA_TYPE)


def internal_error() -> Response:
    """The response to an internal error, without details."""
    return problem_response(S.INTERNAL_SERVER_ERROR, "internal error, not caused by the request; it was logged")


def add_handlers(app: FastAPI) -> None:
    """Register a handler for each exception of the table; others are logged by `RequestLog`."""
    for kind in KINDS:
        app.add_exception_handler(kind, error_response)
    app.add_exception_handler(HTTPException, _handle_http)


async def error_response(_: Request, error: Exception) -> Response:
    """The response to an exception of the table."""
    kind = next(KINDS[one] for one in type(error).__mro__ if one in KINDS)
    headers = HEADERS.get(type(error))
    found = _named(error)
    if not found:
        return problem_response(kind, str(error), headers)
    errors = [
        InvalidParameter(name=_text(one.parameter), value=plain(one.value), allowed=_text(one.allowed))
        for one in found[:MAX_ERRORS]
    ]
    if isinstance(error, DamagedDatasetsError):
        detail = f"{len(found)} data sets are damaged: " + "; ".join(one.parameter for one in found)
        return problem_response(kind, detail, headers, errors=errors)
    first = {"parameter": found[0].parameter, "value": found[0].value, "allowed": found[0].allowed}
    if len(found) == 1:
        return problem_response(kind, str(found[0]), headers, **first)
    detail = f"{len(found)} parameters are missing or wrong: " + "; ".join(map(str, found[:MAX_ERRORS]))
    return problem_response(kind, detail, headers, **first, errors=errors)


def _named(error: Exception) -> list[InvalidArgumentError]:
    """The parameters that an error names, each once, in order; empty if it names none."""
    found: list[InvalidArgumentError] = []
    if isinstance(error, SeveralArgumentsError):
        found = error.errors
    elif isinstance(error, InvalidArgumentError):
        found = [error]
    elif isinstance(error, DamagedDatasetsError):
        found = [InvalidArgumentError(name, text, "an intact data set") for name, text in error.damaged.items()]
    elif isinstance(error, UnknownDatasetError):
        name = error.args[0]
        found = [refusal(f"there is no data set `{name}`", "name", name, "a name that /v1/datasets lists")]
    once: dict[str, InvalidArgumentError] = {}
    for one in found:  # alternatives of one parameter give an error each
        once.setdefault(one.parameter, one)
    return [*once.values()]


def refusal(text: str, parameter: str, value: Any, allowed: str) -> InvalidArgumentError:
    """An error with a text of its own."""
    error = InvalidArgumentError(parameter, value, allowed)
    error.args = (text,)
    return error


async def _handle_http(request: Request, error: Exception) -> Response:
    assert isinstance(error, HTTPException)
    headers, detail = dict(error.headers or {}), str(error.detail)
    if error.status_code == S.METHOD_NOT_ALLOWED and (methods := _methods(request)):
        headers = {"Allow": ", ".join(methods)}
    if "Allow" in headers:
        detail = f"{request.method} is not a method of this route; allowed: {headers['Allow']}"
    elif detail == S.NOT_FOUND.phrase:  # of no route
        detail = f"there is nothing at {_text(request.url.path)}; /docs lists the routes"
    return problem_response(error.status_code, detail, headers)


def _methods(request: Request) -> list[str]:
    """The methods of all routes of a path, of which each knows its own only; none of a mounted folder."""

    def match(route: BaseRoute, method: str) -> Match:
        return route.matches({"type": "http", "path": request.scope["path"], "root_path": "", "method": method})[0]

    routes = [one for one in request.app.routes if not isinstance(one, Mount) and match(one, "") is not Match.NONE]
    return [method for method in HTTPMethod if any(match(one, method) is Match.FULL for one in routes)]


def plain(value: Any) -> float | str | None:
    """A value that JSON can represent; nan and inf here as text."""
    if value is None or (isinstance(value, (int, float)) and -MAX_NUMBER <= value <= MAX_NUMBER):
        return value
    if isinstance(value, (bytes, bytearray)):  # a body of any size
        return value[:MAX_TEXT].decode("utf-8", "backslashreplace")
    return _text(str(value))


def _text(text: str, most: int = MAX_TEXT) -> str:
    """The start of a text that UTF-8 can encode: JSON may hold half of a pair of escapes, here as text."""
    return text[:most].encode("utf-8", "backslashreplace").decode("utf-8")
