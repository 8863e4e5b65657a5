"""Errors as problem+json (RFC 9457): which parameter, its value, and what is allowed.

`STATUS` is the one table from exception to status code.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from http import HTTPStatus
from typing import Any

import pydantic_core
from fastapi import FastAPI, Request, Response
from fastapi.exceptions import RequestValidationError
from pydantic import BaseModel, Field, ValidationError
from starlette.exceptions import HTTPException

from rocking._base.errors import DatasetError, InvalidArgumentError, SeveralArgumentsError
from rocking._datasets.catalogue import UnknownDatasetError
from rocking_api.execution.executor import BusyError, TimeLimitError
from rocking_api.execution.kernels import NotReadyError
from rocking_api.models.params import Params

MEDIA_TYPE = "application/problem+json"


class TooLargeError(InvalidArgumentError):
    """The request exceeds a limit of the service."""


class UnsupportedBodyError(InvalidArgumentError):
    """The body has an unsupported media type or coding."""


class SlowBodyError(InvalidArgumentError):
    """The body does not arrive in time."""


class DamagedDatasetsError(DatasetError):
    """Data sets exist and cannot be used.

    Parameters
    ----------
    damaged : mapping of str to str
        What is wrong, by name.
    """

    def __init__(self, damaged: Mapping[str, str]) -> None:
        super().__init__(damaged)
        self.damaged = dict(sorted(damaged.items()))


class InvalidQueryError(Exception):
    """Parameters that are missing, unknown or no values of their types, and others that are out of range.

    Parameters
    ----------
    validation : ValidationError
        Of pydantic.
    out_of_range : list of InvalidArgumentError
        The others.
    """

    def __init__(self, validation: ValidationError, out_of_range: list[InvalidArgumentError]) -> None:
        super().__init__(validation, out_of_range)
        self.validation = validation
        self.out_of_range = out_of_range


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
    InvalidQueryError: HTTPStatus.UNPROCESSABLE_ENTITY,
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


MAX_ERRORS = 20
"""Parameters that an error names at most."""


class InvalidParameter(BaseModel):
    """A parameter that is missing or wrong."""

    name: str = Field(description="which parameter")
    value: float | str | None = Field(None, description="what it was")
    allowed: str = Field(description="what is allowed")


class Problem(BaseModel):
    """RFC 9457, with the three parts of every error message."""

    type: str = Field("about:blank", description="always about:blank: the title says what the status means")
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
    int(status): {"description": HTTPStatus(status).phrase, "content": {MEDIA_TYPE: {"schema": schema}}}
    for schema in [{"$ref": "#/components/schemas/Problem"}]
    for status in (400, 404, 405, 408, 413, 415, 422, 500, 503, 504)
}
"""For the OpenAPI description: error responses of any route."""


def problem_response(status: int, detail: str, headers: dict[str, str] | None = None, **parts: Any) -> Response:
    """An error response."""
    value = _plain(parts.pop("value", None))
    errors = parts.pop("errors", None)
    texts = {name: text[:MAX_TEXT] for name, text in {"detail": detail, **parts}.items() if text is not None}
    content = Problem(title=HTTPStatus(status).phrase, status=status, value=value, errors=errors, **texts)
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
    refusals = _refusals(error)
    if refusals:
        first, *others = refusals
        parts: dict[str, Any] = {"parameter": first.name, "value": first.value, "allowed": first.allowed}
        if not others:
            return problem_response(status, first.detail, headers, **parts)
        named = refusals[:MAX_ERRORS]
        detail = f"{len(refusals)} parameters are missing or wrong: " + "; ".join(one.detail for one in named)
        return problem_response(status, detail, headers, **parts, errors=[one.parameter for one in named])
    if isinstance(error, DamagedDatasetsError):
        datasets = [
            InvalidParameter(name=name[:MAX_TEXT], value=text[:MAX_TEXT], allowed="an intact data set")
            for name, text in [*error.damaged.items()][:MAX_ERRORS]
        ]
        detail = f"{len(error.damaged)} data sets are damaged: " + "; ".join(error.damaged)
        return problem_response(status, detail, headers, errors=datasets)
    if isinstance(error, UnknownDatasetError):
        allowed = "a name that /v1/datasets lists"
        detail = f"there is no data set `{error.args[0]}`"
        return problem_response(status, detail, parameter="name", value=error.args[0], allowed=allowed)
    return problem_response(status, str(error), headers)


@dataclass(frozen=True)
class _Refusal:
    """One parameter that is missing or wrong: a sentence, and its parts."""

    detail: str
    name: str
    value: Any
    allowed: str

    @property
    def parameter(self) -> InvalidParameter:
        return InvalidParameter(name=self.name[:MAX_TEXT], value=_plain(self.value), allowed=self.allowed[:MAX_TEXT])


def _refusals(error: Exception) -> list[_Refusal]:
    """The parameters that an error names, each once, in its order; empty if it is not about parameters."""
    if isinstance(error, InvalidQueryError):
        found = _of_model(error.validation, "query") + [one for own in error.out_of_range for one in _refusals(own)]
    elif isinstance(error, SeveralArgumentsError):
        found = [one for own in error.errors for one in _refusals(own)]
    elif isinstance(error, InvalidArgumentError):
        found = [_Refusal(str(error), error.parameter, error.value, error.allowed)]
    elif isinstance(error, RequestValidationError):
        found = [_of_validation(one, str(one["loc"][0])) for one in error.errors()]
    elif isinstance(error, ValidationError):
        found = _of_model(error, "body")
    else:
        found = []
    once: dict[str, _Refusal] = {}
    for one in found:  # alternatives of one parameter give an error each
        once.setdefault(one.name, one)
    return [*once.values()]


def _of_model(error: ValidationError, source: str) -> list[_Refusal]:
    """The errors of a parameter model that was read from `source`."""
    names = _names().get(error.title, [])
    return [_of_validation(one, source, names) for one in error.errors(include_url=False)]


def _of_validation(
    error: pydantic_core.ErrorDetails | dict[str, Any], source: str, names: Iterable[str] = ()
) -> _Refusal:
    """An error of pydantic; `names` are the parameters that are expected in `source`: the query, the body, the path."""
    kind, context = str(error["type"]), error.get("ctx", {})
    place = [part for part in error["loc"] if part not in ("query", "body", "path")]
    where = [str(part) for part in place]
    name = where[0] if where else "body"  # the rest is the position in an array
    if len(place) > 2 and isinstance(place[1], int):  # in an array of objects
        name = f"{name}[{place[1]}].{place[2]}"
    if where[:2] == ["pulse", "samples"]:  # the second is the tag of the alternative
        name = "pulse" + "".join(f"[{part}]" if isinstance(part, int) else f".{part}" for part in place[2:])
        own = context.get("error")
        if isinstance(own, InvalidArgumentError):
            name += f".{own.parameter}" + "".join(f"[{index}]" for index in own.index)
            return _Refusal(str(InvalidArgumentError(name, own.value, own.allowed)), name, own.value, own.allowed)
    if kind == "missing":
        return _Refusal(f"`{name}` is missing in the {source}", name, None, f"required in the {source}")
    if kind == "extra_forbidden":
        known = "one of " + ", ".join(names) if names and len(place) == 1 else "see /docs"
        known += f", in the {source}"
        return _Refusal(
            f"there is no parameter `{name}` in the {source}; allowed: {known}", name, error["input"], known
        )
    if kind == "literal_error":
        allowed = f"one of {context['expected']}"
    elif kind.startswith("float"):
        allowed = "a number" + next((_units()[part] for part in reversed(where) if part in _units()), "")
    elif kind.startswith("int"):
        allowed = "an integer"
    else:
        allowed = str(error["msg"])
    text = str(InvalidArgumentError(name, _plain(error["input"]), allowed))
    return _Refusal(text, name, error["input"], allowed)


@cache
def _units() -> dict[str, str]:
    """The units of the parameters of all routes, such as ` [m]`, which their descriptions state."""
    found = {}
    for kind in _models(Params):
        for name, field in kind.model_fields.items():
            unit = re.search(r" \[[^\]]+\]", field.description or "")
            if unit and unit[0] != " [-]":
                found[name] = unit[0]
    return found


@cache
def _names() -> dict[str, list[str]]:
    """The names of the parameters of each model."""
    return {kind.__name__: list(kind.model_fields) for kind in _models(Params)}


def _models(kind: type[Params]) -> Iterator[type[Params]]:
    for own in kind.__subclasses__():
        yield own
        yield from _models(own)


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
