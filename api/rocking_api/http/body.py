"""Bodies of requests: their format, and their arrival within limits of size, time and memory."""

from __future__ import annotations

import io
from collections.abc import Sequence

import anyio
import anyio.lowlevel
from fastapi import Request

from rocking_api.execution.executor import BusyError
from rocking_api.http.encoding import MEDIA_TYPES, Form
from rocking_api.http.errors import SlowBodyError, TooLargeError, UnsupportedBodyError

TURN_BYTES = 64 * 1024
"""Bytes of a body that arrive without waiting for other bodies.

With 64 connections that are read in one iteration of the event loop, 16 MB of bodies pass between two steps of any
other request, and `/health` took 1.4 to 2.7 s.
"""


class MemoryBudget:
    """Bytes of the requests whose bodies arrive or are worked on, at most `limit` unless a single one holds more.

    Without it 64 clients that send bodies of 64 MB at the same time make the service hold 4 GB.
    """

    def __init__(self, limit: int) -> None:
        self.limit = limit
        self.held = 0


class Reservation:
    """Bytes held for one request, in `request.state.reservation`; its methods are called by the event loop only."""

    def __init__(self, budget: MemoryBudget) -> None:
        self._budget = budget
        self.held = 0

    def replace(self, count: int) -> None:
        """Set the number of bytes; `RequestLog` sets 0 at the end of the request."""
        budget = self._budget
        others = budget.held - self.held
        if count > self.held and others and others + count > budget.limit:
            raise BusyError(f"the limit of {budget.limit} bytes for bodies is reached; retry in a moment")
        budget.held = others + count
        self.held = count


def body_form(request: Request, accepted: Sequence[Form]) -> Form:
    """Format of the body by its Content-Type; JSON without one."""
    declared = request.headers.get("content-type", MEDIA_TYPES["json"]).split(";")[0].strip().lower()
    for form in accepted:
        if declared in (MEDIA_TYPES[form], "application/netcdf" if form == "nc" else MEDIA_TYPES[form]):
            return form
    types = ", ".join(MEDIA_TYPES[form] for form in accepted)
    raise UnsupportedBodyError("Content-Type", declared, f"one of {types}")


async def limited_body(
    request: Request, allowed: tuple[int, str], seconds: float, reservation: Reservation, turns: anyio.Lock
) -> bytes:
    """The body, of at most as many bytes as `allowed` says, within `seconds`; its bytes are counted in `reservation`.

    Beyond `TURN_BYTES` bodies arrive in turns: one connection is read in each iteration of the event loop. A body that
    exceeds the bytes in flight is read to its end and dropped, also in turns, before it is refused.
    """
    limit, meaning = allowed
    coding = request.headers.get("content-encoding", "identity")
    if coding != "identity":
        raise UnsupportedBodyError("Content-Encoding", coding, "none: bodies are not compressed")
    declared = request.headers.get("content-length", "")
    if declared.isdecimal() and int(declared[:20]) > limit:  # more digits exceed any limit
        raise TooLargeError("body", declared[:20], meaning)
    body = io.BytesIO()  # getvalue() does not copy
    size, refusal = 0, None
    with anyio.move_on_after(seconds) as time_limit:
        async for chunk in request.stream():
            size += len(chunk)
            if size > limit:
                raise TooLargeError("body", size, meaning)
            if refusal is None:
                try:
                    reservation.replace(reservation.held + len(chunk))
                    body.write(chunk)
                except BusyError as error:
                    refusal, body = error, io.BytesIO()
                    reservation.replace(0)
            if size > TURN_BYTES:  # no more of it is read before the next request for a chunk
                async with turns:
                    await anyio.lowlevel.checkpoint()
    if refusal is not None:
        raise refusal
    if time_limit.cancelled_caught:
        raise SlowBodyError("body", f"{size} bytes", f"all of it within {seconds:g} s")
    return body.getvalue()
