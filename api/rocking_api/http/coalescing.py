"""The head of an answer leaves with the first bytes of its body: one call of the operating system, one packet.

uvicorn writes the one and then the other, and the event loop hands each over at once.
"""

from __future__ import annotations

import asyncio
from typing import Any


class OneWrite:
    """A transport that holds a first piece back until the second is there, or the event loop turns.

    Parameters
    ----------
    transport : asyncio.Transport
        Of a connection; all else is left to it.
    loop : asyncio.AbstractEventLoop
        In which it lives.
    seconds : float
        What a client may take to read what is unsent when the connection is closed [s].
    """

    def __init__(self, transport: asyncio.Transport, loop: asyncio.AbstractEventLoop, seconds: float) -> None:
        self._transport = transport
        self._loop = loop
        self._seconds = seconds
        self._held: bytes | None = None

    def write(self, data: bytes) -> None:
        """Hold the first piece, send the second with it."""
        if self._held is None:
            self._held = data
            self._loop.call_soon(self._send)
        else:
            pieces = [self._held, data]
            self._held = None
            self._transport.writelines(pieces)

    def close(self) -> None:
        """Close it when all is sent, or not read in time."""
        self._send()
        if self._transport.get_write_buffer_size():
            self._loop.call_later(self._seconds, self._transport.abort)
        self._transport.close()

    def _send(self) -> None:
        held, self._held = self._held, None
        if held is not None and not self._transport.is_closing():
            self._transport.write(held)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._transport, name)
