"""The parameters of a request: a query string, and a JSON body, which takes the same fields.

FastAPI describes the parameters, and pydantic validates all of them in one call. FastAPI would validate them one by one
with every request, by which a request for one block takes 1.4 times the processor time.
"""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Callable, Coroutine, Mapping
from functools import cache
from typing import Any, TypeVar, get_type_hints
from urllib.parse import parse_qsl

from fastapi import Request, Response
from fastapi.routing import APIRoute
from pydantic import TypeAdapter, ValidationError
from pydantic_core import ErrorDetails, from_json

from rocking._base.errors import InvalidArgumentError, SeveralArgumentsError, in_range
from rocking._numba.cancellation import StopFlag
from rocking_api.http.caching import revalidated
from rocking_api.http.encoding import json_response
from rocking_api.http.errors import MalformedBodyError, plain, refusal
from rocking_api.models.answer import Answer
from rocking_api.models.params import Params

P = TypeVar("P", bound=Params)

_OBJECT = TypeAdapter(dict[str, Any])

_TOKEN = re.compile(rb'[^"{}]*+(?:("[^"\\]*+(?:\\.[^"\\]*+)*+")\s*+(:)?|([{}])|\Z)', re.DOTALL)
"""The next text of JSON, with the colon after a key, or end of an object; what is before it is passed over at once."""


class ParamsRoute(APIRoute):
    """Route of an endpoint whose arguments are those of the path and any of `params`, `request` and `service`.

    `params` is a parameter model, read from the query. A response of a GET gets an ETag, and without Cache-Control may
    be stored for a minute.
    """

    def get_route_handler(self) -> Callable[[Request], Coroutine[Any, Any, Response]]:
        endpoint, wanted = self.endpoint, get_type_hints(self.endpoint)
        shared = "GET" in (self.methods or ())

        async def handle(request: Request) -> Response:
            arguments = dict(request.path_params)
            if "params" in wanted:
                arguments["params"] = read_query(wanted["params"], query_parameters(request))
            elif shared and request.scope["query_string"]:
                read_query(Params, query_parameters(request))  # refuses all
            if "request" in wanted:
                arguments["request"] = request
            if "service" in wanted:
                arguments["service"] = request.app.state.service
            result = await endpoint(**arguments)
            response = json_response(result, request) if isinstance(result, Answer) else result
            response = revalidated(request, response) if shared else response
            if getattr(request.state, "negotiated", False):
                response.headers.add_vary_header("Accept")
            return response

        return handle


def query_parameters(request: Request) -> dict[str, str]:
    """The query parameters."""
    given = parse_qsl(request.scope["query_string"].decode("latin-1"), keep_blank_values=True)
    parameters = dict(given)
    if len(parameters) < len(given):
        twice = next(name for name, count in Counter(name for name, _ in given).items() if count > 1)
        values = [value for name, value in given if name == twice]
        raise InvalidArgumentError(twice, " and ".join(values), "one value")
    return parameters


def read_query(kind: type[P], query: Mapping[str, str]) -> P:
    """The parameters in a query."""
    try:
        return kind.model_validate_strings(query)
    except ValidationError as error:
        raise SeveralArgumentsError(_named(error, "query", kind)) from None


def check_json(body: bytes, stop: StopFlag) -> None:
    """Refuse a body that is not JSON, or whose objects have a key twice."""
    try:
        from_json(body, cache_strings="none")
    except ValueError as error:
        raise MalformedBodyError("body", str(error), "JSON (RFC 8259)") from None
    reject_repeated_keys(body, stop)


def reject_repeated_keys(body: bytes, stop: StopFlag) -> None:
    """Refuse JSON with an object that has two values of one key, of which parsers take the last one in silence."""
    objects: list[set[bytes]] = []
    for token in _TOKEN.finditer(body):
        text, colon, end = token.groups()
        if end == b"{":
            stop.check()
            objects.append(set())
        elif end:
            objects.pop()
        elif colon:
            key = from_json(text).encode() if b"\\" in text else text[1:-1]
            if key in objects[-1]:
                line = body.count(b"\n", 0, token.start(1)) + 1
                raise InvalidArgumentError(key.decode(), f"two values, the second in line {line}", "one value")
            objects[-1].add(key)


def read_json(kind: type[P], body: bytes, query: Mapping[str, str], options: type[Params], stop: StopFlag) -> P:
    """The parameters in a JSON body, and those of `options` that are in the query."""
    for name, value in query.items():
        if name not in options.model_fields:
            raise InvalidArgumentError(name, value, f"one of {', '.join(options.model_fields)}, in the query")
    given: dict[str, Any] = {}
    try:
        if query:
            given = _OBJECT.validate_json(body)
            found = kind.model_validate({**query, **given})  # pydantic takes texts for numbers
            twice = kind.model_validate({**given, **query}) if given.keys() & query.keys() else found
        else:
            found = twice = kind.model_validate_json(body)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        if first["type"] == "json_invalid":
            raise MalformedBodyError("body", first["ctx"]["error"], "JSON (RFC 8259)") from None
        raise SeveralArgumentsError(_named(error, "body", kind)) from None
    reject_repeated_keys(body, stop)
    for name in [name for name in query if name in given]:
        if getattr(found, name) != getattr(twice, name):
            raise InvalidArgumentError(name, f"{query[name]} in the query and {given[name]} in the body", "one value")
    return found


def _named(error: ValidationError, source: str, kind: type[Params]) -> list[InvalidArgumentError]:
    """The parameters of a model that pydantic found missing or wrong in `source`: the query, or the body."""
    return [_of_validation(one, source, kind) for one in error.errors(include_url=False)]


def _of_validation(error: ErrorDetails, source: str, model: type[Params]) -> InvalidArgumentError:
    """An error of pydantic; the fields of the model are the parameters that are expected in `source`."""
    names = model.model_fields
    kind, context = str(error["type"]), error.get("ctx", {})
    place = error["loc"]
    where = [str(part) for part in place]
    name = where[0] if where else "body"  # the rest is the position in an array
    if len(place) > 2 and isinstance(place[1], int):  # in an array of objects
        name = f"{name}[{place[1]}].{place[2]}"
    own = context.get("error")
    if where[:2] == ["pulse", "samples"]:  # the second is the tag of the alternative
        name = "pulse" + "".join(f"[{part}]" if isinstance(part, int) else f".{part}" for part in place[2:])
        if isinstance(own, InvalidArgumentError):
            name += f".{own.parameter}" + "".join(f"[{index}]" for index in own.index)
            return InvalidArgumentError(name, own.value, own.allowed)
    if isinstance(own, InvalidArgumentError) and name == "pulse":  # or one of its parameters
        return own
    if isinstance(own, InvalidArgumentError):  # of a quantity
        return InvalidArgumentError(name, own.value, own.allowed)
    if kind in _RANGES and name in names:
        index = tuple(part for part in place[1:] if isinstance(part, int))
        value = error["input"]  # an integer may exceed all floats
        return _out_of_range(model, name, value if isinstance(value, int) else float(value), index)
    if kind == "missing":
        return refusal(f"`{name}` is missing in the {source}", name, None, f"required in the {source}")
    if kind == "extra_forbidden":
        known = ("one of " + ", ".join(names) if names else "none") if len(place) == 1 else "see /docs"
        known += f", in the {source}"
        detail = f"there is no parameter `{name}` in the {source}; allowed: {known}"
        return refusal(detail, name, plain(error["input"]), known)
    allowed = str(error["msg"]).removeprefix("Input should be ")
    if kind == "literal_error":
        allowed = f"one of {context['expected']}"
    elif kind.startswith("float"):
        allowed = "a number" + next((_units()[part] for part in reversed(where) if part in _units()), "")
    elif kind.startswith("int"):
        allowed = "an integer"
    return InvalidArgumentError(name, plain(error["input"]), allowed)


_RANGES = {"greater_than", "greater_than_equal", "less_than", "less_than_equal", "finite_number"}


def _out_of_range(model: type[Params], name: str, value: float, index: tuple[int, ...]) -> InvalidArgumentError:
    """The error of `in_range` for the range that the schema of a field states."""
    schema = model.model_json_schema()["properties"][name]
    ends = next(one for one in (schema, *schema.get("anyOf", ())) if "minimum" in one or "exclusiveMinimum" in one)
    low, high = ends.get("minimum", ends.get("exclusiveMinimum")), ends.get("maximum", math.inf)
    unit = re.search(r"\[([^]]+)\]", schema.get("description", ""))
    try:
        in_range(name, value, low, high, closed="both" if "minimum" in ends else "right", unit=unit[1] if unit else "-")
    except InvalidArgumentError as error:
        return InvalidArgumentError(name, error.value, error.allowed, index)
    raise ValueError(f"{value} is in the range of {name}")


@cache
def _units() -> dict[str, str]:
    """The units of the parameters of all routes, such as ` [m]`, which their descriptions state."""
    kinds = [*Params.__subclasses__()]
    for kind in kinds:  # which grows
        kinds += kind.__subclasses__()
    fields = [one for kind in kinds for one in kind.model_fields.items()]
    return {name: unit[0] for name, one in fields if (unit := re.search(r" \[(?!-\])[^\]]+\]", one.description or ""))}
