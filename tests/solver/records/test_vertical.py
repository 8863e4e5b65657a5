"""Records with a vertical component: gravity, zero motion, scales, refusal where the body would fly, amplification."""

import math

import numpy as np
import pytest

import rocking
from rocking._base.constants import STANDARD_GRAVITY
from rocking._base.errors import InvalidArgumentError
from rocking._excitation.records.vertical import highest_vertical_scale
from tests.solver.records.tables import samples

ALPHAS = [None, 0.25]
PART = slice(700, 2700)
HORIZONTAL, VERTICAL = samples("napa_HNE")[PART], samples("napa_HNN")[PART]
MOTION = rocking.Record(HORIZONTAL, 0.005, "g", vertical=VERTICAL)
PLAIN = rocking.Record(HORIZONTAL, 0.005, "g")
GRID = {"frequency_parameter": 3.0, "slenderness": np.linspace(0.3, 1.3, 60), "restitution": 0.87}


@pytest.mark.parametrize("alpha", ALPHAS)
@pytest.mark.parametrize("c", [-0.5, 0.4])
def test_a_constant_vertical_acceleration_is_another_gravity(alpha: float | None, c: float) -> None:
    """With g (1 + c) the frequency parameter is sqrt(1 + c) times as large, the slenderness 1 + c times.

    Without the vertical component the slender block is solved by exact arcs, with it by Taylor steps.
    """
    f = np.append(HORIZONTAL, np.zeros(4000))  # it is at rest before the end
    lifted = rocking.Record(f, 0.005, "g", vertical=np.full(f.size, c))
    heavier = rocking.Record(f, 0.005, "g")
    found = rocking.peak_response(lifted, **GRID, alpha=alpha)
    p, s = GRID["frequency_parameter"] * math.sqrt(1.0 + c), GRID["slenderness"] * (1.0 + c)
    groups = {"frequency_parameter": p, "slenderness": s, "restitution": 0.87, "alpha": alpha}
    other = rocking.peak_response(heavier, **groups)
    np.testing.assert_array_equal(found.outcome, other.outcome)
    rocks = found.outcome == rocking.Outcome.RECOVERS
    assert rocks.sum() > 10
    amplification = rocking.suites.record_amplification(heavier, **groups)[rocks]
    error = np.abs(found.peak_rotation[rocks] / other.peak_rotation[rocks] - 1.0)
    assert (error <= 1000 * 2.2e-16 * np.maximum(amplification, 1.0)).all()


@pytest.mark.parametrize("alpha", ALPHAS)
def test_a_vertical_component_of_zeros_or_times_zero_changes_nothing(alpha: float | None) -> None:
    without = rocking.peak_response(PLAIN, **GRID, alpha=alpha)
    times_zero = rocking.peak_response(MOTION, **GRID, alpha=alpha, vertical_scale=0.0)
    zeros = rocking.peak_response(
        rocking.Record(HORIZONTAL, 0.005, "g", vertical=np.zeros(HORIZONTAL.size)), **GRID, alpha=alpha
    )
    np.testing.assert_array_equal(times_zero.peak_rotation, without.peak_rotation)
    np.testing.assert_array_equal(zeros.outcome, without.outcome)
    if alpha is None:  # Taylor steps instead of exact arcs: equal to rounding, bit by bit otherwise
        np.testing.assert_allclose(zeros.peak_rotation, without.peak_rotation, rtol=1e-10)
    else:
        np.testing.assert_array_equal(zeros.peak_rotation, without.peak_rotation)
        np.testing.assert_array_equal(zeros.first_impact_time, without.first_impact_time)


def test_the_scale_multiplies_the_vertical_component() -> None:
    scale = np.array([0.0, 0.5, 1.0, 2.0])[:, None]
    at_once = rocking.peak_response(MOTION, **GRID, alpha=0.25, vertical_scale=scale)
    assert at_once.shape == (4, 60)
    assert "vertical_scale" in at_once.groups
    for k in range(4):
        motion = rocking.Record(HORIZONTAL, 0.005, "g", vertical=float(scale[k, 0]) * VERTICAL)
        alone = rocking.peak_response(motion, **GRID, alpha=0.25)
        np.testing.assert_array_equal(at_once.outcome[k], alone.outcome)
        np.testing.assert_allclose(at_once.peak_rotation[k], alone.peak_rotation, rtol=1e-9)
    assert np.unique(at_once.peak_rotation[:, 20]).size == 4
    assert "vertical_scale" not in rocking.peak_response(PLAIN, **GRID).groups


def test_a_body_uplifts_where_the_ground_falls_away() -> None:
    """No uplift at slenderness 1.2 without the vertical component; with -0.5 g the ground has to reach 0.5 only."""
    shape = np.array([0.0, 1.0, 0.0, 0.0])
    motion = rocking.Record(shape, 0.1, "g", vertical=[0.0, -0.5, 0.0, 0.0])
    groups = {"frequency_parameter": 2.0, "slenderness": 1.2, "restitution": 0.9}
    assert rocking.peak_response(motion, **groups).outcome == rocking.Outcome.RECOVERS
    assert rocking.peak_response(motion, **groups, vertical_scale=0.0).outcome == rocking.Outcome.NO_UPLIFT
    found = rocking.peak_response(motion, **groups).uplift_time / 2.0
    assert found == pytest.approx(0.1 / (0.5 + 1.0 / 1.2), rel=1e-12)  # t/(1.2 dt) = 1 - 0.5 t/dt


def test_a_factor_at_which_the_body_would_fly_is_refused_with_the_time() -> None:
    motion = rocking.Record([0.0, 1.0, 0.0, -1.0, 0.0], 0.5, "g", vertical=[0.0, 0.3, -0.4, -0.8, 0.2])
    groups = {"frequency_parameter": 2.0, "slenderness": 0.9, "restitution": 0.9}
    limit = highest_vertical_scale(motion)
    assert limit == pytest.approx(1.25, rel=1e-6)
    assert limit < 1.25
    rocking.peak_response(motion, **groups, vertical_scale=limit)
    # -0.4 to -0.8 at a factor of 2 passes -1 at a quarter of the interval from 1 s to 1.5 s
    message = r"`vertical_scale` = 2.0 .* below 1\.25: with 2 .* -g at 1\.125 s, and -15\.69 m/s2 at 1\.5 s"
    for solve in (rocking.peak_response, rocking.time_history, rocking.suites.record_amplification):
        with pytest.raises(InvalidArgumentError, match=message):
            solve(motion, **groups, vertical_scale=2.0)
    with pytest.raises(InvalidArgumentError, match=r"with 1\.25 "):
        rocking.peak_response(motion, **groups, vertical_scale=[0.5, 1.25, 0.1])
    falls = rocking.Record([0.0, 1.0], 0.5, "m/s2", vertical=[-STANDARD_GRAVITY, 0.0])
    with pytest.raises(InvalidArgumentError, match="-g at 0 s"):
        rocking.peak_response(falls, **groups)


def test_a_factor_without_a_vertical_component_is_refused() -> None:
    for solve in (rocking.peak_response, rocking.suites.record_amplification):
        with pytest.raises(InvalidArgumentError, match=r"vertical_scale.*no vertical component"):
            solve(PLAIN, **GRID, vertical_scale=0.5)
    none = rocking.peak_response(PLAIN, **GRID, vertical_scale=None)
    np.testing.assert_array_equal(none.peak_rotation, rocking.peak_response(PLAIN, **GRID).peak_rotation)


def test_the_amplification_is_that_of_the_horizontal_motion() -> None:
    groups = {"frequency_parameter": 3.0, "restitution": 0.87, "alpha": 0.25, "vertical_scale": 1.5}
    slenderness = np.linspace(0.5, 1.2, 30)
    found = rocking.suites.record_amplification(MOTION, **groups, slenderness=slenderness)
    less, more = (
        rocking.peak_response(MOTION, **groups, slenderness=slenderness / (1.0 + change)).peak_rotation
        for change in (-1e-7, 1e-7)
    )
    rocks = np.isfinite(found) & (found < 1e3)
    assert rocks.sum() > 5
    relative = (np.abs(more - less) / (more + less + 1e-300) / 1e-7)[rocks]
    np.testing.assert_allclose(relative, found[rocks], rtol=1e-3)


@pytest.mark.parametrize("alpha", ALPHAS)
@pytest.mark.parametrize("seed", range(3))
def test_strong_vertical_motions_are_solved(alpha: float | None, seed: int) -> None:
    """Close to flight, and pressed down by up to 100 g, outcomes are found and free of nan where the body survives."""
    rng = np.random.default_rng(seed)
    f = rng.uniform(-1.0, 1.0, 400)
    vertical = np.where(rng.random(400) < 0.5, -1.0 + 10.0 ** rng.uniform(-9, 0, 400), 10.0 ** rng.uniform(-2, 2, 400))
    motion = rocking.Record(f, 0.01, "g", vertical=vertical)
    found = rocking.peak_response(
        motion, frequency_parameter=[[0.5], [3.0], [20.0]], slenderness=np.geomspace(0.01, 100.0, 40), restitution=0.9,
        alpha=alpha,
    )  # fmt: skip
    assert (np.isnan(found.peak_rotation) == found.overturned).all()
    assert 0 < found.overturned.sum() < found.overturned.size
