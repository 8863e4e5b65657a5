"""Planted wavelets are found again."""

import math

import numpy as np
import pytest

from rocking._base.errors import InvalidArgumentError
from rocking.suites.velocity_pulses import FAMILIES, VelocityPulse, fit_velocity
from tests.sampling import but_long

STEP = 0.01
TIME = np.arange(2500) * STEP
MP = "mavroeidis_papageorgiou"


def noisy(values, decibel, seed):
    """With white noise whose power is that many decibels below the mean power of the values."""
    level = 10.0 ** (-decibel / 20.0) * math.sqrt(float(values @ values) / values.size)
    return values + level * np.random.default_rng(seed).standard_normal(values.size)


def planted(family, seed):
    draw = np.random.default_rng(seed)
    period, centre = math.exp(draw.uniform(math.log(0.4), math.log(5.0))), draw.uniform(7.0, 17.0)
    if FAMILIES[family].has_cycles:
        return VelocityPulse(family, period, centre, draw.uniform(1.1, 4.0), draw.uniform(-3.1, 3.1), 0.8, 1.0)
    return VelocityPulse(family, period, centre, math.nan, math.nan, 0.8 * draw.choice([-1, 1]), 1.0)


def angle_between(one, other):
    return abs((one - other + math.pi) % (2.0 * math.pi) - math.pi)


@pytest.mark.parametrize("seed", but_long(range(12), 0, 1, 2))
@pytest.mark.parametrize("family", FAMILIES)
def test_planted_pulse_is_found_in_noise_of_40_decibel(family, seed):
    pulse = planted(family, seed)
    found = fit_velocity(noisy(pulse.velocity(TIME), 40.0, seed), STEP, family)
    assert found.period == pytest.approx(pulse.period, rel=0.01)
    assert found.centre == pytest.approx(pulse.centre, abs=0.01 * pulse.period)
    assert found.amplitude == pytest.approx(pulse.amplitude, rel=0.01)
    assert found.explained == pytest.approx(1.0 - 1e-4, abs=1e-4)
    if family == MP:
        assert angle_between(found.phase, pulse.phase) < 0.02
        assert found.cycles == pytest.approx(pulse.cycles, rel=0.02)


@pytest.mark.parametrize("seed", but_long(range(6), 0, 1))
def test_planted_pulse_is_found_in_noise_of_the_acceleration(seed):
    pulse = planted(MP, seed)
    shape, peak = pulse.acceleration_pulse()
    a = noisy(peak * shape.acceleration(2 * math.pi / pulse.period * (TIME - pulse.centre)), 40.0, seed)
    velocity = np.concatenate([[0.0], np.cumsum(0.5 * STEP * (a[1:] + a[:-1]))])
    found = fit_velocity(velocity, STEP, MP)
    assert found.period == pytest.approx(pulse.period, rel=0.01)
    assert angle_between(found.phase, pulse.phase) < 0.02


@pytest.mark.parametrize("family", FAMILIES)
def test_acceleration_is_the_derivative_of_the_velocity(family):
    pulse = planted(family, 3)
    shape, peak = pulse.acceleration_pulse()
    time = pulse.centre + pulse.period * np.linspace(-0.9, 0.9, 301)
    step = 1e-5 * pulse.period
    slope = (pulse.velocity(time + step) - pulse.velocity(time - step)) / (2.0 * step)
    phi = 2.0 * math.pi / pulse.period * (time - pulse.centre)
    np.testing.assert_allclose(peak * shape.acceleration(phi), slope, atol=1e-7 * peak)


def test_amplitude_and_time_scale_the_fit():
    velocity = noisy(planted(MP, 1).velocity(TIME), 20.0, 4)
    one, other = fit_velocity(velocity, STEP, MP), fit_velocity(-3.0 * velocity, 0.5 * STEP, MP)
    assert other.period == pytest.approx(0.5 * one.period, rel=1e-6)
    assert other.amplitude == pytest.approx(3.0 * one.amplitude, rel=1e-6)
    assert angle_between(other.phase, one.phase + math.pi) < 1e-5
    assert other.explained == pytest.approx(one.explained, abs=1e-9)


def test_explained_share_is_that_of_the_fitted_velocity():
    velocity = noisy(planted(MP, 1).velocity(TIME), 3.0, 4)
    found = fit_velocity(velocity, STEP, MP)
    residual = velocity - found.velocity(TIME)
    assert found.explained == pytest.approx(1.0 - residual @ residual / (velocity @ velocity), abs=1e-9)
    assert 0.5 < found.explained < 0.9


@pytest.mark.parametrize("velocity", [np.ones(10), np.zeros(100), np.full(100, np.nan)])
def test_velocity_without_a_pulse_is_refused(velocity):
    with pytest.raises(InvalidArgumentError, match="record"):
        fit_velocity(velocity, STEP, MP)
