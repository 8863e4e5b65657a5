"""Bracketed roots and maxima of many scalar functions at once; nan where there is none."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.optimize import elementwise

from rocking.closed_form.arguments import Array

Function = Callable[..., Array]


def find_root(function: Function, low: Array, high: Array, *args: Array) -> Array:
    """Root of `function(x, *args)` in [low, high] to rounding error (Chandrupatla), element by element.

    Parameters
    ----------
    function : callable
        Vectorised.
    low, high : ndarray
        Brackets; all arrays broadcast. An infinite or nan limit is treated as no bracket.

    Returns
    -------
    ndarray
        nan where the function has the same sign at both ends.
    """
    low, high, *args_ = np.broadcast_arrays(low, high, *args)
    if low.size == 0:
        return np.full(low.shape, np.nan)
    with np.errstate(all="ignore"):
        found = elementwise.find_root(function, (low, high), args=tuple(args_))
        return np.asarray(np.where(found.success, found.x, np.nan), dtype=np.float64)


def find_maximum(function: Function, low: Array, high: Array, *args: Array, points: int = 129) -> Array:
    """Argument of the largest value of `function(x, *args)` on [low, high], element by element.

    A grid of `points` brackets the maximum and Chandrupatla's minimiser refines it. A maximum at an end of the interval
    is returned as that end.
    """
    low, high, *args_ = np.broadcast_arrays(low, high, *args)
    if low.size == 0:
        return np.full(low.shape, np.nan)
    with np.errstate(all="ignore"):
        grid = low + (high - low) * np.linspace(0.0, 1.0, points).reshape(-1, *(1,) * low.ndim)
        values = np.where(np.isfinite(value := function(grid, *args_)), value, -np.inf)
        best = np.argmax(values, axis=0)[np.newaxis]
        left, middle, right = (
            np.take_along_axis(grid, np.clip(best + step, 0, points - 1), axis=0)[0] for step in (-1, 0, 1)
        )
        refined = elementwise.find_minimum(lambda x, *a: -function(x, *a), (left, middle, right), args=tuple(args_))
        return np.asarray(np.where(refined.success, refined.x, middle), dtype=np.float64)
