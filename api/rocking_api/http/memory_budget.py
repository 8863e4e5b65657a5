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
    """Bytes held for all requests.

    Parameters
    ----------
    limit : int
        Most bytes for all requests together, unless a single request holds more.
    """

    def __init__(self, limit: int) -> None:
        self.limit = limit
        self.held = 0


class Reservation:
    """Bytes held for one request; its methods are called by the event loop only.

    Parameters
    ----------
    budget : MemoryBudget
        Of the service.
    """

    def __init__(self, budget: MemoryBudget) -> None:
        self._budget = budget
        self._own = 0

    def replace(self, count: int) -> None:
        """Set the number of bytes; 0 at the end of the request.

        Raises
        ------
        BusyError
            If it grows, and exceeds the limit together with the bytes of other requests.
        """
        budget = self._budget
        others = budget.held - self._own
        if count > self._own and others and others + count > budget.limit:
            raise BusyError(f"the limit of {budget.limit} bytes for bodies and responses is reached; retry in a moment")
        budget.held = others + count
        self._own = count

    def add(self, count: int) -> None:
        """Add bytes; as `replace`."""
        self.replace(self._own + count)


def reservation_of(request: Request) -> Reservation:
    """The reservation of a request."""
    found: Reservation = request.state.reservation
    return found


class MemoryBudgetMiddleware:
    """Counts responses while they are sent, and sends large ones in chunks.

    Parameters
    ----------
    app : ASGI application
        Inner application.
    budget : MemoryBudget
        Of the service.
    seconds : float
        Time for a client to read a chunk; then the response is given up [s].
    """

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

        async def send_in_time(message: Message) -> None:
            with anyio.move_on_after(self._seconds) as patience:
                await send(message)
            if patience.cancelled_caught:
                raise ClientDisconnect

        async def send_chunks(message: Message) -> None:
            """Hold the head until the first bytes: a response beyond the limit is replaced by an error."""
            nonlocal start, refused
            if message["type"] == "http.response.start":
                start = message
                return
            body, head = message.get("body", b""), start
            start = None
            if refused:
                return
            if head is not None:
                try:
                    if len(body) > CHUNK_BYTES:
                        reservation.add(len(body))
                except BusyError as error:
                    refused = True
                    await (await error_response(Request(scope), error))(scope, receive, send)
                    return
                await send(head)
            while len(body) > CHUNK_BYTES:
                await send_in_time({**message, "body": bytes(body[:CHUNK_BYTES]), "more_body": True})
                body = memoryview(body)[CHUNK_BYTES:]
            is_short = head is not None and len(message.get("body", b"")) <= CHUNK_BYTES
            await (send if is_short else send_in_time)({**message, "body": bytes(body)})

        try:
            await self._app(scope, receive, send_chunks)
        finally:
            reservation.replace(0)
