"""A connection that does not get to the point is closed: headers that are too long, or too slow to arrive.

uvicorn waits for the headers of a request for ever, and keeps all of them; a few hundred idle connections with half a
header each would be enough to shut everybody else out. The body is bounded where it is read, see `batch`.
"""

from __future__ import annotations

import asyncio
from http import HTTPStatus
from typing import Any, cast

from uvicorn.protocols.http.httptools_impl import HttpToolsProtocol

from api.one_write import OneWrite
from api.problems import problem


def guarded(seconds: float, header_bytes: int) -> type[HttpToolsProtocol]:
    """uvicorn's protocol with an end to its patience.

    Parameters
    ----------
    seconds : float
        What the headers of a request may take to arrive [s], and an idle connection to ask again.
    header_bytes : int
        Largest URL and headers.
    """

    class Guarded(HttpToolsProtocol):
        """One connection."""

        _timer: asyncio.TimerHandle | None = None
        _arriving = False
        _header_bytes = 0

        def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
            super().connection_made(cast(asyncio.Transport, OneWrite(transport, self.loop)))
            self._wait()

        def connection_lost(self, exc: Exception | None) -> None:
            self._stop_waiting()
            super().connection_lost(exc)

        def data_received(self, data: bytes) -> None:
            super().data_received(data)
            if self._arriving and self._timer is None:  # headers that arrive in one piece need no timer
                self._wait()

        def on_message_begin(self) -> None:
            self._stop_waiting()
            self._arriving = True
            self._header_bytes = 0
            super().on_message_begin()

        def on_url(self, url: bytes) -> None:
            self._count(len(url))
            super().on_url(url)

        def on_header(self, name: bytes, value: bytes) -> None:
            self._count(len(name) + len(value) + 4)  # a colon, a space, the end of the line
            super().on_header(name, value)

        def on_headers_complete(self) -> None:
            self._stop_waiting()
            self._arriving = False
            super().on_headers_complete()

        def _wait(self) -> None:
            self._stop_waiting()
            self._timer = self.loop.call_later(seconds, self._refuse, HTTPStatus.REQUEST_TIMEOUT)

        def _stop_waiting(self) -> None:
            if self._timer is not None:
                self._timer.cancel()
                self._timer = None

        def _count(self, size: int) -> None:
            self._header_bytes += size
            if self._header_bytes > header_bytes:
                self._refuse(HTTPStatus.REQUEST_HEADER_FIELDS_TOO_LARGE)
                raise ValueError("headers too large")  # ends the parsing of what has arrived

        def _refuse(self, status: HTTPStatus) -> None:
            if not self.transport.is_closing():
                self.transport.write(_refusal(status, seconds, header_bytes))
                self.transport.close()

        def send_400_response(self, msg: str) -> None:
            if not self.transport.is_closing():
                super().send_400_response(msg)

    return Guarded


def _refusal(status: HTTPStatus, seconds: float, header_bytes: int) -> bytes:
    allowed = {
        HTTPStatus.REQUEST_TIMEOUT: f"to arrive within {seconds:g} s",
        HTTPStatus.REQUEST_HEADER_FIELDS_TOO_LARGE: f"at most {header_bytes} bytes, with the URL",
    }[status]
    detail = f"the headers of the request are not allowed; allowed: {allowed}"
    parts: dict[str, Any] = {"parameter": "headers", "allowed": allowed}
    answer = problem(status, detail, {"Connection": "close"}, **parts)
    lines = [b"HTTP/1.1 %d %s" % (status, status.phrase.encode())]
    lines += [b"%s: %s" % header for header in answer.raw_headers]
    return b"\r\n".join([*lines, b"", bytes(answer.body)])
