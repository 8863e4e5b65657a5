"""Around every request: an id, a line in the log, a count, the headers of all answers; and no exception gets past.

The id is the client's `X-Request-ID` if that is sane, else a new one. It comes back with the answer and stands in the
log, where an error of the service leaves its traceback. Requests that end in the same turn of the event loop are
counted and logged one after another, which takes less time than each in its turn.
"""

from __future__ import annotations

import asyncio
import logging
import random
import re
import time
from typing import Any, NamedTuple

from starlette.requests import ClientDisconnect
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from rocking_api.http.metrics import Metrics
from rocking_api.http.problems import NOSNIFF, internal_error

ACCESS = logging.getLogger("rocking.access")
ERRORS = logging.getLogger("rocking.service")

METHODS = {"GET", "HEAD", "POST", "PUT", "DELETE", "OPTIONS", "PATCH"}

_RANDOM = random.Random()
"""Of this process; an id is no secret."""

_SANE = re.compile(rb"[A-Za-z0-9._-]{1,64}")


class Seen(NamedTuple):
    """A request that has been answered, with the bytes of the body and the time that it took."""

    scope: Scope
    request_id: str
    status: int
    sent: int
    seconds: float


class Observer:
    """The outermost of our layers.

    Parameters
    ----------
    app : ASGI application
        What is inside.
    metrics : Metrics
        Where requests are counted.
    access_log : bool
        Whether each request is a line in the log "rocking.access".
    """

    def __init__(self, app: ASGIApp, metrics: Metrics, access_log: bool) -> None:
        self._app = app
        self._metrics = metrics
        self._access_log = access_log
        self._seen: list[Seen] = []

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        began = time.perf_counter()
        request_id = _request_id(scope)
        status, sent, whole = 0, 0, False

        async def watched(message: Message) -> None:
            nonlocal status, sent, whole
            if message["type"] == "http.response.start":
                status = message["status"]
                message["headers"] = [*message.get("headers", ()), (b"x-request-id", request_id.encode()), NOSNIFF]
            else:
                sent += len(message.get("body", b""))
                whole = not message.get("more_body", False)
            await send(message)

        try:
            await self._app(scope, receive, watched)
        except ClientDisconnect:
            status = 499  # nobody reads it; the log's usual word for it
        except Exception:
            ERRORS.exception(
                "error of the service", extra={"fields": {"request_id": request_id, "path": scope["path"]}}
            )
            if not status:
                await internal_error()(scope, receive, watched)
            elif not whole:
                raise  # too late to say so; the server closes the connection
        finally:
            if not self._seen:
                asyncio.get_running_loop().call_soon(self._tell)
            self._seen.append(Seen(scope, request_id, status, sent, time.perf_counter() - began))

    def _tell(self) -> None:
        """Count and log what was answered in this turn of the event loop."""
        seen, self._seen = self._seen, []
        for one in seen:
            route = getattr(one.scope.get("route"), "path", "none")
            method = one.scope["method"] if one.scope["method"] in METHODS else "other"
            self._metrics.request(method, route, one.status or 500, one.seconds)
            if self._access_log:
                ACCESS.info("request", extra={"fields": _line(one)})


def _request_id(scope: Scope) -> str:
    for name, value in scope["headers"]:
        if name == b"x-request-id" and _SANE.fullmatch(value):
            return str(value.decode())
    return f"{_RANDOM.getrandbits(64):016x}"


def _line(seen: Seen) -> dict[str, Any]:
    scope = seen.scope
    client = scope.get("client")
    return {
        "request_id": seen.request_id,
        "client": client[0] if client else None,
        "method": scope["method"],
        "path": scope["path"],
        "query": scope["query_string"].decode("latin-1")[:1000],
        "status": seen.status,
        "bytes": seen.sent,
        "milliseconds": round(1e3 * seen.seconds, 3),
    }
