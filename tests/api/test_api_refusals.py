"""What is wrong is refused by name, with its value and what is allowed; afterwards the service answers.

Each kind of fault once for each route that meets it: bodies, sizes, types, and values that depend on others. Random
parameters of all routes are in `test_api_fuzz.py`.
"""

import gzip
import json
import time

import numpy as np
import pytest
import xarray as xr
from rocking_api.app import MAX_JSON
from rocking_api.models import blocks as block_models
from rocking_api.models.pulses import MAX_BODY, MAX_SAMPLES
from rocking_assessment.service import assess, identify

from tests.api.conftest import CSV, JSON, NAPA, NC, POINT, QUERIES, assert_problem, client_of, post
from tests.excitation.record_files import at2
from tests.sampling import number

SIZE = {"width": "0.4", "height": "1.6"}
SUBSET = "/v1/datasets/spectra/sine/eta-0.85/subset"


@pytest.fixture(autouse=True)
def _soon(client):
    began = time.monotonic()
    yield
    assert client.get("/health").status_code == 200
    assert time.monotonic() - began < 30


WITHOUT_CUBE = [
    *({"frequency_ratio": 40}, {"slenderness": 0.01}, {"restitution": 0.7}, {"pulse": "-ricker"}),
    *({"alpha_deg": 80}, {"absolute_tolerance": 1e-13}),
]
PARTS = [{"slenderness_max": 0.5, "slenderness_min": 0.6}, {"variables": "height"}]


def test_a_wrong_value_is_named_with_what_is_allowed(client):
    for route, ordinary, changes in (
        *(("/v1/response", POINT | {"method": "cube"}, wrong) for wrong in WITHOUT_CUBE),
        *((SUBSET, {}, wrong) for wrong in PARTS),
        ("/v1/response", POINT, {"tolerence": 1e-6}),
        ("/v1/suites/demonstration", {}, {"format": "pdf"}),
    ):
        name, value = next(iter(changes.items()))
        problem = assert_problem(client.get(route, params=ordinary | changes), 422, name)
        assert str(problem["value"]).startswith(str(value)) or float(problem["value"]) == value


def test_all_that_is_missing_or_wrong_is_named_up_to_a_number(client):
    problem = assert_problem(client.get("/v1/response?pulse=saw&slenderness=x&restitution=3&colour=1"), 422)
    assert [one["name"] for one in problem["errors"]] == [
        "pulse", "slenderness", "frequency_ratio", "restitution", "colour",
    ]  # fmt: skip
    _, first, missing, above, unknown = problem["errors"]
    assert first["value"] == "x"
    assert missing == {"name": "frequency_ratio", "allowed": "required in the query"}
    assert unknown["allowed"] == "see /docs"
    assert above == {"name": "restitution", "value": 3.0, "allowed": "[0, 1] [-]"}
    assert problem["detail"].startswith("5 parameters are missing or wrong: `pulse` = 'saw' is not allowed")
    unknown = {f"unknown_{k}": 1 for k in range(50)}
    problem = assert_problem(client.get("/v1/response", params=POINT | unknown), 422, "unknown_0")
    assert len(problem["errors"]) == 20
    assert problem["detail"].startswith("50 parameters")


def test_it_is_said_whether_a_value_is_expected_in_the_query_or_in_the_body(client):
    url, columns = "/v1/response", "slenderness\n0.4\n"
    body = {"pulse": "sine", "frequency_ratio": 5, "restitution": 0.85}
    assert assert_problem(client.post(url, json=body), 422, "slenderness")["allowed"] == "required in the body"
    unknown = assert_problem(client.post(url, json=body | {"slenderness": 1, "colour": 1}), 422, "colour")
    assert unknown["detail"].startswith("there is no parameter `colour` in the body")
    for missing, allowed in (
        ("pulse", "required in the query"),
        ("frequency_ratio", "required: a column of the body or a parameter in the URL"),
    ):
        query = {name: value for name, value in body.items() if name != missing}
        assert assert_problem(post(client, url, columns, CSV, **query), 422, missing)["allowed"] == allowed
    both = client.post(f"{url}?method=solver", json=body | {"slenderness": 1})
    assert "JSON body" in assert_problem(both, 422, "method")["allowed"]


def test_long_lists_of_what_is_allowed_do_not_break_off(client):
    allowed = assert_problem(
        client.get("/v1/blocks/response", params=QUERIES["/v1/blocks/response"] | {"inertia": 3}), 422
    )
    assert len(allowed["allowed"]) > 400
    assert allowed["allowed"].endswith(")")
    assert allowed["detail"].endswith(allowed["allowed"])
    long = assert_problem(client.get("/v1/response", params=POINT | {"pulse": "x" * 5000}), 422, "pulse")
    assert len(long["value"]) < 500


LENGTH, TIME = "a number with its unit, such as 0.3 m, 30 cm", "a number with its unit, such as 0.5 s, 500 ms"


def test_wrong_numbers_are_named_with_units_in_json_in_tables_and_of_records(client):
    row = {"width": 0.4, "height": "tall", "peak_acceleration": 4.0, "period": "short"}
    response = client.post("/v1/blocks/response", json={"pulse": "sine", "blocks": [row, row | {"height": 1.6}]})
    assert assert_problem(response, 422, "blocks[0].height")["errors"] == [
        {"name": "blocks[0].height", "value": "tall", "allowed": LENGTH},
        {"name": "blocks[0].period", "value": "short", "allowed": TIME},
        {"name": "blocks[1].period", "value": "short", "allowed": TIME},
    ]
    header, first = TABLE.splitlines()[:2]
    body = "\n".join([header, first, first.replace("80", "tall"), first.replace("0.2,", "-20,")])
    problem = assert_problem(post(client, "/v1/blocks/response", body, CSV, pulse="sine"), 422)
    assert [(error["name"], error["value"]) for error in problem["errors"]] == [
        ("blocks, row 3, height", "tall"),
        ("blocks, row 4, width", "-20"),
    ]
    wrong = SIZE | {"height": "x", "scale": 0.0, "unit": "feet", "baseline_order": "y"}
    problem = assert_problem(client.post("/v1/records/response", params=wrong, content=NAPA.read_bytes()), 422)
    allowed = {one["name"]: one["allowed"] for one in problem["errors"]}
    assert allowed.keys() == {"height", "scale", "unit", "baseline_order"}
    assert (allowed["height"], allowed["baseline_order"]) == (LENGTH, "an integer")


RECORD = "time [s],acceleration [g]\n" + "".join(f"{0.05 * k:.2f},{0.3 * ((-1) ** (k // 5)):.1f}\n" for k in range(21))
TABLE = "name,width [m],height [cm],peak_acceleration [m/s2],period [ms],restitution\nvase,0.2,80,4,500,\n"
NESTED = "[" * 100_000 + "]" * 100_000
GROUPS = '{"pulse":"sine","restitution":0.9,"frequency_ratio":5,"slenderness":%s}'
NO_JSON = [
    *("{", "\x00", "{" * 100_000, '{"pulse":' * 50_000, NESTED, GROUPS % NESTED, '{"pulse": ["\\x"]}'),
    *(GROUPS % f"[{entries}]" for entries in ("1,", ",1", "1,,2", "1 2", "1,true,[", "1,}", "nope")),
]
NO_GROUPS = [
    *("null", "[]", "[1, 2]", '"text"', GROUPS.replace("0.9", '0.9,"x":1') % 1),
    *(GROUPS % one for one in ('{"0":1}', '"0.5x"', "[null]", "[[1]]", "[NaN]", "1e999", "-1")),
    *(GROUPS % one for one in ("[1,null]", '[1,"2x"]', '[1,2],"restitution":[1,2,3]')),
    '{"pulse":["sine"]' + GROUPS[15:] % 1,
    GROUPS.replace("0.9", '0.9,"' + "x" * 100_000 + '":1') % 1,
]


def test_bodies_that_are_no_json_or_no_groups_are_refused_in_few_words(client):
    for status, bodies in ((400, NO_JSON), (422, NO_GROUPS)):
        for body in bodies:
            response = post(client, "/v1/response", body)
            assert_problem(response, status)
            assert len(response.content) < 2000
    for media_type in (CSV, NC):
        assert_problem(post(client, "/v1/response", "{", media_type, pulse="sine"), 422)
    assert_problem(post(client, "/v1/response", b"\xff\xfe\x00"), 400)
    half = assert_problem(post(client, "/v1/response", '{"pulse":"\\ud800"' + GROUPS[15:] % 1), 422, "pulse")
    assert half["value"] == r"\ud800"


BATCH, BLOCKS, RESPONSE = "/v1/response", "/v1/blocks/response", "/v1/records/response?width=0.4&height=1.6"
FIVE = BATCH + "?pulse=sine"
OBJECTS = [{"name": "bust", "width": 0.4, "depth": 0.3, "height": 1.6, "friction": 0.5}]
SHORT = {"acceleration": [1.0, 0.0], "time_step": 0.1}
ASSESS, IDENTIFY = "/v1/assess?pga=3&pgv=0.3&shapes=sine&sensitivity=false", "/v1/identify"


def json_of(**body):
    return json.dumps(body)


BODIES = [
    (FIVE, "slenderness,frequency_ratio\n0.5,5\n", CSV, "restitution"),
    *((FIVE, body, CSV, "body") for body in ("slenderness,mass\n0.5,5\n", "slenderness\n\xff\n")),
    *((FIVE, f"slenderness,frequency_ratio,restitution\n0.5,5{rest}\n", CSV, "body") for rest in ("", ",x")),
    (FIVE + "&slenderness=0.4", "slenderness\n0.5\n", CSV, "slenderness"),
    (FIVE + "&restitution=0.4&frequency_ratio=x", "slenderness\n0.5\n", CSV, "frequency_ratio"),
    (FIVE + "&eta=0.4", "slenderness\n0.5\n", CSV, "eta"),
    *((FIVE, body, CSV, "lines of at most") for body in ("slenderness," * 200, "slenderness\n" + "1" * 2000)),
    (FIVE, "slenderness\n" + "0.5\n" * 10_000 + "x\n", CSV, "from line 10002"),
    *((FIVE, body, NC, "body") for body in ("\x89HDF\r\n", "CDF\x01\x00\x00")),
    (BLOCKS, json_of(pulse="sine", blocks=[]), JSON, "blocks"),
    (
        BLOCKS,
        json_of(pulse="sine", blocks=[{"width": 2, "peak_acceleration": 4, "period": 1}]),
        JSON,
        "blocks[0].height",
    ),
    (BLOCKS, json_of(pulse="sine", blocks=[{"width": 2}]), JSON, "blocks[0].peak_acceleration"),
    (BLOCKS + "?pulse=sine", TABLE.replace("[cm]", ""), CSV, "blocks, row 2, height"),
    (BLOCKS + "?pulse=sine", TABLE.replace("[cm]", "[kg]"), CSV, "blocks, line 1"),
    (BLOCKS + "?pulse=sine", TABLE.replace("80", "tall"), CSV, "blocks, row 2, height"),
    (BLOCKS + "?pulse=sine", TABLE.replace("0.2,", "1e9,"), CSV, "blocks, row 2, width"),
    *((RESPONSE + "&unit=g", body, CSV, "record") for body in ("\0\1\2", "<html>", "{}", "1\n2\n", "a,b\n1,2\n")),
    (RESPONSE, at2("NPTS= 10, DT= .01", body="0.1 0.2\n"), CSV, "record"),
    (IDENTIFY, "{}", JSON, "time"),
    (IDENTIFY, json_of(time=[0, 1], rotation=[0, 1], extra=1), JSON, "extra"),
    (IDENTIFY, json_of(time=[0, 1], rotation=[0]), JSON, "rotation"),
    (IDENTIFY, json_of(time=[20, *range(19)], rotation=[0.1] * 20), JSON, "time"),
    (IDENTIFY, json_of(time=[0, 1e308, 1.7e308], rotation=[1e-300, 1e300, 1e-308]), JSON, "time"),
    (IDENTIFY, json_of(time=[0] * (identify.MAX_SAMPLES + 1), rotation=[]), JSON, "time"),
    *((IDENTIFY, body, CSV, None) for body in ("", "time\n1\n2\n", "a,b,c\n1,2,3\n", "\x00" * 1000)),
    *((IDENTIFY, body, CSV, None) for body in ("0,nan\n1,inf\n", "1,2\n" * 60_000)),
    *((ASSESS, body, JSON, "objects") for body in ("{}", "[1]", "[]", "[{}]", '[{"name": [1], "width": 1}]')),
    *((ASSESS, body, CSV, "objects") for body in ("a,b\n1,2\n", "name,width,height\nbust,1,2\n")),
    *((ASSESS, body, CSV, "objects") for body in ("name,width [m],height [m]\n", "v" * 140_000, '"' * 999, "\0,\0\n")),
    ("/v1/assess", json_of(objects=OBJECTS, sensitivity=False, records=[SHORT], hazard={}), JSON, "hazard"),
    (
        "/v1/assess",
        json_of(objects=OBJECTS, sensitivity=False, records=[SHORT | {"acceleration": []}]),
        JSON,
        "acceleration",
    ),
    ("/v1/assess", json_of(objects=OBJECTS, sensitivity=False, records=[SHORT | {"unit": "ly"}]), JSON, "unit"),
    ("/v1/assess", json_of(objects=OBJECTS, sensitivity=False, records=3), JSON, "records"),
    ("/v1/assess", json_of(objects=OBJECTS, sensitivity=False, mesh="/etc/passwd"), JSON, "mesh"),
    (ASSESS, json_of(objects=[{"path": "/etc/passwd"}]), JSON, "objects"),
]
"""Address, body, its type, and what is named: a parameter, perhaps within another one, or a reason."""


@pytest.mark.parametrize(("route", "body", "media_type", "name"), BODIES, ids=range(len(BODIES)))
def test_a_wrong_body_is_refused_by_name(client, route, body, media_type, name):
    problem = assert_problem(post(client, route, body.encode("latin-1"), media_type), 422)
    assert name is None or name in json.dumps(problem)


SITES = [
    ("pgv=0.3", "pga"),
    ("pga=3", "site"),
    ("pga=3&pgv=0.3&period_min=0.2&period_max=1", "site"),
    ("pga=3&period_min=1&period_max=0.2", "periods"),
    ("pga=3&pgv=0.3&shapes=sine,square", "shapes"),
    ("pga=3&pgv=0.3&samples=1.5&floor_periods=0.5&shapes=sine", "samples"),
    *((f"pga=3&pgv=0.3&floor_periods={wrong}", "floor_periods") for wrong in ("0", "a")),
]
OF_RECORDS = [{"height": "x"}, {"restitution": "plastic"}, {"unit": "feet"}, {"vertical": "up"}]


def test_wrong_parameters_beside_a_body_are_named(client):
    for query, name in SITES:
        assert_problem(client.post(f"/v1/assess?{query}", json=OBJECTS), 422, name)
    record = NAPA.read_bytes()
    for wrong in OF_RECORDS:
        assert_problem(client.post("/v1/records/response", params=SIZE | wrong, content=record), 422, next(iter(wrong)))
    assert_problem(client.post(RESPONSE, params={"acceleration": "Z"}, content=record), 422, "record")
    scales = "/v1/records/scales?width=0.5&height=2"
    assert_problem(client.post(scales + "&scale_min=2&scale_max=1", content=record), 422, "scale_max")
    for factor in (1e-300, 1e-200, 1e-100, 1e-30, 1e6):
        trace = identify.EXAMPLE | {"time": [factor * time for time in identify.EXAMPLE["time"]]}
        problem = assert_problem(client.post(IDENTIFY, json=trace), 422, "time")
        assert "0.001 to 100000 s" in problem["allowed"]


def test_a_body_that_is_not_csv_is_refused_with_line_and_reason(client):
    for body, line, reason in (
        (TABLE.replace("vase", '"vase'), 2, "unexpected end of data"),
        (TABLE.replace("name", "n" * 131_073), 1, "field larger than field limit"),
    ):
        problem = assert_problem(post(client, BLOCKS, body, CSV, pulse="sine"), 422, "blocks")
        assert problem["detail"].startswith(f"blocks, line {line}:")
        assert reason in problem["value"]


@pytest.mark.parametrize("route", ["/v1/response", "/v1/assess", "/v1/spectrum", "/v1/records/response", IDENTIFY])
def test_types_and_codings_that_are_not_read_are_refused(client, route):
    if "records" not in route:
        status = 422 if route == "/v1/spectrum" else 415  # a route with JSON alone reads nothing else
        assert_problem(
            post(client, route, "<x/>", "application/xml", **({"pulse": "sine"} if route == BATCH else {})), status
        )
    bomb = gzip.compress(b" " * number(1_000_000, 50_000_000))
    for coding in ("gzip", "deflate", "br", "gzip, identity"):
        headers = {"content-type": JSON, "content-encoding": coding}
        assert_problem(client.post(route, content=bomb, headers=headers), 415, "Content-Encoding")


def test_odd_lengths_of_a_body(client):
    for declared in ("²", "1e3", "-1", "", "9" * 6000):
        headers = {"content-type": JSON, "content-length": declared.encode("latin-1")}
        assert client.post("/v1/response", content=b"{}", headers=headers).status_code in (413, 422)


def test_a_netcdf_file_of_a_wrong_size_or_damaged_anywhere(client):
    whole = bytes(xr.Dataset({"slenderness": ("point", np.linspace(0.1, 0.9, 50))}).to_netcdf(engine="scipy"))
    bodies, random = [], np.random.default_rng(5)
    where = whole.index(b"point") + 8  # after the name, padded: the length of the dimension
    bodies.extend(whole[:where] + length.to_bytes(4, "big") + whole[where + 4 :] for length in (51, 10**6, 2**31 - 1))
    for body in bodies:
        assert post(client, FIVE, body, NC, frequency_ratio=5, restitution=0.9).status_code in (413, 422)
    for _ in range(number(50, 300)):
        body = bytearray(whole)
        for position in random.integers(4, len(body), 3):
            body[position] = random.integers(256)
        body = bytes(body[: random.integers(4, len(body) + 1)])
        assert post(client, FIVE, body, NC, frequency_ratio=5, restitution=0.9).status_code in (200, 413, 422)


NAMES = [
    *("..%2f..%2fpyproject", "%2e%2e%2f%2e%2e%2fpyproject", "..%252f..%252fpyproject", "....//....//pyproject"),
    *("spectra%2f..%2f..%2fsecret", "spectra/sine/eta-0.85.nc%00", "spectra\\sine\\eta-0.85", "/etc/passwd"),
    *("%2fetc%2fpasswd", "file:%2f%2f%2fetc%2fpasswd", "spectra/sine/%2e/eta-0.85", "~root/x", "a" * 256),
    *("spectra/" + "a" * 256, "a" * 5000, "a/" * 2000 + "a", "spectra/\ud7ff/x", "spectra/sine/eta-0.99", "spectra"),
    *("../pyproject", "spectra/../../secret", "%2e%2e/x/y", ".hidden/x", "a//b", "no/such"),
]


def test_names_lead_to_nothing_but_data_sets_and_static_files(client):
    for name in NAMES:
        for suffix in ("", ".nc", ".zarr/.zmetadata", ".zarr/../../../x"):
            assert_problem(client.get(f"/v1/datasets/{name}{suffix}"), 404)
    for key in ("../../eta-0.85.nc", "..%2f..%2fx", "%00", "a" * 5000, ".zmetadata/../x", "", "none/0.0"):
        assert client.get(f"/v1/datasets/spectra/sine.zarr/{key}").status_code == 404
    for path in ("/static/../app.py", "/static/..%2fapp.py", "/static/%2e%2e/app.py", "/static/%00", "/v2/response"):
        assert client.get(path).status_code == 404
    for name in ("%2e%2e", "..%2f..", "%00", "a" * 5000, "demonstration%2ffragility"):
        assert client.get(f"/v1/suites/{name}").status_code == 404
    assert_problem(client.get("/v1/suites/none"), 404, "name")
    assert_problem(client.get("/v1/suites/none/nrml"), 404, "name")
    assert_problem(client.get("/v1/datasets/spectra/none/subset"), 404, "name")
    assert_problem(client.get("/v1/datasets/overturning/sine/eta-0.85/subset"), 422, "name")  # no cube


def test_sizes_are_limited(results, monkeypatch):
    """One service with small limits; bodies with and without their length."""
    monkeypatch.setattr(assess, "MAX_OBJECTS", 2)
    monkeypatch.setattr(block_models, "MAX_BLOCKS", 2)
    limits = {"max_points": 3, "max_body_bytes": 2000, "max_record_bytes": 1000, "max_samples": 200}
    batch = {"pulse": "sine", "frequency_ratio": 5.0, "restitution": 0.85}
    row = {"width": 0.4, "height": 1.6, "peak_acceleration": 4.0, "period": 0.5}
    grid = xr.Dataset(coords={"slenderness": [0.5, 0.6], "frequency_ratio": [5.0, 6.0]})
    with client_of(results, **limits) as client:
        for count, status in ((3, 200), (4, 413)):
            response = client.post("/v1/response", json=batch | {"slenderness": [0.5] * count})
            assert response.status_code == status
        assert_problem(response, 413, "points")
        assert_problem(post(client, FIVE, bytes(grid.to_netcdf(engine="scipy")), NC, restitution=1), 413, "points")
        assert_problem(post(client, "/v1/response", " " * 2001), 413, "body")
        assert_problem(post(client, "/v1/spectrum", iter([b" " * 300_000] * 2)), 413, "body")
        assert_problem(post(client, FIVE, iter([b"slenderness\n", *[b"0.5\n"] * 1000]), CSV), 413, "body")
        assert "1000 bytes" in assert_problem(post(client, RESPONSE, NAPA.read_bytes(), CSV), 413, "body")["allowed"]
        assert_problem(client.get(SUBSET), 413, "points")
        query = {"pulse": "sine", "restitution": 0.85}
        for columns, rows, wrong in ((20, 10, None), (20, 11, "columns"), (3, 90, "rows")):
            response = client.get("/v1/map", params=query | {"columns": columns, "rows": rows})
            assert response.status_code == (200 if wrong is None else 413)
            assert wrong is None or assert_problem(response, 413, wrong)
        assert_problem(
            post(client, RESPONSE.replace("response", "history"), RECORD, CSV, samples=10**6), 413, "samples"
        )
        for count, status in ((2, 200), (3, 413)):
            assert client.post(BLOCKS, json={"pulse": "sine", "blocks": [row] * count}).status_code == status
            lines = [TABLE.splitlines()[0], *TABLE.splitlines()[1:] * count]
            for end in ("\n", "\r\n", "\r"):
                response = post(client, BLOCKS, end.join([*lines, ""]), CSV, pulse="sine")
                assert response.status_code == status
            objects = client.post("/v1/assess?pga=3&pgv=0.3&shapes=sine&sensitivity=false", json=OBJECTS * count)
            assert objects.status_code == status
        assert assert_problem(response, 413, "blocks")["allowed"] == "at most 2"
        problem = assert_problem(objects, 413, "objects")
        assert (problem["value"], problem["allowed"]) == (3, "at most 2")
        table = "width [m],height [m]\n" + "0.4,1.6\n" * 3
        assert_problem(post(client, ASSESS, table, CSV), 413, "objects")


def test_large_bodies_are_limited_by_route(client, monkeypatch):
    assert "2097152" in assert_problem(post(client, BATCH, " " * (MAX_JSON + 1)), 413, "body")["allowed"]
    assert_problem(post(client, ASSESS, " " * (assess.MAX_BODY + 1), CSV), 413, "body")
    assert_problem(post(client, IDENTIFY, " " * (identify.MAX_BODY + 1)), 413, "body")
    assert_problem(post(client, "/v1/map", "0" * (MAX_BODY + 1)), 413, "body")
    table = "slenderness\n" + "1.5\n" * 100_001
    problem = post(client, BATCH, table, CSV, pulse="sine", frequency_ratio=5, restitution=0.9, format="json")
    assert "csv or nc" in assert_problem(problem, 413, "points")["allowed"]
    monkeypatch.setattr(assess, "MAX_PAIRS", 0)
    assert_problem(client.post(ASSESS, json=OBJECTS), 413, "objects")


PULSES = [
    ({"acceleration": [0, 1, None]}, "pulse.acceleration[2]"),
    ({"acceleration": [0, 1e400, 0]}, "pulse"),
    ({"acceleration": [0, [1], 0]}, "pulse.acceleration[1]"),
    ({"acceleration": [0, 0]}, "pulse"),
    ({"acceleration": [1.0] * (MAX_SAMPLES + 1)}, "pulse.acceleration"),
    ({"acceleration": "0,1,0"}, "pulse.acceleration"),
    ({"acceleration": [0, 1, 0], "time": [0, 2, 1]}, "pulse"),
    ({"acceleration": [0, 1, 0], "period": -1}, "pulse"),
    ({"acceleration": [0, 1, 0], "name": ""}, "pulse.name"),
    ({"acceleration": [0, 1, 0], "dt": 1}, "pulse.dt"),
    ({}, "pulse.acceleration"),
    (5, "pulse"),
    ("triangle", "pulse"),
]


@pytest.mark.parametrize("route", ["/v1/map", "/v1/response"])
def test_an_error_of_the_samples_of_a_pulse_names_the_element(client, route):
    body = {"/v1/map": {"restitution": 0.9}, "/v1/response": json.loads(GROUPS % 1)}[route]
    for pulse, name in PULSES:
        response = post(client, route, json.dumps(body | {"pulse": pulse}))
        problem = assert_problem(response, 422)
        assert problem["parameter"].startswith(name)
        assert len(response.content) < 3000


def test_hostile_json_is_refused_soon(client):
    few = {"restitution": 0.85, "columns": 4, "rows": 3}
    numbers = json.dumps(few | {"pulse": {"acceleration": [1.2345678901234567] * MAX_SAMPLES}})
    began = time.process_time()
    for body in (
        '{"pulse": ' + '{"acceleration": ' * 20_000,
        '{"pulse": {"acceleration": ' + "[" * 400_000,
        '{"pulse": {"acceleration": [' + "1" * 400_000 + "]}}",
        '{"pulse": {"acceleration": [' + '"a",' * 120_000 + "1]}}",
        '{"pulse": {"acceleration": [' + "1e999," * 70_000 + "1]}}",
        '{"a": "' + "\\u0000" * 60_000 + '"}',
    ):
        assert post(client, "/v1/map", body).status_code in (400, 422)
    assert post(client, "/v1/map", numbers).status_code == 200
    assert time.process_time() - began < 10.0
