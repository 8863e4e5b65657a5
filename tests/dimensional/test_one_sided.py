"""Bodies that rock about one edge only, `sides=` of `rocking.RigidBody`; the kernels are compared in test_bodies."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import rocking
from rocking import Outcome, RigidBody

FACADE = RigidBody.from_size(0.6, 6.0, offset=0.05)
MOTION = {"peak_acceleration": 3.0, "period": 1.2}


@given(st.floats(0.0, 1.0), st.sampled_from(["sine", "cosine", "ricker"]), st.floats(1.2, 6.0), st.floats(0.3, 2.0))
def test_left_under_the_mirrored_pulse_is_right(rebound: float, name: str, strength: float, period: float) -> None:
    left = RigidBody(left=0.2, right=0.3, height=1.0, sides="left", rebound=rebound)
    right = RigidBody(left=0.3, right=0.2, height=1.0, sides="right", rebound=rebound)
    peak = strength * float(right.uplift_acceleration)
    assert left.uplift_acceleration == right.uplift_acceleration == pytest.approx(9.80665 * 0.2)
    one = left.response(f"-{name}", peak_acceleration=peak, period=period, thresholds=False)
    other = right.response(name, peak_acceleration=peak, period=period, thresholds=False)
    assert (one.outcome, one.impacts) == (other.outcome, other.impacts)
    np.testing.assert_allclose(one.rotation_left, other.rotation_right, rtol=1e-12)
    assert one.rotation_right == other.rotation_left == 0.0 or one.overturned


def test_pulse_and_its_samples_agree() -> None:
    pulse = rocking.pulse("cosine")
    phases = np.union1d(np.linspace(pulse.start, pulse.end, 8001), pulse.stationary)
    sampled = rocking.SampledPulse(pulse.shape(phases), phases, 2.0 * np.pi)
    wall = FACADE.one_sided("left", np.linspace(0.0, 0.9, 10))
    exact = wall.response("cosine", **MOTION)
    close = wall.response(sampled, **MOTION)
    np.testing.assert_array_equal(exact.outcome, close.outcome)
    np.testing.assert_allclose(exact.rotation, close.rotation, rtol=1e-5)
    assert len(np.unique(exact.rotation)) > 3  # the rebound matters


def test_history_is_that_of_two_edges_until_the_first_impact() -> None:
    times = {"duration": 6.0, "samples": 3001}
    both, wall = (body.history("cosine", **MOTION, **times) for body in (FACADE, FACADE.one_sided("left", 0.7)))
    first = int(np.argmax(both["rotation"].values > 0.0))
    assert 10 < first < 3000
    np.testing.assert_allclose(wall["rotation"][:first], both["rotation"][:first], rtol=0, atol=1e-12)
    assert wall["rotation"].values.max() <= 0.0
    assert both["rotation"].values.max() > 0.01


def test_without_restitution_it_rests_at_the_first_impact_and_with_one_it_never_does() -> None:
    pulse = {"peak_acceleration": 2.0, "period": 1.2}

    def turning_points(rebound: float) -> np.ndarray:
        found = FACADE.one_sided("left", rebound).history("half_sine", **pulse, duration=30.0, samples=40_001)
        free = np.abs(found["rotation"].values[found["time"].values > found.attrs["motion_end"]])
        return free[1:-1][(free[1:-1] > free[:-2]) & (free[1:-1] >= free[2:])]

    assert len(turning_points(0.0)) <= 1
    elastic = turning_points(1.0)
    assert len(elastic) > 3
    np.testing.assert_allclose(elastic, elastic[0], rtol=1e-6)
    damped = turning_points(0.6)
    assert np.all(np.diff(damped[:4]) < 0.0)


def test_thresholds_are_where_the_outcome_changes() -> None:
    wall = FACADE.one_sided("right", 0.8)
    around = wall.thresholds("sine", period=1.2)[0].value * (1.0 + np.array([-1e-6, 1e-6]))
    assert wall.response("sine", peak_acceleration=around, period=1.2).overturned.tolist() == [False, True]


def test_default_rebound_is_a_half_for_a_slender_wall() -> None:
    thin = RigidBody.from_size(0.01, 10.0).one_sided("right")
    assert float(thin.right.restitution) == pytest.approx(0.5, abs=1e-5)
    sine = np.sin(float(FACADE.one_sided("left").left.alpha)) ** 2
    expected = -((1.0 - 1.5 * sine) ** 2) * (1.0 - 1.5 * (1.0 - sine))
    assert float(FACADE.one_sided("left").left.restitution) == pytest.approx(expected, rel=1e-12)
    assert float(RigidBody.from_size(2.0, 1.0).one_sided("right").right.restitution) == 0.0


def test_derived_bodies_keep_their_wall() -> None:
    wall = FACADE.one_sided("right", 0.4)
    for other in (wall.scaled(2.0), wall.tilted("1 deg")):
        assert other.sides == "right"
        assert other.parameters["rebound"] == 0.4
    assert wall != FACADE
    assert wall != FACADE.one_sided("left", 0.4)
    assert "right edge only" in repr(wall)
    assert not wall.contact_is_known


def test_impacts_that_accumulate_end_in_rest() -> None:
    """Without the rule each rest takes thousands of impacts, and beyond the limit bodies rest at the next one."""
    shape = np.convolve(np.random.default_rng(1).standard_normal(1500), np.ones(6), "same")
    walls = RigidBody(np.linspace(0.1, 0.4, 40), 0.3, 2.0, sides="left", rebound=0.9)
    found = walls.response(rocking.Record(shape, 0.01, "m/s2"), scale=0.5)
    assert 10 < found.impacts.max() < 2000


@pytest.mark.parametrize(
    "text",
    [
        "rectangle(width=40cm, height=1.6m",
        "offset_mass(width=40cm, height=1.6m, offset=5cm",
        "two_edges(left=15cm, right=25cm, mass_height=80cm, inclination=1deg",
        "cylinder(diameter=40cm, height=1.6m",
        "hollow(width=40cm, height=1.6m, wall=2cm",
        "on_pedestal(width=30cm, height=1m, pedestal_width=40cm, pedestal_height=60cm, pedestal_mass=2",
        "outline(vertices=0 0; 0.4 0; 0.4 1.6; 0 1.5",
    ],
)
def test_every_rigid_kind_may_stand_against_a_wall(text: str) -> None:
    made, rigid = rocking.body(f"{text}, sides=left, rebound=0.4)"), rocking.body(f"{text}, sides=both)")
    if not isinstance(rigid, RigidBody):
        rigid = RigidBody.from_size(0.4, 1.6)
    assert made == rigid.one_sided("left", 0.4)


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: rocking.body("rectangle", width=0.4, height=1.6, sides="up"), "sides"),
        (lambda: rocking.body("rectangle", width=0.4, height=1.6, rebound=0.4), "rebound"),
        (lambda: rocking.body("frame", width=0.4, height=1.6, mass_ratio=2.0, sides="left"), "sides"),
        (lambda: RigidBody(left=0.1, right=0.1, height=1.0, rebound=0.5), "rebound"),
        (lambda: FACADE.one_sided("right", 1.1), "rebound"),
        (lambda: FACADE.one_sided("top"), "sides"),
    ],
)
def test_refused(make: Callable[[], object], said: str) -> None:
    with pytest.raises(rocking.InvalidArgumentError, match=said):
        make()


def test_outcome_after_a_rebound() -> None:
    """A body that comes down fast at the end of the motion may overturn after the rebound."""
    wall = FACADE.one_sided("right", np.linspace(0.0, 1.0, 101)[:, None])
    found = wall.response("-sine", peak_acceleration=np.linspace(1.5, 6.0, 200), period=1.5)
    counts = np.bincount(np.asarray(found.outcome).ravel(), minlength=4)
    assert counts[Outcome.OVERTURNED_AFTER_IMPACT] > 0
