"""A short way to the routes whose answer costs less than the way through the framework.

Routing, compression and the stacks for dependencies take longer than the answer about one block does. A request for
exactly the path of such a route goes straight to its handler; what goes wrong there is answered by the same table.
All else, other methods of that path among them, takes the usual way.
"""

from __future__ import annotations

from collections.abc import Iterable

from fastapi import Request
from starlette.types import ASGIApp, Receive, Scope, Send

from rocking_api.http.params_route import QuestionRoute
from rocking_api.http.problems import STATUS, answer_problem

KNOWN = tuple(STATUS)


class ShortWay:
    """Stands before the framework.

    Parameters
    ----------
    app : ASGI application
        The usual way.
    routes : routes
        Those to be reached by the short way if asked by GET; their answers are too short to be compressed.
    """

    def __init__(self, app: ASGIApp, routes: Iterable[QuestionRoute]) -> None:
        self._app = app
        self._routes = {
            route.path: (route, route.get_route_handler()) for route in routes if "GET" in (route.methods or ())
        }

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        found = self._routes.get(scope["path"]) if scope.get("method") == "GET" else None
        if found is None:
            await self._app(scope, receive, send)
            return
        scope["route"], handle = found  # the observer counts by route
        request = Request(scope, receive)
        try:
            response = await handle(request)
        except KNOWN as error:
            response = await answer_problem(request, error)
        await response(scope, receive, send)
