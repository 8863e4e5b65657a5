"""Run time of a method at a given error, interpolated between the settings at which it was measured."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

MIN_ERROR = 1e-17
"""Smaller errors are replaced by this one: doubles do not resolve them."""


def time_for(error: float, times: Sequence[float], errors: Sequence[float]) -> float:
    """Return the least time in which a method reaches an error; nan if none of its settings does.

    Between two settings log(time) is linear in log(error). A setting counts only if none with a smaller error is
    faster. The result does not increase with the error, and it is constant above the largest measured error.
    """
    if not len(errors):
        return math.nan
    order = np.argsort(errors)
    reached = np.maximum(np.asarray(errors, dtype=np.float64)[order], MIN_ERROR)
    if not error >= reached[0]:
        return math.nan
    least = np.minimum.accumulate(np.asarray(times, dtype=np.float64)[order])
    return float(np.exp(np.interp(math.log(error), np.log(reached), np.log(least))))
