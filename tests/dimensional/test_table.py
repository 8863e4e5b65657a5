"""Tables of blocks as people keep them: the same values, names as written, each row that is not read named."""

import csv
import io

import pytest

import rocking
from rocking._base.errors import InvalidArgumentError, TableFileError, finite
from rocking._datasets.csv_text import csv_text
from rocking._dimensional.table import BlockTable, read_blocks, read_table, respond_table
from rocking._dimensional.table_reader import TableLayout
from tests.sheets import xlsx_bytes

HEADER = "name,width [m],height [m],peak_acceleration [g],period [s]\n"
NAMES = ["vase, blue", 'say "no"', "two\nlines", "a\rb", "a\r\nb", " vase ", "", "vase; red", "6'", "=1+1", "'-1"]


@pytest.mark.parametrize("delimiter", [",", ";"])
@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_names_are_kept(delimiter, end):
    text = io.StringIO(newline="")
    text.write(HEADER.strip().replace(",", delimiter) + end)
    writer = csv.writer(text, delimiter=delimiter, quoting=csv.QUOTE_ALL, lineterminator=end)
    writer.writerows([name, 0.2, 0.8, 0.4, 0.5] for name in NAMES)
    table = read_table(text.getvalue(), "sine")
    assert table.names == NAMES
    assert {problem.block.half_width for problem in table.problems} == {0.1}


def test_names_that_were_written_are_read_back():
    columns = [NAMES, *([value] * len(NAMES) for value in (0.2, 0.8, 0.4, 0.5))]
    text = csv_text(dict(zip(HEADER.strip().split(","), columns, strict=True)))
    assert [name.removeprefix("'") for name in read_table(text, "sine").names] == [
        name.removeprefix("'") for name in NAMES
    ]


@pytest.mark.parametrize(
    "text",
    [
        '"vase,0.2,0.8,0.4,0.5\nvase,0.2,0.8,0.4,0.5\n',
        'vase,0.2,0.8,0.4,0.5\n"va"se,0.2,0.8,0.4,0.5\n',
        f"{'v' * 131_073},0.2,0.8,0.4,0.5\n",
    ],
)
def test_what_is_not_csv_is_refused(text):
    with pytest.raises(TableFileError, match="in quotes"):
        read_table(HEADER + text, "sine")


@pytest.mark.parametrize(
    ("text", "layout"),
    [
        ("NAME,Width [cm],HEIGHT (m),Peak Acceleration [g],period\nvase,20,0.8,0.4,500 ms\n", {}),
        (
            """# a comment; with signs

Name;Breite;Höhe;peak_acceleration;Period;Material
vase;20 cm;0,8 m;0,4 g;500 ms;clay
""",
            {"columns": {"Breite": "width", "Höhe": "height"}, "decimal": ","},
        ),
        (
            """My table, with commas
name|width [m]|height [m]|peak_acceleration [g]|period [ms]
vase|2e-1|0.8|0.4|5e2
""",
            {"skip": 1},
        ),
    ],
)
def test_layouts_have_the_same_block(text, layout):
    table = read_table(text.replace("|", "\t"), "sine", layout=TableLayout(**layout))
    (problem,) = table.problems
    assert (problem.block.width, problem.block.height) == pytest.approx((0.2, 0.8), rel=1e-15)
    assert (problem.peak_acceleration, problem.period) == pytest.approx((0.4 * 9.80665, 0.5), rel=1e-15)
    assert table.names == ["vase"]
    if "Material" in text:  # columns that are not read, and units, are kept
        assert table.read.cells["Material"] == ["clay"]
        assert table.read.skipped == ["Material"]


def test_each_row_that_is_not_read_is_named_and_the_others_are_kept():
    rows = ["a,0.2,0.8,0.4,0.5", "b,big,0.8,0.4,0.5", "c,-0.2,0.8,0.4,0.5", "d,0.2,0.8,,x", "e,0.2,0.8,0.4,0.5,9",
            "f,,,0.4,0.5", "花瓶,0.2,0.8,0.4,0.5", "@SUM(A1),0.2,0.8,0.4,0.5"]  # fmt: skip
    table = read_table(HEADER + "\n".join(rows), "sine")
    assert table.names == ["a", "花瓶", "@SUM(A1)"]
    assert [(bad.row, bad.columns) for bad in table.read.bad_rows] == [
        (3, ["width"]),
        (4, ["width"]),
        (5, ["period", "peak_acceleration"]),
        (6, ["row"]),
        (7, ["width", "height"]),
    ]
    assert "'-0.2'; allowed: (0, inf) [m]" in str(table.read.bad_rows[1])
    with pytest.raises(InvalidArgumentError, match="blocks, row 3, width"):
        table.check()


def test_values_for_all_rows_stand_for_columns_that_the_table_lacks(tmp_path):
    path = tmp_path / "sizes.csv"
    path.write_text("width [m],height [m],restitution\n0.2,0.8,90 %\n0.2,0.8,momentum\n")
    with pytest.raises(TableFileError, match="a column peak_acceleration and a column period"):
        read_blocks(path, "sine")
    table = read_blocks(path, "sine", peak_acceleration=4.0, period=0.5)
    momentum = rocking.Block(0.2, 0.8).momentum_restitution
    assert [problem.groups["restitution"] for problem in table.problems] == [0.9, momentum]
    assert {(float(problem.peak_acceleration), float(problem.period)) for problem in table.problems} == {(4.0, 0.5)}


def test_a_sheet_is_read_as_its_text_is(tmp_path):
    path = tmp_path / "blocks.xlsx"
    header = ["Name", "width [cm]", "height", "peak_acceleration [g]", "period [s]"]
    path.write_bytes(xlsx_bytes([header, ["vase", 20, "0,8 m", 0.4, 0.5]]))
    table = read_blocks(path, "sine", layout=TableLayout(decimal=","))
    assert table.names == ["vase"]
    assert (table.problems[0].block.width, table.problems[0].block.height) == (0.2, 0.8)
    path.write_text("no sheet")
    with pytest.raises(InvalidArgumentError, match="a sheet of a spreadsheet"):
        read_blocks(path, "sine")


BODIES = """name;width [cm];height [m];wall [cm];diameter [cm];offset [cm];depth [cm];body;Peak Acceleration;period [s]
box;40;1.6;2;;;;;0.4 g;0.5
drum;;1.2;;30;;;;0.4 g;0.5
statue;40;1.6;;;5;30;;0.4 g;0.5
block;40;1.6;;;;30;;0.4 g;0.5
text;;;;;;;two_edges(left=12cm, right=18cm, mass_height=40cm);0.4 g;0.5
none;40;1.6;;;;;mesh(path=a.stl);0.4 g;0.5
"""


def test_a_table_has_the_bodies_of_its_columns():
    table = read_table(BODIES, "sine")
    assert [(bad.row, bad.columns) for bad in table.read.bad_rows] == [(7, ["body"])]
    made = [
        rocking.body("hollow", width=0.4, height=1.6, wall=0.02),
        rocking.body("cylinder", diameter=0.3, height=1.2),
        rocking.RigidBody.from_size(0.4, 1.6, offset=0.05),
        rocking.Block(0.4, 1.6),
        rocking.RigidBody(0.12, 0.18, 0.4),
    ]
    assert [problem.body for problem in table.problems] == made
    found = respond_table(table)
    for k, body in enumerate(made):
        one = body.response("sine", peak_acceleration="0.4 g", period=0.5)
        assert found["body"][k] == body.description
        assert found["peak_rotation"][k] == finite(one.peak_rotation)
        assert found["width"][k] == pytest.approx(body.width)
        assert (found["alpha_deg"][k] is None) is (k != 3)
    assert respond_table(BlockTable(table.problems[3:4], []))["peak_rotation"] == found["peak_rotation"][3:4]
