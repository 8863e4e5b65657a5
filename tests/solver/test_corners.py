"""Corners of the parameter space: each has a response, without exception, endless loop or unexplained nan."""

import itertools
import math

import numpy as np
import pytest

import rocking
import rocking._base.quantities as quantities
from rocking import Outcome
from rocking._excitation.pulses import SinusoidalPulse
from rocking._solver.kernels.event_loop import on_impact, start_flight
from tests.kernels import cell
from tests.sampling import but_long

SLENDERNESS = (quantities.SLENDERNESS.lower, 1e-3, 0.5, 0.999, 1 - 1e-15)
FREQUENCY_RATIO = (quantities.FREQUENCY_RATIO.lower, 1e-3, 1.0, 1e3, quantities.FREQUENCY_RATIO.upper)
RESTITUTION = (0.0, 0.9, 1 - 1e-12, 1.0)
PULSES = ("sine", "cosine", "rectangular", "c2", "ricker", "ricker_antisymmetric")
ALPHA = (0.0, quantities.SMALLEST_ALPHA, 1e-3, 1.2, quantities.ALPHA.upper)


@pytest.mark.slow
@pytest.mark.parametrize("pulse", but_long(PULSES, "c2"))
def test_corners_of_the_parameter_space(pulse: str) -> None:
    groups = np.array(list(itertools.product(SLENDERNESS, FREQUENCY_RATIO, RESTITUTION, ALPHA))).T
    response = rocking.peak_response(
        pulse, slenderness=groups[0], frequency_ratio=groups[1], restitution=groups[2], alpha=groups[3]
    )
    assert np.array_equal(np.isnan(response.peak_rotation), response.overturned)
    standing = response.peak_rotation[~response.overturned]
    assert ((standing >= 0) & np.isfinite(standing)).all()


def neighbours(value, count):
    around = [value]
    for _ in range(count):
        around = [np.nextafter(around[0], 0.0), *around, np.nextafter(around[-1], 2.0)]
    return np.array(around)


GROWING = SinusoidalPulse("growing", 0.4, 5.0, (0.5 * np.pi, 1.5 * np.pi), ((1.0, 1.0, 0.5 * np.pi),))
FALLING = SinusoidalPulse("falling", 0.4, 5.0, (np.pi,), ((1.0, 1.0, 0.0),))


@pytest.mark.parametrize("alpha", [None, 0.05, 0.3, math.pi / 4, 1.2])
@pytest.mark.parametrize("pulse", ["c1", "-c2", GROWING, FALLING], ids=str)
def test_a_pulse_that_starts_where_the_block_just_uplifts(pulse, alpha):
    """Within rounding of |a f| = 1 at the start a flight may be shorter than rounding; they followed each other."""
    started = rocking.pulse(pulse) if isinstance(pulse, str) else pulse
    case = {"frequency_ratio": np.array([[0.15], [1.0], [3.0]]), "alpha": alpha}
    at_start = neighbours(abs(started.shape(started.start)), 4)
    for eta in (0.0, 0.7, 0.85):
        found = rocking.peak_response(pulse, slenderness=at_start, restitution=eta, **case)
        assert (found.outcome > Outcome.NO_UPLIFT).all()
        assert found.impacts.max() < 1000
        assert (found.overturned == found.overturned[:, :1]).all()


@pytest.mark.parametrize("alpha", [None, 0.3, math.pi / 4])
def test_uplift_at_the_start_of_a_growing_pulse_is_not_missed(alpha):
    """With f = 1/a at the start exactly, the interval of uplift was missing for rigid blocks."""
    at_start = neighbours(abs(GROWING.shape(GROWING.start)), 3)
    for omega in (0.15, 1.0, 6.0):
        found = rocking.peak_response(
            GROWING, slenderness=at_start, frequency_ratio=omega, restitution=0.85, alpha=alpha
        )
        assert np.ptp(found.outcome) == np.ptp(found.impacts) == 0
        np.testing.assert_allclose(found.uplift_time, 0.0, atol=1e-14)
        np.testing.assert_allclose(found.peak_rotation, found.peak_rotation[0], rtol=1e-12)


@pytest.mark.parametrize(("growing", "starts_at_uplift"), [(True, 0), (True, 1), (False, 0)])
def test_a_flight_within_rounding_of_the_end_of_an_interval(growing, starts_at_uplift):
    """Where |f| grows the block uplifts anew from rest there, once; where |f| falls the next interval follows."""
    flight = cell("sine", 0.5, 3.0, alpha=0.3)
    slope = 1.0 if growing else -1.0
    interval = next(
        i
        for i in range(flight["interval_count"])
        if flight["interval_level"][i] * flight["interval_slope"][i] == slope and flight["interval_level"][i] != 0.0
    )
    flight["outcome"], flight["impacts"], flight["interval"] = Outcome.RECOVERS, 3, interval
    flight["starts_at_uplift"], flight["length"] = starts_at_uplift, 0.0
    flight["phase"], flight["sign"] = flight["interval_phase"][interval], -flight["interval_level"][interval]
    flight["side"] = int(flight["sign"] < 0.0)
    on_impact(flight, -1e-30)
    assert flight["impacts"] == 4
    again = growing and starts_at_uplift == 0
    assert flight["interval"] == (interval if again else interval + 1)
    assert flight["at_rest"] == again
    assert start_flight(flight)
    assert flight["phase"] == flight["interval_phase"][flight["interval"]]
    assert flight["starts_at_uplift"] == again


def test_the_second_peak_of_a_flight_is_not_missed():
    """The block returns, is thrown back before the impact, and turns again while the restoring acceleration increases.

    The velocity is negative at both ends of the interval of this peak. It was the largest one in one of 1.2 million
    random cells under sums of sinusoids, and is in 12 of these. Exact arcs against Taylor steps.
    """
    terms = ((0.09, 1.0, 4.89), (0.46, 3.0, 3.3), (-0.08, 1.5, 5.78), (0.51, 2.0, 3.99))
    pulse = SinusoidalPulse.of_unit_peak("skewed", 0.0, 9.8, terms)
    random = np.random.default_rng(0)
    s, omega, eta = random.uniform([[0.216], [1.95], [0.45]], [[0.239], [2.16], [0.56]], (3, 2000))
    groups = {"slenderness": s, "frequency_ratio": omega, "restitution": eta}
    arcs, steps = (rocking.peak_response(pulse, **groups, alpha=alpha) for alpha in (None, 1e-6))
    np.testing.assert_array_equal(arcs.outcome, Outcome.RECOVERS)
    np.testing.assert_allclose(arcs.peak_rotation, steps.peak_rotation, rtol=1e-10)
