"""Tables of objects: what is stated is read right, everything else is refused with the words that state it."""

import csv
import io
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rocking_assessment._objects.assess import assess
from rocking_assessment._objects.site import Site
from rocking_assessment._objects.tables import (
    TEMPLATE,
    objects_of_csv,
    objects_of_json,
    read_objects,
    table_template,
    write_template,
)

from rocking._base.errors import InvalidArgumentError, TableFileError
from rocking._base.units import UNITS
from rocking._dimensional.table_reader import TableLayout, TooManyRowsError, csv_of_sheet
from tests.sheets import xlsx_bytes

FIELD = Path(__file__).parents[2] / "data" / "field"

MM = {"columns": {name: f"{name} [mm]" for name in ("width", "depth", "height")}}

STATED = [
    ("diameter_sign_header.csv", {"columns": {"Object": "name", "Ø base (cm)": "diameter [cm]"}},
     [("bust", 0.12, None, None, 0.6), ("vase", None, None, 0.14, 0.6)]),
    ("friction_percent_header.csv", {}, [("a", 0.6, None, None, 1.6)]),
    ("inventory_number.csv", {"columns": {"object": "name"}}, [("bust", 0.12, None, None, 0.6)]),
    ("length_dropped.csv", {"columns": {"L (mm)": "depth", "W (mm)": "width", "H (mm)": "height"}},
     [("row 2", 0.9, 0.3, None, 2.0)]),
    ("mass_in_pounds.csv", {"columns": {"weight (lb)": "mass"}}, [("jar", 0.12, 0.12, None, 0.35)]),
    ("mixed_decimal_signs.csv", {}, [("row 2", 0.179, None, None, 0.6)]),
    ("mixed_decimal_signs.csv", {"decimal": ","}, [("row 3", 0.605, None, None, 0.6)]),
    ("number_after_name.csv", {}, [("bust", 0.4, None, None, 1.6)]),
    ("thickness_dropped.csv", {"columns": {"thickness [cm]": "depth"}}, [("stele", 0.6, 0.12, None, 1.5)]),
    ("two_text_columns.csv", {}, [("urn", 0.3, None, None, 1.1), ("bust", 0.4, None, None, 1.6)]),
    ("unit_in_its_own_column.csv", MM, [("torso", 0.216, 0.381, None, 0.61)]),
    ("unit_column_each.csv", {"columns": {"Item": "name"}},
     [("1", 0.3, 0.45, None, 1.8), ("2", 0.9, 0.45, None, 1.95)]),
]  # fmt: skip
"""Tables that were once misread: what is stated, and name, width, depth, diameter, height [m] of each row."""

REFUSED = [
    ("diameter_sign_header.csv", {}, "Ø base"),
    ("length_dropped.csv", {}, "a column width"),
    ("thickness_dropped.csv", {}, "thickness"),
    ("footprint_wxd.csv", {}, "a column width"),
    ("thousands_point.csv", {}, "a column width"),
]


@pytest.mark.parametrize(("name", "options", "right"), STATED)
def test_a_table_whose_layout_is_stated_is_read(name, options, right):
    table = read_objects(FIELD / name, **options)
    rows = [(obj.name, obj.width, obj.depth, obj.diameter, obj.height) for obj in table.objects]
    assert [row[0] for row in rows] == [row[0] for row in right]
    for row, expected in zip(rows, right, strict=True):
        assert row[1:] == tuple(pytest.approx(size) for size in expected[1:])


@pytest.mark.parametrize(("name", "options", "words"), REFUSED)
def test_a_table_whose_layout_is_not_stated_is_refused_with_its_first_lines(name, options, words):
    with pytest.raises(TableFileError, match=words) as refusal:
        read_objects(FIELD / name, **options)
    assert f"line 1: {(FIELD / name).read_text().splitlines()[0]}" in str(refusal.value)


@pytest.mark.parametrize(
    ("name", "columns"),
    [("zero_for_absent.csv", {}), ("unit_in_its_own_column.csv", {}),
     ("thousands_point.csv", {"Breite [mm]": "width", "Tiefe [mm]": "depth", "Höhe [mm]": "height"})],
)  # fmt: skip
def test_rows_are_refused_one_by_one(name, columns):
    table = read_objects(FIELD / name, columns=columns)
    assert table.objects == []
    assert len(table.bad_rows) == len((FIELD / name).read_text().splitlines()) - 1


def test_a_thousands_point_is_a_question_that_names_unit_and_decimal_sign():
    columns = {"Breite [mm]": "width", "Tiefe [mm]": "depth", "Höhe [mm]": "height", "Objekt": "name"}
    cabinet, shelf = read_objects(FIELD / "thousands_point.csv", columns=columns).bad_rows
    assert (cabinet.columns, shelf.columns) == (["width", "height"], ["height"])
    assert "decimal sign" in str(shelf)
    assert "allow_unusual" in str(shelf)
    tiny = read_objects(FIELD / "thousands_point.csv", columns=columns, allow_unusual=True).objects
    assert [obj.height for obj in tiny] == pytest.approx([0.002, 0.0021])


def test_friction_mass_and_further_columns():
    assert read_objects(FIELD / "friction_percent_header.csv").objects[0].friction == 0.25
    (jar,) = read_objects(FIELD / "mass_in_pounds.csv", columns={"weight (lb)": "mass"}).objects
    assert jar.mass == pytest.approx(45.359237)
    (bust,) = read_objects(FIELD / "inventory_number.csv").objects
    assert bust.details == {"inventory number": "A1", "object": "bust"}
    rows = assess([bust], Site(pga=3.0, pgv=0.3, shapes=["sine"]), sensitivity=False)
    assert rows.to_csv().startswith("inventory number,object")


HEADER = "name;width [cm];height [cm]"

CELLS = [
    ("depth [cm]", "ca. 40", "one number"),
    ("depth [cm]", "40-45", "one number"),
    ("depth [cm]", "1 234", "one number"),
    ("depth [cm]", "40,5", "state `decimal`"),
    ("depth [cm]", "40 mm", "the unit of its header, cm"),
    ("depth [cm]", "0", "(0, inf)"),
    ("depth", "40", "[mm]"),
    ("depth", "40 stone", "a unit: m, cm"),
    ("depth [cm]", "9000", "0.01 to 50 m"),
    ("depth [cm]", "０４０", "one number"),
    ("diameter [cm]", "20", "none beside a diameter"),
    ("friction", "25", "(0, 10]"),
    ("mass", "3", "[kg]"),
    ("restitution", "0.5 1", "one number"),
]


@pytest.mark.parametrize(("header", "cell", "words"), CELLS)
def test_a_cell_that_is_not_read_refuses_its_row(header, cell, words):
    table = objects_of_csv(f"{HEADER};{header}\na;60;160;{cell}\nb;60;160;\n")
    assert [obj.name for obj in table.objects] == ["b"]
    assert words in str(table.bad_rows[0])


def test_a_row_is_refused_with_all_its_reasons():
    table = objects_of_csv(f"{HEADER};depth [cm];friction\n;6.0.0;x;0;2 m\n\n;;;;\nc;;;;;\nd;60;160;40;0.3;7\n")
    assert [(bad.row, bad.columns) for bad in table.bad_rows] == [
        (2, ["width", "height", "depth", "friction"]),
        (5, ["width", "height"]),
        (6, ["row"]),
    ]
    assert len(table.bad_rows[0].reasons) == 4


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "a column width"),
        ("name,width [m]\na,0.5\n", "a column height"),
        ("name,width [stone],height [m]\na,0.5,1\n", "one of \\[m\\]"),
        ("name,width [m],Width (cm),height [m]\na,0.5,50,1\n", "one column width"),
        ("name,width [m];height [m]\na,0.5;1\n", "`delimiter`"),
        ("Collection of 2024\nname,width [m],height [m]\na,0.5,1\n", "skip=1"),
        ("name,width [m],height [m],Seat (cm)\na,0.5,1,2\n", "Seat"),
        ("name,width [m],height [m]\na,0.5,1\nname,width [cm],height [cm]\nb,50,100\n", "one header"),
        ('name,width [m],height [m]\n"a,0.5,1\n"b,0.5,1\n', "in quotes"),
    ],
)
def test_a_table_that_does_not_state_its_layout_is_refused(text, words):
    with pytest.raises(TableFileError, match=words):
        objects_of_csv(text)


def test_what_is_stated_about_a_table_is_checked():
    text = f"{HEADER}\na;60;160\n"
    for layout, words in (
        ({"columns": {"Breite": "width"}}, "a header of the table"),
        ({"columns": {"name": "girth"}}, "with a unit in brackets; or unused"),
        ({"decimal": ";"}, "decimal"),
        ({"delimiter": "x"}, "delimiter"),
    ):
        with pytest.raises(InvalidArgumentError, match=words):
            objects_of_csv(text, layout=TableLayout(**layout))
    remarks = objects_of_csv(text, layout=TableLayout(columns={"width [cm]": "width [in]"})).remarks
    assert remarks == ["the header says width [cm]; width [in] is read, as `columns` says"]
    with pytest.raises(InvalidArgumentError, match="no such file"):
        read_objects("missing.csv")


def test_the_template_is_read_and_has_comments(tmp_path):
    assert table_template().startswith("# ")
    filled = table_template() + "vase,,,20,60,,,\nbox,40,30,,120,12,0.4,new\n"
    vase, box = objects_of_csv(filled).objects
    assert (vase.diameter, vase.height, box.depth, box.mass, box.friction) == (0.2, 0.6, 0.3, 12.0, 0.4)
    for ending in ("csv", "xlsx"):
        path = tmp_path / f"objects.{ending}"
        write_template(path)
        assert [*read_objects(path).columns] == [*TEMPLATE]


def test_cells_of_a_workbook(tmp_path):
    pytest.importorskip("python_calamine")
    path = tmp_path / "table.xlsx"
    path.write_bytes(xlsx_bytes([["name", "width [cm]", "height", "No"], ["vase", 20.5, "0,8 m", 17]]))
    (vase,) = read_objects(path, decimal=",").objects
    assert (vase.width, vase.height, vase.cells["No"]) == (pytest.approx(0.205), 0.8, 17)
    assert read_objects(path).bad_rows[0].columns == ["height"]
    assert csv_of_sheet(path.read_bytes(), "table").splitlines()[1] == 'vase,20.5,"0,8 m",17'
    with pytest.raises(InvalidArgumentError, match="sheet"):
        read_objects(path, sheet="another")


def test_too_many_rows_are_refused_before_an_object_is_made(monkeypatch):
    text = "name,width [m],height [m]\n\na,0.5,1\nb,bad,1\nc,0.5,1"
    assert len(objects_of_csv(text, 3).objects) == 2
    monkeypatch.setattr("rocking_assessment._objects.tables.Object", None)
    for read in (lambda: objects_of_csv(text, 2), lambda: objects_of_json("[{}, {}, {}]", 2)):
        with pytest.raises(TooManyRowsError, match="at most 2"):
            read()


@pytest.mark.parametrize("text", ["{", '{"name": 1}', "[1]", r'[{"name": "\ud800", "width": 1, "height": 2}]'])
def test_json_that_is_no_list_of_objects_is_refused(text):
    with pytest.raises(InvalidArgumentError):
        objects_of_json(text)


def test_rows_of_json_are_refused_one_by_one():
    table = objects_of_json('[{"width": 0.4, "height": "160 cm"}, {"w": 1, "h": 2}, {"width": 4e-4, "height": 1}]')
    assert [(obj.width, obj.height) for obj in table.objects] == [(0.4, 1.6)]
    assert [{*bad.columns} for bad in table.bad_rows] == [{"w", "h"}, {"width"}]


SIZES = {"width": (0.1, 2.0), "height": (0.3, 3.0), "depth": (0.1, 2.0)}
FOREIGN = {"width": "Breite", "height": "Höhe", "depth": "Tiefe"}


@st.composite
def layouts(draw):
    """A table of one object in a random layout: its text, what states it, and the sizes [m]."""
    columns, names, sizes = [], {}, {}
    decimal, delimiter = draw(st.sampled_from([(".", ","), (".", ";"), (",", ";"), (",", "\t"), (".", "\t")]))
    for name, (low, high) in SIZES.items():
        unit = draw(st.sampled_from(["m", "cm", "mm", "in", "ft"]))
        digits = draw(st.integers(0, 4))
        number = f"{draw(st.floats(low, high)) / UNITS['m'][unit]:.{digits}f}"
        sizes[name] = float(number) * UNITS["m"][unit]
        in_cell, is_foreign = draw(st.booleans()), draw(st.booleans())
        canonical = draw(st.sampled_from([name, name.upper(), f" {name}_", name.capitalize()]))
        brackets = draw(st.sampled_from(["[{}]", "({})"])).format(unit)
        header = (FOREIGN[name] if is_foreign else canonical) + ("" if in_cell else f" {brackets}")
        if is_foreign:
            names[header] = name
        columns.append((header, number.replace(".", decimal) + (f" {unit}" if in_cell else "")))
    extra = draw(st.lists(st.sampled_from(["12", "3,5", "a; b", 'say "no"', "", "40 cm"]), max_size=3))
    columns += [(f"extra {number}", cell) for number, cell in enumerate(extra)]
    columns = draw(st.permutations(columns))
    text = io.StringIO()
    quoting = draw(st.sampled_from([csv.QUOTE_MINIMAL, csv.QUOTE_ALL]))
    csv.writer(text, delimiter=delimiter, quoting=quoting).writerows(zip(*columns, strict=True))
    return text.getvalue(), TableLayout(columns=names, decimal=decimal, delimiter=delimiter), sizes


@settings(max_examples=150, deadline=None)
@given(layouts())
def test_a_random_layout_is_read_right_when_stated_and_never_read_differently_when_not(layout):
    text, full, sizes = layout
    for partial in (full, TableLayout(), TableLayout(columns=full.columns), TableLayout(decimal=full.decimal)):
        try:
            objects = objects_of_csv(text, layout=partial).objects
        except InvalidArgumentError:
            objects = []
        usual = all(0.01 <= size <= 50.0 for size in sizes.values())
        if partial is full and usual:
            assert len(objects) == 1, objects_of_csv(text, layout=partial).bad_rows
        for obj in objects:
            assert obj.width == pytest.approx(sizes["width"], rel=1e-12)
            assert obj.height == pytest.approx(sizes["height"], rel=1e-12)
            assert obj.depth in (None, pytest.approx(sizes["depth"], rel=1e-12))
