"""Work ends soon after its flag is set, and no incomplete result is returned."""

import threading
import time
from functools import partial

import numpy as np
import pytest
import rocking_assessment
from rocking_assessment._objects.tables import objects_of_csv

import rocking
from rocking._base.errors import StoppedError
from rocking._boundary.frequency import critical_frequency_ratio
from rocking._history.motion import build_motion
from rocking._numba.cancellation import StopFlag, run_with_timeout
from rocking._spectra.cubes import spectra
from tests.suites.motions import noise

MANY = np.linspace(1 - 1e-6, 1 - 1e-7, 999)
"""Slendernesses just below uplift: an elastic block then has 200,000 impacts."""

ELASTIC = {"frequency_ratio": 0.05, "restitution": 1.0}

SOON = 0.1
"""Processor time within which the work ends [s]; it is a few milliseconds on an idle machine."""

AXES = {"slenderness": MANY[:40], "frequency_ratio": np.linspace(0.04, 0.05, 40)}


def peak(stop, **groups):
    return rocking.peak_response("c2", **{"slenderness": MANY} | ELASTIC | groups, stop=stop)


def under_record(alpha, stop):
    many = {"slenderness": np.linspace(0.3, 0.9, 300_000), "frequency_parameter": 2.3, "restitution": 0.87}
    return rocking.peak_response(noise(1, 200, 0.02), **many, alpha=alpha, threads=1, stop=stop)


def contact(stop):
    return rocking.time_history("c2", slenderness=MANY[-1], **ELASTIC, alpha=0.2, contact=True, stop=stop)


def frequency(stop):
    groups = {"slenderness": MANY[-1], "restitution": 1.0, "alpha": 0.2}
    return critical_frequency_ratio("c2", **groups, window=(0.01, 0.1), stop=stop)


WORK = {
    "arcs": peak,
    "steps": lambda stop: peak(stop, alpha=0.2),
    **{f"record, {alpha}": partial(under_record, alpha) for alpha in (None, 0.25)},
    "threads": lambda stop: peak(stop, alpha=0.2, slenderness=np.repeat(MANY, 9), threads=2),
    "etas": lambda stop: peak(stop, slenderness=MANY[-1], restitution=np.linspace(0.99999, 1.0, 999)),
    "amplitude": lambda stop: rocking.thresholds("c2", **ELASTIC, alpha=0.2, stop=stop),
    "frequency": frequency,
    "boundary": lambda stop: rocking.overturning_boundary("c2", restitution=1.0, nodes=201, alpha=0.2, stop=stop),
    "cube": lambda stop: list(spectra("c2", restitution=[1.0], **AXES, alpha=[0.2], stop=stop)),
    "contact": contact,
}


@pytest.fixture(scope="module", autouse=True)
def _loaded():
    for alpha in (None, 0.2):
        rocking.time_history("c2", slenderness=0.5, frequency_ratio=1, restitution=0.9, alpha=alpha)
        rocking.peak_response("c2", slenderness=0.5, frequency_ratio=1, restitution=0.9, alpha=alpha)
        rocking.peak_response(noise(1), slenderness=0.5, frequency_parameter=2.0, restitution=0.9, alpha=alpha)
    rocking.peak_response("cosine", slenderness=0.999, frequency_ratio=0.05, restitution=1.0)  # has many impacts


def time_to_stop(name):
    """Processor time of all threads from the flag to the end of the work [s]."""
    stop, ended = StopFlag(), []

    def work():
        try:
            WORK[name](stop)
        except StoppedError:
            ended.append(time.process_time())

    thread = threading.Thread(target=work)
    thread.start()
    thread.join(0.3)
    assert thread.is_alive()
    start = time.process_time()
    stop.set()
    thread.join(30)
    assert ended, "it went on to its end"
    return ended[0] - start


@pytest.mark.parametrize("name", WORK)
def test_work_ends_soon_after_cancellation(name):
    # the clock counts the other threads of the process, too: the least of three attempts is that of the work
    assert any(time_to_stop(name) < SOON for _ in range(3))


MOTION, BLOCK, LEVELS = noise(1), rocking.Block(0.4, 1.6), {"intensity": [3.0, 6.0]}
OF_RECORD = {"slenderness": 0.5, "restitution": 0.9, "frequency_parameter": 2.0}
OF_PULSE = {"slenderness": 0.5, "restitution": 0.9, "frequency_ratio": 3.0}
AT_ONCE = {
    "response": lambda stop: rocking.peak_response("sine", **OF_PULSE, stop=stop),
    "history": lambda stop: build_motion("sine", **OF_PULSE, stop=stop).events(),
    "history of a record": lambda stop: rocking.time_history(MOTION, **OF_RECORD, stop=stop),
    "fragility": lambda stop: rocking.fragility(MOTION, BLOCK, **LEVELS, stop=stop),
    "sensitivity": lambda stop: rocking.suites.suite_sensitivity(MOTION, BLOCK, **LEVELS, stop=stop),
    "table": lambda stop: objects_of_csv("width [m],height [m]\n0.3,1.2\n" + "\n" * 9, stop=stop),
    "floor": lambda stop: rocking.floor_motion(MOTION, periods=0.5, stop=stop),
    "site": lambda stop: rocking_assessment.Site(pga=3.0, pgv=0.3, floor_periods=0.5).find_motions(stop),
}


@pytest.mark.parametrize("name", AT_ONCE)
def test_a_flag_set_in_advance_ends_the_work_at_once(name):
    stop = StopFlag()
    stop.set()
    with pytest.raises(StoppedError):
        AT_ONCE[name](stop)


def test_a_flag_that_is_not_set_changes_no_result():
    groups = {"slenderness": np.linspace(0.1, 0.9, 99), "frequency_ratio": 3.0, "restitution": 0.9}
    free, watched = (rocking.peak_response("sine", **groups, stop=stop) for stop in (None, StopFlag()))
    np.testing.assert_array_equal(free.peak_rotation, watched.peak_rotation)


def test_cancelling_the_whole_cancels_its_children_only():
    parent = StopFlag()
    with parent.child() as part:
        part.set()
        assert not parent.is_set()
    with parent.child() as part:
        parent.set()
        assert part.is_set()
    with parent.child() as part:
        assert part.is_set()


def test_work_that_exceeds_its_time_limit_is_cancelled():
    stop = StopFlag()
    began = time.process_time()
    assert run_with_timeout(WORK["amplitude"], 0.1, stop) is None
    assert time.process_time() - began < 0.1 + SOON
    assert not stop.is_set()
    assert run_with_timeout(lambda part: part.is_set(), 10.0, stop) is False
