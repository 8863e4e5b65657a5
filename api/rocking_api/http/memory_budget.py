"""Limit of the memory held for clients: bodies that arrive, batches, responses that are not yet read.

A client that sends or reads slowly makes the service hold its data. Beyond the limit requests are answered 503 and may
be repeated.
"""

from __future__ import annotations

import anyio
from fastapi import Request
from starlette.requests import ClientDisconnect
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from rocking_api.execution.executor import BusyError
from rocking_api.http.errors import error_response

CHUNK_BYTES = 128 * 1024
"""Bytes of a response that are passed to the connection at once; it waits until the client has read most of them."""


class MemoryBudget:
    """Bytes held for all requests, at most `limit` unless a single request holds more."""

    def __init__(self, limit: int) -> None:
        self.limit = limit
        self.held = 0


class Reservation:
    """Bytes held for one request, in `request.state.reservation`; its methods are called by the event loop only."""

    def __init__(self, budget: MemoryBudget) -> None:
        self._budget = budget
        self.held = 0

    def replace(self, count: int) -> None:
        """Set the number of bytes; 0 at the end of the request.

        Raises
        ------
        BusyError
            If it grows, and exceeds the limit together with the bytes of other requests.
        """
        budget = self._budget
        others = budget.held - self.held
        if count > self.held and others and others + count > budget.limit:
            raise BusyError(f"the limit of {budget.limit} bytes for bodies and responses is reached; retry in a moment")
        budget.held = others + count
        self.held = count

    def add(self, count: int) -> None:
        """Add bytes; as `replace`."""
        self.replace(self.held + count)


class MemoryBudgetMiddleware:
    """Counts responses while they are sent, and sends large ones in chunks; gives up after `seconds` for a chunk."""

    def __init__(self, app: ASGIApp, budget: MemoryBudget, seconds: float) -> None:
        self._app = app
        self._budget = budget
        self._seconds = seconds

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        reservation = Reservation(self._budget)
        scope.setdefault("state", {})["reservation"] = reservation
        start: Message | None = None
        refused = False

        async def send_chunks(message: Message) -> None:
            """Hold the head until the first bytes: a response beyond the limit is replaced by an error."""
            nonlocal start, refused
            if message["type"] == "http.response.start":
                start = message
                return
            if refused:
                return
            body, more, head = message.get("body", b""), message.get("more_body", False), start
            if head is not None:
                start = None
                if len(body) > CHUNK_BYTES:
                    try:
                        reservation.add(len(body))
                    except BusyError as error:
                        refused = True
                        await (await error_response(Request(scope), error))(scope, receive, send)
                        return
                await send(head)
                if len(body) <= CHUNK_BYTES:
                    await send(message)
                    return
            for first in range(0, max(len(body), 1), CHUNK_BYTES):
                part, last = bytes(memoryview(body)[first : first + CHUNK_BYTES]), first + CHUNK_BYTES >= len(body)
                with anyio.move_on_after(self._seconds) as patience:
                    await send({"type": message["type"], "body": part, "more_body": more or not last})
                if patience.cancelled_caught:
                    raise ClientDisconnect

        try:
            await self._app(scope, receive, send_chunks)
        finally:
            reservation.replace(0)
