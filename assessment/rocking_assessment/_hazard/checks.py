"""Checks of hazard curves, without the imports of the statistics: for sites."""

import numpy as np
from numpy.typing import ArrayLike

from rocking.extension import Array, InvalidArgumentError, in_range

RANGE = 1e-30, 1e30
"""Smallest and largest intensity and rate: the number of nodes between two points grows with their ratio."""


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
