"""`rocking identify`: the block from a measured free rocking."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

from rocking.extension import TIME_STEP, OutputOptions, option, said, with_options

if TYPE_CHECKING:
    import xarray as xr

MAX_SAMPLES = 1_000_000  # most rows of a file that are read


@with_options
def identify(
    file: Annotated[
        str,
        typer.Argument(
            help="Two columns of numbers: times in s and rotations in radians, or in the units of the header.",
            metavar="FILE",
        ),
    ],
    output: OutputOptions,
    degrees: Annotated[bool, said("Rotations are in degrees if the header states no unit.", "", "--degrees")] = False,
    time_step: Annotated[
        str | None, option(TIME_STEP, text="Time between the rows if the file only counts them")
    ] = None,
    edges: Annotated[int, said("1: equal edges; 2: a right and a left edge.", "1|2")] = 1,
    confidence: Annotated[float, said("Confidence of the intervals, (0, 1).", "-")] = 0.95,
) -> None:
    """Restitution, slenderness angle and frequency parameter from a trace of free rocking, with intervals."""
    from rocking.extension import option_errors, output_format, print_csv, print_json, print_table, print_text, progress

    with option_errors():
        form = output_format(output)
        with progress("fitting the trace"):
            found = _found(file, degrees, time_step, edges, confidence)
    columns = {name: found[name].values.tolist() for name in ("edge", *_columns())}
    if form.kind == "csv":
        print_csv(columns, form)
        return
    about: dict[str, Any] = {"impacts": found.sizes["impact"]}
    about |= {name: found[name].item() for name in ("noise", "offset", "drift", "drift_lower", "drift_upper")}
    about["warnings"] = list(filter(None, found.attrs["warnings"].split("; ")))
    if form.kind == "json":
        print_json({**columns, **about})
        return
    for text in about.pop("warnings"):
        typer.echo(f"warning: {text}")
    print_table(columns)
    print_text(about, form)


def _columns() -> list[str]:
    return [name + end for name in ("restitution", "alpha", "frequency_parameter") for end in ("", "_lower", "_upper")]


def _found(path: str, degrees: bool, time_step: str | None, edges: int, confidence: float) -> xr.Dataset:
    from pathlib import Path

    from rocking.extension import InvalidArgumentError, TextFile, file_errors, read_bytes, read_rotations
    from rocking_assessment._evidence.free_rocking import identify_free_rocking

    step = None if time_step is None else TIME_STEP.number(TIME_STEP.read(time_step))
    with file_errors():
        file = TextFile(Path(path).name, read_bytes(path, "path"))
        time, rotation = read_rotations(file, MAX_SAMPLES, degrees or None, step)
    try:
        return identify_free_rocking(time, rotation, edges=edges, confidence=confidence)
    except InvalidArgumentError as error:
        if error.parameter in ("edges", "confidence"):
            raise
        raise typer.BadParameter(str(error), param_hint="FILE") from None
