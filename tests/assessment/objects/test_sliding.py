"""Displacement of a sliding block against closed forms."""

import math

import numpy as np
import pytest
from numpy.typing import NDArray
from rocking_assessment._objects.site import Motion
from rocking_assessment._objects.sliding import largest_slip, sliding_displacement

import rocking
from rocking._base.constants import STANDARD_GRAVITY
from rocking._excitation.pulses import as_pulse
from rocking._excitation.records.record import Record

Array = NDArray[np.float64]


def test_rectangular_pulse_in_closed_form() -> None:
    friction, peak, period = 0.2, 5.0, 0.6
    speed, resistance = peak * 0.5 * period, friction * STANDARD_GRAVITY
    slip = sliding_displacement(Motion("", as_pulse("rectangular"), peak, period, 0, peak), friction)
    assert slip == pytest.approx(speed**2 / (2.0 * resistance) * (1.0 - resistance / peak), rel=1e-12)  # Newmark (1965)


def test_triangle_in_closed_form() -> None:
    # 0, 2, 0 at 0, 1, 2 s with resistance 1: it starts at 0.5 s with v' = -(a - 1), and stops after 1.5 s
    times, acceleration = np.array([0.0, 1.0, 2.0]), np.array([0.0, 2.0, 0.0])
    speed = 0.5  # at 1.5 s, where a falls below 1
    # v at 1.5 + t: -speed + t^2, to 2 s; then constant deceleration 1
    at_end = speed - 0.25
    slip = 0.25 + (speed * 0.5 - 0.5**3 / 3.0) + at_end**2 / 2.0
    assert largest_slip(times, acceleration, np.ones(3), 1.0) == pytest.approx(slip, rel=1e-12)


def test_mirrored_motion_slides_as_far_and_weak_motion_not_at_all() -> None:
    rng = np.random.default_rng(4)
    times, acceleration = np.arange(200) * 0.05, rng.normal(size=200)
    resistance = 0.5 + 0.3 * rng.random(200)
    slip = largest_slip(times, acceleration, resistance, 0.5)
    assert largest_slip(times, -acceleration, resistance, 0.5) == slip > 0.0
    assert largest_slip(times, acceleration, np.abs(acceleration).max() + resistance, 0.5) == 0.0


def slip_by_small_steps(times: Array, acceleration: Array, resistance: Array, at_end: float) -> float:
    fine = np.arange(0.0, 2.0 * times[-1], 2e-5)
    slip = velocity = largest = 0.0
    for a, held in zip(
        np.interp(fine, times, acceleration, right=0.0).tolist(),
        np.interp(fine, times, resistance, right=at_end).tolist(),
        strict=True,
    ):
        if velocity == 0.0:
            change = -math.copysign(max(abs(a) - held, 0.0), a) * 2e-5
        else:
            change = (-a - math.copysign(held, velocity)) * 2e-5
        new = velocity + change
        velocity = 0.0 if new * velocity < 0.0 else new
        slip += velocity * 2e-5
        largest = max(largest, abs(slip))
    return largest


@pytest.mark.parametrize("vertical", [0.0, 0.3, 0.9])
def test_linear_pieces_agree_with_small_steps(vertical: float) -> None:
    rng = np.random.default_rng(9)
    acceleration = 2.0 * rng.normal(size=(2, 60))
    upwards = np.maximum(vertical * acceleration[1], -0.95 * STANDARD_GRAVITY)
    record = Record(acceleration[0], 0.1, "m/s2", vertical=upwards)
    slip = sliding_displacement(Motion("", record, record.peak_acceleration, 1.0, 0, record.peak_acceleration), 0.07)
    resistance = 0.07 * (STANDARD_GRAVITY + upwards)
    expected = slip_by_small_steps(record.times, acceleration[0], resistance, 0.07 * STANDARD_GRAVITY)
    assert slip == pytest.approx(expected, rel=2e-3)


def test_a_sampled_pulse_slides_as_the_record_of_its_samples() -> None:
    samples = [0.0, 3.0, -4.0, 2.0, -1.0, 0.0]
    record = Record(samples, 0.2, "m/s2")
    pulse = rocking.SampledPulse(samples)
    slips = [sliding_displacement(Motion("", motion, 4.0, 1.0, 0, 4.0), 0.1) for motion in (record, pulse)]
    assert slips[1] == pytest.approx(slips[0], rel=1e-9)


def test_vertical_component_that_unloads_the_block_lets_it_slide_further() -> None:
    # a = 2 for 1 s; mu (g + w) falls from 1 to 0, so that v' = -2 + (1 - t): v = -1.5 at 1 s, then back at 1
    times, resistance = np.array([0.0, 1.0, 1.0 + 1e-12]), np.array([1.0, 0.0, 1.0])
    slip = largest_slip(times, np.array([2.0, 2.0, 0.0]), resistance, 1.0)
    assert slip == pytest.approx(1.0 - 1.0 / 2.0 + 1.0 / 6.0 + 1.5**2 / 2.0, rel=1e-9)
