"""Overturning conditions and curves, (3.8) to (3.22) and (3.31), and the thresholds that follow from them."""

import numpy as np
import pytest

from rocking import paper as cf
from rocking._solver.peak_response import peak_response
from tests.direct_integration import integrate

NONE = (np.nan, np.nan)
# omega: direct, then (overturns_from, survives_again) for eta 0.85, 0.90, 0.95, from an independent implementation
GOLDEN = {
    1: (1.418315, [(1.134352, 1.415149), (1.132047, 1.416384), (1.129869, 1.417427)]),
    2: (2.349903, [(1.231672, 2.291073), (1.225179, 2.314403), (1.219261, 2.333713)]),
    3: (3.631150, [(1.427271, 3.382365), (1.403565, 3.484663), (1.383855, 3.565544)]),
    4: (5.238964, [(1.940645, 4.543074), (1.795442, 4.850111), (1.709019, 5.070161)]),
    5: (7.168129, [(3.980175, 5.356347), (3.018600, 6.318071), (2.515902, 6.818777)]),
    6: (9.416966, [NONE, (5.164159, 7.669873), (4.055362, 8.778730)]),
}
LAST_DIGIT = 0.6e-6


@pytest.mark.parametrize("omega", GOLDEN)
def test_golden_thresholds_to_the_last_digit(omega):
    direct, pairs = GOLDEN[omega]
    found = cf.overturning_amplitudes(omega, [0.85, 0.90, 0.95])
    np.testing.assert_allclose(found.direct, direct, rtol=0, atol=LAST_DIGIT)
    np.testing.assert_allclose(
        np.transpose([found.overturns_from, found.survives_again]), pairs, rtol=0, atol=LAST_DIGIT
    )


@pytest.mark.parametrize(("omega", "eta"), [(1.0, 0.85), (2.5, 0.8), (4.2, 0.9), (5.0, 0.9), (0.7, 0.95), (0.5, 0.6)])
def test_thresholds_separate_outcomes_of_direct_integration(omega, eta):
    found = cf.overturning_amplitudes(omega, eta)
    for threshold, overturns_above in zip(found, (True, False, True), strict=True):
        for side in (-1, 1):
            a = threshold * (1 + side * 1e-8 * min(1.0, omega**2))
            assert overturns(a, omega, eta) == (overturns_above == (side > 0)), (threshold, side)


def overturns(a, omega, eta) -> bool:
    motion = integrate(a, omega, eta, most_impacts=40)
    if motion.overturns_freely:
        return True
    # only the first impact after the pulse can lead to overturning: its velocity follows from the energy
    y, v = motion.rotation, motion.velocity
    return bool(eta * np.sqrt(v * v + abs(y) * (2 - abs(y))) > 1)


def test_case_2_curve_satisfies_both_lines_of_its_condition():
    omega = np.geomspace(0.05, 50, 60)
    a = cf.case_2_amplitude(omega)
    np.testing.assert_allclose(cf.case_2_margin(a, omega) / a, 0, atol=5e-14)  # (3.10), second line
    assert (cf.growing_coefficient(a * (1 - 1e-9), omega) > 0).all()  # (3.8), (3.10), first line
    assert (cf.growing_coefficient(a * (1 + 1e-9), omega) < 0).all()


def test_free_rocking_on_the_case_2_curve_approaches_the_unstable_equilibrium():
    omega = np.array([1.0, 3.0, 8.0])
    y, v = cf.state_at_pulse_end(cf.case_2_amplitude(omega), omega)
    np.testing.assert_allclose(y + v, -1, atol=1e-12)  # B_ex0 = 0, first line of (3.10)


@pytest.mark.parametrize(("a", "omega"), [(2.0, 1.9), (3.0, 4.0), (4.0, 5.0), (6.0, 10.0)])
def test_case_1_2_impact_against_direct_integration(a, omega):
    after = cf.pulse_end(a, omega) + np.linspace(0, 5, 50)
    tau = cf.case_1_2_impact_time(a, omega)
    assert tau > cf.pulse_end(a, omega)
    assert cf.case_1_2_residual(a, omega, tau) == pytest.approx(0, abs=1e-12)  # (3.12)
    assert (cf.case_1_2_residual(a, omega, after[after < tau]) < 0).all()
    motion = integrate(a, omega, 0.9, shape=lambda phi: np.sin(phi) * (phi < 2 * np.pi), end=2 * np.pi)
    assert not motion.impact_times
    A, B = (motion.rotation + 1 - motion.velocity) / 2, (motion.rotation + 1 + motion.velocity) / 2
    since = np.log((1 + np.sqrt(1 - 4 * A * B)) / (2 * B))
    assert tau == pytest.approx(cf.pulse_end(a, omega) + since, rel=1e-10)  # (3.13)
    velocity = (2 * B * np.exp(since) - 2 * A * np.exp(-since)) / 2
    assert cf.case_1_2_impact_velocity(a, omega) == pytest.approx(velocity, rel=1e-10)  # (3.15)
    assert cf.free_velocity(a, omega, tau) == pytest.approx(velocity, rel=1e-10)  # (3.14)


def test_impact_velocity_is_nan_where_the_block_overturns_without_impact():
    omega = np.array([0.8, 1.15, 3.0])
    above = cf.case_2_amplitude(omega) * np.array([[1.001], [1.02], [1.5]])
    assert (cf.impact_velocity_squared(above, omega) < 0).any(axis=0).all()
    velocity = cf.case_1_2_impact_velocity(above, omega)
    assert np.isnan(velocity[cf.impact_velocity_squared(above, omega) < 0]).all()


def test_case_1_2_impact_time_where_the_exponential_overflows():
    # the limit is so close to case 2 here that the largest double below it is used
    omega = 5e-3
    a = np.nextafter(cf.limit_amplitude(omega), 1.0)
    time = cf.case_1_2_impact_time(a, omega)
    assert np.isfinite(time)
    assert time > 0


def test_condition_3_18_is_the_impact_velocity_squared():
    a, omega = np.meshgrid(np.linspace(1.1, 8, 30), np.linspace(0.5, 10, 30))
    np.testing.assert_allclose(cf.condition_3_18(a, omega), cf.impact_velocity_squared(a, omega), rtol=1e-8, atol=1e-10)


@pytest.mark.parametrize("eta", [0.7, 0.85, 0.96, 1.0])
def test_case_1_2_curve_solves_its_condition(eta):
    omega = np.linspace(0.6, 9, 80)
    interval = cf.case_1_2_amplitudes(omega, eta)
    limit, direct = cf.limit_amplitude(omega), cf.case_2_amplitude(omega)
    found = np.isfinite(interval.lower)
    assert (found == np.isfinite(interval.upper)).all()
    upper, w = interval.upper[found], omega[found]
    assert (interval.lower[found] >= limit[found]).all()
    assert (upper <= direct[found]).all()
    on_curve = found & (interval.lower > limit)
    np.testing.assert_allclose(cf.case_1_2_margin(interval.lower[on_curve], omega[on_curve], eta), 0, atol=1e-11)
    if eta < 1:
        np.testing.assert_allclose(cf.condition_3_18(upper, w), 1 / eta**2, rtol=1e-9)  # (3.18)
    else:
        np.testing.assert_allclose(upper, direct[found], rtol=1e-14)
    inside = np.sqrt(interval.lower[found] * upper)
    assert (cf.case_1_2_margin(inside, w, eta) > 0).all()  # (3.16), (3.17): B_i2 > 0 overturns


@pytest.mark.parametrize(
    ("a", "omega", "eta"), [(1.05, 2.0, 0.9), (1.3, 1.5, 0.8), (2.0, 5.0, 0.9), (1.0005, 0.3, 0.9)]
)
def test_case_1_1_impact_against_direct_integration(a, omega, eta):
    motion = integrate(a, omega, eta, most_impacts=99)
    assert cf.case_1_1_impact_time(a, omega) == pytest.approx(motion.impact_times[0], rel=1e-9)  # (3.21)
    assert cf.case_1_1_impact_velocity(a, omega) == pytest.approx(motion.impact_velocities[0], rel=1e-8)  # (3.22)
    if len(motion.impact_times) == 1:
        twice_growing = (
            2 * (motion.rotation + motion.velocity - 1) * np.exp(motion.impact_times[0] - cf.pulse_end(a, omega))
        )
        assert cf.case_1_1_margin(a, omega, eta) == pytest.approx(twice_growing, rel=1e-8, abs=1e-10)  # (3.19), (3.20)


def test_first_impact_within_the_pulse_exactly_below_the_limit():
    omega = np.geomspace(0.3, 30, 50)
    limit = cf.limit_amplitude(omega)
    assert np.isfinite(cf.case_1_1_impact_time(limit * (1 - 1e-9), omega)).all()
    assert np.isnan(cf.case_1_1_impact_time(limit * (1 + 1e-9), omega)).all()
    np.testing.assert_allclose(cf.limit_margin(limit, omega) / omega**2, 0, atol=1e-13)  # (3.31)
    y, v = cf.state_at_pulse_end(limit, omega)
    np.testing.assert_allclose(y * np.exp(-cf.pulse_end(limit, omega)), 0, atol=1e-14)
    np.testing.assert_allclose(v, cf.limit_velocity(omega), rtol=1e-7)


def test_limit_curve_has_the_recorded_values():
    np.testing.assert_allclose(1 / cf.limit_amplitude([0.5, 3.0, 15.0]), [0.89, 0.42, 0.34], atol=0.005)


def test_amplitude_of_impact_time_inverts_the_impact_time():
    omega = np.array([0.4, 1.0, 3.0, 7.0])[:, None]
    a = 1 + (cf.limit_amplitude(omega) - 1) * np.linspace(0.01, 0.99, 20)
    tau = cf.case_1_1_impact_time(a, omega)
    np.testing.assert_allclose(cf.amplitude_of_impact_time(tau, omega), a, rtol=1e-12)
    assert (np.diff(tau, axis=1) > 0).all()  # the impact time increases with the amplitude


def test_impact_time_tends_to_zero_at_the_uplift_limit():
    s = 1e-5
    assert cf.case_1_1_impact_time(np.hypot(1, s), 2.0) == pytest.approx(4 * s / 2.0, rel=1e-4)
    assert cf.case_1_1_impact_time(1.0, 2.0) == 0


@pytest.mark.parametrize("eta", [0.3, 0.5, 0.8, 0.9, 1.0])
def test_case_1_1_curve_solves_its_condition(eta):
    omega = np.linspace(0.15, 6, 80)
    interval = cf.case_1_1_amplitudes(omega, eta)
    found = np.isfinite(interval.lower)
    assert (found == (omega < cf.case_1_1_end(eta))).all()
    np.testing.assert_allclose(cf.case_1_1_margin(interval.lower[found], omega[found], eta), 0, atol=1e-6)
    accurate = found & (omega > 1)
    np.testing.assert_allclose(cf.case_1_1_margin(interval.lower[accurate], omega[accurate], eta), 0, atol=1e-11)
    limit = cf.limit_amplitude(omega)
    assert (interval.upper[found] <= limit[found]).all()
    turned = accurate & (interval.upper < limit)
    np.testing.assert_allclose(cf.case_1_1_margin(interval.upper[turned], omega[turned], eta), 0, atol=1e-11)
    inside = (interval.lower[accurate] + interval.upper[accurate]) / 2
    assert (cf.case_1_1_margin(inside, omega[accurate], eta) > 0).all()


def test_case_1_1_has_an_upper_branch_only_for_slow_pulses():
    slow, fast = cf.case_1_1_amplitudes([0.2, 0.3], 0.8).upper
    assert slow < cf.limit_amplitude(0.2)
    assert fast == cf.limit_amplitude(0.3)
    assert 0.8 * cf.limit_velocity(0.2) < 1 < 0.8 * cf.limit_velocity(0.3)


def test_case_1_1_ends_at_the_recorded_frequency_ratios():
    ends = cf.case_1_1_end([0.80, 0.85, 0.90, 0.96, 1.00])
    np.testing.assert_allclose(ends, [4.1, 4.4, 4.8, 5.2, 5.5], atol=0.051)  # recorded on a grid of 0.05
    np.testing.assert_allclose(cf.limit_velocity(ends), 1 / np.array([0.80, 0.85, 0.90, 0.96, 1.00]), rtol=1e-10)


def test_cases_1_1_and_1_2_meet_on_the_limit():
    below, above = cf.case_1_1_end(0.9) * (1 - 1e-7), cf.case_1_1_end(0.9) * (1 + 1e-7)
    assert cf.case_1_1_amplitudes(below, 0.9).lower == pytest.approx(cf.limit_amplitude(below), rel=1e-5)
    assert cf.case_1_2_amplitudes(above, 0.9).lower == pytest.approx(cf.limit_amplitude(above), rel=1e-5)


def test_no_overturning_after_impact_for_zero_restitution():
    assert np.isnan(cf.case_1_2_amplitudes([1.0, 5.0], 0.0).lower).all()


def test_blocks_between_the_two_intervals_of_one_impact_survive():
    during, after = cf.case_1_1_amplitudes(3.4372, 0.72), cf.case_1_2_amplitudes(3.4372, 0.72)
    ends = np.array([during.lower, during.upper, after.lower, after.upper])
    assert (np.diff(ends) > 0.1).all()
    for shift, expected in ((-1e-6, [False, True, False, True]), (1e-6, [True, False, True, False])):
        found = peak_response("sine", slenderness=1 / (ends + shift), frequency_ratio=3.4372, restitution=0.72)
        np.testing.assert_array_equal(found.overturned, expected)


def test_empty_arguments_give_empty_results():
    nothing = np.array([])
    assert all(part.shape == (0,) for part in cf.overturning_amplitudes(nothing, 0.9))
    assert cf.case_1_1_end(nothing).shape == (0,)
