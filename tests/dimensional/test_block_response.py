"""Responses of blocks in SI units against the dimensionless functions, and what they look like."""

import math
import pickle
import re

import numpy as np
import pytest

import rocking
from rocking._base.errors import InvalidArgumentError
from rocking._model.outcome import Outcome

BLOCK = rocking.Block(width=0.4, height=1.6)
MOTION = {"peak_acceleration": 4.0, "period": 0.5}
RECORD = rocking.Record(9.81 * 0.5 * np.sin(np.arange(400) * 0.05), 0.01, unit="m/s2", name="made up")


def groups(block=BLOCK, peak_acceleration=4.0, period=0.5, restitution=None):
    return {
        "slenderness": block.uplift_acceleration / peak_acceleration,
        "frequency_ratio": 2 * math.pi / period / block.frequency_parameter,
        "restitution": block.momentum_restitution if restitution is None else restitution,
        "alpha": block.alpha,
    }


def test_response_is_that_of_the_groups():
    found = BLOCK.response("sine", **MOTION)
    expected = rocking.peak_response("sine", **groups())
    assert found.rotation == pytest.approx(float(expected.peak_rotation) * BLOCK.alpha, rel=1e-12)
    assert found.displacement == pytest.approx(1.6 * math.sin(found.rotation), rel=1e-12)
    assert (found.outcome, found.impacts, found.overturned) == (Outcome.RECOVERS, int(expected.impacts), False)
    assert found.sentence == "rocks and comes to rest"
    assert found.warnings == []
    assert found.rocking_model_applies
    with pytest.raises(InvalidArgumentError, match=r"^`alpha` = 9e-13 is not allowed; allowed: \[1e-12, 1\.57\]"):
        rocking.Block(width=9e-13, height=1.0).response("sine", peak_acceleration=1e-11, period=0.5)


def test_thresholds_and_margins_are_changes_of_the_outcome():
    found = BLOCK.response("sine", **MOTION)
    lowest, period = found.thresholds[0].value, found.margins.nearest_period
    assert found.largest_surviving_acceleration == lowest == pytest.approx(4.7000674, rel=1e-7)
    size, eta = found.margins.surviving_from_half_diagonal, BLOCK.momentum_restitution
    for factor, overturned in ((1 - 1e-6, False), (1 + 1e-6, True)):
        assert BLOCK.response("sine", peak_acceleration=lowest * factor, period=0.5).overturned == overturned
        assert BLOCK.response("sine", peak_acceleration=4.0, period=period * factor).overturned == overturned
        block = rocking.Block.from_slenderness_angle(BLOCK.alpha, size / factor)
        assert block.response("sine", **MOTION, restitution=eta).overturned == overturned


LINEAR = rocking.EquivalentBlock(0.2, 2.0, restitution=0.9, uplift_acceleration=1.5)


@pytest.mark.parametrize("motion", ["sine", RECORD], ids=["pulse", "record"])
@pytest.mark.parametrize("block", [BLOCK, LINEAR], ids=["rigid", "linear"])
def test_thresholds_are_of_one_type_whatever_the_motion(block, motion):
    by_record = motion is RECORD
    period, name, unit = ({}, "scale", "1") if by_record else ({"period": 0.5}, "peak_acceleration", "m s-2")
    found = block.thresholds(motion, **period)
    strength = {} if by_record else {"peak_acceleration": 4.0}
    assert list(found) == list(block.response(motion, **strength, **period).thresholds)
    assert len(found) == found.value.size > 0
    for factor, overturned in ((1 - 2e-6, False), (1 + 2e-6, True)):
        assert block.response(motion, **{name: factor * found[0].value}, **period).overturned == overturned
    none = block.thresholds(motion, highest=0.999 * found[0].value, **period)
    assert (len(none), list(none)) == (0, [])
    assert "was found to overturn it" in repr(none)
    data = found.to_xarray()
    np.testing.assert_array_equal(data[name], [one.value for one in found])
    assert data[name].attrs["units"] == unit
    assert len(found.to_pandas()) == len(found)
    with pytest.raises(InvalidArgumentError):
        block.thresholds(motion, **({"period": 0.5} if by_record else {}))


def test_margins_and_responses_as_text_and_tables():
    found = BLOCK.response("sine", **MOTION)
    assert repr(found.margins).startswith("<rocking.Margins: acceleration 4.7 m/s2, period 0.5")
    assert (found.sentence, found.margin[:30]) == ("rocks and comes to rest", "it does not overturn below 4.7")
    assert "1 impact during the pulse; block of 0.4 m x 1.6 m under sine of 4 m/s2 and 0.5 s>" in repr(found)
    html = found._repr_html_()
    assert "<td>0.206594</td><td>m</td>" in html
    assert html.count("<tr>") == len(found.fields)
    data, series = found.margins.to_xarray(), found.margins.to_pandas()
    assert data["periods"].values.tolist() == [one.value for one in found.margins.periods]
    for name, value in series.items():
        assert data[name].item() == value == getattr(found.margins, name)
    for one in (found.margins, found, BLOCK.response(RECORD, scale=0.55)):
        assert pickle.loads(pickle.dumps(one)) == one
    none = BLOCK.response("sine", peak_acceleration=1e-3, period=0.01).margins
    assert none.to_pandas().isna()["nearest_period"]
    assert "period not found" in repr(none)


@pytest.mark.parametrize("motion", ["sine", "record"])
def test_arrays_of_arguments_broadcast(motion):
    made, period = (RECORD, {}) if motion == "record" else (motion, {"period": 0.5})
    name = "scale" if motion == "record" else "peak_acceleration"
    strengths = np.array([[0.3], [0.7], [4.0]]) * (2.5 * BLOCK.uplift_acceleration if period else 1.0)
    etas = [0.8, 0.95]
    found = BLOCK.response(made, **{name: strengths}, **period, restitution=etas)
    for index in np.ndindex(3, 2):
        one = BLOCK.response(made, **{name: float(strengths[index[0], 0])}, **period, restitution=etas[index[1]])
        assert (found.outcome[index], found.impacts[index]) == (one.outcome, one.impacts)
        assert found.rotation[index] == pytest.approx(one.rotation, rel=1e-12, nan_ok=True)
        assert found.displacement[index] == pytest.approx(one.displacement, rel=1e-12, nan_ok=True)
    assert found.overturned.any()
    assert not found.overturned.all()
    if period:
        each = [BLOCK.thresholds(made, period=one).value for one in (0.4, 0.5)]
        lowest = BLOCK.thresholds(made, period=[0.4, 0.5]).lowest
        np.testing.assert_allclose(lowest, [one[0] for one in each], rtol=1e-9)
    linear = LINEAR.response(made, **{name: [1.0, 2.0]}, **period)
    each_linear = [LINEAR.response(made, **{name: strength}, **period).rotation for strength in (1.0, 2.0)]
    np.testing.assert_array_equal(linear.rotation, each_linear)


def test_spectrum_of_a_structure_over_its_size():
    structure, half = (rocking.EquivalentBlock(0.2, p, restitution=0.9) for p in (2.0, 2.0 * math.sqrt(2.0)))
    found = structure.spectrum("sine", **MOTION, size=[0.5])
    assert float(found["displacement"][0]) == pytest.approx(half.response("sine", **MOTION).displacement, rel=1e-12)


def test_history_is_that_of_the_groups_in_si_units():
    found = BLOCK.history("sine", **MOTION, samples=50, contact=True)
    expected = rocking.time_history("sine", **groups(), samples=50, contact=True)
    p, alpha = BLOCK.frequency_parameter, BLOCK.alpha
    for name, variable, factor in (
        ("time", "tau", 1 / p),
        ("rotation", "rotation", alpha),
        ("angular_velocity", "angular_velocity", alpha * p),
        ("impact_time", "impact_time", 1 / p),
        ("friction_demand", "friction_demand", 1.0),
        ("ground_acceleration", "ground_acceleration", BLOCK.uplift_acceleration),
    ):
        np.testing.assert_allclose(found[name], expected[variable] * factor, rtol=1e-12)
    np.testing.assert_allclose(found["displacement"], 1.6 * np.sin(found["rotation"]), rtol=1e-13)
    fine = BLOCK.history("sine", **MOTION, samples=4000)  # rad/s over s is rad
    turned = np.trapezoid(fine["angular_velocity"], fine["time"])
    assert turned == pytest.approx(float(fine["rotation"][-1]), abs=1e-4)


def test_history_under_a_record_is_that_of_the_groups_in_si_units():
    motion = rocking.Record(3.0 * np.sin(8.0 * np.arange(0.0, 2.0, 0.01)), 0.01, unit="m/s2")
    found = BLOCK.history(motion, scale=1.2, restitution=0.8, contact=True)
    expected = rocking.time_history(
        motion,
        frequency_parameter=BLOCK.frequency_parameter,
        slenderness=BLOCK.uplift_acceleration / (1.2 * motion.peak_acceleration),
        restitution=0.8,
        alpha=BLOCK.alpha,
        contact=True,
    )
    for name in ("impact_time", "friction_demand"):
        np.testing.assert_allclose(found[name], expected[name], rtol=1e-12)
    np.testing.assert_allclose(found["rotation"], expected["rotation"] * BLOCK.alpha, rtol=1e-13)
    inside = found.sel(time=slice(0.0, 1.99))
    ground = np.interp(inside["time"], 0.01 * np.arange(motion.samples), 1.2 * motion.acceleration)
    np.testing.assert_allclose(inside["ground_acceleration"], ground, atol=1e-12)
    assert float(BLOCK.history(motion, duration=1.5)["time"][-1]) == pytest.approx(1.5)
    with pytest.raises(InvalidArgumentError, match=r"^`period` = 0.5"):
        BLOCK.history(motion, period=0.5)


def test_spectrum_is_the_response_at_each_period():
    found = BLOCK.spectrum("sine", peak_acceleration=4.0, period=[0.3, 0.5, 1.0])
    each = BLOCK.response("sine", peak_acceleration=4.0, period=[0.3, 0.5, 1.0])
    for name, values in (("rotation", each.rotation), ("displacement", each.displacement)):
        np.testing.assert_allclose(found[name], values, rtol=1e-12)
    assert found["overturned"].values.tolist() == each.overturned.tolist() == [False, False, True]
    assert found["period"].attrs["units"] == "s"
    assert BLOCK.spectrum("sine", peak_acceleration=4.0, period=[]).sizes["period"] == 0
    with pytest.raises(InvalidArgumentError, match=r"^`period` = "):
        BLOCK.spectrum("sine", peak_acceleration=4.0, period=[[0.5]])


def test_outcome_changes_across_the_boundary():
    found = BLOCK.boundary("sine", restitution=0.85, period=(0.4, 0.8))
    assert (float(found["period"].min()), float(found["period"].max())) == pytest.approx((0.4, 0.8), rel=1e-12)
    lowest = int(found["peak_acceleration"].values.argmin())
    acceleration, period = (float(found[name][lowest]) for name in ("peak_acceleration", "period"))
    around = acceleration * np.array([1.0 - 1e-9, 1.0 + 1e-9])
    response = BLOCK.response("sine", peak_acceleration=around, period=period, restitution=0.85)
    assert response.overturned.tolist() == [False, True]
    for wrong in (0.5, (0.5,), (0.5, 0.4), (0.0, 0.4)):
        with pytest.raises(InvalidArgumentError, match=r"^`period` = "):
            BLOCK.boundary("sine", period=wrong)


def test_a_record_with_a_scale_is_that_of_the_groups():
    found = BLOCK.response(RECORD, scale=0.55)
    expected = rocking.peak_response(
        RECORD,
        frequency_parameter=BLOCK.frequency_parameter,
        slenderness=BLOCK.uplift_acceleration / (0.55 * RECORD.peak_acceleration),
        restitution=BLOCK.momentum_restitution,
        alpha=BLOCK.alpha,
    )
    assert (found.outcome, found.impacts) == (expected.outcome, expected.impacts)
    assert found.peak_rotation == pytest.approx(float(expected.peak_rotation), rel=1e-12)
    assert found.rotation == pytest.approx(found.peak_rotation * BLOCK.alpha, rel=1e-14)
    assert found.displacement == pytest.approx(1.6 * math.sin(found.rotation))
    assert "under made up scaled to 2.69" in repr(found)
    data = found.to_xarray()
    assert data["displacement"].attrs["units"] == "m"
    assert float(data["scale"]) == 0.55
    assert data.attrs["record"] == found.to_pandas()["record"] == "made up"


@pytest.mark.parametrize("body", [BLOCK, rocking.RigidBody(0.12, 0.18, 0.4)], ids=["block", "edges"])
@pytest.mark.parametrize(
    ("motion", "arguments", "parameter"),
    [
        (RECORD, {"peak_acceleration": 3.0}, "peak_acceleration"),
        (RECORD, {"period": 0.5}, "period"),
        (RECORD, {"scale": 0.0}, "scale"),
        ("sine", {**MOTION, "scale": 1.0}, "scale"),
        ("sine", {"peak_acceleration": 3.0}, "period"),
        ("sine", {"period": 0.5}, "peak_acceleration"),
        ("sine", {**MOTION, "restitution": "housner"}, "restitution"),
        ("sine", {**MOTION, "peak_acceleration": [4.0, -4.0]}, "peak_acceleration"),
        ("sine", {"period": [0.5, 0.6], "peak_acceleration": [1.0, 2.0, 3.0]}, "peak_acceleration, period$"),
    ],
)
def test_wrong_arguments_and_those_of_the_other_kind_of_motion_are_named(body, motion, arguments, parameter):
    with pytest.raises(InvalidArgumentError) as caught:
        body.response(motion, **arguments)
    assert re.search(parameter, caught.value.parameter)
