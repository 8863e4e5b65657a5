"""Tables of many blocks: the numbers of the body, limits, and chunks between which parsing can end."""

import time

import numpy as np
import pytest
from rocking_api.models.batch import batch_of, parse_csv
from rocking_api.models.params import LookupOptions

from rocking._base.errors import InvalidArgumentError, StoppedError
from rocking._numba.cancellation import StopFlag
from tests.api.conftest import assert_problem
from tests.sampling import number

LIMIT = number(600_000, 1_000_000)
OPTIONS = LookupOptions(pulse="sine")


def columns(points):
    random = np.random.default_rng(points)
    return {"slenderness": random.uniform(0.05, 0.95, points), "frequency_ratio": random.uniform(0.5, 12.0, points)}


def as_csv(arrays):
    rows = zip(*(values.tolist() for values in arrays.values()), strict=True)
    return (",".join(arrays) + "\n" + "".join(",".join(map(repr, row)) + "\n" for row in rows)).encode()


def read(body, stop=None, limit=LIMIT):
    return batch_of(OPTIONS, parse_csv(body, limit, stop or StopFlag()), {"restitution": 0.85}, limit)


@pytest.mark.parametrize("points", [0, 1, 2, 60_000])
def test_numbers_are_those_of_the_body(points):
    found = read(as_csv(columns(points)))
    for name, values in columns(points).items():
        np.testing.assert_array_equal(found.groups[name], values)
    lists = {name: values.tolist() for name, values in columns(points).items()}
    again = batch_of(OPTIONS, {}, lists | {"restitution": [0.85]}, LIMIT)
    for name, values in found.groups.items():
        np.testing.assert_array_equal(again.groups[name], values)


class Clock(StopFlag):
    """Notes the processor time of the thread at each look at the flag, and sets it at one of them."""

    def __init__(self, last=None):
        super().__init__()
        self.times = [time.thread_time()]
        self.last = last

    def check(self):
        self.times.append(time.thread_time())
        if len(self.times) == self.last:
            self.set()
        super().check()


def test_parsing_of_a_million_points_can_be_stopped():
    body = as_csv(columns(LIMIT))
    clock = Clock()
    read(body, clock)
    clock.times.append(time.thread_time())
    assert len(clock.times) > 50
    assert max(np.diff(clock.times)) < 0.1
    stopped = Clock(last=5)
    with pytest.raises(StoppedError):
        read(body, stopped)
    assert len(stopped.times) == 5


def post(client, body):
    return client.post("/v1/response", content=body, headers={"content-type": "application/json"})


def test_a_key_given_twice_is_refused(client):
    body = '{"pulse": "sine", "slenderness": [0.1, 0.2], "slenderness": %s, "frequency_ratio": 1, "restitution": 1}'
    for last in ("[0.3]", "0.4"):
        problem = assert_problem(post(client, body % last), 422, "slenderness")
        assert (problem["value"], problem["allowed"]) == ("two values, the second in line 1", "one value")


def test_long_lines_of_csv_are_refused():
    for body in (b"slenderness," * 200, b"slenderness\n" + b"1" * 2000 + b"\n"):
        with pytest.raises(InvalidArgumentError, match="lines of at most"):
            read(body)


def test_line_of_an_error_is_named():
    with pytest.raises(InvalidArgumentError, match=r"from line 10002: .*'x'"):
        read(b"slenderness\n" + b"0.5\n" * 10_000 + b"x\n")
