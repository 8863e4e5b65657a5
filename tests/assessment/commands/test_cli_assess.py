"""`rocking assess`: formats, files, bad rows, and a report that asks nobody for anything."""

import csv
import json
import os
import re
import subprocess
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import rocking_assessment
from typer.testing import CliRunner

import rocking
from rocking._cli.app import app
from tests.api.explorer.chromium import HOW, find
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
    site = rocking_assessment.Site(pga="0.3 g", pgv="0.3 m/s", shapes=["sine", "ricker"])
    expected = rocking_assessment.assess(rocking_assessment.read_objects(table).objects, site, sensitivity=False)
    printed = json.loads(run("assess", str(table), *SITE, "--format=json"))
    for name in expected.columns:
        assert printed[name] == [row[name] for row in expected.rows], name
    assert printed["motions"] == ["sine", "ricker"]
    rows = read_csv(run("assess", str(table), *SITE, "--format=csv"))
    assert [float(row["factor"]) for row in rows] == expected.columns["factor"].tolist()
    file = table.with_name("out.csv")
    run("assess", str(table), *SITE, "--output", str(file))
    assert file.read_text() == expected.to_csv()
    assert "'=1+1" in [row["object"] for row in read_csv(file.read_text())]


INVENTORY = """Inv. no.;name;material;location;room;remarks;width [mm];depth [mm];height (cm);made
0012;Kore;marble;hall;3;"check; soon";340;260;121.5;-520
0007;Stele;marble;stair;;loan;580;160;137.0;-400
0030;Altar;limestone;garden;1;;900;800;60.0;
0031;Herm;marble;hall;2;;270;220;wide;
"""
ASKED = [
    *("Inv. no.", "object", "verdict", "overturns from factor", "at full strength by", "PGA [g]"),
    *("governing motion", "moves by [cm]", "base needed [cm]", "wider by [cm]", "what to do first"),
]
PULSES = ["--pga", "0.3g", "--pgv", "0.3 m/s", "--shapes", "sine,cosine"]


def cells(text, lines):
    """The cells of a printed table."""
    return [re.split(r"\s{2,}", line.strip()) for line in text.splitlines()[:lines]]


def test_a_line_an_object_answers_the_questions_in_units_that_people_use(table):
    rows = csv.reader(INVENTORY.replace("wide", "152.0").splitlines(), delimiter=";")
    table.write_text("\n".join(";".join([*row[:2], *row[6:9]]) for row in rows))
    header, *lines = cells(run("assess", str(table), *PULSES), 5)
    assert header == ASKED
    site = rocking_assessment.Site("0.3 g", "0.3 m/s", shapes=["sine", "cosine"])
    assessment = rocking_assessment.assess(rocking_assessment.read_objects(table).objects, site)
    worst = {row["object"]: row for row in reversed(assessment.rows)}
    assert [line[1] for line in lines] == [*dict.fromkeys(row["object"] for row in assessment.rows)]
    for line in lines[:-1]:
        row, depth = worst[line[1]], {"Kore": 26.0, "Stele": 16.0, "Herm": 22.0}[line[1]]
        expected = [row["factor"], 0.3 * row["factor"], 100 * row["displacement"], 100 * row["smallest_width"]]
        assert [float(line[k]) for k in (3, 5, 7, 8)] == pytest.approx(expected, rel=1e-2)
        assert all(len(line[k].replace(".", "").lstrip("0")) <= 3 for k in (3, 5, 7, 8))
        assert float(line[9]) == pytest.approx(max(0.0, expected[3] - depth), rel=1e-2, abs=0.02)
        assert [line[2], line[6]] == [row["verdict"], row["governing"]]
        assert line[4].startswith(f"{round(2 * row['share_at_full_strength'])} of 2")
        assert ("fix it" in line[10]) == (row["share"] > 0.0)
    assert lines[-1] == ["0030", "Altar", "stays", "> 10", "0 of 2", "-", "-", "0", "14.2", "0", "nothing"]
    both = cells(run("assess", str(table), *PULSES, "--directions"), 9)
    assert both[0][2] == "direction"
    assert [(row[1], row[2]) for row in both[1:3]] == [("Stele", "depth"), ("Stele", "width")]


def test_a_missing_depth_is_said_in_every_output(table):
    """0.85 m wide and 1.7 m high; with a depth of 0.06 m it overturns from a factor of 0.23."""
    table.write_text("name,width [cm],depth [cm],height [cm]\nshelf,85,,170\nscreen,20,,200\nchest,80,80,80\n")
    report, file, book = (table.with_name(f"out.{ending}") for ending in ("html", "csv", "xlsx"))
    options = [*PULSES, "--no-sensitivity"]
    lines = cells(run("assess", str(table), *options, "--report", str(report), "--output", str(file)), 4)
    assert [line[1] for line in lines[1:]] == ["overturns in some motions", "depth missing", "stays"]
    assert lines[1][-1] == "measure the depth, then fix it, or widen the base"
    assert lines[2][-1] == "measure the depth"
    expected = {"screen": "overturns in some motions", "shelf": "depth missing", "chest": "stays"}
    printed = json.loads(run("assess", str(table), *options, "--format=json"))
    assert dict(zip(printed["object"], printed["verdict"], strict=True)) == expected
    assert {row["name"]: row["verdict"] for row in read_csv(file.read_text())} == expected
    run("assess", str(table), *options, "--output", str(book))
    sheet = pd.read_excel(book, engine="calamine")
    assert dict(zip(sheet["name"], sheet["verdict"], strict=True)) == expected
    text = Page(report.read_text()).text
    assert "shelf: depth missing" in text
    assert "measure the depth" in text
    thin = rocking_assessment.assess(
        rocking_assessment.Object("shelf", width=0.85, height=1.7, depth=0.06),
        rocking_assessment.Site("0.3 g", "0.3 m/s"),
    )
    assert thin.columns["factor"].min() == pytest.approx(0.23, abs=0.01)


def test_warnings_are_grouped_and_say_the_side(table):
    header, rows = INVENTORY.split("\n", 1)
    rows = rows.replace("\n", ";\n") + "0050;Vase;clay;;;;;;46.5;;12\n0051;Urn;clay;;;;;;46.5;;12.5\n"
    table.write_text(f"{header};diameter [cm]\n{rows}")
    text = CliRunner().invoke(app, ["assess", str(table), *PULSES, "--no-sensitivity"]).stdout
    assert [line.removeprefix("warning: ") for line in text.splitlines() if line.startswith("warning")] == [
        "5 objects: no coefficient of friction is given: sliding is not assessed: Stele; Vase; Urn; Kore; Altar",
        "2 objects: within 20 %, on the safe side: Vase; Urn",
        "2 objects: round base: the plane model leaves out wobbling and rolling: Vase; Urn",
    ]
    scaled = ["--pga", "0.33g", "--pgv", "0.33 m/s"]
    text = CliRunner().invoke(app, ["assess", str(table), *PULSES, "--no-sensitivity", *scaled]).stdout
    assert "warning: 2 objects: within 20 %, on the unsafe side: Vase; Urn" in text


def test_the_table_goes_through_to_every_file_as_it_stands(table):
    table.write_text(INVENTORY)
    file, book = table.with_name("out.csv"), table.with_name("out.xlsx")
    for output in (file, book):
        assert CliRunner().invoke(app, ["assess", str(table), *PULSES, "--output", str(output)]).exit_code == 2
    inventory = list(csv.DictReader(INVENTORY.splitlines(), delimiter=";"))
    rows = list(csv.DictReader(file.read_text().splitlines()))
    assert list(rows[0])[:11] == [*inventory[0], "object"]
    by_name = {row["name"]: row for row in inventory}
    for row in rows:
        assert {name: row[name] for name in inventory[0]} == by_name[row["name"]]
        assert row["object"] == (row["name"] if row["verdict"] != "not read" else "row 5")
    assert rows[-1]["Inv. no."] == "0031"
    sheet = pd.read_excel(book, engine="calamine", dtype=object)
    assert list(sheet) == list(rows[0])
    assert sheet["width [mm]"].tolist() == [row["width [mm]"] for row in rows]
    assert sheet["Inv. no."].tolist()[-1] == "0031"
    factors = [float(row["factor"] or "nan") for row in rows]  # a workbook has 16 digits
    assert sheet["factor"].tolist() == pytest.approx(factors, rel=1e-15, nan_ok=True)


def test_bad_rows_are_named_and_the_others_assessed(table):
    table.write_text(TABLE + "bad,tall,30,90,\n\x1b[2J,0,30,90,\n")
    result = CliRunner().invoke(app, ["assess", str(table), *SITE])
    assert result.exit_code == 2
    assert "row 5, width: 'tall'" in result.stderr
    assert "row 6, width" in result.stderr
    assert "bust" in result.stdout
    assert "\x1b" not in result.output


def test_records_and_periods(table, tmp_path):
    record = tmp_path / "record.csv"
    rows = "".join(f"{0.05 * k:.2f},{(-1) ** (k // 5) * 2.0}\n" for k in range(40))
    record.write_text(f"time [s],acceleration\n{rows}")
    periods = "--pga", "0.3g", "--period-min", "0.2s", "--period-max", "1s", "--shapes", "sine", "--no-sensitivity"
    for options, count in ((("--record", str(record), "--unit", "m/s2"), 1), (periods, 12)):
        assert len(json.loads(run("assess", str(table), *options, "--format=json"))["motions"]) == count


def test_pairs_with_vertical_on_a_floor_with_a_hazard_curve(table, tmp_path):
    times = 0.05 * np.arange(60)
    x, y, z = np.round([np.sin(4 * times), np.cos(3 * times), 0.2 * np.sin(9 * times)], 6)
    for name, values in (("x", x), ("y", y), ("z", z)):
        np.savetxt(tmp_path / f"{name}.csv", np.column_stack([times, values]), "%.6f", ",", header=HEADER, comments="")
    files = {name: str(tmp_path / f"{name}.csv") for name in "xyz"}
    curve = tmp_path / "PGA" / "curves.csv"
    curve.parent.mkdir()
    curve.write_text("lon,lat,0.05,0.2,1.0\n0,0,1e-2,1e-3,1e-5\n")
    options = ["--pair", f"{files['x']},{files['y']}", "--vertical", files["z"], "--unit", "m/s2", "--pga", "2 m/s2"]
    options += ["--hazard", str(curve), "--floor", "0.5s", "--floor-participation", "1.3"]
    printed = json.loads(run("assess", str(table), *options, "--no-sensitivity", "--format=json"))
    pair = rocking.Record(x, 0.05, "m/s2", vertical=z), rocking.Record(y, 0.05, "m/s2")
    hazard = rocking_assessment.read_hazard(curve)
    site = rocking_assessment.Site(2.0, records=[pair], hazard=hazard, floor_periods=0.5, floor_participation=1.3)
    expected = rocking_assessment.assess(rocking_assessment.read_objects(table).objects, site, sensitivity=False)
    for name in ("factor", "share", "annual_rate"):
        assert printed[name] == [row[name] for row in expected.rows], name
    assert len(printed["motions"]) == 12
    assert "--vertical" in refused("assess", str(table), *options, "--vertical", files["z"])
    assert "--pair" in refused("assess", str(table), "--pair", files["x"], "--unit", "m/s2")


def test_meshes_are_assessed_from_all_sides(tmp_path):
    trimesh = pytest.importorskip("trimesh")
    path = tmp_path / "plinth.stl"
    trimesh.creation.box((400, 300, 1600)).export(path)
    options = ["--mesh", str(path), "--mesh-unit", "mm", "--friction", "0.5", *SITE]
    printed = json.loads(run("assess", *options, "--format=json"))
    assert sorted(printed["direction"]) == sorted(f"{angle} deg" for angle in range(0, 180, 15))
    assert set(printed["object"]) == {"plinth"}
    site = rocking_assessment.Site(pga="0.3 g", pgv="0.3 m/s", shapes=["sine", "ricker"])
    block = rocking_assessment.assess(
        rocking_assessment.Object("block", width=0.4, depth=0.3, height=1.6), site, sensitivity=False
    )
    factors = dict(zip(block.columns["direction"], block.columns["factor"], strict=True))
    by_angle = dict(zip(printed["direction"], printed["factor"], strict=True))
    assert by_angle["0 deg"] == pytest.approx(factors["width"], rel=1e-6)
    assert by_angle["90 deg"] == pytest.approx(factors["depth"], rel=1e-6)
    assert "OBJECTS" in refused("assess", *SITE)
    assert "--mesh-unit: missing; the unit of the lengths" in refused("assess", *options[:2], *SITE)
    assert "--allow-unusual" in refused("assess", *options[:2], "--mesh-unit", "m", *SITE)
    assert "--mesh-up" in refused("assess", *options, "--mesh-up", "w")


@pytest.mark.parametrize(
    ("options", "text"),
    [
        (["--pga", "0.3g"], "--pgv"),
        (["--pga", "0.3", "--pgv", "0.3 m/s"], "missing unit"),
        (["--pga", "0.3g", "--period-min", "0.2s"], "--period-max"),
        (["--pga", "0.3g", "--pgv", "0.3 m/s", "--shapes", "square"], "--shapes"),
        ([*SITE, "--output", "/none/table.csv"], "No such file"),
        (
            [*SITE, "--output", "table.doc"],
            "--output: 'table.doc' is not allowed; allowed: a name that ends in .csv or .xlsx",
        ),
        (["--record", "none.at2"], "none.at2"),
        ([*SITE, "--friction", "0.5"], "--friction"),
        ([*SITE, "--report", "report.pdf"], "'report.pdf' is not allowed; allowed: a name that ends in .html"),
        ([*SITE, "--floor", "x"], "--floor-periods"),
    ],
)
def test_errors_name_the_option(table, options, text):
    assert text in refused("assess", str(table), *options)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"a,b\n1,2\n", "objects.csv, line 1: found a; b"),
        (b"name,width [m],height [m]\nbad,tall,1\n", "row 2, width"),
        (b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR", "OBJECTS: 'binary content' is not allowed; allowed: text"),
    ],
)
def test_an_error_of_the_table_names_the_argument(table, content, message):
    table.write_bytes(content)
    assert message in refused("assess", str(table), *SITE)


class Page(HTMLParser):
    """The tags, their attributes and the text of a page."""

    def __init__(self, text):
        super().__init__()
        self.tags, self.attributes, self.text = [], [], ""
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        self.attributes += attrs

    def handle_data(self, data):
        self.text += data


def test_report_is_self_contained_and_escapes_names(table, monkeypatch):
    file = table.with_name("report.html")
    argv = ["assess", str(table), *SITE, "--report", str(file), "--title", "Room <7>", "--author", "A & B"]
    argv += ["--site", "Athens & Rome"]
    monkeypatch.setattr("sys.argv", ["rocking", *argv])
    table.write_text(TABLE + '"<img src=http://example.org/x>",x,1,1,\n')
    assert CliRunner().invoke(app, [*argv, "--date", "2026-11-24"]).exit_code == 2
    page = Page(file.read_text())
    assert {"script", "img", "link", "iframe", "object"}.isdisjoint(page.tags)
    assert {"src", "onload", "onclick"}.isdisjoint(name for name, _ in page.attributes)
    assert all(value.startswith("#") for name, value in page.attributes if name == "href")
    assert not re.search(r"https?://(?!example)|@import|url\(", file.read_text())
    for text in ("Room <7>", "Athens & Rome", "A & B", "2026-11-24", "<script>alert(1)</script>", "row 5", "--title"):
        assert text in page.text, text
    # three drawings on the first page; two objects that rock, one in both directions, with rotation and thresholds
    assert page.tags.count("svg") == 3 + (2 + 2) + (1 + 2)
    assert page.tags.count("math") == 4
    assert page.text.index("What it means") < page.text.index("All objects") < page.text.index("Model and assumptions")
    assert f"rocking {rocking.__version__}" in page.text
    assert CliRunner().invoke(app, [*argv, "--detail", "all"]).exit_code == 2
    assert file.read_text().count('<section class="block"') == 5  # each direction of each object


HEADER = "time [s],acceleration [m/s2]"
COLLECTION = Path(__file__).parents[3] / "docs" / "assessment" / "collection.csv"


OVERFLOWING = """
const body = document.body.getBoundingClientRect();
const drawn = [...document.body.querySelectorAll("*")].filter((part) => part.getClientRects().length);
const wide = drawn.filter((part) => {
  const { left, right } = part.getBoundingClientRect();
  const outside = left < body.left - 1 || right > body.right + 1;
  const { overflow, display } = getComputedStyle(part);
  const box = display !== "inline" && !part.ownerSVGElement && part.tagName.toLowerCase() !== "svg";
  const cut = overflow === "hidden" && part.scrollHeight > part.clientHeight + 1;
  return outside || (box && part.clientWidth && part.scrollWidth > part.clientWidth + 1) || (box && cut);
});
const labels = [...document.querySelectorAll("svg text")].filter((text) => {
  const { left, right, top, bottom } = text.getBoundingClientRect();
  const picture = text.ownerSVGElement.getBoundingClientRect();
  const beside = left < picture.left - 1 || right > picture.right + 1;
  return beside || top < picture.top - 1 || bottom > picture.bottom + 1;
});
const named = (part) => `${part.tagName} ${part.textContent.trim().slice(0, 40)}`;
document.title = [...wide, ...labels].map(named).join("|");
"""
"""The title of the page lists what is wider than its box, or cut by it; it is empty if nothing is."""


def of_browser(*flags):
    """What the browser prints with some flags; skipped without a browser."""
    browser = find()
    if browser is None:
        pytest.skip(HOW)
    command = [str(browser.path), *browser.flags, "--headless", *flags]
    surroundings = os.environ | browser.environment
    return subprocess.run(command, env=surroundings, check=True, capture_output=True, text=True).stdout


def overflowing(file):
    """What is wider than its box in a report, at the width of its page."""
    copy = file.with_name("copy.html")
    copy.write_text(file.read_text().replace("</body>", f"<script>{OVERFLOWING}</script></body>"))
    document = of_browser("--window-size=700,1000", "--dump-dom", copy.as_uri())
    return re.search("<title>(.*?)</title>", document, re.DOTALL)[1]


def pages_of(file):
    """Number of pages of a report that is printed."""
    paper = file.with_suffix(".pdf")
    of_browser("--no-pdf-header-footer", f"--print-to-pdf={paper}", file.as_uri())
    return len(re.findall(rb"/Type /Page\b(?!s)", paper.read_bytes()))


@pytest.mark.long
def test_nothing_in_a_report_is_wider_than_its_box(table):
    trimesh = pytest.importorskip("trimesh")
    header, *rows = INVENTORY.splitlines()
    long = rows[0].replace("check; soon", "check; soon: " + 12 * "the_base_has_a_crack ")
    table.write_text("\n".join([header, long, *rows[1:3]]) + "\n")
    mesh, report = table.with_name(f"{'a_long_name_of_a_mesh' * 3}.stl"), table.with_name("report.html")
    trimesh.creation.box((0.5, 0.3, 1.6)).export(mesh)
    times = 0.05 * np.arange(60)
    for name, values in (("x", np.sin(4 * times)), ("y", np.cos(3 * times))):
        lines = np.column_stack([times, 4.0 * values])
        np.savetxt(table.with_name(f"{name}.csv"), lines, "%.6f", ",", header=HEADER, comments="")
    pair = f"{table.with_name('x.csv')},{table.with_name('y.csv')}"
    site = ["--pga", "0.3g", "--pgv", "0.3m/s"]
    periods = ["--pga", "0.3g", "--period-min", "0.2s", "--period-max", "1s", "--no-sensitivity"]
    everything = ["--standards", "all", "--detail", "all", "--samples", "10"]
    for options in (
        [str(table), *site, "--standards", "all"],
        ["--mesh", str(mesh), "--mesh-unit", "m", *site, "--standards", "all"],
        [str(table), *site, *everything],
        [str(table), "--pair", pair, "--unit", "m/s2", "--standards", "all", "--no-sensitivity"],
        [str(table), *periods],
    ):
        run("assess", *options, "--report", str(report))
        assert overflowing(report) == "", options
        assert Page(report.read_text()).text.count("0.2 s of 0.2 s") == 0
    assert "room: 3" in Page(report.read_text()).text.partition("All objects")[2].partition("No.:")[0]


def test_the_report_of_one_object_has_no_blank_pages(table):
    table.write_text("name,width [cm],depth [cm],height [cm]\nbust,40,30,160\n")
    report = table.with_name("report.html")
    run("assess", str(table), *SITE, "--report", str(report))
    assert pages_of(report) <= 3


@pytest.mark.long
def test_the_report_of_thirty_objects_is_short_and_nothing_in_it_is_cut(tmp_path):
    file = tmp_path / "report.html"
    printed = run("assess", str(COLLECTION), "--pga", "0.3g", "--pgv", "0.3m/s", "--report", str(file))
    guide = COLLECTION.with_name("assess.md").read_text()
    example = re.search(r"```text\n(inventory number  .*?)```", guide, re.DOTALL)[1].splitlines()
    assert [line.rstrip() for line in printed.splitlines()[: len(example)]] == example
    assert len(file.read_text()) < 300_000
    assert pages_of(file) <= 15
    assert overflowing(file) == ""
