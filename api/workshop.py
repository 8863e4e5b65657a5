"""Heavy work beside the event loop: a few threads, a short queue before them, and an end to everything.

Work stops when its time is up or nobody waits any more: whenever it enters a function of the package its `Leave` is
asked, which the functions themselves need not know. What does not come to such a place is answered 504 at the end of
its time and keeps its place until it is done, so that there is never more work than threads.
"""

from __future__ import annotations

import asyncio
import sys
import time
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from types import FrameType
from typing import Any, TypeVar

from fastapi import Request
from starlette.requests import ClientDisconnect

T = TypeVar("T")


class BusyError(RuntimeError):
    """The queue is full: to be asked again later."""


class TimeLimitError(RuntimeError):
    """The work takes longer than the service grants, or than a `Leave` for a part of it does."""

    def __init__(self, seconds: float, leave: Leave | None = None) -> None:
        self.leave = leave
        super().__init__(f"the answer takes longer than the {seconds:g} s that a request is granted; ask for less")


class Leave:
    """To go on working.

    Parameters
    ----------
    seconds : float
        How long [s].
    """

    def __init__(self, seconds: float) -> None:
        self._seconds = seconds
        self._until = time.monotonic() + seconds
        self._withdrawn = False

    def withdraw(self) -> None:
        """Nobody waits for the answer."""
        self._withdrawn = True

    def ask(self) -> None:
        """Go on, or not.

        Raises
        ------
        TimeLimitError
            When the time is up.
        ClientDisconnect
            When nobody waits any more.
        """
        if self._withdrawn:
            raise ClientDisconnect
        if time.monotonic() > self._until:
            raise TimeLimitError(self._seconds, self)


class Workshop:
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
        self._inside: set[Future[Any]] = set()

    @property
    def running(self) -> int:
        """Requests that are worked on."""
        return min(self._workers, len(self._inside))

    @property
    def waiting(self) -> int:
        """Requests in the queue."""
        return max(0, len(self._inside) - self._workers)

    async def run(self, work: Callable[[], T], request: Request | None = None) -> T:
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
        leave = Leave(self._seconds)
        future = self._pool.submit(_watched, work, leave)
        self._inside.add(future)
        future.add_done_callback(self._inside.discard)
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
            leave.withdraw()
            if gone is not None:
                gone.cancel()
            answer.cancel()  # out of the queue, if it has not begun

    def close(self) -> None:
        """Begin nothing more; what runs comes to its end."""
        self._pool.shutdown(wait=False, cancel_futures=True)


def attempt(work: Callable[[], T], seconds: float) -> T | None:
    """Do a part of the work of this thread within some time [s]; None if that was not enough."""
    leave = Leave(seconds)
    try:
        return _watched(work, leave)
    except TimeLimitError as error:
        if error.leave is not leave:
            raise
        return None


def _watched(work: Callable[[], T], leave: Leave) -> T:
    """Work in this thread that asks for leave, its own and that of the work it is part of.

    It does so with each function of the package that it enters.
    """
    outer = sys.getprofile()

    def look(frame: FrameType, event: Any, argument: Any) -> None:
        if outer is not None:
            outer(frame, event, argument)
        if event == "call" and frame.f_globals.get("__name__", "").startswith("rocking."):
            leave.ask()

    sys.setprofile(look)
    try:
        return work()
    finally:
        sys.setprofile(outer)


async def _gone(request: Request) -> None:
    while (await request.receive())["type"] != "http.disconnect":
        pass
