"""Checks of limit states and hazard curves, without the imports of the statistics: for configurations and sites.

The limit states of a block whose probability is asked for: overturning, rotations of alpha, or a threshold.
"""

from collections.abc import Iterable

import numpy as np
from numpy.typing import ArrayLike

from rocking._base.arrays import Array
from rocking._base.errors import InvalidArgumentError, in_range, number

MAX_THRESHOLD = 1e3
"""Largest threshold of max |theta|/alpha [-]; at 90 degrees a block of alpha = 0.1 degrees is at 900."""


RANGE = 1e-30, 1e30
"""Smallest and largest intensity and rate: the number of nodes between two points grows with their ratio."""


def label(limit: str | float) -> str:
    """The name of a limit state in results: overturning, alpha, or such as `0.5 alpha`."""
    return limit if isinstance(limit, str) else f"{limit:g} alpha"


def check_demands(demand: str | float | Iterable[str | float]) -> list[str | float]:
    """The limit states, all different, thresholds as floats."""
    given = [demand] if isinstance(demand, str) or np.ndim(demand) == 0 else list(demand)  # type: ignore[arg-type]
    found: list[str | float] = []
    for limit in given:
        if isinstance(limit, str):
            if limit not in ("overturning", "alpha"):
                raise InvalidArgumentError("demand", limit, "overturning, alpha, or a threshold of max |theta|/alpha")
            found.append(limit)
        else:
            found.append(number("demand", limit, 0.0, MAX_THRESHOLD, closed="right"))  # type: ignore[arg-type]
    if not found or len({label(limit) for limit in found}) != len(found):
        raise InvalidArgumentError("demand", demand, "one or more different limit states")
    return found


def check_hazard_curve(hazard: tuple[ArrayLike, ArrayLike]) -> tuple[Array, Array]:
    """Intensities and annual rates of a hazard curve, as `annual_rate` describes them."""
    if len(hazard) != 2:
        raise InvalidArgumentError("hazard", f"{len(hazard)} arrays", "intensities and annual rates")
    x = in_range("hazard intensity", hazard[0], *RANGE)
    rates = in_range("hazard rate", hazard[1], *RANGE, unit="1/year")
    if x.ndim != 1 or x.size < 2 or x.shape != rates.shape or not np.all(np.diff(x) > 0.0):
        raise InvalidArgumentError("hazard", (x.shape, rates.shape), "ascending intensities, two at least, and rates")
    if np.any(np.diff(rates) > 0.0):
        raise InvalidArgumentError("hazard", rates.tolist(), "annual rates of exceedance that do not increase")
    return x, rates
