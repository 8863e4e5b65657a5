"""Coefficients and motion before the first impact, (3.3) to (3.11), against integration and 50-digit arithmetic."""

import mpmath as mp
import numpy as np
import pytest

from rocking import paper as cf
from tests.direct_integration import integrate

CASES = [(1.2, 1.0), (2.0, 3.0), (3.4, 2.3), (5.0, 8.0), (1.05, 0.6)]


def exact_arc(a: float, omega: float, tau: float) -> tuple[mp.mpf, mp.mpf]:
    """(3.4) with (3.7) in 50 digits, as printed."""
    with mp.workdps(50):
        a, omega, tau = mp.mpf(a), mp.mpf(omega), mp.mpf(tau)
        s, psi = mp.sqrt(a * a - 1), mp.asin(1 / a)
        A, B = (omega**2 + omega * s) / (omega**2 + 1) / 2, (omega**2 - omega * s) / (omega**2 + 1) / 2
        C = a / (omega**2 + 1)
        theta = -1 + C * mp.sin(omega * tau + psi) + A * mp.exp(-tau) + B * mp.exp(tau)
        return theta, B * mp.exp(tau) - A * mp.exp(-tau) + C * omega * mp.cos(omega * tau + psi)


@pytest.mark.parametrize("a", [1.0, 1 + 1e-12, 1.5, 40.0])
def test_ground_acceleration_at_uplift_phase_is_the_uplift_acceleration(a):
    assert a * np.sin(cf.uplift_phase(a)) == pytest.approx(1, rel=1e-15)  # (3.3)
    assert a * np.cos(cf.uplift_phase(a)) == pytest.approx(np.sqrt((a - 1) * (a + 1)), rel=1e-14)


def test_uplift_phase_is_accurate_near_amplitude_one():
    a = 1 + 1e-13
    with mp.workdps(50):
        exact = float(mp.pi / 2 - mp.asin(1 / mp.mpf(a)))
    assert np.pi / 2 - cf.uplift_phase(a) == pytest.approx(exact, abs=2e-16)


@pytest.mark.parametrize(("a", "omega"), CASES)
def test_integration_constants_satisfy_the_initial_conditions_of_rest(a, omega):
    A, B = cf.integration_constants(a, omega)  # (3.7)
    psi, C = cf.uplift_phase(a), a / (omega**2 + 1)
    assert -1 + C * np.sin(psi) + A + B == pytest.approx(0, abs=1e-15)
    assert B - A + C * omega * np.cos(psi) == pytest.approx(0, abs=1e-14)


@pytest.mark.parametrize(("a", "omega"), CASES)
def test_state_at_pulse_end_against_direct_integration(a, omega):
    motion = integrate(a, omega, 1.0, most_impacts=9) if cf.limit_margin(a, omega) > 0 else None
    y, v = cf.state_at_pulse_end(a, omega)  # (3.11)
    A0, B0, C0 = cf.coefficients(a, omega)
    T = cf.pulse_end(a, omega)
    assert y == pytest.approx((A0 * np.exp(-T) + B0 * np.exp(T)) / 2 - 1, rel=1e-11)  # (3.11) as printed
    assert v == pytest.approx((B0 * np.exp(T) - A0 * np.exp(-T) + C0 * omega) / 2, rel=1e-11)
    if motion is not None:
        assert [y, v] == pytest.approx([motion.rotation, motion.velocity], rel=1e-10)


def test_first_arc_is_accurate_where_the_printed_form_is_not():
    rng = np.random.default_rng(7)
    worst, worst_printed = 0.0, 0.0
    for _ in range(300):
        a, omega = 1 + 10 ** rng.uniform(-12, 1), 10 ** rng.uniform(-1, 1.5)
        tau = 10 ** rng.uniform(-4, 0.7)
        theta, velocity = exact_arc(a, omega, tau)
        worst = max(worst, abs(float(cf.rotation(a, omega, tau) / theta - 1)))
        worst = max(worst, abs(float(cf.angular_velocity(a, omega, tau) / velocity - 1)))
        worst_printed = max(worst_printed, abs(float(cf.printed_rotation(a, omega, tau) / theta - 1)))
    assert worst < 1e-12
    assert worst_printed > 0.1


def test_velocity_is_the_derivative_of_the_rotation():
    step = 1e-5
    for a, omega in CASES:
        for tau in (0.02, 0.4, 1.1):
            slope = (cf.rotation(a, omega, tau + step) - cf.rotation(a, omega, tau - step)) / (2 * step)
            assert cf.angular_velocity(a, omega, tau) == pytest.approx(float(slope), abs=1e-9)  # (3.22)


def test_rotation_obeys_the_equation_of_motion():
    step = 1e-3
    for a, omega in CASES:
        for tau in (0.1, 0.4, 1.1):
            y = [cf.rotation(a, omega, tau + k * step) for k in (-2, -1, 0, 1, 2)]
            curvature = (-y[0] + 16 * y[1] - 30 * y[2] + 16 * y[3] - y[4]) / (12 * step**2)
            ground = a * np.sin(omega * tau + cf.uplift_phase(a))
            assert curvature == pytest.approx(y[2] + 1 - ground, abs=1e-7)  # (3.2), theta < 0


def test_both_forms_of_d0_star_agree_with_the_energy_at_impact():
    a, omega = np.meshgrid(np.linspace(1.01, 12, 40), np.geomspace(0.3, 20, 40))
    np.testing.assert_allclose(cf.d0_star(a, omega), cf.d0_star_expanded(a, omega), rtol=1e-9, atol=1e-11)
    np.testing.assert_allclose(cf.impact_velocity_squared(a, omega), 1 - cf.d0_star(a, omega), rtol=1e-7, atol=1e-11)


def test_impact_velocity_is_accurate_for_short_pulses():
    a, omega = 1.5, 300.0
    with mp.workdps(50):
        s, w = mp.sqrt(mp.mpf(a) ** 2 - 1), mp.mpf(omega)
        T = (2 * mp.pi - mp.asin(1 / mp.mpf(a))) / w
        K = w / (w * w + 1)
        exact = 1 - K**2 * (w + s - a * mp.exp(T)) * (w - s + a * mp.exp(-T))
    assert abs(float(cf.impact_velocity_squared(a, omega) / exact - 1)) < 1e-14
    assert (
        abs(float((1 - cf.d0_star(a, omega)) / exact - 1)) > 1e-13
    )  # the product form cancels, the energy form does not


def test_no_overflow_for_very_low_frequency_ratios():
    omega = np.array([1e-3, 5e-3, 9e-3])
    for a in (1 + 1e-9, 1.5, 50.0):
        assert np.isfinite(cf.case_2_margin(a, omega)).all()
        assert np.isfinite(cf.limit_margin(a, omega)).all()
        assert not np.isnan(cf.d0_star(a, omega)).any()
    assert cf.case_2_amplitude(omega) == pytest.approx(np.sqrt(1 + omega**2), rel=1e-15)
