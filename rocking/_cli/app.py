"""The `rocking` command.

Commands import what they need when they run, so that `rocking --help` does not load the solver, the data sets and the
unit registry. Other packages add commands by entry points of the group `rocking.commands`: the name of the command, and
a function that typer reads.
"""

from __future__ import annotations

import warnings
from importlib.metadata import EntryPoint, entry_points
from typing import Annotated, Any

import typer

from rocking._cli.fragility import fragility
from rocking._cli.pulse import boundary, history, response, spectrum
from rocking._cli.record import record

app = typer.Typer(
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    epilog="Exit codes: 0 done; 1 a package is missing; 2 an argument, a file or a row of a table is not allowed; "
    "130 interrupted.",
)


def _print_version(value: bool) -> None:
    if value:
        from rocking._base.installation import __version__

        typer.echo(__version__)
        raise typer.Exit


def _warning_line(message: Any, *_: Any, **__: Any) -> str:
    """Return a warning without the line of the source."""
    return f"warning: {message}\n"


@app.callback()
def main(
    version: Annotated[  # noqa: ARG001  # its callback prints
        bool, typer.Option("--version", help="Print the version.", callback=_print_version, is_eager=True)
    ] = False,
) -> None:
    """Rocking and overturning of free-standing rigid blocks under pulses and recorded ground motions."""
    warnings.formatwarning = _warning_line


app.command()(response)
app.command()(history)
app.command()(spectrum)
app.command()(boundary)
app.command()(record)
app.command()(fragility)


def _add_command(entry_point: EntryPoint) -> None:
    """Add the command of another package; where a package of its extra is missing, one that says so."""
    try:
        function = entry_point.load()
    except ModuleNotFoundError as error:
        reason = str(error)
    else:
        app.command(entry_point.name)(function)
        return

    @app.command(
        entry_point.name,
        help=reason.replace("[", r"\["),  # which would be markup
        context_settings={"ignore_unknown_options": True, "allow_extra_args": True},
    )
    def missing() -> None:
        typer.echo(f"rocking {entry_point.name}: {reason}", err=True)
        raise typer.Exit(1)


for _entry_point in entry_points(group="rocking.commands"):
    _add_command(_entry_point)
