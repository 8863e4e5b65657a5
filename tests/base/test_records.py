"""Fields of records are copied by name, whatever the layout."""

import numpy as np

from rocking._numba.compilation import kernel
from rocking._numba.records import constant_fields, copy_fields

STATE = np.dtype([("other", "f8"), ("flag", "i8"), ("count", "i8"), ("ratio", "f8")])
SHORT = np.dtype([("ratio", "f8"), ("count", "i4"), ("flag", "?"), ("own", "i1")], align=True)
set_values = constant_fields({"ratio": np.nan, "count": -1, "flag": 1, "unknown": 3})


@kernel
def copy(source, target):
    copy_fields(source, target)


@kernel
def set_all(target):
    set_values(target)


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
