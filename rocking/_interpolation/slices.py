"""Choice of the slices of restitution or slenderness angle from which a value or an interval is interpolated.

Nothing is compiled here: the workflow plans its jobs with it.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

STENCIL_SIZE = 4  # nodes of a stencil in one direction, and slices of a window: the interpolant is exact for cubics


def slice_index(slices: Array, value: ArrayLike) -> tuple[NDArray[np.intp], NDArray[np.bool_]]:
    """Return the index of the slice at or below each value, -1 outside, and whether the value is on that slice."""
    value = np.asarray(value, dtype=np.float64)
    below = np.searchsorted(slices, value, side="right") - 1
    if not slices.size:
        return below, below >= 0
    on_slice = slices[below] == value  # -1 selects the last slice, which is above such a value
    return np.where((below < slices.size - 1) | on_slice, below, -1), on_slice


def slice_window(count: int, lower: int) -> tuple[int, int]:
    """Return the first and number of the slices from which the interval above a slice is interpolated.

    `count`: number of all slices; `lower`: the slice below the interval, 0 to `count` - 2.
    The two slices below and the two above the interval; at the ends the four outermost; all if there are fewer.
    """
    size = min(count, STENCIL_SIZE)
    return min(max(lower - 1, 0), count - size), size


def windows_of(count: int, first: int, last: int) -> tuple[int, int]:
    """Return the first and the end of the slices from which the intervals above `first` to `last` - 1 are made.

    The last slice of all has no interval above it.
    """
    start, end = first, last
    for k in range(first, min(last, count - 1)):
        window_start, size = slice_window(count, k)
        start, end = min(start, window_start), max(end, window_start + size)
    return start, end
