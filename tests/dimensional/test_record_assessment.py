"""The assessment of a block under a record: made when it is asked for, and cancelled by its flag."""

import threading
import time

import numpy as np
import pytest

import rocking
from rocking._base.errors import StoppedError
from rocking._dimensional import response
from rocking._dimensional.problem import Problem
from rocking._numba.cancellation import StopFlag
from tests.suites.motions import noise

BLOCK = rocking.Block(0.5, 2.0)


def test_nothing_is_searched_before_it_is_asked_for(monkeypatch):
    monkeypatch.setattr(response, "block_thresholds", None)  # a search fails
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
