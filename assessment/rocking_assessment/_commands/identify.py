"""`rocking identify`: the block from a measured free rocking."""

from __future__ import annotations

from typing import Annotated, Any

import typer

from rocking.extension import (
    Decimal,
    Delimiter,
    OutputFormat,
    Rotation,
    Skip,
    Time,
    TimeStep,
    TimeUnit,
    Unit,
    reported_errors,
)

MAX_SAMPLES = 1_000_000  # most rows of a file that are read

IDENTIFIED = ("restitution", "alpha", "frequency_parameter")


def identify(
    file: Annotated[
        str,
        typer.Argument(
            help="Columns of times and rotations, named time \\[s] and rotation \\[rad], or in a stated layout.",
            metavar="FILE",
        ),
    ],
    rotation: Rotation = None,
    time: Time = None,
    time_step: TimeStep = None,
    time_unit: TimeUnit = None,
    unit: Unit = None,
    skip: Skip = 0,
    delimiter: Delimiter = None,
    decimal: Decimal = ".",
    edges: Annotated[int, typer.Option(help="1: equal edges; 2: a right and a left edge.", metavar="[1|2]")] = 1,
    confidence: Annotated[float, typer.Option(help="Confidence of the intervals, (0, 1).", metavar="[-]")] = 0.95,
    output_format: OutputFormat = "table",
) -> None:
    """Restitution, slenderness angle and frequency parameter from a trace of free rocking, with intervals."""
    from pathlib import Path

    from rocking.extension import (
        TextFile,
        print_csv,
        print_json,
        print_table,
        print_values,
        progress,
        read_bytes,
        read_rotations,
        unit_label,
    )
    from rocking_assessment._evidence.free_rocking import identify_free_rocking

    with reported_errors():
        times, rotations = read_rotations(
            TextFile(Path(file).name, read_bytes(file, "path")),
            MAX_SAMPLES,
            rotation=rotation,
            time=time,
            time_step=time_step,
            time_unit=time_unit,
            unit=unit,
            skip=skip,
            delimiter=delimiter,
            decimal=decimal,
        )
    with reported_errors({"time": "FILE", "rotation": "FILE"}), progress("fitting the trace"):
        fit = identify_free_rocking(times, rotations, edges=edges, confidence=confidence)
    names = ["edge"]
    for name in IDENTIFIED:
        names += [name, f"{name}_lower", f"{name}_upper"]
    scalars = ["noise", "offset", "drift", "drift_lower", "drift_upper"]
    columns = {name: fit[name].values.tolist() for name in names}
    units = {name: unit_label(fit[name].attrs.get("units", "")) for name in (*names, *scalars)}
    if output_format == "csv":
        print_csv(columns, units)
        return
    values: dict[str, Any] = {"impacts": fit.sizes["impact"]} | {name: fit[name].item() for name in scalars}
    warnings = list(filter(None, fit.attrs["warnings"].split("; ")))
    if output_format == "json":
        print_json({**columns, **values, "warnings": warnings})
        return
    for text in warnings:
        typer.echo(f"warning: {text}")
    print_table(columns, units)
    print_values(values, units)
