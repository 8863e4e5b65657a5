"""Fragility curves: the probability that a limit state is reached at an intensity x.

- lognormal: P = Phi(ln(x/median)/beta), Phi the normal distribution (Baker 2015, eq. 1);
- logistic: P = 1/(1 + exp(-ln(x/median)/s)).

References
----------
Baker J. W. (2015), Efficient analytical fragility function fitting using dynamic structural analysis, Earthquake
Spectra 31(1), 579-599.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import expit, log_expit, log_ndtr, ndtr

from rocking._base.arrays import Array


@dataclass(frozen=True)
class Link:
    """A distribution, symmetric about 0, whose logarithm is concave."""

    # cdf, log_cdf: F(z) and ln F(z)
    cdf: Callable[[Array], Array]
    log_cdf: Callable[[Array], Array]
    slope: Callable[[Array], Array]  # d ln F/dz
    curvature: Callable[[Array, Array], Array]  # -d2 ln F/dz2, >= 0, from z and the slope at z
    deviation: float  # its standard deviation [-]


def _normal_slope(z: Array) -> Array:
    return np.asarray(np.exp(-0.5 * z * z - 0.5 * math.log(2.0 * math.pi) - log_ndtr(z)))


LINKS = {
    "lognormal": Link(ndtr, log_ndtr, _normal_slope, lambda z, slope: slope * (z + slope), 1.0),
    "logistic": Link(
        expit,
        log_expit,
        lambda z: np.asarray(expit(-z)),
        lambda _, slope: slope * (1.0 - slope),
        math.pi / math.sqrt(3.0),
    ),
}


def curve_probability(model: str, intensity: ArrayLike, median: ArrayLike, dispersion: ArrayLike) -> Array:
    """Evaluate the probability of a curve [-], nan without one; median and dispersion as in `CurveFit`, all broadcast.

    A dispersion of 0 is a step, 1/2 at the median; a negative one a curve that falls.
    """
    link = LINKS[model]
    distance = np.log(np.asarray(intensity, dtype=np.float64)) - np.log(np.asarray(median, dtype=np.float64))
    width = np.asarray(dispersion, dtype=np.float64) / link.deviation
    with np.errstate(divide="ignore", invalid="ignore"):
        z = np.where((width == 0.0) & (distance == 0.0), 0.0, distance / width)
    return np.asarray(link.cdf(z))
