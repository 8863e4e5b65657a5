"""GET and POST /v1/response."""

import io
import math

import numpy as np
import pytest
import xarray as xr

import rocking
from rocking._datasets.cube import write_dataset
from rocking._model.response import Outcome
from rocking._solver.peak_response import peak_response
from rocking._spectra.cubes import spectra
from tests.api.conftest import assert_problem, client_of

QUERY = {"pulse": "sine", "slenderness": 0.6, "frequency_ratio": 6.0, "restitution": 0.85}


def get_response(client, **changes):
    return client.get("/v1/response", params=QUERY | changes)


def test_a_response_from_a_cube(client):
    result = get_response(client).json()
    expected = peak_response("sine", slenderness=0.6, frequency_ratio=6.0, restitution=0.85)
    assert result["source"] == "cube"
    assert abs(result["peak_rotation"] - expected.peak_rotation) <= result["error_bound"] <= 1e-4
    assert result["outcome"] == Outcome(expected.outcome).name == "RECOVERS"
    assert result["impacts"] == expected.impacts
    assert not result["overturned"]
    assert result["query"] == QUERY | {"alpha_deg": None, "method": "auto", "absolute_tolerance": 1e-4}
    stored = client.get("/v1/datasets/spectra/sine/eta-0.85").json()
    assert result["data_version"] == stored["sha256"]


def test_between_restitutions_the_data_set_next_below_is_named(tmp_path):
    window = {"slenderness": np.linspace(0.5, 0.7, 41), "frequency_ratio": np.geomspace(5.0, 8.0, 31)}
    for cube in spectra("sine", restitution=[0.82, 0.84, 0.86, 0.88, 0.90], **window):
        write_dataset(cube, tmp_path / "spectra" / "sine" / f"eta-{float(cube.restitution):.2f}.nc")
    with client_of(tmp_path) as client:
        result = get_response(client, restitution=0.87).json()
        below = client.get("/v1/datasets/spectra/sine/eta-0.86").json()
    expected = peak_response("sine", slenderness=0.6, frequency_ratio=6.0, restitution=0.87)
    assert result["source"] == "cube"
    assert result["data_version"] == below["sha256"]
    assert abs(result["peak_rotation"] - expected.peak_rotation) <= result["error_bound"] <= 1e-4


def test_a_response_from_the_solver_equals_the_solver(client):
    result = get_response(client, method="solver").json()
    expected = peak_response("sine", slenderness=0.6, frequency_ratio=6.0, restitution=0.85)
    assert result["source"] == "solver"
    assert result["peak_rotation"] == expected.peak_rotation
    assert 0 < result["error_bound"] < 1e-9
    assert result["data_version"] is None


@pytest.mark.parametrize(
    "changes",
    [{"restitution": 0.7}, {"frequency_ratio": 40.0}, {"pulse": "half_sine"}, {"absolute_tolerance": 1e-13}],
    ids=["no cube of this restitution", "outside the cube", "no cube of this pulse", "too coarse"],
)
def test_auto_uses_the_solver_where_no_cube_applies(client, changes):
    result = get_response(client, **changes).json()
    assert result["source"] == "solver"
    requested = {key: value for key, value in (QUERY | changes).items() if key not in ("pulse", "absolute_tolerance")}
    assert result["peak_rotation"] == peak_response(changes.get("pulse", "sine"), **requested).peak_rotation


def test_overturned_has_no_peak_and_a_note(client):
    result = get_response(client, slenderness=0.3, frequency_ratio=2.0).json()
    assert result["overturned"]
    assert result["peak_rotation"] is result["error_bound"] is None
    assert "overturns" in result["note"]


def test_without_a_bound_there_is_a_warning(client):
    block = {"frequency_ratio": 5.0, "restitution": 0.9, "method": "solver"}
    found = client.get("/v1/thresholds", params={"pulse": "sine", "frequency_ratio": 5.0, "restitution": 0.9}).json()
    threshold = found["thresholds"][0]["slenderness"]
    below, above = threshold * (1.0 - 1e-11), threshold * (1.0 + 1e-11)  # it overturns below
    while math.nextafter(below, 1.0) < above:
        middle = below + 0.5 * (above - below)
        if get_response(client, slenderness=middle, **block).json()["overturned"]:
            below = middle
        else:
            above = middle
    result = get_response(client, slenderness=above, **block).json()
    assert (result["overturned"], result["error_bound"]) == (False, None)
    assert result["warnings"] == [result["note"]]
    assert "rounding" in result["note"]


@pytest.mark.parametrize(
    ("changes", "parameter"),
    [
        ({"pulse": "sinus"}, "pulse"),
        ({"restitution": 1.01}, "restitution"),
        ({"restitution": -0.1}, "restitution"),
        ({"slenderness": 0}, "slenderness"),
        ({"slenderness": -1}, "slenderness"),
        ({"slenderness": "nan"}, "slenderness"),
        ({"slenderness": "inf"}, "slenderness"),
        ({"slenderness": "much"}, "slenderness"),
        ({"frequency_ratio": "-inf"}, "frequency_ratio"),
        ({"frequency_ratio": 0}, "frequency_ratio"),
        ({"absolute_tolerance": -1}, "absolute_tolerance"),
        ({"absolute_tolerance": "nan"}, "absolute_tolerance"),
        ({"method": "guess"}, "method"),
        ({"alpha_deg": 95}, "alpha_deg"),
        ({"tolerence": 1e-6}, "tolerence"),
        ({"frequency_ratio": 40, "method": "cube"}, "frequency_ratio"),
        ({"slenderness": 0.01, "method": "cube"}, "slenderness"),
        ({"restitution": 0.7, "method": "cube"}, "restitution"),
        ({"pulse": "-ricker", "method": "cube"}, "pulse"),
        ({"alpha_deg": 80, "method": "cube"}, "alpha_deg"),
        ({"absolute_tolerance": 1e-13, "method": "cube"}, "absolute_tolerance"),
    ],
)
def test_bad_input_names_parameter_value_and_range(client, changes, parameter):
    problem = assert_problem(get_response(client, **changes), 422, parameter)
    value = next(iter(changes.values()))
    assert str(problem["value"]).startswith(str(value)) or float(problem["value"]) == value


def test_it_is_said_whether_a_value_is_expected_in_the_query_or_in_the_body(client):
    url, csv = "/v1/response", {"headers": {"content-type": "text/csv"}, "content": "slenderness\n0.4\n"}
    body = {"pulse": "sine", "frequency_ratio": 5, "restitution": 0.85}
    assert assert_problem(client.post(url, json=body), 422, "slenderness")["allowed"] == "required in the body"
    unknown = assert_problem(client.post(url, json=body | {"slenderness": 1, "colour": 1}), 422, "colour")
    assert unknown["detail"].startswith("there is no parameter `colour` in the body; allowed: one of pulse")
    query = "?frequency_ratio=5&restitution=0.85"
    assert assert_problem(client.post(url + query, **csv), 422, "pulse")["allowed"] == "required in the query"
    unknown = assert_problem(client.post(url + query + "&pulse=sine&colour=1", **csv), 422, "colour")
    assert unknown["allowed"].endswith(", in the query")
    column = assert_problem(client.post(url + "?restitution=1&pulse=sine", **csv), 422, "frequency_ratio")
    assert column["allowed"] == "required: a column of the body or a parameter in the URL"
    block = {"width": 0.4, "height": 1.6, "peak_acceleration": 4.0, "period": 0.5}
    missing = assert_problem(client.post("/v1/blocks/response", json={"blocks": [block]}), 422, "pulse")
    assert missing["allowed"] == "required in the query, or in a JSON body"
    blocks = {"blocks": [{"width": 0.4}], "colour": 1}
    problem = assert_problem(client.post("/v1/blocks/response?pulse=sine", json=blocks), 422)
    assert "`blocks[0].period` is missing in the body" in problem["detail"]
    assert "there is no parameter `colour` in the body" in problem["detail"]


def test_several_missing_or_wrong_parameters_are_all_named(client):
    problem = assert_problem(client.get("/v1/response?pulse=saw&slenderness=x&restitution=3&colour=1"), 422)
    assert [one["name"] for one in problem["errors"]] == [
        "pulse", "slenderness", "frequency_ratio", "restitution", "colour",
    ]  # fmt: skip
    _, first, missing, above, unknown = problem["errors"]
    assert first == {"name": "slenderness", "value": "x", "allowed": "a number"}
    assert missing == {"name": "frequency_ratio", "allowed": "required in the query"}
    assert unknown["allowed"].startswith(
        "one of pulse, alpha_deg, method, absolute_tolerance, slenderness, frequency_ratio"
    )
    assert above == {"name": "restitution", "value": 3.0, "allowed": "[0, 1] [-]"}
    assert (problem["parameter"], problem["value"]) == ("pulse", "saw")
    assert problem["detail"].startswith("5 parameters are missing or wrong: `pulse` = 'saw' is not allowed")
    outside = assert_problem(get_response(client, slenderness=-1.0, restitution=2.0), 422, "slenderness")
    assert [one["name"] for one in outside["errors"]] == ["slenderness", "restitution"]


def test_unknown_parameters_are_named_up_to_a_number(client):
    problem = assert_problem(get_response(client, **{f"unknown_{k}": 1 for k in range(50)}), 422, "unknown_0")
    assert len(problem["errors"]) == 20
    assert problem["detail"].startswith("50 parameters")


BATCH = {
    "slenderness": np.array([0.6, 0.3, 1.2, 0.62]),
    "frequency_ratio": np.array([6.0, 2.0, 1.0, 20.0]),
    "restitution": np.array([0.85, 0.85, 0.85, 0.7]),
}
TRUTH = [Outcome.RECOVERS, Outcome.OVERTURNED_DIRECTLY, Outcome.NO_UPLIFT, Outcome.RECOVERS]


def test_a_json_batch_equals_single_requests(client):
    body = {"pulse": "sine"} | {name: values.tolist() for name, values in BATCH.items()}
    result = client.post("/v1/response", json=body).json()
    assert result["query"]["points"] == 4
    for k in range(4):
        single = get_response(client, **{name: values[k] for name, values in BATCH.items()}).json()
        for name in ("peak_rotation", "overturned", "outcome", "impacts", "exceeded_alpha", "error_bound", "source"):
            assert result[name][k] == single[name]
    assert result["data_versions"] == [get_response(client).json()["data_version"]]


def test_numbers_broadcast_against_arrays(client):
    body = {"pulse": "sine", "slenderness": [0.5, 0.6], "frequency_ratio": 6.0, "restitution": 0.85}
    assert client.post("/v1/response", json=body).json()["outcome"] == ["RECOVERS", "RECOVERS"]
    body["slenderness"] = []
    assert client.post("/v1/response", json=body).json()["outcome"] == []


def test_csv_batch(client):
    lines = [",".join(BATCH), *(",".join(map(repr, map(float, row))) for row in zip(*BATCH.values(), strict=True))]
    result = client.post(
        "/v1/response",
        params={"pulse": "sine", "absolute_tolerance": 1e-3},
        content="\r\n".join(lines),
        headers={"content-type": "text/csv"},
    )
    assert result.headers["content-type"].startswith("text/csv")
    header, *rows = [line.split(",") for line in result.text.splitlines()]
    assert [row[header.index("outcome")] for row in rows] == [outcome.name for outcome in TRUTH]
    assert rows[1][header.index("peak_rotation")] == ""
    assert float(rows[0][header.index("error_bound")]) <= 1e-3


def test_netcdf_batch_in_and_out(client):
    grid = xr.Dataset(coords={"slenderness": [0.5, 0.6, 1.5], "frequency_ratio": [5.0, 6.0]})
    result = client.post(
        "/v1/response",
        params={"pulse": "sine", "restitution": 0.85},
        content=bytes(grid.to_netcdf(engine="scipy")),
        headers={"content-type": "application/x-netcdf"},
    )
    assert result.headers["content-type"] == "application/x-netcdf"
    found = xr.open_dataset(io.BytesIO(result.content), engine="scipy").load()
    expected = peak_response(
        "sine", slenderness=found.slenderness, frequency_ratio=found.frequency_ratio, restitution=0.85
    )
    assert found.sizes == {"point": 6}
    np.testing.assert_array_equal(found.outcome, expected.outcome)
    assert np.all(np.abs(found.peak_rotation - expected.peak_rotation) <= found.error_bound)
    assert found.attrs["pulse"] == "sine"
    assert found.outcome.attrs["flag_meanings"].split()[1] == "recovers"


def post(client, content, media_type, **parameters):
    return client.post("/v1/response", params=parameters, content=content, headers={"content-type": media_type})


@pytest.mark.parametrize(
    ("content", "media_type", "parameters", "parameter"),
    [
        (b"{", "application/json", {}, "body"),
        (b"[1, 2]", "application/json", {}, "body"),
        (b'{"pulse": "sine", "slenderness": [NaN], "frequency_ratio": 1, "restitution": 1}', "application/json", {},
         "slenderness"),
        (b'{"pulse": "sine", "slenderness": [1, 2], "frequency_ratio": [1, 2, 3], "restitution": 1}',
         "application/json", {}, "slenderness"),
        (b'{"pulse": "sine", "slenderness": [[1]], "frequency_ratio": 1, "restitution": 1}', "application/json", {},
         "slenderness"),
        (b'{"pulse": "sine", "slenderness": 1, "frequency_ratio": 1, "restitution": 1}', "application/json",
         {"eta": "0.4"}, "eta"),
        (b"slenderness,frequency_ratio\n0.5,5\n", "text/csv", {"pulse": "sine"}, "restitution"),
        (b"slenderness,mass\n0.5,5\n", "text/csv", {"pulse": "sine"}, "body"),
        (b"slenderness,frequency_ratio,restitution\n0.5,5\n", "text/csv", {"pulse": "sine"}, "body"),
        (b"slenderness,frequency_ratio,restitution\n0.5,5,x\n", "text/csv", {"pulse": "sine"}, "body"),
        (b"slenderness\n\xff\n", "text/csv", {"pulse": "sine"}, "body"),
        (b"slenderness\n0.5\n", "text/csv", {"pulse": "sine", "slenderness": "0.4"}, "slenderness"),
        (b"slenderness\n0.5\n", "text/csv", {"pulse": "sine", "restitution": "0.4", "frequency_ratio": "x"},
         "frequency_ratio"),
        (b"slenderness\n0.5\n", "text/csv", {"pulse": "sine", "eta": "0.4"}, "eta"),
        (b"\x89HDF\r\n", "application/x-netcdf", {"pulse": "sine"}, "body"),
        (b"CDF\x01\x00\x00", "application/x-netcdf", {"pulse": "sine"}, "body"),
    ],
)  # fmt: skip
def test_bodies_that_cannot_be_read_are_explained(client, content, media_type, parameters, parameter):
    status = 400 if content == b"{" else 422  # no JSON at all
    assert_problem(post(client, content, media_type, **parameters), status, parameter)


def test_too_much_at_once(results):
    with client_of(results, max_points=3, max_body_bytes=2000) as client:
        body = {"pulse": "sine", "slenderness": [0.5] * 4, "frequency_ratio": 5.0, "restitution": 0.85}
        assert_problem(client.post("/v1/response", json=body), 413, "points")
        body["slenderness"] = [0.5] * 3
        assert client.post("/v1/response", json=body).status_code == 200
        assert_problem(post(client, b" " * 2001, "application/json"), 413, "body")
        chunks = iter([b"slenderness\n", *[b"0.5\n"] * 1000])  # no Content-Length
        assert_problem(post(client, chunks, "text/csv", pulse="sine"), 413, "body")
        grid = xr.Dataset(coords={"slenderness": [0.5, 0.6], "frequency_ratio": [5.0, 6.0]})
        content = bytes(grid.to_netcdf(engine="scipy"))
        assert_problem(post(client, content, "application/x-netcdf", pulse="sine", restitution=1.0), 413, "points")


@pytest.mark.parametrize(
    ("changes", "parameter"),
    [
        ({"slenderness": 1e-10}, "slenderness"),
        ({"frequency_ratio": 1e7}, "frequency_ratio"),
        ({"frequency_ratio": 1e-7}, "frequency_ratio"),
        ({"alpha_deg": 1e-9}, "alpha_deg"),
    ],
)
def test_values_outside_the_ranges_of_the_service(client, changes, parameter):
    assert_problem(get_response(client, **changes), 422, parameter)


def test_a_json_batch_may_repeat_its_parameters_in_the_url(client):
    body = {"pulse": "sine", "slenderness": [0.6], "frequency_ratio": 6.0, "restitution": 0.85}
    named, plain = client.post("/v1/response?pulse=sine", json=body), client.post("/v1/response", json=body)
    assert named.json() == plain.json() | {"url": "POST /v1/response?pulse=sine"}
    assert_problem(client.post("/v1/response?pulse=cosine", json=body), 422, "pulse")
    assert_problem(client.post("/v1/response?restitution=0.9", json=body), 422, "restitution")


def test_a_number_of_impacts_that_a_cube_leaves_open_is_null(results, client):
    """Beside nodes with another number; the solver counts."""
    point = {"absolute_tolerance": 1e-2}
    random = np.random.default_rng(1)
    points = {"slenderness": random.uniform(0.5, 0.94, 3000), "frequency_ratio": random.uniform(1.0, 11.0, 3000)}
    cube = rocking.open_cube(results / "spectra" / "sine" / "eta-0.85.nc")
    found = cube.response(**points, absolute_tolerance=1e-2)
    open_ones = np.flatnonzero(found.from_cube & (found.impacts < 0))
    assert open_ones.size
    k = int(open_ones[0])
    point |= {name: float(values[k]) for name, values in points.items()}
    answer = get_response(client, **point).json()
    assert answer["source"] == "cube"
    assert answer["impacts"] is None
    assert "method=solver" in answer["note"]
    counted = get_response(client, **point, method="solver").json()
    assert counted["impacts"] == peak_response("sine", restitution=0.85, **{n: point[n] for n in points}).impacts
    assert counted["note"] is None
