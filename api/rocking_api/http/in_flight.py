"""Bytes that the service holds for its clients: bodies that arrive, answers not yet read. Their sum is limited.

A client that sends or reads slowly makes the service keep what it has sent, or has yet to read. Beyond the limit
requests are answered 503, and may come again. The limits of time are those of the connection, see `guard`.
"""

from __future__ import annotations

import threading

from fastapi import Request
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from rocking_api.execution.executor import BusyError
from rocking_api.http.problems import answer_problem

PIECE = 128 * 1024
"""Bytes of an answer that are handed to the connection at once, which waits until the client has read most of them."""


class InFlight:
    """Counts the bytes of all requests.

    Parameters
    ----------
    limit : int
        Most bytes held for all requests together, unless one request alone holds more.
    """

    def __init__(self, limit: int) -> None:
        self.limit = limit
        self.held = 0
        self.lock = threading.Lock()


class Holding:
    """Counts the bytes of one request; its methods may be called from any thread.

    Parameters
    ----------
    in_flight : InFlight
        Of the service.
    """

    def __init__(self, in_flight: InFlight) -> None:
        self._in_flight = in_flight
        self._own = 0
        self._released = False

    def replace(self, count: int) -> None:
        """Count this many bytes in place of all that were counted before.

        Raises
        ------
        BusyError
            If they are more than before, and others hold so many that these would exceed the limit.
        """
        total = self._in_flight
        with total.lock:
            if self._released:
                return  # nobody waits for the answer any more
            others = total.held - self._own
            if count > self._own and others and others + count > total.limit:
                raise BusyError(f"bodies and answers of {total.limit} bytes are on their way; ask again in a moment")
            total.held = others + count
            self._own = count

    def add(self, count: int) -> None:
        """Count bytes more.

        Raises
        ------
        BusyError
            If others hold so many that these would exceed the limit.
        """
        self.replace(self._own + count)

    def release(self) -> None:
        """The request is over."""
        with self._in_flight.lock:
            self._in_flight.held -= self._own
            self._own = 0
            self._released = True


def holding_of(request: Request) -> Holding:
    """What the request holds."""
    found: Holding = request.state.holding
    return found


class InFlightLayer:
    """Counts answers while they are sent, and sends large ones in pieces.

    Parameters
    ----------
    app : ASGI application
        What is inside.
    in_flight : InFlight
        Of the service.
    """

    def __init__(self, app: ASGIApp, in_flight: InFlight) -> None:
        self._app = app
        self._in_flight = in_flight

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        holding = Holding(self._in_flight)
        scope.setdefault("state", {})["holding"] = holding
        start: Message | None = None
        refused = False

        async def piecewise(message: Message) -> None:
            """The head waits for the first bytes, since an answer that is too much is replaced by another."""
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
                    if len(body) > PIECE:
                        holding.add(len(body))
                except BusyError as error:
                    refused = True
                    await (await answer_problem(Request(scope), error))(scope, receive, send)
                    return
                await send(head)
            while len(body) > PIECE:
                await send({"type": "http.response.body", "body": bytes(body[:PIECE]), "more_body": True})
                body = memoryview(body)[PIECE:]
            await send({**message, "body": bytes(body)})

        try:
            await self._app(scope, receive, piecewise)
        finally:
            holding.release()
