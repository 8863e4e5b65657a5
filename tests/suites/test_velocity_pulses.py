"""Pulses fitted to records: planted wavelets are found again, and overturn as the record."""

import math

import numpy as np
import pytest

import rocking
from rocking._base.errors import InvalidArgumentError
from rocking.suites.velocity_pulses import FAMILIES, VelocityPulse, fit_velocity
from tests.sampling import but_long, number
from tests.suites.motions import BLOCK, noise, sampled

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


def angle_between(angle, other):
    return abs((angle - other + math.pi) % (2.0 * math.pi) - math.pi)


@pytest.mark.parametrize("seed", but_long(range(12), 0, 1, 2))
@pytest.mark.parametrize("family", FAMILIES)
def test_planted_pulse_is_found_in_noise_of_40_decibel(family, seed):
    pulse = planted(family, seed)
    fit = fit_velocity(noisy(pulse.velocity(TIME), 40.0, seed), STEP, family)
    assert fit.period == pytest.approx(pulse.period, rel=0.01)
    assert fit.centre == pytest.approx(pulse.centre, abs=0.01 * pulse.period)
    assert fit.amplitude == pytest.approx(pulse.amplitude, rel=0.01)
    assert fit.explained == pytest.approx(1.0 - 1e-4, abs=1e-4)
    if family == MP:
        assert angle_between(fit.phase, pulse.phase) < 0.02
        assert fit.cycles == pytest.approx(pulse.cycles, rel=0.02)


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
    fit, scaled = fit_velocity(velocity, STEP, MP), fit_velocity(-3.0 * velocity, 0.5 * STEP, MP)
    assert scaled.period == pytest.approx(0.5 * fit.period, rel=1e-6)
    assert scaled.amplitude == pytest.approx(3.0 * fit.amplitude, rel=1e-6)
    assert angle_between(scaled.phase, fit.phase + math.pi) < 1e-5
    assert scaled.explained == pytest.approx(fit.explained, abs=1e-9)


def test_explained_share_is_that_of_the_fitted_velocity():
    velocity = noisy(planted(MP, 1).velocity(TIME), 3.0, 4)
    fit = fit_velocity(velocity, STEP, MP)
    residual = velocity - fit.velocity(TIME)
    assert fit.explained == pytest.approx(1.0 - residual @ residual / (velocity @ velocity), abs=1e-9)
    assert 0.5 < fit.explained < 0.9


@pytest.mark.parametrize("velocity", [np.ones(10), np.zeros(100), np.full(100, np.nan)])
def test_velocity_without_a_pulse_is_refused(velocity):
    with pytest.raises(InvalidArgumentError, match="record"):
        fit_velocity(velocity, STEP, MP)


def record_of(name, period, step=0.005, peak=2.0, lead=400, **parameters):
    """A record of a pulse of the catalogue after `lead` samples of rest."""
    pulse = rocking.pulse(name, **parameters)
    phi = np.arange(pulse.start, pulse.end, 2 * math.pi * step / period)
    zeros = np.zeros(lead)
    return rocking.Record(np.concatenate([zeros, peak * pulse.acceleration(phi), zeros]), step, "m/s2", name)


@pytest.mark.parametrize("name", ["ricker", "-ricker", "ricker_antisymmetric", "-ricker_antisymmetric"])
def test_ricker_wavelets_are_recognised(name):
    fit = rocking.suites.fit_pulse(record_of(name, 1.2), blocks=[])
    assert fit.pulse.name == name
    assert fit.period == pytest.approx(1.2, rel=1e-3)
    assert fit.peak_acceleration == pytest.approx(2.0, rel=1e-3)
    assert fit.explained > 0.9999


@pytest.mark.parametrize(("cycles", "phase"), [(1.2, 0.5), (2.0, -2.0), (3.1, 1.4)])
def test_pulse_of_a_record_overturns_as_the_record(cycles, phase):
    record = record_of("mavroeidis_papageorgiou", 0.9, cycles=cycles, phase=phase)
    fit = rocking.suites.fit_pulse(record, blocks=BLOCK)
    assert fit.velocity.cycles == pytest.approx(cycles, rel=1e-2)
    assert fit.velocity.phase == pytest.approx(phase, abs=0.02)
    assert fit.scale_ratio == pytest.approx([1.0], abs=0.01)
    error = fit.acceleration(record.times) - record.acceleration
    assert np.abs(error).max() < 0.02 * record.peak_acceleration


def test_fit_describes_a_record_and_gives_the_ratio_of_scales():
    record = noise(3, 600, 0.02)
    fit = rocking.suites.fit_pulse(record)
    assert 0.2 < fit.explained < 1.0
    assert [block.half_diagonal for block in fit.blocks] == pytest.approx([1.0, 4.0, 16.0])
    assert np.isfinite(fit.scale_ratio).all()
    assert "times the record" in repr(fit)
    for family in number(("ricker",), ("ricker", "ricker_antisymmetric", "mavroeidis_papageorgiou")):
        assert rocking.suites.fit_pulse(record, family=family, blocks=[]).explained <= fit.explained + 1e-12


def test_thresholds_of_a_sampled_sine_are_its_critical_amplitudes():
    record = sampled("sine", 4.0, samples=8000)
    block = {"restitution": BLOCK.inelastic_restitution, "alpha": BLOCK.alpha}
    exact = rocking.thresholds("sine", frequency_ratio=4.0, **block, highest=10.0)
    thresholds = BLOCK.thresholds(record)
    amplitude = thresholds.value * record.peak_acceleration / BLOCK.uplift_acceleration
    np.testing.assert_allclose(amplitude, exact.amplitude, rtol=1e-4)
    assert thresholds.overturns_above.tolist() == exact.overturns_above.tolist() == [True, False, True]
    assert thresholds.searched[1] == pytest.approx(10.0 * thresholds.searched[0])


@pytest.mark.parametrize("wrong", [{"record": 1.0}, {"family": "gabor"}, {"blocks": [0.2]}])
def test_invalid_arguments_are_named(wrong):
    with pytest.raises(InvalidArgumentError, match=f"`{next(iter(wrong))}`"):
        rocking.suites.fit_pulse(**{"record": noise(0)} | wrong)


def test_a_weak_record_is_fitted():
    strong = record_of("ricker", 1.2)
    weak = rocking.Record(1e-4 * strong.acceleration, strong.time_step, "m/s2")
    fit = rocking.suites.fit_pulse(weak, blocks=[rocking.Block(0.4, 1.6)])
    assert fit.pulse.name == "ricker"
    assert fit.peak_acceleration == pytest.approx(2e-4, rel=1e-3)
