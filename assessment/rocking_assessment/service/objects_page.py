"""The page of objects: a table as text, which can be mended in place, and its assessment, rendered here."""

from __future__ import annotations

import csv
import io
import re
import shlex
from collections.abc import Iterator
from dataclasses import asdict
from datetime import UTC, datetime
from itertools import islice
from pathlib import Path, PurePath
from typing import Any
from urllib.parse import unquote_to_bytes

from fastapi import APIRouter, Request, Response
from fastapi.responses import HTMLResponse, JSONResponse, PlainTextResponse
from rocking_api.http.encoding import text_response
from rocking_api.http.errors import TooLargeError, UnsupportedBodyError
from rocking_api.models.table import table_refusal
from rocking_api.routers.pages import POLICY, html
from rocking_api.service import Service, ServiceDep
from rocking_api.settings import Settings

from rocking.extension import (
    SHEETS,
    UNITS,
    BadRow,
    InvalidArgumentError,
    PreviewLine,
    StopFlag,
    TableFile,
    TableFileError,
    TableLayout,
    TablePreview,
    open_text,
    plain_numbers,
    preview_table,
    stated_columns,
)
from rocking_assessment._objects.assess import assess
from rocking_assessment._objects.columns import INPUTS, SHAPES, VERDICTS
from rocking_assessment._objects.report import Project, report_html
from rocking_assessment._objects.result import Assessment
from rocking_assessment._objects.summary import counts_of, lines_of, names_in_short, number_of, warnings_of
from rocking_assessment._objects.tables import SCHEMA, ObjectTable, objects_of_csv
from rocking_assessment.service.assess import MAX_BODY, check_table
from rocking_assessment.service.models import MAX_OBJECTS
from rocking_assessment.service.object_page import SITE, address_of, periods_of, quantity_of, site_of
from rocking_assessment.service.workbooks import text_of_workbook

MAX_SENSITIVITY = 200
"""Objects up to which sizes that survive and changed objects are assessed as well [-]: these take most of the time."""

MAX_FIELDS = 100  # most fields of the form [-]: those of the site, and of rows that are corrected
MAX_CORRECTED = 50  # most rows that are corrected at a time [-]
PART = 65536  # characters of a form whose escapes are replaced at a time [-]

PATH = "/objects"

WORKBOOK = "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet"

EXAMPLE = Path(__file__).parent / "static" / "collection.csv"

# the report has its styles inside
REPORT_POLICY = (
    "default-src 'none'; style-src 'unsafe-inline'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)

LAYOUT = {"columns": "", "decimal": "", "delimiter": "", "skip": "", "sheet": "", "allow_unusual": ""}
"""Fields of the layout of the table; `columns` has a line for each column that is stated."""

DEFAULTS = SITE | LAYOUT | {"table": "", "table_name": "TABLE", "title": "Objects at a site"}

FIRST = 3  # objects that a preview describes
LINES_UNREAD = 12  # lines that it shows of a table that is not divided into cells

MAIN = ("name", "width", "depth", "diameter", "height", "mass", "friction", "notes")
"""Quantities that every page has a list for; those of the others are folded."""

UNITS_OF = {si: tuple(units) for si, units in UNITS.items()}

router = APIRouter(prefix=PATH, include_in_schema=False)


@router.get("")
async def get_objects_page(service: ServiceDep) -> Response:
    """The page with the table of the guide as an example."""
    table = EXAMPLE.read_text("utf-8")
    return _page(DEFAULTS | {"table": table}, service.settings)


@router.post("")
async def post_objects_page(request: Request, service: ServiceDep) -> Response:
    """The page with the assessment of the table in its form, and fields for what was not read."""
    raw = await request.body()

    def work(stop: StopFlag) -> Response:
        given = _fields(raw, stop)
        table = _table(given, stop)
        found = _assessed(table, given, stop) if table.objects or not table.bad_rows else None
        return _page(given, service.settings, table, found)

    return await service.solve_one(work, request)


@router.post("/report")
async def post_report(request: Request, service: ServiceDep) -> Response:
    """The report of the assessment, to print."""
    given, table, found = await _answer(request, service)
    project = Project(given["title"], "", "", datetime.now(UTC).date().isoformat(), shlex.join(_command(given)))
    text = await service.solve_one(lambda _: report_html(found, project, table.bad_rows, table.reading), request)
    return HTMLResponse(text, headers={"Content-Security-Policy": REPORT_POLICY})


@router.post("/assessment.csv")
@router.post("/assessment.xlsx")
async def post_file(request: Request, service: ServiceDep) -> Response:
    """The assessment as CSV or as a workbook, as its address ends."""
    _, table, found = await _answer(request, service)
    if request.url.path.endswith(".csv"):
        return text_response(await service.read(lambda _: found.to_csv(bad_rows=table.bad_rows)), "assessment")
    headers = {"Content-Disposition": 'attachment; filename="assessment.xlsx"'}
    raw = await service.read(lambda _: found.to_xlsx(bad_rows=table.bad_rows))
    return Response(raw, headers=headers, media_type=WORKBOOK)


async def _answer(request: Request, service: Service) -> tuple[dict[str, str], ObjectTable, Assessment]:
    """The fields of the form, its table and its assessment."""
    raw = await request.body()

    def work(stop: StopFlag) -> tuple[dict[str, str], ObjectTable, Assessment]:
        given = _fields(raw, stop)
        table = _table(given, stop)
        return given, table, _assessed(table, given, stop)

    return await service.solve_one(work, request)


@router.post("/preview")
async def post_preview(request: Request, service: ServiceDep) -> Response:
    """What the table in the form holds, and how it would be read. Nothing is assessed."""
    raw = await request.body()
    return await service.read_body(lambda stop: JSONResponse(_preview(_fields(raw, stop), stop)), request)


@router.post("/text")
async def post_text(
    request: Request, service: ServiceDep, name: str = "", sheet: str = "", decimal: str = ""
) -> Response:
    """A sheet of a workbook as CSV, with a decimal sign."""
    raw = await request.body()
    ending = PurePath(name).suffix.lower()
    if ending not in SHEETS:
        raise UnsupportedBodyError("table", ending, f"a workbook: {', '.join(SHEETS)}")
    text = await text_of_workbook(service, raw, "table", name, sheet or None, decimal or ".")
    return PlainTextResponse(text)


def _command(given: dict[str, str]) -> list[str]:
    """The words of the command that assesses the table at the site of a form."""
    words = ["rocking", "assess", given["table_name"]]
    words += ["--pga", quantity_of(given, "pga").replace(" ", "")]
    periods = periods_of(given)
    if given["pgv"].strip():
        words += ["--pgv", quantity_of(given, "pgv").replace(" ", "")]
    elif periods is not None:
        words += ["--period-min", periods[0].replace(" ", ""), "--period-max", periods[1].replace(" ", "")]
    if given["floor_periods"].strip():
        modes, participation = (plain_numbers(name, given[name]) for name in ("floor_periods", "floor_participation"))
        words += ["--floor", ",".join(f"{period}s" for period in modes)]
        words += ["--floor-participation", ",".join(map(str, participation))]
    for text in given["columns"].splitlines():
        words += ["--columns", text]
    for name in ("decimal", "delimiter", "skip", "sheet"):
        if given[name].strip():
            words += [f"--{name}", given[name].strip()]
    return [*words, "--allow-unusual"] if given["allow_unusual"] else words


def _layout(given: dict[str, str]) -> TableLayout:
    """What a form states about its table; the sheet is chosen before."""
    skip = given["skip"].strip() or "0"
    if not skip.isdecimal() or len(skip) > 4:
        raise InvalidArgumentError("skip", skip, "a number of lines, 0 to 9999")
    return TableLayout(
        columns=stated_columns(given["columns"].splitlines()),
        decimal=given["decimal"] or ".",
        delimiter=given["delimiter"] or None,
        skip=int(skip),
        allow_unusual=bool(given["allow_unusual"]),
    )


def _table(given: dict[str, str], stop: StopFlag) -> ObjectTable:
    """The objects of a form."""
    try:
        return objects_of_csv(given["table"], MAX_OBJECTS, stop, _layout(given))
    except TableFileError as error:
        raise table_refusal(error) from None


def _preview(given: dict[str, str], stop: StopFlag) -> dict[str, Any]:
    """What the page shows before anything is assessed."""
    layout = _layout(given)
    problem: dict[str, Any] | None = None
    table = ObjectTable()
    try:
        table = objects_of_csv(given["table"], MAX_OBJECTS, stop, layout)
    except TableFileError as error:
        problem = {"line": error.line, "was": str(error.value), "expected": error.expected}
    except InvalidArgumentError as error:
        problem = {"line": None, "was": f"{error.parameter} {error.value}", "expected": error.allowed}
    try:
        preview = preview_table(open_text(given["table"], "table", SCHEMA, layout, stop))
    except TableFileError:
        lines = islice(io.StringIO(given["table"]), LINES_UNREAD)
        preview = TablePreview([PreviewLine(k, line.rstrip()[:200], []) for k, line in enumerate(lines, 1)])
    try:
        command = _command(given)
    except InvalidArgumentError:  # of the site, which is not checked here
        command = []
    first = [
        {"name": item.name, "height": next(iter(item.planes.values())).height}
        | {"bases": {direction: plane.base for direction, plane in item.planes.items()}}
        for item in table.objects[:FIRST]
    ]
    return asdict(preview) | {
        "problem": problem,
        "objects": len(table.objects),
        "bad_rows": len(table.bad_rows),
        "reasons": [str(row) for row in table.bad_rows[:FIRST]],
        "skipped": table.skipped,
        "remarks": table.remarks,
        "first": first,
        "command": command,
    }


def _fields(body: bytes, stop: StopFlag) -> dict[str, str]:
    """The fields of the form; fields `line-N` and `cell-N-K` take the place of rows of the table and of their cells."""
    count = body.count(b"&") + 1
    if count > MAX_FIELDS:
        raise TooLargeError("form", f"{count} fields", f"at most {MAX_FIELDS}")
    parts = (part.partition(b"=") for part in body.split(b"&"))
    fields = DEFAULTS | {_unescaped(name, stop): _unescaped(value, stop) for name, _, value in parts}
    if len(fields["table"]) > MAX_BODY:
        raise TooLargeError("table", f"{len(fields['table'])} characters", f"at most {MAX_BODY}")
    corrected: dict[int, dict[int | None, str]] = {}  # by row and place of the cell, None for the line
    for name, value in fields.items():
        if found := re.fullmatch("(?:line|cell)-([0-9]{1,9})(?:-([0-9]{1,4}))?", name):
            corrected.setdefault(int(found[1]), {})[int(found[2]) if found[2] else None] = value
    if corrected:
        text = fields["table"].removeprefix("\ufeff")
        file = open_text(text, "table", SCHEMA, _layout(fields), stop)
        above = text[: len(text) - sum(map(len, file.lines))]
        rows = _rows_of(file)
        corrected_rows = [_with_cells(row, corrected.get(number, {}), file.delimiter) for number, row in rows]
        fields["table"] = "".join([above, *corrected_rows])
    return fields


def _rows_of(file: TableFile) -> Iterator[tuple[int, str]]:
    """Number and text of each row from the header on."""
    reader = csv.reader(file.lines, delimiter=file.delimiter)
    start = 0
    for number, _ in enumerate(reader, start=file.first):
        yield number, "".join(file.lines[start : reader.line_num])
        start = reader.line_num


def _with_cells(row: str, given: dict[int | None, str], delimiter: str) -> str:
    """The text of a row with other cells, by their place; the whole line at the place None."""
    line = row.rstrip("\r\n")
    end, line = row[len(line) :], given.get(None, line)
    cells = {place: cell for place, cell in given.items() if place is not None}
    if cells:
        found = next(csv.reader(io.StringIO(line, newline=""), delimiter=delimiter))
        found += [""] * (max(cells) + 1 - len(found))
        for place, cell in cells.items():
            found[place] = cell
        text = io.StringIO()
        csv.writer(text, delimiter=delimiter).writerow(found)
        line = text.getvalue().removesuffix("\r\n")
    return line + end


def _unescaped(raw: bytes, stop: StopFlag) -> str:
    """A text of a form; by parts, because `unquote_to_bytes` keeps 80 bytes of memory for each byte of escapes."""
    found, start = bytearray(), 0
    while start < len(raw):
        stop.check()
        end = start + PART
        cut = raw.rfind(b"%", end - 2, end)  # an escape that the end would divide
        end = end if cut < 0 else cut
        found += unquote_to_bytes(raw[start:end].replace(b"+", b" "))
        start = end
    return found.decode("utf-8", "replace")


def _assessed(table: ObjectTable, given: dict[str, str], stop: StopFlag) -> Assessment:
    check_table(table, "table")
    return assess(table.objects, site_of(given), sensitivity=len(table.objects) <= MAX_SENSITIVITY, stop=stop)


def _page(
    given: dict[str, str], settings: Settings, table: ObjectTable | None = None, found: Assessment | None = None
) -> HTMLResponse:
    bad_rows = table.bad_rows[:MAX_CORRECTED] if table else []
    numbers = {bad.row for bad in bad_rows}
    texts: dict[int, str] = {}
    if numbers:
        file = open_text(given["table"], "table", SCHEMA, _layout(given))
        texts = {number: row.rstrip("\r\n") for number, row in _rows_of(file) if number in numbers}
    lines = lines_of(found) if found else []
    text = html(
        "objects.html",
        "Which objects overturn?",
        PATH,
        settings,
        given=given,
        bad_rows=[(one, _wrong_places(one, table)) for one in bad_rows if table],
        texts=texts,
        table=table,
        found=found,
        lines=lines,
        full_strength=counts_of(lines),
        warnings=[(kind, names_in_short(names), len(names)) for kind, names in warnings_of(found)] if found else [],
        own_of=lambda obj: ", ".join(filter(None, obj.details.values())),
        verdicts=VERDICTS,
        number_of=number_of,
        address=address_of,
        quantities=[quantity for quantity in INPUTS if quantity.name in MAIN],
        others=[quantity for quantity in (*INPUTS, *SHAPES) if quantity.name not in MAIN],
        units_of=UNITS_OF,
    )
    return HTMLResponse(text, headers={"Content-Security-Policy": POLICY, "Cache-Control": "no-cache"})


def _wrong_places(bad: BadRow, table: ObjectTable) -> set[int]:
    """The places of the cells that a row was not read for; none if it is the whole row."""
    if "row" in bad.columns:
        return set()
    names = [table.columns.get(label, "").partition(" [")[0] for label in bad.cells]
    return {place for place, name in enumerate(names) if name in bad.columns}
