"""`rocking assess`: which of many objects the motions of a site overturn."""

from __future__ import annotations

import datetime as dt
import shlex
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rocking._cli.options import OutputOptions, with_options

if TYPE_CHECKING:
    from rocking._assessment.report import Project
    from rocking._assessment.result import Assessment
    from rocking._assessment.site import Site
    from rocking._cli.printing import Form
    from rocking._dimensional.table_reader import BadRow
    from rocking._excitation.records.record import Record

SHOWN = (
    *("object", "direction", "verdict", "factor", "governing"),
    *("uplift_acceleration", "rotation", "displacement", "friction_needed", "smallest_width"),
)
"""Columns that fit a screen; CSV, JSON and files have all of them."""

MOST = 5
"""Objects that are named beside a warning at most."""

HINTS = {"objects": "OBJECTS", "site": "--pgv", "periods": "--period-min", "pulse": "--shapes"}
"""Where a value was given, by the argument that an error names; others have the name of the option."""

Objects = Annotated[
    str, typer.Argument(help="Table of objects: CSV, JSON, XLSX or ODS, with units in its header or in its cells.")
]
Pga = Annotated[str | None, typer.Option(help="Peak ground acceleration, such as 0.3g; records are scaled to it.")]
Pgv = Annotated[str | None, typer.Option(help="Peak ground velocity, such as '0.3 m/s': each pulse has this one.")]
PeriodMin = Annotated[str | None, typer.Option(help="In place of PGV: shortest period of the pulses, such as 0.2s.")]
PeriodMax = Annotated[str | None, typer.Option(help="Longest period of the pulses, such as 1s.")]
Records = Annotated[list[str] | None, typer.Option("--record", help="Accelerogram of the suite; may be repeated.")]
Unit = Annotated[str | None, typer.Option(help="Unit of the records if their files state none.")]
TimeStep = Annotated[str | None, typer.Option(help="Time step of the records if their files state none.")]
Shapes = Annotated[
    str | None,
    typer.Option(help="Pulses, such as sine,ricker; by default all by name that leave the ground at rest."),
]
MovingGround = Annotated[
    bool, typer.Option("--moving-ground", help="Also pulses that leave the ground moving: half sine, rectangular.")
]
Sensitivity = Annotated[
    bool,
    typer.Option(
        "--sensitivity/--no-sensitivity",
        help="Whether to find the factors of changed objects and the sizes that are not overturned.",
    ),
]
Output = Annotated[str | None, typer.Option("--output", "-o", help="CSV file to write, with all columns.")]


Report = Annotated[str | None, typer.Option(help="HTML file to write: verdicts, drawings, inputs; prints on A4.")]
Title = Annotated[str, typer.Option(help="Title of the report.")]
Place = Annotated[str, typer.Option("--site", help="Name of the site in the report.")]
Date = Annotated[str | None, typer.Option(help="Date of the report; by default today.")]


@with_options
def assess(
    objects: Objects,
    form: OutputOptions,
    pga: Pga = None,
    pgv: Pgv = None,
    period_min: PeriodMin = None,
    period_max: PeriodMax = None,
    record: Records = None,
    unit: Unit = None,
    time_step: TimeStep = None,
    shapes: Shapes = None,
    moving_ground: MovingGround = False,
    sensitivity: Sensitivity = True,
    output: Output = None,
    report: Report = None,
    title: Title = "Assessment of free-standing objects",
    place: Place = "",
    date: Date = None,
) -> None:
    """Which objects the motions of a site overturn, from which factor on these motions, the worst first.

    Rows of the table that cannot be read are named at the end, and the exit code is 2; the others are assessed.
    """
    from rocking._assessment.assess import assess as assess_objects
    from rocking._assessment.report import Project
    from rocking._assessment.site import Site
    from rocking._assessment.tables import read_objects
    from rocking._base.errors import InvalidArgumentError
    from rocking._cli import printing
    from rocking._cli.arguments import option_errors
    from rocking._cli.progress import progress
    from rocking._cli.record import file_errors

    with option_errors(HINTS), file_errors():
        kind = printing.output_format(form)
        if (period_min is None) != (period_max is None):
            missing = "period_min" if period_min is None else "period_max"
            raise InvalidArgumentError(missing, None, "the shortest and the longest period")
        periods = None if period_min is None or period_max is None else (period_min, period_max)
        names = None if shapes is None else shapes.split(",")
        site = Site(pga, pgv, periods, _read(record or (), unit, time_step), None, names, moving_ground)
        table = read_objects(objects)
        bad = [f"{objects}, {printing.printable(str(one))}" for one in table.bad_rows]
        if not table.objects:
            raise InvalidArgumentError("objects", objects, "\n".join(["a table with one object or more", *bad]))
        with progress(f"assessing {len(table.objects)} objects"):
            found = assess_objects(table.objects, site, sensitivity=sensitivity)
        if output is not None:
            _write("output", output, found.to_csv(bad_rows=table.bad_rows))
        if report is not None:
            day = date or dt.datetime.now().astimezone().date().isoformat()
            project = Project(title, place, day, shlex.join(["rocking", *sys.argv[1:]]))
            _write("report", report, _html(found, site, project, table.bad_rows))
    _print(found, kind, bad)
    if bad:
        typer.echo("\n".join(bad), err=True)
        raise typer.Exit(2)


def _read(paths: Sequence[str], unit: str | None, time_step: str | None) -> list[Record]:
    """The records of a suite."""
    from rocking._excitation.records.readers.read_record import read_record

    return [read_record(path, unit=unit, time_step=time_step) for path in paths]


def _html(found: Assessment, site: Site, project: Project, bad_rows: Sequence[BadRow]) -> str:
    """The report."""
    from rocking._assessment.report import report_html
    from rocking._base.errors import InvalidArgumentError

    try:
        return report_html(found, site, project, bad_rows)
    except ModuleNotFoundError as error:
        raise InvalidArgumentError(
            "report", error.name, "with the extra `report`: pip install 'rocking[report]'"
        ) from None


def _write(option: str, path: str, text: str) -> None:
    """Write a file.

    Raises
    ------
    InvalidArgumentError
        If that is not possible.
    """
    from rocking._base.errors import InvalidArgumentError

    try:
        Path(path).write_text(text, encoding="utf-8", newline="")
    except OSError as error:
        raise InvalidArgumentError(option, path, f"a file that can be written ({error.strerror})") from None


def _print(found: Assessment, form: Form, bad: list[str]) -> None:
    """Print the table, and below it the objects to which each warning applies."""
    from rocking._assessment.columns import OUTPUTS
    from rocking._cli import printing

    rows = found.rows
    columns = {one.name: [row[one.name] for row in rows] for one in OUTPUTS}
    units = {one.name: one.unit for one in OUTPUTS if one.label != one.name}
    if form.kind == "json":
        printing.print_json(columns | {"motions": found.motions, "bad_rows": bad})
        return
    if form.kind == "csv":
        printing.print_csv(columns, form, units)
        return
    printing.print_table({name: columns[name] for name in SHOWN}, units)
    concerned: dict[str, list[str]] = {}
    for row in rows:
        for text in filter(None, row["warnings"].split("; ")):
            concerned.setdefault(text, []).append(f"{row['object']} ({row['direction']})")
    for text, names in concerned.items():
        more = f" and {len(names) - MOST} more" if len(names) > MOST else ""
        typer.echo(f"warning: {text}: {printing.printable(', '.join(names[:MOST]))}{more}")
