"""Bodies with two edges: against the block, symmetries, Newton's law, outlines and meshes, searches from both sides."""

import csv
import json
import math

import numpy as np
import pytest
import xarray as xr
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import rocking
from rocking._base.constants import STANDARD_GRAVITY
from rocking._base.errors import InvalidArgumentError
from rocking._dimensional import response
from rocking._model.body import polygon_properties
from rocking._solver.bodies import outcome_margin_of
from tests.sampling import number
from tests.solver.records.tables import TABLE, record, samples

BODY = rocking.RigidBody(0.12, 0.18, 0.4)
MOTION = {"peak_acceleration": 4.0, "period": 0.6}
TRIANGLE = rocking.SampledPulse([0.0, 1.0, -0.7, 0.0])


@pytest.mark.parametrize("motion", ["sine", "-ricker", "c2", TRIANGLE])
def test_equal_edges_are_the_block(motion):
    block, body = rocking.Block(0.3, 1.0), rocking.RigidBody.from_size(0.3, 1.0)
    for strength, period in ((2.0, 0.5), (3.2, 0.4), (5.0, 0.6), (8.0, 0.9), (6.0, 0.3)):
        one = block.response(motion, peak_acceleration=strength, period=period)
        other = body.response(motion, peak_acceleration=strength, period=period)
        assert other.outcome == one.outcome
        assert other.impacts == one.impacts
        assert float(other.rotation) == pytest.approx(one.rotation, rel=1e-13, nan_ok=True)
        assert float(other.displacement) == pytest.approx(one.displacement, rel=1e-13, nan_ok=True)
    changes = rocking.RigidBody(0.15, 0.15, 0.5).thresholds(motion, period=0.6).changes
    expected = [one.value for one in block.response(motion, **MOTION).thresholds]
    assert [one.value for one in changes] == pytest.approx(expected, rel=1e-9)


def test_a_body_of_a_size_has_its_edges_mass_and_top_there_for_arrays_and_labels_too():
    offset = xr.DataArray([-0.05, 0.05], dims="offset")
    body = rocking.RigidBody.from_size("40 cm", 1.6, offset=offset, mass_height=0.7)
    expected = {"left": 0.25, "right": 0.15, "height": 0.8, "gyration": math.hypot(0.4, 1.6) / math.sqrt(12.0)}
    expected |= {"top_height": 1.6, "gravity": STANDARD_GRAVITY, "inclination": 0.0}
    given = rocking.RigidBody.from_size(0.4, 1.6, offset=0.05).parameters
    assert {name: float(value) for name, value in given.items()} == pytest.approx(expected)
    found = body.response("sine", **MOTION)
    assert found["outcome"].dims == ("offset",)
    one = rocking.RigidBody(0.25, 0.15, 0.7, math.hypot(0.4, 1.6) / math.sqrt(12.0), top_height=1.6)
    assert found["rotation"].values[1] == pytest.approx(float(one.response("sine", **MOTION).rotation), rel=1e-12)
    assert body == rocking.RigidBody.from_size(0.4, 1.6, offset=[-0.05, 0.05], mass_height=0.7)


@pytest.mark.parametrize("offset", ["20 cm", [0.0, -0.3]])
def test_a_mass_that_is_not_above_the_base_is_refused(offset):
    with pytest.raises(InvalidArgumentError, match=r"`offset` = .* allowed: less than half the width to either side"):
        rocking.RigidBody.from_size(0.4, 1.6, offset=offset)


def test_the_summary_of_a_response_is_plain_and_searches_no_thresholds_where_none_are_asked_for(monkeypatch):
    body, motion = rocking.RigidBody.from_size(0.4, 1.6, offset=0.03), {"peak_acceleration": 8.0, "period": 0.5}
    found = body.response("sine", **motion)
    said = found.summary()
    assert json.loads(json.dumps(said, allow_nan=False)) == said
    assert (said["overturned"], said["peak_rotation_deg"], said["margin"]) == (True, None, found.margin)
    assert said["edge"] in ("left", "right")
    monkeypatch.setattr(response, "thresholds_of", None)
    assert body.response("sine", **motion, thresholds=False).summary()["margin"] is None


@settings(max_examples=number(20, 60))
@given(
    st.floats(0.05, 0.3),
    st.floats(0.05, 0.3),
    st.floats(0.3, 1.5),
    st.floats(0.5, 12.0),
    st.floats(0.15, 2.0),
    st.floats(-0.05, 0.05),
    st.sampled_from(["sine", "cosine", "c1", "ricker"]),
)
def test_exchanged_edges_under_the_opposite_motion(left, right, height, strength, period, tilt, name):
    assume(abs(tilt) < 0.9 * np.arctan(min(left, right) / height))  # it stands
    motion = {"peak_acceleration": strength, "period": period}
    there = rocking.RigidBody(left, right, height).tilted(tilt).response(name, **motion)
    back = rocking.RigidBody(right, left, height).tilted(-tilt).response("-" + name, **motion)
    margin = abs(float(outcome_margin_of(there.records, there.edges, there.problem.cells)[0]))
    if there.outcome == rocking.Outcome.NO_UPLIFT or margin > 1e-6:
        assert (there.outcome, there.edge) == (back.outcome, -back.edge)
        scale = float(np.nan_to_num(there.rotation))
        for one, other in ((there.rotation_left, back.rotation_right), (there.rotation_right, back.rotation_left)):
            assert float(one) == pytest.approx(float(other), rel=1e-6, abs=1e-9 * scale, nan_ok=True)


@pytest.mark.parametrize("motion", ["sine", TRIANGLE, "record"])
def test_history_has_the_peaks_of_the_response(motion):
    arguments = {"scale": 1.5} if motion == "record" else MOTION
    made = record("napa_HNE", 0.005) if motion == "record" else motion
    found = BODY.response(made, **arguments)
    assert found.outcome == rocking.Outcome.RECOVERS
    history = BODY.history(made, **arguments, samples=20_000, contact=True)
    rotation = history["rotation"].values
    assert rotation.max() == pytest.approx(float(found.rotation_right), rel=1e-5)
    assert -rotation.min() == pytest.approx(float(found.rotation_left), rel=1e-5)
    assert (np.sign(rotation) == history["edge"].values)[rotation != 0.0].all()
    assert history.attrs["outcome"] == "RECOVERS"
    first = float(history["time"].values[np.flatnonzero(rotation)[0]])
    assert first == pytest.approx(float(found.uplift_time), abs=2e-3)


@pytest.mark.parametrize("tilt", [0.0, 0.04])
@pytest.mark.parametrize("vertical", [False, True])
def test_reactions_move_the_centre_of_mass(vertical, tilt):
    """Newton's law: second differences of the positions of the centre of mass give the reactions."""
    height = 0.9 if vertical else 0.4
    body = rocking.RigidBody(0.12, 0.18, height).tilted(tilt)
    if vertical:
        horizontal, upwards = samples("napa_HNE")[700:3000], 0.6 * samples("napa_HNN")[700:3000]
        motion = rocking.Record(horizontal, 0.005, "g", vertical=upwards)
        history = body.history(motion, scale=1.5, contact=True, duration=8.0, samples=100_001)
    else:
        history = body.history("sine", peak_acceleration=5.0, period=0.7, samples=40_001, contact=True)
    rotation, time, edges = (history[name].values for name in ("rotation", "time", "edge"))
    allowed, checked = 1e-3 if vertical else 2e-4, 0
    for sign, b in ((1, 0.18), (-1, 0.12)):
        radius, alpha = math.hypot(b, height), math.atan2(b, height) - sign * tilt
        lean = alpha - np.abs(rotation)
        x, y = -sign * radius * np.sin(lean), radius * np.cos(lean)
        for k in range(200, time.size - 200, 431 if vertical else 131):
            part = slice(k - 1, k + 2)
            step = np.diff(time[part])
            kink = vertical and abs(time[k] / 0.005 - round(time[k] / 0.005)) < 0.05  # of the ground acceleration
            if kink or not (edges[k - 3 : k + 4] == sign).all() or abs(step[0] / step[1] - 1.0) > 1e-6:
                continue
            ax, ay = (np.diff(values[part], 2)[0] / step[0] ** 2 for values in (x, y))
            ax += float(history["ground_acceleration"][k])
            ay += float(history["vertical_acceleration"][k]) if vertical else 0.0
            across, up = ax / STANDARD_GRAVITY, 1.0 + ay / STANDARD_GRAVITY
            along, normal = across * math.cos(tilt) - up * math.sin(tilt), across * math.sin(tilt) + up * math.cos(tilt)
            assert float(history["horizontal_reaction"][k]) == pytest.approx(along, abs=allowed)
            assert float(history["normal_reaction"][k]) == pytest.approx(normal, abs=allowed)
            if normal > 0.2:
                assert float(history["friction_demand"][k]) == pytest.approx(abs(along) / normal, abs=10 * allowed)
            checked += 1
    assert checked > 30


def test_an_inclined_body_uplifts_at_other_accelerations():
    body = BODY.tilted("3 deg")
    right, left = math.atan2(0.18, 0.4) - math.radians(3), math.atan2(0.12, 0.4) + math.radians(3)
    assert float(body.right.alpha) == pytest.approx(right)
    assert float(body.left.alpha) == pytest.approx(left)
    for name, alpha in (("-rectangular", right), ("rectangular", left)):
        uplift = STANDARD_GRAVITY * math.tan(alpha)
        outcomes = body.response(name, peak_acceleration=uplift * np.array([0.999, 1.001]), period=0.2).outcome
        assert outcomes[0] == rocking.Outcome.NO_UPLIFT != outcomes[1]
    for angle, said in (("-20 deg", r"more than -16\.7 degrees: the body falls over"), ("30 deg", "less than 24")):
        with pytest.raises(InvalidArgumentError, match=said):
            BODY.tilted(angle)


def test_a_body_that_nothing_overturns_has_no_thresholds():
    found = BODY.response("sine", peak_acceleration=4.0, period=1e-4)
    assert list(found.thresholds) == found.warnings == []
    assert found.margin.startswith("no peak acceleration up to ")


def test_angular_momentum_gives_the_restitution_of_each_edge():
    body = rocking.RigidBody(0.1, 0.2, 0.5, 0.3)
    assert float(body.right.restitution) == pytest.approx((0.09 + 0.25 - 0.02) / (0.09 + 0.25 + 0.01))
    assert float(body.left.restitution) == pytest.approx((0.09 + 0.25 - 0.02) / (0.09 + 0.25 + 0.04))
    wide = rocking.RigidBody(0.9, 0.8, 0.4, 0.3)
    found = wide.response("sine", peak_acceleration=30.0, period=1.0)
    assert any("impacts that leave the right edge is negative" in text for text in found.warnings)


def test_outcome_margin_is_positive_where_bodies_overturn():
    found = BODY.response("sine", peak_acceleration=np.linspace(3, 20, 400), period=np.linspace(0.2, 2.0, 30)[:, None])
    margin = outcome_margin_of(found.records, found.edges, found.problem.cells)
    rocks = found.outcome.ravel() > rocking.Outcome.NO_UPLIFT
    assert rocks.sum() > 5000
    np.testing.assert_array_equal((margin > 0.0)[rocks], found.overturned.ravel()[rocks])


@pytest.mark.parametrize("period", [0.4, 0.8, 1.3])
def test_thresholds_are_confirmed_from_both_sides(period):
    found = BODY.thresholds("sine", period=period)
    assert found.changes
    for one in found.changes:
        around = one.value * (1 + np.array([-1e-7, 1e-7]))
        overturned = BODY.response("sine", peak_acceleration=around, period=period).overturned
        assert overturned.tolist() == [not one.overturns_above, one.overturns_above]
    strengths = np.linspace(2.0, float(found.lowest) * (1 - 1e-9), 2000)
    assert not BODY.response("sine", peak_acceleration=strengths, period=period).overturned.any()


def test_thresholds_of_an_array_are_those_of_its_bodies():
    bodies = rocking.RigidBody([0.1, 0.12, 0.4], 0.18, 0.4)
    found = bodies.thresholds("sine", period=0.8)
    for k, left in enumerate([0.1, 0.12, 0.4]):
        one = rocking.RigidBody(left, 0.18, 0.4).thresholds("sine", period=0.8)
        np.testing.assert_array_equal(found.value[k][~np.isnan(found.value[k])], one.value)
    assert found.lowest.shape == (3,)
    assert found.to_xarray()["peak_acceleration"].dims == ("dim_0", "threshold")
    with pytest.raises(InvalidArgumentError, match="those of one body"):
        list(found)
    record_found = bodies.thresholds(record("napa_HNE", 0.005), highest=6.0)
    assert record_found.value.shape[0] == 3
    assert (record_found.searched[:, 1] == 6.0).all()


def test_boundary_points_separate_outcomes():
    curves = BODY.boundary("sine", period=(0.3, 2.0))
    inside = (curves["slenderness"].values > 0.05) & (curves["slenderness"].values < 0.98)
    pick = np.flatnonzero(inside)[::37]
    assert pick.size > 15
    strength, period = (curves[name].values[pick, None] for name in ("peak_acceleration", "period"))
    around, changed = 1.0 + np.array([-1e-6, 1e-6]), np.zeros(pick.size, bool)
    for strengths, periods in ((strength * around, period), (strength, period * around)):
        found = BODY.response("sine", peak_acceleration=strengths, period=periods)
        changed |= (found.outcome[:, 0] != found.outcome[:, 1]) | (found.impacts[:, 0] != found.impacts[:, 1])
    assert changed.mean() > 0.95


def test_spectra_are_responses():
    given = {"peak_acceleration": 4.0, "period": np.array([0.3, 0.6, 0.9])}
    np.testing.assert_array_equal(BODY.spectrum("sine", **given)["rotation"], BODY.response("sine", **given).rotation)
    sizes, motion = np.array([1.0, 2.0, 5.0]), record("napa_HNE", 0.005)
    by_size = BODY.spectrum(motion, scale=2.0, size=sizes)
    assert by_size["rotation"].dims == ("size",)
    each = [rocking.RigidBody(0.12 * size, 0.18 * size, 0.4 * size).response(motion, scale=2.0) for size in sizes]
    for name in ("rotation", "displacement"):
        np.testing.assert_allclose(by_size[name], [getattr(one, name) for one in each], rtol=1e-9)


@pytest.mark.parametrize("chunks", [{}, {"object": 1, "strength": 2}], ids=["arrays", "dask"])
def test_labelled_bodies_and_motions_broadcast_by_name(chunks):
    left = xr.DataArray([0.2, 0.3], dims="object", coords={"object": ["vase", "bust"]})
    height = xr.DataArray([0.4, 0.6], dims="level")
    strength = xr.DataArray([2.0, 4.0, 6.0], dims="strength")
    plain = rocking.RigidBody(left.values[:, None, None], 0.15, height.values[:, None])
    expected = plain.response("sine", peak_acceleration=strength.values, period=0.5, restitution=0.9)
    if chunks:
        left, strength = (one.chunk({one.dims[0]: chunks[one.dims[0]]}) for one in (left, strength))
    bodies = rocking.RigidBody(left, "15 cm", height)
    assert bodies.shape == (2, 2)
    found = bodies.response("sine", peak_acceleration=strength, period="500 ms", restitution=0.9)
    assert bool(found.chunks) == bool(chunks)
    for name, values in found.compute().items():
        np.testing.assert_array_equal(values.transpose("object", "level", "strength"), getattr(expected, name))
    assert found["displacement"].attrs["units"] == "m"
    assert found["object"].values.tolist() == ["vase", "bust"]
    same, by_name = (rocking.RigidBody(one, 0.15, 0.4).scaled(2.0) for one in (left.values, left))
    np.testing.assert_array_equal(
        by_name.response("sine", **MOTION)["rotation"], same.response("sine", **MOTION).rotation
    )
    of_block = rocking.Block(0.3, 1.0).response("sine", peak_acceleration=strength, period=0.5)
    assert of_block["rotation"].dims == ("strength",)
    with pytest.raises(InvalidArgumentError, match="equal indexes of a dimension"):
        rocking.RigidBody(left, 0.15, left.assign_coords(object=["vase", "urn"]))
    with pytest.raises(InvalidArgumentError, match="a number or an xarray"):
        bodies.response("sine", peak_acceleration=[2.0, 4.0], period=0.5)


@pytest.mark.parametrize("order", [1, -1])
def test_outline_of_a_triangle_by_its_closed_forms(order):
    """A right triangle with legs b, h: centroid at thirds, polar moment of area (b^2 + h^2) b h/36."""
    b, h = 0.3, 0.9
    found = polygon_properties([(0.0, 0.0), (b, 0.0), (0.0, h)][::order])
    assert (found.left, found.right, found.height) == pytest.approx((b / 3, 2 * b / 3, h / 3), rel=1e-12)
    assert found.gyration == pytest.approx(math.sqrt((b * b + h * h) / 18), rel=1e-12)
    assert found.top == pytest.approx(h, rel=1e-15)


@pytest.mark.parametrize(
    ("vertices", "text"),
    [
        ([(0, 0), (1, 1), (1, 0), (0, 1)], "encloses an area"),
        ([(0, 0), (2, 2), (2, 0), (0, 1)], "does not cross itself"),
        ([(0, 0), (1, 0)], "at least three pairs"),
        ([(0, 0), (1, 1), (0, 2), (-1, 1)], "stands"),
        ([(0, 0), (0.1, 0), (3, 1), (2.9, 1)], "stands"),
        ([(0, 0), (1, 0), (0.5, 0.5), (0.3, 0.8), (0.7, 0.8), (0.5, 0.5)], "does not cross itself"),
    ],
)
def test_outlines_that_are_no_bodies_are_refused(vertices, text):
    with pytest.raises(InvalidArgumentError, match=text):
        rocking.RigidBody.from_polygon(vertices)


ROWS = list(csv.DictReader((TABLE.parent / "bodies.csv").read_text(encoding="utf-8").splitlines()))


@pytest.mark.parametrize("row", ROWS[::4], ids=[str(k) for k in range(0, len(ROWS), 4)])
def test_reference_cases_through_records(row):
    """Cases of the reference table; the unit of its records makes errors of a few roundings more."""
    part = slice(*map(int, row["n"].split(":")))
    vertical = float(row["vertical_scale"]) * samples(row["vertical"])[part] if row["vertical"] else None
    horizontal = float(row["scale"]) * samples(row["record"])[part]
    motion = rocking.Record(horizontal, float(row["time_step"]), "g", vertical=vertical)
    body = rocking.RigidBody(*(float(row[name]) for name in ("b_left", "b_right", "height", "gyration")))
    found = body.response(motion, restitution=float(row["restitution"]) if row["restitution"] else "momentum")
    assert bool(found.overturned) == (row["overturned"] == "1")
    if not found.overturned:
        allowed = 1e-12 * max(1.0, float(row["amplification"]))
        assert float(found.rotation_right) == pytest.approx(float(row["peak_right"]), rel=allowed)
        assert float(found.rotation_left) == pytest.approx(float(row["peak_left"]), rel=allowed)


@pytest.mark.parametrize("body", [rocking.RigidBody(0.2, 0.2, 0.8, gravity=3.7), rocking.Block(0.4, 1.6, gravity=3.7)])
def test_limits_of_factors_of_a_record(body):
    ground = record("napa_HNE", 0.005)
    with pytest.raises(InvalidArgumentError, match=r"highest.*\(0, 1e\+06\]"):
        body.thresholds(ground, highest=1e7)
    falling = rocking.Record(ground.acceleration, 0.005, "m/s2", vertical=np.full(6997, -0.6 * STANDARD_GRAVITY))
    with pytest.raises(InvalidArgumentError, match=r"scale. = 1\.0 .*below 0\.628825.*-5\.884 m/s2"):
        body.response(falling)
