"""Arguments of the closed forms: ranges, and checks that they broadcast."""

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rocking._base.errors import broadcast, float_array
from rocking._base.parameter import Parameter
from rocking._model.checks import check
from rocking._model.parameters import FREQUENCY_RATIO, RESTITUTION, SLENDERNESS

Array = NDArray[np.float64]

AMPLITUDE = Parameter(
    "amplitude", "a", "-", 1.0, 1.0 / SLENDERNESS.lower, "both", "amplitude of the pulse over g tan(alpha)"
)
"""Below 1 the block does not uplift."""

UPLIFTING_AMPLITUDE = replace(AMPLITUDE, closed="right")

ANY_FREQUENCY_RATIO = replace(FREQUENCY_RATIO, lower=1e-12, upper=1e12)
"""The formulas hold beyond the range of the solver."""

POSITIVE_RESTITUTION = replace(RESTITUTION, closed="right")

TIME = Parameter("time", "tau", "-", 0.0, np.inf, "left", "time p t since uplift")

_RANGES = {parameter.name: parameter for parameter in (AMPLITUDE, ANY_FREQUENCY_RATIO, RESTITUTION)}


def checked(**given: ArrayLike) -> list[Array]:
    """The arguments as float64 arrays of their broadcast shape.

    `amplitude`, `frequency_ratio` and `restitution` are checked against their ranges; others, such as times and
    velocities, may have any value, nan included. Labelled arguments (xarray, pandas) have to agree in dimensions and
    indexes.
    """
    arrays = [
        check(_RANGES[name], value) if name in _RANGES else float_array(name, value) for name, value in given.items()
    ]
    return broadcast(given, arrays)
