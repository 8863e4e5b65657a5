"""Overturning without a further impact within the pulse, for any pulse, and published special cases."""

import math

import numpy as np
import pytest
from scipy.integrate import simpson

import rocking
from rocking import paper as cf
from rocking._excitation.pulses import PULSE_NAMES, SinusoidalPulse
from tests.direct_integration import integrate
from tests.excitation.test_smooth_pulse import Given


def test_rectangular_formula_of_housner_1963():
    omega = np.array([0.5, 1.0, 4.0])
    np.testing.assert_allclose(cf.rectangular_amplitude(omega), 1 / (1 - np.exp(-np.pi / omega)), rtol=1e-14)


@pytest.mark.parametrize(
    ("pulse", "closed"),
    [
        ("sine", cf.case_2_amplitude),
        ("half_sine", cf.half_sine_amplitude),
        ("rectangular", cf.rectangular_amplitude),
        ("cosine", cf.cosine_amplitude),
    ],
)
@pytest.mark.parametrize("omega", [0.5, 1.0, 3.0, 8.0])
def test_margin_without_impact_vanishes_on_the_published_curves(pulse, closed, omega):
    a = float(closed(omega))
    assert cf.margin_without_impact(pulse, a, omega) == pytest.approx(0, abs=1e-12)
    assert cf.margin_without_impact(pulse, a * (1 + 1e-9), omega) > 0
    assert cf.margin_without_impact(f"-{pulse}", a * (1 - 1e-9), omega) < 0


@pytest.mark.parametrize("name", PULSE_NAMES)
def test_first_uplift_phase_of_any_pulse(name):
    pulse = rocking.pulse(name)
    phi = np.linspace(pulse.start, pulse.end, 200_001)
    for a in (1.0 + 1e-6, 1.3, 4.0, 1e4):
        reached = np.flatnonzero(np.abs(a * pulse.shape(phi)) >= 1)
        uplift = cf.first_uplift_phase(pulse, a)
        if reached.size:
            assert phi[max(reached[0] - 1, 0)] - 1e-12 <= uplift <= phi[reached[0]] + 1e-12
        assert abs(a * pulse.shape(uplift)) >= 1 - 1e-12
    assert math.isnan(cf.first_uplift_phase(pulse, 0.99))
    assert cf.margin_without_impact(pulse, 0.99, 1.0) == -1


@pytest.mark.parametrize("name", PULSE_NAMES)
@pytest.mark.parametrize("omega", [0.01, 0.7, 5.0, 40.0])
def test_discounted_integral_against_quadrature(name, omega):
    pulse = rocking.pulse(name)
    start = pulse.start + 0.3 * (pulse.end - pulse.start)
    reach = min(pulse.end, start + 45 * omega)

    phi = np.linspace(start, reach, 400_001)
    values = pulse.shape(phi) * np.exp(-(phi - start) / omega) / omega
    plain = simpson(values, x=phi)
    assert cf.discounted_integral(name, omega, start) == pytest.approx(plain, rel=1e-10, abs=1e-13)


def test_margin_after_impact_vanishes_on_the_curves_of_the_sine():
    for omega, eta in ((2.0, 0.9), (3.0, 0.8)):
        a = float(cf.case_1_1_amplitudes(omega, eta).lower)
        motion = integrate(a, omega, eta)
        phase = omega * motion.impact_times[0] + float(cf.uplift_phase(a))
        margin = cf.margin_after_impact("sine", a, omega, eta, phase, motion.impact_velocities[0])
        assert margin == pytest.approx(0, abs=1e-9)  # (3.20)
        a = float(cf.case_1_2_amplitudes(omega, eta).upper)
        velocity = float(cf.case_1_2_impact_velocity(a, omega))
        assert cf.margin_after_impact("sine", a, omega, eta, 2 * np.pi, velocity) == pytest.approx(0, abs=1e-12)
        assert cf.margin_after_impact("-sine", a, omega, eta, 2 * np.pi, -velocity) == pytest.approx(0, abs=1e-12)


@pytest.mark.parametrize("omega", [0.3, 2.0])
def test_discounted_integral_of_samples_is_that_of_the_linear_pieces(omega):
    pulse = rocking.SampledPulse([0.0, 1.0, -0.4, 0.0, 0.2, 0.0])
    time, f = pulse.phases / omega, pulse.values
    slope = np.diff(f) / np.diff(time)
    exact = (f[:-1] + slope) * np.exp(-time[:-1]) - (f[1:] + slope) * np.exp(-time[1:])
    assert cf.discounted_integral(pulse, omega, 0.0) == pytest.approx(exact.sum(), rel=1e-13)


def test_discounted_integral_of_a_smooth_pulse_with_many_extremes():
    sinusoid = SinusoidalPulse("sum", 0.0, 3.0, (), ((1.0, 60.0, -0.5 * np.pi),))
    smooth = Given("smooth", 0.0, 3.0, lambda phi: np.sin(60.0 * phi))
    for start in (0.0, 1.1):
        exact = cf.discounted_integral(sinusoid, 0.5, start)
        assert cf.discounted_integral(smooth, 0.5, start) == pytest.approx(exact, rel=1e-12, abs=1e-15)


def test_a_peak_of_equal_samples_is_an_extreme():
    flat, pointed = rocking.SampledPulse([0.0, 1.0, 1.0, 0.0]), rocking.SampledPulse([0.0, 1.0, 1.0 - 1e-9, 0.0])
    assert len(flat.stationary) == 1
    assert len(rocking.SampledPulse([0.0, 1.0, 1.0, -0.5, -0.5, 0.2]).stationary) == 2
    assert rocking.SampledPulse([0.0, 0.5, 0.5, 1.0]).stationary == ()  # no extreme
    for of in (lambda one: cf.first_uplift_phase(one, 3.0), lambda one: cf.margin_without_impact(one, 3.0, 1.0)):
        assert of(flat) == pytest.approx(of(pointed), rel=1e-8)
