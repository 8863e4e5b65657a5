"""Lowest thresholds of arrays of bodies: those of the search of one body, confirmed from both sides by the solver."""

import numpy as np
import pytest

import rocking
from rocking._dimensional.lowest_thresholds import lowest_thresholds
from rocking._dimensional.problem import Problem
from rocking._excitation.pulses import as_pulse
from tests.sampling import but_long


def random_bodies(seed: int, count: int) -> rocking.RigidBody:
    """Bodies of 0.2 to 2.4 m, every other one with an offset centre of mass."""
    rng = np.random.default_rng(seed)
    height = np.exp(rng.uniform(np.log(0.1), np.log(1.2), count))
    half = height * rng.uniform(0.1, 0.6, count)
    offset = np.where(np.arange(count) % 2, rng.uniform(0.6, 1.0, count), 1.0)
    return rocking.RigidBody(left=half * offset, right=half, height=height)


PERIODS = {"sine": 0.6, "cosine": 0.9, "c2": 1.0, "ricker_antisymmetric": 0.8}


@pytest.mark.parametrize("pulse", but_long(PERIODS, "sine", "cosine"))
def test_no_threshold_of_one_body_is_lower_and_each_is_confirmed_from_both_sides(pulse: str) -> None:
    bodies, period = random_bodies(7, 6), PERIODS[pulse]
    highest = 12.0 * np.asarray(bodies.uplift_acceleration)
    found = lowest_thresholds(Problem(bodies, as_pulse(pulse), np.ones(()), np.array(period), None), highest)
    sizes = zip(*(bodies.parameters[name] for name in ("left", "right", "height")), strict=True)
    single = np.array([rocking.RigidBody(*size).thresholds(pulse, period=period).lowest for size in sizes])
    single = np.where(single <= highest, single, np.nan)
    np.testing.assert_allclose(found, single, rtol=1e-3)  # several changes can lie between two nodes, 0.05 % apart
    assert not (found > single * (1.0 + 1e-10)).any()
    known = np.isfinite(found)
    assert known.sum() >= 3
    for factor, overturns in ((1.0 + 1e-9, True), (1.0 - 1e-9, False)):
        acceleration = np.where(known, factor * found, 0.5 * highest)
        outcome = bodies.response(pulse, peak_acceleration=acceleration, period=period)
        assert (outcome.overturned[known] == overturns).all()


def test_nothing_is_found_above_the_highest_acceleration_or_below_uplift() -> None:
    bodies = random_bodies(3, 6)
    problem = Problem(bodies, as_pulse("sine"), np.ones(()), np.array(0.8), None)
    found = lowest_thresholds(problem, 20.0 * np.asarray(bodies.uplift_acceleration))
    known = np.isfinite(found)
    assert known.sum() >= 3
    assert np.isnan(lowest_thresholds(problem, np.where(known, 0.999 * found, 1e-3))[known]).all()
    np.testing.assert_array_equal(lowest_thresholds(problem, np.where(known, 1.001 * found, 1e-3))[known], found[known])
    assert np.isnan(lowest_thresholds(problem, 0.5 * np.asarray(bodies.uplift_acceleration))).all()
