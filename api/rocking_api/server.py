"""The server process: uvicorn with one event loop, connection limits, JSON logs and graceful shutdown."""

from __future__ import annotations

import ctypes
import gc
import sys
from contextlib import suppress

import uvicorn

from rocking_api.app import create_app
from rocking_api.http.connection import limited_protocol
from rocking_api.http.request_log import CONFIG
from rocking_api.settings import Settings

GC_THRESHOLD = 20_000
"""Net allocations that start a garbage collection [-]."""


SWITCH_INTERVAL = 0.0005
"""Time after which a thread of Python passes the interpreter lock to one that waits for it [s]; the default is 0.005.

The event loop waits that long after each read from a connection while another thread parses a body. Under 64 uploads of
5 MB `/health` takes 0.008 s in the median rather than 0.017 to 0.030 s, on two busy cores.
"""


M_TRIM_THRESHOLD, M_MMAP_THRESHOLD = -1, -3
"""Parameters of `mallopt`, from glibc's malloc.h."""

LARGE_BLOCK = 1_000_000
"""Bytes of memory that are returned to the operating system when they are freed."""


def serve(settings: Settings, host: str, port: int) -> None:
    """Serve until SIGINT or SIGTERM; then finish running requests within `stop_seconds`, and refuse new ones.

    Parameters
    ----------
    settings : Settings
        Of the service.
    host, port : str, int
        Address; port 0 takes a free one and logs it.
    """
    _tune_garbage_collector()
    _return_freed_memory()
    sys.setswitchinterval(SWITCH_INTERVAL)
    uvicorn.run(
        create_app(settings, when_ready=gc.freeze),
        host=host,
        port=port,
        http=limited_protocol(settings.arrival_seconds, settings.max_header_bytes, settings.reading_seconds),
        ws="none",
        log_config=CONFIG,
        access_log=False,  # written by RequestLog
        server_header=False,
        timeout_graceful_shutdown=settings.stop_seconds,
    )


def _return_freed_memory() -> None:
    """Make glibc return freed blocks of a megabyte and more to the operating system at once.

    By default it raises that threshold to 32 MB and keeps freed memory. Twenty clients that requested 500,000 points
    each and read nothing add at most 73 to 125 MB rather than 138 to 201 MB, and 42 to 49 MB of it remain.
    """
    with suppress(OSError, AttributeError):  # another C library
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
