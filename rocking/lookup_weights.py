"""Weights of levels for many values, found once where all values are one, as in most questions to a data set."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from rocking.interpolation import level_weights

Array = NDArray[np.float64]
Index = NDArray[np.intp]


def weights_on(levels: Array, values: Array) -> tuple[Index, Index, Array]:
    """As `level_weights`, for values (points,)."""
    size = values.size
    if size == 0 or not (values == values[0]).all():
        return level_weights(levels, values)
    gap, first, weights = _weights_of_one(levels.tobytes(), float(values[0]))
    return np.full(size, gap), np.full(size, first), weights.repeat(size, axis=0)


@lru_cache(maxsize=1024)
def _weights_of_one(levels: bytes, value: float) -> tuple[np.intp, np.intp, Array]:
    gap, first, weights = level_weights(np.frombuffer(levels), np.array([value]))
    return gap[0], first[0], weights
