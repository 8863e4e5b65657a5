"""Peak rotation after an impact that follows the pulse, (4.12) to (4.16), and deviations from the scale law."""

import numpy as np
import pytest

from rocking import paper as cf
from rocking._base.errors import InvalidArgumentError
from rocking._solver.peak_response import peak_response
from rocking.paper import largest_deviation, restitution_exponent, scale_law_deviation
from tests.direct_integration import peak_of_free_rocking


@pytest.mark.parametrize("velocity", [0.0, 1e-3, 0.3, 0.9, 0.999])
def test_peak_of_velocity_against_integrated_free_rocking(velocity):
    assert cf.peak_of_velocity(velocity) == pytest.approx(peak_of_free_rocking(velocity), rel=1e-9, abs=1e-15)  # (4.12)


def test_peak_of_velocity_at_and_above_the_overturning_velocity():
    assert cf.peak_of_velocity(1.0) == 1
    assert np.isnan(cf.peak_of_velocity(1.0 + 1e-12))
    assert cf.peak_of_velocity(1e-9) == pytest.approx(5e-19, rel=1e-12)


def test_peak_after_impact_is_nan_where_the_block_overturns_without_impact():
    """(4.13) and its leading term are valid below (3.10) only and are not negative there."""
    assert np.isnan(cf.case_1_2_peak(1 / 0.3, 2, 0.9))
    omega = np.geomspace(0.3, 12.0, 60)
    ratio = np.concatenate([np.linspace(0.5, 0.999, 40), np.linspace(1.001, 4.0, 40)])[:, None]
    a = cf.case_2_amplitude(omega) * ratio
    a, omega = np.broadcast_arrays(np.maximum(a, 1.0), omega)
    directly = peak_response("sine", slenderness=1 / a, frequency_ratio=omega, restitution=0.9).outcome == 2
    assert 0.3 < directly.mean() < 0.7
    for form in (cf.case_1_2_peak, cf.case_1_2_peak_by_pulse, cf.small_peak, cf.small_peak_by_pulse):
        found = form(a, omega, 0.9)
        assert np.isnan(found[directly]).all()
        assert (found[np.isfinite(found)] >= 0).all()
    assert np.isfinite(cf.scale_function(a, omega)[~directly]).mean() > 0.9


def test_small_peak_formulas_are_the_leading_term():
    a, omega = 3.0, np.array([20.0, 40.0, 80.0])
    exact = cf.case_1_2_peak(a, omega, 0.85)
    error = cf.small_peak(a, omega, 0.85) / exact - 1  # (4.14)
    velocity_squared = 0.85**2 * cf.scale_function(a, omega)
    np.testing.assert_allclose(error, -velocity_squared / 4, rtol=0.1)  # the next term of the series
    np.testing.assert_allclose(cf.small_peak_by_pulse(a, omega, 0.85), cf.small_peak(a, omega, 0.85) / a)  # (4.15)
    np.testing.assert_allclose(cf.case_1_2_peak_by_pulse(a, omega, 0.85), exact / a, rtol=1e-15)


def test_scale_law_deviation_is_zero_for_the_leading_term():
    eta = np.array([0.80, 0.85, 0.90, 0.96])
    peak = cf.small_peak(3.0, np.array([5.0, 10.0]), eta[:, None])  # (4.16)
    np.testing.assert_allclose(scale_law_deviation(peak, eta, reference=0.85), 0, atol=1e-14)
    np.testing.assert_allclose(restitution_exponent(peak, eta), 2, rtol=1e-12)
    np.testing.assert_allclose(largest_deviation(peak, eta, reference=0.85), 0, atol=1e-14)


def test_scale_law_deviation_of_the_closed_form_spectrum():
    eta = np.arange(0.80, 0.961, 0.02)
    omega = np.array([8.0, 20.0, 60.0])
    peak = cf.case_1_2_peak(3.0, omega, eta[:, None])
    deviation = largest_deviation(peak, eta, reference=0.88)
    exponent = restitution_exponent(peak, eta)
    assert (np.diff(deviation) < 0).all()  # the law is asymptotic: its error decreases with the rotation
    assert (np.diff(exponent) < 0).all()
    assert exponent[-1] == pytest.approx(2, abs=0.01)


def test_scale_law_deviation_is_nan_for_overturned_blocks():
    eta = np.array([0.8, 0.9, 1.0])
    peak = np.array([[0.1, np.nan, np.nan], [0.2, np.nan, 0.3], [0.3, 0.4, np.nan]])
    deviation = scale_law_deviation(peak, eta, reference=0.9)
    np.testing.assert_array_equal(np.isnan(deviation), [[0, 1, 1], [0, 1, 0], [0, 1, 1]])
    np.testing.assert_array_equal(np.isnan(largest_deviation(peak, eta, reference=0.9)), [False, True, True])
    np.testing.assert_array_equal(np.isnan(restitution_exponent(peak, eta)), [False, True, True])


def test_scale_law_refuses_invalid_arguments():
    with pytest.raises(InvalidArgumentError, match="`reference`"):
        scale_law_deviation([0.1, 0.2], [0.8, 0.9], reference=0.85)
    with pytest.raises(InvalidArgumentError, match="`restitution`"):
        scale_law_deviation([0.1, 0.2, 0.3], [0.8, 0.9], reference=0.8)
    with pytest.raises(InvalidArgumentError, match="`restitution`"):
        restitution_exponent([0.1, 0.2], [0.0, 0.9])


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_scale_law_deviation_of_three_dimensional_peaks(axis):
    eta, rng = np.array([0.8, 0.9, 1.0]), np.random.default_rng(2)
    peaks = rng.uniform(0.1, 0.9, (3, 4, 5))
    turned = np.moveaxis(peaks, 0, axis)
    deviation = scale_law_deviation(turned, eta, reference=0.9, axis=axis)
    expected = (peaks[1] / 0.9**2) / (peaks[0] / 0.8**2) - 1
    np.testing.assert_allclose(np.moveaxis(deviation, axis, 0)[0], expected)
    np.testing.assert_array_equal(restitution_exponent(turned, eta, axis=axis), restitution_exponent(peaks, eta))
    np.testing.assert_array_equal(np.moveaxis(deviation, axis, 0), scale_law_deviation(peaks, eta, reference=0.9))
    for i in range(4):
        one = scale_law_deviation(peaks[:, i], eta, reference=0.9)
        np.testing.assert_array_equal(np.moveaxis(deviation, axis, 0)[:, i], one)
