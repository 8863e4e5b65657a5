"""Thresholds: lowest of records and of arrays of bodies, in words, made when asked for and cancelled by their flag."""

import math
import threading
import time

import numpy as np
import pytest

import rocking
from rocking._base.errors import StoppedError
from rocking._dimensional import response
from rocking._dimensional.lowest_thresholds import lowest_thresholds
from rocking._dimensional.problem import Problem
from rocking._dimensional.thresholds import (
    BodyThresholds,
    Threshold,
    overturning_scale,
    threshold_text,
    warnings_of_changes,
)
from rocking._excitation.pulses import as_pulse
from rocking._numba.cancellation import StopFlag
from tests.sampling import but_long
from tests.suites.motions import noise

BLOCKS = [rocking.Block(0.2, 1.0), rocking.Block(0.5, 2.0), rocking.Block(2.0, 10.0)]


@pytest.mark.parametrize("seed", but_long(range(4), 0))
def test_the_lowest_of_all_changes_is_the_lowest_overturning_scale(seed):
    record = noise(seed)
    for block in BLOCKS:
        every = block.thresholds(record).value
        lowest = overturning_scale(record, block)
        if not every.size:
            assert math.isnan(lowest)
            continue
        assert lowest == every[0]
        assert block.thresholds(record, highest=1.5 * lowest).value[0] == lowest
        assert math.isnan(overturning_scale(record, block, highest=lowest * (1.0 - 1e-5)))


def test_text_of_a_threshold_is_on_the_safe_side():
    rng = np.random.default_rng(1)
    for value in np.exp(rng.uniform(-20.0, 20.0, 500)).tolist():
        for digits in (1, 2, 4, 9):
            down, up = (float(Threshold(value, above).text(digits)) for above in (True, False))
            assert down < value < up
            assert up - down <= value * (2.0 * 10.0 ** (1 - digits) + 3e-6)
    assert str(Threshold(4.700067, True)) == "overturns above 4.70006"
    assert str(Threshold(13.1270943, False)) == "survives above 13.1272"
    assert threshold_text(1.1338454, 4) == "1.133"
    assert threshold_text(5e-7, 2) == "4.9e-07"  # within the error of the search


def test_many_changes_nearby_are_counted():
    changes = [Threshold(0.96 + 0.01 * k, k % 2 == 0) for k in range(6)]
    about = "the outcome changes within 5 % of this scale: "
    assert warnings_of_changes(1.0, changes, "scale") == [about + "6 times, from 0.959999 to 1.01001"]
    assert warnings_of_changes(1.0, changes[1::-1], "scale") == [about + "at 0.959999, 0.970001"]  # in order
    assert warnings_of_changes(2.0, changes, "scale") == []


ONE_CHANGE = "it overturns from 1.13388 times the record"


@pytest.mark.parametrize(
    ("count", "said"),
    [
        (0, "no factor of the record up to 4.99999 was found to overturn it"),
        (1, ONE_CHANGE),
        (3, f"{ONE_CHANGE}; above that the outcome changes 2 more times up to 4.99999 times"),
    ],
)
def test_changes_in_words(count, said):
    values, above = np.array([1.13389, 1.2, 1.3]), np.array([True, False, True])
    found = BodyThresholds(values[:count], above[:count], np.array([0.5, 5.0]), "scale")
    assert found.sentence == said
    assert [one.overturns_above for one in found.changes] == above[:count].tolist()


BLOCK = rocking.Block(0.5, 2.0)


def test_nothing_is_searched_before_it_is_asked_for(monkeypatch):
    monkeypatch.setattr(response, "thresholds_of", None)  # a search fails
    found = BLOCK.response(noise(0))
    assert found.to_dict()["outcome"] == found.outcome.name
    assert BLOCK.response(noise(0), thresholds=False).margin is None
    with pytest.raises(TypeError):
        repr(found)


def test_a_set_flag_ends_the_assessment():
    flag = StopFlag()
    found = BLOCK.response(noise(0), stop=flag)
    flag.set()
    with pytest.raises(StoppedError):
        _ = found.warnings


def test_a_flag_that_is_set_meanwhile_ends_the_search():
    long = rocking.Record(np.tile(noise(0).acceleration, 40), 0.01, unit="m/s2")
    large, flag = rocking.Block(4.0, 16.0), StopFlag()
    found = response.respond(Problem.of(large, long), stop=flag, seconds=600.0)
    timer = threading.Timer(0.2, flag.set)
    timer.start()
    began = time.process_time()
    with pytest.raises(StoppedError):
        _ = found.margin
    assert time.process_time() - began < 10.0


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
    np.testing.assert_allclose(found, single, rtol=1e-3)  # several changes can lie between two strengths tried
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
