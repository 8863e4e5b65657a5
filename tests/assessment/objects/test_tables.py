"""Tables as people keep them are read with the right values, or refused: none is misread."""

import csv
import io
import random
from pathlib import Path

import pytest
from rocking_assessment._objects.assess import assess
from rocking_assessment._objects.objects import Object
from rocking_assessment._objects.site import Site
from rocking_assessment._objects.tables import objects_of_csv, objects_of_json, objects_of_text, read_objects

from rocking._base.errors import InvalidArgumentError
from rocking._dimensional.table_reader import TooManyRowsError, csv_of_sheet
from tests.assessment.objects.dialects import Writer, errors_of
from tests.sampling import SEED, number
from tests.sheets import xlsx_bytes

TABLES = Path(__file__).parent / "tables"


def box(name: str, width: float, depth: float | None, height: float, **other: object) -> Object:
    return Object(name, width=width, depth=depth, height=height, **other)


EXPECTED = {
    "english.csv": [box("vase", 0.18, 0.18, 0.45), box("statue, marble", 0.5, 0.35, 1.8, notes="loan")],
    "german.csv": [
        box("Vase", 0.18, 0.18, 0.455, mass=2.1, friction=0.4),
        box("Statue", 0.5, 0.35, 1.8, mass=410.0, friction=0.5, notes="Sockel neu"),
    ],
    "italian.tsv": [box("Anfora", 0.32, 0.32, 0.9), box("Busto", 0.4, 0.3, 0.75)],
    "french.csv": [box("Coffre", 0.805, 0.6, 1.2)],
    "merged.csv": [box("chest", 0.8, 0.6, 1.2, mass=55.0), box("lamp", 0.2, 0.2, 1.4, mass=6.0)],
    "pipes.csv": [
        Object("amphora", diameter=0.32, height=0.9, notes="room 1"),
        Object("column", diameter=0.45, height=12.505, notes="room 2"),
    ],
    "cells.csv": [box("A-1", 0.4, 0.3, 1.2), box("A-2", 0.4064, 0.3048, 1.2192)],
    "objects.json": [Object("vase", diameter=0.18, height=0.45)],
    "spanish.csv": [box("Estatua", 0.5, None, 1.8005, friction=0.4)],
    "utf16.txt": [box("kouros", 0.45, None, 1.95)],
}


def csv_of(*rows: list[str]) -> str:
    text = io.StringIO()
    csv.writer(text, delimiter=";").writerows(rows)
    return text.getvalue()


FIELD = Path(__file__).parents[2] / "data" / "field"

MISREAD: dict[str, list[tuple[str, dict[str, object]]]] = {
    "thickness_dropped.csv": [("stele", {"width": 0.6, "depth": 0.12, "height": 1.5})],
    "length_dropped.csv": [("rack", {"width": 0.9, "depth": 0.3, "height": 2.0})],
    "mass_in_pounds.csv": [("jar", {"width": 0.12, "mass": 45.359237})],
    "zero_for_absent.csv": [
        ("box", {"width": 0.12, "depth": 0.09, "diameter": None, "height": 0.31}),
        ("vase", {"width": None, "depth": None, "diameter": 0.095, "height": 0.31}),
    ],
    "unit_in_its_own_column.csv": [("torso", {"width": 0.216, "depth": 0.381, "height": 0.61})],
    "diameter_sign_header.csv": [
        ("bust", {"width": 0.12, "diameter": None, "details": {"Inv. no.": "A1"}}),
        ("vase", {"width": None, "diameter": 0.14, "height": 0.6}),
    ],
    "mixed_decimal_signs.csv": [("a", {"width": 0.179}), ("b", {"width": 0.605})],
    "inventory_number.csv": [("bust", {"details": {"inventory number": "A1"}})],
    "friction_percent_header.csv": [("a", {"friction": 0.25})],
    "two_text_columns.csv": [
        ("urn", {"notes": "marble; hall", "details": {"material": "marble", "location": "hall"}}),
        ("bust", {"notes": "bronze; stair"}),
    ],
    "number_after_name.csv": [("bust", {"details": {"no": "17"}})],
}
"""Tables that were once misread or refused, with what is right."""


@pytest.mark.parametrize("name", MISREAD)
def test_tables_that_were_misread_are_read(name: str) -> None:
    table = read_objects(FIELD / name)
    assert table.bad_rows == []
    assert [one.name for one in table.objects] == [label for label, _ in MISREAD[name]]
    for one, (_, expected) in zip(table.objects, MISREAD[name], strict=True):
        for field, value in expected.items():
            assert getattr(one, field) == (pytest.approx(value, rel=1e-12) if isinstance(value, float) else value)


HEADER = "name;width [cm];height [cm]"


@pytest.mark.parametrize(
    ("header", "cell", "field", "value"),
    [
        ("friction (%)", "25", "friction", 0.25),
        ("Friction, %", "25", "friction", 0.25),
        ("friction (mu)", "0,25", "friction", 0.25),
        ("restitution [%]", "85", "restitution", 0.85),
        ("Gewicht (kN)", "9.80665", "mass", 1000.0),
        ("weight", "16 oz", "mass", 0.45359237),
        ("depth_mm", "90", "depth", 0.09),
        ("Tiefe / depth (mm)", "90", "depth", 0.09),
        ('Dicke (")', "10", "depth", 0.254),
        ("Dicke (Zoll)", "10", "depth", 0.254),
        ("depth (CM.)", "90 mm.", "depth", 0.09),
        ("mass", "0", "mass", None),
        ("COR", "0,85", "restitution", 0.85),
        ("mu_s [%]", "30", "friction", 0.3),
        ("coefficient of static friction", "0.3", "friction", 0.3),
        ("depth (cm)", "N/A", "depth", None),
    ],
)
def test_one_reading_of_units_holds_for_every_column(header: str, cell: str, field: str, value: float | None) -> None:
    text = csv_of([*HEADER.split(";"), header], ["a", "60", "160", cell])
    (one,) = objects_of_csv(text).objects
    assert getattr(one, field) == (None if value is None else pytest.approx(value, rel=1e-12))


CELLS = [
    ("girth (cm)", "88", "girth (cm)"),
    ("Seat height [mm]", "ca. 450", "Seat height"),
    ("side", "12", "side"),
    ("thick one", "12 cm", "thick one"),
    ("e2", "12", "e2"),
    ("friction", "25", "25 %"),
    ("friction [%]", "0,3", "percentage above 1"),
    ("weight", "12 stone", "kg, g, t, lb"),
    ("depth [cm]", "1,234", "decimal sign"),
    ("depth [cm]", "0", "depth"),
    ("diameter [cm]", "20", "none beside a diameter"),
    ("depth [cm]", "40-45", "of a range or an estimate"),
    ("depth [cm]", "ca. 40", "of a range or an estimate"),
    ("depth [cm]", "40 cm (est.)", "of a range or an estimate"),
    ("restitution", "85", "a percentage has its sign, 85 %"),
    ("pedestal (cm)", "90", "pedestal (cm)"),
    ("", "12", "#4"),
    ("kinetic friction", "0,3", "kinetic friction"),
    ("normal restitution", "0.8", "normal restitution"),
    ("centre of mass [%]", "45", "centre of mass [%]"),
    ("tilt [deg]", "2", "tilt [deg]"),
    ("h/b", "2,5", "h/b"),
    ("weight tons", "2", "weight tons"),
]
"""Columns beside width and height, a cell of them, and what the reason names."""


@pytest.mark.parametrize(
    ("header", "row", "said"),
    [
        *((f"{HEADER};{header}", f"a;60;160;{cell}", said) for header, cell, said in CELLS),
        ("name;W x D x H (cm)", "a;60 x 150", "60 x 150 (2 of 3 dimensions"),
        ("name;W x D x H (cm)", "a;60", "60 (1 of 3 dimensions"),
        ("name;w [cm];h [cm];Dimensions", "a;60;150;60 x 40 x 150 cm", "Dimensions"),
        ("name;w [cm];h [cm];Maße", "a;60;150;T 40", "Maße"),
        ("name;w [cm];h [cm]", "a;60;-", "a height"),
        ("name;w [in];h [in]", "a;30/40;60", "30/40"),
        ("name;w;h", "a;31 1/2;60 in", "with its unit, as 31 1/2 in"),
        ("name;w;h", "a;2' 7;60 in", "2' 7"),
        *(
            ("name,width [m],height [m]", f"a,{cells}", "")
            for cells in (
                "0,4,1,2",
                "0.4,1 2",
                "0.4,5'6",
                "0.4,1.2.3",
                "0.4,-1",
                ",1.2",
                "0.4 kg,1.2",
                "0.4,1.2 or 1.3",
            )
        ),
    ],
)
def test_what_is_not_certain_refuses_its_row_with_the_reason(header: str, row: str, said: str) -> None:
    other = "b,0.6,1.6" if "," in header else "b;60 cm;160 cm"
    found = objects_of_csv("\n".join([header, row, *([other] if " x " not in header else [])]))
    assert [one.name for one in found.objects] == (["b"] if " x " not in header else [])
    (bad,) = found.bad_rows
    assert said in str(bad)


def test_a_length_that_is_not_read_is_read_once_it_is_named(tmp_path: Path) -> None:
    path, text = tmp_path / "rack.csv", "name;width [cm];height [cm];Girth (mm)\na;60;160;120\n"
    path.write_text(text)
    assert read_objects(path).objects == []
    (one,) = read_objects(path, columns={"Girth (mm)": "depth"}).objects
    assert one.depth == pytest.approx(0.12)
    unused = read_objects(path, columns={"Girth (mm)": "unused"})
    assert (unused.objects[0].depth, unused.skipped) == (None, ["Girth (mm)"])
    assert unused.reading.endswith("; not read: Girth (mm)")
    assert unused.objects[0].details == {"Girth (mm)": "120"}
    assert unused.columns == {"name": "name", "width [cm]": "width", "height [cm]": "height"}
    assert "width [cm] as width" in repr(unused)
    with pytest.raises(InvalidArgumentError, match="columns"):
        read_objects(path, columns={"Girth": "depth"})
    path.write_text("name;w [cm];w [cm];h [cm];\na;60;40;160;7\n")
    (one,) = read_objects(path, columns={"w [cm]#3": "depth", "#5": "unused"}).objects
    assert (one.width, one.depth) == (0.6, 0.4)
    path.write_text(text.replace("Girth", "unused: Girth"))
    assert len(read_objects(path).objects) == 1
    with pytest.raises(InvalidArgumentError, match="no such file"):
        read_objects(tmp_path / "missing.csv")


def test_a_title_gives_no_units_and_totals_are_no_objects() -> None:
    text = "Objects (m);Hall 3 (ft);\nname;width;height\na;60 cm;160 cm\n"
    assert objects_of_csv(text).objects[0].width == pytest.approx(0.6)
    assert objects_of_csv(text.replace("60 cm;160 cm", "60;160")).objects == []
    text = f"All dimensions in mm;;\n{HEADER.replace(' [cm]', '')}\na;60;160\nb;70;100\n;130;260\nTotal (2);130;260\n"
    found = objects_of_csv(text)
    assert [one.width for one in found.objects] == pytest.approx([0.06, 0.07])
    assert [one.row for one in found.bad_rows] == [5]


@pytest.mark.parametrize(
    ("rows", "sizes"),
    [
        (["w;unit;h;unit;mass;unit", "40;cm;1,6;m;100;lb"], (0.4, None, 1.6)),
        (["w;h;unit;mass;mass unit", "400;1600;mm;100;pounds"], (0.4, None, 1.6)),
        (["w;h;mass;unit of measure", "40;160;100 lb;cm"], (0.4, None, 1.6)),
        (["w;h;mass;Ma\u00dfeinheit", "40;160;100 lb;cm"], (0.4, None, 1.6)),
        (["w;h;mass", "cm;m;lb", "40;1.6;100"], (0.4, None, 1.6)),
        (["Dimensions (cm);;mass", "w;h;lb", "40;160;100"], (0.4, None, 1.6)),
        (["w;h;d", """31 1/2 ";15¾ in;2' 7 1/2\""""], (0.8001, 0.8001, 0.40005)),
        (["w;h;d", "2 ft 7.5 in.;5′ 2½″;1’ 3”"], (0.8001, 0.381, 1.5875)),
        (["w (in);h (in);d (in)", "31-1/2;1/2;2' 6\""], (0.8001, 0.762, 0.0127)),
        (["L x W x H (in)", "23 5/8 x 15 3/4 x 59"], (0.40005, 0.600075, 1.4986)),
        (["name;W x D x H (cm)", "a;60 x 40 x 150"], (0.6, 0.4, 1.5)),
        (["name,WxDxH,mass", "a,60×40×150 cm,7"], (0.6, 0.4, 1.5)),
        (["Objekt;Maße (H × B × T) in cm", "a;150 x 60 x 40"], (0.6, 0.4, 1.5)),
        (["name;Breite x Höhe x Tiefe [mm]", "a;600 x 1500 by 400"], (0.6, 0.4, 1.5)),
        (["name;WxDxH;mass", ";cm;kg", "a;60 cm x 40 x 150;7"], (0.6, 0.4, 1.5)),
        (["Inv.-Nr.;Overall dimensions (WxDxH);unit", "a;60*40*150;cm"], (0.6, 0.4, 1.5)),
        (["idno;Dimensions height;Dimensions width;Dimensions depth", "7;150 cm;60 cm;40 cm"], (0.6, 0.4, 1.5)),
        (["名称;幅（cm）;奥行（cm）;高さ（cm）", "a;６０;４０．０;１５０"], (0.6, 0.4, 1.5)),
        (["name;w [m];d [m];h [m];p (1/s)", "a;0.6;0.4;1.5;2.9"], (0.6, 0.4, 1.5)),
        (["name;2b [m];2h [m]", "a;0.3;0.9"], (0.3, None, 0.9)),
        (["name;half width [m];half height [m]", "a;0.3;0.9"], (0.6, None, 1.8)),
        (["name;half width [m];height [m]", "a;0.3;0.9"], (0.6, None, 0.9)),
        (["name;b [m];height [m]", "a;0.3;0.9"], (0.3, None, 0.9)),
        (["name;width (b) [m];height (h) [m]", "a;0.3;0.9"], (0.3, None, 0.9)),
        (["name;\u5e45 [m];\u9ad8\u3055 [m]", "a;0.3;0.9"], (0.3, None, 0.9)),
    ],
)
def test_sizes_units_and_their_spellings(rows: list[str], sizes: tuple[float, float | None, float]) -> None:
    found = objects_of_csv("\n".join(rows))
    (one,) = found.objects
    assert (one.width, one.depth, one.height) == pytest.approx(sizes)
    assert one.mass == (pytest.approx(45.359237) if "100" in rows[-1] else 7.0 if "mass" in rows[0] else None)
    assert ("half_width" in found.reading) == ("half width" in rows[0])
    said = "not read: p (1/s) (frequency parameter, no depth)"
    assert found.reading.endswith(said) == ("p (1/s)" in rows[0])


@pytest.mark.parametrize(
    "row",
    ["a;394;120;419;;object: 394 x 120 x 419 mm", "a;311;;213;;support: 311 x 213 mm", 'a;;;318;152;12 1/2 x 6"'],
)
def test_sizes_that_the_other_columns_hold_as_well_refuse_no_row(row: str) -> None:
    found = objects_of_csv(f"name;width [mm];depth [mm];height [mm];diameter [mm];Dimensions\n{row}")
    assert len(found.objects) == 1
    assert "Dimensions" in found.skipped


@pytest.mark.parametrize("name", EXPECTED)
def test_layouts_are_read(name: str) -> None:
    found = read_objects(TABLES / name).objects
    assert [one.name for one in found] == [one.name for one in EXPECTED[name]]
    for one, expected in zip(found, EXPECTED[name], strict=True):
        for field, value in (vars(expected) | {"details": one.details}).items():
            assert getattr(one, field) == (pytest.approx(value) if isinstance(value, float) else value), field


def test_bad_rows_are_named_with_row_column_and_reason() -> None:
    big, bare = read_objects(TABLES / "cells.csv").bad_rows
    assert (big.row, big.column, bare.row, bare.column) == (5, "width", 6, "width")
    assert "'big'" in str(big)
    assert "unit" in bare.reason
    (flat,) = read_objects(TABLES / "objects.json").bad_rows
    assert (flat.row, flat.column) == (2, "height")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("name,width [m]\na,0.5\n", "missing: height"),
        ("name,width [stone],height [m]\na,0.5,1\n", "a unit"),
        ("name,width [m],width [cm],height [m]\na,0.5,50,1\n", "one column"),
        ("", "columns"),
        ("Height (in.),Height (cm),Width (cm)\n24.5,62.2,25.4\n", r"Height \(in\.\); Height \(cm\)"),
        *(
            (f"name;{header}\na;60 x 40 x 150\n", 'its header says the order: "W x D x H')
            for header in ("Dimensions", "Maße", "Misure (cm)", "Dimensiones")
        ),
        *(
            (f"name;{header}\na;0.3;0.9\n", "2b and 2h")
            for header in ("b [m];h [m]", "B_m;H (m)", "half width [m];h [m]", "b [m];half height [m]")
        ),
    ],
)
def test_ambiguous_and_incomplete_tables_are_refused(text: str, said: str) -> None:
    with pytest.raises(InvalidArgumentError, match=said):
        objects_of_csv(text)


def test_a_header_that_lacks_a_column_names_it_and_the_one_that_may_be_it() -> None:
    header = "Name;material;location;room;remarks;Width [cm];Height overall max [cm]"
    with pytest.raises(
        InvalidArgumentError, match=r"missing: height or mass_height; if that is 'Height overall max \[cm\]'"
    ) as refused:
        objects_of_csv(f"Inventory of 2024\n{header}\na;b;c;d;e;30;60\n")
    assert "width" not in refused.value.allowed.partition("missing:")[2]
    assert len(objects_of_csv(header.replace("overall max ", "") + "\na;b;c;d;e;30;60\n").objects) == 1


def test_a_row_of_totals_says_nothing_of_the_decimal_sign_of_a_workbook(tmp_path: Path) -> None:
    rows = [["object", "width [cm]", "height [cm]"], ["vase", "1.234", 40.0], ["jug", "40,0", 41.5]]
    path = tmp_path / "table.xlsx"
    path.write_bytes(xlsx_bytes([*rows, ["Total", "5.5", 81.5]]))
    for table in (read_objects(path), objects_of_csv(csv_of_sheet(path.read_bytes(), "table"))):
        assert [one.width for one in table.objects] == pytest.approx([12.34, 0.4])


def test_rows_of_totals_are_those_whose_first_cell_says_so() -> None:
    names = ["Total Eclipse (bronze)", "bust", "Mean old man", "Somme, battlefield", "Sum-1"]
    totals = ["Total:", "SUM", " Mittelwert : ", "\u5408\u8a08", "Avg.", "Std dev", "Grand total", "Zwischensumme"]
    totals += ["Total g\u00e9n\u00e9ral", "Subtotal hall 1", "Promedio", "mean \u00b1 sd", "\u03a3"]
    rows = "".join(f"{name};30;30;60\n" for name in [*names, *totals])
    found = objects_of_csv(f"name;width [cm];depth [cm];height [cm]\n{rows};Total;30;60\n")
    assert found.totals == [f"row {k}: {one.strip()}" for k, one in enumerate([*totals, "Total"], 7)]
    assert "row 8: SUM (no object)" in found.reading
    assert [one.name for one in found.objects] == names
    assert found.bad_rows == []


@pytest.mark.parametrize(
    "second", ["name;width [cm];height [cm]", "name;height;width", "Objekt;Breite (mm);H\u00f6he (m)"]
)
def test_a_second_header_of_other_columns_or_units_refuses_the_table(second: str) -> None:
    text = "name;width [in];height [in]\na;24;60\n{}\nb;24;60\n"
    with pytest.raises(InvalidArgumentError, match=r"row 3.*one header"):
        objects_of_csv(text.format(second))
    repeated = objects_of_csv(text.format("Name;Width [in];Height"))
    assert [one.name for one in repeated.objects] == ["a", "b"]
    assert len(repeated.bad_rows) == 1


def test_a_missing_depth_is_a_warning() -> None:
    found = objects_of_csv("name;w [cm];d [cm];h [cm];diameter [cm]\na;60;?;160;\nb;60;40;160;\nc;;;160;60\n").objects
    rows = assess(found, Site(pga=3.0, pgv=0.3, shapes=["sine"]), sensitivity=False).rows
    assert [row["object"] for row in rows if "no depth is given" in row["warnings"]] == ["a"]


def test_too_many_rows_are_refused_before_an_object_is_made(monkeypatch: pytest.MonkeyPatch) -> None:
    rows = ["a,0.5,1", "b,bad,1", "c,0.5,1"]
    text = "name,width [m],height [m]\n\nTotal,1,1\n" + "\r".join(rows)
    assert len(objects_of_csv(text, 3).objects) == 2
    assert len(objects_of_json('[{"width": 1, "height": 2}, {}]', 2).bad_rows) == 1
    monkeypatch.setattr("rocking_assessment._objects.tables.Object", None)
    for read in (lambda: objects_of_csv(text, 2), lambda: objects_of_json("[{}, {}, {}]", 2)):
        with pytest.raises(TooManyRowsError, match="at most 2"):
            read()


@pytest.mark.parametrize("text", ["{", '{"name": 1}', "[1]", r'[{"name": "\ud800", "width": 1, "height": 2}]'])
def test_json_that_is_no_list_of_objects_is_refused(text: str) -> None:
    with pytest.raises(InvalidArgumentError):
        objects_of_json(text)


def test_columns_with_names_like_those_that_are_read_are_others() -> None:
    header = ["Room Name", "base price", "artistId", "Floor area (sq ft)", "width_cm", "HEIGHT (CM)", "Weight_grams"]
    (one,) = objects_of_csv(csv_of(header, ["hall", "12.5", "38", "120", "60", "160", "250"])).objects
    assert (one.width, one.height, one.mass, one.notes) == (pytest.approx(0.6), pytest.approx(1.6), 0.25, "")
    assert one.details == dict(zip(header, ["hall", "12.5", "38", "120"], strict=False))


CASES = number(60, 11_000)


def test_what_is_read_is_true_or_refused() -> None:
    read, wrong, refused = 0, [], 0
    for seed in random.Random(SEED).sample(range(10**9), CASES):
        dialect = Writer(seed).table()
        try:
            table = objects_of_text(dialect.raw, json=False)
        except InvalidArgumentError:
            refused += 1
            continue
        wrong += [f"seed {seed}: {error}" for error in errors_of(table, dialect)]
        read += len(table.objects) == len(dialect.objects)
    assert wrong == []
    assert read > 0.5 * CASES
    assert refused < 0.15 * CASES


def test_a_workbook_is_read_alike_by_command_and_by_page(tmp_path: Path) -> None:
    pytest.importorskip("python_calamine")
    path = tmp_path / "table.xlsx"
    for seed in random.Random(SEED).sample(range(10**9), max(10, CASES // 10)):
        dialect = Writer(seed, typed=True).table()
        raw = xlsx_bytes(dialect.rows)
        path.write_bytes(raw)
        answers = []
        for page in (False, True):
            try:
                table = objects_of_csv(csv_of_sheet(raw, "table")) if page else read_objects(path)
            except InvalidArgumentError as error:
                answers.append(str(error))
                continue
            assert errors_of(table, dialect) == [], seed
            rows = [vars(one) | {"cells": one.cells} for one in table.objects]
            answers.append((rows, [vars(one) for one in table.bad_rows]))
        assert answers[0] == answers[1], seed
