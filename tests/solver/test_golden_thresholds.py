"""Thresholds known from closed forms, publications and integration, computed by `peak_response`."""

import math

import numpy as np
import pytest

import rocking
from reference.exact_response import working_precision
from reference.multiprecision import integrate
from rocking import Outcome, paper
from tests.paper.test_overturning import GOLDEN, NONE

HALF_OF_LAST_DIGIT = 0.5001e-6
GRAVITY = 9.80665


def momentum(alpha: float) -> float:
    return 1 - 1.5 * math.sin(alpha) ** 2  # (2.4)


@pytest.mark.parametrize(
    ("omega", "eta", "direct", "after_impact"),
    [
        (omega, eta, direct, pair)
        for omega, (direct, pairs) in GOLDEN.items()
        for eta, pair in zip((0.85, 0.90, 0.95), pairs, strict=True)
    ],
)
def test_slender_full_sine_to_the_last_digit(omega, eta, direct, after_impact):
    found = rocking.thresholds("sine", frequency_ratio=omega, restitution=eta)
    by_one_impact = (found.outcome == Outcome.OVERTURNED_AFTER_IMPACT) & (found.impacts == 1)
    directly = found.outcome == Outcome.OVERTURNED_DIRECTLY
    expected = () if after_impact is NONE else after_impact
    np.testing.assert_allclose(found.amplitude[by_one_impact], expected, rtol=0, atol=HALF_OF_LAST_DIGIT)
    np.testing.assert_array_equal(found.overturns_above[by_one_impact], [True, False][: len(expected)])
    np.testing.assert_allclose(found.amplitude[directly], [direct], rtol=0, atol=HALF_OF_LAST_DIGIT)
    assert found.overturns_above[directly].all()
    # anything else is an island of three impacts or more, near the tip only
    others = ~(by_one_impact | directly)
    assert (found.impacts[others] >= 3).all()
    assert not others.any() or (omega, eta) == (1, 0.95)


@pytest.mark.parametrize(
    ("pulse", "formula"),
    [
        ("half_sine", paper.half_sine_amplitude),
        ("rectangular", paper.rectangular_amplitude),
        ("cosine", paper.cosine_amplitude),
        ("sine", paper.case_2_amplitude),
    ],
)
@pytest.mark.parametrize("omega", [1.0, 2.0, 3.0, 7.0])
def test_overturning_without_impact_of_simple_pulses(pulse, formula, omega):
    for name in (pulse, f"-{pulse}"):
        found = rocking.thresholds(name, frequency_ratio=omega, restitution=0.85, highest=200.0)
        directly = found.outcome == Outcome.OVERTURNED_DIRECTLY
        np.testing.assert_allclose(found.amplitude[directly], [float(formula(omega))], rtol=2e-12 * formula(omega))


def test_half_sine_and_rectangle_have_one_threshold_whatever_the_restitution():
    for pulse in ("half_sine", "rectangular"):
        thresholds = [
            rocking.thresholds(pulse, frequency_ratio=3.0, restitution=eta).amplitude for eta in (0.0, 0.6, 1.0)
        ]
        for amplitude in thresholds[1:]:
            np.testing.assert_array_equal(amplitude, thresholds[0])


@pytest.mark.parametrize(
    ("half_diagonal", "expected"),
    [
        (0.25, ("1.26189", "2.69717", "2.72859")),
        (0.5, ("1.45844", "3.97129", "4.07192")),
        (1.0, ("2.16378", "6.20125", "6.5094")),
    ],
)
def test_rigid_full_sine_by_size(half_diagonal, expected):
    alpha, period = 0.2, 0.5
    omega = 2 * math.pi / period / math.sqrt(0.75 * GRAVITY / half_diagonal)
    found = rocking.thresholds("sine", frequency_ratio=omega, restitution=momentum(alpha), alpha=alpha, highest=10.0)
    np.testing.assert_array_equal(found.overturns_above, [True, False, True])
    for amplitude, printed in zip(found.amplitude, expected, strict=True):
        decimals = len(printed.split(".")[1])
        # known to within one unit of the last digit: 4.0719142 is given as 4.07192
        assert abs(amplitude - float(printed)) <= 10**-decimals
        for side in (-1e-9, 1e-9):  # the multi-precision integration gives the same threshold
            question = {"slenderness": 1 / (amplitude * (1 + side)), "frequency_ratio": omega}
            with working_precision(128):
                truth = integrate("sine", **question, restitution=momentum(alpha), alpha=alpha)
            response = rocking.peak_response("sine", **question, restitution=momentum(alpha), alpha=alpha)
            assert truth.outcome == response.outcome
            changed = np.flatnonzero(found.amplitude == amplitude)[0]
            assert truth.overturned == (found.overturns_above[changed] == (side > 0))
