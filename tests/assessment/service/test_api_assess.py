"""POST /v1/assess: the rows of a direct call, bad rows beside them, and bodies that are no tables."""

import csv
import io
from typing import get_args

import numpy as np
import rocking_assessment
from rocking_assessment._objects.columns import OUTPUTS
from rocking_assessment.service.models import AssessedRow
from rocking_assessment.service.workbooks import MEDIA_TYPES

import rocking
from tests.api.conftest import CSV, assert_problem, post
from tests.sheets import xlsx_bytes

URL = "/v1/assess?pga=3&pgv=0.3&shapes=sine,ricker&sensitivity=false"
TABLE = (
    "name,width [cm],depth [cm],height [m],friction,colour\nbust,40,30,1.6,0.5,red\nbad,tall,30,1.6,,\nvase,16,,0.9,,\n"
)
ROWS = [
    {"name": "bust", "width": 0.4, "depth": 0.3, "height": 1.6, "friction": 0.5},
    {"name": "vase", "width": 0.16, "height": 0.9},
]


def test_rows_are_those_of_a_direct_call(client):
    site = rocking_assessment.Site(pga=3.0, pgv=0.3, shapes=["sine", "ricker"])
    for sensitivity, rows in (("false", ROWS), ("true", ROWS[1:])):
        answer = client.post(f"{URL.replace('false', sensitivity)}&standards=static,asce43", json=rows).json()
        objects = [rocking_assessment.Object(**row) for row in rows]
        expected = rocking_assessment.assess(
            objects, site, sensitivity=sensitivity == "true", standards=["static", "asce43"]
        )
        assert answer["rows"] == expected.rows
        assert answer["motions"] == ["sine", "ricker"]
        assert answer["bad_rows"] == []


def test_a_row_has_the_declared_columns():
    assert list(AssessedRow.model_fields) == [column.name for column in OUTPUTS]
    kinds = {"": str, "bool": bool}
    for column in OUTPUTS:
        annotation = AssessedRow.model_fields[column.name].annotation
        assert kinds.get(column.unit, float) in (annotation, *get_args(annotation)), column.name


def test_records_hazard_and_floor_are_those_of_a_direct_call(client):
    times = 0.05 * np.arange(60)
    x, y, z = np.sin(4 * times), np.cos(3 * times), 0.2 * np.sin(9 * times)
    layout = {"time_step": 0.05, "unit": "m/s2"}
    pair = {"acceleration": x.tolist(), "second": y.tolist(), "vertical": z.tolist(), "name": "A", **layout}
    curve = {"intensity": [0.5, 3.0, 9.0], "annual_rate": [1e-2, 1e-3, 1e-5]}
    body = {"objects": ROWS[1:], "records": [pair, {"acceleration": y.tolist(), **layout}], "hazard": curve}
    site = {"pga": "2 m/s2", "shapes": "sine", "floor_periods": "0.5,0.1", "floor_participation": "1.2,-0.2"}
    answer = client.post("/v1/assess", json=body | site | {"sensitivity": False, "samples": 8, "seed": 3})
    assert answer.status_code == 200, answer.text
    first = rocking.Record(x, 0.05, "m/s2", "A", vertical=z)
    second, other = (rocking.Record(y, 0.05, "m/s2", name) for name in ("A", "record 2"))
    site = rocking_assessment.Site(
        2.0,
        shapes=["sine"],
        records=[(first, second), other],
        hazard=(curve["intensity"], curve["annual_rate"]),
        floor_periods=[0.5, 0.1],
        floor_participation=[1.2, -0.2],
    )
    expected = rocking_assessment.assess(
        rocking_assessment.Object(**ROWS[1]), site, sensitivity=False, samples=8, seed=3
    )
    assert answer.json()["rows"] == expected.rows
    assert len(answer.json()["motions"]) == 13
    without = client.post("/v1/assess", json=body | {"hazard": None, "sensitivity": False})
    assert without.json()["rows"][0]["annual_rate"] is None


def test_a_layout_is_stated_in_the_query(client):
    table = "Objekt;Breite (cm);height [cm]\nVase;20,5;60\n"
    refused = assert_problem(post(client, URL, table, CSV), 422, "objects")
    assert "line 2: Vase;20,5;60" in refused["detail"]
    address = f"{URL}&decimal=,&columns=Breite (cm)=width [cm]&columns=Objekt=name"
    answer = post(client, address, table, CSV, format="json").json()
    assert answer["columns"] == {"Objekt": "name", "Breite (cm)": "width [cm]", "height [cm]": "height [cm]"}
    assert [row["object"] for row in answer["rows"]] == ["Vase"]
    assert_problem(post(client, f"{URL}&columns=width", table, CSV), 422, "columns")


def test_a_workbook_is_a_table(client):
    rows = [["name", "Breite", "height [cm]"], ["Vase", "20,5 cm", 60.5]]
    url = f"{URL}&decimal=,&columns=Breite=width"
    (media, *_) = MEDIA_TYPES
    answer = post(client, url, xlsx_bytes(rows), media).json()
    assert answer["details"]["height [cm]"] == ["60,5"]
    assert [row["object"] for row in answer["rows"]] == ["Vase"]
    assert "sheet" in assert_problem(post(client, f"{url}&sheet=Hall", xlsx_bytes(rows), media), 422)["detail"]
    assert_problem(post(client, url, b"no workbook", media), 422, "objects")


def test_a_tiny_object_is_a_question(client):
    rows = [{"name": "bust", "width": 0.004, "height": 0.1}]
    assert "allow_unusual" in assert_problem(client.post(URL, json=rows), 422, "objects")["detail"]
    assert client.post(f"{URL}&allow_unusual=true", json=rows).status_code == 200


def test_the_template_is_a_table(client):
    text = client.get("/v1/assess/template").text
    answer = post(client, URL, f"{text}vase,,,20,60,,,\n", CSV, format="json").json()
    assert [row["object"] for row in answer["rows"]] == ["vase"]


def test_bad_rows_of_a_table_are_named_and_the_others_assessed(client):
    answer = post(client, URL, TABLE, CSV, format="json").json()
    assert answer["rows"] == client.post(URL, json=ROWS).json()["rows"]
    (bad,) = answer["bad_rows"]
    assert (bad["row"], bad["columns"], bad["cells"]["colour"]) == (3, ["width"], "")
    assert "tall" in bad["reasons"][0]
    assert answer["warnings"] == ["rows that were not read: 1, see `bad_rows`"]
    assert answer["skipped"] == ["colour"]
    response = post(client, URL, TABLE, CSV)
    assert response.headers["content-type"].startswith("text/csv")
    rows = list(csv.DictReader(io.StringIO(response.text)))
    assert [row["verdict"] for row in rows] == [row["verdict"] for row in answer["rows"]] + ["not read"]
    assert float(rows[0]["factor"]) == answer["rows"][0]["factor"]
    assert rows[-1]["object"] == "row 3"
    inventory = list(csv.DictReader(io.StringIO(TABLE)))
    assert list(rows[0])[: len(inventory[0])] == list(inventory[0])  # as they stand, also those that are not read
    assert [{name: row.pop(name) for name in inventory[0]} for row in rows] == [
        inventory[2],
        inventory[0],
        inventory[0],
        inventory[1],
    ]
    assert answer["details"]["colour"] == ["", "red", "red"]
    accepted = client.post(f"{URL}&format=csv", json=ROWS)
    assert list(csv.DictReader(io.StringIO(accepted.text))) == rows[:-1]
    assert {"name", "width [cm]", "height [m]"} <= {*answer["columns"].values()}


def test_strengths_and_periods_take_units_and_records_keep_their_names(client):
    numbers = client.post("/v1/assess?pga=2.941995&pgv=0.3&shapes=sine&sensitivity=false", json=ROWS[:1]).json()
    texts = client.post("/v1/assess?pga=0.3g&pgv=30 cm/s&shapes=sine&sensitivity=false", json=ROWS[:1]).json()
    assert texts["rows"] == numbers["rows"]
    assert texts["query"]["pgv"] == 0.3
    assert assert_problem(client.post("/v1/assess?pga=3&pgv=0.3 m", json=ROWS[:1]), 422, "pgv")["value"] == "0.3 m"
    name = "South Napa 2014-08-24, station NHC, component 90, as processed"
    record = {"acceleration": [0.0, 2.0, -2.0, 0.0], "time_step": 0.1}
    body = {"objects": ROWS[:1], "records": [record | {"name": name}, record], "sensitivity": False}
    assert client.post("/v1/assess", json=body).json()["motions"] == [name, "record 2"]
