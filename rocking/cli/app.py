"""The `rocking` command: questions in groups or in units, answers as text, JSON or CSV, and the service.

Only signatures stand here. The work is imported inside the commands, so that `rocking --help` does not wait for the
solver, the data sets and the unit registry.
"""

from __future__ import annotations

from typing import Annotated, Any

import typer

app = typer.Typer(
    help="Rocking of free-standing rigid blocks under pulse ground motion.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)

_GROUPS = "In groups"
_UNITS = "With units"

Pulse = Annotated[str, typer.Option(help="Pulse, such as sine; a leading minus mirrors it.")]
Slenderness = Annotated[float | None, typer.Option(help="g tan(alpha)/a_g = 1/a.", rich_help_panel=_GROUPS)]
FrequencyRatio = Annotated[float | None, typer.Option(help="omega_g/p.", rich_help_panel=_GROUPS)]
Restitution = Annotated[
    str, typer.Option(help="Coefficient eta in [0, 1]; housner for a block with units: (2.4), 0 where negative.")
]
Alpha = Annotated[
    str | None,
    typer.Option(help="Slenderness angle, such as '20 deg'; absent: the slender limit.", rich_help_panel=_GROUPS),
]
HalfWidth = Annotated[str | None, typer.Option(help="b, such as 0.2m.", rich_help_panel=_UNITS)]
HalfHeight = Annotated[str | None, typer.Option(help="h, such as '80 cm'.", rich_help_panel=_UNITS)]
PeakAcceleration = Annotated[str | None, typer.Option(help="a_g, such as '4 m/s^2' or 0.4g.", rich_help_panel=_UNITS)]
PulsePeriod = Annotated[str | None, typer.Option(help="T_p, such as 0.5s.", rich_help_panel=_UNITS)]
FrequencyRatioMin = Annotated[float, typer.Option(help="Lower end of omega_g/p.")]
FrequencyRatioMax = Annotated[float, typer.Option(help="Upper end of omega_g/p.")]
Json = Annotated[bool, typer.Option("--json", help="Answer as JSON.")]
Csv = Annotated[bool, typer.Option("--csv", help="Answer as CSV.")]


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
    """Fate and peak rotation of one block, by the solver."""
    from rocking import cli_answers, cli_question

    with cli_question.refusals():
        question = cli_question.read(
            pulse, restitution, slenderness, frequency_ratio, alpha,
            half_width, half_height, peak_acceleration, pulse_period,
        )  # fmt: skip
        cli_answers.response(question, cli_answers.form(json=json, csv=csv))


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
    from rocking import cli_answers, cli_question

    with cli_question.refusals():
        question = cli_question.read(
            pulse, restitution, slenderness, frequency_ratio, alpha,
            half_width, half_height, peak_acceleration, pulse_period,
        )  # fmt: skip
        cli_answers.history(question, duration, samples, contact, cli_answers.form(json=json, csv=csv))


@app.command()
def spectrum(
    pulse: Pulse,
    slenderness: Annotated[float, typer.Option(help="g tan(alpha)/a_g = 1/a.")],
    restitution: Annotated[float, typer.Option(help="Coefficient eta in [0, 1].")],
    alpha: Alpha = None,
    frequency_ratio_min: FrequencyRatioMin = 0.5,
    frequency_ratio_max: FrequencyRatioMax = 12.0,
    points: Annotated[int, typer.Option(help="Points, spaced evenly in the logarithm.")] = 24,
    json: Json = False,
    csv: Csv = False,
) -> None:
    """Peak rotation against the frequency ratio."""
    from rocking import cli_answers, cli_question

    with cli_question.refusals():
        window = cli_question.window(frequency_ratio_min, frequency_ratio_max)
        question = cli_question.read(pulse, str(restitution), slenderness, window[0], alpha)
        cli_answers.spectrum(question, window, points, cli_answers.form(json=json, csv=csv))


@app.command()
def boundary(
    pulse: Pulse,
    restitution: Annotated[float, typer.Option(help="Coefficient eta in [0, 1].")],
    alpha: Alpha = None,
    frequency_ratio_min: FrequencyRatioMin = 0.2,
    frequency_ratio_max: FrequencyRatioMax = 15.0,
    json: Json = False,
    csv: Csv = False,
) -> None:
    """The curves that separate standing from falling, traced."""
    from rocking import cli_answers, cli_question

    with cli_question.refusals():
        window = cli_question.window(frequency_ratio_min, frequency_ratio_max)
        question = cli_question.read(pulse, str(restitution), 1.0, window[0], alpha)
        cli_answers.boundary(question, window, cli_answers.form(json=json, csv=csv))


@app.command()
def serve(
    host: Annotated[str, typer.Option(help="Address to listen on.")] = "127.0.0.1",
    port: Annotated[int, typer.Option(help="Port to listen on.", min=0, max=65535)] = 8000,
    results: Annotated[
        str | None,
        typer.Option(help="Folder that the workflow filled; ROCKING_RESULTS, or results.", show_default=False),
    ] = None,
) -> None:
    """Answer over HTTP until interrupted; the routes are described under /docs."""
    from pydantic import ValidationError
    from rocking_api.server import serve as listen
    from rocking_api.settings import Settings

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
    listen(settings, host, port)


if __name__ == "__main__":
    app()
