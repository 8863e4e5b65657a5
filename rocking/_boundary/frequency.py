"""Frequencies at which the outcome changes while the amplitude of the pulse stays: other periods, other sizes.

At one slenderness a longer pulse or a larger block of the same shape changes the frequency ratio omega_g/p only: omega
is inversely proportional to T_p and proportional to the square root of R (2.2). So one line through the control space
gives the critical periods of a block and the critical sizes of a shape.
"""

from dataclasses import dataclass

import numpy as np

from rocking._base.arrays import Flags
from rocking._base.equality import EqualByValue
from rocking._base.errors import InvalidArgumentError
from rocking._base.quantities import FREQUENCY_RATIO, RESTITUTION, SLENDERNESS
from rocking._base.units import Scalar
from rocking._boundary.search import Floats, block_solver, classifier, counted_code, outcomes_along
from rocking._excitation.pulses import AbstractPulse, as_pulse
from rocking._model.checks import check_ends, check_one_alpha
from rocking._model.outcome import SURVIVES
from rocking._numba.cancellation import StopFlag

NODES_PER_DECADE = 1000  # nodes on which outcomes are first computed, before their changes are refined [-]


@dataclass(frozen=True, eq=False)
class FrequencyThresholds(EqualByValue):
    """Frequency ratios at which the outcome for a block changes, ascending; arrays (thresholds,)."""

    # omega = omega_g/p; the block overturns at it, and survives within a relative `RESOLUTION` of it [-]
    frequency_ratio: Floats
    overturns_above: Flags  # True where the block overturns just above the threshold and survives just below it
    overturns_at_ends: tuple[bool, bool]  # whether it overturns at the lower and at the upper end of the window


def critical_frequency_ratio(
    pulse: str | AbstractPulse,
    *,
    slenderness: Scalar,
    restitution: Scalar,
    window: tuple[float, float],
    alpha: Scalar | None = None,
    stop: StopFlag | None = None,
) -> FrequencyThresholds:
    """Search every frequency ratio at which the outcome changes, the amplitude being fixed.

    Arguments and errors are those of `peak_response`. `window`: smallest and largest omega considered [-],
    1e-9 <= low < high <= 1e9, at most four decades apart.

    Each threshold is good to a relative `RESOLUTION`, or to `ELASTIC_RESOLUTION` where an elastic block overturns after
    more than `MOST_COUNTED` impacts. A region narrower than 1/1000 of a decade that lies between equal outcomes can be
    missed; a surviving band between two ways of overturning, of which all with more than `MOST_COUNTED` impacts are
    one, is not, unless it is narrower than `RESOLUTION`.
    """
    shape = as_pulse(pulse)
    low, high = check_ends(FREQUENCY_RATIO, window, "window")
    if not high <= 1e4 * low:
        raise InvalidArgumentError("window", (low, high), "two ascending frequency ratios, at most four decades apart")

    nodes = np.linspace(np.log(low), np.log(high), 2 + int(NODES_PER_DECADE * np.log10(high / low)))
    point = SLENDERNESS.number(slenderness), float(nodes[0]), RESTITUTION.number(restitution), check_one_alpha(alpha)
    grid, codes = outcomes_along(1, point, nodes, classifier(block_solver(shape, stop=stop), counted_code))
    overturns = codes != SURVIVES
    edge = np.flatnonzero(overturns[1:] != overturns[:-1])
    above = overturns[edge + 1]
    return FrequencyThresholds(
        np.exp(grid[np.where(above, edge + 1, edge)]), above, (bool(overturns[0]), bool(overturns[-1]))
    )
