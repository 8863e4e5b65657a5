"""Axes of the data sets from their configuration."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray


def steps_between(breaks: Sequence[float], steps: Sequence[float]) -> list[int]:
    """Number of steps from each break to the next one; each interval is a multiple of its own step."""
    if len(steps) != len(breaks) - 1:
        raise ValueError(f"{len(steps)} steps for {len(breaks) - 1} stretches between breaks {list(breaks)}")
    counts = []
    for (low, high), step in zip(pairwise(breaks), steps, strict=True):
        counts.append(round((high - low) / step))
        if counts[-1] < 1 or abs(counts[-1] * step - (high - low)) > 1e-9:
            raise ValueError(f"from {low} to {high} is no multiple of the step {step}")
    return counts


def stepped(breaks: Sequence[float], steps: Sequence[float]) -> NDArray[np.float64]:
    """Values from the first break to the last one, evenly spaced in each interval; errors as `steps_between`."""
    axis = [np.array(breaks[:1], dtype=np.float64)]
    for (low, high), count in zip(pairwise(breaks), steps_between(breaks, steps), strict=True):
        axis.append(np.linspace(low, high, count + 1)[1:])
    # rounded so that a step of 0.0025 gives 0.9 and not 0.9000000000000001
    return np.round(np.concatenate(axis), 12)
