"""Thread pool for heavy work, with queue limit, timeout and cancellation.

Work is a function of a `StopFlag`, which it passes on to the searches and to the solver. The flag is set after the time
limit or when the client disconnects; the thread is free hundredths of a second later.
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
"""Work for a thread; it ends with `StoppedError` soon after the flag is set."""


class BusyError(RuntimeError):
    """The queue is full; the client may retry."""


class TimeLimitError(RuntimeError):
    """The work exceeds the time limit.

    Parameters
    ----------
    seconds : float
        The limit [s].
    advice : str
        What to ask instead.
    """

    def __init__(self, seconds: float, advice: str = "reduce it") -> None:
        super().__init__(f"the request exceeds the time limit of {seconds:g} s; {advice}")
        self.seconds = seconds


class BoundedExecutor:
    """Threads for heavy work.

    Parameters
    ----------
    workers : int
        Number of threads.
    queue : int
        Requests that may wait for one.
    seconds : float
        Time limit of a request, waiting included [s].
    on_change : callable, optional
        Called with the executor, in any thread, after `running` or `waiting` has changed.
    """

    def __init__(
        self, workers: int, queue: int, seconds: float, on_change: Callable[[BoundedExecutor], None] = lambda _: None
    ) -> None:
        self._pool = ThreadPoolExecutor(workers, thread_name_prefix="heavy")
        self._capacity = workers + queue
        self._workers = workers
        self._seconds = seconds
        self._jobs: dict[Future[Any], StopFlag] = {}
        self._on_change = on_change

    @property
    def running(self) -> int:
        """Requests being computed."""
        return min(self._workers, len(self._jobs))

    @property
    def waiting(self) -> int:
        """Requests in the queue."""
        return max(0, len(self._jobs) - self._workers)

    async def run(self, work: Work[T], request: Request | None = None) -> T:
        """Run work in a thread; given the request, its body read, stop when the client disconnects.

        Raises
        ------
        BusyError
            If the queue is full.
        TimeLimitError
            If the time limit is exceeded.
        ClientDisconnect
            If the client has disconnected.
        """
        if len(self._jobs) >= self._capacity:
            raise BusyError("all workers are busy and the queue is full; retry in a moment")
        stop = StopFlag()
        future = self._pool.submit(work, stop)
        self._jobs[future] = stop
        self._on_change(self)
        future.add_done_callback(self._forget)
        answer = asyncio.wrap_future(future)
        gone = None if request is None else asyncio.create_task(_wait_for_disconnect(request))
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
            answer.cancel()  # removes it from the queue if it has not started

    def _forget(self, future: Future[Any]) -> None:
        del self._jobs[future]
        self._on_change(self)

    def close(self) -> None:
        """Start no more work, and cancel what runs."""
        self._pool.shutdown(wait=False, cancel_futures=True)
        for stop in [*self._jobs.values()]:
            stop.set()


async def _wait_for_disconnect(request: Request) -> None:
    while (await request.receive())["type"] != "http.disconnect":
        pass
