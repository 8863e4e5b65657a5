"""`rocking response`, `history`, `spectrum` and `boundary`: one body, or those of a table, under pulses."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rocking._base.quantities import START
from rocking._cli.errors import reported_errors
from rocking._cli.parameters import (
    MOTION,
    Body,
    Height,
    OutputFormat,
    PeakAcceleration,
    Period,
    PeriodMax,
    PeriodMin,
    Pulse,
    Restitution,
    Sheet,
    TableColumns,
    TableDecimal,
    TableDelimiter,
    TableSkip,
    Width,
)

if TYPE_CHECKING:
    from rocking._dimensional.body import RespondingBody
    from rocking._dimensional.table import BlockTable


def response(
    pulse: Pulse,
    file: Annotated[
        str | None,
        typer.Argument(
            help="Table of many bodies: CSV, XLSX or ODS, - for standard input; columns width, height or those of "
            "another kind, peak_acceleration, period, optionally name and restitution; units in header or cells.",
            metavar="FILE",
        ),
    ] = None,
    width: Width = None,
    height: Height = None,
    body: Body = None,
    restitution: Restitution = "momentum",
    peak_acceleration: PeakAcceleration = None,
    period: Period = None,
    columns: TableColumns = None,
    decimal: TableDecimal = ".",
    delimiter: TableDelimiter = None,
    skip: TableSkip = 0,
    sheet: Sheet = None,
    allow_unusual: Annotated[
        bool, typer.Option("--allow-unusual", help="Read bodies of a table below 1 cm or above 50 m.")
    ] = False,
    output_format: OutputFormat = "table",
) -> None:
    """Outcome and peak rotation of one body or of the bodies of a table under a pulse.

    Rows of a table that cannot be read are named at the end, and the exit code is 2; the others are solved.
    """
    from rocking._base.errors import reject_given
    from rocking._base.quantities import PEAK_ACCELERATION, PERIOD, RESTITUTION
    from rocking._cli.arguments import read_body, read_pulse
    from rocking._cli.printing import print_response, progress, response_values
    from rocking._dimensional.table import read_blocks
    from rocking._dimensional.table_reader import TableLayout, stated_columns

    with reported_errors({"blocks": "FILE"}):
        motion, eta = read_pulse(pulse), RESTITUTION.read(restitution)
        if file is not None:
            reject_given("a table, which has the bodies", width=width, height=height, body=body)
            strength = {}
            if peak_acceleration is not None:
                strength["peak_acceleration"] = PEAK_ACCELERATION.number(peak_acceleration)
            if period is not None:
                strength["period"] = PERIOD.number(period)
            layout = TableLayout(
                columns=stated_columns(columns or []),
                decimal=decimal,
                delimiter=delimiter,
                skip=skip,
                sheet=sheet,
                allow_unusual=allow_unusual,
            )
            _print_responses(file, read_blocks(file, motion, eta, **strength, layout=layout), output_format)
            return
        block = read_body(width, height, body)
        with progress("solving the body"):
            solved = block.response(
                motion, peak_acceleration=peak_acceleration, period=period, restitution=eta, error_bound=True
            )
            values = response_values(solved)
    print_response(solved, values, output_format)


def _print_responses(file: str, table: BlockTable, output_format: str) -> None:
    """Print the responses of the rows of a table, then the rows that could not be read.

    CSV has the columns of the table as they stand, and those of the responses; a table for people the names, and what
    every response has.
    """
    from rocking._cli.printing import print_columns, print_json, printable, progress, unit_label
    from rocking._dimensional.fields import FIELDS
    from rocking._dimensional.table import respond_table
    from rocking._model.fields import KINDS

    with progress(f"solving {len(table.problems)} bodies"):
        responses = respond_table(table)
    read = table.read
    units = {field.label: unit_label(field.label_unit) for field in FIELDS}
    if output_format == "json":
        bad_rows = [{"row": bad.row, "reasons": bad.reasons, "cells": bad.cells} for bad in read.bad_rows]
        print_json({**responses, "table": read.cells, "bad_rows": bad_rows})
    elif output_format == "csv":
        column_names = {header.partition(" [")[0] for header in read.columns.values()}
        results = {name: values for name, values in responses.items() if name not in column_names}
        headers = {f"{name} [{units[name]}]" if units.get(name) else name for name in results}
        cells = {f"{label} (given)" if label in headers else label: values for label, values in read.cells.items()}
        print_columns(cells | results, "csv", units)
    else:
        names = {"name": table.names} if table.names else {}
        shared = {field.label: responses[field.label] for field in FIELDS if field.kinds == KINDS}
        print_columns(names | shared, "table", units)
    if read.bad_rows:
        typer.echo("\n".join(f"{file}, {printable(str(row))}" for row in read.bad_rows), err=True)
        raise typer.Exit(2)


def history(
    pulse: Pulse = "",
    start: Annotated[str | None, typer.Option(help=START.sentence, metavar="[rad]", rich_help_panel=MOTION)] = None,
    width: Width = None,
    height: Height = None,
    body: Body = None,
    restitution: Restitution = "momentum",
    peak_acceleration: PeakAcceleration = None,
    period: Period = None,
    duration: Annotated[str | None, typer.Option(help="Length, such as 3s.", metavar="[s]")] = None,
    samples: Annotated[
        int | None,
        typer.Option(help="Number of uniform samples, 400 by default; the events are added.", metavar="[NUMBER]"),
    ] = None,
    contact: Annotated[
        bool, typer.Option("--contact", help="Add reactions of the ground and friction demand.")
    ] = False,
    output_format: OutputFormat = "table",
) -> None:
    """Rotation and angular velocity of one body against time, under a pulse or released from a rotation."""
    from rocking._base.errors import InvalidArgumentError
    from rocking._base.quantities import RESTITUTION
    from rocking._cli.arguments import read_body, read_pulse
    from rocking._cli.printing import print_dataset, progress

    with reported_errors({"motion": "--pulse"}):
        if not pulse and start is None:
            raise InvalidArgumentError("pulse", None, "a pulse, or --start, the rotation of a release")
        block = read_body(width, height, body)
        with progress("solving the motion"):
            solved = block.history(
                read_pulse(pulse) if pulse else None,
                start=start,
                peak_acceleration=peak_acceleration,
                period=period,
                restitution=RESTITUTION.read(restitution),
                duration=duration,
                samples=samples,
                contact=contact,
            )
    print_dataset(solved, "time", output_format)


def spectrum(
    pulse: Pulse,
    width: Width = None,
    height: Height = None,
    body: Body = None,
    restitution: Restitution = "momentum",
    peak_acceleration: PeakAcceleration = None,
    period_min: PeriodMin = None,
    period_max: PeriodMax = None,
    points: Annotated[
        int,
        typer.Option(
            help="Number of periods, spaced evenly in the logarithm.", metavar="[NUMBER]", min=2, max=1_000_000
        ),
    ] = 24,
    output_format: OutputFormat = "table",
) -> None:
    """Peak rotation against the period of the pulse; without a window of periods for omega_g/p from 0.5 to 12."""
    import numpy as np

    from rocking._base.quantities import RESTITUTION
    from rocking._cli.arguments import read_body, read_pulse
    from rocking._cli.printing import print_dataset, progress

    with reported_errors():
        motion, block = read_pulse(pulse), read_body(width, height, body)
        shortest, longest = _window(block, period_min, period_max, (0.5, 12.0))
        periods = np.geomspace(shortest, longest, points)
        with progress(f"solving {points} bodies"):
            solved = block.spectrum(
                motion, peak_acceleration=peak_acceleration, period=periods, restitution=RESTITUTION.read(restitution)
            )
    print_dataset(solved, "period", output_format)


def boundary(
    pulse: Pulse,
    width: Width = None,
    height: Height = None,
    body: Body = None,
    restitution: Restitution = "momentum",
    period_min: PeriodMin = None,
    period_max: PeriodMax = None,
    output_format: OutputFormat = "table",
) -> None:
    """Curves of peak acceleration against period at which the outcome changes.

    Without a window of periods for omega_g/p from 0.2 to 15.
    """
    from rocking._base.quantities import RESTITUTION
    from rocking._boundary.curves import points_of
    from rocking._cli.arguments import read_body, read_pulse
    from rocking._cli.printing import print_columns, progress

    with reported_errors():
        motion, block = read_pulse(pulse), read_body(width, height, body)
        window = _window(block, period_min, period_max, (0.2, 15.0))
        with progress("tracing the boundaries"):
            solved = block.boundary(motion, restitution=RESTITUTION.read(restitution), period=window)
    points = points_of(solved)
    axes = {name: solved[name].values.tolist() for name in ("period", "peak_acceleration")}
    columns = {"curve": points.pop("curve"), **axes, **points}
    print_columns(columns, output_format, {"period": "s", "peak_acceleration": "m/s2"})


def _window(
    body: RespondingBody, period_min: str | None, period_max: str | None, frequency_ratios: tuple[float, float]
) -> tuple[float, float]:
    """Return the shortest and the longest period [s]; an end that is not stated is that of the frequency ratios [-]."""
    from rocking._base.quantities import PERIOD
    from rocking._model.checks import check_window

    unit = 2.0 * math.pi / float(body.right.frequency_parameter)  # period at frequency ratio 1 [s]
    lowest, highest = frequency_ratios
    low: Any = unit / highest if period_min is None else period_min
    high: Any = unit / lowest if period_max is None else period_max
    return check_window(PERIOD, low, high)
