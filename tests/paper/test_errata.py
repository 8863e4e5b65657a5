"""Misprints of the paper: the printed form fails, the corrected form holds."""

import inspect
import math
from pathlib import Path

import numpy as np
import pytest
import yaml
from scipy.integrate import solve_ivp

import rocking
from rocking import paper as cf
from rocking._base.errors import InvalidArgumentError
from rocking.paper import Orientation, quantity_of
from tests.direct_integration import integrate, peak_of_free_rocking

CONFIG = Path(__file__).parents[2] / "workflow" / "config" / "paper.yaml"


def test_3_3_uplift_phase():
    a, alpha = 2.0, 0.2
    with np.errstate(invalid="ignore"):
        printed = np.arcsin(1 / alpha)  # a slender block would have sin(psi) = 5
    assert np.isnan(printed)
    # |a f| is below 1 just before psi and above 1 just after it
    psi = cf.uplift_phase(a)
    assert a * math.sin(psi - 1e-6) < 1 < a * math.sin(psi + 1e-6)


@pytest.mark.parametrize(("omega", "a"), [(4.0, 3.0), (5.0, 4.5), (8.0, 6.0)])
def test_3_9_second_line_against_integration(omega, a):
    motion = integrate(a, omega, 0.9)
    assert not motion.impact_times
    y, v = motion.rotation, motion.velocity
    energy = v * v - y * (y + 2)  # squared velocity at the impact after the pulse, 1 - D0*
    corrected = cf.d0_star_expanded(a, omega)
    printed = corrected * (omega**2 + 1) / omega
    assert corrected == pytest.approx(1 - energy, rel=1e-9)
    assert printed != pytest.approx(1 - energy, rel=0.1)


def test_3_9_second_line_at_the_recorded_point():
    omega, a, T = 2.3, 3.4, 1.75
    s, K = math.sqrt(a * a - 1), omega / (omega**2 + 1)
    bracket = omega**2 - 2 * a**2 + 1 + (s + omega) * a * math.exp(-T) + (s - omega) * a * math.exp(T)
    product = K * (omega + s - a * math.exp(T)) * K * (omega - s + a * math.exp(-T))
    assert product == pytest.approx(0.67238, abs=5e-6)
    assert K**2 * bracket == pytest.approx(product, rel=1e-12)  # corrected
    assert K * bracket == pytest.approx(1.83880, abs=5e-6)  # printed


def test_after_3_31_assignment_of_conditions_to_cases():
    omega, eta = 3.0, 0.9
    of_3_18 = float(cf.case_1_2_amplitudes(omega, eta).upper)
    of_3_30 = float(cf.semi_analytical_amplitudes(omega, eta).lower)
    assert cf.condition_3_18(of_3_18, omega) == pytest.approx(1 / eta**2, rel=1e-10)
    assert cf.ad_hoc_margin(of_3_30, omega, eta) == pytest.approx(0, abs=1e-10)
    assert not integrate(of_3_18, omega, eta).impact_times  # no impact in the pulse: case 1.2, printed as 1.1
    assert len(integrate(of_3_30, omega, eta).impact_times) == 1  # impact in the pulse: case 1.1, printed as 1.2


def test_before_4_3_equation_with_six_variables():
    of_3_31 = inspect.signature(cf.limit_margin).parameters
    assert len(of_3_31) == 2  # printed: (3.31), which depends on a and omega only
    of_4_2 = [quantity_of(name) for name in ("theta", "alpha", "p", "a_g/g", "omega_g", "eta")]
    assert len(of_4_2) == 6  # right: (4.2)
    dimensions = {(q.length, q.time) for q in of_4_2} - {(0, 0)}
    assert dimensions == {(0, -1)}  # one reference dimension, time, hence the five groups of (4.3)


def test_4_8_argument_of_the_response_function():
    printed, right = quantity_of("a_g/(a_g/(g*alpha))"), quantity_of("a_g/g")  # a_g/a with a of (3.6), and a_g/g
    assert (printed.length, printed.time) != (0, 0)
    assert (right.length, right.time) == (0, 0)
    assert right.orientation is Orientation.LZ  # as (4.8) needs it: l_z^e2


@pytest.mark.parametrize("velocity", [0.1, 0.5, 0.9])
def test_4_12_energy_against_integration(velocity):
    peak = peak_of_free_rocking(velocity)
    alpha = 1e-3
    gained = math.cos(alpha - peak * alpha) - math.cos(alpha)  # corrected, in units of m g R
    printed = 1 - math.cos(alpha - peak * alpha)
    kinetic = velocity**2 * alpha**2 / 2  # I p^2 = m g R
    assert gained == pytest.approx(kinetic, rel=1e-5)
    assert printed != pytest.approx(kinetic, rel=0.1)
    assert cf.peak_of_velocity(velocity) == pytest.approx(peak, rel=1e-9)


@pytest.mark.parametrize("by_pulse", [False, True], ids=["(4.14)", "(4.15)"])
def test_4_14_and_4_15_small_forms_against_integration(by_pulse):
    a, omega, eta = 3.0, 40.0, 0.85
    motion = integrate(a, omega, eta)
    y, v = motion.rotation, motion.velocity
    speed = eta * math.sqrt(v * v - y * (y + 2))
    scale = a if by_pulse else 1
    peak = peak_of_free_rocking(speed) / scale
    corrected = cf.small_peak_by_pulse(a, omega, eta) if by_pulse else cf.small_peak(a, omega, eta)
    printed = eta**2 / 2 * math.sqrt(1 - cf.d0_star(a, omega)) / scale
    assert speed < 0.15
    assert corrected == pytest.approx(peak, rel=speed**2 / 3)
    assert printed > 5 * peak


def test_4_16_scale_function_against_integration():
    a = 3.0
    for omega in (20.0, 40.0, 80.0):
        motion = integrate(a, omega, 1.0)
        f = motion.velocity**2 - motion.rotation * (motion.rotation + 2)
        assert cf.scale_function(a, omega) == pytest.approx(f, rel=1e-8)
        assert math.sqrt(1 - cf.d0_star(a, omega)) > 1.5 * f


@pytest.mark.parametrize("theta", [-0.4, -0.1])
@pytest.mark.parametrize("u", [-0.5, 0.0, 0.3])
def test_5_1_sign_for_negative_rotation(theta, u):
    alpha = 0.3
    exact = -math.sin(-alpha - theta) - u * math.cos(-alpha - theta)  # (2.2), theta < 0, u in g

    def equation_5_1(last):
        bracket = (u * math.tan(alpha) + 1) * math.sin(theta) + last * math.cos(theta)
        return math.cos(alpha) * bracket

    assert equation_5_1(math.tan(alpha) - u) == pytest.approx(exact, rel=1e-12)  # corrected
    off = exact - equation_5_1(u - math.tan(alpha))  # printed
    assert off == pytest.approx(2 * (math.sin(alpha) - u * math.cos(alpha)) * math.cos(theta), rel=1e-12)


def test_figure_captions_histories_come_from_3_2():
    assert list(inspect.signature(cf.uplift_phase).parameters) == ["amplitude"]  # (3.3) has no time in it
    a, omega, tau, step = 2.0, 3.0, 0.8, 1e-3
    y = [float(cf.rotation(a, omega, tau + k * step)) for k in (-1, 0, 1)]
    ground = a * math.sin(omega * tau + cf.uplift_phase(a))
    assert (y[0] - 2 * y[1] + y[2]) / step**2 == pytest.approx(y[1] + 1 - ground, abs=1e-5)  # (3.2)


def test_figure_8_restitutions():
    text, caption = np.arange(0.80, 0.961, 0.02), np.arange(0.82, 0.961, 0.02)
    assert (len(text), len(caption)) == (9, 8)
    computed = yaml.safe_load(CONFIG.read_text())["restitution"]
    assert all(np.isclose(computed, eta).any() for eta in text)  # the text is right: the plot has nine curves


def test_figure_3_caption_numerical_condition():
    omega, eta = 1.5, 0.9
    on_curve = float(cf.case_1_1_amplitudes(omega, eta).lower)
    motion = integrate(on_curve, omega, eta)
    (time,) = motion.impact_times
    exact = cf.printed_rotation(on_curve, omega, time)  # (3.21)
    printed = cf.ad_hoc_residual(on_curve, omega, time)  # (3.28), the approximation
    assert exact == pytest.approx(0, abs=1e-8)
    assert abs(printed) > 0.01


def test_above_4_1_equation_that_is_multiplied():
    a, omega, tau = 2.0, 3.0, 0.8
    psi = float(cf.uplift_phase(a))
    motion = integrate(a, omega, 0.9, end=psi + omega * tau)
    # (4.1) has the sine and the forced constants, as (3.4) has; (3.5) is free rocking, without them
    A0, B0, _ = cf.coefficients(a, omega)
    free = (A0 * math.exp(-tau) + B0 * math.exp(tau)) / 2 - 1
    forced = free + a / (omega**2 + 1) * math.sin(omega * tau + psi)
    assert forced / a == pytest.approx(motion.rotation / a, rel=1e-8)
    assert free / a != pytest.approx(motion.rotation / a, rel=0.1)


def test_below_3_12_condition_that_takes_the_impact_time():
    a, omega = 3.0, 4.0
    time = float(cf.case_1_2_impact_time(a, omega))
    velocity = float(cf.free_velocity(a, omega, time))  # left side of (3.17) with (3.13) inserted, over 2
    assert velocity**2 == pytest.approx(float(cf.condition_3_18(a, omega)), rel=1e-12)  # becomes (3.18)
    assert "time" not in inspect.signature(cf.condition_3_18).parameters  # which has no time of impact in it


def test_section_6_figure_10_is_not_of_slender_blocks():
    # in the slender formulation all angles would have one threshold; those of figure 10 differ
    slender, rigid = (
        rocking.thresholds("sine", frequency_ratio=4.0, restitution=0.85, alpha=alpha).amplitude
        for alpha in (None, math.radians(20))
    )
    assert np.all(np.abs(rigid / slender - 1) > 0.005)


def test_section_7_small_rotations_are_not_exactly_self_similar():
    alpha = np.radians([1e-4, 20.0])
    tiny, large = (
        rocking.peak_response("sine", slenderness=0.6, frequency_ratio=8.0, restitution=0.85, alpha=a).peak_rotation
        * a
        / np.sin(a)
        for a in alpha
    )
    slender = float(rocking.peak_response("sine", slenderness=0.6, frequency_ratio=8.0, restitution=0.85).peak_rotation)
    assert slender < 0.15  # small rotations
    assert tiny == pytest.approx(slender, rel=1e-6)  # exact in the slender limit
    assert 1e-4 < abs(large / slender - 1) < 0.05  # practically, not exactly, for other blocks


def test_below_3_8_manifold_without_the_growing_exponential():
    omega = 3.0
    a = float(cf.case_2_amplitude(omega))
    y, v = (float(state) for state in cf.state_at_pulse_end(a, omega))
    assert y + v + 1 == pytest.approx(0.0, abs=1e-12)  # B = 0: theta/alpha = -1 is the unstable equilibrium
    duration = 3.0
    free = solve_ivp(lambda _, state: [state[1], state[0] + 1.0], (0.0, duration), [y, v], rtol=1e-12, atol=1e-14)
    # the motion comes closer to the equilibrium: its stable manifold; on the unstable one it would move away as e^tau
    assert abs(free.y[0, -1] + 1) == pytest.approx(abs(y + 1) * math.exp(-duration), rel=1e-6)


def test_symbol_alpha_is_not_accepted_as_amplitude():
    # (3.3) and (4.8) confuse a and alpha because of the similar symbols
    with pytest.raises(InvalidArgumentError, match="`amplitude`"):
        cf.uplift_phase(0.2)
