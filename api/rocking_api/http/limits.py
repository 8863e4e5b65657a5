"""What each request passes first: limits of its body, HEAD answered as GET, headers against named attacks."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import anyio
from anyio import CapacityLimiter
from fastapi import Response
from starlette.datastructures import Headers
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from rocking_api.http.errors import problem_response

LARGE_BODY = 1_000_000  # bytes beyond which bodies are taken a few at a time

LARGE_BODIES = 4
"""Large bodies in the service at a time: with 64 clients that send 64 MB each it would hold 4 GB."""

NOSNIFF = (b"x-content-type-options", b"nosniff")  # of every response: no content sniffing by browsers


class Limit(NamedTuple):
    """Largest body of a route [bytes]: of JSON, which is parsed while nothing else is answered, and of files."""

    json: int
    file: int


class RequestLimits:
    """The outermost middleware.

    Bodies are read here within their limits of size and time, so that a route meets whole ones. The header Host is
    hidden from the routes: Starlette makes the target of a redirect from it, and a client can choose it.
    """

    def __init__(self, app: ASGIApp, limits: Mapping[str, Limit], default: Limit, seconds: float) -> None:
        self._app = app
        self._limits = limits
        self._default = default
        self._seconds = seconds
        self._large = CapacityLimiter(LARGE_BODIES)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        inner = {**scope, "server": None, "headers": [pair for pair in scope["headers"] if pair[0] != b"host"]}
        if scope["method"] == "HEAD":  # the server leaves out the body
            inner["method"] = "GET"

        async def marked(message: Message) -> None:
            if message["type"] == "http.response.start":
                message["headers"] = [*message.get("headers", ()), NOSNIFF]
            await send(message)

        if scope["method"] == "POST":
            await self._with_body(inner, receive, marked)
        else:
            await self._app(inner, receive, marked)

    async def _with_body(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Call the application with the body of a request, or answer in its place."""
        headers = Headers(scope=scope)
        coding = headers.get("content-encoding", "identity")
        if coding != "identity":
            detail = f"`Content-Encoding` = {coding!r} is not allowed; allowed: none: bodies are not compressed"
            await problem_response(415, detail, parameter="Content-Encoding", value=coding, allowed="none")(
                scope, receive, send
            )
            return
        declared = headers.get("content-length", "")
        is_small = declared.isdecimal() and len(declared) < 10 and int(declared) <= LARGE_BODY
        with anyio.move_on_after(self._seconds) as waiting:
            if not is_small:
                await self._large.acquire()
        if waiting.cancelled_caught:
            refusal = problem_response(503, "other large bodies arrive; retry in a moment", {"Retry-After": "2"})
            await refusal(scope, receive, send)
            return
        try:
            found = await self._body(scope, headers, receive)
            if isinstance(found, Response):
                await found(scope, receive, send)
            else:
                await self._app(scope, _replayed(found, receive), send)
        finally:
            if not is_small:
                self._large.release()

    async def _body(self, scope: Scope, headers: Headers, receive: Receive) -> bytes | Response:
        """The body, or the refusal of one that is too large or too slow."""
        limit = self._limit(scope["path"], headers.get("content-type", ""))
        declared = headers.get("content-length", "")
        too_large = f"`body` is too large; allowed: at most {limit} bytes"
        if declared.isdecimal() and int(declared[:20]) > limit:
            return problem_response(413, too_large, parameter="body", value=declared[:20], allowed=f"{limit} bytes")
        body = bytearray()
        with anyio.move_on_after(self._seconds) as arriving:
            more = True
            while more:
                message = await receive()
                if message["type"] == "http.disconnect":
                    return Response(status_code=499)  # nobody reads it; the usual code in logs
                body += message.get("body", b"")
                more = message.get("more_body", False)
                if len(body) > limit:
                    return problem_response(413, too_large, parameter="body", value=len(body), allowed=f"{limit} bytes")
        if arriving.cancelled_caught:
            detail = f"only {len(body)} bytes of the body arrived within {self._seconds:g} s"
            return problem_response(408, detail, {"Connection": "close"}, parameter="body", allowed="a faster client")
        return bytes(body)

    def _limit(self, path: str, content_type: str) -> int:
        """The largest body of a path and a media type [bytes]."""
        prefix = next((prefix for prefix in self._limits if path.startswith(prefix)), None)
        limit = self._default if prefix is None else self._limits[prefix]
        return limit.json if "json" in content_type.lower() else limit.file


def _replayed(body: bytes, receive: Receive) -> Receive:
    """A channel that gives the body that was read, then what follows it."""
    messages: list[Message] = [{"type": "http.request", "body": body, "more_body": False}]

    async def replay() -> Message:
        return messages.pop() if messages else await receive()

    return replay
