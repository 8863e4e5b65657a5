"""Errors as problem+json (RFC 9457): which parameter, its value, and what is allowed.

`KINDS` is the one table from exception to status code and type.
"""

from __future__ import annotations

import errno
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from http import HTTPStatus as S
from typing import Any

from fastapi import FastAPI, Request, Response
from fastapi.exceptions import RequestValidationError
from pydantic import BaseModel, Field
from starlette.exceptions import HTTPException

from rocking._base.errors import DatasetError, InvalidArgumentError, SeveralArgumentsError
from rocking._datasets.catalogue import UnknownDatasetError
from rocking._dimensional.table_reader import TooManyRowsError
from rocking_api.execution.kernels import NotReadyError
from rocking_api.execution.work import BusyError, TimeLimitError

MEDIA_TYPE = "application/problem+json"


class TooLargeError(InvalidArgumentError):
    """The request exceeds a limit of the service."""


class UnsupportedBodyError(InvalidArgumentError):
    """The body has an unsupported media type or coding."""


class DamagedDatasetsError(DatasetError):
    """Data sets exist and cannot be used: what is wrong with each, by name."""

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
        "A parameter is missing, unknown, not of its type or out of range; `errors` lists all of them.",
    ),
    TooLargeError: Kind(
        "too-large", S.REQUEST_ENTITY_TOO_LARGE, "The request exceeds a limit of the service: divide it."
    ),
    TooManyRowsError: Kind("too-many-rows", S.REQUEST_ENTITY_TOO_LARGE, "The table has too many rows: divide it."),
    UnsupportedBodyError: Kind(
        "unsupported-body", S.UNSUPPORTED_MEDIA_TYPE, "The route does not read this media type, or it is compressed."
    ),
    UnknownDatasetError: Kind("unknown-data-set", S.NOT_FOUND, "No data set has this name; /v1/datasets lists them."),
    DatasetError: Kind("damaged-data-set", S.SERVICE_UNAVAILABLE, "A data set cannot be used; it was logged."),
    BusyError: Kind("busy", S.SERVICE_UNAVAILABLE, "The queue is full: repeat it after `Retry-After`."),
    NotReadyError: Kind("not-ready", S.SERVICE_UNAVAILABLE, "The solver is being loaded: repeat after `Retry-After`."),
    TimeLimitError: Kind("time-limit", S.GATEWAY_TIMEOUT, "The work exceeds the time limit of a request: reduce it."),
}  # fmt: skip
"""Kinds of errors by exception."""

FULL = Kind("full-disk", S.SERVICE_UNAVAILABLE, "The temporary folder of the service is full: repeat it later.")

OTHERS = (
    Kind("slow-body", S.REQUEST_TIMEOUT, "The body did not arrive in time."),
    Kind("bad-request", S.BAD_REQUEST, "A header or the JSON of the body is malformed."),
    Kind("not-found", S.NOT_FOUND, "There is nothing at this address."),
    Kind("method-not-allowed", S.METHOD_NOT_ALLOWED, "The route has other methods, which `Allow` lists."),
    Kind("internal", S.INTERNAL_SERVER_ERROR, "A fault of the service, not of the request; it was logged."),
)
"""Those without an exception of their own, by their status codes."""


RETRY_AFTER: dict[type[Exception], str] = {BusyError: "2", NotReadyError: "30"}  # [s]

MAX_TEXT = 400  # characters of a value that an error repeats
MAX_DETAIL = 2000  # characters of the detail of an error, which may show the first lines of a file
MAX_NAME = 100  # characters of a name that an error repeats
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


_CONTENT = {MEDIA_TYPE: {"schema": {"$ref": "#/components/schemas/Problem"}}}

RESPONSES: dict[int | str, dict[str, Any]] = {
    422: {"model": Problem, "description": S(422).phrase},
    **{status: {"description": S(status).phrase, "content": _CONTENT} for status in (400, 413, 415, 500, 503, 504)},
}
"""For the OpenAPI description: error responses of any route."""


def problem_response(kind: Kind | int, detail: str, headers: Mapping[str, str] | None = None, **parts: Any) -> Response:
    """An error response of a kind, or of the first one of a status; `parts` are other fields of `Problem`."""
    if not isinstance(kind, Kind):
        status = kind
        named = (*OTHERS, *KINDS.values())
        kind = next((one for one in named if one.status == status), Kind("other", S(status), ""))
    content = Problem(
        type=kind.type, title=kind.status.phrase, status=kind.status, detail=_encodable(detail[:MAX_DETAIL]), **parts
    )
    return Response(content.model_dump_json(exclude_none=True), kind.status, headers, MEDIA_TYPE)


def add_handlers(app: FastAPI) -> None:
    """Register a handler for each exception of the table, and for those of FastAPI and of the system."""
    for exception in KINDS:
        app.add_exception_handler(exception, _handle_known)
    app.add_exception_handler(RequestValidationError, _handle_validation)
    app.add_exception_handler(HTTPException, _handle_http)
    app.add_exception_handler(OSError, _handle_system)
    app.add_exception_handler(Exception, _handle_unknown)


async def _handle_known(_: Request, error: Exception) -> Response:
    """The response to an exception of the table."""
    kind = next(KINDS[ancestor] for ancestor in type(error).__mro__ if ancestor in KINDS)
    retry_after = RETRY_AFTER.get(type(error))
    headers = {"Retry-After": retry_after} if retry_after else None
    if isinstance(error, DamagedDatasetsError):
        invalid = [InvalidArgumentError(name, text, "an intact data set") for name, text in error.damaged.items()]
        return _of_arguments(kind, invalid, headers, f"{len(invalid)} data sets are damaged")
    if isinstance(error, UnknownDatasetError):
        name = str(error.args[0])
        invalid = [InvalidArgumentError("name", name, "a name that /v1/datasets lists")]
        return _of_arguments(kind, invalid, headers, f"there is no data set `{name}`")
    if isinstance(error, SeveralArgumentsError):
        return _of_arguments(kind, error.errors, headers)
    if isinstance(error, InvalidArgumentError):
        return _of_arguments(kind, [error], headers)
    return problem_response(kind, str(error), headers)


async def _handle_validation(_: Request, error: Exception) -> Response:
    """The response to parameters that pydantic refused."""
    assert isinstance(error, RequestValidationError)
    details = error.errors()
    if details[0]["type"] == "json_invalid":
        return problem_response(400, f"the body is not JSON: {details[0]['ctx']['error']}")
    return _of_arguments(KINDS[InvalidArgumentError], [_of_validation(detail) for detail in details], None)


async def _handle_http(request: Request, error: Exception) -> Response:
    assert isinstance(error, HTTPException)
    detail = str(error.detail)
    if detail == S.NOT_FOUND.phrase:
        detail = f"there is nothing at {request.url.path[:MAX_TEXT]}; /docs lists the routes"
    if error.status_code == S.METHOD_NOT_ALLOWED:
        detail = f"{request.method} is not a method of this route"
    return problem_response(error.status_code, detail, error.headers)


async def _handle_system(_: Request, error: Exception) -> Response:
    """The response to an error of the system: a full disk is the state of the service, others are faults."""
    if isinstance(error, OSError) and error.errno in (errno.ENOSPC, errno.EDQUOT):
        return problem_response(FULL, "the temporary folder of the service is full; retry later", {"Retry-After": "30"})
    raise error


async def _handle_unknown(_: Request, __: Exception) -> Response:
    """The response to an internal error, without details; Starlette raises it again, and uvicorn logs it."""
    return problem_response(S.INTERNAL_SERVER_ERROR, "internal error, not caused by the request; it was logged")


def _of_arguments(
    kind: Kind, invalid: Sequence[InvalidArgumentError], headers: Mapping[str, str] | None, detail: str = ""
) -> Response:
    """A response that names each parameter once: alternatives of a type give an error each."""
    by_name: dict[str, InvalidArgumentError] = {}
    for error in invalid:
        by_name.setdefault(error.parameter, error)
    errors = [
        InvalidParameter(name=_encodable(error.parameter), value=plain(error.value), allowed=_encodable(error.allowed))
        for error in list(by_name.values())[:MAX_ERRORS]
    ]
    first = errors[0]
    if not detail:
        sentences = "; ".join(str(error) for error in list(by_name.values())[:MAX_ERRORS])
        detail = sentences if len(errors) == 1 else f"{len(by_name)} parameters are missing or wrong: {sentences}"
    listed = errors if len(errors) > 1 or kind is KINDS[DatasetError] else None
    return problem_response(
        kind, detail, headers, parameter=first.name, value=first.value, allowed=first.allowed, errors=listed
    )


def _of_validation(error: Mapping[str, Any]) -> InvalidArgumentError:
    """An error of pydantic as one of this package."""
    kind, context = str(error["type"]), error.get("ctx", {})
    source, *place = error["loc"]
    names = [part for part in place if isinstance(part, int) or _is_field(part)]
    own = context.get("error")
    name = _joined(names) or str(source)
    if isinstance(own, InvalidArgumentError):  # of a validator of this package
        if "<samples>" in place:
            name += f".{own.parameter}" + "".join(f"[{index}]" for index in own.index)
        elif name == "pulse":  # or one of its parameters
            name = own.parameter
        return InvalidArgumentError(name, own.value, own.allowed)
    value = error.get("input")
    if kind == "missing":
        return refusal(f"`{name}` is missing in the {source}", name, None, f"required in the {source}")
    if kind == "extra_forbidden":
        return refusal(f"there is no parameter `{name}` in the {source}; /docs lists them", name, value, "see /docs")
    allowed = str(error["msg"]).removeprefix("Input should be ").removeprefix("Value error, ")
    if kind == "literal_error":
        allowed = f"one of {context['expected']}"
    elif kind.startswith("float"):
        allowed = "a number"
    elif kind.startswith("int"):
        allowed = "an integer"
    return InvalidArgumentError(name, plain(value), allowed)


TYPES = {"float", "int", "str", "bool"}
"""Parts of the places of errors that name an alternative of a type, as tags such as "<json>" and models do."""


def _is_field(part: str) -> bool:
    """True if a part of the place of an error is the name of a field, not of an alternative."""
    return part.isidentifier() and part not in TYPES and not part[0].isupper()


def _joined(place: Sequence[str | int]) -> str:
    """The place of a value: names joined by dots, indices in brackets."""
    text = ""
    for part in place:
        if isinstance(part, int):
            text += f"[{part}]"
        else:
            text += f".{part}" if text else part
    return text if len(text) <= MAX_NAME else f"{text[:MAX_NAME]} ..."


def refusal(text: str, parameter: str, value: Any, allowed: str) -> InvalidArgumentError:
    """An error with a text of its own."""
    error = InvalidArgumentError(parameter, plain(value), allowed)
    error.args = (text,)
    return error


def plain(value: Any) -> float | str | None:
    """A value that JSON can represent; nan, infinite and larger numbers as text, of long texts the start."""
    is_number = isinstance(value, int | float) and not isinstance(value, bool)
    if value is None or (is_number and abs(value) <= sys.float_info.max):  # neither nan nor infinite
        number: float | None = value
        return number
    text = value[:MAX_TEXT].decode("utf-8", "backslashreplace") if isinstance(value, bytes) else str(value)
    return _encodable(text if len(text) <= MAX_TEXT else f"{text[:MAX_TEXT]} ...")


def _encodable(text: str) -> str:
    """A text that UTF-8 can encode: JSON may hold half of a pair of escapes, here as text."""
    return text.encode("utf-8", "backslashreplace").decode("utf-8")
