"""POST /v1/assess: the rows of a direct call, bad rows beside them, and bodies that are no tables."""

import csv
import io

import pytest
from rocking_api.models.assess import AssessedRow
from rocking_api.routers import assess as router

import rocking
from rocking._assessment.columns import OUTPUTS
from tests.api.conftest import assert_problem, client_of

URL = "/v1/assess?pga=3&pgv=0.3&shapes=sine,ricker&sensitivity=false"
CSV = {"content-type": "text/csv"}
TABLE = (
    "name,width [cm],depth [cm],height [m],friction,colour\nbust,40,30,1.6,0.5,red\nbad,tall,30,1.6,,\nvase,16,,0.9,,\n"
)
ROWS = [
    {"name": "bust", "width": 0.4, "depth": 0.3, "height": 1.6, "friction": 0.5},
    {"name": "vase", "width": 0.16, "height": 0.9},
]


def test_rows_are_those_of_a_direct_call(client):
    objects = [rocking.Object(**row) for row in ROWS]
    site = rocking.Site(pga=3.0, pgv=0.3, shapes=["sine", "ricker"])
    for sensitivity in ("false", "true"):
        answer = client.post(URL.replace("false", sensitivity), json=ROWS).json()
        expected = rocking.assess(objects, site, sensitivity=sensitivity == "true")
        assert answer["rows"] == expected.rows
        assert answer["motions"] == ["sine", "ricker"]
        assert answer["bad_rows"] == []
    assert list(AssessedRow.model_fields) == [one.name for one in OUTPUTS]


def test_bad_rows_of_a_table_are_named_and_the_others_assessed(client):
    answer = client.post(URL + "&format=json", content=TABLE, headers=CSV).json()
    assert answer["rows"] == client.post(URL, json=ROWS).json()["rows"]
    (bad,) = answer["bad_rows"]
    assert (bad["row"], bad["column"]) == (3, "width")
    assert "tall" in bad["reason"]
    assert answer["skipped"] == ["colour"]
    response = client.post(URL, content=TABLE, headers=CSV)
    assert response.headers["content-type"].startswith("text/csv")
    rows = list(csv.DictReader(io.StringIO(response.text)))
    assert [row["verdict"] for row in rows] == [row["verdict"] for row in answer["rows"]] + ["not read"]
    assert float(rows[0]["factor"]) == answer["rows"][0]["factor"]
    assert rows[-1]["object"] == "row 3"
    accepted = client.post(URL, json=ROWS, headers={"accept": "text/csv"})
    assert accepted.text.splitlines() == response.text.splitlines()[:-1]


def test_names_that_a_spreadsheet_would_evaluate_are_text(client):
    names = ["=1+1", "+1", "@SUM(A1)", "-2+3", 'say "no"', "two\nlines", "<script>"]
    rows = [{"name": name, "width": 0.4, "height": 1.6} for name in names]
    text = client.post(URL + "&format=csv", json=rows).text
    found = [row["object"] for row in csv.DictReader(io.StringIO(text, newline=""))]
    assert found == [*(f"'{name}" for name in names[:4]), *names[4:]]
    assert [row["object"] for row in client.post(URL, json=rows).json()["rows"]] == names


@pytest.mark.parametrize(
    ("query", "parameter"),
    [
        ("pgv=0.3", "pga"),
        ("pga=3", "site"),
        ("pga=3&pgv=0.3&period_min=0.2&period_max=1", "site"),
        ("pga=3&period_min=0.2", "periods"),
        ("pga=3&period_min=1&period_max=0.2", "periods"),
        ("pga=-3&pgv=0.3", "pga"),
        ("pga=3&pgv=nan", "pgv"),
        ("pga=3&pgv=1000", "pgv"),
        ("pga=3&period_min=1e-9&period_max=1", "period_min"),
        ("pga=3&pgv=0.3&shapes=", "pulse"),
        ("pga=3&pgv=0.3&shapes=sine,square", "pulse"),
        ("pga=3&pgv=0.3&hazard=1", "hazard"),
    ],
)
def test_a_wrong_site_is_refused_by_name(client, query, parameter):
    assert_problem(client.post(f"/v1/assess?{query}", json=ROWS), 422, parameter)


@pytest.mark.parametrize(
    "body",
    [
        *(b"", b"{}", b"[1]", b"[]", b"[{}]", b"[" * 100_000, b"[" + b"9" * 5000),
        b'[{"name": [1], "width": 1, "height": 1}]',
    ],
    ids=range(8),
)
def test_json_that_is_no_table_is_refused(client, body):
    assert_problem(client.post(URL, content=body, headers={"content-type": "application/json"}), 422, "objects")


@pytest.mark.parametrize(
    "body",
    [
        *("", "a,b\n1,2\n", "name,width,height\nbust,1,2\n", "name,width [m],height [m]\n"),
        *("v" * 140_000, '"' * 999, "\0,\0\n"),
    ],
    ids=range(7),
)
def test_csv_that_is_no_table_is_refused(client, body):
    problem = assert_problem(client.post(URL, content=body, headers=CSV), 422)
    assert problem["parameter"].startswith("objects")


def test_size_type_and_time_are_limited(client, results, monkeypatch):
    monkeypatch.setattr(router, "MAX_OBJECTS", 2)
    problem = assert_problem(client.post(URL, json=[*ROWS, {}]), 413, "objects")
    assert (problem["value"], problem["allowed"]) == (3, "at most 2")
    assert_problem(client.post(URL, content=b" " * (router.MAX_BODY + 1), headers=CSV), 413, "body")
    assert_problem(client.post(URL, content="<x/>", headers={"content-type": "application/xml"}), 415)
    with client_of(results, max_seconds=0.001) as hurried:
        assert hurried.post("/v1/assess?pga=3&period_min=0.1&period_max=2", json=ROWS).status_code in (503, 504)
