"""Checks of limit states, without the imports of the statistics: for configurations.

The limit states of a block whose probability is asked for: overturning, rotations of alpha, or a threshold.
"""

from collections.abc import Iterable

import numpy as np

from rocking._base.errors import InvalidArgumentError, number

MAX_THRESHOLD = 1e3
"""Largest threshold of max |theta|/alpha [-]; at 90 degrees a block of alpha = 0.1 degrees is at 900."""


def label(limit: str | float) -> str:
    """Return the name of a limit state in results: overturning, alpha, or such as `0.5 alpha`."""
    return limit if isinstance(limit, str) else f"{limit:g} alpha"


def check_demands(demand: str | float | Iterable[str | float]) -> list[str | float]:
    """Return the limit states as a list, thresholds as floats; raise if two of them are equal."""
    if isinstance(demand, str) or np.ndim(demand) == 0:  # type: ignore[arg-type]
        limits: list[str | float] = [demand]  # type: ignore[list-item]
    else:
        limits = [*demand]  # type: ignore[misc]
    for k, limit in enumerate(limits):
        if not isinstance(limit, str):
            limits[k] = number("demand", limit, 0.0, MAX_THRESHOLD, closed="right")
        elif limit not in ("overturning", "alpha"):
            raise InvalidArgumentError("demand", limit, "overturning, alpha, or a threshold of max |theta|/alpha")
    if not limits or len({label(limit) for limit in limits}) != len(limits):
        raise InvalidArgumentError("demand", demand, "one or more different limit states")
    return limits
