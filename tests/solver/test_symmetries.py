"""Symmetries of the equation of motion in the responses of the solver."""

import numpy as np
import pytest

import rocking
from rocking import PULSE_NAMES
from rocking._excitation.pulses import SinusoidalPulse


def random_cells(n: int, seed: int) -> dict[str, np.ndarray]:
    rng = np.random.default_rng(seed)
    return {
        "slenderness": rng.uniform(0.02, 0.999, n),
        "frequency_ratio": np.exp(rng.uniform(-2, 3, n)),
        "restitution": rng.uniform(0, 1, n),
    }


def shifted(pulse: SinusoidalPulse, by: float) -> SinusoidalPulse:
    terms = tuple((c, w, d - w * by) for c, w, d in pulse.terms)
    stationary = tuple(phi + by for phi in pulse.stationary)
    return SinusoidalPulse(f"shifted {pulse.name}", pulse.start + by, pulse.end + by, stationary, terms)


@pytest.mark.parametrize("alpha", [None, 0.2])
@pytest.mark.parametrize("name", PULSE_NAMES)
def test_mirror_pulse_gives_the_mirrored_history(name, alpha):
    question = {"slenderness": 0.45, "frequency_ratio": 2.5, "restitution": 0.9, "alpha": alpha, "samples": 60}
    one, other = rocking.time_history(name, **question), rocking.time_history(f"-{name}", **question)
    for variable in ("rotation", "angular_velocity", "ground_acceleration"):
        np.testing.assert_array_equal(one[variable], -other[variable])
    for variable in ("tau", "impact_time"):
        np.testing.assert_array_equal(one[variable], other[variable])


@pytest.mark.parametrize("name", [name for name in PULSE_NAMES if not name.startswith("ricker")])
@pytest.mark.parametrize("by", [1.0, -20.0])
def test_only_the_time_since_the_start_of_the_pulse_matters(name, by):
    question = random_cells(300, seed=8)
    pulse = rocking.pulse(name)
    one = rocking.peak_response(pulse, **question)
    other = rocking.peak_response(shifted(pulse, by), **question)
    np.testing.assert_array_equal(one.outcome, other.outcome)
    np.testing.assert_allclose(other.peak_rotation, one.peak_rotation, rtol=1e-9)
    np.testing.assert_allclose(other.uplift_time, one.uplift_time, rtol=1e-9, atol=1e-13)
