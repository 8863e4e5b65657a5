"""Tables as people keep them are read with the right values, or refused: none is misread."""

from pathlib import Path

import pytest

from rocking._assessment.objects import Object
from rocking._assessment.tables import objects_of_csv, objects_of_json, read_objects
from rocking._base.errors import InvalidArgumentError
from rocking._dimensional.table_reader import TooManyRowsError

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


def test_every_layout_has_its_expected_objects() -> None:
    assert EXPECTED.keys() == {path.name for path in TABLES.iterdir()}


@pytest.mark.parametrize("name", EXPECTED)
def test_layouts_are_read(name: str) -> None:
    found = read_objects(TABLES / name).objects
    assert [one.name for one in found] == [one.name for one in EXPECTED[name]]
    for one, expected in zip(found, EXPECTED[name], strict=True):
        for field, value in vars(expected).items():
            assert getattr(one, field) == (pytest.approx(value) if isinstance(value, float) else value), field


def test_bad_rows_are_named_with_row_column_and_reason() -> None:
    big, bare = read_objects(TABLES / "cells.csv").bad_rows
    assert (big.row, big.column, bare.row, bare.column) == (5, "width", 6, "width")
    assert "'big'" in str(big)
    assert "unit" in bare.reason
    (flat,) = read_objects(TABLES / "objects.json").bad_rows
    assert (flat.row, flat.column) == (2, "height")


@pytest.mark.parametrize(
    "text",
    [
        'name,width [mm],height [mm]\na,"1,234","2,345"\n',  # thousands or decimals
        "name;width [m];height [m]\na;1.234;2.345\n",
        'name,width [m],height [m]\na,0.5,"1,25"\n',  # both signs
        "name,width [m]\na,0.5\n",  # no height
        "name,width [stone],height [m]\na,0.5,1\n",
        "name,width [m],width [cm],height [m]\na,0.5,50,1\n",
        "",
    ],
)
def test_ambiguous_and_incomplete_tables_are_refused(text: str) -> None:
    with pytest.raises(InvalidArgumentError):
        objects_of_csv(text)


@pytest.mark.parametrize(
    "row",
    ["a,0,4,1,2", "a,0.4,1 2", "a,0.4,5'6", "a,0.4,1.2.3", "a,0.4,-1", "a,,1.2", "a,0.4 kg,1.2", "a,0.4,1.2 or 1.3"],
)
def test_rows_that_could_be_misread_are_reported(row: str) -> None:
    found = objects_of_csv(f"name,width [m],height [m]\ngood,0.5,1.5\n{row}\n")
    assert [one.name for one in found.objects] == ["good"]
    assert [one.row for one in found.bad_rows] == [3]


def test_rows_of_totals_are_those_whose_first_cell_says_so() -> None:
    names = ["Total Eclipse (bronze)", "bust", "Mean old man", "Somme, battlefield", "Sum-1"]
    totals = ["Total:", "SUM", " Mittelwert : "]
    rows = [f"{name};30;30;60\n" for name in [*names, *totals]]
    found = objects_of_csv(f"name;width [cm];depth [cm];height [cm]\n{''.join(rows)};Total;30;60\n")
    assert [one.name for one in found.objects] == names
    assert found.bad_rows == []


def test_too_many_rows_are_refused_before_an_object_is_made(monkeypatch: pytest.MonkeyPatch) -> None:
    rows = ["a,0.5,1", "b,bad,1", "c,0.5,1"]
    text = "name,width [m],height [m]\n\nTotal,1,1\n" + "\r".join(rows)
    assert len(objects_of_csv(text, 3).objects) == 2
    assert len(objects_of_json('[{"width": 1, "height": 2}, {}]', 2).bad_rows) == 1
    monkeypatch.setattr("rocking._assessment.tables.Object", None)
    for read in (lambda: objects_of_csv(text, 2), lambda: objects_of_json("[{}, {}, {}]", 2)):
        with pytest.raises(TooManyRowsError, match="at most 2"):
            read()


@pytest.mark.parametrize("text", ["{", '{"name": 1}', "[1]", r'[{"name": "\ud800", "width": 1, "height": 2}]'])
def test_json_that_is_no_list_of_objects_is_refused(text: str) -> None:
    with pytest.raises(InvalidArgumentError):
        objects_of_json(text)


def test_a_missing_file_is_refused() -> None:
    with pytest.raises(InvalidArgumentError, match="can be read"):
        read_objects(TABLES / "missing.csv")
