"""Slices of restitution or slenderness angle: from which of them a value, or the interval above one, is interpolated.

Nothing is compiled here: the workflow plans its jobs with it.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

STENCIL_SIZE = 4  # nodes of a stencil in one direction, and slices of a window: the interpolant is exact for cubics


def slice_index(slices: Array, value: ArrayLike) -> tuple[NDArray[np.intp], NDArray[np.bool_]]:
    """Index of the slice at or below each value, -1 outside of the slices; and whether the value is on that slice."""
    value = np.asarray(value, dtype=np.float64)
    below = np.searchsorted(slices, value, side="right") - 1
    if not slices.size:
        return below, below >= 0
    on_slice = slices[below] == value  # -1 selects the last slice, which is above such a value
    return np.where((below < slices.size - 1) | on_slice, below, -1), on_slice


def slice_window(count: int, lower: int) -> tuple[int, int]:
    """First and number of the slices from which the interval above slice `lower`, 0 to `count` - 2, is interpolated.

    The two slices below and the two above the interval; at the ends the four outermost; all if there are fewer.
    """
    size = min(count, STENCIL_SIZE)
    return min(max(lower - 1, 0), count - size), size


def windows_of(count: int, first: int, last: int) -> tuple[int, int]:
    """First slice, and the one after the last, from which the intervals above slices `first` to `last` - 1 are made.

    The last slice of all has no interval above it.
    """
    windows = [slice_window(count, k) for k in range(first, min(last, count - 1))]
    return min([first, *(start for start, _ in windows)]), max([last, *(start + size for start, size in windows)])
