"""The command `rocking serve`, found through the entry point `serve` of the group `rocking.commands`."""

from __future__ import annotations

import multiprocessing
import os
import signal
import tempfile
from contextlib import ExitStack
from types import FrameType
from typing import Any

import typer
import uvicorn  # noqa: F401  (`rocking serve` names the extra if this import fails; the server is imported by `main`)
from pydantic import ValidationError

from rocking_api.settings import Settings


def main(results: str | None, host: str, port: int, workers: int = 1) -> None:
    """Serve a folder of results on an address until SIGINT or SIGTERM.

    Parameters
    ----------
    results : str or None
        Folder; None takes it from the environment, as all other settings.
    host : str
        Address to listen on.
    port : int
        Port to listen on, 0 to 65535; 0 takes a free one.
    workers : int
        Number of processes that serve, >= 1; more than one where processes can be forked, not on Windows.

    Raises
    ------
    typer.Exit
        With code 2 if a setting is not allowed; the message names it.
    """
    if workers > 1 and "fork" not in multiprocessing.get_all_start_methods():
        typer.echo(f"Error: --workers = {workers} is not allowed; allowed: 1 on a system that cannot fork", err=True)
        raise typer.Exit(2)
    given: dict[str, Any] = {} if results is None else {"results": results}
    try:
        settings = Settings(**given)
    except ValidationError as error:
        wrong = error.errors()[0]
        (name,) = wrong["loc"]
        name = f"--{name}" if name in given else f"ROCKING_{name}".upper()
        allowed = wrong.get("ctx", {}).get("error", wrong["msg"])
        typer.echo(f"Error: {name} = {wrong['input']!r} is not allowed; allowed: {allowed}", err=True)
        raise typer.Exit(2) from None
    if results is not None and not settings.results.is_dir():
        typer.echo(f"Error: --results = {results!r} is not allowed; allowed: a folder that exists", err=True)
        raise typer.Exit(2)
    with ExitStack() as stack:
        if workers > 1:
            folder = stack.enter_context(tempfile.TemporaryDirectory(prefix="rocking-metrics-"))
            os.environ["PROMETHEUS_MULTIPROC_DIR"] = folder
            signal.signal(signal.SIGTERM, _leave)  # until the workers run; the folder is removed
        from rocking_api.server import serve  # noqa: PLC0415  (prometheus_client reads the variable on import)

        stopped_by = serve(settings, host, port, workers)
    if stopped_by == signal.SIGTERM:  # end as one process does
        signal.signal(stopped_by, signal.SIG_DFL)
        signal.raise_signal(stopped_by)


def _leave(number: int, _: FrameType | None) -> None:
    raise SystemExit(128 + number)
