"""The solver against the closed forms of sections 3 and 4, where those are exact."""

import numpy as np
import pytest

import rocking
from rocking import PULSE_NAMES, Outcome, paper
from tests.sampling import number

SIGNED = tuple(sign + name for name in PULSE_NAMES for sign in ("", "-"))


@pytest.fixture(scope="module")
def sine_cells():
    rng = np.random.default_rng(12)
    n = number(6_000, 40_000)
    slenderness, omega = rng.uniform(0.05, 0.98, n), np.exp(rng.uniform(-0.5, 2.5, n))
    eta = rng.uniform(0.3, 1.0, n)
    found = rocking.peak_response("sine", slenderness=slenderness, frequency_ratio=omega, restitution=eta)
    return 1 / slenderness, omega, eta, found


def test_uplift_of_the_sine(sine_cells):
    a, omega, _, found = sine_cells
    np.testing.assert_allclose(found.uplift_time, np.arcsin(1 / a) / omega, rtol=2e-15, atol=5e-16)  # (3.3)


def test_first_impact_within_the_pulse(sine_cells):
    a, omega, _, found = sine_cells
    during = np.isfinite(found.first_impact_time)
    assert during.sum() > 500
    early = paper.limit_margin(a, omega) < 0  # (3.31)
    clear = np.abs(paper.limit_margin(a, omega)) > 1e-9
    np.testing.assert_array_equal(during[clear], early[clear])
    h = paper.case_1_1_impact_time(a, omega)[during]
    np.testing.assert_allclose(found.first_impact_time[during], h, rtol=1e-10)
    v = paper.case_1_1_impact_velocity(a, omega)[during]
    np.testing.assert_allclose(found.first_impact_velocity[during], v, rtol=1e-8)


def test_peak_above_the_limit_curve(sine_cells):
    a, omega, eta, found = sine_cells
    late = (paper.limit_margin(a, omega) > 1e-9) & (found.outcome == Outcome.RECOVERS)
    after = late & (found.peak_mode == 3)  # in free rocking after the first impact
    assert after.sum() > 80
    np.testing.assert_allclose(
        found.peak_rotation[after], paper.case_1_2_peak(a, omega, eta)[after], rtol=1e-9
    )  # (4.13)
    overturns = (paper.limit_margin(a, omega) > 1e-9) & found.overturned
    assert np.isnan(paper.case_1_2_peak(a, omega, eta)[overturns]).all()
    before = late & (found.peak_mode <= 1)
    closed = np.nan_to_num(paper.case_1_2_peak(a, omega, eta)[before])
    assert (found.peak_rotation[before] >= closed * (1 - 1e-12)).all()


def test_outcomes_of_the_sine(sine_cells):
    a, omega, eta, found = sine_cells
    closed = paper.overturning_amplitudes(omega, eta)
    falls = (a >= closed.direct) | ((a > closed.overturns_from) & (a < closed.survives_again))
    islands = found.overturned & (found.impacts >= 3)  # which the closed forms do not cover
    np.testing.assert_array_equal(found.overturned & ~islands, falls)
    assert (a[islands] < 1 / 0.89).all()
    assert (omega[islands] < 1.15).all()
    assert (found.impacts[islands] % 2 == 1).all()
    directly = found.outcome == Outcome.OVERTURNED_DIRECTLY
    np.testing.assert_array_equal(directly, a >= closed.direct)


def test_a_block_that_rests_and_uplifts_again_may_overturn_after_two_impacts():
    """At eta = 0.0055 the impacts accumulate to rest; the number of impacts need not be odd then."""
    group = {"slenderness": 0.9466138403728683, "frequency_ratio": 0.343037995180433}
    found = rocking.peak_response("sine", **group, restitution=0.005539619256187129)
    assert (bool(found.overturned), int(found.impacts)) == (True, 2)


@pytest.mark.parametrize("name", SIGNED)
def test_overturning_without_a_further_impact_for_every_pulse(name):
    pulse = rocking.pulse(name)
    rng = np.random.default_rng(13)
    n = 120
    a, omega = 1 / rng.uniform(0.05, 0.95, n), np.exp(rng.uniform(-0.5, 2.5, n))
    found = rocking.peak_response(pulse, slenderness=1 / a, frequency_ratio=omega, restitution=0.85)
    compared = 0
    for i in range(n):
        margin = paper.margin_without_impact(pulse, a[i], omega[i])
        if found.outcome[i] == Outcome.OVERTURNED_DIRECTLY:
            assert margin > -1e-9
        elif np.isnan(
            found.first_impact_time[i]
        ):  # no impact during the pulse: the outcome is decided by the one after it
            compared += 1
            assert margin < 1e-9
        elif found.impacts[i] == 1:
            compared += 1
            phase = pulse.start + omega[i] * (found.uplift_time[i] + found.first_impact_time[i])
            after = paper.margin_after_impact(pulse, a[i], omega[i], 0.85, phase, found.first_impact_velocity[i])
            assert (after > -1e-9) or not found.overturned[i]
    assert compared > 0


@pytest.mark.slow
@pytest.mark.parametrize("rigid", [False, True])
def test_random_cells_have_a_response(rigid):
    rng = np.random.default_rng(14)
    n = number(20_000, 1_000_000) // len(PULSE_NAMES) + 1
    for name in PULSE_NAMES:
        slenderness = np.minimum(np.exp(rng.uniform(np.log(1e-3), 0.0, n)), 1 - 1e-9)
        slenderness[: n // 10] = 1 - np.exp(rng.uniform(np.log(1e-9), np.log(0.1), n // 10))
        found = rocking.peak_response(
            name,
            slenderness=slenderness,
            frequency_ratio=np.exp(rng.uniform(np.log(0.02), np.log(100.0), n)),
            restitution=rng.uniform(0, 1, n),
            alpha=np.exp(rng.uniform(np.log(1e-8), np.log(1.5), n)) if rigid else None,
        )
        np.testing.assert_array_equal(np.isnan(found.peak_rotation), found.overturned)
        standing = found.peak_rotation[~found.overturned]
        assert ((standing >= 0) & (standing < np.inf)).all()
        assert (found.outcome != Outcome.NO_UPLIFT).all()
        assert np.isfinite(found.uplift_time).all()
