"""POST /v1/records/response and /v1/records/history: a record in the body, a block in the query."""

import io
import math

import numpy as np
import pytest
import xarray as xr

import rocking
from rocking._excitation.records.readers.read_record import parse_record
from tests.api.conftest import NAPA, assert_problem
from tests.excitation.record_files import at2, rows

RECORD = NAPA.read_bytes()
BLOCK = {"width": 0.5, "height": 2.0}
DAMAGED = b"time_s,acceleration_g\n0,0.1\n0.01,0.2\n0.02,what\n0.03,0.1\n"


def post(client, body=RECORD, route="response", **params):
    return client.post(f"/v1/records/{route}", params=BLOCK | params, content=body)


@pytest.fixture(scope="module")
def motion():
    return rocking.read_record(NAPA)


def test_the_response_is_that_of_the_library(client, motion):
    block = rocking.Block(0.5, 2.0)
    expected = block.response(motion, scale=1.1)
    found = post(client, scale=1.1, name="napa_HNE.csv").json()
    assert found["peak_rotation"] == float(expected.dimensionless.peak_rotation)
    assert found["peak_rotation_deg"] == pytest.approx(math.degrees(expected.rotation))
    assert found["top_displacement"] == pytest.approx(2.0 * math.sin(expected.rotation))
    assert found["impacts"] == int(expected.dimensionless.impacts)
    assert found["outcome"] == "RECOVERS"
    assert not found["overturned"]
    assert found["meaning"] == "rocks and comes to rest"
    assert found["record"]["digest"] == motion.digest
    assert found["record"]["peak_acceleration"] == motion.peak_acceleration
    assert found["record"]["name"] == "napa_HNE"
    assert found["peak_rotation_resampled"] == float(expected.resampled.peak_rotation)
    assert found["friction_demand"] > found["friction_at_uplift"] == 0.25
    assert [one["scale"] for one in found["thresholds"]] == expected.thresholds.value.tolist()
    assert found["pulse"] is None


def test_a_statue_under_a_record_with_its_vertical_component(client):
    body = b"time [s],ns [g],up [g]\n" + b"".join(
        b"%.2f,%.4f,%.4f\n" % (0.02 * k, 0.4 * math.sin(0.2 * k), 0.2 * math.cos(0.5 * k)) for k in range(100)
    )
    motion = parse_record(body, "record", component="ns", vertical="up")
    expected = rocking.RigidBody.from_size(0.5, 2.0, offset=-0.03).response(motion, scale=1.1)
    given = {"scale": 1.1, "component": "ns", "vertical": "up", "offset": -0.03}
    found = post(client, body, **given).json()
    assert {name: found[name] for name in expected.summary()} == expected.summary()
    assert [one["scale"] for one in found["thresholds"]] == expected.thresholds.value.tolist()
    assert found["edge"] == {1: "right", -1: "left"}[int(expected.edge)]
    faster = post(client, body, **given, thresholds=False).json()
    assert faster["thresholds"] is faster["margin"] is None
    assert_problem(post(client, body, **given, fit=True), 422, "fit")
    assert_problem(post(client, body, **given | {"offset": 0.25}), 422, "offset")


def test_remarks_of_the_reader_are_in_the_response(client):
    body = at2("NPTS= 101, DT= .01 SEC", body=rows(count=100)).encode()
    remark = "the file holds 100 samples, its header states 101"
    found = post(client, body, scale=3.0).json()
    assert remark in found["warnings"]
    assert found["record"]["remarks"] == [remark]
    assert post(client, body, route="history", scale=3.0).json()["record"]["remarks"] == [remark]
    problem = assert_problem(post(client, at2("NPTS= 10, DT= .01", body="0.1 0.2\n").encode()), 422, "record")
    assert "10 stated, 2 values" in problem["detail"]


def test_thresholds_and_a_pulse_on_request(client, motion):
    found = post(client, fit=True, restitution=0.8).json()
    scales = [threshold["scale"] for threshold in found["thresholds"]]
    assert scales == sorted(scales)
    assert found["thresholds"][0]["overturns_above"]
    assert found["thresholds"][0]["peak_acceleration"] == pytest.approx(scales[0] * motion.peak_acceleration)
    above = post(client, scale=scales[0] * (1 + 1e-5), restitution=0.8).json()
    below = post(client, scale=scales[0] * (1 - 1e-5), restitution=0.8).json()
    assert (above["overturned"], below["overturned"]) == (True, False)
    assert found["pulse"]["pulse"] == "mavroeidis_papageorgiou"
    assert found["pulse"]["scale_ratio"] == pytest.approx(1.6, abs=0.2)


def test_history_in_three_formats(client, motion):
    block = rocking.Block(0.5, 2.0)
    expected = rocking.time_history(
        motion,
        frequency_parameter=block.frequency_parameter,
        slenderness=block.uplift_acceleration / motion.peak_acceleration,
        restitution=block.inelastic_restitution,
        alpha=block.alpha,
        samples=300,
        contact=True,
    )
    found = post(client, route="history", samples=300, contact=True).json()
    np.testing.assert_array_equal(found["rotation"], expected.rotation)
    np.testing.assert_array_equal(found["time"], expected.time)
    np.testing.assert_array_equal(found["impact_time"], expected.impact_time)
    assert len(found["contact"]["normal_reaction"]) == len(found["time"])
    text = post(client, route="history", samples=300, format="csv").text
    table = np.loadtxt(io.StringIO(text), delimiter=",", skiprows=1)
    np.testing.assert_array_equal(table[:, 1], expected.rotation)
    file = post(client, route="history", samples=300, format="nc").content
    with xr.open_dataset(io.BytesIO(file)) as dataset:
        np.testing.assert_array_equal(dataset.rotation, expected.rotation)
    whole = post(client, route="history").json()
    assert len(whole["time"]) > motion.samples


def test_scales_are_those_of_the_library(client, motion):
    block = rocking.Block(0.5, 2.0)
    uplift = block.uplift_acceleration / motion.peak_acceleration
    found = post(client, route="scales", points=30, scale_max=2.0).json()
    scale = np.array(found["scale"])
    np.testing.assert_allclose(scale, np.geomspace(uplift, 2.0, 30), rtol=1e-14)
    expected = rocking.peak_response(
        motion,
        frequency_parameter=block.frequency_parameter,
        slenderness=block.uplift_acceleration / (scale * motion.peak_acceleration),
        restitution=block.inelastic_restitution,
        alpha=block.alpha,
    )
    assert found["overturned"] == expected.overturned.tolist()
    assert [math.nan if peak is None else peak for peak in found["peak_rotation"]] == pytest.approx(
        expected.peak_rotation.tolist(), nan_ok=True
    )
    thresholds = block.thresholds(motion, highest=2.0)
    assert [one["scale"] for one in found["thresholds"]] == thresholds.value.tolist()
    table = post(client, route="scales", points=30, scale_max=2.0, format="csv").text.splitlines()
    assert table[0].startswith("scale,peak_acceleration,peak_rotation,overturned")
    file = post(client, route="scales", points=30, scale_max=2.0, format="nc").content
    with xr.open_dataset(io.BytesIO(file)) as dataset:
        np.testing.assert_array_equal(dataset.peak_rotation, expected.peak_rotation)
    assert_problem(post(client, route="scales", scale_min=2.0, scale_max=1.0), 422, "scale_max")
    assert_problem(post(client, route="scales", points=1), 422, "points")


def test_the_pulse_is_drawn_beside_the_record(client, motion):
    part = rocking.Record(motion.acceleration[800:2400], motion.time_step, "m/s2")
    plain = "\n".join(map(repr, part.acceleration.tolist())).encode()
    found = post(client, plain, route="pulse", unit="m/s2", time_step=0.005, scale=2.0, samples=400).json()
    fit = rocking.suites.fit_pulse(part, blocks=rocking.Block(0.5, 2.0))
    assert found["pulse"]["period"] == pytest.approx(fit.period, rel=1e-6)
    assert len(found["time"]) == 400
    np.testing.assert_allclose(found["record_velocity"], 2.0 * part.velocity[::4])
    np.testing.assert_allclose(found["pulse_acceleration"], 2.0 * fit.acceleration(part.times[::4]), atol=1e-5)
    rates = np.gradient(found["pulse_velocity"], found["time"])
    assert np.abs(rates - found["pulse_acceleration"]).max() < 0.02 * np.abs(found["pulse_acceleration"]).max()
    assert "unconservative" in found["caution"]


def test_a_damaged_file_is_explained_by_its_line(client):
    problem = assert_problem(post(client, DAMAGED, name="damaged.csv"), 422, "record")
    assert "damaged.csv, line 4: found what; expected a number" in problem["detail"]
    assert problem["value"] == "what"


def both_columns(motion, share=0.5):
    a = motion.acceleration
    rows = np.stack([motion.times, a, share * np.roll(a, 5)], axis=1).tolist()
    return "t,h_m/s2,up_m/s2\n" + "".join(f"{t!r},{a!r},{w!r}\n" for t, a, w in rows)


def test_the_vertical_component_is_a_column_of_the_body(client, motion):
    columns = {"component": "h", "vertical": "up"}
    body = both_columns(motion)
    both = rocking.Record(motion.acceleration, 0.005, "m/s2", vertical=0.5 * np.roll(motion.acceleration, 5))
    expected = rocking.Block(0.5, 2.0).response(both, scale=1.1)
    found = post(client, body, **columns, scale=1.1).json()
    assert found["peak_rotation"] == pytest.approx(float(expected.dimensionless.peak_rotation), rel=1e-9)
    assert found["margin"] == expected.margin
    assert found["record"]["peak_vertical_acceleration"] == pytest.approx(both.peak_vertical_acceleration)
    assert found["record"]["digest"] == both.digest
    contact = expected.contact
    assert found["friction_demand"] == pytest.approx(contact.largest_friction_demand, rel=1e-9)
    assert found["smallest_normal_reaction"] == pytest.approx(contact.smallest_normal_reaction, rel=1e-9)
    history = post(client, body, route="history", **columns).json()
    assert np.abs(history["vertical_acceleration"]).max() == pytest.approx(both.peak_vertical_acceleration / 9.80665)
    assert post(client, route="history").json()["vertical_acceleration"] is None
    assert (
        "vertical_acceleration" in post(client, body, route="history", **columns, format="csv").text.partition("\n")[0]
    )
    scales = post(client, body, route="scales", points=20, scale_max=2.0, **columns).json()
    assert [one["scale"] for one in scales["thresholds"]] == [
        one["scale"]
        for one in post(client, body, route="scales", points=5, scale_max=2.0, **columns).json()["thresholds"]
    ]


def test_errors_of_the_vertical_component_name_the_parameter(client, motion):
    body = both_columns(motion, share=-1.0)
    columns = {"component": "h", "vertical": "up"}
    assert_problem(post(client, body, component="h", vertical="z"), 422, "vertical")
    assert_problem(post(client, vertical="up"), 422, "vertical")
    assert_problem(post(client, body, **columns, scale=5.0), 422, "scale")
    assert_problem(post(client, body, route="history", **columns, scale=5.0), 422, "scale")
    assert_problem(post(client, body, route="scales", **columns, scale_max=5.0), 422, "scale_max")
    by_default = post(client, body, route="scales", **columns).json()
    assert by_default["scale"][-1] == pytest.approx(9.80665 / motion.acceleration.max())
