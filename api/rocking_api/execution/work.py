"""Work outside the event loop: two limiters of threads, one for cheap and one for dear requests.

Work is a function of a `StopFlag`, which it passes on to parsers, searches and the solver. The flag is set after the
time limit or when the client disconnects; the thread is free hundredths of a second later. Cheap requests have threads
of their own, so that they never wait for dear ones.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import TypeVar

import anyio
import anyio.to_thread
from anyio import CapacityLimiter
from fastapi import Request
from starlette.requests import ClientDisconnect

from rocking._base.errors import StoppedError
from rocking._numba.cancellation import StopFlag

T = TypeVar("T")

Work = Callable[[StopFlag], T]
"""Work for a thread; it ends with `StoppedError` soon after the flag is set."""


class BusyError(RuntimeError):
    """The queue is full; the client may retry."""


class TimeLimitError(RuntimeError):
    """The work exceeds the time limit."""

    def __init__(self, seconds: float, advice: str = "reduce it") -> None:
        super().__init__(f"the request exceeds the time limit of {seconds:g} s; {advice}")
        self.seconds = seconds


class Workers:
    """Threads for some kind of requests, of which at most `queue` wait; `seconds` is the limit, waiting included."""

    def __init__(self, threads: int, queue: int, seconds: float) -> None:
        self.limiter = CapacityLimiter(threads)
        self._queue = queue
        self._seconds = seconds

    @property
    def running(self) -> int:
        """Requests being computed."""
        return self.limiter.borrowed_tokens

    async def run(self, work: Work[T], request: Request | None = None) -> T:
        """Run work in a thread; given the request, its body read, stop when the client disconnects.

        Raises `BusyError` if the queue is full, `TimeLimitError`, or `ClientDisconnect`.
        """
        is_full = self.limiter.available_tokens == 0 and self.limiter.statistics().tasks_waiting >= self._queue
        if is_full:
            raise BusyError("all workers are busy and the queue is full; retry in a moment")
        stop = StopFlag()
        deadline = asyncio.get_running_loop().call_later(self._seconds, stop.set)
        watch = None if request is None else asyncio.create_task(_stop_at_disconnect(request, stop))
        try:
            with anyio.fail_after(self._seconds):  # ends the wait for a thread; work ends by its flag
                return await anyio.to_thread.run_sync(work, stop, limiter=self.limiter)
        except (StoppedError, TimeoutError):
            if watch is not None and watch.done():
                raise ClientDisconnect from None
            raise TimeLimitError(self._seconds) from None
        finally:
            stop.set()
            deadline.cancel()
            if watch is not None:
                watch.cancel()


async def _stop_at_disconnect(request: Request, stop: StopFlag) -> None:
    while (await request.receive())["type"] != "http.disconnect":
        pass
    stop.set()
