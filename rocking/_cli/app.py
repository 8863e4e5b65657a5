"""The `rocking` command: parameters as groups or with units, output as text, JSON or CSV, and the service.

This module holds the signatures only. The commands import what they need, so that `rocking --help` does not load the
solver, the data sets and the unit registry. Other packages add commands by entry points of the group
`rocking.commands`: the name of the command, and a function that typer reads.
"""

from __future__ import annotations

import atexit
import gc
import os
import sys
import warnings
from contextlib import suppress
from importlib.metadata import EntryPoint, entry_points
from typing import Annotated, Any

import typer
from typer.core import TyperGroup

from rocking._cli import options
from rocking._cli.floor import floor
from rocking._cli.fragility import fragility
from rocking._cli.plot import plot
from rocking._cli.record import record

UsageError: Any = typer.BadParameter.__mro__[1]
"""What typer raises for arguments that it does not understand; newer versions bring their own copy of click."""


def _added_commands() -> dict[str, EntryPoint]:
    """Return the commands that other packages add, by name."""
    return {entry_point.name: entry_point for entry_point in entry_points(group="rocking.commands")}


def _load_command(entry_point: EntryPoint) -> Any:
    """Return the command of an entry point; where a package of its extra is missing, one that says so."""
    single = typer.Typer(add_completion=False, pretty_exceptions_enable=False)
    try:
        function = entry_point.load()
    except ModuleNotFoundError as error:
        reason = str(error)

        def function() -> None:
            typer.echo(f"rocking {entry_point.name}: {reason}", err=True)
            raise typer.Exit(1)

        single.command(
            entry_point.name,
            help=reason.replace("[", r"\["),  # which would be markup
            context_settings={"ignore_unknown_options": True, "allow_extra_args": True},
        )(function)
    else:
        single.command(entry_point.name)(function)
    return typer.main.get_command(single)


class Commands(TyperGroup):
    """The commands, and those of other packages; what is wrong with an argument is printed in a line of its own."""

    def list_commands(self, ctx: Any) -> list[str]:
        """Return the names of the commands, those of other packages last."""
        return [*super().list_commands(ctx), *_added_commands()]

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        """Return a command; that of another package is loaded here."""
        command = super().get_command(ctx, cmd_name)
        if command is not None:
            return command
        entry_point = _added_commands().get(cmd_name)
        return None if entry_point is None else _load_command(entry_point)

    def main(self, *args: Any, **extra: Any) -> Any:
        """Run the command of the arguments."""
        if not extra.get("standalone_mode", True):
            return super().main(*args, **extra)
        extra["standalone_mode"] = False
        warnings.formatwarning = lambda message, *_: f"warning: {message}\n"  # without a line of the source
        try:
            status = super().main(*args, **extra) or 0
            sys.stdout.flush()
            sys.exit(status)
        except UsageError as error:
            command = error.ctx.command_path if error.ctx else "rocking"
            message = error.format_message().replace("Value error, ", "")  # what newer versions of typer put before it
            if message:  # no command: the help was printed
                typer.echo(f"{command}: {message}", err=True)
            sys.exit(error.exit_code)
        except ImportError as error:  # a package of an extra
            typer.echo(f"rocking: {error}", err=True)
            sys.exit(1)
        except OSError as error:  # commands convert the errors of the files that they read and write
            _discard_output()
            if not isinstance(error, BrokenPipeError):  # a reader that has enough needs no message
                typer.echo(f"rocking: {error.filename or 'standard output'}: {error.strerror or error}", err=True)
            sys.exit(1)


def _discard_output() -> None:
    """Send what standard output still holds to nowhere; at the end Python would try to write it, and fail again."""
    with suppress(OSError, ValueError):  # standard output without a file
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, sys.stdout.fileno())


app = typer.Typer(
    cls=Commands,
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    epilog="Exit codes: 0 done; 1 a package is missing, or the output was closed or could not be written; 2 an "
    "argument, a file or a row of a table is not allowed; 130 interrupted.",
)


def _print_version(given: bool) -> None:
    if given:
        from rocking._base.installation import __version__

        typer.echo(__version__)
        raise typer.Exit


@app.callback()
def main(
    version: Annotated[  # noqa: ARG001  # its callback prints
        bool, typer.Option("--version", help="Print the version.", callback=_print_version, is_eager=True, metavar="")
    ] = False,
) -> None:
    """Rocking and overturning of free-standing rigid blocks under pulses and recorded ground motions."""
    # What a short command imports remains until its end: to look for garbage among it, by default more than a thousand
    # times and once more at the end, takes a quarter of its time.
    gc.set_threshold(100_000)
    atexit.register(gc.freeze)


@app.command()
@options.with_options
def response(
    block: options.ProblemOptions,
    output: options.OutputOptions,
    file: Annotated[
        str | None,
        typer.Argument(
            help="Table of many bodies: CSV, XLSX or ODS, - for standard input; columns width, height or those of "
            "another kind, peak_acceleration, period, optionally name and restitution; units in header or cells.",
            metavar="FILE",
        ),
    ] = None,
    column: Annotated[
        list[str] | None,
        options.said('Header of a column: "Breite (cm)=width [cm]"; may be repeated.', "HEADER=NAME", "--columns"),
    ] = None,
    decimal: Annotated[str, options.said("Decimal sign of the table, a point or a comma.", "SIGN")] = ".",
    delimiter: Annotated[str | None, options.said("Sign between the cells of the table.", "SIGN")] = None,
    skip: Annotated[int, options.said("Lines above the header of the table.", "NUMBER")] = 0,
    sheet: Annotated[str | None, options.said("Sheet of a workbook, where several hold cells.", "NAME")] = None,
    allow_unusual: Annotated[
        bool, options.said("Read bodies below 1 cm or above 50 m.", "", "--allow-unusual")
    ] = False,
) -> None:
    """Outcome and peak rotation of one block or of the blocks of a table, by the solver.

    Rows of a table that cannot be read are named at the end, and the exit code is 2; the others are solved.
    """
    from rocking._cli import arguments, printing
    from rocking._cli.record import file_errors

    with arguments.option_errors({"blocks": "FILE"}), file_errors():
        if file is None:
            form = printing.output_format(output, block)
            printing.response(arguments.read_params(block), form)
            return
        table = arguments.read_blocks(
            file,
            block,
            columns=column,
            decimal=decimal,
            delimiter=delimiter,
            skip=skip,
            sheet=sheet,
            allow_unusual=allow_unusual,
        )
        printing.responses(table, printing.output_format(output, block, table.read.units))
    bad = [f"{file}, {printing.printable(str(one))}" for one in table.read.bad_rows]
    if bad:
        typer.echo("\n".join(bad), err=True)
        raise typer.Exit(2)


@app.command()
@options.with_options
def history(
    block: options.HistoryOptions,
    output: options.OutputOptions,
    duration: options.Duration = None,
    samples: Annotated[int, options.said("Number of uniform samples; the events are added.", "NUMBER")] = 400,
    contact: Annotated[bool, options.said("Add reactions of the ground and friction demand.", "", "--contact")] = False,
) -> None:
    """Rotation and angular velocity of one block against time, under a pulse or released from a rotation."""
    from rocking._base.errors import InvalidArgumentError
    from rocking._cli import arguments, printing

    with arguments.option_errors({"motion": "--pulse"}):
        form = printing.output_format(output, block)
        if block.start is not None:
            printing.released(block, duration, samples, contact, form)
            return
        if not block.pulse:
            raise InvalidArgumentError("pulse", None, "a pulse, or --start, the rotation of a release")
        params = arguments.read_params(block)
        printing.history(params, arguments.read_duration(duration, params), samples, contact, form)


@app.command()
@options.with_options
def spectrum(
    block: options.SpectrumOptions,
    output: options.OutputOptions,
    points: Annotated[int, options.said("Number of points, spaced evenly in the logarithm.", "NUMBER")] = 24,
) -> None:
    """Peak rotation against the frequency ratio, or against the period."""
    from rocking._cli import arguments, printing

    with arguments.option_errors():
        params, window = arguments.read_spectrum(block, (0.5, 12.0))
        printing.spectrum(params, window, points, printing.output_format(output, block))


@app.command()
@options.with_options
def boundary(block: options.WindowOptions, output: options.OutputOptions) -> None:
    """Overturning boundary curves, traced with the solver."""
    from rocking._cli import arguments, printing

    with arguments.option_errors():
        params, window = arguments.read_boundary(block, (0.2, 15.0))
        printing.boundary(params, window, printing.output_format(output, block))


@app.command()
@options.with_options
def pulses(output: options.OutputOptions) -> None:
    """Names of pulses, with their durations in periods."""
    import math

    from rocking._cli import printing
    from rocking._excitation import pulses as module

    made = [module.as_pulse(name) for name in module.PULSE_NAMES]
    columns: dict[str, list[Any]] = {
        "pulse": [one.name for one in made],
        "periods": [(one.end - one.start) / (2.0 * math.pi) for one in made],
        "description": [(getattr(module, name).__doc__ or "").partition("\n")[0] for name in module.PULSE_NAMES],
    }
    printing.print_columns(columns, printing.output_format(output))


@app.command()
@options.with_options
def units(output: options.OutputOptions) -> None:
    """Names of units, for options and tables. Case, blanks and signs of a power do not matter."""
    from rocking._base.units import EXAMPLES, UNITS
    from rocking._cli import printing

    known = {unit: list(names) for unit, names in UNITS.items()}
    columns: dict[str, list[Any]] = {
        "si_unit": list(known),
        "units": list(known.values()),
        "examples": [EXAMPLES.get(unit, "85 %") for unit in known],
    }
    printing.print_columns(columns, printing.output_format(output))


app.command()(record)
app.command()(fragility)
app.command()(floor)
app.add_typer(plot, name="plot")
