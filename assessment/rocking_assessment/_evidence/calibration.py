"""Parameters of a planar block from outcomes of tests on a shaking table."""

from collections.abc import Sequence

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from rocking.extension import (
    STANDARD_GRAVITY,
    Array,
    Flags,
    InvalidArgumentError,
    Record,
    Scalar,
    in_range,
    integer,
    number,
    record_response,
)

SEED = 0  # of the order in which tests are divided into folds, and of the resamples
RESAMPLES = 400  # resamples of the tests for the intervals [-]


def calibrate(
    motions: Sequence[Record],
    outcomes: ArrayLike,
    *,
    alpha: tuple[float, float],
    half_diagonal: tuple[float, float],
    restitution: tuple[float, float],
    points: int = 12,
    folds: int = 5,
    confidence: Scalar = 0.95,
) -> xr.Dataset:
    """The block that agrees best with the outcomes of tests, and the share of other tests that it predicts.

    A test counts as a Bernoulli trial: the model is right with the probability 1 - e, the same for all tests, so that
    the likelihood (1 - e)^k e^(n - k) of k right ones among n, with its e = 1 - k/n, is largest for the block with most
    right ones. Blocks are tried on a grid, and on a second one between the neighbours of the best point. Intervals are
    those of the bootstrap (Efron 1979): tests are drawn again with replacement, and the lower end is the quantile of
    the least value of the blocks that are best then, the upper end that of the largest.

    Parameters
    ----------
    motions : sequence of Record
        Measured motions of the table, one for each test.
    outcomes : array_like of bool (tests,)
        True where the body overturned.
    alpha, half_diagonal, restitution : (float, float)
        Ends of the grid: slenderness angle [rad], (0, 1.5]; R [m], > 0; eta [-], [0, 1]. p^2 = 3 g/(4 R).
    points : int
        Points along each parameter [-], 2 to 50.
    folds : int
        Parts of the cross validation [-], 2 to the number of tests.
    confidence : float
        Of the intervals [-], (0, 1).

    Returns
    -------
    xarray.Dataset
        `alpha` [rad], `half_diagonal` [m], `restitution` [-] of the best block, the middle one of several that are as
        good, with `_lower` and `_upper`; `right`, its share of right outcomes. `validated`, `validated_pga` and
        `validated_pgv`: shares of right predictions of tests that were left out of the fit (on the first grid), of the
        model and of the best threshold of PGA and PGV.

    Raises
    ------
    InvalidArgumentError
        If an argument is not as described, or all tests have the same outcome.

    References
    ----------
    Efron B. (1979), Bootstrap methods: another look at the jackknife, Annals of Statistics 7(1), 1-26.
    """
    overturned = np.asarray(outcomes)
    if overturned.dtype != np.bool_ or overturned.shape != (len(motions),) or len(set(overturned.tolist())) < 2:
        allowed = f"{len(motions)} truth values, one for each motion, not all equal"
        raise InvalidArgumentError("outcomes", outcomes, allowed)
    count = integer("points", points, 2, 50)
    parts = integer("folds", folds, 2, len(motions))
    level = number("confidence", confidence, 0.0, 1.0, closed="neither")
    ranges = {
        "alpha": _ends("alpha", alpha, 1e-3, 1.5),
        "half_diagonal": _ends("half_diagonal", half_diagonal, 1e-3, 1e4),
        "restitution": _ends("restitution", restitution, 0.0, 1.0),
    }
    first = _grid([np.linspace(ends[0], ends[1], count) for ends in ranges.values()])
    overturns = _predicted(motions, first)
    best = _middle(first, (overturns == overturned).mean(axis=1))
    finer = []
    for value, (low, high) in zip(best, ranges.values(), strict=True):
        step = (high - low) / (count - 1)
        finer.append(np.linspace(max(low, value - step), min(high, value + step), count))
    second = _grid(finer)
    blocks = np.concatenate([first, second])
    right = np.concatenate([overturns == overturned, _predicted(motions, second) == overturned])
    share = right.mean(axis=1)
    best = _middle(blocks, share)
    lower, upper = _ends_of_best(blocks, right, level)
    results = {"right": share.max()}
    for k, name in enumerate(ranges):
        results[name] = best[k]
        results[f"{name}_lower"] = min(lower[k], best[k])
        results[f"{name}_upper"] = max(upper[k], best[k])
    pga = np.array([motion.peak_acceleration for motion in motions])
    pgv = np.array([motion.peak_velocity for motion in motions])
    results["validated"] = _validated(overturns, overturned, parts)
    results["validated_pga"] = _validated(_above(pga), overturned, parts)
    results["validated_pgv"] = _validated(_above(pgv), overturned, parts)
    return xr.Dataset({name: float(value) for name, value in results.items()}, attrs={"confidence": level})


def _ends(name: str, value: tuple[float, float], low: float, high: float) -> Array:
    ends = in_range(name, value, low, high)
    if ends.shape != (2,) or ends[0] >= ends[1]:
        raise InvalidArgumentError(name, value, "two ends of a range, ascending")
    return ends


def _grid(axes: list[Array]) -> Array:
    return np.stack([coordinate.ravel() for coordinate in np.meshgrid(*axes, indexing="ij")], axis=1)


def _predicted(motions: Sequence[Record], blocks: Array) -> Flags:
    """True where a block (blocks, 3) overturns under a motion: (blocks, tests)."""
    alpha, half_diagonal, eta = blocks.T
    p = np.sqrt(0.75 * STANDARD_GRAVITY / half_diagonal)
    columns = []
    for motion in motions:
        slenderness = STANDARD_GRAVITY * np.tan(alpha) / motion.peak_acceleration
        response = record_response(motion, frequency_parameter=p, slenderness=slenderness, restitution=eta, alpha=alpha)
        columns.append(response.overturned)
    return np.stack(columns, axis=1).astype(bool)


def _middle(blocks: Array, share: Array) -> Array:
    """The block next to the mean of those with the largest share of right outcomes, over the spread of all."""
    equal = blocks[share == share.max()]
    distance = (((equal - equal.mean(axis=0)) / np.ptp(blocks, axis=0)) ** 2).sum(axis=1)
    return np.asarray(equal[distance.argmin()])


def _ends_of_best(blocks: Array, right: Flags, level: float) -> tuple[Array, Array]:
    """Lower and upper ends (3,) of the parameters of the blocks that are best in resamples of the tests."""
    tests = right.shape[1]
    counts = np.random.default_rng(SEED).multinomial(tests, np.full(tests, 1.0 / tests), RESAMPLES)
    scores = right.astype(np.float32) @ counts.T.astype(np.float32)  # integers, exact
    equal = [blocks[score == score.max()] for score in scores.T]
    tail = 0.5 * (1.0 - level)
    low = np.quantile([best.min(axis=0) for best in equal], tail, axis=0, method="inverted_cdf")
    high = np.quantile([best.max(axis=0) for best in equal], 1.0 - tail, axis=0, method="inverted_cdf")
    return low, high


def _above(values: Array) -> Flags:
    """Rules that a test overturns from each of the values on, and none: (rules, tests)."""
    return np.asarray(values >= np.append(np.sort(values), np.inf)[:, None])


def _validated(rules: Flags, overturned: Flags, folds: int) -> float:
    """Share of right predictions of the tests of each fold by the middle one of the best rules on the others."""
    fold = np.random.default_rng(SEED).permutation(overturned.size) % folds
    right = rules == overturned
    count = 0
    for k in range(folds):
        score = right[:, fold != k].sum(axis=1)
        best = np.flatnonzero(score == score.max())
        count += right[best[best.size // 2], fold == k].sum()
    return float(count / overturned.size)
