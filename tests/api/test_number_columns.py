"""Columns of numbers of large bodies: the same numbers as parsed at once, and chunks between which work can end."""

import json
import time

import numpy as np
import pytest
from rocking_api.http.batch import read_batch
from rocking_api.http.errors import TooLargeError
from rocking_api.http.number_columns import CHUNK_BYTES, cut_arrays, parse_array

from rocking._base.errors import InvalidArgumentError, StoppedError
from rocking._numba.cancellation import StopFlag

LIMIT = 1_000_000
OPTIONS = {"pulse": "sine", "restitution": "0.85"}


def columns(points):
    random = np.random.default_rng(points)
    return {"slenderness": random.uniform(0.05, 0.95, points), "frequency_ratio": random.uniform(0.5, 12.0, points)}


def as_json(arrays, **options):
    return json.dumps({"pulse": "sine", "restitution": 0.85, **options} | {k: v.tolist() for k, v in arrays.items()})


def as_csv(arrays):
    rows = zip(*(values.tolist() for values in arrays.values()), strict=True)
    return ",".join(arrays) + "\n" + "".join(",".join(map(repr, row)) + "\n" for row in rows)


def read(form, body, stop=None):
    return read_batch(body.encode(), form, {} if form == "json" else OPTIONS, LIMIT, stop or StopFlag())


def body_of(form, points):
    return as_json(columns(points)) if form == "json" else as_csv(columns(points))


@pytest.mark.parametrize("form", ["json", "csv"])
@pytest.mark.parametrize("points", [0, 1, 2, 60_000])
def test_numbers_are_those_of_the_body(form, points):
    found = read(form, body_of(form, points))
    for name, values in columns(points).items():
        np.testing.assert_array_equal(found.groups[name], values)


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


@pytest.mark.parametrize("form", ["json", "csv"])
def test_parsing_of_a_million_points_can_be_stopped(form):
    body = body_of(form, LIMIT)
    clock = Clock()
    read(form, body, clock)
    clock.times.append(time.thread_time())
    assert len(clock.times) > 50
    assert max(np.diff(clock.times)) < 0.1
    stopped = Clock(last=5)
    with pytest.raises(StoppedError):
        read(form, body, stopped)
    assert len(stopped.times) == 5


@pytest.mark.parametrize("form", ["json", "csv"])
def test_too_many_points_are_refused_while_they_are_parsed(form):
    with pytest.raises(TooLargeError):
        read_batch(body_of(form, 1001).encode(), form, {} if form == "json" else OPTIONS, 1000, StopFlag())


@pytest.mark.parametrize(
    "entries", ["1,", ",1", "1,,2", "1,null", '1,"2]"', "1 2", "1,true,[", "1,}", "nope", "1," * CHUNK_BYTES]
)
def test_entries_that_are_no_numbers_are_refused(entries):
    body = f'{{"pulse": "sine", "slenderness": [{entries}], "frequency_ratio": 1, "restitution": 1}}'
    with pytest.raises(ValueError):  # noqa: PT011  (of pydantic, or InvalidArgumentError)
        read("json", body)


def test_the_last_of_two_equal_keys_counts_as_in_any_json():
    body = '{"pulse": "sine", "slenderness": [0.1, 0.2], "slenderness": %s, "frequency_ratio": 1, "restitution": 1}'
    assert read("json", body % "[0.3]").groups["slenderness"].tolist() == [0.3]
    assert read("json", body % "0.4").groups["slenderness"].tolist() == [0.4]


def test_other_parts_of_a_body_are_limited():
    for more in ('"pulse": [' + "1," * 100_000 + "1]", '"slenderness": [[' + "1," * 100_000 + "1]]", " " * 200_000):
        with pytest.raises(InvalidArgumentError, match="beside slenderness"):
            cut_arrays(('{"restitution": 1, ' + more + "}").encode())


def test_long_lines_of_csv_are_refused():
    for body in ("slenderness," * 200, "slenderness\n" + "1" * 2000 + "\n"):
        with pytest.raises(InvalidArgumentError, match="lines of at most"):
            read("csv", body)


def test_line_of_an_error_is_named():
    with pytest.raises(InvalidArgumentError, match=r"from line 10002: .*'x'"):
        read("csv", "slenderness\n" + "0.5\n" * 10_000 + "x\n")


def test_array_in_several_chunks():
    text = b"0.25, " * CHUNK_BYTES + b"0.5"
    numbers = parse_array("slenderness", b"[" + text + b"]", (1, 1 + len(text)), LIMIT, StopFlag())
    assert (numbers.size, numbers[0], numbers[-1]) == (CHUNK_BYTES + 1, 0.25, 0.5)
