"""`rocking floor`: the motion of a floor or above an isolation, as a file of a record."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

from rocking._cli.options import FileOptions, said, with_options
from rocking._cli.record import File, file_errors

if TYPE_CHECKING:
    from rocking._excitation.records.record import Record


@with_options
def floor(
    file: File,
    period: Annotated[list[str], said("Period of a mode, such as 0.5s; once for each mode.", "s", "--period")],
    stated: FileOptions,
    damping: Annotated[list[float], said("Damping ratio, of all modes or once for each.", "-")] = [0.05],  # noqa: B006
    participation: Annotated[  # typer reads the lists
        list[float], said("Participation factor times mode shape at the floor, of all modes or once for each.", "-")
    ] = [1.0],  # noqa: B006
) -> None:
    """Print the motion of a floor of a linear structure as CSV, a record for the other commands.

    One mode of participation 1 is a structure on an isolation. The floor has the vertical component of the ground.
    """
    from rocking._base.errors import positive
    from rocking._cli.arguments import option_errors
    from rocking._datasets.csv_text import csv_text
    from rocking._excitation.records.floor import floor_motion
    from rocking._excitation.records.readers.read_record import read_record

    with option_errors({"periods": "--period", "format": "--file-format"}), file_errors():
        periods = [positive("period", one, "s") for one in period]
        record = read_record(file, vertical=stated.vertical, **stated.stated())
        motion = floor_motion(record, periods=periods, damping=_each(damping), participation=_each(participation))
    typer.echo(csv_text(_columns(motion)), nl=False)
    typer.echo(motion.source, err=True)


def _each(values: list[float]) -> float | list[float]:
    return values[0] if len(values) == 1 else values


def _columns(motion: Record) -> dict[str, Any]:
    """Times and components, with units in the names: columns that `read_record` takes as they are."""
    vertical = {} if motion.vertical is None else {"vertical [m/s2]": motion.vertical.tolist()}
    return {"time [s]": motion.times.tolist(), "acceleration [m/s2]": motion.acceleration.tolist(), **vertical}
