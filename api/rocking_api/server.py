"""The server: uvicorn, one event loop in each process, with a limit of connections, JSON logs and graceful shutdown."""

from __future__ import annotations

import ctypes
import gc
import socket
import subprocess
import sys
from collections.abc import Callable
from contextlib import suppress
from typing import Any

import uvicorn
from uvicorn.config import STARTUP_FAILURE

from rocking.precompile import load_kernels
from rocking_api.app import create_app
from rocking_api.execution.kernels import compile_command
from rocking_api.json_log import CONFIG
from rocking_api.metrics import forget_process
from rocking_api.service_manager import tell_that_it_answers
from rocking_api.settings import Settings
from rocking_api.workers import Workers

GC_THRESHOLD = 20_000
"""Net allocations that start a garbage collection [-]."""


SWITCH_INTERVAL = 0.0005
"""Time after which a thread of Python passes the interpreter lock to one that waits for it [s]; the default is 0.005.

The event loop waits that long after each read from a connection while another thread parses a body. Under 64 uploads of
5 MB `/health` takes 0.008 s in the median rather than 0.017 to 0.030 s, on two busy cores.
"""


M_TRIM_THRESHOLD, M_MMAP_THRESHOLD = -1, -3
"""Parameters of `mallopt`, from glibc's malloc.h."""

UNSENT = 128 * 1024
"""Unsent bytes of a connection that the operating system buffers; the rest waits in this process."""

LARGE_BLOCK = 1_000_000
"""Bytes of memory that are returned to the operating system when they are freed."""


def serve(settings: Settings, host: str, port: int, workers: int = 1) -> int:
    """Serve until SIGINT or SIGTERM; then finish running requests within `stop_seconds`, and refuse new ones.

    Parameters
    ----------
    settings : Settings
        Of the service; limits are those of each worker.
    host, port : str, int
        Address; port 0 takes a free one and logs it.
    workers : int
        Number of processes that serve, >= 1. The metrics are those of all if `PROMETHEUS_MULTIPROC_DIR` named a folder
        when `prometheus_client` was imported.

    Returns
    -------
    int
        The signal that has stopped several workers; one worker ends by the signal.
    """
    _return_freed_memory()
    sys.setswitchinterval(SWITCH_INTERVAL)
    options: dict[str, Any] = {
        "host": host,
        "port": port,
        "limit_concurrency": settings.max_connections,
        "ws": "none",
        "log_config": CONFIG,
        "access_log": False,  # written by RequestLog
        "server_header": False,
        "timeout_graceful_shutdown": settings.stop_seconds,
    }

    def work(listener: socket.socket, runs: Callable[[], None]) -> None:
        async def notify() -> None:
            runs()

        app = create_app(settings, when_ready=gc.freeze)
        # with a negative time uvicorn notifies once a second whatever is done to the clock of the machine
        config = uvicorn.Config(app, callback_notify=notify, timeout_notify=-sys.maxsize, **options)
        server = uvicorn.Server(config)
        server.run([listener])
        if not server.started:
            sys.exit(STARTUP_FAILURE)

    listeners = _listen(uvicorn.Config("", **options), workers)
    if workers == 1:
        _tune_garbage_collector()
        with suppress(KeyboardInterrupt):
            work(listeners[0], tell_that_it_answers)
        return 0
    _load_kernels()
    _tune_garbage_collector()
    return Workers(work, forget_process, settings.stop_seconds).run(listeners)


def _listen(config: uvicorn.Config, workers: int) -> list[socket.socket]:
    """Sockets that listen on the address of the configuration, one for each worker; connections wait for the workers.

    Linux distributes connections evenly among them. Of one socket the worker that wakes first takes all connections
    that wait: sixteen that were opened together all went to one of two workers. Elsewhere the workers share one socket.
    """
    first = config.bind_socket()  # fails if another service listens there
    if hasattr(socket, "TCP_NOTSENT_LOWAT"):  # connections inherit it: how slowly a client reads is noticed here
        first.setsockopt(socket.IPPROTO_TCP, socket.TCP_NOTSENT_LOWAT, UNSENT)
    sockets = [first] * workers
    if sys.platform == "linux":
        first.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEPORT, 1)
        sockets[1:] = [socket.socket(first.family) for _ in sockets[1:]]
        for one in sockets[1:]:
            one.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEPORT, 1)
            one.setsockopt(socket.IPPROTO_TCP, socket.TCP_NOTSENT_LOWAT, UNSENT)
            one.bind(first.getsockname())
    for one in sockets:
        one.listen(config.backlog)
    return sockets


def _load_kernels() -> None:
    """Load the solver before workers are forked, which then share it; compile it if necessary."""
    if (command := compile_command()) is not None:
        subprocess.run(command, check=False)
    load_kernels()


def _return_freed_memory() -> None:
    """Make glibc return freed blocks of a megabyte and more to the operating system at once.

    By default it raises that threshold to 32 MB and keeps freed memory. Twenty clients that requested 500,000 points
    each and read nothing add at most 73 to 125 MB rather than 138 to 201 MB, and 42 to 49 MB of it remain.
    """
    with suppress(OSError, AttributeError, TypeError):  # another C library; on Windows None names none
        for parameter in (M_TRIM_THRESHOLD, M_MMAP_THRESHOLD):
            ctypes.CDLL(None).mallopt(parameter, LARGE_BLOCK)


def _tune_garbage_collector() -> None:
    """Exclude imported objects from garbage collection, and collect less often.

    A full collection of them pauses the event loop for 0.1 to 0.3 s, for example while kernels are loaded. The kernels
    are excluded once they are loaded. The throughput is the same without.
    """
    gc.collect()
    gc.freeze()
    gc.set_threshold(GC_THRESHOLD)
