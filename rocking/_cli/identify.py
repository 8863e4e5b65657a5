"""`rocking identify`: the block from a measured free rocking."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

from rocking._cli.options import OutputOptions, TraceOptions, said, with_options

if TYPE_CHECKING:
    import xarray as xr

MAX_SAMPLES = 1_000_000  # most rows of a file that are read


@with_options
def identify(
    file: Annotated[
        str,
        typer.Argument(
            help="Columns of times and rotations, named time \\[s] and rotation \\[rad], or in a stated layout.",
            metavar="FILE",
        ),
    ],
    output: OutputOptions,
    stated: TraceOptions,
    edges: Annotated[int, said("1: equal edges; 2: a right and a left edge.", "1|2")] = 1,
    confidence: Annotated[float, said("Confidence of the intervals, (0, 1).", "-")] = 0.95,
) -> None:
    """Restitution, slenderness angle and frequency parameter from a trace of free rocking, with intervals."""
    from rocking._cli import printing
    from rocking._cli.arguments import option_errors
    from rocking._cli.progress import progress

    with option_errors():
        form = printing.output_format(output)
        with progress("fitting the trace"):
            found = _found(file, stated, edges, confidence)
    columns = {name: found[name].values.tolist() for name in ("edge", *_columns())}
    if form.kind == "csv":
        printing.print_csv(columns, form)
        return
    about: dict[str, Any] = {"impacts": found.sizes["impact"]}
    about |= {name: found[name].item() for name in ("noise", "offset", "drift", "drift_lower", "drift_upper")}
    about["warnings"] = list(filter(None, found.attrs["warnings"].split("; ")))
    if form.kind == "json":
        printing.print_json({**columns, **about})
        return
    for text in about.pop("warnings"):
        typer.echo(f"warning: {text}")
    printing.print_table(columns)
    printing.print_text(about, form)


def _columns() -> list[str]:
    return [name + end for name in ("restitution", "alpha", "frequency_parameter") for end in ("", "_lower", "_upper")]


def _found(path: str, stated: TraceOptions, edges: int, confidence: float) -> xr.Dataset:
    from pathlib import Path

    from rocking._base.errors import InvalidArgumentError
    from rocking._cli.record import file_errors
    from rocking._dimensional.table_reader import read_bytes
    from rocking._evidence.free_rocking import identify_free_rocking
    from rocking._excitation.records.readers.columns import read_rotations
    from rocking._excitation.records.readers.text_file import TextFile

    with file_errors():
        file = TextFile(Path(path).name, read_bytes(path, "path"))
        time, rotation = read_rotations(file, MAX_SAMPLES, **vars(stated))
    try:
        return identify_free_rocking(time, rotation, edges=edges, confidence=confidence)
    except InvalidArgumentError as error:
        if error.parameter in ("edges", "confidence"):
            raise
        raise typer.BadParameter(str(error), param_hint="FILE") from None
