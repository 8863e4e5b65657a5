"""The samples of a ground motion as the kernels read them, and searches in them.

The motion is linear between its samples and zero after the last. Samples of a record are equidistant; samples of a
sampled pulse need not be.
"""

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from rocking._base.constants import STANDARD_GRAVITY
from rocking._base.errors import InvalidArgumentError
from rocking._excitation.records.record import Record as RecordedMotion
from rocking._excitation.shapes import AbstractPulse
from rocking._numba.compilation import FloatArray, Record, kernel

SHAPE, LATER, BLOCKS, TIME, VERTICAL, LATER_LOW, BLOCKS_LOW = range(7)
"""Rows of the array of a motion, see `sample_rows`."""

BLOCK = 32  # sample intervals for each extreme in the rows `BLOCKS` and `BLOCKS_LOW`


def sample_rows(
    shape: NDArray[np.float64], time: NDArray[np.float64] | None = None, vertical: NDArray[np.float64] | None = None
) -> NDArray[np.float64]:
    """The array (7, samples) of a motion.

    `shape` (samples,): f, the horizontal acceleration over its largest absolute value [-]. `time` (samples,): times of
    the samples in any unit, ascending from 0; 0, 1, 2, ... without it. `vertical` (samples,): vertical acceleration
    over g, upwards [-]; 0 without it. Returns float array (7, samples): rows `SHAPE`, `TIME` and `VERTICAL` as above.
    Row `LATER`: the largest |f| from each sample on. Row `BLOCKS`: entry b is the largest |f| on the sample intervals
    from 32 b to 32 b + 31; entries beyond the last block are 0. Rows `LATER_LOW` and `BLOCKS_LOW`: the same with the
    smallest vertical acceleration. Not to be changed (kernels take writable arrays only).
    """
    rows = np.zeros((7, shape.size))
    rows[SHAPE] = shape
    rows[TIME] = np.arange(shape.size) if time is None else time
    rows[VERTICAL] = 0.0 if vertical is None else vertical
    for later, blocks, values in ((LATER, BLOCKS, np.abs(shape)), (LATER_LOW, BLOCKS_LOW, -rows[VERTICAL])):
        rows[later] = np.maximum.accumulate(values[::-1])[::-1]
        highest = np.maximum.reduceat(values, np.arange(0, shape.size, BLOCK))
        ends = values[BLOCK::BLOCK]  # the right end of a block is the first sample of the next one
        highest[: ends.size] = np.maximum(highest[: ends.size], ends)
        rows[blocks, : highest.size] = highest
    rows[[LATER_LOW, BLOCKS_LOW]] *= -1.0
    return rows


@lru_cache(maxsize=16)
def motion_samples(motion: RecordedMotion) -> NDArray[np.float64]:
    """`sample_rows` of a record, whose unit of time is its time step; shared by all callers."""
    vertical = None if motion.vertical is None else motion.vertical / STANDARD_GRAVITY
    return sample_rows(motion.acceleration / motion.peak_acceleration, None, vertical)


@lru_cache(maxsize=16)
def pulse_samples(pulse: AbstractPulse, parts: int = 1) -> NDArray[np.float64]:
    """`sample_rows` of a sampled pulse, in time units of the phase [rad]; each interval is divided into `parts`."""
    if pulse.samples is None:
        raise InvalidArgumentError("pulse", pulse.name, "a pulse given by samples")
    phases, values = pulse.samples
    if parts > 1:
        share = np.arange(parts) / parts
        phases = np.append(phases[:-1, None] + np.diff(phases)[:, None] * share, phases[-1])
        values = pulse.shape(phases)
    return sample_rows(values, phases)


@kernel
def interval_length(block: Record, samples: FloatArray, k: int) -> float:
    """Length of the sample interval `k` [tau]."""
    return float(block.h if block.equidistant == 1 else block.h * (samples[TIME, k + 1] - samples[TIME, k]))


@kernel
def lifting_sign(block: Record, f: float, vertical: float) -> float:
    """Sgn(theta) of the rotation that the ground acceleration starts, 0 where it holds the body down.

    Positive acceleration lifts the right edge: the body rotates about the left one, theta < 0.
    """
    if block.a[1] * f >= vertical:
        return -1.0
    return 1.0 if -block.a[0] * f >= vertical else 0.0


@kernel
def vertical_at(block: Record, samples: FloatArray, k: int) -> float:
    """V = 1 + (vertical acceleration)/g at the sample `k`."""
    return float(1.0 if block.vertical == 0.0 else 1.0 + block.vertical * samples[VERTICAL, k])


@kernel
def ground_at(block: Record, samples: FloatArray, k: int, s: float) -> tuple[float, float]:
    """f and V at time `s` in the interval `k`."""
    f, share = samples[SHAPE], s / interval_length(block, samples, k)
    v0 = vertical_at(block, samples, k)
    return f[k] + (f[k + 1] - f[k]) * share, v0 + (vertical_at(block, samples, k + 1) - v0) * share


@kernel
def next_exceedance(block: Record, samples: FloatArray, first: int) -> int:
    """The first interval from `first` on at whose right end q < 0 on an edge; the number of intervals if none.

    At rest the body uplifts in this interval, where q crosses 0, or at its left end. None is missed: a block of
    intervals is passed only if its largest |f| and its smallest V hold both edges down.
    """
    f, blocks, lows = samples[SHAPE], samples[BLOCKS], samples[BLOCKS_LOW]
    right, left = block.a[0], block.a[1]
    strongest, count = max(right, left), len(f) - 1
    has_vertical, vertical = block.vertical != 0.0, 1.0
    k = first
    while k < count:
        if k % BLOCK == 0:
            b = k // BLOCK
            if strongest * blocks[b] <= (1.0 + block.vertical * lows[b] if has_vertical else 1.0):
                k += BLOCK
                continue
        if has_vertical:
            vertical = vertical_at(block, samples, k + 1)
        if max(left * f[k + 1], -right * f[k + 1]) > vertical:
            return k
        k += 1
    return count


@kernel
def extremes_in_window(
    block: Record, samples: FloatArray, window: float, spread: float
) -> tuple[float, float, float, float, float]:
    """Bounds of q from the position of the body on, over a time `window` [tau].

    Returns a lower and an upper bound of q on the right edge, the same on the left edge, and the largest V, from the
    extremes of both components: without vertical motion the bounds are the extremes of q. The search ends early, with
    the extremes so far, once q <= 0 on an edge, or q varies by more than the factor `spread`: the answer is no then.
    """
    right, left = block.a[0], block.a[1]
    count, k = samples.shape[1] - 1, block.interval
    has_vertical = block.vertical != 0.0
    f, vertical = ground_at(block, samples, k, block.s)
    low, high, lightest, heaviest = f, f, vertical, vertical
    end = block.s + window  # from the left end of interval k
    while k < count:
        h = interval_length(block, samples, k)
        inside = end < h  # the window ends in this interval: its end counts, and no further sample
        if inside:
            f, vertical = ground_at(block, samples, k, end)
        else:
            f = samples[SHAPE, k + 1]
            if has_vertical:
                vertical = vertical_at(block, samples, k + 1)
        low, high = min(low, f), max(high, f)
        if has_vertical:
            lightest, heaviest = min(lightest, vertical), max(heaviest, vertical)
        least_right, least_left = lightest + right * low, lightest - left * high
        if (
            inside
            or min(least_right, least_left) <= 0.0
            or heaviest + right * high >= spread * least_right
            or heaviest - left * low >= spread * least_left
        ):
            return least_right, heaviest + right * high, least_left, heaviest - left * low, heaviest
        end -= h
        k += 1
    # the window goes on beyond the last sample, where q = V = 1
    least_right, least_left = lightest + right * low, lightest - left * high
    most_right, most_left = heaviest + right * high, heaviest - left * low
    return min(least_right, 1.0), max(most_right, 1.0), min(least_left, 1.0), max(most_left, 1.0), max(heaviest, 1.0)
