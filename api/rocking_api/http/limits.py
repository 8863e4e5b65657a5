"""A connection is closed whose client does not send its headers, or the rest of its body, or does not read the answer.

uvicorn waits for the headers of a request for ever, and keeps all of them; a few hundred idle connections with half a
header each would be enough to shut everybody else out. It waits for ever too until an answer is read. A body that a
route reads is bounded there, see `batch`; what still arrives of one when the answer has left is bounded here.
"""

from __future__ import annotations

import asyncio
import socket
from http import HTTPStatus
from typing import Any, cast

from uvicorn.protocols.http.httptools_impl import HttpToolsProtocol, RequestResponseCycle

from rocking_api.http.coalescing import OneWrite
from rocking_api.http.problems import NOSNIFF, problem

UNSENT = 128 * 1024
"""Bytes of an answer that the operating system takes before it sends them; what is more waits here."""


def guarded(seconds: float, header_bytes: int, reading_seconds: float) -> type[HttpToolsProtocol]:
    """uvicorn's protocol with limits of time and size.

    Parameters
    ----------
    seconds : float
        What the headers of a request may take to arrive [s], an idle connection to ask again, and a body that no route
        reads to end after the answer.
    header_bytes : int
        Largest URL and headers.
    reading_seconds : float
        What a client may take to read the bytes that wait for it here, 64 to 200 kB [s].
    """

    class Guarded(HttpToolsProtocol):
        """One connection."""

        _timer: asyncio.TimerHandle | None = None
        _unread: asyncio.TimerHandle | None = None
        _arriving = False
        _header_bytes = 0

        def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
            _wait_here(transport)
            super().connection_made(cast(asyncio.Transport, OneWrite(transport, self.loop, reading_seconds)))
            self._wait()

        def connection_lost(self, exc: Exception | None) -> None:
            self._stop_waiting()
            super().connection_lost(exc)  # resumes writing
            self.resume_writing()

        def pause_writing(self) -> None:
            super().pause_writing()
            self._unread = self.loop.call_later(reading_seconds, self.transport.abort)

        def resume_writing(self) -> None:
            if self._unread is not None:
                self._unread.cancel()
                self._unread = None
            super().resume_writing()

        def data_received(self, data: bytes) -> None:
            super().data_received(data)
            if self._timer is None:
                if self._arriving:  # headers that arrive in one piece need no timer
                    self._wait()
                elif self._is_idle():
                    self._timer = self.loop.call_later(seconds, self.transport.close)

        def _is_idle(self) -> bool:
            """Whether what arrives is no request, but the rest of one that is answered; uvicorn waits for ever then."""
            cycle: RequestResponseCycle | None = self.cycle
            return cycle is not None and cycle.response_complete and self.timeout_keep_alive_task is None

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
            if self.parser.should_upgrade() and _has_body(self.headers):
                self._close_with(HTTPStatus.BAD_REQUEST, "a request with a body cannot go on in another protocol")
                raise ValueError("Upgrade with a body")  # which the parser would take for the other protocol
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
            allowed = {
                HTTPStatus.REQUEST_TIMEOUT: f"to arrive within {seconds:g} s",
                HTTPStatus.REQUEST_HEADER_FIELDS_TOO_LARGE: f"at most {header_bytes} bytes, with the URL",
            }[status]
            detail = f"the headers of the request are not allowed; allowed: {allowed}"
            self._close_with(status, detail, parameter="headers", allowed=allowed)

        def send_400_response(self, msg: str) -> None:  # noqa: ARG002  (uvicorn's message, in plain text)
            self._close_with(HTTPStatus.BAD_REQUEST, "the request is not HTTP/1.1; see RFC 9112")

        def _close_with(self, status: HTTPStatus, detail: str, **parts: Any) -> None:
            if not self.transport.is_closing():
                self.transport.write(_refusal(status, detail, **parts))
                self.transport.close()

        def _unsupported_upgrade_warning(self) -> None:
            """Nothing: a request to go on in another protocol may be ignored (RFC 9110, 7.8)."""

    return Guarded


def _wait_here(transport: asyncio.Transport) -> None:
    """Have the operating system take little more than it can send: how far a client reads is seen here by that."""
    connection = transport.get_extra_info("socket")
    if connection is not None and hasattr(socket, "TCP_NOTSENT_LOWAT"):  # Linux, macOS
        connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NOTSENT_LOWAT, UNSENT)


def _has_body(headers: list[tuple[bytes, bytes]]) -> bool:
    return any(name in (b"content-length", b"transfer-encoding") and value != b"0" for name, value in headers)


def _refusal(status: HTTPStatus, detail: str, **parts: Any) -> bytes:
    """An answer as it goes over the wire, before there is a request to pass through the application."""
    answer = problem(status, detail, {"Connection": "close"}, **parts)
    lines = [b"HTTP/1.1 %d %s" % (status, status.phrase.encode())]
    lines += [b"%s: %s" % header for header in [*answer.raw_headers, NOSNIFF]]
    return b"\r\n".join([*lines, b"", bytes(answer.body)])
