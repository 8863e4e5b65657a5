"""`rocking assess`: formats, files, bad rows, and a report that asks nobody for anything."""

import json
import re
from html.parser import HTMLParser

import numpy as np
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


def test_pairs_with_vertical_on_a_floor_with_a_hazard_curve(table, tmp_path):
    times = 0.05 * np.arange(60)
    parts = {"x": np.sin(4 * times), "y": np.cos(3 * times), "z": 0.2 * np.sin(9 * times)}
    for name, values in parts.items():
        (tmp_path / f"{name}.csv").write_text("".join(f"{t:.2f},{a:.6f}\n" for t, a in zip(times, values, strict=True)))
    files = {name: str(tmp_path / f"{name}.csv") for name in parts}
    curve = tmp_path / "PGA" / "curves.csv"
    curve.parent.mkdir()
    curve.write_text("lon,lat,0.05,0.2,1.0\n0,0,1e-2,1e-3,1e-5\n")
    options = ["--pair", f"{files['x']},{files['y']}", "--vertical", files["z"], "--unit", "m/s2", "--pga", "2 m/s2"]
    options += ["--hazard", str(curve), "--floor", "0.5s", "--floor-participation", "1.3"]
    found = json.loads(run("assess", str(table), *options, "--no-sensitivity", "--format=json"))
    x, y, z = (np.round(parts[name], 6) for name in "xyz")
    pair = rocking.Record(x, 0.05, "m/s2", vertical=z), rocking.Record(y, 0.05, "m/s2")
    site = rocking.Site(
        2.0,
        records=[pair],
        hazard=rocking.suites.read_hazard(curve),
        floor_periods=0.5,
        floor_participation=1.3,
    )
    expected = rocking.assess(rocking.read_objects(table).objects, site, sensitivity=False)
    for name in ("factor", "share", "annual_rate"):
        assert found[name] == [row[name] for row in expected.rows], name
    assert len(found["motions"]) == 12
    assert "--vertical" in refused("assess", str(table), *options, "--vertical", files["z"])
    assert "--pair" in refused("assess", str(table), "--pair", files["x"], "--unit", "m/s2")


def test_meshes_are_assessed_from_all_sides(tmp_path):
    trimesh = pytest.importorskip("trimesh")
    path = tmp_path / "plinth.stl"
    trimesh.creation.box((400, 300, 1600)).export(path)
    options = ["--mesh", str(path), "--mesh-unit", "mm", "--friction", "0.5", *SITE]
    found = json.loads(run("assess", *options, "--format=json"))
    assert sorted(found["direction"]) == sorted(f"{angle} deg" for angle in range(0, 180, 15))
    assert set(found["object"]) == {"plinth"}
    site = rocking.Site(pga="0.3 g", pgv="0.3 m/s", shapes=["sine", "ricker"])
    block = rocking.assess(rocking.Object("block", width=0.4, depth=0.3, height=1.6), site, sensitivity=False)
    factors = dict(zip(block.columns["direction"], block.columns["factor"], strict=True))
    by_angle = dict(zip(found["direction"], found["factor"], strict=True))
    assert by_angle["0 deg"] == pytest.approx(factors["width"], rel=1e-6)
    assert by_angle["90 deg"] == pytest.approx(factors["depth"], rel=1e-6)
    assert "OBJECTS" in refused("assess", *SITE)


@pytest.mark.parametrize(
    ("options", "text"),
    [
        (["--pga", "0.3g"], "--pgv"),
        (["--pga", "0.3", "--pgv", "0.3 m/s"], "missing unit"),
        (["--pga", "0.3g", "--period-min", "0.2s"], "--period-max"),
        (["--pga", "0.3g", "--pgv", "0.3 m/s", "--shapes", "square"], "--shapes"),
        ([*SITE, "--output", "/none/table.csv"], "No such file"),
        (["--record", "none.at2"], "none.at2"),
        ([*SITE, "--friction", "0.5"], "--friction"),
        ([*SITE, "--floor", "x"], "--floor-periods"),
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
    argv = [
        "assess",
        str(table),
        *SITE,
        "--report",
        str(file),
        "--title",
        "Room <7>",
        "--author",
        "A & B",
        "--site",
        "Athens & Rome",
    ]
    monkeypatch.setattr("sys.argv", ["rocking", *argv])
    table.write_text(TABLE + '"<img src=http://example.org/x>",x,1,1,\n')
    assert CliRunner().invoke(app, [*argv, "--date", "2026-11-24"]).exit_code == 2
    page = Page()
    page.feed(file.read_text())
    assert {"script", "img", "link", "iframe", "object"}.isdisjoint(page.tags)
    assert {"src", "href", "onload", "onclick"}.isdisjoint(name for name, _ in page.attributes)
    assert not re.search(r"https?://(?!example)|@import|url\(", file.read_text())
    for text in ("Room <7>", "Athens & Rome", "A & B", "2026-11-24", "<script>alert(1)</script>", "row 5", "--title"):
        assert text in page.text, text
    # three objects, two of them in two directions: drawing, thresholds, ground acceleration and rotation of each
    assert page.tags.count("svg") == 4 * 5
    assert page.tags.count("math") == 4
    assert page.text.index("Verdicts") < page.text.index("Objects")
    assert f"rocking {rocking.__version__}" in page.text
