"""Blocks in metres under records with a vertical component: gravity, scales, searches, structures."""

import math

import numpy as np
import pytest

import rocking
from rocking._base.constants import STANDARD_GRAVITY
from rocking._base.errors import InvalidArgumentError
from rocking._dimensional.problem import record_groups, uplift_scale
from rocking._dimensional.thresholds import overturning_scale
from tests.sampling import number
from tests.solver.records.tables import samples
from tests.suites.motions import noise

PART = slice(700, 2700)
HORIZONTAL, VERTICAL = samples("napa_HNE")[PART], samples("napa_HNN")[PART]
MOTION = rocking.Record(HORIZONTAL, 0.005, "g", vertical=VERTICAL, name="napa")
BLOCK = rocking.Block(0.2, 1.0)


@pytest.mark.parametrize("scale", [0.85, 0.9, 1.0])
def test_a_constant_vertical_acceleration_is_another_gravity(scale: float) -> None:
    """Times the scale: c g times the scale adds to gravity."""
    f, c = np.append(HORIZONTAL, np.zeros(4000)), 0.5
    lifted = rocking.Record(f, 0.005, "g", vertical=np.full(f.size, c))
    heavier = rocking.Block(0.2, 1.0, gravity=STANDARD_GRAVITY * (1.0 + scale * c))
    found = BLOCK.response(lifted, scale=scale, thresholds=False)
    other = heavier.response(rocking.Record(f, 0.005, "g"), scale=scale, thresholds=False)
    assert found.outcome == other.outcome == rocking.Outcome.RECOVERS
    assert found.rotation == pytest.approx(other.rotation, rel=1e-11)
    history = BLOCK.history(lifted, scale=scale)
    inside = history.time < lifted.duration
    np.testing.assert_allclose(history.vertical_acceleration[inside], scale * c * STANDARD_GRAVITY, rtol=1e-12)
    assert history.vertical_acceleration.attrs["units"] == "m s-2"


def test_the_scale_multiplies_both_components_under_any_gravity() -> None:
    def motion(k: float) -> rocking.Record:
        return rocking.Record(k * HORIZONTAL, 0.005, "g", vertical=k * VERTICAL)

    moon = rocking.Block(0.2, 1.0, gravity=1.62)
    found, other = moon.response(motion(0.1), scale=2.0), moon.response(motion(0.2))
    assert found.outcome == other.outcome
    assert found.peak_rotation == pytest.approx(other.peak_rotation, rel=1e-10, nan_ok=True)
    np.testing.assert_allclose(found.thresholds.value, 2.0 * other.thresholds.value, rtol=1e-5)
    # lengths and accelerations divided by the same number leave the ratios
    k = STANDARD_GRAVITY / 1.62
    earth = rocking.Block(0.2 * k, k).response(motion(0.1 * k), scale=2.0)
    assert earth.peak_rotation == pytest.approx(found.peak_rotation, rel=1e-9, nan_ok=True)


def test_uplift_depends_on_both_components() -> None:
    scale = uplift_scale(MOTION, BLOCK)
    for factor, outcome in ((1.0 - 1e-9, rocking.Outcome.NO_UPLIFT), (1.0 + 1e-6, rocking.Outcome.RECOVERS)):
        assert BLOCK.response(MOTION, scale=scale * factor, thresholds=False).outcome == outcome
    held = rocking.Record([0.0, 1.0, 0.0], 0.1, "g", vertical=[1.0, 10.0, 1.0])
    assert uplift_scale(held, BLOCK) == 1e6
    found = BLOCK.thresholds(held)
    assert found.value.size == 0
    assert math.isnan(overturning_scale(held, BLOCK))


@pytest.mark.parametrize("heavy", [rocking.Block(4.0, 8.0), rocking.RigidBody(2.0, 2.1, 4.0)])
def test_a_search_ends_where_the_body_would_fly(heavy: rocking.Block | rocking.RigidBody) -> None:
    record = noise(1)
    motion = rocking.Record(record.acceleration, record.time_step, "m/s2", vertical=-3.0 * record.acceleration)
    limit = -STANDARD_GRAVITY / float(motion.vertical.min())
    found = heavy.thresholds(motion)
    assert found.ends_in_flight
    assert limit * (1.0 - 1e-8) < found.searched[1] < limit
    assert found.sentence.endswith("times on its vertical acceleration reaches -g")
    response = heavy.response(motion, scale=0.9 * limit)
    assert response.margin == found.sentence
    assert not heavy.thresholds(motion, highest=0.5 * limit).ends_in_flight
    with pytest.raises(InvalidArgumentError, match=r"`scale` = .* -g at .* s"):
        heavy.response(motion, scale=1.01 * limit)
    with pytest.raises(InvalidArgumentError, match="`scale`"):
        heavy.history(motion, scale=1.01 * limit)


def test_thresholds_are_those_of_the_responses() -> None:
    record = noise(2)
    upwards = 0.6 * np.roll(record.acceleration, 9)
    motion = rocking.Record(record.acceleration, record.time_step, "m/s2", vertical=upwards)
    found = BLOCK.thresholds(motion)
    assert found.value.size
    assert overturning_scale(motion, BLOCK) == found.value[0]
    without = BLOCK.thresholds(record).value[0]
    assert abs(found.value[0] / without - 1.0) > 1e-3
    for scale in found.value.tolist():
        assert BLOCK.response(motion, scale=scale, thresholds=False).overturned
        near = scale * np.linspace(1.0 - 1e-6, 1.0 + 1e-6, number(401, 2001))  # ranges near a threshold can be narrow
        groups = record_groups(motion, BLOCK, near, BLOCK.inelastic_restitution)
        assert not rocking.peak_response(motion, **groups).overturned.all()


def test_structures_take_the_vertical_component() -> None:
    """Bodies by (2.2) as their block; a mechanism by the linear equation as a slender block of its groups."""
    body = rocking.EquivalentBlock(BLOCK.alpha, BLOCK.frequency_parameter, restitution=BLOCK.inelastic_restitution)
    found, block = (one.response(MOTION, scale=0.7, thresholds=False) for one in (body, BLOCK))
    assert found.peak_rotation == pytest.approx(block.peak_rotation, rel=1e-9, nan_ok=True)
    linear = rocking.EquivalentBlock(0.3, 3.0, restitution=0.9, uplift_acceleration=2.5)
    mechanism = linear.response(MOTION, scale=1.2)
    groups = {"frequency_parameter": 3.0, "slenderness": 2.5 / (1.2 * MOTION.peak_acceleration), "restitution": 0.9}
    slender = rocking.peak_response(MOTION, **groups, vertical_scale=1.2)
    assert mechanism.outcome == slender.outcome
    assert mechanism.peak_rotation == pytest.approx(float(slender.peak_rotation), rel=1e-12, nan_ok=True)
    assert mechanism.thresholds is not None
