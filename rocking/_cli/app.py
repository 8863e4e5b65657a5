"""The `rocking` command: parameters as groups or with units, output as text, JSON or CSV, and the service.

This module holds the signatures only. The commands import what they need, so that `rocking --help` does not load the
solver, the data sets and the unit registry.
"""

from __future__ import annotations

import atexit
import gc
from typing import Annotated

import typer

from rocking._cli.assess import assess
from rocking._cli.floor import floor
from rocking._cli.fragility import fragility
from rocking._cli.identify import identify
from rocking._cli.options import (
    FrequencyRatioMax,
    FrequencyRatioMin,
    OutputOptions,
    ProblemOptions,
    SpectrumOptions,
    WindowOptions,
    with_options,
)
from rocking._cli.plot import plot
from rocking._cli.record import record

app = typer.Typer(
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)


def _print_version(given: bool) -> None:
    if given:
        from rocking._base.version import __version__

        typer.echo(__version__)
        raise typer.Exit


@app.callback()
def main(
    version: Annotated[  # noqa: ARG001  # its callback prints
        bool, typer.Option("--version", help="Print the version.", callback=_print_version, is_eager=True)
    ] = False,
) -> None:
    """Rocking of free-standing rigid blocks under pulse ground motion."""
    # What a short command imports remains until its end: to look for garbage among it, by default more than a thousand
    # times and once more at the end, takes a quarter of its time.
    gc.set_threshold(100_000)
    atexit.register(gc.freeze)


@app.command()
@with_options
def response(
    block: ProblemOptions,
    output: OutputOptions,
    blocks: Annotated[
        str | None,
        typer.Option(
            help="CSV file of many blocks, - for standard input; the header has units: 'width (m),height (cm),"
            "peak_acceleration (g),period (s)', optionally name and restitution. Prints CSV.",
            rich_help_panel="With units",
        ),
    ] = None,
) -> None:
    """Outcome and peak rotation of one block or of many, by the solver."""
    from rocking._cli import arguments, printing

    with arguments.option_errors():
        if blocks is None:
            form = printing.output_format(output)
            printing.response(arguments.read_params(block), form)
        else:
            form = printing.output_format(output, default="csv")
            printing.responses(arguments.read_blocks(blocks, block), form)


@app.command()
@with_options
def history(
    block: ProblemOptions,
    output: OutputOptions,
    duration: Annotated[
        str | None, typer.Option(help="Length: a number tau = p t, or a time such as 3s for a block with units.")
    ] = None,
    samples: Annotated[int, typer.Option(help="Uniform samples; the events are added.")] = 400,
    contact: Annotated[
        bool, typer.Option("--contact", help="Add reactions of the ground and friction demand.")
    ] = False,
) -> None:
    """Rotation and angular velocity of one block against time."""
    from rocking._cli import arguments, printing

    with arguments.option_errors():
        params = arguments.read_params(block)
        length = arguments.read_duration(duration, params)
        printing.history(params, length, samples, contact, printing.output_format(output))


@app.command()
@with_options
def spectrum(
    block: SpectrumOptions,
    output: OutputOptions,
    frequency_ratio_min: FrequencyRatioMin = 0.5,
    frequency_ratio_max: FrequencyRatioMax = 12.0,
    points: Annotated[int, typer.Option(help="Points, spaced evenly in the logarithm.")] = 24,
) -> None:
    """Peak rotation against the frequency ratio, or against the period."""
    from rocking._cli import arguments, printing

    with arguments.option_errors():
        params, window = arguments.read_spectrum(block, frequency_ratio_min, frequency_ratio_max)
        printing.spectrum(params, window, points, printing.output_format(output))


@app.command()
@with_options
def boundary(
    block: WindowOptions,
    output: OutputOptions,
    frequency_ratio_min: FrequencyRatioMin = 0.2,
    frequency_ratio_max: FrequencyRatioMax = 15.0,
) -> None:
    """Overturning boundary curves, traced with the solver."""
    from rocking._cli import arguments, printing

    with arguments.option_errors():
        params, window = arguments.read_boundary(block, frequency_ratio_min, frequency_ratio_max)
        printing.boundary(params, window, printing.output_format(output))


app.command()(record)
app.command()(assess)
app.command()(fragility)
app.command()(identify)
app.command()(floor)
app.add_typer(plot, name="plot")


@app.command()
def serve(
    host: Annotated[str, typer.Option(help="Address to listen on.")] = "127.0.0.1",
    port: Annotated[int, typer.Option(help="Port to listen on.", min=0, max=65535)] = 8000,
    results: Annotated[
        str | None,
        typer.Option(help="Folder that the workflow filled; ROCKING_RESULTS, or results.", show_default=False),
    ] = None,
    workers: Annotated[int, typer.Option(help="Number of processes that serve.", min=1, max=256)] = 1,
) -> None:
    """Run the HTTP service until interrupted; the routes are described under /docs."""
    from importlib.metadata import entry_points

    (entry,) = entry_points(group="rocking.commands", name="serve")
    try:
        listen = entry.load()
    except ModuleNotFoundError as error:
        typer.echo(
            f"no module {error.name}: rocking serve needs the extra `service`, pip install 'rocking[service]'", err=True
        )
        raise typer.Exit(1) from error
    listen(results, host, port, workers)
