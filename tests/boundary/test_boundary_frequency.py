"""Critical frequency ratios: the outcome changes there and nowhere else; they agree with critical amplitudes."""

import math

import numpy as np
import pytest

import rocking
from rocking._base.errors import InvalidArgumentError
from rocking._boundary.amplitude import thresholds
from rocking._boundary.frequency import critical_frequency_ratio
from rocking._solver.peak_response import peak_response
from tests.suites.motions import noise

WINDOW = (0.3, 20.0)


@pytest.mark.parametrize("alpha", [None, 0.2])
@pytest.mark.parametrize("pulse", ["sine", "-cosine", "ricker"])
@pytest.mark.parametrize("slenderness", [0.15, 0.4, 0.7])
def test_the_outcome_changes_there_and_nowhere_else(pulse, slenderness, alpha):
    critical = critical_frequency_ratio(pulse, slenderness=slenderness, restitution=0.85, window=WINDOW, alpha=alpha)
    assert critical.frequency_ratio.size > 0

    def overturns(omega):
        groups = {"slenderness": slenderness, "frequency_ratio": omega, "restitution": 0.85, "alpha": alpha}
        return peak_response(pulse, **groups).overturned

    below, above = (overturns(critical.frequency_ratio * (1 + shift)) for shift in (-1e-10, 1e-10))
    np.testing.assert_array_equal(above, critical.overturns_above)
    np.testing.assert_array_equal(below, ~critical.overturns_above)
    # between two thresholds, and outside of them all, the outcome is the same
    omega = np.geomspace(*WINDOW, 3001)
    passed = np.searchsorted(critical.frequency_ratio, omega)
    expected = np.append(np.where(critical.overturns_above, False, True), critical.overturns_at_ends[1])
    np.testing.assert_array_equal(overturns(omega), expected[passed])
    assert critical.overturns_at_ends == tuple(overturns(np.array(WINDOW)).tolist())


def test_a_critical_amplitude_has_its_frequency_as_a_critical_frequency():
    for omega in (2.0, 4.0, 5.0):
        for a in thresholds("sine", frequency_ratio=omega, restitution=0.9).amplitude:
            critical = critical_frequency_ratio("sine", slenderness=1 / a, restitution=0.9, window=WINDOW)
            assert np.abs(critical.frequency_ratio / omega - 1).min() < 1e-8


def test_without_impact_a_cosine_overturns_below_the_closed_form():
    # a = (1 + omega^2)/(1 - exp(-2 pi/omega)): from larger frequencies on the block survives if eta = 0
    omega = 3.0
    a = (1 + omega**2) / -math.expm1(-2 * math.pi / omega)
    critical = critical_frequency_ratio("cosine", slenderness=1 / a, restitution=0.0, window=(1.0, 9.0))
    assert critical.overturns_at_ends[0]
    assert critical.frequency_ratio[0] == pytest.approx(omega, rel=1e-10)


def test_a_block_that_never_uplifts_has_none():
    critical = critical_frequency_ratio("sine", slenderness=1.0, restitution=0.9, window=WINDOW)
    assert critical.frequency_ratio.size == 0
    assert critical.overturns_at_ends == (False, False)


@pytest.mark.parametrize("window", [(1e-9, 1e-6), (1e6, 1e9)])
def test_the_window_may_reach_to_the_border_of_the_solver(window):
    critical = critical_frequency_ratio("sine", slenderness=0.4, restitution=0.85, window=window)
    assert critical.overturns_at_ends == ((True, True) if window[0] < 1.0 else (False, False))


@pytest.mark.parametrize("window", [(2.0, 2.0), (3.0, 2.0), (0.0, 1.0), (1.0, math.inf), (1e-3, 100.0)])
def test_a_wrong_window_is_named(window):
    with pytest.raises(InvalidArgumentError, match=r"`window(\[1\])?`"):
        critical_frequency_ratio("sine", slenderness=0.4, restitution=0.9, window=window)


@pytest.mark.parametrize(
    ("name", "value"), [("slenderness", 0.0), ("restitution", 1.1), ("alpha", 2.0), ("slenderness", math.nan)]
)
def test_what_is_out_of_range_is_named(name, value):
    groups = {"slenderness": 0.4, "restitution": 0.9, "alpha": None} | {name: value}
    with pytest.raises(InvalidArgumentError, match=f"`{name}`"):
        critical_frequency_ratio("sine", window=WINDOW, **groups)


def test_thresholds_in_words_and_tables():
    thresholds = rocking.thresholds("sine", frequency_ratio=2.0, restitution=0.9)
    assert repr(thresholds) == (
        "<rocking.Thresholds: overturns above a = 1.22518, survives above a = 2.3144, overturns above a = 2.3499>"
    )
    assert thresholds.to_pandas().outcome.tolist() == ["OVERTURNED_AFTER_IMPACT"] * 2 + ["OVERTURNED_DIRECTLY"]
    assert thresholds.to_xarray().amplitude.values.tolist() == thresholds.amplitude.tolist()
    none = rocking.thresholds("sine", frequency_ratio=9.0, restitution=0.9, highest=1.5)
    assert repr(none) == "<rocking.Thresholds: no amplitude was found that overturns the block>"
    assert none.to_pandas().empty


def test_thresholds_of_a_record_are_those_of_the_block():
    record = noise(1)
    block = rocking.Block(0.5, 2.0)
    thresholds = rocking.thresholds(
        record, frequency_parameter=block.frequency_parameter, restitution=0.9, alpha=block.alpha
    )
    scales = block.response(record, restitution=0.9).thresholds
    uplift = block.uplift_acceleration / record.peak_acceleration
    assert thresholds.amplitude.size
    assert thresholds.amplitude * uplift == pytest.approx(scales.value, rel=2e-6)
    at = rocking.peak_response(
        record,
        frequency_parameter=block.frequency_parameter,
        restitution=0.9,
        alpha=block.alpha,
        slenderness=1.0 / thresholds.amplitude,
    )
    assert at.outcome.tolist() == thresholds.outcome.tolist()
