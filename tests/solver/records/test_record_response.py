"""Responses under records: order of convergence to pulses, invariances, chatter, limits, arguments."""

import numpy as np
import pytest

import rocking
from tests.solver.records.tables import record

MOTION = record("synthetic_31", 0.01)
ALPHAS = [None, 0.25]
GRID = {"frequency_parameter": 2.3, "slenderness": np.linspace(0.15, 1.05, 46), "restitution": 0.87}


@pytest.mark.parametrize("alpha", ALPHAS)
@pytest.mark.parametrize(("omega", "slenderness", "eta"), [(5.0, 0.4, 0.85), (8.0, 0.3, 0.9)])
def test_a_sine_sampled_ever_finer_converges_with_second_order(
    omega: float, slenderness: float, eta: float, alpha: float | None
) -> None:
    exact = rocking.peak_response(
        "sine", slenderness=slenderness, frequency_ratio=omega, restitution=eta, alpha=alpha
    ).peak_rotation
    errors = []
    for count in (64, 256, 1024):
        motion = rocking.Record(np.sin(2 * np.pi * np.arange(count + 1) / count), 1.0 / count, unit="m/s2")
        found = rocking.peak_response(
            motion, frequency_parameter=2 * np.pi / omega, slenderness=slenderness, restitution=eta, alpha=alpha
        )
        errors.append(abs(float(found.peak_rotation / exact) - 1.0))
    order = np.log2(errors[0] / errors[2]) / 4.0
    assert errors[2] < 1e-5
    assert 1.95 < order < 2.05


def responses_equal(first: rocking.Response, second: rocking.Response, rtol: float = 1e-9) -> None:
    np.testing.assert_array_equal(first.outcome, second.outcome)
    np.testing.assert_allclose(first.peak_rotation, second.peak_rotation, rtol=rtol)
    np.testing.assert_allclose(first.uplift_time, second.uplift_time, rtol=rtol)


@pytest.mark.parametrize("alpha", ALPHAS)
def test_interpolated_samples_change_nothing(alpha: float | None) -> None:
    """A motion that is linear between its samples is the same motion with more of them."""
    times = np.arange(3 * (MOTION.samples - 1) + 1) * (MOTION.time_step / 3)
    finer = rocking.Record(np.interp(times, MOTION.times, MOTION.acceleration), MOTION.time_step / 3, unit="m/s2")
    responses_equal(
        rocking.peak_response(MOTION, **GRID, alpha=alpha), rocking.peak_response(finer, **GRID, alpha=alpha), 1e-7
    )


@pytest.mark.parametrize("alpha", ALPHAS)
def test_the_opposite_motion_gives_the_mirror_image(alpha: float | None) -> None:
    mirrored = rocking.Record(-MOTION.acceleration, MOTION.time_step, unit="m/s2")
    first, second = (rocking.peak_response(motion, **GRID, alpha=alpha) for motion in (MOTION, mirrored))
    np.testing.assert_array_equal(first.peak_rotation, second.peak_rotation)
    np.testing.assert_array_equal(first.first_impact_velocity, -second.first_impact_velocity)


def test_time_and_amplitude_enter_through_the_groups_only() -> None:
    """Twice the step with half of p, and any amplitude with the same slenderness: the same bits."""
    slower = rocking.Record(4.0 * MOTION.acceleration, 2.0 * MOTION.time_step, unit="m/s2")
    first = rocking.peak_response(MOTION, **GRID)
    second = rocking.peak_response(slower, **(GRID | {"frequency_parameter": 1.15}))
    np.testing.assert_array_equal(first.peak_rotation, second.peak_rotation)


@pytest.mark.parametrize("alpha", ALPHAS)
def test_quiet_samples_before_and_after_change_nothing(alpha: float | None) -> None:
    padded = rocking.Record(np.pad(MOTION.acceleration, (777, 1000)), MOTION.time_step, unit="m/s2")
    first, second = (rocking.peak_response(motion, **GRID, alpha=alpha) for motion in (MOTION, padded))
    np.testing.assert_array_equal(first.outcome, second.outcome)
    np.testing.assert_allclose(first.peak_rotation, second.peak_rotation, rtol=1e-7)
    shift = 777 * 0.01 * 2.3
    np.testing.assert_allclose(first.uplift_time + shift, second.uplift_time, rtol=1e-12)


def test_a_tiny_angle_gives_the_slender_response() -> None:
    """Exact arcs and Taylor steps share neither formula nor search of events."""
    slender, rigid = (rocking.peak_response(MOTION, **GRID, alpha=alpha) for alpha in (None, 1e-9))
    responses_equal(slender, rigid, 1e-6)
    np.testing.assert_allclose(slender.first_impact_time, rigid.first_impact_time, rtol=1e-7)
    np.testing.assert_allclose(slender.first_impact_velocity, rigid.first_impact_velocity, rtol=1e-7)


@pytest.mark.parametrize("alpha", ALPHAS)
def test_a_coarse_motion_needs_several_taylor_steps_an_interval(alpha: float | None) -> None:
    """The triangle of 0, 1, -1, 0 at an interval of 3 in p t, against the same motion with 64 times the samples."""
    coarse = rocking.Record([0.0, 1.0, -1.0, 0.0], 1.0, unit="m/s2")
    times = np.arange(193) / 64
    fine = rocking.Record(np.interp(times, coarse.times, coarse.acceleration), 1.0 / 64, unit="m/s2")
    blocks = {"frequency_parameter": 3.0, "slenderness": np.linspace(0.3, 0.95, 14), "restitution": 0.6}
    responses_equal(
        rocking.peak_response(coarse, **blocks, alpha=alpha), rocking.peak_response(fine, **blocks, alpha=alpha)
    )


def test_a_block_that_passes_the_horizontal_inside_an_interval_has_overturned() -> None:
    # 1e11 g tan(alpha): the block would spin for millions of steps up to the next sample, and come back to the ground
    motion = rocking.Record([0.0, 1.0, -0.5, 0.3], 1.0, unit="m/s2")
    found = rocking.peak_response(motion, frequency_parameter=20.0, slenderness=1e-11, restitution=0.5, alpha=0.03)
    assert found.outcome == rocking.Outcome.OVERTURNED_DIRECTLY


@pytest.mark.parametrize("alpha", ALPHAS)
def test_a_constant_acceleration_that_ends_has_a_closed_form(alpha: float | None) -> None:
    """A rectangular pulse: samples 1, ..., 1, then zero after the last; it is the catalogue's rectangular pulse."""
    motion = rocking.Record(np.ones(51), 0.01, unit="m/s2")  # half a second
    p, s = 4.0, np.array([0.2, 0.4, 0.6, 0.9])
    found = rocking.peak_response(motion, frequency_parameter=p, slenderness=s, restitution=0.8, alpha=alpha)
    pulse = rocking.peak_response(
        "rectangular", slenderness=s, frequency_ratio=2 * np.pi / (2 * 0.5) / p, restitution=0.8, alpha=alpha
    )
    np.testing.assert_array_equal(found.outcome, pulse.outcome)
    np.testing.assert_allclose(found.peak_rotation, pulse.peak_rotation, rtol=1e-12)


def test_a_block_without_restitution_rests_after_each_impact() -> None:
    response = rocking.peak_response(MOTION, frequency_parameter=2.3, slenderness=0.5, restitution=0.0)
    assert response.outcome == rocking.Outcome.RECOVERS
    assert response.impacts > 3
    assert not response.chatter
    assert response.peak_mode // 65536 > 0  # uplifted again


def test_a_perfectly_elastic_block_ends() -> None:
    for alpha in ALPHAS:
        response = rocking.peak_response(
            MOTION, frequency_parameter=2.3, slenderness=[0.9, 0.999], restitution=1.0, alpha=alpha
        )
        assert (response.outcome == rocking.Outcome.RECOVERS).all()


def test_a_motion_that_starts_with_a_jump_lifts_the_block_at_once() -> None:
    motion = rocking.Record([1.0, 0.5, 0.0], 0.05, unit="g")
    response = rocking.peak_response(motion, frequency_parameter=3.0, slenderness=0.4, restitution=0.8)
    assert response.uplift_time == 0.0
    assert response.outcome == rocking.Outcome.RECOVERS


def test_arguments_broadcast_and_slender_and_rigid_blocks_mix() -> None:
    p, s = np.array([1.5, 2.5])[:, None, None], np.array([0.3, 0.6, 0.9])[:, None]
    response = rocking.peak_response(MOTION, frequency_parameter=p, slenderness=s, restitution=0.8, alpha=[0.0, 0.3])
    assert response.shape == (2, 3, 2)
    single = rocking.peak_response(MOTION, frequency_parameter=2.5, slenderness=0.6, restitution=0.8, alpha=0.3)
    assert response.peak_rotation[1, 1, 1] == single.peak_rotation
    empty = rocking.peak_response(MOTION, frequency_parameter=2.0, slenderness=[], restitution=0.8)
    assert empty.shape == (0,)


@pytest.mark.parametrize("alpha", [None, 0.2, 1.2])
def test_a_sample_that_just_uplifts_the_block(alpha):
    """Where |u| = 1 within rounding at a sample, flights of an inelastic block followed each other without end."""
    rng = np.random.default_rng(3)
    levels = np.array([-1.5, -1.0, -1 - 2**-52, -0.5, 0.0, 0.5, 1 - 2**-53, 1.0, 1 + 2**-52, 1.5])
    for _ in range(60):
        samples = np.append(rng.choice(levels, rng.integers(3, 12)), 1.5)
        motion = rocking.Record(samples, float(rng.choice([0.005, 0.1, 1.0])), unit="m/s2")
        ties = np.unique(np.abs(samples[samples != 0.0])) / 1.5
        found = rocking.peak_response(
            motion,
            frequency_parameter=float(rng.choice([0.5, 2.0, 5.0])),
            slenderness=np.concatenate([ties, np.nextafter(ties, 0.0), np.nextafter(ties, 2.0)])[:, None],
            restitution=[0.0, 0.5],
            alpha=alpha,
        )
        assert np.array_equal(np.isnan(found.peak_rotation), found.overturned)
