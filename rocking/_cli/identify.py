"""`rocking identify`: the block from a measured free rocking."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Annotated

import typer

from rocking._cli.options import OutputOptions, with_options

if TYPE_CHECKING:
    import xarray as xr

MAX_SAMPLES = 1_000_000
"""Most rows of a file that are read."""

Degrees = Annotated[bool, typer.Option("--degrees", help="The rotations are in degrees, not in radians.", metavar="")]
Edges = Annotated[
    int, typer.Option(help="1 for a body with equal edges, 2 for one with a right and a left edge.", metavar="[1|2]")
]


@with_options
def identify(
    file: Annotated[
        str, typer.Argument(help="Two columns of numbers: time in s, rotation in radians.", metavar="FILE")
    ],
    output: OutputOptions,
    degrees: Degrees = False,
    edges: Edges = 1,
) -> None:
    """Restitution, slenderness angle and frequency parameter from a trace of free rocking, with 95 % intervals."""
    from rocking._cli import printing
    from rocking._cli.arguments import option_errors
    from rocking._cli.progress import progress

    with option_errors():
        form = printing.output_format(output)
        with progress("fitting the trace"):
            found = _found(file, degrees, edges)
    columns = {name: found[name].values.tolist() for name in ("edge", *_columns())}
    if form.kind == "csv":
        printing.print_csv(columns, form)
        return
    about = {"impacts": found.sizes["impact"], "noise": found["noise"].item(), "offset": found["offset"].item()}
    if form.kind == "json":
        printing.print_json({**columns, **about})
        return
    printing.print_table(columns)
    printing.print_text(about, form)


def _columns() -> list[str]:
    return [name + end for name in ("restitution", "alpha", "frequency_parameter") for end in ("", "_lower", "_upper")]


def _found(path: str, degrees: bool, edges: int) -> xr.Dataset:
    from pathlib import Path

    import numpy as np

    from rocking._base.errors import InvalidArgumentError, RecordFileError
    from rocking._evidence.free_rocking import identify_free_rocking
    from rocking._excitation.records.readers.columns import read_samples
    from rocking._excitation.records.readers.lines import TextFile

    try:
        file = TextFile(Path(path).name, Path(path).read_bytes())
        _, time, rotation = read_samples(file, MAX_SAMPLES)
    except OSError as error:
        raise typer.BadParameter(f"{path}: {error.strerror}", param_hint="FILE") from None
    except RecordFileError as error:
        raise typer.BadParameter(str(error).replace("accelerations", "rotations"), param_hint="FILE") from None
    if time is None:
        raise typer.BadParameter(f"{path}: one column; expected times and rotations", param_hint="FILE")
    try:
        return identify_free_rocking(
            time, rotation * (math.pi / 180.0) if degrees else np.asarray(rotation), edges=edges
        )
    except InvalidArgumentError as error:
        if error.parameter == "edges":
            raise
        raise typer.BadParameter(str(error), param_hint="FILE") from None
