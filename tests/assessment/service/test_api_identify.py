"""POST /v1/identify: the block of a direct call, and bodies that are no traces."""

import csv
import io
import math
from pathlib import Path

import numpy as np
import pytest
import rocking_assessment
from rocking_assessment.service.identify import EDGE_COLUMNS

from benchmarks.accuracy.free_rocking import free_rocking
from tests.api.conftest import CSV, assert_problem, post

URL = "/v1/identify"
ALPHA, P, ETA = 0.25, 2.5, 0.9


@pytest.fixture(scope="module")
def trace():
    rotation = free_rocking(np.array([0.2]), ALPHA, P, ETA, 6.0, 60)[0]
    noisy = rotation + 1e-3 * np.random.default_rng(3).normal(size=rotation.size)
    return {"time": (np.arange(noisy.size) / 60).tolist(), "rotation": noisy.tolist()}


def as_csv(trace, factor=1.0, header="time [s],rotation [rad]"):
    rows = zip(trace["time"], trace["rotation"], strict=True)
    return f"{header}\n" + "".join(f"{time!r},{factor * rotation!r}\n" for time, rotation in rows)


def test_the_block_is_that_of_a_direct_call(client, trace):
    expected = rocking_assessment.identify_free_rocking(trace["time"], trace["rotation"], confidence=0.9)
    answer = client.post(URL, json=trace | {"confidence": 0.9}).json()
    for name in EDGE_COLUMNS:
        assert answer[name] == expected[name].values.tolist()
    assert answer["restitution"] == pytest.approx([ETA], abs=0.01)
    assert answer["drift"] == expected["drift"].item()
    assert answer["warnings"] == []
    assert answer["impact_time"] == expected["impact_time"].values.tolist()
    assert answer["rotation"] == trace["rotation"]
    nan = np.isnan(expected["fitted"].values)
    assert [value is None for value in answer["fitted"]] == nan.tolist()
    degrees = post(client, URL, as_csv(trace, 180 / math.pi, "time [s],rotation"), CSV, unit="deg", confidence=0.9)
    (row,) = csv.DictReader(io.StringIO(degrees.text))
    assert float(row["alpha"]) == pytest.approx(answer["alpha"][0], rel=1e-6)  # of the fit


def test_rotations_of_csv_are_in_the_unit_of_the_header(client, trace):
    body = as_csv(trace, 180 / math.pi, "time [s],rotation [deg]")
    expected = client.post(URL, json=trace).json()["alpha"]
    other = as_csv(trace, 180 / math.pi, "t,roll")
    layout = {"rotation": "roll", "unit": "deg", "time": "t", "time_unit": "s"}
    for content, query in ((body, {}), (body, {"unit": "deg"}), (other, layout)):
        (row,) = csv.DictReader(io.StringIO(post(client, URL, content, CSV, **query).text))
        assert float(row["alpha"]) == pytest.approx(expected[0], rel=1e-6)
    problem = assert_problem(post(client, URL, other, CSV), 422, "record")
    assert "such as ?rotation=...&time=...&unit=..." in problem["detail"]


def test_frames_are_no_times(client):
    body = (Path(__file__).parents[2] / "data/field/frame_counter.csv").read_bytes()
    headers = {"Content-Type": "text/csv"}
    problem = assert_problem(client.post("/v1/identify", content=body, headers=headers), 422)
    assert "found frame, rotation [deg]" in problem["detail"]
    assert "`time_step`" in problem["detail"]
    response = client.post(
        "/v1/identify", params={"time_step": 1.0 / 60.0, "format": "json"}, content=body, headers=headers
    ).json()
    assert response["frequency_parameter"] == [pytest.approx(2.5, rel=0.01)]
    json = client.post(URL, json={"time": [*range(20)], "rotation": [0.1] * 20, "time_step": 0.01})
    assert assert_problem(json, 422)["parameter"] == "time_step"
