"""The `rocking` command: parameters as groups or with units, output as text, JSON or CSV, and the service.

This module holds the signatures only. The commands import what they need, so that `rocking --help` does not load the
solver, the data sets and the unit registry.
"""

from __future__ import annotations

from typing import Annotated

import typer

from rocking.cli.fragility import fragility
from rocking.cli.record import record
from rocking.model.parameters import ALPHA, FREQUENCY_RATIO, RESTITUTION, SLENDERNESS
from rocking.version import __version__

app = typer.Typer(
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)

_GROUPS = "In groups"
_UNITS = "With units"

Pulse = Annotated[str, typer.Option(help="Pulse, such as sine; a leading minus mirrors it.")]
Slenderness = Annotated[float | None, typer.Option(help=f"{SLENDERNESS.help}.", rich_help_panel=_GROUPS)]
FrequencyRatio = Annotated[float | None, typer.Option(help=f"{FREQUENCY_RATIO.help}.", rich_help_panel=_GROUPS)]
Restitution = Annotated[
    str,
    typer.Option(
        help=f"{RESTITUTION.help}, {RESTITUTION.interval}; housner for a block with units: (2.4), 0 where negative."
    ),
]
Alpha = Annotated[
    str | None,
    typer.Option(help=f"{ALPHA.help}, such as '20 deg'.", rich_help_panel=_GROUPS),
]
HalfWidth = Annotated[str | None, typer.Option(help="b, such as 0.2m.", rich_help_panel=_UNITS)]
HalfHeight = Annotated[str | None, typer.Option(help="h, such as '80 cm'.", rich_help_panel=_UNITS)]
PeakAcceleration = Annotated[str | None, typer.Option(help="a_g, such as '4 m/s^2' or 0.4g.", rich_help_panel=_UNITS)]
PulsePeriod = Annotated[str | None, typer.Option(help="T_p, such as 0.5s.", rich_help_panel=_UNITS)]
FrequencyRatioMin = Annotated[float, typer.Option(help="Lower end of omega_g/p.")]
FrequencyRatioMax = Annotated[float, typer.Option(help="Upper end of omega_g/p.")]
Json = Annotated[bool, typer.Option("--json", help="Print JSON.")]
Csv = Annotated[bool, typer.Option("--csv", help="Print CSV.")]


def _print_version(given: bool) -> None:
    if given:
        typer.echo(__version__)
        raise typer.Exit


@app.callback()
def main(
    version: Annotated[
        bool, typer.Option("--version", help="Print the version.", callback=_print_version, is_eager=True)
    ] = False,
) -> None:
    """Rocking of free-standing rigid blocks under pulse ground motion."""


@app.command()
def response(
    pulse: Pulse,
    restitution: Restitution,
    slenderness: Slenderness = None,
    frequency_ratio: FrequencyRatio = None,
    alpha: Alpha = None,
    half_width: HalfWidth = None,
    half_height: HalfHeight = None,
    peak_acceleration: PeakAcceleration = None,
    pulse_period: PulsePeriod = None,
    json: Json = False,
    csv: Csv = False,
) -> None:
    """Outcome and peak rotation of one block, by the solver."""
    from rocking.cli import arguments, output

    with arguments.option_errors():
        params = arguments.read_params(
            pulse, restitution, slenderness, frequency_ratio, alpha,
            half_width, half_height, peak_acceleration, pulse_period,
        )  # fmt: skip
        output.response(params, output.output_format(json=json, csv=csv))


@app.command()
def history(
    pulse: Pulse,
    restitution: Restitution,
    slenderness: Slenderness = None,
    frequency_ratio: FrequencyRatio = None,
    alpha: Alpha = None,
    half_width: HalfWidth = None,
    half_height: HalfHeight = None,
    peak_acceleration: PeakAcceleration = None,
    pulse_period: PulsePeriod = None,
    duration: Annotated[float | None, typer.Option(help="Length in tau = p t.")] = None,
    samples: Annotated[int, typer.Option(help="Uniform samples; the events are added.")] = 400,
    contact: Annotated[
        bool, typer.Option("--contact", help="Add reactions of the ground and friction demand.")
    ] = False,
    json: Json = False,
    csv: Csv = False,
) -> None:
    """Rotation and angular velocity of one block against time."""
    from rocking.cli import arguments, output

    with arguments.option_errors():
        params = arguments.read_params(
            pulse, restitution, slenderness, frequency_ratio, alpha,
            half_width, half_height, peak_acceleration, pulse_period,
        )  # fmt: skip
        output.history(params, duration, samples, contact, output.output_format(json=json, csv=csv))


@app.command()
def spectrum(
    pulse: Pulse,
    slenderness: Annotated[float, typer.Option(help=f"{SLENDERNESS.help}.")],
    restitution: Annotated[float, typer.Option(help=f"{RESTITUTION.help}, {RESTITUTION.interval}.")],
    alpha: Alpha = None,
    frequency_ratio_min: FrequencyRatioMin = 0.5,
    frequency_ratio_max: FrequencyRatioMax = 12.0,
    points: Annotated[int, typer.Option(help="Points, spaced evenly in the logarithm.")] = 24,
    json: Json = False,
    csv: Csv = False,
) -> None:
    """Peak rotation against the frequency ratio."""
    from rocking.cli import arguments, output

    with arguments.option_errors():
        window = arguments.frequency_window(frequency_ratio_min, frequency_ratio_max)
        params = arguments.read_params(pulse, str(restitution), slenderness, window[0], alpha)
        output.spectrum(params, window, points, output.output_format(json=json, csv=csv))


@app.command()
def boundary(
    pulse: Pulse,
    restitution: Annotated[float, typer.Option(help=f"{RESTITUTION.help}, {RESTITUTION.interval}.")],
    alpha: Alpha = None,
    frequency_ratio_min: FrequencyRatioMin = 0.2,
    frequency_ratio_max: FrequencyRatioMax = 15.0,
    json: Json = False,
    csv: Csv = False,
) -> None:
    """Overturning boundary curves, traced with the solver."""
    from rocking.cli import arguments, output

    with arguments.option_errors():
        window = arguments.frequency_window(frequency_ratio_min, frequency_ratio_max)
        params = arguments.read_params(pulse, str(restitution), 1.0, window[0], alpha)
        output.boundary(params, window, output.output_format(json=json, csv=csv))


app.command()(record)
app.command()(fragility)


@app.command()
def serve(
    host: Annotated[str, typer.Option(help="Address to listen on.")] = "127.0.0.1",
    port: Annotated[int, typer.Option(help="Port to listen on.", min=0, max=65535)] = 8000,
    results: Annotated[
        str | None,
        typer.Option(help="Folder that the workflow filled; ROCKING_RESULTS, or results.", show_default=False),
    ] = None,
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
    listen(results, host, port)
