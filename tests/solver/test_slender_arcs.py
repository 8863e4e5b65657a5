"""Exact arcs of the slender block: accuracy at changes of branch, and comparison with Taylor steps."""

import mpmath
import numpy as np
import pytest

import rocking
from rocking._excitation.pulses import PULSE_NAMES, SinusoidalPulse
from rocking._solver.arcs.arc import (
    MAX_EXPONENT,
    SERIES_RADIUS,
    arc_state,
    cosh_minus_one_and_sinh,
    expand_series,
    rotation,
    velocity,
)
from rocking._solver.arcs.events import long_flight, short_flight
from rocking._solver.arcs.flight import set_angles, state_at
from rocking._solver.state import IMPACT, step_state
from rocking._solver.taylor.flight import flight_by_steps
from tests.kernels import first_flight, flight_from

SINUSOIDS = tuple(name for name in PULSE_NAMES if isinstance(rocking.pulse(name), SinusoidalPulse))


@pytest.mark.parametrize("h", [0.0, 1e-300, 1e-9, 1e-3, 0.3, 0.5 - 1e-16, 0.5, 0.7, 3.0, 40.0, 300.0])
def test_hyperbolic_functions_are_accurate_for_small_arguments(h):
    cosh1, sinh = cosh_minus_one_and_sinh(float(h))
    with mpmath.workprec(200):
        exact = mpmath.mpf(h)
        true = float(mpmath.cosh(exact) - 1), float(mpmath.sinh(exact))
    np.testing.assert_allclose((cosh1, sinh), true, rtol=1e-15)


def test_hyperbolic_functions_are_continuous_where_the_series_ends_and_never_overflow():
    below, above = cosh_minus_one_and_sinh(np.nextafter(0.5, 0.0)), cosh_minus_one_and_sinh(0.5)
    np.testing.assert_allclose(below, above, rtol=1.5e-15)
    assert np.isfinite(cosh_minus_one_and_sinh(1e9)).all()
    np.testing.assert_allclose(cosh_minus_one_and_sinh(1e9), np.exp(MAX_EXPONENT) / 2)


@pytest.mark.parametrize("name", SINUSOIDS)
@pytest.mark.parametrize("omega", [1e-2, 0.4, 3.0, 30.0])
def test_series_and_arc_agree_at_the_radius_of_the_series(name, omega):
    flight = first_flight(name, 0.5, omega)
    reach = SERIES_RADIUS / float(flight["max_rate"])
    set_angles(flight, float(flight["phase"]) + omega * reach, flight["cosine1"], flight["sine1"])
    z_arc, w_arc = arc_state(flight, reach, flight["cosine1"], flight["sine1"])
    expand_series(flight, 0.0, float(flight["w0"]), float(flight["q0"]), flight["cosine0"], flight["sine0"])
    z, w = rotation(flight, reach), velocity(flight, reach)
    # the arc is a difference of terms of the size of a h^2 or smaller; the series is exact to rounding
    size = 1.0 / 0.5 * reach * reach
    assert abs(z - z_arc) <= 2e-15 * max(1.0, size)
    assert abs(w - w_arc) <= 2e-15 * max(1.0, size / reach)


@pytest.mark.parametrize("name", SINUSOIDS)
def test_series_is_the_solution_in_many_digits(name):
    # z'' = z - q, by the integral z = - integral of sinh(h - s) q(s) ds, in multi-precision
    omega, slenderness = 2.3, 0.4
    flight = first_flight(name, slenderness, omega)
    phase, sign = float(flight["phase"]), float(flight["sign"])
    terms = rocking.pulse(name).terms
    with mpmath.workprec(120):

        def pulled(s):
            angle = mpmath.mpf(phase) + mpmath.mpf(omega) * s
            return 1 + sign * sum(c * mpmath.cos(w * angle + d) for c, w, d in terms) / mpmath.mpf(slenderness)

        for h in (0.05, 0.2, 0.6, 1.1):
            z_true = -mpmath.quad(lambda s, h=h: mpmath.sinh(h - s) * pulled(s), [0, h])
            w_true = -mpmath.quad(lambda s, h=h: mpmath.cosh(h - s) * pulled(s), [0, h])
            set_angles(flight, phase + omega * h, flight["cosine1"], flight["sine1"])
            z, w = state_at(flight, h, flight["cosine1"], flight["sine1"])
            assert abs(z - float(z_true)) <= 4e-15 * max(abs(float(z_true)), h * 1e-1)
            assert abs(w - float(w_true)) <= 4e-15 * max(abs(float(w_true)), 1e-1)


@pytest.mark.parametrize("omega", [0.3, 3.0])
def test_short_and_long_flight_agree_on_a_short_flight(omega):
    # initial velocities near the largest that `short_flight` accepts: 2.5 w0 = reach q0
    flight = first_flight("sine", 0.8, omega)
    phase = 0.3
    flight["interval"] = 0
    flight_from(flight, phase, 1.0, 1.0)
    q0, reach = float(flight["q0"]), SERIES_RADIUS / float(flight["max_rate"])
    to_cut = (float(flight["interval_phase"][1]) - phase) / omega
    taken = 0
    for share in (1e-6, 1e-3, 0.1, 0.5, 0.9, 0.99, 1.01):
        flight_from(flight, phase, share * reach * q0 / 2.5, 1.0)
        hopped = short_flight(flight, to_cut, 0.0)
        ended, h, w, _, peak = long_flight(flight)
        if hopped[0] >= 0.0:
            taken += 1
            assert ended == IMPACT
            np.testing.assert_allclose(hopped, (h, w, peak), rtol=2e-13)
    assert taken >= 3


@pytest.mark.parametrize("name", SINUSOIDS)
def test_flights_by_arcs_and_by_taylor_steps_agree(name):
    rng = np.random.default_rng(4)
    compared = 0
    for _ in range(60):
        slenderness, omega = float(rng.uniform(0.1, 0.95)), float(np.exp(rng.uniform(-1, 2.5)))
        arcs, steps = first_flight(name, slenderness, omega), first_flight(name, slenderness, omega)
        ended, h, w, z, peak = long_flight(arcs)
        ended_steps, w_steps, z_steps = flight_by_steps(steps, step_state(steps))
        h_steps, peak_steps = float(steps["elapsed"]), float(steps["largest_z"])
        if ended == IMPACT:
            compared += 1
            assert ended_steps == IMPACT
            np.testing.assert_allclose((h_steps, w_steps, peak_steps), (h, w, peak), rtol=1e-10)
        elif ended_steps != IMPACT and z + abs(w) < 10.0 and h == pytest.approx(h_steps, rel=1e-14):
            np.testing.assert_allclose((z_steps, w_steps), (z, w), rtol=1e-10, atol=1e-12)
    assert compared > 10 or name in ("rectangular", "half_sine")


@pytest.mark.parametrize("name", SINUSOIDS)
def test_responses_by_arcs_and_by_taylor_steps_agree(name):
    rng = np.random.default_rng(5)
    n = 1500
    question = {
        "slenderness": rng.uniform(0.02, 0.999, n),
        "frequency_ratio": np.exp(rng.uniform(-1.5, 2.5, n)),
        "restitution": rng.uniform(0, 1, n),
    }
    arcs = rocking.peak_response(name, **question)
    steps = rocking.peak_response(name, **question, alpha=1e-9)  # (2.2) then differs from (3.1) by 1e-18
    np.testing.assert_array_equal(arcs.outcome, steps.outcome)
    np.testing.assert_array_equal(arcs.exceeded_alpha, steps.exceeded_alpha)
    counted = ~(arcs.chatter | steps.chatter)
    np.testing.assert_array_equal(arcs.impacts[counted], steps.impacts[counted])
    np.testing.assert_allclose(steps.uplift_time, arcs.uplift_time, rtol=1e-13, atol=1e-14)
    np.testing.assert_allclose(steps.first_impact_time, arcs.first_impact_time, rtol=1e-9)
    # near a threshold rounding errors of a peak are amplified without bound: most peaks agree to ten digits
    error = np.abs(steps.peak_rotation / np.where(arcs.peak_rotation > 0, arcs.peak_rotation, 1.0) - 1)
    error = error[np.isfinite(error)]
    assert np.median(error) < 2e-14
    assert np.quantile(error, 0.98) < 1e-10
    assert error.max() < 1e-6


def test_a_peak_after_a_minimum_of_the_velocity_is_found():
    """w > 0 at both ends of a monotone interval and negative inside; found among 420,000 random blocks."""
    groups = {
        "slenderness": 0.9716350970804516,
        "frequency_ratio": 0.41023686938728526,
        "restitution": 0.993624995799155,
    }
    peak = float(rocking.peak_response("c1", **groups).peak_rotation)
    motion = rocking.time_history("c1", **groups, samples=200_000)
    assert np.abs(motion.rotation.values).max() == pytest.approx(peak, rel=1e-6)
