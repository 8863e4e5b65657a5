"""Axes of the data sets from their configuration."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray


def stepped(breaks: Sequence[float], steps: Sequence[float]) -> NDArray[np.float64]:
    """Values from the first break to the last one, with a step of its own from each break to the next.

    Raises
    ------
    ValueError
        If there is not one step to each stretch, or a stretch is no multiple of its step.
    """
    if len(steps) != len(breaks) - 1:
        raise ValueError(f"{len(steps)} steps for {len(breaks) - 1} stretches between breaks {list(breaks)}")
    axis = [np.array(breaks[:1], dtype=np.float64)]
    for low, high, step in zip(breaks[:-1], breaks[1:], steps, strict=True):
        count = round((high - low) / step)
        if count < 1 or abs(count * step - (high - low)) > 1e-9:
            raise ValueError(f"from {low} to {high} is no multiple of the step {step}")
        axis.append(np.linspace(low, high, count + 1)[1:])
    # rounded so that a step of 0.0025 gives 0.9 and not 0.9000000000000001
    return np.round(np.concatenate(axis), 12)
