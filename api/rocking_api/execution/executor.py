"""Threads for work on requests: a fair queue with a limit, a time limit and cancellation.

Work is a function of a `StopFlag`, which it passes on to parsers, searches and the solver. The flag is set after the
time limit or when the client disconnects; the thread is free hundredths of a second later.

Of the requests that wait, the next one is of the client whose work has taken the least time since the threads were last
idle; among those of one client it is the one with the smallest cost. Where all threads are busy, one more gives a
request a trial of `TRIAL_SECONDS`: short work never waits for long work to end, whatever it was expected to cost.
"""

from __future__ import annotations

import asyncio
import time
from collections import Counter, defaultdict
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Any, TypeVar

from fastapi import Request
from starlette.requests import ClientDisconnect

from rocking._base.errors import StoppedError
from rocking._numba.cancellation import StopFlag

T = TypeVar("T")

Work = Callable[[StopFlag], T]
"""Work for a thread; it ends with `StoppedError` soon after the flag is set, and can then be done again."""

TRIAL_SECONDS = 0.5
"""Time of a trial [s]. Work that exceeds it starts anew when a thread is free, so that long work takes so much longer
at most, and only where others wait."""


class BusyError(RuntimeError):
    """The queue is full; the client may retry."""


class TimeLimitError(RuntimeError):
    """The work exceeds the time limit."""

    def __init__(self, seconds: float, advice: str = "reduce it") -> None:
        super().__init__(f"the request exceeds the time limit of {seconds:g} s; {advice}")
        self.seconds = seconds


@dataclass(eq=False)
class _Job:
    """Work of a request, and what its client waits for."""

    work: Work[Any]
    client: str
    cost: int
    answer: asyncio.Future[Any]
    stop: StopFlag = field(default_factory=StopFlag)
    started: float = 0.0
    on_trial: bool = False
    is_long: bool = False


class BoundedExecutor:
    """Threads for heavy work. All methods are called by the event loop.

    `seconds` is the limit of a request, waiting included; `on_change` is called after `running` or `waiting` changed.
    With `trials` one more thread gives trials, and the work must raise `StoppedError` when it is stopped.
    """

    def __init__(
        self,
        workers: int,
        queue: int,
        seconds: float,
        on_change: Callable[[BoundedExecutor], None] = lambda _: None,
        *,
        trials: bool = False,
    ) -> None:
        self._pool = ThreadPoolExecutor(workers + trials, thread_name_prefix="heavy")
        self._workers = workers
        self._capacity = workers + queue
        self._seconds = seconds
        self._on_change = on_change
        self._trials = trials
        self._waiting: list[_Job] = []
        self._running: list[_Job] = []
        self._spent: defaultdict[str, float] = defaultdict(float)

    @property
    def running(self) -> int:
        """Requests being computed."""
        return len(self._running)

    @property
    def waiting(self) -> int:
        """Requests in the queue."""
        return len(self._waiting)

    async def run(self, work: Work[T], request: Request | None = None, cost: int = 0, *, is_long: bool = False) -> T:
        """Run work in a thread; given the request, its body read, stop when the client disconnects.

        Of the requests of a client that with the least cost is served first, such as the size of a body [bytes]; what
        `is_long` has no trial, and is served after what may be short. Raises `BusyError` if the queue is full, of which
        a client with fewer requests than another one takes the place.
        """
        client = getattr(request, "client", None)
        answer = asyncio.get_running_loop().create_future()
        job = _Job(work, client.host if client else "", cost, answer, is_long=is_long)
        self._admit(job)
        gone = None if request is None else asyncio.create_task(_wait_for_disconnect(request))
        try:
            waited_for: set[asyncio.Future[Any]] = {job.answer} if gone is None else {job.answer, gone}
            await asyncio.wait(waited_for, timeout=self._seconds, return_when=asyncio.FIRST_COMPLETED)
            if job.answer.done():
                found: T = job.answer.result()
                return found
            if gone is not None and gone.done():
                raise ClientDisconnect
            raise TimeLimitError(self._seconds)
        finally:
            job.stop.set()
            job.answer.cancel()
            if gone is not None:
                gone.cancel()
            if job in self._waiting:
                self._waiting.remove(job)
                self._on_change(self)

    def _admit(self, job: _Job) -> None:
        """Add a job to the queue; of a full one it takes the place of the client with the most, if that has more."""
        if len(self._waiting) + len(self._running) >= self._capacity:
            held = Counter(one.client for one in (*self._waiting, *self._running))
            most = max(self._waiting, key=lambda one: (held[one.client], one.cost), default=job)
            error = BusyError("all workers are busy and the queue is full; retry in a moment")
            if held[most.client] <= held[job.client] + 1:
                raise error
            self._waiting.remove(most)
            most.answer.set_exception(error)
        self._waiting.append(job)
        self._start_next()

    def _start_next(self) -> None:
        """Start what waits, as far as threads are free."""
        while self._waiting:
            is_free, on_trial = self._is_free(), any(one.on_trial for one in self._running)
            ready = [one for one in self._waiting if is_free or not (one.is_long or on_trial or not self._trials)]
            if not ready:
                break
            self._start(min(ready, key=self._rank), on_trial=not is_free)
        self._on_change(self)

    def _is_free(self) -> bool:
        return sum(not one.on_trial for one in self._running) < self._workers

    def _rank(self, job: _Job) -> tuple[float, bool, int]:
        now = time.monotonic()
        running = sum(now - one.started for one in self._running if one.client == job.client)
        return self._spent.get(job.client, 0.0) + running, job.is_long, job.cost

    def _start(self, job: _Job, *, on_trial: bool) -> None:
        loop = asyncio.get_running_loop()
        self._waiting.remove(job)
        self._running.append(job)
        job.stop, job.started, job.on_trial = StopFlag(), time.monotonic(), on_trial
        if on_trial:
            loop.call_later(TRIAL_SECONDS, self._end_trial, job, job.stop)

        def ended(future: Future[Any]) -> None:
            with suppress(RuntimeError):  # the event loop has ended
                loop.call_soon_threadsafe(self._end, job, future)

        self._pool.submit(job.work, job.stop).add_done_callback(ended)

    def _end_trial(self, job: _Job, stop: StopFlag) -> None:
        if job.stop is not stop or job not in self._running:
            return
        if self._is_free():
            job.on_trial = False
            self._start_next()
        else:
            job.is_long = True
            stop.set()

    def _end(self, job: _Job, future: Future[Any]) -> None:
        """Give a client its answer, or start work anew that took longer than its trial."""
        self._running.remove(job)
        self._spent[job.client] += time.monotonic() - job.started
        if not self._running and not self._waiting:
            self._spent.clear()
        if not job.answer.done():
            error = future.exception()
            if isinstance(error, StoppedError) and job.on_trial:
                self._waiting.append(job)
            elif error is not None:
                job.answer.set_exception(error)
            else:
                job.answer.set_result(future.result())
        self._start_next()

    def close(self) -> None:
        """Start no more work, and cancel what runs."""
        self._pool.shutdown(wait=False, cancel_futures=True)
        for job in self._running:
            job.stop.set()
        for job in (*self._waiting, *self._running):
            job.answer.cancel()


async def _wait_for_disconnect(request: Request) -> None:
    while (await request.receive())["type"] != "http.disconnect":
        pass
