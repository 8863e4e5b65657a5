"""Limit of the memory held for clients: bodies that arrive, batches, responses that are not yet read.

A client that sends or reads slowly makes the service hold its data. Beyond the limit requests are answered 503 and may
be repeated. Time limits are those of the connection.
"""

from __future__ import annotations

import threading

from fastapi import Request
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
        self.lock = threading.Lock()


class Reservation:
    """Bytes held for one request; its methods may be called from any thread.

    Parameters
    ----------
    budget : MemoryBudget
        Of the service.
    """

    def __init__(self, budget: MemoryBudget) -> None:
        self._budget = budget
        self._own = 0
        self._released = False

    def replace(self, count: int) -> None:
        """Set the number of bytes.

        Raises
        ------
        BusyError
            If it grows, and exceeds the limit together with the bytes of other requests.
        """
        budget = self._budget
        with budget.lock:
            if self._released:
                return  # the request is over
            others = budget.held - self._own
            if count > self._own and others and others + count > budget.limit:
                raise BusyError(
                    f"the limit of {budget.limit} bytes for bodies and responses is reached; retry in a moment"
                )
            budget.held = others + count
            self._own = count

    def add(self, count: int) -> None:
        """Add bytes.

        Raises
        ------
        BusyError
            If they exceed the limit together with the bytes of other requests.
        """
        self.replace(self._own + count)

    def release(self) -> None:
        """Release all bytes: the request is over."""
        with self._budget.lock:
            self._budget.held -= self._own
            self._own = 0
            self._released = True


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
    """

    def __init__(self, app: ASGIApp, budget: MemoryBudget) -> None:
        self._app = app
        self._budget = budget

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
                await send({"type": "http.response.body", "body": bytes(body[:CHUNK_BYTES]), "more_body": True})
                body = memoryview(body)[CHUNK_BYTES:]
            await send({**message, "body": bytes(body)})

        try:
            await self._app(scope, receive, send_chunks)
        finally:
            reservation.release()
