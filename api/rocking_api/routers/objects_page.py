"""The page of objects: a table as text, which can be mended in place, and its assessment, rendered here."""

from __future__ import annotations

import io
import re
import shlex
import zipfile
from datetime import UTC, datetime
from importlib.util import find_spec
from itertools import islice
from pathlib import PurePath
from urllib.parse import unquote_to_bytes

from fastapi import APIRouter, Request, Response
from fastapi.responses import HTMLResponse, PlainTextResponse

from rocking._assessment.assess import assess
from rocking._assessment.columns import VERDICTS
from rocking._assessment.report import Project, report_html
from rocking._assessment.result import Assessment
from rocking._assessment.tables import SCHEMA, ObjectTable, objects_of_csv
from rocking._base.errors import InvalidArgumentError, plain_numbers
from rocking._dimensional.table_reader import MARK, SHEETS, rows_of_csv, text_of
from rocking._numba.cancellation import StopFlag
from rocking_api.http.caching import revalidated
from rocking_api.http.encoding import text_response
from rocking_api.http.errors import TooLargeError, UnsupportedBodyError
from rocking_api.limited_process import result_of
from rocking_api.models.assess import MAX_OBJECTS
from rocking_api.routers.assess import MAX_BODY, check_table
from rocking_api.routers.object_page import SITE, address_of, quantity_of, site_of
from rocking_api.routers.pages import POLICY, REPORT_POLICY, STATIC, html
from rocking_api.service import Service, ServiceDep

MAX_SHEET = 32 * 1024 * 1024
"""Largest unpacked file of a sheet [bytes]."""

MAX_SENSITIVITY = 200
"""Objects up to which sizes that survive and changed objects are assessed as well [-]: these take most of the time."""

MAX_FIELDS = 100
"""Most fields of the form [-]: those of the site, and of rows that are corrected."""

MAX_CORRECTED = 50
"""Most rows that are corrected at a time [-]."""

PART = 65536
"""Characters of a form whose escapes are replaced at a time [-]."""

PATH = "/objects"

DEFAULTS = SITE | {"table": "", "title": "Objects at a site"}

router = APIRouter(prefix=PATH, include_in_schema=False)


@router.get("")
async def get_objects_page(request: Request, sample: str | None = None) -> Response:
    """The page, empty or with the table of the guide."""
    table = "" if sample is None else (STATIC / "collection.csv").read_text("utf-8")
    return revalidated(request, _page(DEFAULTS | {"table": table}))


@router.post("")
async def post_objects_page(request: Request, service: ServiceDep) -> Response:
    """The page with the assessment of the table in its form."""
    given = await _form(request, service)
    table, found = await _assessed(given, request, service)
    return await service.run_io(lambda: _page(given, table=table, found=found))


@router.post("/report")
async def post_report(request: Request, service: ServiceDep) -> Response:
    """The report of the assessment, to print."""
    given = await _form(request, service)
    table, found = await _assessed(given, request, service)
    words = ["rocking", "assess", "TABLE"]
    for name in ("pga", "pgv"):
        words += [f"--{name}", quantity_of(given, name).replace(" ", "")]
    if given["floor_periods"].strip():
        periods, participation = (plain_numbers(name, given[name]) for name in ("floor_periods", "floor_participation"))
        words += ["--floor", ",".join(f"{one}s" for one in periods)]
        words += ["--floor-participation", ",".join(map(str, participation))]
    project = Project(given["title"], "", "", datetime.now(UTC).date().isoformat(), shlex.join(words))
    text = await service.executor.run(lambda _: report_html(found, project, table.bad_rows, table.reading), request)
    return HTMLResponse(text, headers={"Content-Security-Policy": REPORT_POLICY})


@router.post("/assessment.csv")
async def post_csv(request: Request, service: ServiceDep) -> Response:
    """The assessment as CSV."""
    table, found = await _assessed(await _form(request, service), request, service)
    return text_response(await service.run_io(lambda: found.to_csv(bad_rows=table.bad_rows)), "assessment")


@router.post("/text")
async def post_text(request: Request, service: ServiceDep, name: str = "") -> Response:
    """The text of a file, of a sheet as CSV."""
    body = await service.read_body(request, MAX_BODY)
    in_process = _ending(name) in SHEETS
    text = await service.run_parser(lambda stop: _text(body, name, stop), request, True, in_process=in_process)
    return PlainTextResponse(text)


def _ending(name: str) -> str:
    return PurePath(name).suffix.lower()


def _text(raw: bytes, name: str, stop: StopFlag) -> str:
    ending = _ending(name)
    if ending not in SHEETS:
        return text_of(raw)
    if find_spec("python_calamine") is None:
        raise UnsupportedBodyError("table", ending, 'CSV: sheets need pip install "rocking[sheets]" on the service')
    try:
        size = sum(one.file_size for one in zipfile.ZipFile(io.BytesIO(raw)).infolist())
    except zipfile.BadZipFile:
        raise InvalidArgumentError("table", name, "a sheet, which is a zip archive") from None
    if size > MAX_SHEET:  # as stated; what is there is bounded by the memory of the process
        raise TooLargeError("table", size, f"at most {MAX_SHEET} bytes, unpacked")
    text: str = result_of("rocking_api.sheet_process", raw, "table", name, stop)["text"]
    return text


async def _form(request: Request, service: Service) -> dict[str, str]:
    body = await service.read_body(request, 3 * MAX_BODY)  # with signs that are escaped
    return await service.run_parser(lambda stop: _fields(body, stop), request, large=True)


def _fields(body: bytes, stop: StopFlag) -> dict[str, str]:
    """The fields of the form; fields `line-N` take the place of rows of the table."""
    count = body.count(b"&") + 1
    if count > MAX_FIELDS:
        raise TooLargeError("form", f"{count} fields", f"at most {MAX_FIELDS}")
    parts = (part.partition(b"=") for part in body.split(b"&"))
    fields = DEFAULTS | {_unescaped(name, stop): _unescaped(value, stop) for name, _, value in parts}
    if len(fields["table"]) > MAX_BODY:
        raise TooLargeError("table", f"{len(fields['table'])} characters", f"at most {MAX_BODY}")
    lines = [int(name[5:]) for name in fields if re.fullmatch("line-[0-9]{1,9}", name)]
    if lines:
        rows = list(islice(rows_of_csv(fields["table"], SCHEMA, stop), max(lines)))
        rest = fields["table"].removeprefix(MARK)[sum(map(len, rows)) :]
        for number in (one for one in lines if 0 < one <= len(rows)):
            row = rows[number - 1]
            rows[number - 1] = fields[f"line-{number}"] + row[len(row.rstrip("\r\n")) :]
        fields["table"] = "".join([*rows, rest])
    return fields


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


async def _assessed(given: dict[str, str], request: Request, service: Service) -> tuple[ObjectTable, Assessment]:
    site = site_of(given)
    table = await service.run_parser(
        lambda stop: objects_of_csv(given["table"], MAX_OBJECTS, stop), request, large=True
    )
    check_table(table, "table")

    def run(stop: StopFlag) -> Assessment:
        return assess(table.objects, site, sensitivity=len(table.objects) <= MAX_SENSITIVITY, stop=stop)

    await service.kernels.wait()
    return table, await service.executor.run(run, request)


def _page(given: dict[str, str], *, table: ObjectTable | None = None, found: Assessment | None = None) -> HTMLResponse:
    bad_rows = table.bad_rows[:MAX_CORRECTED] if table else []
    shown = {one.row for one in bad_rows}
    rows = islice(enumerate(rows_of_csv(given["table"], SCHEMA), start=1), max(shown, default=0))
    text = html(
        "objects.html",
        "Which objects overturn?",
        PATH,
        given=given,
        bad_rows=bad_rows,
        lines={number: row.rstrip("\r\n") for number, row in rows if number in shown},
        table=table,
        found=found,
        verdicts=VERDICTS,
        address=address_of,
    )
    return HTMLResponse(text, headers={"Content-Security-Policy": POLICY, "Cache-Control": "no-cache"})
