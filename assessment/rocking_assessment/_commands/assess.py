"""`rocking assess`: which of many objects the motions of a site overturn."""

from __future__ import annotations

import datetime as dt
import shlex
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

from rocking.extension import PERIOD, PGA, PGV, BaselineOrder, OutputOptions, SeriesOptions, option, said, with_options
from rocking_assessment._objects.columns import CLAUSES, INPUTS, SHAPES

if TYPE_CHECKING:
    from rocking.extension import Form, Record
    from rocking_assessment._objects.result import Assessment
    from rocking_assessment._objects.tables import ObjectTable

HINTS = {
    "records": "--pair",
    "objects": "OBJECTS",
    "site": "--pgv",
    "periods": "--period-min",
    "pulse": "--shapes",
    "path": "--mesh",
    "columns": "--columns",
    "format": "--file-format",
}
"""The option or file of each argument that an error names; other arguments are options of the same name."""

Texts = list[str] | None


@with_options
def assess(
    form: OutputOptions,
    stated: SeriesOptions,
    objects: Annotated[
        str | None,
        typer.Argument(
            help="Table of objects: CSV, JSON, XLSX or ODS, with units in its header or in its cells; columns "
            f"{', '.join(one.name for one in INPUTS)}, and those of other kinds of bodies: "
            f"{', '.join(one.name for one in SHAPES)}.",
            metavar="OBJECTS",
        ),
    ] = None,
    column: Annotated[
        Texts,
        said(
            'Header of a column: "Breite (cm)=width [cm]", "Alter=unused"; may be repeated.', "HEADER=NAME", "--columns"
        ),
    ] = None,
    sheet: Annotated[str | None, said("Sheet of a workbook, where several hold cells.", "NAME")] = None,
    template: Annotated[
        str | None, said("CSV or XLSX file to write: a table to fill in. Nothing is assessed.", "FILE")
    ] = None,
    mesh: Annotated[
        Texts, said("Mesh of an object, a closed surface (STL, PLY, OBJ, ...), z upwards; may be repeated.", "FILE")
    ] = None,
    mesh_unit: Annotated[str, said("Unit of the lengths of the meshes: m, cm, mm, in, ft.", "UNIT")] = "m",
    friction: Annotated[
        float | None, said("Coefficient of friction of the meshes; without it sliding is not assessed.", "-")
    ] = None,
    contact_tolerance: Annotated[
        float, said("Height of the vertices of a mesh on which it stands, over its own height, 0 to 0.1.", "-")
    ] = 1e-4,
    pga: Annotated[
        str | None,
        option(PGA, text="Peak ground acceleration of the site, from its hazard map; records are scaled to it"),
    ] = None,
    pgv: Annotated[
        str | None,
        option(PGV, text="Peak ground velocity of the site, from the same source; it sets the period of each pulse"),
    ] = None,
    period_min: Annotated[
        str | None,
        option(PERIOD, text="Where you have no PGV: shortest period of the pulses to try, with --period-max"),
    ] = None,
    period_max: Annotated[
        str | None, option(PERIOD, text="Longest of these periods; longer pulses overturn larger objects")
    ] = None,
    record: Annotated[Texts, said("Accelerogram of the suite; may be repeated.", "FILE", "--record")] = None,
    pair: Annotated[
        Texts, said("Two horizontal components: one record at all angles; may be repeated.", "FILE,FILE")
    ] = None,
    vertical: Annotated[
        Texts, said("Vertical component: one for each --record, then one for each --pair, or none.", "FILE")
    ] = None,
    baseline_order: BaselineOrder = None,
    record_skip: Annotated[int, said("As --skip, of files of records.", "NUMBER")] = 0,
    record_delimiter: Annotated[str | None, said("As --delimiter, of files of records.", "NAME")] = None,
    record_decimal: Annotated[str, said("As --decimal, of files of records.", "SIGN")] = ".",
    hazard: Annotated[
        str | None, said("Hazard curve of PGA of the site, for instance from OpenQuake or the USGS.", "FILE")
    ] = None,
    floor_periods: Annotated[
        str | None,
        said("Periods of the building, for objects on a floor: 0.5s,0.2s.", "s,s,...", "--floor-periods", "--floor"),
    ] = None,
    floor_damping: Annotated[str, said("Damping ratios of these modes, one or one for each.", "-,-,...")] = "0.05",
    floor_participation: Annotated[
        str, said("Participation factors times mode shapes at the floor, one or one for each.", "-,-,...")
    ] = "1",
    shapes: Annotated[
        str | None,
        said("Pulses, such as sine,ricker; by default the seven that leave the ground at rest.", "NAME,NAME,..."),
    ] = None,
    moving_ground: Annotated[
        bool, said("Also pulses that leave the ground moving: half sine, rectangular.", "", "--moving-ground")
    ] = False,
    # two flags: a column of the help for the negative names of one would leave no room for the other names
    sensitivity: Annotated[bool, said("", "", "--sensitivity", hidden=True)] = True,
    no_sensitivity: Annotated[
        bool, said("Do not find factors of changed objects, nor sizes that survive.", "", "--no-sensitivity")
    ] = False,
    standards: Annotated[
        str, said(f"Checks by standards beside the outcome: all, or some of {', '.join(CLAUSES)}.", "NAME,NAME,...")
    ] = "",
    samples: Annotated[
        int, said("Number of variants of each object within its tolerance to try, such as 10000.", "NUMBER")
    ] = 0,
    seed: Annotated[int, said("Seed of these variants.", "NUMBER")] = 0,
    resolution: Annotated[
        float, said("Largest relative distance between the factors tried on a record, 0.0001 to 0.1.", "-")
    ] = 0.005,
    output: Annotated[
        str | None, said("CSV or XLSX file to write: the table as given, and all columns.", "FILE", "--output", "-o")
    ] = None,
    directions: Annotated[
        bool, said("Each object in both directions; by default in the worse one.", "", "--directions")
    ] = False,
    report: Annotated[str | None, said("HTML file to write: verdicts, drawings, inputs; prints on A4.", "FILE")] = None,
    detail: Annotated[
        Literal["usual", "all"],
        said("Objects with drawings in the report: those that rock, or are close to it; all.", "NAME"),
    ] = "usual",
    title: Annotated[str, said("Title of the report.", "TEXT")] = "Assessment of free-standing objects",
    author: Annotated[str, said("Author of the report.", "TEXT")] = "",
    place: Annotated[str, said("Name of the site in the report.", "TEXT", "--site")] = "",
    date: Annotated[str | None, said("Date of the report, such as 2026-11-25; by default today.", "DATE")] = None,
) -> None:
    """List the objects that the motions of a site overturn, the worst first, each with the lowest factor that does so.

    Rows of the table that cannot be read are named at the end, and the exit code is 2; the others are assessed.
    """
    from rocking.extension import (
        InvalidArgumentError,
        file_errors,
        option_errors,
        output_errors,
        output_format,
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

    with option_errors(HINTS), file_errors():
        if template is not None:
            with output_errors("template", template):
                write_template(template)
            return
        kind = output_format(form)
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
        of_records = {"skip": record_skip, "delimiter": record_delimiter, "decimal": record_decimal}
        site = Site(
            pga,
            pgv,
            None if period_min is None or period_max is None else (period_min, period_max),
            _read(record or (), pair or (), vertical or (), baseline_order, stated.stated() | of_records),
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
                columns=stated_columns(column or ()),
                decimal=stated.decimal,
                delimiter=stated.delimiter,
                skip=stated.skip,
                sheet=sheet,
                allow_unusual=stated.allow_unusual,
            )
        bad = [f"{objects}, {printable(str(one))}" for one in table.bad_rows]
        of_meshes: dict[str, Any] = {"unit": mesh_unit, "friction": friction, "contact_tolerance": contact_tolerance}
        meshes = [Object.from_mesh(path, **of_meshes) for path in mesh or ()]
        given = [*table.objects, *meshes]
        if not given:
            raise InvalidArgumentError(
                "objects", objects, "\n".join(["a table with one object or more, or a mesh", *bad])
            )
        with progress(f"assessing {len(given)} objects") as advance:
            found = assess_objects(
                given,
                site,
                sensitivity=sensitivity and not no_sensitivity,
                standards=standards,
                samples=samples,
                seed=seed,
                resolution=resolution,
                progress=advance,
            )
        if output is not None:
            is_xlsx = Path(output).suffix.lower() == ".xlsx"
            write_table = found.to_xlsx if is_xlsx else found.to_csv
            with output_errors("output", output):
                write_table(output, bad_rows=table.bad_rows)
        if report is not None:
            day = date or dt.datetime.now().astimezone().date().isoformat()
            command = shlex.join(["rocking", *sys.argv[1:], *([] if date else ["--date", day])])
            project = Project(title, author, place, day, command)
            text = report_html(found, project, table.bad_rows, table.reading, detailed=detail == "all")
            with output_errors("report", report):
                write_output(report, text)
    _print(found, kind, table, bad, directions)
    if kind.kind == "table" and table.reading:
        typer.echo(printable(table.reading))
    if bad:
        typer.echo("\n".join(bad), err=True)
        raise typer.Exit(2)


def _read(
    paths: Sequence[str], pairs: Sequence[str], verticals: Sequence[str], order: int | None, stated: dict[str, Any]
) -> list[Record | tuple[Record, Record]]:
    """The records and pairs of components of a suite."""
    from rocking.extension import InvalidArgumentError, read_record

    if verticals and len(verticals) != len(paths) + len(pairs):
        allowed = f"{len(paths) + len(pairs)} of them, one for each record and pair"
        raise InvalidArgumentError("vertical", f"{len(verticals)} files", allowed)
    up = iter(verticals)

    def read(path: str, vertical: str | None = None) -> Record:
        return read_record(path, vertical=vertical, **stated).baseline_corrected(order=order)

    found: list[Record | tuple[Record, Record]] = [read(path, next(up, None)) for path in paths]
    for one in pairs:
        first, comma, second = one.partition(",")
        if not comma:
            raise InvalidArgumentError("pair", one, "two files, FILE,FILE")
        found.append((read(first, next(up, None)), read(second)))
    return found


def _print(found: Assessment, form: Form, table: ObjectTable, bad: list[str], directions: bool) -> None:
    """Print a line for each object, and below them each kind of warning with the objects to which it applies."""
    from rocking.extension import print_json, print_table, printable
    from rocking_assessment._objects.columns import OUTPUTS
    from rocking_assessment._objects.summary import (
        counts_of,
        lines_of,
        names_in_short,
        rows_in_units,
        table_of,
        warnings_of,
    )

    columns = {one.name: [row[one.name] for row in found.rows] for one in OUTPUTS}
    if form.kind == "json":
        about = {"details": found.details, "columns": table.columns, "skipped": table.skipped, "remarks": table.remarks}
        print_json(columns | about | {"motions": found.motions, "resolution": found.resolution, "bad_rows": bad})
        return
    if form.kind == "csv":
        typer.echo(found.to_csv(), nl=False)
        return
    print_table(rows_in_units(found) if form.all else table_of(found, directions=directions))
    typer.echo(counts_of(lines_of(found)))
    if found.resolution:
        typer.echo(f"factors tried on records are at most {100.0 * found.resolution:g} % apart")
    for text, names in warnings_of(found):
        count = f"{len(names)} object{'s' if len(names) > 1 else ''}"
        typer.echo(f"warning: {count}: {printable(f'{text}: {names_in_short(names)}')}")
    if not (directions or form.all) and len({*map(id, found.objects)}) < len(found.objects):
        typer.echo("each object in its worse direction; --directions shows both, --all every value")
