"""Functions of vectors of several cells."""

import numpy as np
import scipy.special

from rocking._numba.compilation import kernel
from rocking._numba.simd import (
    LANES,
    load,
    store,
)
from rocking._numba.simd_functions import arccosine, cosh_minus_one_and_sinh, exponential, scaled_erfc, sine_and_cosine


@kernel
def evaluate(x, results):
    cosh1, sinh = cosh_minus_one_and_sinh(load(x, 0))
    sine, cosine = sine_and_cosine(load(x, 1))
    store(results, 0, cosh1)
    store(results, 1, sinh)
    store(results, 2, sine)
    store(results, 3, cosine)
    store(results, 4, arccosine(load(x, 2)))
    store(results, 5, exponential(load(x, 3)))
    store(results, 6, scaled_erfc(load(x, 4)))


def test_functions_are_accurate_to_rounding():
    rng = np.random.default_rng(3)
    for _ in range(300):
        x = np.zeros((5, LANES))
        x[0], x[1] = np.exp(rng.uniform(-20, 5.8, LANES)), rng.uniform(-1000, 1000, LANES)
        x[2] = 1.0 - np.exp(rng.uniform(-35, 0, LANES))
        x[3], x[4] = rng.uniform(-699, 300, LANES), np.exp(rng.uniform(-8, 12, LANES))
        results, exact = np.zeros((7, LANES)), x.astype(np.longdouble)
        evaluate(x, results)
        expected = 2 * np.sinh(exact[0] / 2) ** 2, np.sinh(exact[0]), np.sin(exact[1]), np.cos(exact[1])
        for k, value in enumerate((*expected, np.arccos(exact[2]), np.exp(exact[3]))):
            scale = 1.0 if k in (2, 3) else np.abs(value)
            assert np.max(np.abs(results[k] - value) / scale) < 6e-16
        assert np.max(np.abs(results[6] / scipy.special.erfcx(x[4]) - 1.0)) < 1.5e-15  # scipy's share: 7e-16
