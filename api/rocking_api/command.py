"""The command `rocking serve`, found through the entry point `serve` of the group `rocking.commands`.

`rocking --help` loads this module, so that the service is imported when it starts.
"""

from __future__ import annotations

import os
import subprocess
import tempfile
from contextlib import ExitStack
from typing import Annotated, Any

import typer

LOG: dict[str, Any] = {
    "version": 1,
    "disable_existing_loggers": False,
    "formatters": {"line": {"format": "%(asctime)s %(levelname)s %(name)s: %(message)s"}},
    "handlers": {"stderr": {"class": "logging.StreamHandler", "formatter": "line"}},
    "loggers": {name: {"handlers": ["stderr"], "level": "INFO", "propagate": False} for name in ("rocking", "uvicorn")},
}
"""For logging.config.dictConfig."""

HEALTHCHECK_SECONDS = 10
"""Time that uvicorn waits for the answer of a worker before it replaces it [s].

It waits as long for one that has died between question and answer, and stops nothing meanwhile: with `stop_seconds` it
stays below `TimeoutStopSec` of `deploy/rocking.service`. A thread of the worker answers before the package is loaded.
"""


def serve(
    host: Annotated[str, typer.Option(help="Address to listen on.", metavar="[ADDRESS]")] = "127.0.0.1",
    port: Annotated[
        int, typer.Option(help="Port to listen on; 0 takes a free one.", metavar="[NUMBER]", min=0, max=65535)
    ] = 8000,
    results: Annotated[
        str | None,
        typer.Option(
            help="Folder with the data sets of the workflow; by default ROCKING_RESULTS, or results.",
            metavar="[FOLDER]",
        ),
    ] = None,
    workers: Annotated[int, typer.Option(help="Processes that serve.", metavar="[NUMBER]", min=1, max=256)] = 1,
) -> None:
    """Run the HTTP service until interrupted; the routes are described under /docs."""
    import uvicorn
    from pydantic import ValidationError

    from rocking_api.execution.kernels import compile_command
    from rocking_api.settings import EXAMPLE, Settings, has_data, unknown_variables, variables

    for variable in unknown_variables(os.environ):
        typer.echo(f"Error: {variable} is not allowed; allowed: {', '.join(variables())}", err=True)
        raise typer.Exit(2)
    overrides: dict[str, Any] = {} if results is None else {"results": results}
    try:
        settings = Settings(**overrides)
    except ValidationError as error:
        wrong = error.errors()[0]
        (name,) = wrong["loc"]
        name = f"--{name}" if name in overrides else f"ROCKING_{name}".upper()
        allowed = wrong.get("ctx", {}).get("error", wrong["msg"])
        typer.echo(f"Error: {name} = {wrong['input']!r} is not allowed; allowed: {allowed}", err=True)
        raise typer.Exit(2) from None
    if results is not None:
        if not settings.results.is_dir():
            typer.echo(f"Error: --results = {results!r} is not allowed; allowed: a folder that exists", err=True)
            raise typer.Exit(2)
        os.environ["ROCKING_RESULTS"] = results
    elif "ROCKING_RESULTS" not in os.environ and not has_data(settings.results):
        os.environ["ROCKING_RESULTS"] = str(EXAMPLE)
        typer.echo(f"No data sets in the folder {settings.results}: those of an example are served.", err=True)
    with ExitStack() as stack:
        if workers > 1:
            folder = stack.enter_context(tempfile.TemporaryDirectory(prefix="rocking-metrics-"))
            os.environ["PROMETHEUS_MULTIPROC_DIR"] = folder  # of prometheus_client
            if (command := compile_command()) is not None:  # once, not in each worker
                subprocess.run(command, check=False)
        uvicorn.run(
            "rocking_api.server:application",
            factory=True,
            host=host,
            port=port,
            workers=workers,
            ws="none",
            server_header=False,
            log_config=LOG,
            access_log=settings.access_log,
            limit_concurrency=settings.max_connections,
            timeout_graceful_shutdown=settings.stop_seconds,
            timeout_worker_healthcheck=HEALTHCHECK_SECONDS,
        )
