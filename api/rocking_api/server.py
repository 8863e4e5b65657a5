"""The server process: uvicorn, one event loop, guarded connections, JSON logs, an orderly end."""

from __future__ import annotations

import ctypes
import gc
import logging
from contextlib import suppress

import uvicorn

from rocking_api.app import create_app
from rocking_api.http.limits import guarded
from rocking_api.http.logs import CONFIG
from rocking_api.settings import Settings

GARBAGE = 20_000
"""Objects made and not freed that make the collector look for circles [-]."""


M_TRIM_THRESHOLD, M_MMAP_THRESHOLD = -1, -3
"""Parameters of `mallopt`, from glibc's malloc.h."""

LARGE_BLOCK = 1_000_000
"""Bytes of memory that are returned to the operating system when they are freed."""


def serve(settings: Settings, host: str, port: int) -> None:
    """Answer until SIGINT or SIGTERM; then running requests are granted `stop_seconds`, and new ones refused.

    Parameters
    ----------
    settings : Settings
        Of the service.
    host, port : str, int
        Where to listen; port 0 takes a free one and logs it.
    """
    _lean_logging()
    _lean_collector()
    _return_freed_memory()
    uvicorn.run(
        create_app(settings, when_ready=gc.freeze),
        host=host,
        port=port,
        http=guarded(settings.arrival_seconds, settings.max_header_bytes, settings.reading_seconds),
        ws="none",
        log_config=CONFIG,
        access_log=False,  # the observer writes it
        server_header=False,
        timeout_graceful_shutdown=settings.stop_seconds,
    )


def _return_freed_memory() -> None:
    """Have glibc return freed blocks of a megabyte and more to the operating system at once.

    Left alone it raises that limit to 32 MB with the first large blocks that are freed, and keeps what it has. After 20
    clients that asked for 500,000 points each and never read, this leaves 42 to 49 MB more than before them rather than
    138 to 201 MB; at most 73 to 125 MB are added rather than 138 to 201 MB.
    """
    with suppress(OSError, AttributeError):  # another C library
        for parameter in (M_TRIM_THRESHOLD, M_MMAP_THRESHOLD):
            ctypes.CDLL(None).mallopt(parameter, LARGE_BLOCK)


def _lean_collector() -> None:
    """Take what was imported out of the collector's sight: to look through it all stops everything for 0.1 s and more.

    So it is with the kernels once they are loaded. What requests leave behind is looked through once in some hundred of
    them, not after each few.
    """
    gc.collect()
    gc.freeze()
    gc.set_threshold(GARBAGE)


def _lean_logging() -> None:
    """Have no record look up what our lines do not tell: the caller, the thread, the process."""
    logging._srcfile = None  # the way that Python's logging HOWTO names, as the flags below
    logging.logThreads = logging.logProcesses = logging.logMultiprocessing = False
