"""Approximate impact time of case 1.1, (3.23) to (3.30), and the root of appendix A that is the impact."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rocking import paper as cf
from tests.direct_integration import integrate

finite = st.floats(-5, 5)


def test_expansions_agree_to_second_order_about_the_initial_guess():
    a, omega = 1.8, 3.0
    assert cf.EXPANSION_TIME == 1.0  # (3.23)
    for order, step in ((3, 1e-2), (3, 2e-2)):
        time = cf.EXPANSION_TIME + np.array([-step, 0.0, step])
        exact = np.sin(omega * time + cf.uplift_phase(a))
        np.testing.assert_allclose(cf.sine_series(a, omega, time), exact, atol=(omega * step) ** order / 6 * 1.01)
        kappa, lambda_ = cf.kappa_lambda(a, omega)
        pair = kappa * np.exp(-time) + lambda_ * np.exp(time)
        np.testing.assert_allclose(
            cf.exponential_series(a, omega, time), pair, atol=2 * (abs(kappa) + abs(lambda_)) * step**order
        )


@pytest.mark.parametrize(("a", "omega"), [(1.3, 0.8), (1.8, 3.0), (2.5, 5.0)])
def test_kappa_and_lambda_make_the_two_series_equal(a, omega):
    time = np.array([0.7, 1.0, 1.4])
    constant = (omega**2 + 1) * np.sin(omega + cf.uplift_phase(a))
    np.testing.assert_allclose(
        cf.exponential_series(a, omega, time) + constant, cf.sine_series(a, omega, time), atol=1e-12
    )  # (3.24) = (3.25) + the constant of (3.27), by (3.26)


def test_error_of_the_ad_hoc_sine_grows_with_frequency_ratio():
    time = np.linspace(0.8, 1.2, 41)

    def error(omega):
        exact = np.sin(omega * time + cf.uplift_phase(2.0))
        return float(np.abs(cf.ad_hoc_sine(2.0, omega, time) - exact).max())  # (3.27), figure S1

    assert error(1.0) < 0.003
    assert error(2.0) < 0.016
    assert 0.1 < error(5.0) < 0.35


@given(falling=finite, growing=finite, constant=finite)
def test_rising_root_is_a_root_with_positive_slope(falling, growing, constant):
    tau = cf.rising_root(falling, growing, constant)
    if np.isnan(tau) or abs(tau) > 30:
        return
    scale = abs(falling) * np.exp(-tau) + abs(growing) * np.exp(tau) + abs(constant)
    assert abs(cf.residual(falling, growing, constant, tau)) <= 1e-7 * scale  # (A 1), also at double roots
    assert growing * np.exp(tau) - falling * np.exp(-tau) >= -1e-7 * scale


@given(falling=finite, growing=finite, constant=finite)
def test_rising_root_finds_every_upward_crossing(falling, growing, constant):
    tau = np.linspace(-3, 3, 400)
    value = cf.residual(falling, growing, constant, tau)
    crossing = np.flatnonzero((value[:-1] < -1e-9) & (value[1:] > 1e-9))
    assert crossing.size <= 1  # the quadratic (A 4) has two roots and rises through one
    if crossing.size:
        root = cf.rising_root(falling, growing, constant)
        assert tau[crossing[0]] <= root <= tau[crossing[0] + 1]


@pytest.mark.parametrize(("a", "omega"), [(1.45, 3.0), (1.7, 3.8), (2.0, 4.4)])
def test_rising_root_of_the_approximation_is_close_to_the_impact_time(a, omega):
    exact = integrate(a, omega, 0.9).impact_times[0]
    tau = cf.ad_hoc_impact_time(a, omega)
    assert cf.ad_hoc_residual(a, omega, tau) == pytest.approx(0, abs=1e-12)  # (3.28)
    assert tau == pytest.approx(exact, abs=0.02)  # (3.29)
    # theta increases at this root; at the other one, with the minus sign, it decreases
    before, after = cf.ad_hoc_residual(a, omega, tau - 1e-6), cf.ad_hoc_residual(a, omega, tau + 1e-6)
    assert before < 0 < after


def test_other_root_after_the_pulse_is_not_a_physical_time():
    omega = np.linspace(1.5, 6, 10)
    a = (cf.limit_amplitude(omega) + cf.case_2_amplitude(omega)) / 2
    falling, growing = cf.after_pulse_coefficients(a, omega)
    growing = growing * np.exp(cf.pulse_end(a, omega))
    other = (1 - np.sqrt(1 - falling * growing)) / growing
    assert ((other < 0) | (np.log(np.abs(other)) < 0)).all()  # e^tau negative, or tau before the end of the pulse
    assert (other < 0).any()


@pytest.mark.parametrize(("eta", "reach"), [(0.80, 3.5), (0.85, 4.1), (0.90, 4.4), (0.95, 4.7), (1.00, 5.2)])
def test_semi_analytical_curve_solves_its_condition_and_is_close_to_the_exact_curve(eta, reach):
    omega = np.linspace(0.3, reach, 40)
    semi, exact = cf.semi_analytical_amplitudes(omega, eta).lower, cf.case_1_1_amplitudes(omega, eta).lower
    np.testing.assert_allclose(cf.ad_hoc_margin(semi, omega, eta), 0, atol=1e-10)  # (3.30)
    assert cf.within_pulse(semi, omega).all()
    np.testing.assert_allclose(semi, exact, rtol=0.065)  # the impact comes at tau = 6 when omega = 0.3, not at 1
    np.testing.assert_allclose(semi[omega > 2], exact[omega > 2], rtol=0.016)
    np.testing.assert_allclose(semi[omega > 3], exact[omega > 3], rtol=0.006)


def test_semi_analytical_curve_is_wrong_close_to_the_end_of_case_1_1():
    semi, exact = cf.semi_analytical_amplitudes(4.0, 0.8).lower, cf.case_1_1_amplitudes(4.0, 0.8).lower
    assert semi > 1.2 * exact
    assert not cf.within_pulse(semi, 4.0)
    assert np.isnan(cf.semi_analytical_amplitudes(4.4, 0.85).lower)  # case 1.1 ends at 4.437


def test_ad_hoc_impact_time_is_exact_where_the_impact_is_at_the_initial_guess():
    """(3.29) is exact for an impact at tau = 1."""
    for omega in (3.5, 4.0, 4.4):
        a = float(cf.amplitude_of_impact_time(1.0, omega))
        assert cf.ad_hoc_impact_time(a, omega) == pytest.approx(1, abs=1e-12)


def test_upper_solution_of_the_semi_analytical_condition_is_outside_the_pulse():
    semi = cf.semi_analytical_amplitudes([4.0, 4.8], 0.9)
    assert np.isfinite(semi.upper).all()
    assert not cf.within_pulse(semi.upper, [4.0, 4.8]).any()


def test_semi_analytical_solutions_above_twice_case_2_are_not_returned():
    omega, eta = np.array([4.2327731092436975, 4.921008403361344, 6.002521008403361]), np.array([0.7, 0.8, 1.0])
    limit = 2 * cf.case_2_amplitude(omega)
    beyond = cf.ad_hoc_margin(np.linspace(limit, limit + 1, 400), omega, eta)
    assert ((beyond[:-1] >= 0) & (beyond[1:] < 0)).any(axis=0).all()  # there is one
    assert np.isnan(cf.semi_analytical_amplitudes(omega, eta).upper).all()
