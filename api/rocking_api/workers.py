"""Several worker processes on one port, forked from a main process that replaces those that end.

uvicorn's own supervisor starts each worker as a new interpreter, which imports and loads everything again: 180 MB of
private memory and 3 s of processor time for each. A worker that is forked after the solver was loaded shares these
pages and takes 22 MB. The main process has no other threads of Python and never answers a request. It owns the
sockets that listen, one for each worker: connections that wait while a worker is replaced are accepted by the next one.
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
from multiprocessing.connection import wait
from multiprocessing.process import BaseProcess

from uvicorn.config import STARTUP_FAILURE

LOG = logging.getLogger("rocking.service")

SIGNALS = {signal.SIGINT, signal.SIGTERM}
"""Signals that stop the service."""

QUICK_SECONDS = 1.0
"""Time between the starts of a worker that ends at once and of the one that replaces it [s]."""

KILL_SECONDS = 5
"""Time after `stop_seconds` until a worker that has not ended is killed [s]."""


class Workers:
    """The workers of one main process.

    Parameters
    ----------
    work : callable
        Serves the connections of a socket until SIGTERM or SIGINT, in a worker.
    when_ended : callable
        Called in the main process with the process id of a worker that has ended.
    stop_seconds : float
        Time that a worker has to end after SIGTERM [s].
    """

    def __init__(
        self, work: Callable[[socket.socket], None], when_ended: Callable[[int], None], stop_seconds: float
    ) -> None:
        self._work = work
        self._when_ended = when_ended
        self._stop_seconds = stop_seconds + KILL_SECONDS
        self._listeners: Sequence[socket.socket] = ()
        self._started: dict[BaseProcess, tuple[socket.socket, float]] = {}

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
                    wait([reader, *(process.sentinel for process in self._started)])
                    stopped_by = _received(reader)
                    if not stopped_by:
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
        process = multiprocessing.get_context("fork").Process(target=_run_worker, args=(self._work, listener, others))
        signal.pthread_sigmask(signal.SIG_BLOCK, SIGNALS)  # until the worker has handlers of its own
        try:
            process.start()
        finally:
            signal.pthread_sigmask(signal.SIG_UNBLOCK, SIGNALS)
        self._started[process] = listener, time.monotonic()

    def _replace(self) -> None:
        """Replace the workers that have ended, unless one could not start."""
        for process, (listener, started) in self._ended():
            if process.exitcode == STARTUP_FAILURE:
                raise SystemExit(STARTUP_FAILURE)
            fields = {"worker": process.pid, "status": process.exitcode}
            LOG.error("a worker has ended, another one replaces it", extra={"fields": fields})
            time.sleep(max(0.0, started + QUICK_SECONDS - time.monotonic()))
            self._start(listener)

    def _ended(self) -> list[tuple[BaseProcess, tuple[socket.socket, float]]]:
        """Workers that have ended, their sockets, and when they were started."""
        ended = [(process, facts) for process, facts in self._started.items() if not process.is_alive()]
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
    work: Callable[[socket.socket], None], listener: socket.socket, others: Collection[socket.socket]
) -> None:
    for other in others:  # they listen only as long as their own workers
        other.close()
    signal.set_wakeup_fd(-1)
    signal.signal(signal.SIGINT, signal.default_int_handler)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, SIGNALS)
    threading.Thread(target=_end_with_main_process, daemon=True).start()
    work(listener)


def _end_with_main_process() -> None:
    """End as after SIGTERM when the main process was killed: nobody would stop or replace this worker."""
    main = multiprocessing.parent_process()
    if main is not None:
        main.join()
        os.kill(os.getpid(), signal.SIGTERM)
