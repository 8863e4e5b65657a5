"""`rocking assess`: formats, files, bad rows, and a report that asks nobody for anything."""

import json
import re
from html.parser import HTMLParser

import pytest
from typer.testing import CliRunner

import rocking
from rocking._cli.app import app
from tests.cli.test_cli import read_csv, refused, run

TABLE = """name,width [cm],depth [cm],height [cm],friction
bust,40,30,160,0.5
<script>alert(1)</script>,30,30,90,
=1+1,15,,60,0.3
"""
SITE = ["--pga", "0.3g", "--pgv", "0.3 m/s", "--shapes", "sine,ricker", "--no-sensitivity"]


@pytest.fixture
def table(tmp_path):
    path = tmp_path / "objects.csv"
    path.write_text(TABLE)
    return path


def test_formats_and_file_hold_the_rows_of_python(table):
    site = rocking.Site(pga="0.3 g", pgv="0.3 m/s", shapes=["sine", "ricker"])
    expected = rocking.assess(rocking.read_objects(table).objects, site, sensitivity=False)
    found = json.loads(run("assess", str(table), *SITE, "--format=json"))
    for name in expected.columns:
        assert found[name] == [row[name] for row in expected.rows], name
    assert found["motions"] == ["sine", "ricker"]
    rows = read_csv(run("assess", str(table), *SITE, "--format=csv"))
    assert [float(row["factor"]) for row in rows] == expected.columns["factor"].tolist()
    file = table.with_name("out.csv")
    shown = run("assess", str(table), *SITE, "--output", str(file)).splitlines()
    assert file.read_text() == expected.to_csv()
    assert "'=1+1" in [row["object"] for row in read_csv(file.read_text())]
    assert [line.split()[0] for line in shown[1:6]] == [name.split()[0] for name in expected.columns["object"]]


def test_bad_rows_are_named_and_the_others_assessed(table):
    table.write_text(TABLE + "bad,tall,30,90,\n\x1b[2J,0,30,90,\n")
    result = CliRunner().invoke(app, ["assess", str(table), *SITE])
    assert result.exit_code == 2
    assert "row 5, width: `width` = 'tall'" in result.stderr
    assert "row 6, width" in result.stderr
    assert "bust" in result.stdout
    assert "\x1b" not in result.output
    table.write_text("name,width [m],height [m]\nbad,tall,1\n")
    assert "row 2, width" in refused("assess", str(table), *SITE)


def test_records_and_periods(table, tmp_path):
    record = tmp_path / "record.csv"
    record.write_text("".join(f"{0.05 * k:.2f},{(-1) ** (k // 5) * 2.0}\n" for k in range(40)))
    found = json.loads(run("assess", str(table), "--record", str(record), "--unit", "m/s2", "--format=json"))
    assert len(found["motions"]) == 1
    periods = ["--pga", "0.3g", "--period-min", "0.2s", "--period-max", "1s", "--shapes", "sine"]
    assert len(json.loads(run("assess", str(table), *periods, "--no-sensitivity", "--format=json"))["motions"]) == 12


@pytest.mark.parametrize(
    ("options", "text"),
    [
        (["--pga", "0.3g"], "--pgv"),
        (["--pga", "0.3", "--pgv", "0.3 m/s"], "missing unit"),
        (["--pga", "0.3g", "--period-min", "0.2s"], "--period-max"),
        (["--pga", "0.3g", "--pgv", "0.3 m/s", "--shapes", "square"], "--shapes"),
        ([*SITE, "--output", "/none/table.csv"], "No such file"),
        (["--record", "none.at2"], "none.at2"),
    ],
)
def test_errors_name_the_option(table, options, text):
    assert text in refused("assess", str(table), *options)


def test_an_error_of_the_table_names_the_argument(table):
    assert "OBJECTS" in refused("assess", str(table.with_name("none.csv")), *SITE)
    table.write_text("a,b\n1,2\n")
    assert "OBJECTS" in refused("assess", str(table), *SITE)


class Page(HTMLParser):
    """The tags, their attributes and the text of a page."""

    def __init__(self):
        super().__init__()
        self.tags, self.attributes, self.text = [], [], ""

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        self.attributes += attrs

    def handle_data(self, data):
        self.text += data


def test_report_is_self_contained_and_escapes_names(table, monkeypatch):
    file = table.with_name("report.html")
    argv = ["assess", str(table), *SITE, "--report", str(file), "--title", "Room <7>", "--site", "Athens & Rome"]
    monkeypatch.setattr("sys.argv", ["rocking", *argv])
    table.write_text(TABLE + '"<img src=http://example.org/x>",x,1,1,\n')
    assert CliRunner().invoke(app, [*argv, "--date", "2026-11-24"]).exit_code == 2
    page = Page()
    page.feed(file.read_text())
    assert {"script", "img", "link", "iframe", "object"}.isdisjoint(page.tags)
    assert {"src", "href", "onload", "onclick"}.isdisjoint(name for name, _ in page.attributes)
    assert not re.search(r"https?://(?!example)|@import|url\(", file.read_text())
    for text in ("Room <7>", "Athens & Rome", "2026-11-24", "<script>alert(1)</script>", "row 5", "--title"):
        assert text in page.text, text
    assert page.tags.count("svg") == 5  # three objects, two of them in two directions
    assert page.text.index("Verdicts") < page.text.index("Objects")
    assert f"rocking {rocking.__version__}" in page.text
