"""Hostile requests: each has a response below 500 within a short time."""

import gzip
import json
import time

import anyio
import numpy as np
import pytest
import xarray as xr
from rocking_api.http.errors import error_response

from rocking._base.errors import InvalidArgumentError, SeveralArgumentsError
from tests.api.conftest import assert_problem

POINT = {"pulse": "sine", "slenderness": "0.6", "frequency_ratio": "6", "restitution": "0.85"}
BLOCK = {"pulse": "sine", "width": "0.4", "height": "1.6", "peak_acceleration": "4", "period": "0.5"}
ROUTES = {
    "/v1/response": POINT,
    "/v1/blocks/response": BLOCK,
    "/v1/thresholds": {key: POINT[key] for key in ("pulse", "frequency_ratio", "restitution")},
    "/v1/spectrum": {key: POINT[key] for key in ("pulse", "slenderness", "restitution")} | {"points": "20"},
    "/v1/history": POINT | {"samples": "20", "duration": "9"},
    "/v1/overturning": {key: POINT[key] for key in ("pulse", "restitution")},
}
NO_NUMBERS = ["1e400", "-1e400", "nan", "-nan", "inf", "Infinity", "1e", "0x10", "", " ", "١", "1,5", "9" * 5000]
NO_NUMBERS += ["null", "true", "[]", "{}", "\x00", "%00", "<script>", "' OR 1=1 --", "../../etc/passwd", "\ud7ff"]


@pytest.fixture(autouse=True)
def soon():
    began = time.monotonic()
    yield
    assert time.monotonic() - began < 15


@pytest.mark.parametrize("value", NO_NUMBERS)
@pytest.mark.parametrize("route", ROUTES)
def test_no_number_is_refused_by_name(client, route, value):
    for name in ROUTES[route]:
        if name == "restitution" and value == "true":
            continue
        assert_problem(client.get(route, params=ROUTES[route] | {name: value}), 422, name)


@pytest.mark.parametrize("route", ROUTES)
def test_a_parameter_given_twice_is_refused(client, route):
    for name, value in ROUTES[route].items():
        query = [*ROUTES[route].items(), (name, value)]
        problem = assert_problem(client.get(route, params=query), 422, name)
        assert problem["allowed"] == "one value"


@pytest.mark.parametrize("value", ["1e-300", "1e300", "1.7976931348623157e308", "5e-324", "-0.0"])
@pytest.mark.parametrize("route", ROUTES)
def test_extreme_numbers_have_a_response_or_an_error(client, route, value):
    for name in ROUTES[route]:
        if name != "pulse":
            response = client.get(route, params=ROUTES[route] | {name: value})
            assert response.status_code in (200, 422)
            json.loads(response.text, parse_constant=pytest.fail)  # no NaN, no Infinity


@pytest.mark.parametrize(("route", "name"), [("spectrum", "points"), ("history", "samples")])
@pytest.mark.parametrize("value", ["-1", "0", "1", "1e3", "10.5", "9" * 30])
def test_invalid_counts(client, route, name, value):
    query = ROUTES[f"/v1/{route}"] | {name: value}
    assert client.get(f"/v1/{route}", params=query).status_code in (413, 422)


@pytest.mark.parametrize(
    ("route", "name"),
    [("spectrum", "points"), ("history", "samples"), ("map", "columns"), ("map", "rows")],
)
@pytest.mark.parametrize("sign", ["", "-"])
def test_integers_beyond_all_doubles(client, route, name, sign):
    query = {key: POINT[key] for key in ("pulse", "slenderness", "restitution", "frequency_ratio")}
    unknown = {"spectrum": ["frequency_ratio"], "map": ["slenderness", "frequency_ratio"]}.get(route, [])
    query = {key: value for key, value in query.items() if key not in unknown} | {name: sign + "9" * 400}
    response = client.get(f"/v1/{route}", params=query)
    assert_problem(response, 422 if route == "history" or sign else 413, name)


NESTED = b"[" * 100_000 + b"]" * 100_000
BODIES = [
    b"",
    b"null",
    b"[]",
    b'"text"',
    b"\xff\xfe\x00",
    b"{" * 100_000,
    b'{"pulse":' * 50_000,
    NESTED,
    b'{"pulse":"sine","restitution":0.9,"frequency_ratio":5,"slenderness":' + NESTED + b"}",
    b'{"pulse":"sine","restitution":0.9,"frequency_ratio":5,"slenderness":{"0":1}}',
    b'{"pulse":"sine","restitution":0.9,"frequency_ratio":5,"slenderness":"0.5x"}',
    b'{"pulse":"sine","restitution":0.9,"frequency_ratio":5,"slenderness":[null]}',
    b'{"pulse":"sine","restitution":0.9,"frequency_ratio":5,"slenderness":1e999}',
    b'{"pulse":"sine","restitution":0.9,"frequency_ratio":5,"slenderness":-1}',
    b'{"pulse":"sine","restitution":0.9,"frequency_ratio":5,"slenderness":' + b"9" * 100_000 + b"}",
    b'{"pulse":["sine"],"restitution":0.9,"frequency_ratio":5,"slenderness":1}',
    b'{"pulse":"sine","pulse":"sinus","restitution":0.9,"frequency_ratio":5,"slenderness":1}',
    b'{"pulse":"\\ud800","restitution":0.9,"frequency_ratio":5,"slenderness":1}',
    b'{"pulse":"sine","restitution":0.9,"frequency_ratio":5,"slenderness":1,"' + b"x" * 100_000 + b'":1}',
]


def is_json(body):
    try:
        json.loads(body)["pulse"].encode() if b"ud800" in body else json.loads(body)
    except (ValueError, RecursionError):
        return False
    return True


@pytest.mark.parametrize("body", BODIES, ids=range(len(BODIES)))
@pytest.mark.parametrize("media_type", ["application/json", "text/csv", "application/x-netcdf"])
def test_invalid_bodies(client, body, media_type):
    response = client.post("/v1/response", content=body, headers={"content-type": media_type})
    assert_problem(response, 400 if media_type == "application/json" and not is_json(body) else 422)
    assert len(response.content) < 2000


@pytest.mark.parametrize("media_type", ["application/json", "text/csv", "application/x-netcdf"])
@pytest.mark.parametrize("coding", ["gzip", "deflate", "br", "gzip, identity"])
def test_compressed_bodies_are_refused(client, media_type, coding):
    bomb = gzip.compress(b" " * 50_000_000)
    headers = {"content-type": media_type, "content-encoding": coding}
    assert_problem(client.post("/v1/response", content=bomb, headers=headers), 415, "Content-Encoding")


@pytest.mark.parametrize("declared", ["²", "1e3", "-1", "", "9" * 6000])
def test_odd_lengths_of_a_body(client, declared):
    headers = {"content-type": "application/json", "content-length": declared.encode("latin-1")}
    assert client.post("/v1/response", content=b"{}", headers=headers).status_code in (413, 422)


def test_a_netcdf_file_with_a_wrong_size(client):
    body = bytearray(xr.Dataset({"slenderness": ("point", np.linspace(0.1, 0.9, 50))}).to_netcdf(engine="scipy"))
    where = body.index(b"point") + 8  # after the name, padded: the length of the dimension
    for length in (51, 10**6, 2**31 - 1):
        body[where : where + 4] = length.to_bytes(4, "big")
        response = client.post(
            "/v1/response",
            params={"pulse": "sine", "frequency_ratio": 5, "restitution": 0.9},
            content=bytes(body),
            headers={"content-type": "application/x-netcdf"},
        )
        assert response.status_code in (413, 422), length


def test_a_netcdf_file_damaged_anywhere(client):
    whole = bytes(xr.Dataset({"slenderness": ("point", np.linspace(0.1, 0.9, 5))}).to_netcdf(engine="scipy"))
    random = np.random.default_rng(5)
    for _ in range(300):
        body = bytearray(whole)
        for position in random.integers(4, len(body), 3):
            body[position] = random.integers(256)
        response = client.post(
            "/v1/response",
            params={"pulse": "sine", "frequency_ratio": 5, "restitution": 0.9},
            content=bytes(body[: random.integers(4, len(body) + 1)]),
            headers={"content-type": "application/x-netcdf"},
        )
        assert response.status_code in (200, 413, 422)


@pytest.mark.parametrize(
    "name",
    [
        "..%2f..%2fpyproject",
        "%2e%2e%2f%2e%2e%2fpyproject",
        "..%252f..%252fpyproject",
        "....//....//pyproject",
        "spectra%2f..%2f..%2fsecret",
        "spectra/sine/eta-0.85.nc%00",
        "spectra\\sine\\eta-0.85",
        "/etc/passwd",
        "%2fetc%2fpasswd",
        "file:%2f%2f%2fetc%2fpasswd",
        "spectra/sine/%2e/eta-0.85",
        "~root/x",
        "a" * 256,
        "spectra/" + "a" * 256,
        "a" * 5000,
        "a/" * 2000 + "a",
        "spectra/\ud7ff/x",
    ],
)
@pytest.mark.parametrize("suffix", ["", ".nc", ".zarr/.zmetadata", ".zarr/../../../x"])
def test_path_traversal_by_names_is_404(client, name, suffix):
    assert_problem(client.get(f"/v1/datasets/{name}{suffix}"), 404)


@pytest.mark.parametrize("key", ["../../eta-0.85.nc", "..%2f..%2fx", "%00", "a" * 5000, ".zmetadata/../x", ""])
def test_path_traversal_by_zarr_keys_is_404(client, key):
    assert client.get(f"/v1/datasets/spectra/sine/eta-0.85.zarr/{key}").status_code == 404


@pytest.mark.parametrize("path", ["/static/../app.py", "/static/..%2fapp.py", "/static/%2e%2e/app.py", "/static/%00"])
def test_only_static_files_are_served(client, path):
    assert client.get(path).status_code == 404


@pytest.mark.parametrize(
    ("header", "value"),
    [
        ("accept", "application/json;q=" + "9" * 5000),
        ("accept", ",".join(["text/csv;q=x"] * 2000)),
        ("if-none-match", '"' + "a" * 20_000),
        ("range", "bytes=" + ",".join(f"{k}-{k}" for k in range(3000))),
        ("range", "bytes=0-" + "9" * 5000),
        ("if-range", "\x80"),
        ("accept-encoding", "gzip;q=nan"),
        ("content-type", "application/json; charset=" + "x" * 5000),
        ("x-request-id", "\x80\x81"),
        ("host", "[::::"),
        ("origin", "null"),
    ],
)
def test_odd_headers(client, header, value):
    for url in ("/v1/response?pulse=sine&slenderness=2&frequency_ratio=1&restitution=1", "/v1/datasets", "/",
                "/v1/datasets/spectra/sine/eta-0.85.nc"):  # fmt: skip
        assert client.get(url, headers={header: value.encode("latin-1")}).status_code < 500


@pytest.mark.parametrize("count", [1, 2])
def test_half_of_a_pair_of_escapes_is_repeated_as_text(count):
    errors = [InvalidArgumentError(f"a{number} \ud800", "b \udc00", "c \udfff") for number in range(count)]
    response = anyio.run(error_response, None, errors[0] if count == 1 else SeveralArgumentsError(errors))
    problem = json.loads(response.body)
    assert [problem[name] for name in ("parameter", "value", "allowed")] == [r"a0 \ud800", r"b \udc00", r"c \udfff"]
    assert r"\ud800" in problem["detail"]
    assert len(problem.get("errors", [])) == (0 if count == 1 else 2)
