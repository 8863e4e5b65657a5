"""GET and POST /v1/response."""

import io
import math

import numpy as np
import rocking_api.execution.evaluation
import xarray as xr

import rocking
from rocking._datasets.cube import write_dataset
from rocking._model.response import Outcome
from rocking._solver.peak_response import peak_response
from rocking._spectra.cubes import spectra
from tests.api.conftest import CSV, NC, POINT, assert_problem, client_of, post
from tests.cf_compliance import complaints


def get_response(client, **changes):
    return client.get("/v1/response", params=POINT | changes)


def test_a_response_is_from_a_cube_or_the_solver_as_asked(client):
    expected = peak_response("sine", slenderness=0.6, frequency_ratio=6.0, restitution=0.85)
    result = get_response(client).json()
    assert result["source"] == "cube"
    assert abs(result["peak_rotation"] - expected.peak_rotation) <= result["error_bound"] <= 1e-4
    assert result["outcome"] == Outcome(expected.outcome).name == "RECOVERS"
    assert result["impacts"] == expected.impacts
    assert not result["overturned"]
    assert result["query"] == POINT | {"alpha_deg": None, "method": "auto", "absolute_tolerance": 1e-4}
    assert result["data_version"] == client.get("/v1/datasets/spectra/sine/eta-0.85").json()["sha256"]
    result = get_response(client, method="solver").json()
    assert (result["source"], result["data_version"]) == ("solver", None)
    assert result["peak_rotation"] == expected.peak_rotation
    assert 0 < result["error_bound"] < 1e-9
    for changes in ({"restitution": 0.7}, {"frequency_ratio": 40.0}, {"pulse": "half_sine"}):  # no cube applies
        solved = {key: value for key, value in (POINT | changes).items() if key != "pulse"}
        result = get_response(client, **changes).json()
        assert result["source"] == "solver"
        assert result["peak_rotation"] == peak_response(changes.get("pulse", "sine"), **solved).peak_rotation
    too_coarse = get_response(client, absolute_tolerance=1e-13).json()
    assert (too_coarse["source"], too_coarse["peak_rotation"]) == ("solver", expected.peak_rotation)
    result = get_response(client, slenderness=0.3, frequency_ratio=2.0).json()
    assert result["overturned"]
    assert result["peak_rotation"] is result["error_bound"] is None
    assert "overturns" in result["note"]


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


BATCH = {
    "slenderness": np.array([0.6, 0.3, 1.2, 0.62]),
    "frequency_ratio": np.array([6.0, 2.0, 1.0, 20.0]),
    "restitution": np.array([0.85, 0.85, 0.85, 0.7]),
}
TRUTH = [Outcome.RECOVERS, Outcome.OVERTURNED_DIRECTLY, Outcome.NO_UPLIFT, Outcome.RECOVERS]


def test_a_batch_equals_single_requests_in_json_and_csv(client):
    body = {"pulse": "sine"} | {name: values.tolist() for name, values in BATCH.items()}
    result = client.post("/v1/response", json=body).json()
    assert result["query"]["points"] == 4
    for k in range(4):
        single = get_response(client, **{name: values[k] for name, values in BATCH.items()}).json()
        for name in ("peak_rotation", "overturned", "outcome", "impacts", "exceeded_alpha", "error_bound", "source"):
            assert result[name][k] == single[name]
    assert result["data_versions"] == [get_response(client).json()["data_version"]]
    assert result["outcome"] == [outcome.name for outcome in TRUTH]
    lines = [",".join(BATCH), *(",".join(map(repr, map(float, row))) for row in zip(*BATCH.values(), strict=True))]
    for query in ({"pulse": "sine"}, {"pulse": "sine", "absolute_tolerance": 1e-3}):
        answer = post(client, "/v1/response", "\r\n".join(lines), CSV, **query)
        assert answer.headers["content-type"].startswith("text/csv")
        header, *rows = [line.split(",") for line in answer.text.splitlines()]
        assert [row[header.index("outcome")] for row in rows] == result["outcome"]
        assert rows[1][header.index("peak_rotation")] == ""
        assert float(rows[0][header.index("error_bound")]) <= 1e-3


def test_numbers_broadcast_and_json_holds_all_parameters(client):
    body = POINT | {"slenderness": [0.5, 0.6]}
    assert client.post("/v1/response", json=body).json()["outcome"] == ["RECOVERS", "RECOVERS"]
    assert client.post("/v1/response", json=body | {"slenderness": []}).json()["outcome"] == []
    assert_problem(client.post("/v1/response?pulse=cosine", json=body), 422, "pulse")
    assert_problem(client.post("/v1/response?restitution=0.9", json=body), 422, "restitution")


def test_batches_in_chunks_are_equal(client, monkeypatch):
    many = POINT | {"slenderness": [0.05 + 0.009 * k for k in range(101)]}
    whole = client.post("/v1/response", json=many).json()
    monkeypatch.setattr(rocking_api.execution.evaluation, "CHUNK_SIZE", 7)
    assert client.post("/v1/response", json=many).json() == whole


def test_netcdf_batch_in_and_out(client, tmp_path):
    grid = xr.Dataset(coords={"slenderness": [0.5, 0.6, 1.5], "frequency_ratio": [5.0, 6.0]})
    result = post(client, "/v1/response?pulse=sine&restitution=0.85", bytes(grid.to_netcdf(engine="scipy")), NC)
    assert result.headers["content-type"] == NC
    (tmp_path / "answer.nc").write_bytes(result.content)
    assert complaints(tmp_path / "answer.nc") == []
    found = xr.open_dataset(io.BytesIO(result.content), engine="scipy").load()
    groups = {name: found[name] for name in ("slenderness", "frequency_ratio")}
    expected = peak_response("sine", **groups, restitution=0.85)
    assert found.sizes == {"point": 6}
    np.testing.assert_array_equal(found.outcome, expected.outcome)
    assert np.all(np.abs(found.peak_rotation - expected.peak_rotation) <= found.error_bound)
    assert found.attrs["pulse"] == "sine"
    assert found.outcome.attrs["flag_meanings"].split()[1] == "recovers"


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
