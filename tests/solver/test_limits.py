"""Limits of the control space with known response: impulses, slow pulses, strong pulses, onset of rocking."""

import numpy as np
import pytest

import rocking
from rocking import PULSE_NAMES, Outcome, paper

SIGNED = tuple(sign + name for name in PULSE_NAMES for sign in ("", "-"))


def velocity_given(name: str, slenderness: float) -> float:
    """Integral of a f - 1 over the part above 1 of a half sine or a rectangle of unit frequency [-]."""
    uplift = np.arcsin(slenderness) if name == "half_sine" else 0.0
    gained = (1 + np.cos(uplift)) / slenderness if name == "half_sine" else np.pi / slenderness
    return gained - (np.pi - uplift)


@pytest.mark.parametrize("name", ["half_sine", "rectangular"])
def test_an_impulse_is_an_initial_velocity_of_free_rocking(name):
    omega, slenderness = 1e4, np.array([1e-2, 1e-3, 5e-4])
    speed = velocity_given(name, slenderness) / omega
    found = rocking.peak_response(name, slenderness=slenderness, frequency_ratio=omega, restitution=0.9)
    error = found.peak_rotation / paper.peak_of_velocity(speed) - 1
    assert (np.abs(error) < 1.3 * np.pi / omega / speed).all()  # the distance moved during the pulse
    assert (found.outcome == Outcome.RECOVERS).all()
    # overturns when the velocity reaches 1, (3.8), up to the distance moved during the pulse, of the order of 1/omega
    threshold = rocking.thresholds(name, frequency_ratio=omega, restitution=0.9, highest=1e5)
    assert velocity_given(name, 1 / threshold.amplitude[0]) / omega == pytest.approx(1.0, rel=3e-4)


@pytest.mark.parametrize("name", SIGNED)
@pytest.mark.parametrize("alpha", [None, 0.3])
def test_a_slow_pulse_overturns_every_block_that_uplifts(name, alpha):
    slenderness = [1e-4, 0.01, 0.5, 0.9]
    slow = {"frequency_ratio": 1e-4, "restitution": 0.9, "alpha": alpha}
    assert rocking.peak_response(name, slenderness=slenderness, **slow).overturned.all()


@pytest.mark.parametrize("name", [name for name in PULSE_NAMES if name != "rectangular"])
def test_peaks_vanish_at_the_onset_of_rocking(name):
    gap = 10.0 ** np.arange(-2, -13, -1)
    found = rocking.peak_response(name, slenderness=1 - gap, frequency_ratio=3.0, restitution=0.5)
    assert (np.diff(found.peak_rotation) < 0).all()
    assert found.peak_rotation[-1] < 1e-9
    # over the half-width sqrt(2 gap) of uplift the acceleration is of order gap: rotation of order gap^2/omega^2
    if abs(float(rocking.pulse(name).shape(rocking.pulse(name).start))) < 1:
        order = np.diff(np.log(found.peak_rotation[2:])) / np.log(0.1)
        assert np.median(order) == pytest.approx(2.0, abs=0.1)
