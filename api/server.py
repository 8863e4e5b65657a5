"""The server process: uvicorn, one event loop, guarded connections, JSON logs, an orderly end."""

from __future__ import annotations

import gc

import uvicorn

from api.app import create_app
from api.guard import guarded
from api.logs import CONFIG
from api.settings import Settings


def serve(settings: Settings, host: str, port: int) -> None:
    """Answer until SIGINT or SIGTERM; then running requests are granted `stop_seconds`, and new ones refused.

    Parameters
    ----------
    settings : Settings
        Of the service.
    host, port : str, int
        Where to listen; port 0 takes a free one and logs it.
    """
    uvicorn.run(
        create_app(settings, when_ready=_settle),
        host=host,
        port=port,
        http=guarded(settings.arrival_seconds, settings.max_header_bytes),
        ws="none",
        log_config=CONFIG,
        access_log=False,  # the observer writes it
        server_header=False,
        timeout_graceful_shutdown=settings.stop_seconds,
    )


def _settle() -> None:
    """Take what was loaded out of the collector's sight: to look through it all takes a tenth of a second each time."""
    gc.collect()
    gc.freeze()
