"""Frequencies at which the fate of a block changes while the amplitude of its pulse stays: other periods, other sizes.

At one slenderness the frequency ratio omega_g/p is all that a longer pulse or a larger block of the same shape changes,
and both change it in the same way: omega falls as 1/T_p and grows as the square root of R (2.2). So one line through
the control space tells the critical periods of a block and the critical sizes of a shape.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rocking._numba.cancellation import StopFlag
from rocking.boundary.search import Floats, classifier, fates_along
from rocking.errors import InvalidArgumentError, in_range
from rocking.excitation.pulses import AbstractPulse, as_pulse
from rocking.solver.peak_response import FREQUENCY_RATIO_RANGE

NODES_PER_DECADE = 1000
"""Nodes on which fates are looked for, before their changes are refined [-]."""

Flags = NDArray[np.bool_]


@dataclass(frozen=True)
class FrequencyThresholds:
    """Frequency ratios at which the fate of a block changes, ascending; arrays (thresholds,).

    Attributes
    ----------
    frequency_ratio : float array [-]
        omega = omega_g/p; the block overturns at it, and stands within a relative `RESOLUTION` of it.
    overturns_above : bool array
        True where the block overturns just above the threshold and stands just below it.
    overturns_at_ends : (bool, bool)
        Whether it overturns at the lower and at the upper end of the window.
    """

    frequency_ratio: Floats
    overturns_above: Flags
    overturns_at_ends: tuple[bool, bool]


def critical_frequency_ratio(
    pulse: str | AbstractPulse,
    *,
    slenderness: float,
    restitution: float,
    window: tuple[float, float],
    alpha: float | None = None,
    stop: StopFlag | None = None,
) -> FrequencyThresholds:
    """Every frequency ratio of a window at which the fate changes, the amplitude being fixed.

    Parameters
    ----------
    pulse, slenderness, restitution, alpha
        As for `peak_response`; scalars.
    window : (float, float)
        Smallest and largest omega = omega_g/p looked at [-], 1e-9 <= low < high <= 1e9, at most four decades apart.
    stop : StopFlag, optional
        Once another thread sets it, this ends soon with `StoppedError`.

    Returns
    -------
    FrequencyThresholds
        Each good to a relative `RESOLUTION`. A region narrower than 1/1000 of a decade that lies between equal fates
        can be missed; a safe band between two ways of overturning is not, unless it is narrower than `RESOLUTION`.

    Raises
    ------
    InvalidArgumentError
        For an argument out of range.
    StoppedError
        If `stop` was set.
    """
    made = as_pulse(pulse)
    low, high = (float(in_range("window", end, *FREQUENCY_RATIO_RANGE)) for end in window)
    if not low < high <= 1e4 * low:
        raise InvalidArgumentError("window", (low, high), "two ascending frequency ratios, at most four decades apart")

    nodes = np.linspace(np.log(low), np.log(high), 2 + int(NODES_PER_DECADE * np.log10(high / low)))
    point = float(slenderness), float(nodes[0]), float(in_range("restitution", restitution, 0.0, 1.0))
    grid, codes = fates_along(1, point, nodes, classifier(made, alpha, stop))
    falls = codes > 0
    edge = np.flatnonzero(falls[1:] != falls[:-1])
    above = falls[edge + 1]
    return FrequencyThresholds(np.exp(grid[np.where(above, edge + 1, edge)]), above, (bool(falls[0]), bool(falls[-1])))
