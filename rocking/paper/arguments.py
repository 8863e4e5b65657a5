"""Arguments of the closed forms: ranges, and checks that they broadcast."""

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rocking._base.errors import broadcast, float_array
from rocking._base.quantities import FREQUENCY_RATIO, RESTITUTION, SLENDERNESS
from rocking._base.quantity import Quantity

Array = NDArray[np.float64]

AMPLITUDE = Quantity(
    "amplitude",
    "-",
    "amplitude of the pulse over g tan(alpha)",
    symbol="a",
    lower=1.0,
    upper=1.0 / SLENDERNESS.lower,
    closed="both",
)
"""Below 1 the block does not uplift."""

UPLIFTING_AMPLITUDE = replace(AMPLITUDE, closed="right")

ANY_FREQUENCY_RATIO = replace(FREQUENCY_RATIO, lower=1e-12, upper=1e12)
"""The formulas hold beyond the range of the solver."""

POSITIVE_RESTITUTION = replace(RESTITUTION, closed="right")

TIME = Quantity("time", "-", "time p t since uplift", symbol="tau", lower=0.0, closed="left")

_RANGES = {parameter.name: parameter for parameter in (AMPLITUDE, ANY_FREQUENCY_RATIO, RESTITUTION)}


def checked(**given: ArrayLike) -> list[Array]:
    """The arguments as float64 arrays of their broadcast shape.

    `amplitude`, `frequency_ratio` and `restitution` are checked against their ranges; others, such as times and
    velocities, may have any value, nan included. Labelled arguments (xarray, pandas) have to agree in dimensions and
    indexes.
    """
    arrays = [
        _RANGES[name].convert(value) if name in _RANGES else float_array(name, value) for name, value in given.items()
    ]
    return broadcast(given, arrays)
