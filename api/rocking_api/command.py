"""The command `rocking serve`, found through the entry point `serve` of the group `rocking.commands`."""

from __future__ import annotations

from typing import Any

import typer
from pydantic import ValidationError

from rocking_api.server import serve
from rocking_api.settings import Settings


def main(results: str | None, host: str, port: int) -> None:
    """Serve a folder of results on an address until SIGINT or SIGTERM.

    Parameters
    ----------
    results : str or None
        Folder; None takes it from the environment, as all other settings.
    host : str
        Address to listen on.
    port : int
        Port to listen on, 0 to 65535; 0 takes a free one.

    Raises
    ------
    typer.Exit
        With code 2 if a setting is not allowed; the message names it.
    """
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
    serve(settings, host, port)
