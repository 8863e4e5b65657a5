"""Maximum-likelihood fits: known answers, coverage of the intervals, data without a curve."""

import math

import numpy as np
import pytest
from scipy.optimize import minimize
from scipy.stats import binomtest, logistic, norm

from rocking.suites.curve import curve_probability
from rocking.suites.fits import FitStatus, binomial_interval, fit_curve

LEVELS = np.geomspace(0.3, 10.0, 15)


def outcomes_of(capacity, levels=LEVELS):
    """Outcomes (levels, records) of records that reach the limit state from their capacity on."""
    return capacity <= np.asarray(levels)[:, None]


def sample(records, median, beta, seed):
    return outcomes_of(median * np.exp(beta * np.random.default_rng(seed).standard_normal(records)))


@pytest.mark.parametrize(("model", "distribution"), [("lognormal", norm), ("logistic", logistic)])
def test_fit_maximises_the_likelihood_that_scipy_maximises(model, distribution):
    reached = sample(44, 2.0, 0.4, 1)
    count = reached.sum(axis=1)

    def loss(parameters):
        p = np.clip(distribution.cdf((np.log(LEVELS) - parameters[0]) / math.exp(parameters[1])), 1e-300, 1 - 1e-16)
        return -(count * np.log(p) + (44 - count) * np.log1p(-p)).sum()

    expected = minimize(loss, [0.0, 0.0], method="Nelder-Mead", options={"xatol": 1e-9, "fatol": 1e-12})
    fit = fit_curve(reached, LEVELS, model=model)
    assert fit.status == FitStatus.FITTED
    assert math.log(fit.median) == pytest.approx(expected.x[0], abs=1e-6)
    assert fit.dispersion == pytest.approx(math.exp(expected.x[1]) * distribution.std(), rel=1e-6)
    assert fit.log_likelihood == pytest.approx(-expected.fun, abs=1e-7)
    assert 0.0 < fit.deviance < 30.0
    p = curve_probability(model, LEVELS, fit.median, fit.dispersion)
    assert fit.largest_deviation == pytest.approx(np.abs(p - count / 44).max())


@pytest.mark.parametrize(("records", "suites"), [(10, 300), pytest.param(40, 200, marks=pytest.mark.long)])
def test_intervals_hold_the_answer_as_often_as_they_state(records, suites):
    fits = [fit_curve(sample(records, 2.0, 0.4, seed), LEVELS) for seed in range(suites)]
    assert {fit.status for fit in fits} == {FitStatus.FITTED}
    median = np.mean([fit.median_interval[0] <= 2.0 <= fit.median_interval[1] for fit in fits])
    spread = np.mean([fit.dispersion_interval[0] <= 0.4 <= fit.dispersion_interval[1] for fit in fits])
    assert 0.92 <= median <= 0.99
    assert 0.89 <= spread <= 0.98
    assert np.mean([math.log(fit.median) for fit in fits]) == pytest.approx(math.log(2.0), abs=0.03)


def test_intervals_do_not_shrink_with_more_levels():
    # levels of one record depend on each other; intervals that took them as independent would shrink by sqrt(10)
    capacity = 2.0 * np.exp(0.4 * np.random.default_rng(5).standard_normal(30))
    grids = [np.geomspace(0.3, 10.0, count) for count in (15, 150)]
    coarse, fine = np.log([fit_curve(outcomes_of(capacity, levels), levels).median_interval for levels in grids])
    assert np.ptp(fine) == pytest.approx(np.ptp(coarse), rel=0.1)


def test_unit_of_the_intensity_does_not_matter():
    reached = sample(25, 2.0, 0.4, 3)
    in_g, in_si = fit_curve(reached, LEVELS), fit_curve(reached, LEVELS * 9.80665)
    assert in_si.median == pytest.approx(9.80665 * in_g.median, rel=1e-8)
    assert in_si.median_interval == pytest.approx([9.80665 * end for end in in_g.median_interval], rel=1e-7)
    assert in_si.dispersion == pytest.approx(in_g.dispersion, rel=1e-8)


def test_falling_curve_is_the_mirror_of_the_rising_one():
    reached = sample(25, 2.0, 0.4, 3)
    rising, falling = fit_curve(reached, LEVELS), fit_curve(reached[::-1], 1.0 / LEVELS[::-1], falling=True)
    assert falling.median == pytest.approx(1.0 / rising.median)
    assert falling.dispersion == pytest.approx(-rising.dispersion)
    assert falling.median_interval == pytest.approx([1.0 / end for end in rising.median_interval[::-1]])
    assert falling.dispersion_interval == pytest.approx([-end for end in rising.dispersion_interval[::-1]])
    p = curve_probability("lognormal", [0.1, 10.0], falling.median, falling.dispersion)
    assert p[0] > 0.99
    assert p[1] < 0.01


def test_separated_outcomes_give_a_step():
    reached = np.array([[0] * 8, [0] * 8, [1] * 8, [1] * 8])
    fit = fit_curve(reached, [1.0, 2.0, 4.0, 8.0])
    assert fit.status == FitStatus.SEPARATED
    assert fit.median == pytest.approx(math.sqrt(8.0))
    assert fit.dispersion == 0.0
    assert fit.median_interval == (2.0, 4.0)
    assert fit.dispersion_interval == (0.0, math.inf)
    assert fit.largest_deviation == 0.0


def test_step_at_a_level_of_its_own():
    reached = np.array([[0, 0, 0], [0, 1, 0], [1, 1, 1]])
    fit = fit_curve(reached, [1.0, 2.0, 4.0])
    assert fit.status == FitStatus.SEPARATED
    assert fit.median == pytest.approx(2.0)
    assert fit.log_likelihood == pytest.approx(math.log(1 / 3) + 2 * math.log(2 / 3))
    assert fit.median_interval == (0.0, math.inf)  # three records do not bound it at 95 %


@pytest.mark.parametrize(("value", "status"), [(False, FitStatus.NONE_REACHES), (True, FitStatus.ALL_REACH)])
@pytest.mark.parametrize("records", [3, 20])
def test_median_of_one_outcome_alone_is_bounded_on_one_side(value, status, records):
    fit = fit_curve(np.full((4, records), value), [1.0, 2.0, 4.0, 8.0])
    assert fit.status == status
    assert math.isnan(fit.median)
    bounded = 0.5**records < 0.025
    expected = (0.0, 1.0 if bounded else math.inf) if value else (8.0 if bounded else 0.0, math.inf)
    assert fit.median_interval == expected


def test_probability_that_falls_has_no_rising_curve():
    reached = np.array([[1, 1, 1, 0], [1, 0, 1, 0], [0, 0, 1, 0]])
    fit = fit_curve(reached, [1.0, 2.0, 3.0])
    assert fit.status == FitStatus.NO_TREND
    assert math.isnan(fit.median)
    assert fit_curve(reached, [1.0, 2.0, 3.0], falling=True).status == FitStatus.FITTED


def test_one_record_gives_no_interval():
    fit = fit_curve(np.array([[0], [1], [0], [1], [1]]), [1.0, 2.0, 3.0, 4.0, 5.0])
    assert fit.status == FitStatus.FITTED
    assert fit.median_interval == (0.0, math.inf)
    assert fit.dispersion_interval == (0.0, math.inf)


def test_binomial_interval_is_that_of_scipy():
    low, high = binomial_interval(np.arange(8), 7, 0.9)
    for count in range(8):
        expected = binomtest(count, 7).proportion_ci(0.9, method="exact")
        assert (low[count], high[count]) == pytest.approx((expected.low, expected.high), abs=1e-12)
