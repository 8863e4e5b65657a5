"""Fields of records are copied by name, whatever the layout; lanes become records of any size."""

import numpy as np

from rocking._numba.compilation import kernel
from rocking._numba.records import constant_fields, copy_fields, copy_lane
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
def copy_from(source, lane, target):
    copy_lane(source, lane, target)


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


def test_a_lane_becomes_a_record():
    rng = np.random.default_rng(1)
    layout = np.dtype([("number", "f8"), ("first", "i4"), ("second", "i4"), ("code", "i1"), ("flag", "?")], align=True)
    draws = {"first": (0, 2**31), "second": (-(2**31), 2**31), "code": (-128, 128), "flag": (0, 2)}
    source = np.zeros(1, [(name, np.float64, LANES) for name in reversed(layout.names)])[0]
    for name in layout.names:
        source[name] = rng.integers(*draws[name], LANES) if name in draws else rng.random(LANES)
    records = np.zeros(LANES, layout)
    for lane in range(LANES):
        copy_from(source, lane, records[lane])
    for name in layout.names:
        np.testing.assert_array_equal(records[name], source[name].astype(layout[name]))
