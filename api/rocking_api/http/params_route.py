"""A route that reads its question from the URL at one go.

FastAPI's own reading of a query model looks at every field anew for every request, which takes longer than the solver
does. Here pydantic reads all of them at once. What routes declare stays FastAPI's, and so does their description; and
a parameter that is given twice is refused, since there is no telling which of the two was meant.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Coroutine
from typing import Any, get_type_hints
from urllib.parse import parse_qsl

from fastapi import Request, Response
from fastapi.routing import APIRoute
from pydantic import BaseModel

from rocking.errors import InvalidArgumentError
from rocking_api.http.caching import revalidated
from rocking_api.http.formats import json_response
from rocking_api.models.params import Question
from rocking_api.service import Service

Handler = Callable[[Request], Coroutine[Any, Any, Response]]


class QuestionRoute(APIRoute):
    """For endpoints whose parameters are a question, the request and the service, or some of these."""

    def get_route_handler(self) -> Handler:
        hints = get_type_hints(self.endpoint)
        kinds = {name: hints[name] for name in inspect.signature(self.endpoint).parameters}
        readers = {name: _reader(kind) for name, kind in kinds.items()}
        endpoint = self.endpoint
        shared = "GET" in (self.methods or ())

        async def handle(request: Request) -> Response:
            answer = await endpoint(**{name: read(request) for name, read in readers.items()})
            response = json_response(answer) if isinstance(answer, BaseModel) else answer
            return revalidated(request, response) if shared else response

        return handle


def _reader(kind: Any) -> Callable[[Request], Any]:
    """How an argument of this type is taken from a request."""
    if kind is Request:
        return lambda request: request
    if kind is Service:
        return lambda request: request.app.state.service
    if issubclass(kind, Question):
        return lambda request: kind.model_validate_strings(single_parameters(request))
    raise TypeError(f"an endpoint of a QuestionRoute takes no {kind}")


def single_parameters(request: Request) -> dict[str, str]:
    """The parameters of the URL.

    Raises
    ------
    InvalidArgumentError
        If one is given more than once.
    """
    given = parse_qsl(request.scope["query_string"].decode("latin-1"), keep_blank_values=True)
    parameters = dict(given)
    if len(parameters) < len(given):
        for name in parameters:
            values = [value for key, value in given if key == name]
            if len(values) > 1:
                raise InvalidArgumentError(name, " and ".join(values), "one value")
    return parameters
