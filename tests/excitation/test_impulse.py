"""Ground velocities of pulse shapes, against their integrals."""

import math

import numpy as np
import pytest

import rocking
from rocking._excitation.impulse import impulse_of
from rocking._excitation.pulses import PULSE_NAMES, as_pulse


@pytest.mark.parametrize(
    ("pulse", "largest", "final", "total"),
    [
        ("sine", 2.0, 0.0, 4.0),
        ("cosine", 1.0, 0.0, 4.0),
        ("half_sine", 2.0, 2.0, 2.0),
        ("rectangular", math.pi, math.pi, math.pi),
        ("ricker", math.sqrt(2.0) * math.exp(-0.5), 0.0, 4.0 * math.sqrt(2.0) * math.exp(-0.5)),
    ],
)
def test_integrals_of_shapes_in_closed_form(pulse: str, largest: float, final: float, total: float) -> None:
    found = impulse_of(as_pulse(pulse))
    np.testing.assert_allclose([found.largest, found.final, found.total], [largest, final, total], atol=2e-13)


def test_pulses_that_leave_the_ground_moving_are_known_by_their_integral() -> None:
    assert {name for name in PULSE_NAMES if not impulse_of(as_pulse(name)).ends_at_rest} == {"half_sine", "rectangular"}


def test_a_sampled_pulse_is_integrated_exactly() -> None:
    found = impulse_of(rocking.SampledPulse([0.0, 1.0, -1.0, 0.5], period=2.0 * math.pi))
    np.testing.assert_allclose([found.largest, found.final, found.total], [0.75, 0.25, 1.0 + 1 / 3 + 1 / 12])
