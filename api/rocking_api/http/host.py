"""The Host header: exactly one (RFC 9112, 3.2), and no response repeats it."""

from __future__ import annotations

from starlette.types import ASGIApp, Receive, Scope, Send

from rocking_api.http.errors import problem_response


class HostCheck:
    """Middleware that refuses requests without a Host header, or with several, and hides the host from the routes.

    Starlette makes the target of a redirect from the Host header, which a client can choose; without it and without the
    address of the server the target is a path. A request of HTTP/1.0 needs no Host.
    """

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] == "http":
            hosts = [value for name, value in scope["headers"] if name == b"host"]
            if len(hosts) > 1 or (not hosts and scope["http_version"] != "1.0"):
                detail = f"the request has {len(hosts)} headers Host; allowed: one"
                value = f"{len(hosts)} headers"
                refused = problem_response(400, detail, parameter="Host", value=value, allowed="one")
                await refused(scope, receive, send)
                return
            scope["headers"] = [header for header in scope["headers"] if header[0] != b"host"]
            scope["server"] = None
        await self._app(scope, receive, send)
