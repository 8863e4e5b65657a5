"""`rocking assess`: which of many objects the motions of a site overturn."""

from __future__ import annotations

import datetime as dt
import shlex
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

from rocking._cli.options import BaselineOrder, Component, OutputOptions, Skip, with_options

if TYPE_CHECKING:
    from rocking._assessment.report import Project
    from rocking._assessment.result import Assessment
    from rocking._assessment.tables import ObjectTable
    from rocking._cli.printing import Form
    from rocking._excitation.records.record import Record

HINTS = {
    "records": "--pair",
    "objects": "OBJECTS",
    "site": "--pgv",
    "periods": "--period-min",
    "pulse": "--shapes",
    "path": "--mesh",
    "columns": "--columns",
}
"""Where a value was given, by the argument that an error names; others have the name of the option."""

Objects = Annotated[
    str | None,
    typer.Argument(
        help="Table of objects: CSV, JSON, XLSX or ODS, with units in its header or in its cells; columns name, "
        "height, width or diameter, and optionally depth, mass_height, offset_width, offset_depth, mass, friction, "
        "restitution, tolerance, pedestal, notes.",
        metavar="OBJECTS",
    ),
]
Columns = Annotated[
    list[str] | None,
    typer.Option(
        "--columns",
        help='What a column of the table is: "Length (cm)=depth", "Seat height (cm)=unused"; may be repeated.',
        metavar="[HEADER=NAME]",
    ),
]
Mesh = Annotated[
    list[str] | None,
    typer.Option(
        help="Closed surface of an object (STL, PLY, OBJ, ...), z upwards, from all sides; may be repeated.",
        metavar="[FILE]",
    ),
]
MeshUnit = Annotated[str, typer.Option(help="Unit of the lengths of the meshes: m, cm, mm, in, ft.", metavar="[UNIT]")]
Friction = Annotated[
    float | None,
    typer.Option(help="Coefficient of friction of the meshes; none by default: sliding is not judged.", metavar="[-]"),
]
Pga = Annotated[
    str | None, typer.Option(help="Peak ground acceleration, such as 0.3g; records are scaled to it.", metavar="[m/s2]")
]
Pgv = Annotated[
    str | None, typer.Option(help="Peak ground velocity, such as '0.3 m/s': each pulse has this one.", metavar="[m/s]")
]
PeriodMin = Annotated[
    str | None, typer.Option(help="In place of PGV: shortest period of the pulses, such as 0.2s.", metavar="[s]")
]
PeriodMax = Annotated[str | None, typer.Option(help="Longest period of the pulses, such as 1s.", metavar="[s]")]
Records = Annotated[
    list[str] | None, typer.Option("--record", help="Accelerogram of the suite; may be repeated.", metavar="[FILE]")
]
Pair = Annotated[
    list[str] | None,
    typer.Option(help="Two horizontal components: one record at all angles; may be repeated.", metavar="[FILE,FILE]"),
]
Vertical = Annotated[
    list[str] | None,
    typer.Option(
        help="Vertical component: one for each --record, then one for each --pair, or none.", metavar="[FILE]"
    ),
]
Hazard = Annotated[
    str | None, typer.Option(help="Hazard curve of PGA of the site, as of OpenQuake or the USGS.", metavar="[FILE]")
]
FloorPeriods = Annotated[
    str | None,
    typer.Option(
        "--floor-periods",
        "--floor",
        help="Periods of a building of which the objects are on a floor: 0.5s,0.2s.",
        metavar="[s,s,...]",
    ),
]
FloorDamping = Annotated[
    str, typer.Option(help="Damping ratios of these modes, one or one for each.", metavar="[-,-,...]")
]
FloorParticipation = Annotated[
    str,
    typer.Option(
        help="Participation factors times mode shapes at the floor, one or one for each.", metavar="[-,-,...]"
    ),
]
Samples = Annotated[
    int,
    typer.Option(
        help="Variants of each object within its tolerance that are tried, such as 10000.", metavar="[NUMBER]"
    ),
]
Seed = Annotated[int, typer.Option(help="Seed of these variants.", metavar="[NUMBER]")]
Resolution = Annotated[
    float,
    typer.Option(
        help="Largest relative distance of the factors on a record that are tried, 0.0001 to 0.1.", metavar="[-]"
    ),
]
Unit = Annotated[
    str | None, typer.Option(help="Unit of the records if their files state none, such as g.", metavar="[UNIT]")
]
TimeStep = Annotated[
    str | None, typer.Option(help="Time step of the records if their files state none, such as 0.01s.", metavar="[s]")
]
Shapes = Annotated[
    str | None,
    typer.Option(
        help="Pulses, such as sine,ricker; by default all by name that leave the ground at rest.",
        metavar="[NAME,NAME,...]",
    ),
]
MovingGround = Annotated[
    bool,
    typer.Option(
        "--moving-ground", help="Also pulses that leave the ground moving: half sine, rectangular.", metavar=""
    ),
]
Sensitivity = Annotated[
    bool,
    typer.Option(
        "--sensitivity/--no-sensitivity",
        help="Whether to find the factors of changed objects and the sizes that are not overturned.",
        metavar="",
    ),
]
Standards = Annotated[
    str,
    typer.Option(
        help="Checks by standards beside the outcome: all, or some of static, ishiyama, asce43, circolare_linear, "
        "circolare_nonlinear.",
        metavar="[NAME,NAME,...]",
    ),
]
Output = Annotated[
    str | None,
    typer.Option(
        "--output", "-o", help="CSV or XLSX file to write: the table as given, and all columns.", metavar="[FILE]"
    ),
]
Directions = Annotated[
    bool,
    typer.Option("--directions", help="Each object in both directions; by default in the worse one.", metavar=""),
]
Detail = Annotated[
    Literal["usual", "all"],
    typer.Option(
        help="Objects with drawings in the report: those that rock, or are close to it; all.", metavar="[NAME]"
    ),
]

Report = Annotated[
    str | None, typer.Option(help="HTML file to write: verdicts, drawings, inputs; prints on A4.", metavar="[FILE]")
]
Author = Annotated[str, typer.Option(help="Author of the report.", metavar="[TEXT]")]
Title = Annotated[str, typer.Option(help="Title of the report.", metavar="[TEXT]")]
Place = Annotated[str, typer.Option("--site", help="Name of the site in the report.", metavar="[TEXT]")]
Date = Annotated[
    str | None, typer.Option(help="Date of the report, such as 2026-11-25; by default today.", metavar="[DATE]")
]


@with_options
def assess(
    form: OutputOptions,
    objects: Objects = None,
    column: Columns = None,
    mesh: Mesh = None,
    mesh_unit: MeshUnit = "m",
    friction: Friction = None,
    pga: Pga = None,
    pgv: Pgv = None,
    period_min: PeriodMin = None,
    period_max: PeriodMax = None,
    record: Records = None,
    pair: Pair = None,
    vertical: Vertical = None,
    unit: Unit = None,
    time_step: TimeStep = None,
    component: Component = None,
    skip: Skip = None,
    baseline_order: BaselineOrder = None,
    hazard: Hazard = None,
    floor_periods: FloorPeriods = None,
    floor_damping: FloorDamping = "0.05",
    floor_participation: FloorParticipation = "1",
    shapes: Shapes = None,
    moving_ground: MovingGround = False,
    sensitivity: Sensitivity = True,
    standards: Standards = "",
    samples: Samples = 0,
    seed: Seed = 0,
    resolution: Resolution = 0.005,
    output: Output = None,
    directions: Directions = False,
    report: Report = None,
    detail: Detail = "usual",
    title: Title = "Assessment of free-standing objects",
    author: Author = "",
    place: Place = "",
    date: Date = None,
) -> None:
    """Which objects the motions of a site overturn, from which factor on these motions, the worst first.

    Rows of the table that cannot be read are named at the end, and the exit code is 2; the others are assessed.
    """
    from rocking._assessment.assess import assess as assess_objects
    from rocking._assessment.objects import Object
    from rocking._assessment.report import Project
    from rocking._assessment.site import Site
    from rocking._assessment.tables import ObjectTable, read_objects
    from rocking._base.errors import InvalidArgumentError, plain_numbers
    from rocking._cli import printing
    from rocking._cli.arguments import option_errors
    from rocking._cli.progress import progress
    from rocking._cli.record import file_errors
    from rocking._excitation.pulses import split_pulses
    from rocking.suites.hazard_files import read_hazard

    with option_errors(HINTS), file_errors():
        kind = printing.output_format(form)
        if (period_min is None) != (period_max is None):
            missing = "period_min" if period_min is None else "period_max"
            raise InvalidArgumentError(missing, None, "the shortest and the longest period")
        if friction is not None and not mesh:
            raise InvalidArgumentError("friction", friction, "a mesh beside it; a table has a column for it")
        stated = {"unit": unit, "time_step": time_step, "component": component, "skip": skip}
        site = Site(
            pga,
            pgv,
            None if period_min is None or period_max is None else (period_min, period_max),
            _read(record or (), pair or (), vertical or (), baseline_order, stated),
            None if hazard is None else read_hazard(hazard),
            None if shapes is None else split_pulses(shapes),
            moving_ground,
            None if floor_periods is None else floor_periods.split(","),
            plain_numbers("floor_damping", floor_damping),
            plain_numbers("floor_participation", floor_participation),
        )
        table = ObjectTable([], []) if objects is None else read_objects(objects, columns=_columns(column or ()))
        bad = [f"{objects}, {printing.printable(str(one))}" for one in table.bad_rows]
        meshes = [Object.from_mesh(path, unit=mesh_unit, friction=friction) for path in mesh or ()]
        given = [*table.objects, *meshes]
        if not given:
            raise InvalidArgumentError(
                "objects", objects, "\n".join(["a table with one object or more, or a mesh", *bad])
            )
        with progress(f"assessing {len(given)} objects") as advance:
            found = assess_objects(
                given,
                site,
                sensitivity=sensitivity,
                standards=standards,
                samples=samples,
                seed=seed,
                resolution=resolution,
                progress=advance,
            )
        if output is not None:
            is_xlsx = Path(output).suffix.lower() == ".xlsx"
            _write("output", output, (found.to_xlsx if is_xlsx else found.to_csv)(bad_rows=table.bad_rows))
        if report is not None:
            day = date or dt.datetime.now().astimezone().date().isoformat()
            command = shlex.join(["rocking", *sys.argv[1:], *([] if date else ["--date", day])])
            project = Project(title, author, place, day, command)
            _write("report", report, _html(found, project, table, detail == "all"))
    _print(found, kind, table, bad, directions)
    if kind.kind == "table" and table.reading:
        typer.echo(printing.printable(table.reading))
    if bad:
        typer.echo("\n".join(bad), err=True)
        raise typer.Exit(2)


def _columns(given: Sequence[str]) -> dict[str, str]:
    """What columns of the table are, by their headers."""
    from rocking._base.errors import InvalidArgumentError

    for one in given:
        if not one.rpartition("=")[0].strip():
            raise InvalidArgumentError("columns", one, 'a header and a name, such as "Length (cm)=depth"')
    return {header.strip(): name.strip() for header, _, name in (one.rpartition("=") for one in given)}


def _read(
    paths: Sequence[str], pairs: Sequence[str], verticals: Sequence[str], order: int | None, stated: dict[str, Any]
) -> list[Record | tuple[Record, Record]]:
    """The records and pairs of components of a suite."""
    from rocking._base.errors import InvalidArgumentError
    from rocking._excitation.records.readers.read_record import read_record

    if verticals and len(verticals) != len(paths) + len(pairs):
        allowed = f"{len(paths) + len(pairs)} of them, one for each record and pair"
        raise InvalidArgumentError("vertical", f"{len(verticals)} files", allowed)
    up = iter(verticals)

    def read(path: str, vertical: str | None = None) -> Record:
        motion = read_record(path, vertical=vertical, **stated)
        return motion if order is None else motion.baseline_corrected(order=order)

    found: list[Record | tuple[Record, Record]] = [read(path, next(up, None)) for path in paths]
    for one in pairs:
        first, comma, second = one.partition(",")
        if not comma:
            raise InvalidArgumentError("pair", one, "two files, FILE,FILE")
        found.append((read(first, next(up, None)), read(second)))
    return found


def _html(found: Assessment, project: Project, table: ObjectTable, detailed: bool) -> str:
    """The report."""
    from rocking._assessment.report import report_html
    from rocking._base.errors import InvalidArgumentError

    try:
        return report_html(found, project, table.bad_rows, table.reading, detailed=detailed)
    except ModuleNotFoundError as error:
        raise InvalidArgumentError(
            "report", error.name, "with the extra `report`: pip install 'rocking[report]'"
        ) from None


def _write(option: str, path: str, content: str | bytes) -> None:
    """Write a file.

    Raises
    ------
    InvalidArgumentError
        If that is not possible.
    """
    from rocking._base.errors import InvalidArgumentError

    try:
        Path(path).write_bytes(content.encode() if isinstance(content, str) else content)
    except OSError as error:
        raise InvalidArgumentError(option, path, f"a file that can be written ({error.strerror})") from None


def _print(found: Assessment, form: Form, table: ObjectTable, bad: list[str], directions: bool) -> None:
    """Print a line for each object, and below them each kind of warning with the objects to which it applies."""
    from rocking._assessment.columns import OUTPUTS
    from rocking._assessment.summary import names_in_short, rows_in_units, table_of, warnings_of
    from rocking._cli import printing

    columns = {one.name: [row[one.name] for row in found.rows] for one in OUTPUTS}
    if form.kind == "json":
        about = {"details": found.details, "columns": table.columns, "skipped": table.skipped}
        printing.print_json(
            columns | about | {"motions": found.motions, "resolution": found.resolution, "bad_rows": bad}
        )
        return
    if form.kind == "csv":
        units = {one.name: one.unit for one in OUTPUTS if one.header != one.name}
        printing.print_csv(found.with_details(columns), form, units)
        return
    printing.print_table(rows_in_units(found) if form.all else table_of(found, directions=directions))
    if found.resolution:
        typer.echo(f"factors on records: at most {100.0 * found.resolution:g} % apart were tried")
    for text, names in warnings_of(found):
        count = f"{len(names)} object{'s' if len(names) > 1 else ''}"
        typer.echo(f"warning: {count}: {printing.printable(f'{text}: {names_in_short(names)}')}")
    if not (directions or form.all) and len({*map(id, found.objects)}) < len(found.objects):
        typer.echo("each object in its worse direction; --directions shows both, --all every value")
