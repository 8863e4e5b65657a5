"""GET /v1/spectrum, /v1/overturning and /v1/history, in every format."""

import csv
import io

import numpy as np
import pytest
import rocking_api.routers.overturning
import xarray as xr

from rocking._boundary.curves import join_curves
from rocking._boundary.tracing import overturning_boundary
from rocking._datasets.cube import read_dataset, write_dataset
from rocking._history.time_history import time_history
from rocking._solver.peak_response import peak_response
from tests.api.conftest import client_of

GROUPS = {"slenderness": 0.4, "frequency_ratio": 5.0, "restitution": 0.85}
BLOCK = {"pulse": "sine"} | GROUPS
SPECTRUM = {"pulse": "sine", "slenderness": 0.6, "restitution": 0.85, "points": 50}
ROUTES = {
    "/v1/spectrum": SPECTRUM,
    "/v1/overturning": {"pulse": "sine", "restitution": 0.85},
    "/v1/history": BLOCK,
}


def read_netcdf(response):
    assert response.headers["content-type"] == "application/x-netcdf"
    return xr.open_dataset(io.BytesIO(response.content), engine="scipy").load()


def read_csv(response):
    assert response.headers["content-type"].startswith("text/csv")
    return list(csv.DictReader(io.StringIO(response.text)))


def test_spectrum_lies_within_its_bounds(client):
    result = client.get("/v1/spectrum", params=SPECTRUM).json()
    expected = peak_response("sine", slenderness=0.6, frequency_ratio=np.geomspace(0.5, 12.0, 50), restitution=0.85)
    assert result["frequency_ratio"] == np.geomspace(0.5, 12.0, 50).tolist()
    assert result["overturned"] == expected.overturned.tolist()
    assert any(result["overturned"])
    assert {"cube", "solver"} >= set(result["source"])
    for peak, bound, exact in zip(result["peak_rotation"], result["error_bound"], expected.peak_rotation, strict=True):
        assert peak is None or abs(peak - exact) <= bound


def test_the_three_formats_of_a_spectrum_agree(client):
    result = client.get("/v1/spectrum", params=SPECTRUM).json()
    rows = read_csv(client.get("/v1/spectrum", params=SPECTRUM | {"format": "csv"}))
    stored = read_netcdf(client.get("/v1/spectrum", params=SPECTRUM, headers={"accept": "application/x-netcdf"}))
    assert [row["outcome"] for row in rows] == result["outcome"]
    assert [float(row["peak_rotation"]) if row["peak_rotation"] else None for row in rows] == result["peak_rotation"]
    np.testing.assert_array_equal(
        stored["peak_rotation"], [np.nan if peak is None else peak for peak in result["peak_rotation"]]
    )
    assert stored.attrs["slenderness"] == 0.6


def test_traced_curves_are_cached(client, monkeypatch):
    traced = []

    def trace(*args, **kwargs):
        traced.append(args)
        return overturning_boundary(*args, **kwargs)

    monkeypatch.setattr(rocking_api.routers.overturning, "overturning_boundary", trace)
    query = {"pulse": "half_sine", "restitution": 0.8765}
    responses = [client.get("/v1/overturning", params=query | more) for more in ({}, {"alpha_deg": 0}, {})]
    assert len(traced) == 1
    assert responses[0].headers["etag"] == responses[2].headers["etag"]
    assert responses[0].json()["curves"] == responses[1].json()["curves"]
    known = client.get("/v1/overturning", params=query, headers={"If-None-Match": responses[0].headers["etag"]})
    assert known.status_code == 304


def test_overturning_reads_the_curves_of_the_workflow(client, results):
    result = client.get("/v1/overturning", params=ROUTES["/v1/overturning"]).json()
    stored = read_dataset(results / "overturning" / "sine" / "eta-0.85.nc")
    assert result["source"] == "dataset"
    assert result["data_version"] == client.get("/v1/datasets/overturning/sine/eta-0.85").json()["sha256"]
    assert [len(curve["slenderness"]) for curve in result["curves"]] == stored["row_size"].values.tolist()
    np.testing.assert_array_equal(
        np.concatenate([curve["slenderness"] for curve in result["curves"]]), stored["slenderness"]
    )
    assert {curve["outcome"] for curve in result["curves"]} == {"OVERTURNED_DIRECTLY", "OVERTURNED_AFTER_IMPACT"}


def test_overturning_returns_the_curves_of_the_requested_angle(own_results):
    path = own_results / "overturning" / "sine" / "eta-0.85.nc"
    slender = read_dataset(path)
    alpha = np.radians(20)
    rigid = overturning_boundary("sine", restitution=0.85, alpha=alpha, nodes=41).drop_attrs(deep=False)
    rigid["alpha"] = "curve", np.full(rigid.sizes["curve"], alpha)
    rigid = rigid.assign_coords({name: slender[name] for name in ("pulse", "restitution")})
    write_dataset(join_curves([slender, rigid]), path)
    with client_of(own_results) as client:
        for angle, stored in ((None, slender), (0, slender), (20, rigid)):
            requested = ROUTES["/v1/overturning"] | ({} if angle is None else {"alpha_deg": angle})
            result = client.get("/v1/overturning", params=requested).json()
            assert result["source"] == "dataset"
            found = [s for curve in result["curves"] for s in curve["slenderness"]]
            assert found == stored["slenderness"].values.tolist()
        requested["alpha_deg"] = 10
        assert client.get("/v1/overturning", params=requested).json()["source"] == "solver"


@pytest.mark.parametrize("changes", [{"restitution": 0.5}, {"pulse": "half_sine"}])
def test_overturning_traces_curves_that_are_not_stored(client, changes):
    result = client.get("/v1/overturning", params=ROUTES["/v1/overturning"] | changes).json()
    assert (result["source"], result["data_version"]) == ("solver", None)
    curve = max(result["curves"], key=lambda curve: len(curve["slenderness"]))
    assert curve["outcome"].startswith("OVERTURNED")
    for s, w in list(zip(curve["slenderness"], curve["frequency_ratio"], strict=True))[::40]:
        beside = s * (1 + np.array([-1e-9, 1e-9]))
        pulse, eta = changes.get("pulse", "sine"), changes.get("restitution", 0.85)
        overturned = peak_response(pulse, slenderness=beside, frequency_ratio=w, restitution=eta).overturned
        assert overturned[0] != overturned[1] or s < 0.02


def test_damaged_curves_are_traced_instead(own_results):
    (own_results / "overturning" / "sine" / "eta-0.85.nc").write_bytes(b"not a netCDF file")
    with client_of(own_results) as client:
        assert client.get("/v1/overturning", params=ROUTES["/v1/overturning"]).json()["source"] == "solver"


def test_overturning_as_csv_and_netcdf(client):
    result = client.get("/v1/overturning", params=ROUTES["/v1/overturning"]).json()
    rows = read_csv(client.get("/v1/overturning", params=ROUTES["/v1/overturning"] | {"format": "csv"}))
    stored = read_netcdf(client.get("/v1/overturning", params=ROUTES["/v1/overturning"] | {"format": "nc"}))
    points = sum(len(curve["slenderness"]) for curve in result["curves"])
    assert len(rows) == stored.sizes["point"] == points
    assert int(rows[-1]["curve"]) == stored.sizes["curve"] - 1


def test_history_equals_the_solver(client):
    result = client.get("/v1/history", params=BLOCK | {"samples": 50}).json()
    expected = time_history(BLOCK["pulse"], **GROUPS, samples=50)
    for name in ("tau", "rotation", "angular_velocity", "ground_acceleration", "impact_time"):
        assert result[name] == expected[name].values.tolist()
    assert result["outcome"] == "RECOVERS"
    assert result["peak_rotation"] == pytest.approx(max(map(abs, result["rotation"])), rel=0.05)


def test_history_as_csv_and_netcdf(client):
    rows = read_csv(client.get("/v1/history", params=BLOCK | {"format": "csv"}))
    stored = read_netcdf(client.get("/v1/history", params=BLOCK | {"format": "nc"}))
    assert [float(row["rotation"]) for row in rows] == stored["rotation"].values.tolist()


def test_history_with_the_reactions_of_the_ground(client):
    requested = BLOCK | {"alpha_deg": 20, "samples": 50, "contact": "true"}
    result = client.get("/v1/history", params=requested).json()
    expected = time_history(
        BLOCK["pulse"],
        **{key: BLOCK[key] for key in BLOCK if key != "pulse"},
        alpha=np.radians(20),
        samples=50,
        contact=True,
    )
    for name in ("horizontal_reaction", "normal_reaction", "friction_demand", "friction_demand_over_slope"):
        assert result["contact"][name] == expected[name].values.tolist()
    assert result["contact"]["largest_friction_demand"] == expected.largest_friction_demand
    assert (result["contact"]["lifts_off"], result["contact"]["warnings"]) == (False, "")
    rows = read_csv(client.get("/v1/history", params=requested | {"format": "csv"}))
    assert [float(row["friction_demand"]) for row in rows] == result["contact"]["friction_demand"]
    stored = read_netcdf(client.get("/v1/history", params=requested | {"format": "nc"}))
    np.testing.assert_array_equal(stored["normal_reaction"], expected["normal_reaction"])
    assert client.get("/v1/history", params=BLOCK).json()["contact"] is None
