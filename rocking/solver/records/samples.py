"""The samples of a recorded motion as the kernels read them, and searches in them."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from rocking._numba.compilation import FloatArray, kernel
from rocking.excitation.records.record import Record

SHAPE, LATER, BLOCKS = 0, 1, 2
"""Rows of the array of a motion, see `motion_samples`."""

BLOCK = 32
"""Sample intervals of which the row `BLOCKS` holds one maximum."""


@lru_cache(maxsize=16)
def motion_samples(motion: Record) -> NDArray[np.float64]:
    """Array (3, samples) of a motion, shared by all callers: not to be changed (kernels take writable arrays only).

    Row `SHAPE`: f = a/max|a| at the samples [-]. Row `LATER`: the largest |f| from each sample on. Row `BLOCKS`: entry
    b is the largest |f| on the sample intervals from 32 b to 32 b + 31; entries beyond the last block are 0.
    """
    f = motion.acceleration / motion.peak_acceleration
    rows = np.zeros((3, f.size))
    rows[SHAPE] = f
    rows[LATER] = np.maximum.accumulate(np.abs(f[::-1]))[::-1]
    blocks = np.maximum.reduceat(np.abs(f), np.arange(0, f.size, BLOCK))
    ends = np.abs(f[BLOCK::BLOCK])  # the right end of a block is the first sample of the next one
    blocks[: ends.size] = np.maximum(blocks[: ends.size], ends)
    rows[BLOCKS, : blocks.size] = blocks
    return rows


@kernel
def next_exceedance(samples: FloatArray, first: int, a: float) -> int:
    """The first interval from `first` on at whose right end |u| > 1, with u = a f; the number of intervals if none.

    At rest the block uplifts in this interval, where |u| crosses 1, or at its left end.
    """
    f, blocks = samples[SHAPE], samples[BLOCKS]
    count = len(f) - 1
    k = first
    while k < count:
        if k % BLOCK == 0 and a * blocks[k // BLOCK] <= 1.0:
            k += BLOCK
            continue
        if a * abs(f[k + 1]) > 1.0:
            return k
        k += 1
    return count


@kernel
def extremes_in_window(
    samples: FloatArray, a: float, k: int, s: float, h: float, window: float, spread: float
) -> tuple[float, float]:
    """Smallest and largest u from time `s` [tau] in the interval `k` of length `h` on, over a time `window` [tau].

    After the last sample u is 0. The search ends early, with the extremes so far, once |u| >= 1, or 1 + u or 1 - u
    varies by more than the factor `spread`.
    """
    f = samples[SHAPE]
    count = len(f) - 1
    u = a * (f[k] + (f[k + 1] - f[k]) * (s / h))
    least, most = u, u
    end = s + window  # from the left end of interval k
    while k < count:
        if end < h:
            u = a * (f[k] + (f[k + 1] - f[k]) * (end / h))
            return min(least, u), max(most, u)
        u = a * f[k + 1]
        least, most = min(least, u), max(most, u)
        if max(-least, most) >= 1.0 or 1.0 + most >= spread * (1.0 + least) or 1.0 - least >= spread * (1.0 - most):
            return least, most
        end -= h
        k += 1
    return min(least, 0.0), max(most, 0.0)
