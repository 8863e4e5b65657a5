"""Fields of records are copied by name, whatever the layout; lanes become records of any size."""

import numpy as np
import pytest

from rocking._numba.compilation import kernel
from rocking._numba.records import constant_fields, copy_fields, scatter_records
from rocking._numba.simd import LANES

STATE = np.dtype([("other", "f8"), ("flag", "i8"), ("count", "i8"), ("ratio", "f8")])
SHORT = np.dtype([("ratio", "f8"), ("count", "i4"), ("flag", "?"), ("own", "i1")], align=True)
set_values = constant_fields({"ratio": np.nan, "count": -1, "flag": 1, "unknown": 3})


@kernel
def copy(source, target):
    copy_fields(source, target)


@kernel
def set_all(target):
    set_values(target)


@kernel
def scatter(source, places, target):
    scatter_records(source, places, target)


def test_shared_fields_are_copied_and_others_kept():
    state = np.array([(1.0, 1, -7, 2.5)], STATE)[0]
    short = np.array([(0.0, 3, False, 5)], SHORT)[0]
    copy(state, short)
    assert short.item() == (2.5, -7, True, 5)
    copy(short, state)
    assert state.item() == (1.0, 1, -7, 2.5)


def test_constants_are_set_by_name():
    short = np.array([(0.0, 3, False, 5)], SHORT)[0]
    set_all(short)
    assert np.isnan(short["ratio"])
    assert short.item()[1:] == (-1, True, 5)


@pytest.mark.parametrize("doubles", [1, 6, 7, 8, 15, 16, 17])
def test_lanes_become_records_where_a_place_is_given(doubles):
    """Of 16 to 144 bytes."""
    rng = np.random.default_rng(doubles)
    numbers = [(f"number_{k}", np.float64) for k in range(doubles)]
    layout = np.dtype([*numbers, ("first", "i4"), ("second", "i4"), ("code", "i1"), ("flag", "?")], align=True)
    draws = {"first": (0, 2**31), "second": (-(2**31), 2**31), "code": (-128, 128), "flag": (0, 2)}
    source = np.zeros(1, [(name, np.float64, LANES) for name in reversed(layout.names)])[0]
    for name in layout.names:
        source[name] = rng.integers(*draws[name], LANES) if name in draws else rng.random(LANES)
    records, places = np.zeros(30, layout), rng.permutation(30)[:LANES].astype(np.int64)
    places[[0, 5, 11]] = -1
    scatter(source, places, records)
    written = places >= 0
    for name in layout.names:
        np.testing.assert_array_equal(records[name][places[written]], source[name][written].astype(layout[name]))
        assert not np.delete(records[name], places[written]).any()
