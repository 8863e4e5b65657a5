"""The page of objects as the service renders it: rows, rows that cannot be read, report, CSV, sheets, hostile input."""

import html
import io
import re
import sys
import tracemalloc
import zipfile
from urllib.parse import urlencode

import pytest
import rocking_assessment
from rocking_assessment._objects.columns import VERDICTS
from rocking_assessment._objects.summary import _rounded_up
from rocking_assessment.service import objects_page, workbooks

from rocking._numba.cancellation import StopFlag
from tests.api.conftest import assert_problem
from tests.sheets import xlsx_bytes

TABLE = "name;width [cm];height [cm]\nvase;22;55\n<b>slab</b>;5;60\njug;wide;40\n"
SITE = {"pga": "0.3", "pga_unit": "g", "pgv": "30", "pgv_unit": "cm/s"}


@pytest.fixture(scope="module")
def text(client):
    return client.post("/objects", data={"table": TABLE, **SITE}).text


@pytest.fixture(scope="module")
def found():
    return rocking_assessment.assess(
        [
            rocking_assessment.Object("vase", width=0.22, height=0.55),
            rocking_assessment.Object("slab", width=0.05, height=0.6),
        ],
        rocking_assessment.Site(pga="0.3 g", pgv="30 cm/s"),
    )


def cell(row, name, scale):
    label = {"factor": "Overturns from factor", "smallest_width": "Base needed [cm]"}[name]
    start = f'<td data-value="{row[name]}" data-label="{label}">'
    shown = f"{scale * row[name]:.3g}" if name == "factor" else f"{_rounded_up(row[name]) * scale:.3g}"
    return start + shown


def test_rows_are_those_of_the_package_the_worst_first(text, found):
    assert re.findall(r'<th scope="row"><a [^>]*>(.*?)</a>', text) == ["&lt;b&gt;slab&lt;/b&gt;", "vase"]
    for row in found.rows:
        assert f'<span class="badge verdict-{VERDICTS.index(row["verdict"])}">{row["verdict"]}</span>' in text
        assert cell(row, "factor", 1) in text
        assert cell(row, "smallest_width", 100) in text
    assert 'width="0.22" height="0.55"' in text  # the drawing has the proportions of the object
    assert "<b>" not in text


def test_where_no_row_is_read_each_has_its_fields(client):
    none = client.post("/objects", data={"table": "name;width [cm];height [cm]\njug;wide;40", **SITE})
    assert none.status_code == 200
    assert 'name="cell-2-1"' in none.text


ROWS = [
    *("\n", "# My objects\f1\n", "name;width [cm];height [cm];notes\n", 'vase;22;55;"two\nlines\u2028or three"\n'),
    *("jug;wide;40;a\x0cb\u2028c\r\n", '"slab\n2";5;high;\n', "\n", "cup;;9;"),
]


def table_of(text):
    """The table of the form; its first line end is dropped."""
    return html.unescape(re.search(r'<textarea id="table".*?>\n(.*?)</textarea>', text, re.DOTALL)[1])


def test_rows_are_those_of_the_table_whatever_ends_a_line(client):
    given = {"table": "".join(ROWS), **SITE}
    text = client.post("/objects", data=given).text
    assert re.findall(r'name="cell-(\d-\d)"', text) == ["5-1", "6-2", "8-1"]
    assert "wide" in re.search(r'id="reason-5">(.*?)</p>', text)[1]
    assert table_of(text) == "".join(ROWS)
    text = client.post("/objects", data=given | {"cell-5-1": "20", "cell-6-2": "60", "cell-8-1": "9"}).text
    assert "were not read" not in text
    mended = [*ROWS[:4], "jug;20;40;a\x0cb\u2028c\r\n", '"slab\n2";5;60;\n', ROWS[6], "cup;9;9;"]
    assert table_of(text) == "".join(mended)


def test_a_row_with_too_many_cells_is_mended_as_a_line(client):
    table = "name;width [cm];height [cm]\nvase;22;55\njug;20;40;9\n"
    text = client.post("/objects", data={"table": table, **SITE}).text
    assert re.findall(r'name="line-3" form="objects" value="(.*?)"', text) == ["jug;20;40;9"]
    assert "were not read" not in client.post("/objects", data={"table": table, **SITE, "line-3": "jug;20;40"}).text


def test_fields_of_the_form_are_limited(client):
    given = {"table": TABLE, **SITE}
    many = {f"line-{number}": "" for number in range(100, 200)}
    assert_problem(client.post("/objects", data=given | many), 413, "form")
    assert_problem(client.post("/objects", data=given | {"table": "a" * (objects_page.MAX_BODY + 1)}), 413, "table")


def test_escapes_of_a_form_take_little_memory(monkeypatch):
    body = b"table=" + b"%0A" * 2**18
    tracemalloc.start()
    assert objects_page._fields(body, StopFlag())["table"] == "\n" * 2**18
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 10 * len(body)  # 80 by urllib
    text = "100 %; 1+1 & =\u20ac\r\n" * 5
    for part in (3, 4, 5):
        monkeypatch.setattr(objects_page, "PART", part)
        assert objects_page._fields(urlencode({"table": text}).encode(), StopFlag())["table"] == text


def test_report_and_csv_are_those_of_the_package(client, found):
    given = {"table": TABLE, **SITE}
    report = client.post("/objects/report", data=given | {"pga": " 0,3", "pgv": "3e1"})
    assert "default-src 'none'" in report.headers["content-security-policy"]
    assert f"{found.rows[0]['factor']:.3g}" in report.text
    assert "rocking assess TABLE --pga 0.3g --pgv 3e1cm/s" in report.text
    table = client.post("/objects/assessment.csv", data=given)
    assert "attachment" in table.headers["content-disposition"]
    assert table.text.count("not read") == 1


def test_an_error_names_its_field(client):
    assert_problem(client.post("/objects", data={"table": TABLE, **SITE, "pga": "much"}), 422, "pga")
    assert_problem(client.post("/objects", data={"table": "", **SITE}), 422)
    page = client.post("/objects", data={"table": TABLE, **SITE, "pgv": "0"}, headers={"accept": "text/html"})
    assert (page.status_code, page.headers["content-type"]) == (422, "text/html; charset=utf-8")


def test_a_preview_shows_what_would_be_read(client):
    table = "List of 2026\nName;Breite (cm);Höhe;Material\nvase;22,5;55 cm;clay\njug;wide;40 cm;clay\n"
    found = client.post("/objects/preview", data={"table": table, **SITE}).json()
    assert (found["objects"], found["missing"]) == (0, ["width or diameter", "height or mass_height"])
    stated = {"skip": "1", "decimal": ",", "columns": "Breite (cm)=width [cm]\nHöhe=height", "table_name": "a b.csv"}
    found = client.post("/objects/preview", data={"table": table, **SITE, **stated}).json()
    assert found["labels"] == ["Name", "Breite (cm)", "Höhe", "Material"]
    assert (found["named"], found["units"]["Breite (cm)"]) == ({"Name": "name"}, {"m": "cm"})
    assert [line["number"] for line in found["lines"]] == [1, 2, 3, 4]
    assert (found["names_line"], found["missing"], found["problem"]) == (2, [], None)
    assert found["first"] == [{"name": "vase", "bases": {"width": 0.225}, "height": 0.55}]
    assert (found["objects"], found["bad_rows"], found["skipped"]) == (1, 1, ["Material"])
    words = ["--columns", "Breite (cm)=width [cm]", "--columns", "Höhe=height", "--decimal", ",", "--skip", "1"]
    assert found["command"] == ["rocking", "assess", "a b.csv", "--pga", "0.3g", "--pgv", "30cm/s", *words]
    unclosed = client.post("/objects/preview", data={"table": 'name;width [cm];height [cm]\n"vase;2;3', **SITE}).json()
    assert unclosed["problem"]["line"] == 2
    assert unclosed["lines"][1] == {"number": 2, "text": '"vase;2;3', "cells": []}
    assert_problem(client.post("/objects/preview", data={"table": table, "skip": "many"}), 422, "skip")


def test_a_sheet_is_text_with_the_decimal_sign(client):
    content = xlsx_bytes([["name", "height"], ["2,5", 2.5]])
    url = "/objects/text?name=a.xlsx"
    assert client.post(url, content=content).text == 'name,height\n"2,5",2.5\n'
    assert client.post(f"{url}&decimal=,", content=content).text == 'name,height\n"2,5","2,5"\n'
    problem = assert_problem(client.post(f"{url}&sheet=b", content=content), 422, "table")
    assert problem["allowed"] == "the argument `sheet`, one of: a"
    assert_problem(client.post("/objects/text?name=a.csv", content=b"a"), 415, "table")
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("xl/workbook.xml", bytes(33 * 1024 * 1024))
    url = "/objects/text?name=huge.xlsx"
    assert_problem(client.post(url, content=packed.getvalue()), 413, "table")
    assert_problem(client.post(url, content=b"no archive"), 422, "table")


@pytest.mark.skipif(sys.platform != "linux", reason="limits of a process are those of Linux")
def test_a_sheet_whose_cells_are_far_apart_ends_its_own_process_only(client):
    """The reader allocates the rectangle between them: 2**34 cells, 550 GB, and aborts."""
    content = xlsx_bytes([["object"]], last="XFD1048576")
    problem = assert_problem(client.post("/objects/text?name=far.xlsx", content=content), 422, "table")
    assert problem["value"] == "far.xlsx"
    assert problem["allowed"] == "a table that is read within 10 s and 1024 MiB"
    assert client.get("/health").status_code == 200


def test_sheets_need_their_package(client, monkeypatch):
    monkeypatch.setattr(workbooks, "find_spec", lambda _: None)
    problem = assert_problem(client.post("/objects/text?name=a.xlsx", content=xlsx_bytes([["object"]])), 415, "table")
    assert "rocking[sheets]" in problem["detail"]


ON_FLOOR = {"table": TABLE, **SITE, "floor_periods": "0.5, 0.2", "floor_participation": "1.3,-0.3"}


def test_the_floor_of_the_form_is_that_of_the_assessment(client, found, monkeypatch):
    """On a floor an assessment takes ten seconds; here another one takes its place."""
    sites = []
    monkeypatch.setattr(objects_page, "assess", lambda _, site, **__: sites.append(site) or found)
    text = client.post("/objects", data=ON_FLOOR).text
    assert "on a floor of a building of 0.5, 0.2 s</h2>" in text
    command = "rocking assess TABLE --pga 0.3g --pgv 30cm/s --floor 0.5s,0.2s --floor-participation 1.3,-0.3"
    assert command in client.post("/objects/report", data=ON_FLOOR).text
    for site in sites:
        assert (site.floor_periods, site.floor_participation) == ((0.5, 0.2), (1.3, -0.3))


def test_periods_of_a_building_that_are_not_allowed_are_named(client):
    for wrong in ("high", "0,5 s", "nan", "-1", "0.5," * 51):
        problem = assert_problem(client.post("/objects", data={"table": TABLE, **SITE, "floor_periods": wrong}), 422)
        assert "periods" in problem["detail"]
