"""Vectors of several cells: functions, masks, and rows of cells."""

import numpy as np
import pytest
import scipy.special

from rocking._numba.compilation import kernel
from rocking._numba.simd import (
    LANES,
    any_lane,
    gather,
    gather_rows,
    lane_bits,
    load,
    maximum,
    minimum,
    scatter_rows,
    select,
    splat,
    square_root,
    store,
    store_where,
)
from rocking._numba.simd_error_function import scaled_erfc
from rocking._numba.simd_exponentials import arccosine, cosh_minus_one_and_sinh, exponential
from rocking._numba.simd_sines import sine_and_cosine


@kernel
def evaluate(x, found):
    cosh1, sinh = cosh_minus_one_and_sinh(load(x, 0))
    sine, cosine = sine_and_cosine(load(x, 1))
    store(found, 0, cosh1)
    store(found, 1, sinh)
    store(found, 2, sine)
    store(found, 3, cosine)
    store(found, 4, arccosine(load(x, 2)))
    store(found, 5, exponential(load(x, 3)))
    store(found, 6, scaled_erfc(load(x, 4)))


def test_functions_are_accurate_to_rounding():
    rng = np.random.default_rng(3)
    for _ in range(300):
        x = np.zeros((5, LANES))
        x[0], x[1] = np.exp(rng.uniform(-20, 5.8, LANES)), rng.uniform(-1000, 1000, LANES)
        x[2] = 1.0 - np.exp(rng.uniform(-35, 0, LANES))
        x[3], x[4] = rng.uniform(-699, 300, LANES), np.exp(rng.uniform(-8, 12, LANES))
        found, exact = np.zeros((7, LANES)), x.astype(np.longdouble)
        evaluate(x, found)
        expected = 2 * np.sinh(exact[0] / 2) ** 2, np.sinh(exact[0]), np.sin(exact[1]), np.cos(exact[1])
        for k, value in enumerate((*expected, np.arccos(exact[2]), np.exp(exact[3]))):
            scale = 1.0 if k in (2, 3) else np.abs(value)
            assert np.max(np.abs(found[k] - value) / scale) < 6e-16
        assert np.max(np.abs(found[6] / scipy.special.erfcx(x[4]) - 1.0)) < 1.5e-15  # scipy's share: 7e-16


@kernel
def combine(x, found):
    small, large = load(x, 0) < 3.0, load(x, 0) >= 10.0
    middle = ~(small | large)
    store(found, 0, select(middle, load(x, 0), splat(-1.0)))
    store_where(found, 1, middle, load(x, 0))
    store_where(found, 1, large, -1.0)
    return lane_bits(small), any_lane(large & small)


def test_masks_combine_lane_by_lane():
    x, found = np.arange(float(LANES))[None], np.full((2, LANES), 7.0)
    assert combine(x, found) == (0b111, False)
    np.testing.assert_array_equal(found[0], np.where((x[0] >= 3.0) & (x[0] < 10.0), x[0], -1.0))
    np.testing.assert_array_equal(found[1], np.where(x[0] < 3.0, 7.0, found[0]))


@kernel
def exchange(source, places, columns, target):
    gather_rows(source, places, columns)
    scatter_rows(columns, places, target)


@kernel
def take(source, places, found):
    store(found, 0, gather(source, places))


def test_elements_are_taken_from_places():
    source, places = np.random.default_rng(3).random(60), np.random.default_rng(4).permutation(40)[:LANES]
    found = np.zeros((1, LANES))
    take(source, places, found)
    np.testing.assert_array_equal(found[0], source[places])


@kernel
def of_numbers(x, y):
    return select(x < y, maximum(x, y), minimum(x, y)), square_root(x)


def test_rules_of_vectors_hold_for_numbers():
    assert of_numbers(2.0, 3.0) == (3.0, np.sqrt(2.0))
    assert of_numbers(3.0, 2.0) == (2.0, np.sqrt(3.0))


@pytest.mark.parametrize("seed", range(3))
def test_rows_become_columns_and_return(seed):
    rng = np.random.default_rng(seed)
    source, places = rng.random((40, LANES)), rng.permutation(40)[:LANES].astype(np.int64)
    columns, target = np.zeros((LANES, LANES)), np.zeros((40, LANES))
    exchange(source, places, columns, target)
    np.testing.assert_array_equal(columns.T, source[places])
    np.testing.assert_array_equal(target[places], source[places])
