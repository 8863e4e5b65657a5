"""`rocking assess`: which of many objects the motions of a site overturn."""

from __future__ import annotations

import datetime as dt
import shlex
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

from rocking.extension import (
    LAYOUT,
    Acceleration,
    BaselineOrder,
    FileFormat,
    OutputFormat,
    Sheet,
    TableColumns,
    TableDecimal,
    TableDelimiter,
    TableSkip,
    Time,
    TimeStep,
    TimeUnit,
    Unit,
    Wrapped,
    reported_errors,
)
from rocking_assessment._objects.columns import CLAUSES, INPUTS, SHAPES

if TYPE_CHECKING:
    from rocking.extension import Record
    from rocking_assessment._objects.result import Assessment
    from rocking_assessment._objects.tables import ObjectTable

ARGUMENTS = {
    "records": "--pair",
    "objects": "OBJECTS",
    "site": "--pgv",
    "periods": "--period-min",
    "pulse": "--shapes",
    "path": "--mesh",
    "unit": "--mesh-unit",
    "up": "--mesh-up",
}
"""The option or file of each argument that an error names; other arguments are options of the same name."""

RECORD_ARGUMENTS = {
    "unit": "--unit",
    "path": "FILE",
    "skip": "--record-skip",
    "delimiter": "--record-delimiter",
    "decimal": "--record-decimal",
}
"""Those of the files of records."""

OBJECTS = "Objects"
SITE = "Site"
METHOD = "Method"
REPORT = "Report"


def assess(
    objects: Annotated[
        str | None,
        typer.Argument(
            help="Table of objects: CSV, JSON, XLSX or ODS, with units in its header or in its cells; columns "
            f"{', '.join(column.name for column in INPUTS)}, and those of other kinds of bodies: "
            f"{', '.join(column.name for column in SHAPES)}.",
            metavar="OBJECTS",
        ),
    ] = None,
    columns: TableColumns = None,
    decimal: TableDecimal = ".",
    delimiter: TableDelimiter = None,
    skip: TableSkip = 0,
    sheet: Sheet = None,
    template: Annotated[
        str | None,
        typer.Option(
            help="CSV or XLSX file to write: a table to fill in; nothing is assessed.",
            metavar="[FILE]",
            rich_help_panel=OBJECTS,
        ),
    ] = None,
    mesh: Annotated[
        list[str] | None,
        typer.Option(
            help="Mesh of an object, a closed surface (STL, PLY, OBJ, GLB, ...); may be repeated.",
            metavar="[FILE]",
            rich_help_panel=OBJECTS,
        ),
    ] = None,
    mesh_unit: Annotated[
        str | None,
        typer.Option(
            help="Unit of the lengths of the meshes: m, cm, mm, in, ft; glTF has metres.",
            metavar="[UNIT]",
            rich_help_panel=OBJECTS,
        ),
    ] = None,
    mesh_up: Annotated[
        str | None,
        typer.Option(
            help="Axis of the meshes that points upwards: x, y or z; by default z, of glTF y.",
            metavar="[AXIS]",
            rich_help_panel=OBJECTS,
        ),
    ] = None,
    contact_tolerance: Annotated[
        float,
        typer.Option(
            help="Height of the vertices of a mesh on which it stands, over its own height, 0 to 0.1.",
            metavar="[-]",
            rich_help_panel=OBJECTS,
        ),
    ] = 1e-4,
    friction: Annotated[
        float | None,
        typer.Option(
            help="Coefficient of friction of the meshes; without it sliding is not assessed.",
            metavar="[-]",
            rich_help_panel=OBJECTS,
        ),
    ] = None,
    pga: Annotated[
        str | None,
        typer.Option(
            help="Peak ground acceleration of the site, such as 0.3g, from its hazard map; records are scaled to it.",
            metavar="[m/s2]",
            rich_help_panel=SITE,
        ),
    ] = None,
    pgv: Annotated[
        str | None,
        typer.Option(
            help="Peak ground velocity of the site, such as '0.3 m/s', from the same source; it sets the period of "
            "each pulse.",
            metavar="[m/s]",
            rich_help_panel=SITE,
        ),
    ] = None,
    period_min: Annotated[
        str | None,
        typer.Option(
            help="Where you have no PGV: shortest period of the pulses to try, such as 0.2s, with --period-max.",
            metavar="[s]",
            rich_help_panel=SITE,
        ),
    ] = None,
    period_max: Annotated[
        str | None,
        typer.Option(
            help="Longest of these periods; longer pulses overturn larger objects.",
            metavar="[s]",
            rich_help_panel=SITE,
        ),
    ] = None,
    shapes: Annotated[
        str | None,
        typer.Option(
            help="Pulses, such as sine,ricker; by default the seven that leave the ground at rest.",
            metavar="[NAME,...]",
            rich_help_panel=SITE,
        ),
    ] = None,
    moving_ground: Annotated[
        bool,
        typer.Option(
            "--moving-ground",
            help="Also pulses that leave the ground moving: half sine, rectangular.",
            rich_help_panel=SITE,
        ),
    ] = False,
    record: Annotated[
        list[str] | None,
        typer.Option(help="Accelerogram of the suite; may be repeated.", metavar="[FILE]", rich_help_panel=SITE),
    ] = None,
    pair: Annotated[
        list[str] | None,
        typer.Option(
            help="Two horizontal components: one record at all angles; may be repeated.",
            metavar="[FILE,FILE]",
            rich_help_panel=SITE,
        ),
    ] = None,
    vertical: Annotated[
        list[str] | None,
        typer.Option(
            help="Vertical component: one for each --record, then one for each --pair, or none.",
            metavar="[FILE]",
            rich_help_panel=SITE,
        ),
    ] = None,
    baseline_order: BaselineOrder = None,
    hazard: Annotated[
        str | None,
        typer.Option(
            help="Hazard curve of PGA of the site, for instance from OpenQuake or the USGS.",
            metavar="[FILE]",
            rich_help_panel=SITE,
        ),
    ] = None,
    floor_periods: Annotated[
        str | None,
        typer.Option(
            "--floor-periods",
            "--floor",
            help="Periods of the building, for objects on a floor: 0.5s,0.2s.",
            metavar="[s,s,...]",
            rich_help_panel=SITE,
        ),
    ] = None,
    floor_damping: Annotated[
        str,
        typer.Option(
            help="Damping ratios of these modes, one or one for each.", metavar="[-,-,...]", rich_help_panel=SITE
        ),
    ] = "0.05",
    floor_participation: Annotated[
        str,
        typer.Option(
            help="Participation factors times mode shapes at the floor, one or one for each.",
            metavar="[-,-,...]",
            rich_help_panel=SITE,
        ),
    ] = "1",
    file_format: FileFormat = None,
    acceleration: Acceleration = None,
    time: Time = None,
    time_step: TimeStep = None,
    time_unit: TimeUnit = None,
    unit: Unit = None,
    record_skip: Annotated[
        int, typer.Option(help="As --skip, of files of records.", metavar="[NUMBER]", rich_help_panel=LAYOUT)
    ] = 0,
    record_delimiter: Annotated[
        str | None,
        typer.Option(help="As --delimiter, of files of records.", metavar="[NAME]", rich_help_panel=LAYOUT),
    ] = None,
    record_decimal: Annotated[
        str, typer.Option(help="As --decimal, of files of records.", metavar="[SIGN]", rich_help_panel=LAYOUT)
    ] = ".",
    wrapped: Wrapped = False,
    allow_unusual: Annotated[
        bool,
        typer.Option(
            "--allow-unusual",
            help="Accept what usually is a wrong unit: an object below 1 cm or above 50 m; a record with a PGA above "
            "5 g, a PGV above 10 m/s, a step above 0.1 s.",
        ),
    ] = False,
    sensitivity: Annotated[
        bool,
        typer.Option(help="Also find factors of changed objects, and sizes that survive.", rich_help_panel=METHOD),
    ] = True,
    standards: Annotated[
        str,
        typer.Option(
            help=f"Checks by standards beside the outcome: all, or some of {', '.join(CLAUSES)}.",
            metavar="[NAME,...]",
            rich_help_panel=METHOD,
        ),
    ] = "",
    samples: Annotated[
        int,
        typer.Option(
            help="Number of variants of each object within its tolerance to try, such as 10000.",
            metavar="[NUMBER]",
            rich_help_panel=METHOD,
        ),
    ] = 0,
    seed: Annotated[int, typer.Option(help="Seed of these variants.", metavar="[NUMBER]", rich_help_panel=METHOD)] = 0,
    resolution: Annotated[
        float,
        typer.Option(
            help="Largest relative distance between the factors tried on a record, 0.0001 to 0.1.",
            metavar="[-]",
            rich_help_panel=METHOD,
        ),
    ] = 0.005,
    output: Annotated[
        str | None,
        typer.Option(
            "--output", "-o", help="CSV or XLSX file to write: the table as given, and all columns.", metavar="[FILE]"
        ),
    ] = None,
    directions: Annotated[
        bool, typer.Option("--directions", help="Each object in both directions; by default in the worse one.")
    ] = False,
    report: Annotated[
        str | None,
        typer.Option(
            help="HTML file to write: verdicts, drawings, inputs; prints on A4.",
            metavar="[FILE]",
            rich_help_panel=REPORT,
        ),
    ] = None,
    detail: Annotated[
        Literal["usual", "all"],
        typer.Option(
            help="Objects with drawings in the report: those that rock, or are close to it; all.",
            rich_help_panel=REPORT,
        ),
    ] = "usual",
    title: Annotated[
        str, typer.Option(help="Title of the report.", metavar="[TEXT]", rich_help_panel=REPORT)
    ] = "Assessment of free-standing objects",
    author: Annotated[str, typer.Option(help="Author of the report.", metavar="[TEXT]", rich_help_panel=REPORT)] = "",
    site: Annotated[
        str, typer.Option(help="Name of the site in the report.", metavar="[TEXT]", rich_help_panel=REPORT)
    ] = "",
    date: Annotated[
        str | None,
        typer.Option(
            help="Date of the report, such as 2026-11-25; by default today.", metavar="[DATE]", rich_help_panel=REPORT
        ),
    ] = None,
    output_format: OutputFormat = "table",
) -> None:
    """List the objects that the motions of a site overturn, the worst first, each with the lowest factor that does so.

    Rows of the table that cannot be read are named at the end, and the exit code is 2; the others are assessed.
    """
    from rocking.extension import (
        InvalidArgumentError,
        output_errors,
        plain_numbers,
        printable,
        progress,
        split_pulses,
        stated_columns,
        write_output,
    )
    from rocking_assessment._hazard.curve_files import read_hazard
    from rocking_assessment._objects.assess import assess as assess_objects
    from rocking_assessment._objects.objects import Object
    from rocking_assessment._objects.report import Project, report_html
    from rocking_assessment._objects.site import Site
    from rocking_assessment._objects.tables import ObjectTable, read_objects, write_template

    with reported_errors(ARGUMENTS):
        if template is not None:
            with output_errors("template", template):
                write_template(template)
            return
        if report is not None and Path(report).suffix.lower() not in (".html", ".htm"):
            raise InvalidArgumentError(
                "report", report, "a name that ends in .html or .htm; a browser prints it as PDF"
            )
        if output is not None and Path(output).suffix.lower() not in (".csv", ".xlsx"):
            raise InvalidArgumentError("output", output, "a name that ends in .csv or .xlsx")
        if (period_min is None) != (period_max is None):
            missing = "period_min" if period_min is None else "period_max"
            raise InvalidArgumentError(missing, None, "the shortest and the longest period")
        if friction is not None and not mesh:
            raise InvalidArgumentError("friction", friction, "a mesh beside it; a table has a column for it")
    layout: dict[str, Any] = {
        "format": file_format,
        "acceleration": acceleration,
        "time": time,
        "time_step": time_step,
        "time_unit": time_unit,
        "unit": unit,
        "skip": record_skip,
        "delimiter": record_delimiter,
        "decimal": record_decimal,
        "wrapped": wrapped,
        "allow_unusual": allow_unusual,
    }
    with reported_errors({**ARGUMENTS, **RECORD_ARGUMENTS}):
        records = _read_records(record or [], pair or [], vertical or [], baseline_order, layout)
    with reported_errors(ARGUMENTS):
        ground = Site(
            pga,
            pgv,
            None if period_min is None or period_max is None else (period_min, period_max),
            records,
            None if hazard is None else read_hazard(hazard),
            None if shapes is None else split_pulses(shapes),
            moving_ground,
            None if floor_periods is None else floor_periods.split(","),
            plain_numbers("floor_damping", floor_damping),
            plain_numbers("floor_participation", floor_participation),
        )
        table = ObjectTable()
        if objects is not None:
            table = read_objects(
                objects,
                columns=stated_columns(columns or []),
                decimal=decimal,
                delimiter=delimiter,
                skip=skip,
                sheet=sheet,
                allow_unusual=allow_unusual,
            )
        bad_rows = [f"{objects}, {printable(str(row))}" for row in table.bad_rows]
        meshes = [
            Object.from_mesh(
                path,
                unit=mesh_unit,
                up=mesh_up,
                friction=friction,
                contact_tolerance=contact_tolerance,
                allow_unusual=allow_unusual,
            )
            for path in mesh or []
        ]
        everything = [*table.objects, *meshes]
        if not everything:
            allowed = "\n".join(["a table with one object or more, or a mesh", *bad_rows])
            raise InvalidArgumentError("objects", objects, allowed)
        with progress(f"assessing {len(everything)} objects") as advance:
            assessment = assess_objects(
                everything,
                ground,
                sensitivity=sensitivity,
                standards=standards,
                samples=samples,
                seed=seed,
                resolution=resolution,
                progress=advance,
            )
        if output is not None:
            is_xlsx = Path(output).suffix.lower() == ".xlsx"
            write_table = assessment.to_xlsx if is_xlsx else assessment.to_csv
            with output_errors("output", output):
                write_table(output, bad_rows=table.bad_rows)
        if report is not None:
            day = date or dt.datetime.now().astimezone().date().isoformat()
            command = shlex.join(["rocking", *sys.argv[1:], *([] if date else ["--date", day])])
            project = Project(title, author, site, day, command)
            text = report_html(assessment, project, table.bad_rows, table.reading, detailed=detail == "all")
            with output_errors("report", report):
                write_output(report, text)
    _print(assessment, output_format, table, bad_rows, directions)
    if output_format == "table" and table.reading:
        typer.echo(printable(table.reading))
    if bad_rows:
        typer.echo("\n".join(bad_rows), err=True)
        raise typer.Exit(2)


def _read_records(
    paths: Sequence[str], pairs: Sequence[str], verticals: Sequence[str], order: int | None, layout: dict[str, Any]
) -> list[Record | tuple[Record, Record]]:
    """The records and pairs of components of a suite."""
    from rocking.extension import InvalidArgumentError, read_record

    if verticals and len(verticals) != len(paths) + len(pairs):
        allowed = f"{len(paths) + len(pairs)} of them, one for each record and pair"
        raise InvalidArgumentError("vertical", f"{len(verticals)} files", allowed)
    remaining = iter(verticals)

    def read(path: str, vertical: str | None = None) -> Record:
        return read_record(path, vertical=vertical, **layout).baseline_corrected(order=order)

    records: list[Record | tuple[Record, Record]] = [read(path, next(remaining, None)) for path in paths]
    for pair in pairs:
        first, comma, second = pair.partition(",")
        if not comma:
            raise InvalidArgumentError("pair", pair, "two files, FILE,FILE")
        records.append((read(first, next(remaining, None)), read(second)))
    return records


def _print(
    assessment: Assessment, output_format: str, table: ObjectTable, bad_rows: list[str], directions: bool
) -> None:
    """Print a line for each object, and below them each kind of warning with the objects to which it applies."""
    from rocking.extension import print_json, print_table, printable
    from rocking_assessment._objects.columns import OUTPUTS
    from rocking_assessment._objects.summary import counts_of, lines_of, names_in_short, table_of, warnings_of

    if output_format == "json":
        columns = {column.name: [row[column.name] for row in assessment.rows] for column in OUTPUTS}
        columns_read = {"details": assessment.details, "columns": table.columns, "skipped": table.skipped}
        motions = {"motions": assessment.motions, "resolution": assessment.resolution}
        print_json({**columns, **columns_read, "remarks": table.remarks, **motions, "bad_rows": bad_rows})
        return
    if output_format == "csv":
        typer.echo(assessment.to_csv(), nl=False)
        return
    print_table(table_of(assessment, directions=directions))
    typer.echo(counts_of(lines_of(assessment)))
    if assessment.resolution:
        typer.echo(f"factors tried on records are at most {100.0 * assessment.resolution:g} % apart")
    for text, names in warnings_of(assessment):
        count = f"{len(names)} object{'s' if len(names) > 1 else ''}"
        typer.echo(f"warning: {count}: {printable(f'{text}: {names_in_short(names)}')}")
    if not directions and len({*map(id, assessment.objects)}) < len(assessment.objects):
        typer.echo("each object in its worse direction; --directions shows both, --format csv every value")
