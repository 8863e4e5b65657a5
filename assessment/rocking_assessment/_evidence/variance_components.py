"""Intervals of unknowns of a linear model with independent errors and random changes of unknown sizes.

    y = J b + C_1 w_1 + C_2 w_2 + ... + e,

b unknown, the elements of w_g normal with the standard deviation s_g, e with sigma. The likelihood of the sizes s_g,
with b integrated out, is that of restricted maximum likelihood (Patterson & Thompson 1971). It is evaluated on a grid
of sizes at equal ratios, that is with the prior 1/s_g: the intervals are those of the mixture over the grid, which for
a single size and a mean are those of Student. Few changes tell their size badly; the mixture counts this.

References
----------
Patterson H. D., Thompson R. (1971), Recovery of inter-block information when block sizes are unequal, Biometrika 58(3),
545-554.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy.linalg import cho_factor, cho_solve
from scipy.special import stdtr

from rocking.extension import Array

SIZES = np.geomspace(1e-3, 0.5, 10)
"""Sizes of the grid [-]: shares of alpha and eta. Those of no real body are more constant than the first."""

LEAST_VARIANCE = 1e-12  # of the errors, over that of samples by changes of 1 [-]: below it rounding counts
BISECTIONS = 60  # of the half width, which is between 0 and a bound that holds


class Mixture(NamedTuple):
    """The unknowns over the grid.

    Attributes
    ----------
    weight : float array (grid,)
        Probabilities of the points of the grid; their sum is 1.
    sizes : float array (grid, groups)
        Sizes of the changes.
    mean, deviation : float array (grid, unknowns)
        Estimate of the unknowns and its standard deviation.
    freedom : float
        Degrees of freedom of the variance of the errors.
    """

    weight: Array
    sizes: Array
    mean: Array
    deviation: Array
    freedom: float

    def typical_sizes(self) -> Array:
        """Geometric mean of the size of each group (groups,)."""
        return np.asarray(np.exp(self.weight @ np.log(self.sizes)))

    def half_widths(self, level: float) -> Array:
        """Distance from 0 within which each unknown is with a probability (unknowns,)."""
        low = np.zeros(self.mean.shape[1])
        high = np.full_like(low, np.inf)
        width = self.deviation.max(axis=0) + np.abs(self.mean).max(axis=0)
        while not np.all(np.isfinite(high)):
            high = np.where(np.isinf(high) & (self._within(width) >= level), width, high)
            width = np.where(np.isinf(high), 2.0 * width, width)
        for _ in range(BISECTIONS):
            middle = 0.5 * (low + high)
            enough = self._within(middle) >= level
            low, high = np.where(enough, low, middle), np.where(enough, middle, high)
        return high

    def _within(self, width: Array) -> Array:
        scale = np.maximum(self.deviation, 1e-300)
        above = stdtr(self.freedom, (width - self.mean) / scale)
        below = stdtr(self.freedom, (-width - self.mean) / scale)
        return np.asarray(self.weight @ (above - below))


def mixture(y: Array, jacobian: Array, groups: Sequence[Array], variance: float, freedom: float) -> Mixture:
    """Estimate the unknowns for each point of the grid of sizes.

    Parameters
    ----------
    y : float array (samples,)
        What the model explains.
    jacobian : float array (samples, unknowns)
        J.
    groups : sequence of float arrays (samples, changes)
        C_1, C_2, ...
    variance : float
        sigma^2, > 0.
    freedom : float
        Degrees of freedom of `variance`.
    """
    basis, triangle = np.linalg.qr(np.hstack([jacobian, *groups]))
    seen = basis.T @ y
    unknowns = jacobian.shape[1]
    ends = np.cumsum([unknowns, *(group.shape[1] for group in groups)])
    fixed = triangle[:, :unknowns]
    covariances = [triangle[:, low:high] @ triangle[:, low:high].T for low, high in itertools.pairwise(ends)]
    floor = LEAST_VARIANCE * max(float(np.trace(covariance)) for covariance in covariances)
    variance = max(variance, floor)
    sizes = np.array(list(itertools.product(SIZES, repeat=len(groups))))
    logarithm, means, deviations = [], [], []
    for point in sizes:
        total = variance * np.eye(seen.size)
        for size, covariance in zip(point, covariances, strict=True):
            total += size**2 * covariance
        factor = cho_factor(total, lower=True)
        weighted = cho_solve(factor, fixed)
        information = fixed.T @ weighted
        scale = 1.0 / np.sqrt(np.diag(information))  # unknowns have units
        inverse = np.linalg.pinv(information * np.outer(scale, scale), hermitian=True)
        inverse *= np.outer(scale, scale)
        mean = inverse @ (weighted.T @ seen)
        left = seen - fixed @ mean
        determinant = (
            2.0 * np.log(np.diag(factor[0])).sum() + np.linalg.slogdet(information * np.outer(scale, scale))[1]
        )
        determinant -= 2.0 * np.log(scale).sum()
        logarithm.append(-0.5 * (determinant + float(left @ cho_solve(factor, left))))
        means.append(mean)
        deviations.append(np.sqrt(np.diag(inverse)))
    weight = np.exp(np.array(logarithm) - max(logarithm))
    return Mixture(weight / weight.sum(), sizes, np.array(means), np.array(deviations), freedom)
