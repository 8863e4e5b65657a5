"""Motion of floors: against lsim, closed forms, limits, and the stated interpolation error."""

import numpy as np
import pytest
from scipy.signal import lsim

import rocking
from rocking._base.errors import InvalidArgumentError
from rocking._excitation.records.floor import floor_motion, isolated_motion

rng = np.random.default_rng(3)
NOISE = np.concatenate([np.zeros((2, 1)), rng.normal(size=(2, 299))], axis=1)
GROUND = rocking.Record(NOISE[0], 0.01, "m/s2", "noise", "made up", vertical=0.1 * NOISE[1])


def test_modes_agree_with_lsim():
    periods, damping, gamma = np.array([0.4, 0.09]), np.array([0.05, 0.9]), np.array([1.3, -0.4])
    floor = floor_motion(GROUND, periods=periods, damping=damping, participation=gamma)
    ground = np.where(floor.times <= GROUND.duration, np.interp(floor.times, GROUND.times, GROUND.acceleration), 0.0)
    expected = (1.0 - gamma.sum()) * ground
    for omega, zeta, factor in zip(2.0 * np.pi / periods, damping, gamma, strict=True):
        system = [2.0 * zeta * omega, omega**2], [1.0, 2.0 * zeta * omega, omega**2]
        expected += factor * lsim(system, ground, floor.times)[1]
    during = floor.times <= GROUND.duration + 1e-9  # lsim has a ramp where the ground stops at once
    np.testing.assert_allclose(floor.acceleration[during], expected[during], atol=1e-11)


def test_a_step_of_the_ground_gives_the_closed_form_and_rings_out_after_it():
    step = rocking.Record(np.ones(401), 0.005, "m/s2")
    omega, zeta = 2.0 * np.pi / 0.5, 0.1
    floor = isolated_motion(step, period=0.5, damping=zeta)
    damped = omega * np.sqrt(1.0 - zeta**2)

    # absolute acceleration q'' + 1 for q(0) = q'(0) = 0 (Chopra, section 4.3)
    def response(t):
        shape = np.cos(damped * t) - zeta / np.sqrt(1.0 - zeta**2) * np.sin(damped * t)
        return np.where(t < 0.0, 0.0, 1.0 - np.exp(-zeta * omega * t) * shape)

    expected = response(floor.times) - response(floor.times - step.duration)
    np.testing.assert_allclose(floor.acceleration, expected, atol=1e-12)
    assert floor.duration == pytest.approx(step.duration + 5.0)


@pytest.mark.parametrize("tolerance", [1e-2, 1e-4])
def test_the_interpolation_error_is_within_the_tolerance(tolerance):
    floor = floor_motion(GROUND, periods=0.15, relative_tolerance=tolerance, tail=0.5)
    finest = floor_motion(GROUND, periods=0.15, relative_tolerance=1e-6, tail=0.5)
    between = np.interp(finest.times, floor.times, floor.acceleration)
    error = np.abs(between - finest.acceleration).max()
    assert error <= 1.05 * tolerance * floor.peak_acceleration
    assert float(floor.source.split(" to ")[-1].split()[0]) == pytest.approx(error, rel=0.15)


def test_a_stiff_structure_follows_the_ground_and_a_soft_one_does_not():
    stiff = floor_motion(GROUND, periods=1e-3, damping=0.7, relative_tolerance=0.1)
    at_samples = stiff.acceleration[:: round(GROUND.time_step / stiff.time_step)][: GROUND.samples]
    np.testing.assert_allclose(at_samples, GROUND.acceleration, atol=0.02)
    assert isolated_motion(GROUND, period=50.0, damping=0.05).peak_acceleration < 0.02 * GROUND.peak_acceleration


def test_the_vertical_component_is_passed_through_or_filtered():
    passed, filtered = (floor_motion(GROUND, periods=0.2, vertical=how) for how in ("pass", "filter"))
    each = round(GROUND.time_step / passed.time_step)
    np.testing.assert_allclose(passed.vertical[::each][: GROUND.samples], GROUND.vertical, rtol=1e-13)
    assert not passed.vertical[GROUND.samples * each :].any()
    alone = floor_motion(rocking.Record(GROUND.vertical, 0.01, "m/s2"), periods=0.2, relative_tolerance=1e-4)
    ratio = round(filtered.time_step / alone.time_step)
    np.testing.assert_allclose(filtered.vertical, alone.acceleration[::ratio][: filtered.samples], atol=1e-12)


@pytest.mark.parametrize(
    "given",
    [{"periods": 0.0}, {"periods": []}, {"periods": [0.1, 0.2], "damping": [0.1] * 3}, {"periods": 1.0, "damping": 1.0},
     {"periods": 1.0, "vertical": "drop"}, {"periods": 1.0, "tail": 1e5}, {"periods": 0.1, "tail": 1e4}],
)  # fmt: skip
def test_refusals(given):
    with pytest.raises(InvalidArgumentError, match="relative_tolerance" if given.get("tail") == 1e4 else "allowed"):
        floor_motion(GROUND, **given)
