"""What each request passes: one Host header, a request id, metrics and common headers; no exception escapes.

The id is the client's `X-Request-ID` if it is valid, else a random one. It is sent back, and logged with the traceback
of an internal error. uvicorn writes the line of the log for each request.
"""

from __future__ import annotations

import logging
import random
import re
import time

from starlette.requests import ClientDisconnect
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from rocking_api.http.errors import NOSNIFF, internal_error, problem_response
from rocking_api.metrics import Metrics

ERRORS = logging.getLogger("rocking.service")

METHODS = {"GET", "HEAD", "POST", "PUT", "DELETE", "OPTIONS", "PATCH"}

_SANE = re.compile(rb"[A-Za-z0-9._-]{1,64}")


class RequestLog:
    """The outermost middleware.

    It refuses requests without a Host header, or with several (RFC 9112, 3.2; HTTP/1.0 needs none), and hides it from
    the routes: Starlette makes the target of a redirect from this header, which a client can choose.
    """

    def __init__(self, app: ASGIApp, metrics: Metrics) -> None:
        self._app = app
        self._metrics = metrics

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        began = time.perf_counter()
        hosts, request_id = 0, f"{random.getrandbits(64):016x}".encode()  # an id is no secret
        for name, value in scope["headers"]:
            hosts += name == b"host"
            if name == b"x-request-id" and _SANE.fullmatch(value):
                request_id = value
        scope["headers"] = [header for header in scope["headers"] if header[0] != b"host"]
        scope["server"] = None
        app = self._app if hosts == 1 or (not hosts and scope["http_version"] == "1.0") else _refusal(hosts)
        status, whole = 0, False

        async def watched(message: Message) -> None:
            nonlocal status, whole
            if message["type"] == "http.response.start":
                status = message["status"]
                message["headers"] = [*message.get("headers", ()), (b"x-request-id", request_id), NOSNIFF]
            else:
                whole = not message.get("more_body", False)
            await send(message)

        try:
            await app(scope, receive, watched)
        except ClientDisconnect:
            status = 499  # client closed the request; the usual code in logs
        except Exception:
            ERRORS.exception("error of the service, request %s, path %s", request_id.decode(), scope["path"])
            if not status:
                await internal_error()(scope, receive, watched)
            elif not whole:
                raise  # the head is sent; the server closes the connection
        finally:
            if (reservation := scope.get("state", {}).get("reservation")) is not None:
                reservation.replace(0)
            method = scope["method"] if scope["method"] in METHODS else "other"
            route = getattr(scope.get("route"), "path", "none")
            self._metrics.request(method, route, status or 500, time.perf_counter() - began)


def _refusal(hosts: int) -> ASGIApp:
    detail, value = f"the request has {hosts} headers Host; allowed: one", f"{hosts} headers"
    return problem_response(400, detail, parameter="Host", value=value, allowed="one")
