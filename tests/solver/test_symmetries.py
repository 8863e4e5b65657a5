"""Symmetries of the equation of motion in the responses of the solver."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import rocking
from rocking import PULSE_NAMES
from rocking._excitation.pulses import SinusoidalPulse

EVEN = (
    *("peak_rotation", "peak_mode", "outcome", "impacts", "chatter", "exceeded_alpha"),
    *("uplift_time", "first_impact_time"),
)


def random_cells(n: int, seed: int) -> dict[str, np.ndarray]:
    rng = np.random.default_rng(seed)
    return {
        "slenderness": rng.uniform(0.02, 0.999, n),
        "frequency_ratio": np.exp(rng.uniform(-2, 3, n)),
        "restitution": rng.uniform(0, 1, n),
    }


def shifted(pulse: SinusoidalPulse, by: float) -> SinusoidalPulse:
    """The same acceleration with a shifted phase."""
    terms = tuple((c, w, d - w * by) for c, w, d in pulse.terms)
    stationary = tuple(phi + by for phi in pulse.stationary)
    return SinusoidalPulse(f"shifted {pulse.name}", pulse.start + by, pulse.end + by, stationary, terms)


@pytest.mark.parametrize("alpha", [None, 1e-6, 0.3, 1.2])
@pytest.mark.parametrize("name", PULSE_NAMES)
def test_mirror_pulse_gives_the_mirrored_response_bit_for_bit(name, alpha):
    question = random_cells(400 if alpha is None else 60, seed=7)
    one = rocking.peak_response(name, **question, alpha=alpha)
    other = rocking.peak_response(f"-{name}", **question, alpha=alpha)
    for field in EVEN:
        np.testing.assert_array_equal(getattr(one, field), getattr(other, field), err_msg=field)
    np.testing.assert_array_equal(one.first_impact_velocity, -other.first_impact_velocity)


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


def test_half_sine_is_a_window_of_the_cosine():
    turned = SinusoidalPulse("turned", -np.pi / 2, np.pi / 2, (0.0,), ((1.0, 1.0, 0.0),))
    question = random_cells(500, seed=9)
    one, other = rocking.peak_response("half_sine", **question), rocking.peak_response(turned, **question)
    np.testing.assert_array_equal(one.outcome, other.outcome)
    np.testing.assert_allclose(other.peak_rotation, one.peak_rotation, rtol=1e-9)


def test_a_sinusoid_and_its_three_equal_parts_give_equal_responses():
    sine = rocking.pulse("sine")
    amplitude, multiple, shift = sine.terms[0]
    parts = tuple((share * amplitude, multiple, shift) for share in (0.5, 0.25, 0.25))
    split = SinusoidalPulse("split", sine.start, sine.end, sine.stationary, parts)
    question = random_cells(500, seed=10)
    one, other = rocking.peak_response(sine, **question), rocking.peak_response(split, **question)
    np.testing.assert_array_equal(one.outcome, other.outcome)
    np.testing.assert_allclose(other.peak_rotation, one.peak_rotation, rtol=1e-9)


@given(
    half_diagonal=st.floats(0.05, 20),
    alpha=st.floats(0.02, 0.6),
    slenderness=st.floats(0.1, 0.99),
    frequency_ratio=st.floats(0.2, 10),
    times=st.floats(0.1, 50),
)
@settings(max_examples=40)
def test_blocks_of_equal_groups_respond_equally(half_diagonal, alpha, slenderness, frequency_ratio, times):
    gravity = 9.80665
    peaks = []
    for size in (half_diagonal, half_diagonal * times):
        block = rocking.Block(width=2 * (size * np.sin(alpha)), height=2 * (size * np.cos(alpha)))
        a_g = gravity * np.tan(alpha) / slenderness
        omega_g = frequency_ratio * block.frequency_parameter
        peaks.append(
            rocking.peak_response(
                "sine",
                slenderness=gravity * np.tan(block.alpha) / a_g,
                frequency_ratio=omega_g / block.frequency_parameter,
                restitution=0.9,
                alpha=block.alpha,
            )
        )
    one, other = peaks
    if one.outcome == other.outcome:  # otherwise the groups differ in the last bit at a boundary
        np.testing.assert_allclose(one.peak_rotation, other.peak_rotation, rtol=1e-8)
    else:
        beside = slenderness * (1 + np.array([-1e-12, 1e-12]))
        found = rocking.peak_response(
            "sine", slenderness=beside, frequency_ratio=frequency_ratio, restitution=0.9, alpha=alpha
        )
        assert found.outcome[0] != found.outcome[1]


def test_restitution_does_not_matter_before_the_first_impact():
    eta = np.linspace(0, 1, 11)
    for name in PULSE_NAMES:
        found = rocking.peak_response(name, slenderness=0.3, frequency_ratio=2.0, restitution=eta)
        for field in ("uplift_time", "first_impact_time", "first_impact_velocity"):
            values = getattr(found, field)
            np.testing.assert_array_equal(values, np.full_like(values, values[0]))
