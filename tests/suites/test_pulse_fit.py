"""Pulses fitted to records, and their comparison with the record."""

import math

import numpy as np
import pytest

import rocking
from rocking._base.errors import InvalidArgumentError
from tests.sampling import number
from tests.suites.motions import BLOCK, noise, sampled


def record_of(name, period, step=0.005, peak=2.0, lead=400, **parameters):
    """A record of a pulse of the catalogue after `lead` samples of rest."""
    pulse = rocking.pulse(name, **parameters)
    phi = np.arange(pulse.start, pulse.end, 2 * math.pi * step / period)
    rest = np.zeros(lead)
    return rocking.Record(np.concatenate([rest, peak * pulse.acceleration(phi), rest]), step, "m/s2", name)


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
    time = record.times
    assert np.abs(fit.acceleration(time) - record.acceleration).max() < 0.02 * record.peak_acceleration


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
    given = {"restitution": BLOCK.inelastic_restitution, "alpha": BLOCK.alpha}
    exact = rocking.thresholds("sine", frequency_ratio=4.0, **given, highest=10.0)
    found = BLOCK.thresholds(record)
    amplitude = found.value * record.peak_acceleration / BLOCK.uplift_acceleration
    np.testing.assert_allclose(amplitude, exact.amplitude, rtol=1e-4)
    assert found.overturns_above.tolist() == exact.overturns_above.tolist() == [True, False, True]
    assert found.searched[1] == pytest.approx(10.0 * found.searched[0])


@pytest.mark.parametrize(
    ("arguments", "name"),
    [({"record": 1.0}, "record"), ({"family": "gabor"}, "family"), ({"blocks": [0.2]}, "blocks")],
)
def test_invalid_arguments_are_named(arguments, name):
    given = {"record": noise(0)} | arguments
    with pytest.raises(InvalidArgumentError) as error:
        rocking.suites.fit_pulse(given.pop("record"), **given)
    assert error.value.parameter == name


def test_a_weak_record_is_fitted():
    strong = record_of("ricker", 1.2)
    weak = rocking.Record(1e-4 * strong.acceleration, strong.time_step, "m/s2")
    fit = rocking.suites.fit_pulse(weak, blocks=[rocking.Block(0.4, 1.6)])
    assert fit.pulse.name == "ricker"
    assert fit.peak_acceleration == pytest.approx(2e-4, rel=1e-3)
