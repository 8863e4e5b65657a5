"""Intervals with changes of unknown size, against those of Student for a mean."""

import numpy as np
import pytest
from rocking_assessment._evidence.variance_components import mixture
from scipy.special import stdtrit

from tests.sampling import number

SAMPLES, GROUPS = 8, 6


def groups_and_mean():
    """Derivatives by the mean of all samples, and by the change of each group."""
    change = np.repeat(np.eye(GROUPS), SAMPLES, axis=0)
    return np.ones((SAMPLES * GROUPS, 1)), change


def test_large_changes_give_the_interval_of_student():
    mean, change = groups_and_mean()
    values = np.array([0.03, -0.02, 0.05, 0.01, -0.04, 0.02])
    y = change @ values
    noise = 1e-5
    estimate = mixture(y, mean, [change], noise**2, 1e4)
    half_width = stdtrit(GROUPS - 1, 0.975) * values.std(ddof=1) / np.sqrt(GROUPS)
    spread = np.sum(estimate.weight * (estimate.mean[:, 0] - values.mean()) ** 2)
    assert spread < 1e-6
    centred = estimate._replace(mean=estimate.mean - values.mean())
    assert centred.half_widths(0.95)[0] == pytest.approx(half_width, rel=0.1)


def test_without_changes_the_interval_is_that_of_least_squares():
    mean, change = groups_and_mean()
    rng = np.random.default_rng(3)
    noise = 1.0  # the changes of the grid are at most half of it
    y = noise * rng.normal(size=SAMPLES * GROUPS)
    y -= y.mean()
    estimate = mixture(y, mean, [1e-3 * change], noise**2, 1e4)
    assert estimate.half_widths(0.95)[0] == pytest.approx(1.96 * noise / np.sqrt(SAMPLES * GROUPS), rel=0.01)
    assert estimate.weight.sum() == pytest.approx(1.0)


def test_intervals_of_two_kinds_of_changes_hold_the_mean():
    mean, change = groups_and_mean()
    slope = change * np.tile(np.linspace(-1.0, 1.0, SAMPLES), GROUPS)[:, None]
    rng = np.random.default_rng(6)
    held = 0
    runs = number(12, 400)
    for _ in range(runs):
        y = change @ (0.02 * rng.normal(size=GROUPS)) + slope @ (0.1 * rng.normal(size=GROUPS))
        y += 0.01 * rng.normal(size=y.size)  # about a mean of 0
        estimate = mixture(y, mean, [change, slope], 1e-4, 40.0)
        best = float(estimate.weight @ estimate.mean[:, 0])
        held += abs(best) <= estimate._replace(mean=estimate.mean - best).half_widths(0.95)[0]
    assert held / runs >= number(0.75, 0.93)
