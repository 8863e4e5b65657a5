"""Time and size limits of a connection: header size, time for the headers, time to read a response.

uvicorn waits for the headers of a request without limit and keeps all of them; a few hundred idle connections with
incomplete headers could exhaust the service. It also waits without limit until a response is read. Bodies that a route
reads are limited in `batch`; the rest of a body that arrives after its response is limited here. Needed against slow
clients; it costs about 10 % of the processor time of a request for one block.
"""

from __future__ import annotations

import asyncio
import socket
from http import HTTPStatus
from typing import Any

from uvicorn.protocols.http.httptools_impl import HttpToolsProtocol, RequestResponseCycle

from rocking_api.http.errors import NOSNIFF, problem_response

UNSENT = 128 * 1024
"""Unsent bytes that the operating system buffers; the rest waits in this process."""


def limited_protocol(seconds: float, header_bytes: int, reading_seconds: float) -> type[HttpToolsProtocol]:
    """uvicorn's protocol with limits of time and size.

    Parameters
    ----------
    seconds : float
        Time for the headers of a request to arrive, for an idle connection to send a request, and for a body that no
        route reads to end after the response [s].
    header_bytes : int
        Largest URL and headers.
    reading_seconds : float
        Time for a client to read the bytes that wait here, up to 130 kB [s].
    """

    class LimitedProtocol(HttpToolsProtocol):
        """One connection."""

        _timer: asyncio.TimerHandle | None = None
        _unread: asyncio.TimerHandle | None = None
        _arriving = False
        _header_bytes = 0

        def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
            _limit_unsent_bytes(transport)
            super().connection_made(transport)
            self._wait()

        def connection_lost(self, exc: Exception | None) -> None:
            self._stop_waiting()
            super().connection_lost(exc)  # resumes writing
            self.resume_writing()

        def pause_writing(self) -> None:
            super().pause_writing()
            self._unread = self.loop.call_later(reading_seconds, self.transport.abort)

        def on_response_complete(self) -> None:
            super().on_response_complete()
            self._limit_close()

        def timeout_keep_alive_handler(self) -> None:
            super().timeout_keep_alive_handler()
            self._limit_close()

        def _limit_close(self) -> None:
            """A closed transport waits until everything is sent: limit that time too."""
            if self.transport.is_closing() and self.transport.get_write_buffer_size():
                self.loop.call_later(reading_seconds, self.transport.abort)

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
                    self._timer = self.loop.call_later(seconds, self._close)

        def _is_idle(self) -> bool:
            """Whether the data is the rest of an answered request; uvicorn would wait for it without limit."""
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
                self._close_with(HTTPStatus.BAD_REQUEST, "a request with a body cannot upgrade to another protocol")
                raise ValueError("Upgrade with a body")  # the parser would take the body for the other protocol
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
                raise ValueError("headers too large")  # ends parsing

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
                self._close()

        def _close(self) -> None:
            self.transport.close()
            self._limit_close()

        def _unsupported_upgrade_warning(self) -> None:
            """Nothing: a server may ignore an upgrade request (RFC 9110, 7.8)."""

    return LimitedProtocol


def _limit_unsent_bytes(transport: asyncio.Transport) -> None:
    """Limit what the operating system buffers, so that this process notices a client that does not read."""
    connection = transport.get_extra_info("socket")
    if connection is not None and hasattr(socket, "TCP_NOTSENT_LOWAT"):  # Linux, macOS
        connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NOTSENT_LOWAT, UNSENT)


def _has_body(headers: list[tuple[bytes, bytes]]) -> bool:
    return any(name in (b"content-length", b"transfer-encoding") and value != b"0" for name, value in headers)


def _refusal(status: HTTPStatus, detail: str, **parts: Any) -> bytes:
    """The bytes of an error response, for a connection without a complete request."""
    answer = problem_response(status, detail, {"Connection": "close"}, **parts)
    lines = [b"HTTP/1.1 %d %s" % (status, status.phrase.encode())]
    lines += [b"%s: %s" % header for header in [*answer.raw_headers, NOSNIFF]]
    return b"\r\n".join([*lines, b"", bytes(answer.body)])
