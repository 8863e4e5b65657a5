"""Responses under pulses given by samples: reference, order, records, every function that takes a pulse."""

from __future__ import annotations

import math

import numpy as np
import pytest

import rocking
from reference.records import response_and_amplification
from tests.sampling import number

TRIANGLE = rocking.SampledPulse([0.0, 1.0, 0.0], name="triangle")
SAW = rocking.SampledPulse([0.0, 1.0, -1.0, 1.0, -1.0, 0.0], name="saw")
RANDOM = rocking.SampledPulse(np.random.default_rng(9).uniform(-1, 1, 9), name="random")


@pytest.mark.parametrize("alpha", [None, 0.3])
@pytest.mark.parametrize("pulse", [TRIANGLE, SAW, RANDOM], ids=lambda pulse: pulse.name)
def test_responses_are_those_of_the_reference(pulse: rocking.SampledPulse, alpha: float | None) -> None:
    rng = np.random.default_rng(len(pulse.values))
    step = float(pulse.phases[1])
    for _ in range(number(1, 8)):
        s, omega, eta = rng.uniform(0.2, 0.9), rng.uniform(0.6, 6.0), rng.uniform(0.6, 0.95)
        groups = {"slenderness": s, "restitution": eta, "alpha": alpha}
        exact, amplification = response_and_amplification(
            pulse.values.tolist(), 1.0, frequency_parameter=step / omega, **groups
        )
        found = rocking.peak_response(pulse, frequency_ratio=omega, **groups)
        assert bool(found.overturned) == exact.overturned
        if not exact.overturned and exact.peak_rotation is not None:
            allowed = 1e-12 * max(1.0, 0.01 * amplification)
            assert float(found.peak_rotation) == pytest.approx(float(exact.peak_rotation), rel=allowed)


@pytest.mark.parametrize("alpha", [None, 0.3])
def test_the_same_samples_are_the_same_record(alpha: float | None) -> None:
    values = np.random.default_rng(2).uniform(-1.0, 1.0, 40)
    record = rocking.Record(values, 0.02, "m/s2")
    pulse = rocking.SampledPulse(values, 0.02 * np.arange(40), period=0.4)
    p = np.linspace(2.0, 9.0, 30)
    groups = {"slenderness": 0.5, "restitution": 0.9, "alpha": alpha}
    one = rocking.peak_response(record, frequency_parameter=p, **groups)
    other = rocking.peak_response(pulse, frequency_ratio=2.0 * math.pi / 0.4 / p, **groups)
    np.testing.assert_array_equal(one.outcome, other.outcome)
    np.testing.assert_array_equal(one.impacts, other.impacts)
    np.testing.assert_allclose(one.peak_rotation, other.peak_rotation, rtol=1e-10)


def test_times_need_not_be_equidistant() -> None:
    """A sample on the line between its neighbours changes nothing; low frequencies divide the intervals."""
    groups = {"slenderness": 0.4, "frequency_ratio": np.geomspace(1e-3, 12.0, 60), "restitution": 0.85}
    uneven = rocking.SampledPulse([0.0, 0.5, 1.0, 0.0], [0.0, 0.25, 0.5, 1.0])
    for alpha in (None, 0.2):
        one = rocking.peak_response(TRIANGLE, **groups, alpha=alpha)
        other = rocking.peak_response(uneven, **groups, alpha=alpha)
        np.testing.assert_array_equal(one.outcome, other.outcome)
        np.testing.assert_allclose(one.peak_rotation, other.peak_rotation, rtol=1e-11)
    with pytest.raises(rocking.InvalidArgumentError, match="frequency_ratio"):
        rocking.peak_response(TRIANGLE, **{**groups, "frequency_ratio": 1e-9})


def test_mirrored_pulse_and_equality() -> None:
    groups = {"slenderness": 0.4, "frequency_ratio": 3.0, "restitution": 0.85}
    assert rocking.peak_response(SAW.mirrored(), **groups).peak_rotation == pytest.approx(
        float(rocking.peak_response(SAW, **groups).peak_rotation), rel=1e-13, nan_ok=True
    )
    again = rocking.SampledPulse([0.0, 2.0, 0.0], [5.0, 5.5, 6.0], name="triangle")
    assert again == TRIANGLE
    assert hash(again) == hash(TRIANGLE)
    assert again != SAW
    assert SAW.mirrored().mirrored() == SAW


@pytest.mark.parametrize(
    ("given", "name"),
    [
        ({"acceleration": [1.0]}, "acceleration"),
        ({"acceleration": [0.0, 0.0]}, "acceleration"),
        ({"acceleration": [[1.0, 2.0]]}, "acceleration"),
        ({"acceleration": [1.0, math.nan]}, "acceleration"),
        ({"acceleration": [1.0, 2.0], "time": [0.0, 0.0]}, "time"),
        ({"acceleration": [1.0, 2.0], "time": [0.0]}, "time"),
        ({"acceleration": [1.0, 2.0, 1.0], "time": [0.0, 1e-12, 1.0]}, "time"),
        ({"acceleration": [1.0, 2.0], "period": 0.0}, "period"),
        ({"acceleration": [1.0, 2.0], "name": ""}, "name"),
    ],
)
def test_invalid_samples_are_refused(given: dict[str, object], name: str) -> None:
    with pytest.raises(rocking.InvalidArgumentError) as refusal:
        rocking.SampledPulse(**given)
    assert refusal.value.parameter == name
