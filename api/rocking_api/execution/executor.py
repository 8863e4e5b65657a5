"""Heavy work beside the event loop: a few threads, a queue of limited length before them, a time limit.

Work is a function of a `StopFlag`, which it passes on to the searches and to the solver. The flag is set when the time
is up or the client has gone; the thread is free for other work hundredths of a second later.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Any, TypeVar

from fastapi import Request
from starlette.requests import ClientDisconnect

from rocking._numba.cancellation import StopFlag

T = TypeVar("T")

Work = Callable[[StopFlag], T]
"""What is done in a thread; it ends with `StoppedError` soon after the flag is set."""


class BusyError(RuntimeError):
    """The queue is full: to be asked again later."""


class TimeLimitError(RuntimeError):
    """The work takes longer than the service grants."""

    def __init__(self, seconds: float) -> None:
        super().__init__(f"the answer takes longer than the {seconds:g} s that a request is granted; ask for less")


class BoundedExecutor:
    """Threads for heavy work.

    Parameters
    ----------
    workers : int
        Threads.
    queue : int
        Requests that may wait for one.
    seconds : float
        What one request is granted, waiting included [s].
    """

    def __init__(self, workers: int, queue: int, seconds: float) -> None:
        self._pool = ThreadPoolExecutor(workers, thread_name_prefix="heavy")
        self._places = workers + queue
        self._workers = workers
        self._seconds = seconds
        self._inside: dict[Future[Any], StopFlag] = {}

    @property
    def running(self) -> int:
        """Requests that are worked on."""
        return min(self._workers, len(self._inside))

    @property
    def waiting(self) -> int:
        """Requests in the queue."""
        return max(0, len(self._inside) - self._workers)

    async def run(self, work: Work[T], request: Request | None = None) -> T:
        """Have work done in a thread; given the request, its body read, stop when its client goes away.

        Raises
        ------
        BusyError
            If the queue is full.
        TimeLimitError
            If it takes too long.
        ClientDisconnect
            If the client has gone.
        """
        if len(self._inside) >= self._places:
            raise BusyError("all places for heavy work are taken; ask again in a moment")
        stop = StopFlag()
        future = self._pool.submit(work, stop)
        self._inside[future] = stop
        future.add_done_callback(self._inside.pop)
        answer = asyncio.wrap_future(future)
        gone = None if request is None else asyncio.create_task(_gone(request))
        try:
            waited_for: set[asyncio.Future[Any]] = {answer} if gone is None else {answer, gone}
            await asyncio.wait(waited_for, timeout=self._seconds, return_when=asyncio.FIRST_COMPLETED)
            if answer.done():
                return answer.result()
            if gone is not None and gone.done():
                raise ClientDisconnect
            raise TimeLimitError(self._seconds)
        finally:
            stop.set()
            if gone is not None:
                gone.cancel()
            answer.cancel()  # out of the queue, if it has not begun

    def close(self) -> None:
        """Begin nothing more, and stop what runs."""
        self._pool.shutdown(wait=False, cancel_futures=True)
        for stop in [*self._inside.values()]:
            stop.set()


async def _gone(request: Request) -> None:
    while (await request.receive())["type"] != "http.disconnect":
        pass
