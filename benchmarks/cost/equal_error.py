"""How long a method takes for a given error, between the settings at which it was measured."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

SMALLEST = 1e-17
"""Errors below count as this one: doubles do not tell them apart."""


def time_for(error: float, times: Sequence[float], errors: Sequence[float]) -> float:
    """Least time in which a method reaches an error; nan if none of its settings does.

    Between two settings log(time) is linear in log(error). A setting counts only if none with a smaller error is
    faster, so the time does not rise where more error is allowed, nor fall beyond the coarsest setting.
    """
    if not len(errors):
        return math.nan
    order = np.argsort(errors)
    reached = np.maximum(np.asarray(errors, dtype=np.float64)[order], SMALLEST)
    if not error >= reached[0]:
        return math.nan
    least = np.minimum.accumulate(np.asarray(times, dtype=np.float64)[order])
    return float(np.exp(np.interp(math.log(error), np.log(reached), np.log(least))))
