"""Pulses given by samples in the body of a request: responses of the solver, echo, errors, limits."""

from __future__ import annotations

import json
import time

import numpy as np
import pytest
from rocking_api.models.pulses import MAX_BODY, MAX_SAMPLES
from rocking_api.routers import overturning

import rocking
from tests.api.conftest import assert_problem, client_of

SAMPLES = {"acceleration": [0.0, 2.0, -1.0, 0.0], "time": [0.0, 0.1, 0.4, 1.0], "name": "ramp"}
RAMP = rocking.SampledPulse(SAMPLES["acceleration"], SAMPLES["time"], name="ramp")
GROUPS = {"slenderness": 0.4, "frequency_ratio": 5.0, "restitution": 0.85}
ONE = {name: GROUPS[name] for name in ("slenderness", "restitution")}
BLOCK = {"width": 0.4, "height": 1.6, "peak_acceleration": 4.0, "period": 0.5}
BODIES = {
    "/v1/response": GROUPS,
    "/v1/spectrum": ONE | {"points": 5},
    "/v1/history": GROUPS | {"samples": 20},
    "/v1/map": {"restitution": 0.85, "columns": 4, "rows": 3},
    "/v1/overturning": {"restitution": 0.2},
    "/v1/thresholds": {"frequency_ratio": 5.0, "restitution": 0.85},
    "/v1/blocks/response": {"blocks": [BLOCK]},
}


def post(client, route, pulse=SAMPLES, **changes):
    return client.post(route, json=BODIES[route] | {"pulse": pulse} | changes)


def answer(client, route, **changes):
    response = post(client, route, **changes)
    assert response.status_code == 200, response.text
    assert "Cache-Control" not in response.headers
    return response.json()


@pytest.mark.parametrize("route", BODIES)
def test_the_answer_repeats_name_and_digest_but_not_the_samples(client, route):
    found = answer(client, route)
    assert found["query"]["pulse"] == "ramp"
    assert found["query"]["pulse_digest"] == RAMP.digest
    assert "acceleration" not in found["query"]
    assert set(np.atleast_1d(found["source"])) == {"solver"}


def test_answers_are_those_of_the_solver(client):
    peaks = rocking.peak_response(RAMP, **GROUPS)
    assert answer(client, "/v1/response")["peak_rotation"] == [float(peaks.peak_rotation)]
    spectrum = answer(client, "/v1/spectrum")
    along = rocking.peak_response(RAMP, **ONE, frequency_ratio=spectrum["frequency_ratio"])
    np.testing.assert_array_equal(np.array(spectrum["peak_rotation"], float), along.peak_rotation)
    motion = rocking.time_history(RAMP, **GROUPS, samples=20)
    assert answer(client, "/v1/history")["rotation"] == motion["rotation"].values.tolist()
    area = answer(client, "/v1/map")
    axes = {"slenderness": np.array(area["slenderness"])[:, None], "frequency_ratio": area["frequency_ratio"]}
    expected = rocking.peak_response(RAMP, **axes, restitution=0.85)
    assert area["outcome"] == expected.outcome.ravel().tolist()
    amplitudes = rocking.thresholds(RAMP, frequency_ratio=5.0, restitution=0.85).amplitude
    found = answer(client, "/v1/thresholds")["thresholds"]
    assert [one["amplitude"] for one in found] == amplitudes.tolist()
    one = rocking.Block(0.4, 1.6).response(RAMP, peak_acceleration=4.0, period=0.5)
    assert answer(client, "/v1/blocks/response")["top_displacement"] == [one.displacement]


def test_boundaries_are_those_of_the_solver_and_cached_by_digest(client, monkeypatch):
    found = answer(client, "/v1/overturning")
    curves = rocking.overturning_boundary(RAMP, restitution=0.2, nodes=overturning.NODES)
    traced = [value for curve in found["curves"] for value in curve["slenderness"]]
    assert traced == curves["slenderness"].values.tolist()
    monkeypatch.setattr(overturning, "overturning_boundary", None)
    assert answer(client, "/v1/overturning") == found
    doubled = SAMPLES | {"acceleration": [2.0 * value for value in SAMPLES["acceleration"]]}
    assert answer(client, "/v1/overturning", pulse=doubled) == found  # the same shape
    assert post(client, "/v1/overturning", pulse=SAMPLES | {"acceleration": [0, 1, -1, 0]}).status_code == 500


@pytest.mark.parametrize("form", ["json", "csv", "nc"])
def test_a_pulse_that_overturns_nothing_has_no_boundaries(client, form):
    response = post(client, "/v1/overturning", pulse=SAMPLES | {"period": 1e6}, format=form)
    assert response.status_code == 200
    if form == "json":
        assert response.json()["curves"] == []


@pytest.mark.parametrize("route", BODIES)
def test_a_body_may_name_the_pulse(client, route):
    found = answer(client, route, pulse="-sine")
    assert found["query"]["pulse"] == "-sine"
    assert found["query"].get("pulse_digest") is None


@pytest.mark.parametrize("route", BODIES)
@pytest.mark.parametrize(
    ("pulse", "name"),
    [
        ({"acceleration": [0, 1, "a"]}, "pulse.acceleration[2]"),
        ({"acceleration": [0, 1, None]}, "pulse.acceleration[2]"),
        ({"acceleration": [0, 1e400, 0]}, "pulse.acceleration[1]"),
        ({"acceleration": [0, [1], 0]}, "pulse.acceleration[1]"),
        ({"acceleration": [0, 0]}, "pulse.acceleration"),
        ({"acceleration": [1]}, "pulse.acceleration"),
        ({"acceleration": [1.0] * (MAX_SAMPLES + 1)}, "pulse.acceleration"),
        ({"acceleration": "0,1,0"}, "pulse.acceleration"),
        ({"acceleration": {}}, "pulse.acceleration"),
        ({"acceleration": [0, 1, 0], "time": [0, 2, 1]}, "pulse.time[2]"),
        ({"acceleration": [0, 1, 0], "time": [0, 2]}, "pulse.time"),
        ({"acceleration": [0, 1, 0], "time": [0, 1e-300, 1e300]}, "pulse.time"),
        ({"acceleration": [0, 1, 0], "period": -1}, "pulse.period"),
        ({"acceleration": [0, 1, 0], "period": 1e300}, "pulse.period"),
        ({"acceleration": [0, 1, 0], "name": ""}, "pulse.name"),
        ({"acceleration": [0, 1, 0], "dt": 1}, "pulse.dt"),
        ({}, "pulse.acceleration"),
        ([], "pulse"),
        (5, "pulse"),
        ("triangle", "pulse"),
    ],
    ids=str,
)
def test_errors_name_the_element(client, route, pulse, name):
    body = json.dumps(BODIES[route] | {"pulse": pulse})
    problem = assert_problem(client.post(route, content=body), 422, name)
    assert len(json.dumps(problem)) < 2000
    assert client.get("/health").status_code == 200


def test_parameters_are_in_the_body(client):
    assert_problem(
        client.post("/v1/spectrum?points=3", json=BODIES["/v1/spectrum"] | {"pulse": SAMPLES}), 422, "points"
    )
    assert_problem(post(client, "/v1/spectrum", colour=1), 422, "colour")
    assert_problem(client.post("/v1/spectrum", json={"pulse": SAMPLES, "restitution": 0.9}), 422, "slenderness")
    assert_problem(client.post("/v1/history", json=BODIES["/v1/history"]), 422, "pulse")
    assert_problem(client.post("/v1/history", content="a,b", headers={"content-type": "text/csv"}), 415, "Content-Type")
    assert_problem(post(client, "/v1/response", method="cube"), 422, "pulse")
    twice = client.post("/v1/blocks/response?pulse=sine", json=BODIES["/v1/blocks/response"] | {"pulse": SAMPLES})
    assert_problem(twice, 422, "pulse")
    assert_problem(client.post("/v1/blocks/response", json=BODIES["/v1/blocks/response"]), 422, "pulse")


def test_hostile_bodies_are_refused_soon(client):
    numbers = json.dumps(BODIES["/v1/map"] | {"pulse": {"acceleration": [1.2345678901234567] * MAX_SAMPLES}})
    began = time.process_time()
    for body in (
        '{"pulse": ' + '{"acceleration": ' * 20_000,
        '{"pulse": {"acceleration": ' + "[" * 400_000,
        '{"pulse": {"acceleration": [' + "1" * 400_000 + "]}}",
        '{"pulse": {"acceleration": [' + '"a",' * 120_000 + "1]}}",
        '{"pulse": {"acceleration": [' + "1e999," * 70_000 + "1]}}",
        '{"pulse": {' + ",".join(f'"k{k}": 1' for k in range(40_000)) + "}}",
        '{"a": "' + "\\u0000" * 60_000 + '"}',
    ):
        assert client.post("/v1/map", content=body).status_code in (400, 422)
        assert client.get("/health").status_code == 200
    assert client.post("/v1/map", content=numbers).status_code == 200
    assert time.process_time() - began < 10.0
    assert_problem(client.post("/v1/map", content="0" * (MAX_BODY + 1)), 413, "body")


def test_long_work_under_samples_ends_at_the_time_limit(results):
    rng = np.random.default_rng(1)
    long = {"acceleration": rng.uniform(-1, 1, MAX_SAMPLES).tolist(), "period": 10.0}
    with client_of(results, max_seconds=0.3) as client:
        while client.get("/v1/thresholds?pulse=sine&frequency_ratio=3&restitution=0.8").status_code != 200:
            time.sleep(0.1)
        assert post(client, "/v1/map", pulse=long, columns=300, rows=300, alpha_deg=20.0).status_code == 504
        problem = post(client, "/v1/overturning", pulse=long, alpha_deg=20.0)
        assert problem.status_code == 504
        assert "POST /v1/map" in problem.json()["detail"]
        assert client.get("/health").status_code == 200
