"""Several worker processes on one port, forked from a main process that replaces those that end.

uvicorn's own supervisor starts each worker as a new interpreter, which imports and loads everything again: 180 MB of
private memory and 3 s of processor time for each. A worker that is forked after the solver was loaded shares these
pages and takes 22 MB. The main process has no other threads of Python and never answers a request. It owns the
sockets that listen, one for each worker: connections that wait while a worker is replaced are accepted by the next one.

Under a service manager with a watchdog, the main process kills a worker whose event loop has stopped, and replaces it;
the service manager restarts the service if the main process stops, or if workers end as soon as they are started.
"""

from __future__ import annotations

import logging
import multiprocessing
import os
import signal
import socket
import threading
import time
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass
from multiprocessing.connection import wait
from multiprocessing.process import BaseProcess
from multiprocessing.sharedctypes import RawValue
from typing import Any

from uvicorn.config import STARTUP_FAILURE

from rocking_api.service_manager import tell_that_it_answers, watchdog_seconds

LOG = logging.getLogger("rocking.service")

SIGNALS = {signal.SIGINT, signal.SIGTERM}
"""Signals that stop the service."""

QUICK_SECONDS = 1.0
"""Time between the starts of a worker that ends at once and of the one that replaces it [s]."""

KILL_SECONDS = 5
"""Time after `stop_seconds` until a worker that has not ended is killed [s]."""

CHECK_SECONDS = 1.0
"""Time between two looks at the workers and messages to the service manager [s]."""


@dataclass(frozen=True)
class _Worker:
    """The socket that a worker serves, when it was started, and when its event loop last ran: 0 before it serves.

    The worker writes that time, of the monotonic clock, to memory that it shares with the main process [s].
    """

    listener: socket.socket
    started: float
    last_run: Any


class Workers:
    """The workers of one main process.

    Parameters
    ----------
    work : callable
        Serves the connections of a socket until SIGTERM or SIGINT, in a worker, and calls its second argument once a
        second while it does.
    when_ended : callable
        Called in the main process with the process id of a worker that has ended.
    stop_seconds : float
        Time that a worker has to end after SIGTERM [s].
    """

    def __init__(
        self,
        work: Callable[[socket.socket, Callable[[], None]], None],
        when_ended: Callable[[int], None],
        stop_seconds: float,
    ) -> None:
        self._work = work
        self._when_ended = when_ended
        self._stop_seconds = stop_seconds + KILL_SECONDS
        self._listeners: Sequence[socket.socket] = ()
        self._started: dict[BaseProcess, _Worker] = {}

    def run(self, listeners: Sequence[socket.socket]) -> int:
        """Run a worker for each socket until SIGTERM or SIGINT, and return it; then new connections are refused.

        Raises
        ------
        SystemExit
            With the status of a worker that could not start, once the others have ended.
        """
        reader, writer = socket.socketpair()
        for end in (reader, writer):
            end.setblocking(False)
        woken_by = signal.set_wakeup_fd(writer.fileno())
        handlers = {number: signal.signal(number, lambda *_: None) for number in SIGNALS}
        try:
            self._listeners = listeners
            for listener in listeners:
                self._start(listener)
            stopped_by = 0
            try:
                while not stopped_by:
                    events = wait([reader, *(process.sentinel for process in self._started)], CHECK_SECONDS)
                    stopped_by = _received(reader)
                    if not events:
                        self._check()
                    elif not stopped_by:
                        self._replace()
            finally:
                for listener in listeners:
                    listener.close()
                self._stop(reader)
            return stopped_by
        finally:
            signal.set_wakeup_fd(woken_by)
            for number, handler in handlers.items():
                signal.signal(number, handler)
            reader.close()
            writer.close()

    def _start(self, listener: socket.socket) -> None:
        others = {other for other in self._listeners if other is not listener}
        last_run = RawValue("d", 0.0)
        process = multiprocessing.get_context("fork").Process(
            target=_run_worker, args=(self._work, listener, others, last_run)
        )
        signal.pthread_sigmask(signal.SIG_BLOCK, SIGNALS)  # until the worker has handlers of its own
        try:
            process.start()
        finally:
            signal.pthread_sigmask(signal.SIG_UNBLOCK, SIGNALS)
        self._started[process] = _Worker(listener, time.monotonic(), last_run)

    def _replace(self) -> None:
        """Replace the workers that have ended, unless one could not start."""
        for process, worker in self._ended():
            if process.exitcode == STARTUP_FAILURE:
                raise SystemExit(STARTUP_FAILURE)
            fields = {"worker": process.pid, "status": process.exitcode}
            LOG.error("a worker has ended, another one replaces it", extra={"fields": fields})
            time.sleep(max(0.0, worker.started + QUICK_SECONDS - time.monotonic()))
            self._start(worker.listener)

    def _check(self) -> None:
        """Kill the workers that have not run for the time of the watchdog; tell the service manager if all serve."""
        earliest = time.monotonic() - watchdog_seconds()
        for process, worker in self._started.items():
            if max(worker.started, worker.last_run.value) < earliest:
                LOG.error("a worker does not answer, it is killed", extra={"fields": {"worker": process.pid}})
                process.kill()
                process.join()
        if all(worker.last_run.value for worker in self._started.values()):
            tell_that_it_answers()

    def _ended(self) -> list[tuple[BaseProcess, _Worker]]:
        """Workers that have ended."""
        ended = [(process, worker) for process, worker in self._started.items() if not process.is_alive()]
        for process, _ in ended:
            del self._started[process]
            if process.pid is not None:
                self._when_ended(process.pid)
        return ended

    def _stop(self, reader: socket.socket) -> None:
        """End all workers: each finishes its running requests."""
        for process in self._started:
            process.terminate()
        deadline = time.monotonic() + self._stop_seconds
        while self._started and (left := deadline - time.monotonic()) > 0:
            wait([reader, *(process.sentinel for process in self._started)], timeout=left)
            _received(reader)  # it is stopping already
            self._ended()
        for process in self._started:
            process.kill()
            process.join()


def _received(reader: socket.socket) -> int:
    """The first signal that stops the service among those that have arrived, else 0."""
    try:
        return next((number for number in reader.recv(4096) if number in SIGNALS), 0)
    except BlockingIOError:
        return 0


def _run_worker(
    work: Callable[[socket.socket, Callable[[], None]], None],
    listener: socket.socket,
    others: Collection[socket.socket],
    last_run: Any,
) -> None:
    for other in others:  # they listen only as long as their own workers
        other.close()
    signal.set_wakeup_fd(-1)
    signal.signal(signal.SIGINT, signal.default_int_handler)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, SIGNALS)
    threading.Thread(target=_end_with_main_process, daemon=True).start()

    def runs() -> None:
        last_run.value = time.monotonic()

    work(listener, runs)


def _end_with_main_process() -> None:
    """End as after SIGTERM when the main process was killed: nobody would stop or replace this worker."""
    main = multiprocessing.parent_process()
    if main is not None:
        main.join()
        os.kill(os.getpid(), signal.SIGTERM)
