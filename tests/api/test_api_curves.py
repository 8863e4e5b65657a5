"""Spectrum, history, thresholds, map and boundaries, under a pulse by its name and by samples, in every format.

And the catalogue of pulses.
"""

import csv
import io

import numpy as np
import pytest
import xarray as xr
from rocking_api.routers import overturning

import rocking
from rocking import precompile
from rocking._boundary.curves import join_curves
from rocking._boundary.tracing import overturning_boundary
from rocking._datasets.cube import read_dataset, write_dataset
from rocking._excitation import pulses
from rocking._excitation.pulses import PULSE_NAMES
from rocking._model.response import Outcome
from tests.api.conftest import NAPA, assert_problem, client_of
from tests.cf_compliance import complaints
from tests.excitation.test_smooth_pulse import CHIRP

SAMPLES = {"acceleration": [0.0, 2.0, -1.0, 0.0], "time": [0.0, 0.1, 0.4, 1.0], "name": "ramp"}
RAMP = rocking.SampledPulse(SAMPLES["acceleration"], SAMPLES["time"], name="ramp")
GROUPS = {"slenderness": 0.4, "frequency_ratio": 5.0, "restitution": 0.85}
ONE = {"slenderness": 0.6, "restitution": 0.85}
SHAPE = {"restitution": 0.85, "alpha_deg": 14.0}
BLOCK = {"width": 0.4, "height": 1.6, "peak_acceleration": 4.0, "period": 0.5}
BODIES = {
    "/v1/response": GROUPS,
    "/v1/spectrum": ONE | {"points": 50},
    "/v1/history": GROUPS | {"samples": 50, "alpha_deg": 14.0, "contact": True},
    "/v1/map": SHAPE | {"columns": 21, "rows": 12, "slenderness_min": 0.1, "slenderness_max": 1.1},
    "/v1/overturning": {"restitution": 0.2},
    "/v1/thresholds": SHAPE | {"frequency_ratio": 5.0},
    "/v1/blocks/response": {"blocks": [BLOCK]},
}
SLENDER = np.radians(14.0)


def post(client, route, pulse=SAMPLES, **changes):
    return client.post(route, json=BODIES[route] | {"pulse": pulse} | changes)


def answer(client, route, pulse=SAMPLES, **changes):
    response = post(client, route, pulse, **changes)
    assert response.status_code == 200, response.text
    assert "Cache-Control" not in response.headers
    return response.json()


def numbers(values):
    return np.array(values, dtype=float)


@pytest.mark.parametrize("pulse", ["sine", "ramp"])
def test_answers_are_those_of_the_solver(client, pulse):
    given, motion = ("sine", "sine") if pulse == "sine" else (SAMPLES, RAMP)
    peaks = rocking.peak_response(motion, **GROUPS)
    assert answer(client, "/v1/response", given, method="auto" if pulse == "ramp" else "solver")["peak_rotation"] == [
        float(peaks.peak_rotation)
    ]

    spectrum = answer(client, "/v1/spectrum", given)
    along = rocking.peak_response(motion, **ONE, frequency_ratio=np.geomspace(0.5, 12.0, 50))
    assert spectrum["frequency_ratio"] == np.geomspace(0.5, 12.0, 50).tolist()
    assert spectrum["overturned"] == along.overturned.tolist()
    assert any(spectrum["overturned"])
    assert ("cube" in spectrum["source"]) is (pulse == "sine")
    for peak, bound, exact in zip(spectrum["peak_rotation"], spectrum["error_bound"], along.peak_rotation, strict=True):
        assert peak is None or abs(peak - exact) <= bound

    history = answer(client, "/v1/history", given)
    expected = rocking.time_history(motion, **GROUPS, samples=50, alpha=SLENDER, contact=True)
    for name in ("tau", "rotation", "angular_velocity", "ground_acceleration", "impact_time"):
        assert history[name] == expected[name].values.tolist()
    for name in ("horizontal_reaction", "normal_reaction", "friction_demand", "friction_demand_over_slope"):
        assert history["contact"][name] == expected[name].values.tolist()
    assert history["contact"]["largest_friction_demand"] == expected.largest_friction_demand
    assert (history["contact"]["lifts_off"], history["contact"]["warnings"]) == (False, "")
    assert history["outcome"] == expected.outcome
    assert answer(client, "/v1/history", given, contact=False)["contact"] is None

    area = answer(client, "/v1/map", given)
    axes = {"slenderness": np.linspace(0.1, 1.1, 12)[:, None], "frequency_ratio": np.geomspace(0.5, 12.0, 21)}
    grid = rocking.peak_response(motion, **axes, restitution=0.85, alpha=SLENDER)
    assert {Outcome.NO_UPLIFT, Outcome.RECOVERS, Outcome.OVERTURNED_DIRECTLY} <= set(grid.outcome.ravel().tolist())
    assert [Outcome[area["outcomes"][code]] for code in area["outcome"]] == grid.outcome.ravel().tolist()
    np.testing.assert_allclose(numbers(area["peak_rotation"]), grid.peak_rotation.ravel(), rtol=0, atol=0.5001e-4)
    assert (area["slenderness"][0], area["slenderness"][-1], len(area["frequency_ratio"])) == (0.1, 1.1, 21)

    for alpha in (None, SLENDER):
        changes = rocking.thresholds(motion, frequency_ratio=5.0, restitution=0.85, alpha=alpha)
        found = answer(client, "/v1/thresholds", given, alpha_deg=alpha and 14.0)["thresholds"]
        assert [one["amplitude"] for one in found] == changes.amplitude.tolist()
        assert [one["impacts"] for one in found] == changes.impacts.tolist()
        assert all(one["slenderness"] == 1 / one["amplitude"] for one in found)
    one = rocking.Block(0.4, 1.6).response(motion, peak_acceleration=4.0, period=0.5)
    assert answer(client, "/v1/blocks/response", given)["displacement"] == [one.displacement]


def test_golden_thresholds_and_those_above_the_highest(client):
    query = {"pulse": "sine", "frequency_ratio": 5.0, "restitution": 0.85}
    found = client.get("/v1/thresholds", params=query).json()
    amplitudes = [one["amplitude"] for one in found["thresholds"]]
    assert amplitudes == pytest.approx([3.980175, 5.356347, 7.168129], abs=1e-6)
    assert [one["overturns_above"] for one in found["thresholds"]] == [True, False, True]
    assert found["thresholds"][-1]["outcome"] == "OVERTURNED_DIRECTLY"
    assert found["largest_surviving_amplitude"] == amplitudes[0]
    found = client.get("/v1/thresholds", params=query | {"highest": 2.0}).json()
    assert (found["thresholds"], found["largest_surviving_amplitude"]) == ([], None)


@pytest.mark.parametrize("route", BODIES)
def test_the_answer_repeats_the_name_of_a_pulse_and_of_samples_the_digest(client, route):
    found = answer(client, route)
    assert (found["query"]["pulse"], found["query"]["pulse_digest"]) == ("ramp", RAMP.digest)
    assert "acceleration" not in found["query"]
    assert set(np.atleast_1d(found["source"])) == {"solver"}
    found = answer(client, route, pulse="-sine")
    assert (found["query"]["pulse"], found["query"].get("pulse_digest")) == ("-sine", None)


def test_parameters_beside_samples_are_in_the_body(client):
    one = {"pulse": SAMPLES, "restitution": 0.9}
    for response, name in (
        (client.post("/v1/spectrum?points=3", json=BODIES["/v1/spectrum"] | one), "points"),
        (post(client, "/v1/spectrum", colour=1), "colour"),
        (client.post("/v1/spectrum", json=one), "slenderness"),
        (client.post("/v1/history", json=BODIES["/v1/history"]), "pulse"),
        (post(client, "/v1/response", method="cube"), "pulse"),
        (client.post("/v1/blocks/response?pulse=sine", json=BODIES["/v1/blocks/response"] | one), "pulse"),
    ):
        assert_problem(response, 422, name)


RECORD = {"width": 0.5, "height": 2.0}
FORMATS = {
    # route, parameters, body, variables with one value for each row
    "spectrum": ("/v1/spectrum", ONE | {"pulse": "sine", "points": 50}, None),
    "history": ("/v1/history", GROUPS | {"pulse": "sine", "samples": 50}, None),
    "map": ("/v1/map", {"pulse": "cosine", "restitution": 0.9, "columns": 21, "rows": 12}, None),
    "subset": ("/v1/datasets/spectra/sine/eta-0.85/subset", {"slenderness_max": 0.1}, None),
    "record": ("/v1/records/history", RECORD | {"samples": 300}, NAPA),
    "scales": ("/v1/records/scales", RECORD | {"points": 5, "scale_max": 2.0}, NAPA),
}


@pytest.mark.parametrize("name", FORMATS)
def test_csv_and_netcdf_hold_every_digit(client, tmp_path, name):
    route, query, file = FORMATS[name]
    method, body = ("GET", {}) if file is None else ("POST", {"content": file.read_bytes()})
    text = client.request(method, route, params=query | {"format": "csv"}, **body)
    assert text.headers["content-type"].startswith("text/csv")
    rows = list(csv.DictReader(io.StringIO(text.text)))
    binary = client.request(method, route, params=query | {"format": "nc"}, **body)
    assert binary.headers["content-type"] == "application/x-netcdf"
    stored = xr.open_dataset(io.BytesIO(binary.content), engine="scipy").load()
    (tmp_path / "answer.nc").write_bytes(binary.content)
    assert complaints(tmp_path / "answer.nc") == []
    compared = [column for column in ("peak_rotation", "rotation", "impacts") if column in rows[0]]
    assert compared
    for column in compared:
        values = stored[column].values.ravel().astype(float)
        values[values < -1e9] = np.nan  # unknown numbers of impacts
        np.testing.assert_array_equal([float(row[column] or "nan") for row in rows], values)
    for one in {"restitution", "slenderness"} & {*query}:
        assert stored.attrs[one] == query[one]
    if name in ("spectrum", "history", "record", "scales"):
        given = client.request(method, route, params=query, **body).json()
        np.testing.assert_array_equal(numbers(given[compared[0]]), stored[compared[0]])


CURVES = {"pulse": "sine", "restitution": 0.85}


def test_traced_curves_are_cached(client, monkeypatch):
    traced = []

    def trace(*args, **kwargs):
        traced.append(args)
        return overturning_boundary(*args, **kwargs)

    monkeypatch.setattr(overturning, "overturning_boundary", trace)
    query = {"pulse": "half_sine", "restitution": 0.8765}
    responses = [client.get("/v1/overturning", params=query | more) for more in ({}, {"alpha_deg": 0}, {})]
    assert len(traced) == 1
    assert responses[0].json() == responses[2].json()
    assert responses[0].json()["curves"] == responses[1].json()["curves"]
    found = answer(client, "/v1/overturning")
    curves = rocking.overturning_boundary(RAMP, restitution=0.2, nodes=overturning.NODES)
    traced = [value for curve in found["curves"] for value in curve["slenderness"]]
    assert traced == curves["slenderness"].values.tolist()
    monkeypatch.setattr(overturning, "overturning_boundary", None)
    doubled = SAMPLES | {"acceleration": [2.0 * value for value in SAMPLES["acceleration"]]}
    for same in (SAMPLES, doubled):  # of one shape
        assert answer(client, "/v1/overturning", pulse=same) == found
    assert post(client, "/v1/overturning", pulse=SAMPLES | {"acceleration": [0, 1, -1, 0]}).status_code == 500


def test_boundaries_are_those_of_the_workflow_in_every_format(client, results, tmp_path):
    result = client.get("/v1/overturning", params=CURVES).json()
    stored = read_dataset(results / "overturning" / "sine" / "eta-0.85.nc")
    assert result["source"] == "dataset"
    assert result["data_version"] == client.get("/v1/datasets/overturning/sine/eta-0.85").json()["sha256"]
    assert [len(curve["slenderness"]) for curve in result["curves"]] == stored["row_size"].values.tolist()
    points = [value for curve in result["curves"] for value in curve["slenderness"]]
    np.testing.assert_array_equal(points, stored["slenderness"])
    assert {curve["outcome"] for curve in result["curves"]} == {"OVERTURNED_DIRECTLY", "OVERTURNED_AFTER_IMPACT"}
    rows = list(csv.DictReader(io.StringIO(client.get("/v1/overturning", params=CURVES | {"format": "csv"}).text)))
    path = tmp_path / "answer.nc"
    path.write_bytes(client.get("/v1/overturning", params=CURVES | {"format": "nc"}).content)
    assert complaints(path) == []
    file = xr.open_dataset(path, engine="scipy").load()
    assert len(rows) == file.sizes["point"] == len(points)
    assert int(rows[-1]["curve"]) == file.sizes["curve"] - 1


def test_boundaries_are_those_of_the_requested_angle_and_traced_where_they_are_damaged(own_results):
    path = own_results / "overturning" / "sine" / "eta-0.85.nc"
    slender = read_dataset(path)
    alpha = np.radians(20)
    rigid = overturning_boundary("sine", restitution=0.85, alpha=alpha, nodes=41).drop_attrs(deep=False)
    rigid["alpha"] = "curve", np.full(rigid.sizes["curve"], alpha)
    rigid = rigid.assign_coords({name: slender[name] for name in ("pulse", "restitution")})
    write_dataset(join_curves([slender, rigid]), path)
    with client_of(own_results) as client:
        for angle, stored in ((None, slender), (0, slender), (20, rigid)):
            requested = CURVES | ({} if angle is None else {"alpha_deg": angle})
            result = client.get("/v1/overturning", params=requested).json()
            assert result["source"] == "dataset"
            found = [s for curve in result["curves"] for s in curve["slenderness"]]
            assert found == stored["slenderness"].values.tolist()
        requested["alpha_deg"] = 10
        assert client.get("/v1/overturning", params=requested).json()["source"] == "solver"
        path.write_bytes(b"not a netCDF file")
        assert client.get("/v1/overturning", params=CURVES).json()["source"] == "solver"
        path.unlink()
        path.symlink_to(path)  # which cannot be read
        assert client.get("/v1/overturning", params=CURVES).json()["source"] == "solver"


@pytest.mark.parametrize("form", ["json", "csv", "nc"])
def test_a_pulse_that_overturns_nothing_has_no_boundaries(client, form):
    response = post(client, "/v1/overturning", pulse=SAMPLES | {"period": 1e6}, format=form)
    assert response.status_code == 200
    assert form != "json" or response.json()["curves"] == []


def test_pulses_are_those_of_the_package(client):
    found = client.get("/v1/pulses", params={"samples": 33}).json()["pulses"]
    assert [one["name"] for one in found][: len(PULSE_NAMES)] == list(PULSE_NAMES)
    for one in found[: len(PULSE_NAMES)]:
        pulse = rocking.pulse(one["name"])
        phase = np.linspace(pulse.start, pulse.end, 33)
        np.testing.assert_allclose(one["time"], (phase - pulse.start) / (2 * np.pi), atol=5.1e-5)
        np.testing.assert_allclose(one["acceleration"], pulse.shape(phase), atol=5.1e-5)
        assert one["duration"] == pytest.approx((pulse.end - pulse.start) / (2 * np.pi))
        assert one["definition"].endswith((".", ")"))
    last = next(one for one in found if one["name"] == "mavroeidis_papageorgiou")
    assert {one["name"]: one["default"] for one in last["parameters"]} == {"cycles": 2.0, "phase": 0.0}
    assert {one["name"]: one["range"] for one in last["parameters"]}["cycles"] == "(1, 20]"


def test_a_pulse_takes_its_parameters_in_its_text(client):
    text = "mavroeidis_papageorgiou(cycles=3, phase=90deg)"
    groups = {"slenderness": 0.5, "frequency_ratio": 4.0, "restitution": 0.9}
    expected = rocking.peak_response(rocking.pulse("mavroeidis_papageorgiou", cycles=3, phase=np.pi / 2), **groups)
    answer = client.get("/v1/response", params={"pulse": text, **groups}).json()
    assert answer["peak_rotation"] == pytest.approx(float(expected.peak_rotation), rel=1e-12)
    assert_problem(client.get("/v1/response", params={"pulse": "cosine(cycles=2)", **groups}), 422, "cycles")


def test_a_registered_pulse_is_listed_and_solved(tmp_path, monkeypatch):
    monkeypatch.setattr(pulses, "_REGISTERED", {})
    pulses.register(CHIRP)
    precompile.main()  # the service refuses requests while it compiles
    groups = {"slenderness": 0.45, "frequency_ratio": 3.0, "restitution": 0.85}
    with client_of(tmp_path) as client:
        listed = {pulse["name"]: pulse for pulse in client.get("/v1/pulses").json()["pulses"]}
        assert listed["chirp"]["duration"] == pytest.approx(4.0)
        response = client.get("/v1/response", params=groups | {"pulse": "chirp", "method": "solver"})
        assert response.status_code == 200, response.text
        solved = float(rocking.peak_response(CHIRP, **groups).peak_rotation)
        assert response.json()["peak_rotation"] == pytest.approx(solved, abs=1e-4)
