"""Displacement of a sliding block against closed forms."""

import math

import numpy as np
import pytest

from rocking._assessment.site import Motion
from rocking._assessment.sliding import largest_slip, sliding_displacement
from rocking._base.constants import STANDARD_GRAVITY
from rocking._excitation.pulses import as_pulse


def test_rectangular_pulse_in_closed_form() -> None:
    friction, peak, period = 0.2, 5.0, 0.6
    speed, resistance = peak * 0.5 * period, friction * STANDARD_GRAVITY
    found = sliding_displacement(Motion("", as_pulse("rectangular"), peak, period, 0, peak), friction)
    assert found == pytest.approx(
        speed**2 / (2.0 * resistance) * (1.0 - resistance / peak), rel=1e-12
    )  # Newmark (1965)


def test_triangle_in_closed_form() -> None:
    # 0, 2, 0 at 0, 1, 2 s with resistance 1: it starts at 0.5 s with v' = -(a - 1), and stops after 1.5 s
    times, acceleration = np.array([0.0, 1.0, 2.0]), np.array([0.0, 2.0, 0.0])
    speed = 0.5  # at 1.5 s, where a falls below 1
    # v at 1.5 + t: -speed + t^2, to 2 s; then constant deceleration 1
    at_end = speed - 0.25
    slip = 0.25 + (speed * 0.5 - 0.5**3 / 3.0) + at_end**2 / 2.0
    assert largest_slip(times, acceleration, 1.0) == pytest.approx(slip, rel=1e-12)


def test_mirrored_motion_slides_as_far_and_weak_motion_not_at_all() -> None:
    rng = np.random.default_rng(4)
    times, acceleration = np.arange(200) * 0.05, rng.normal(size=200)
    assert largest_slip(times, -acceleration, 0.5) == largest_slip(times, acceleration, 0.5) > 0.0
    assert largest_slip(times, acceleration, float(np.abs(acceleration).max())) == 0.0


def test_linear_pieces_agree_with_small_steps() -> None:
    rng = np.random.default_rng(9)
    times, acceleration, resistance = np.arange(60) * 0.1, 2.0 * rng.normal(size=60), 0.7
    fine = np.arange(0.0, 12.0, 2e-5)
    slip = velocity = largest = 0.0
    for a in np.interp(fine, times, acceleration, right=0.0).tolist():
        if velocity == 0.0:
            change = -math.copysign(max(abs(a) - resistance, 0.0), a) * 2e-5
        else:
            change = (-a - math.copysign(resistance, velocity)) * 2e-5
        new = velocity + change
        velocity = 0.0 if new * velocity < 0.0 else new
        slip += velocity * 2e-5
        largest = max(largest, abs(slip))
    assert largest_slip(times, acceleration, resistance) == pytest.approx(largest, rel=2e-3)
