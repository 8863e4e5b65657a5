"""POST /v1/records/response and /v1/records/history: a record in the body, a block in the query."""

import numpy as np
import pytest

import rocking
from rocking._excitation.records.readers.read_record import parse_record
from tests.api.conftest import NAPA, assert_problem
from tests.excitation.record_files import at2, rows
from tests.excitation.test_volume_files import csmip

RECORD = NAPA.read_bytes()
BLOCK = {"width": 0.5, "height": 2.0}


def post(client, body=RECORD, route="response", **params):
    return client.post(f"/v1/records/{route}", params=BLOCK | params, content=body)


@pytest.fixture(scope="module")
def motion():
    return rocking.read_record(NAPA)


def test_the_response_is_that_of_the_library(client, motion):
    block = rocking.Block(0.5, 2.0)
    expected = block.response(motion, scale=1.1, restitution=0.8)
    found = post(client, scale=1.1, restitution=0.8, fit=True, name="napa_HNE.csv").json()
    summary = expected.summary()
    for name in {*summary} & {*found} - {"notes", "warnings"}:
        assert found[name] == pytest.approx(summary[name]), name
    assert (found["outcome"], found["meaning"]) == ("RECOVERS", "rocks and comes to rest")
    assert found["peak_rotation"] == float(expected.peak_rotation)
    assert found["peak_rotation_resampled"] == float(expected.resampled.peak_rotation)
    record = {"digest": motion.digest, "peak_acceleration": motion.peak_acceleration, "name": "napa_HNE"}
    assert found["record"].items() >= record.items()
    assert found["friction_demand"] > found["friction_at_uplift"] == 0.25
    scales = [threshold["scale"] for threshold in found["thresholds"]]
    assert scales == expected.thresholds.value.tolist() == sorted(scales)
    assert found["thresholds"][0]["overturns_above"]
    assert found["thresholds"][0]["peak_acceleration"] == pytest.approx(scales[0] * motion.peak_acceleration)
    assert found["pulse"]["pulse"] == "mavroeidis_papageorgiou"
    assert found["pulse"]["scale_ratio"] == pytest.approx(1.6, abs=0.2)
    for factor, overturned in ((1 + 1e-5, True), (1 - 1e-5, False)):
        beside = post(client, scale=scales[0] * factor, restitution=0.8, thresholds=False).json()
        assert beside["overturned"] is overturned
        assert beside["pulse"] is None


def test_the_mirrored_record_and_forces_of_a_known_mass(client, motion):
    body = rocking.RigidBody.from_size(0.5, 2.0, offset=0.03)
    given = {"offset": 0.03, "samples": 40, "mass": 200.0, "mirrored": True}
    found = post(client, route="history", **given).json()
    expected = body.history(motion.mirrored(), scale=1.0, samples=40, contact=True)
    np.testing.assert_allclose(found["rotation"], expected["rotation"])
    np.testing.assert_allclose(found["contact"]["normal_force"], 200.0 * 9.80665 * expected["normal_reaction"].values)
    assert found["units"]["contact.normal_force"] == "N"
    assert found["record"]["name"].endswith(", mirrored")
    plain = post(client, route="history", samples=40, contact=True).json()
    assert plain["contact"].get("normal_force") is None


def test_remarks_of_the_reader_are_in_the_response(client):
    body = at2("NPTS= 101, DT= .01 SEC", body=rows(count=100)).encode()
    remark = "the file holds 100 samples, its header states 101"
    found = post(client, body, scale=3.0).json()
    assert remark in found["warnings"]
    assert found["record"]["remarks"] == [remark]
    assert post(client, body, route="history", scale=3.0).json()["record"]["remarks"] == [remark]
    problem = assert_problem(post(client, at2("NPTS= 10, DT= .01", body="0.1 0.2\n").encode()), 422, "record")
    assert "10 stated, 2 values" in problem["detail"]


def test_history_and_scales_are_those_of_the_library(client, motion):
    block = rocking.Block(0.5, 2.0)
    uplift = block.uplift_acceleration / motion.peak_acceleration
    groups = {"frequency_parameter": block.frequency_parameter, "restitution": block.inelastic_restitution}
    groups["alpha"] = block.alpha
    expected = rocking.time_history(motion, **groups, slenderness=uplift, samples=300, contact=True)
    found = post(client, route="history", samples=300, contact=True).json()
    for name in ("rotation", "time", "impact_time"):
        np.testing.assert_array_equal(found[name], expected[name])
    assert len(found["contact"]["normal_reaction"]) == len(found["time"])
    whole = post(client, route="history").json()
    assert len(whole["time"]) > motion.samples
    assert whole["vertical_acceleration"] is None

    found = post(client, route="scales", points=30, scale_max=2.0).json()
    scale = np.array(found["scale"])
    np.testing.assert_allclose(scale, np.geomspace(uplift, 2.0, 30), rtol=1e-14)
    expected = rocking.peak_response(motion, **groups, slenderness=uplift / scale)
    assert found["overturned"] == expected.overturned.tolist()
    np.testing.assert_allclose(np.array(found["peak_rotation"], float), expected.peak_rotation)
    assert [one["scale"] for one in found["thresholds"]] == block.thresholds(motion, highest=2.0).value.tolist()
    table = post(client, route="scales", points=5, scale_max=2.0, format="csv").text
    assert table.startswith("scale,peak_acceleration,peak_rotation,overturned")


def test_the_pulse_is_drawn_beside_the_record(client, motion):
    part = rocking.Record(motion.acceleration[800:2400], motion.time_step, "m/s2")
    plain = "\n".join(map(repr, part.acceleration.tolist())).encode()
    stated = {"acceleration": 1, "unit": "m/s2", "time_step": 0.005}
    found = post(client, plain, route="pulse", **stated, scale=2.0, samples=400).json()
    fit = rocking.suites.fit_pulse(part, blocks=rocking.Block(0.5, 2.0))
    assert found["pulse"]["period"] == pytest.approx(fit.period, rel=1e-6)
    assert len(found["time"]) == 400
    np.testing.assert_allclose(found["record_velocity"], 2.0 * part.velocity[::4])
    np.testing.assert_allclose(found["pulse_acceleration"], 2.0 * fit.acceleration(part.times[::4]), atol=1e-5)
    rates = np.gradient(found["pulse_velocity"], found["time"])
    assert np.abs(rates - found["pulse_acceleration"]).max() < 0.02 * np.abs(found["pulse_acceleration"]).max()
    assert "unconservative" in found["caution"]


def both_columns(share):
    """A motion of 2 s with a vertical component."""
    k = np.arange(100)
    table = np.stack([0.02 * k, 4.0 * np.sin(0.2 * k), share * np.cos(0.5 * k)], axis=1).tolist()
    return ("time [s],h [m/s2],up [m/s2]\n" + "".join(f"{t!r},{a!r},{w!r}\n" for t, a, w in table)).encode()


COLUMNS = {"acceleration": "h", "vertical": "up"}


@pytest.mark.parametrize("offset", [0.0, -0.03])
def test_the_vertical_component_is_a_column_of_the_body(client, offset):
    body = both_columns(2.0)
    motion = parse_record(body, "record", **COLUMNS)
    body_ = rocking.RigidBody.from_size(0.5, 2.0, offset=offset) if offset else rocking.Block(0.5, 2.0)
    expected = body_.response(motion, scale=1.1)
    found = post(client, body, **COLUMNS, scale=1.1, offset=offset).json()
    summary = expected.summary()
    for name in {*summary} & {*found} - {"notes"}:
        assert found[name] == (summary[name] if isinstance(summary[name], str) else pytest.approx(summary[name])), name
    assert [one["scale"] for one in found["thresholds"]] == expected.thresholds.value.tolist()
    assert found["record"]["peak_vertical_acceleration"] == pytest.approx(motion.peak_vertical_acceleration)
    assert found["record"]["digest"] == motion.digest
    faster = post(client, body, **COLUMNS, scale=1.1, offset=offset, thresholds=False).json()
    assert faster["thresholds"] is faster["margin"] is None
    if offset:
        assert found["edge"] == {1: "right", -1: "left"}[int(expected.edge)]
        assert_problem(post(client, body, **COLUMNS, offset=offset, fit=True), 422, "fit")
        assert_problem(post(client, body, **COLUMNS, offset=0.25), 422, "offset")
        return
    history = post(client, body, route="history", **COLUMNS).json()
    assert np.abs(history["vertical_acceleration"]).max() == pytest.approx(motion.peak_vertical_acceleration / 9.80665)
    header = post(client, body, route="history", **COLUMNS, format="csv").text.partition("\n")[0]
    assert "vertical_acceleration" in header
    few, many = (
        post(client, body, route="scales", points=points, scale_max=2.0, **COLUMNS).json()["thresholds"]
        for points in (5, 20)
    )
    assert [one["scale"] for one in few] == [one["scale"] for one in many]


def test_errors_of_the_vertical_component_name_the_parameter(client):
    body = both_columns(-4.0)
    assert_problem(post(client, body, acceleration="h", vertical="z"), 422, "vertical")
    assert_problem(post(client, vertical="up"), 422, "vertical")
    assert_problem(post(client, body, **COLUMNS, scale=5.0), 422, "scale")
    assert_problem(post(client, body, route="history", **COLUMNS, scale=5.0), 422, "scale")
    assert_problem(post(client, body, route="scales", **COLUMNS, scale_max=5.0), 422, "scale_max")
    by_default = post(client, body, route="scales", **COLUMNS).json()
    assert by_default["scale"][-1] == pytest.approx(9.80665 / 4.0)


def preview(client, body, **params):
    response = client.post("/v1/records/preview", params=params, content=body)
    assert response.status_code == 200, response.text
    return response.json()


def test_a_preview_shows_what_a_file_holds_and_what_would_be_read(client, motion):
    found = preview(client, RECORD, samples=500)
    assert found["columns"] == ["time [s]", "acceleration [g]"]
    assert found["in_file"] == {"acceleration": 2, "unit": "g", "time": 1, "time_unit": "s"} == found["chosen"]
    assert (found["file_format"], found["encoding"], found["missing"], found["problem"]) == (
        "columns",
        "UTF-8",
        [],
        None,
    )
    assert found["record"]["digest"] == motion.digest
    assert len(found["time"]) == len(found["acceleration"]) <= 502
    assert np.abs(found["acceleration"]).max() == motion.peak_acceleration  # the drawing keeps the peaks
    assert np.diff(found["time"]).min() >= 0.0


def test_a_preview_says_what_is_missing_or_asked(client):
    rows = "".join(f"{10 * k};{k % 7 - 3},5\n" for k in range(40))
    body = f"Messung\nZeit;Längs [m/s2]\n{rows}".encode()
    found = preview(client, body)
    assert found["record"] is None
    assert found["missing"] == ["acceleration", "time", "unit"]
    stated = {"skip": 1, "decimal": ","}
    found = preview(client, body, **stated)
    assert found["columns"] == ["Zeit", "Längs [m/s2]"]
    assert found["names_line"] == 2
    assert found["lines"][0] == {"number": 1, "text": "Messung", "cells": []}
    assert found["lines"][2]["cells"] == ["0", "-3,5"]
    stated |= {"acceleration": "Längs", "time": "1"}
    found = preview(client, body, **stated)
    assert found["missing"] == ["time_unit"]
    assert found["chosen"] == {"acceleration": 2, "unit": "m/s2", "time": 1, "time_unit": None}
    stated["time_unit"] = "ms"
    assert preview(client, body, **stated)["record"]["time_step"] == 0.01
    found = preview(client, body, **stated | {"unit": "g", "time_unit": "s"})
    assert "allow_unusual" in found["problem"]["expected"]
    assert found["record"]["peak_acceleration"] == pytest.approx(3.5 * 9.80665)  # shown beside the question
    found = preview(client, body, **stated | {"acceleration": "Quer"})
    assert "one column Quer" in found["problem"]["expected"]
    latin = preview(client, body.decode().encode("cp1252"), **stated | {"acceleration": "2"})
    assert (latin["encoding"], latin["record"]["samples"]) == ("Latin-1", 40)
    assert_problem(client.post("/v1/records/preview", content=b"\0\0"), 422, "record")


def test_a_preview_names_format_and_channels(client):
    body = at2("NPTS= 100, DT= .01 SEC", body=rows(count=100)).encode()
    found = preview(client, body)
    assert (found["file_format"], found["columns"], found["missing"]) == ("AT2", [], [])
    assert found["record"]["samples"] == 100
    found = preview(client, csmip().encode())
    assert (found["file_format"], found["record"]) == ("CSMIP", None)
    channel = found["columns"][0]
    assert preview(client, csmip().encode(), acceleration=channel)["record"]["name"].endswith(channel)
    found = preview(client, b"<html>")
    assert found["file_format"] is None
    assert found["problem"]["was"] == "a web page or XML"


def test_the_vertical_component_is_a_file_of_its_own(client):
    component = at2("NPTS= 100, DT= .01 SEC", body=rows(count=100))
    body = BLOCK | {"record": component, "vertical_record": component, "scale": 0.1}
    record = client.post("/v1/records/response", json=body).json()["record"]
    assert record["peak_vertical_acceleration"] == pytest.approx(record["peak_acceleration"])
    assert_problem(client.post("/v1/records/response", json=body | {"vertical": "1"}), 422, "vertical")
