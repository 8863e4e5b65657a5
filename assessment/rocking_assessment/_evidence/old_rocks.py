"""Constraints on hazard from rocks that still stand: probabilities of survival, and unexceeded ground motions."""

from __future__ import annotations

import math
from collections.abc import Sequence
from os import PathLike
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from scipy.optimize import minimize
from scipy.special import log_ndtr, stdtrit

from rocking.extension import (
    RESOLUTION,
    AbstractBlock,
    Array,
    Flags,
    InvalidArgumentError,
    Record,
    Scalar,
    StopFlag,
    block_lines,
    checked_resolution,
    float_array,
    number,
    offset_doubts,
    overturning_scale,
    restitution_of,
    search_range,
    variable,
)
from rocking_assessment._hazard.curve_files import hazard_arrays
from rocking_assessment._hazard.rates import Hazard, annual_rate

MAX_YEARS = 1e9  # longest age of a rock [year]
FEWEST = 4  # fewest records that overturn a rock from which a line is fitted [-]
LARGEST_DISPERSION = 5.0  # largest s [-]: ten times the factor of uplift is 2.3

SKEWNESS = 1.2
"""Factor of the margin [-]: outcomes are spread further above the line than below it.

Without it 0.935 to 0.95 of held-out records overturn for a stated 0.95 with suites of 12 to 30 records.
`python -m benchmarks.accuracy.unexceeded` measures it.
"""


def survival(fragility: xr.Dataset, hazard: Hazard | Sequence[str | PathLike[str]], *, years: Scalar) -> xr.Dataset:
    """Probability that a rock has stood for some years, under each branch of a hazard model.

    Overturning by earthquakes is a Poisson process of the rate nu = integral of P(x) abs(dH(x)), as
    `rocking_assessment.annual_rate` has it, so that the probability of none in t years is exp(-nu t) (Brune 1996;
    Baker et al. 2013, eq. 1). A branch under which it is small contradicts the rock.

    Parameters
    ----------
    fragility : xarray.Dataset
        Result of `rocking.fragility`; its fitted curves are used.
    hazard : path, sequence of paths, xarray.DataArray, or pair of arrays
        As for `rocking_assessment.annual_rate`; the second array of a pair may be (branches, levels), annual rates of
        exceedance [1/year] under several branches. Several files are as many branches.
    years : float
        Age of the rock in its present form [year], [0, 1e9].

    Returns
    -------
    xarray.Dataset
        `survival` [-] and `annual_rate` [1/year] over `branch` and the dimensions of the medians of the fragility; nan
        where there is no curve. `survival_lower` and `survival_upper` are those of the bounds of the rate.

    References
    ----------
    Brune J. N. (1996), Precariously balanced rocks and ground-motion maps for Southern California, Bulletin of the
    Seismological Society of America 86(1A), 43-54. Baker J. W., Abrahamson N. A., Whitney J. W., Board M. P., Hanks
    T. C. (2013), Use of fragile geologic structures as indicators of unexceeded ground motions and direct constraints
    on probabilistic seismic hazard analysis, Bulletin of the Seismological Society of America 103(3), 1898-1911.
    """
    time = number("years", years, 0.0, MAX_YEARS, unit="year")
    branches, several = _branches(hazard)
    rates = xr.concat([annual_rate(fragility, branch) for branch in branches], "branch")
    result = xr.Dataset(
        {
            "annual_rate": rates["annual_rate"],
            "survival": np.exp(-time * rates["annual_rate"]),
            "survival_lower": np.exp(-time * rates["annual_rate_upper"]),
            "survival_upper": np.exp(-time * rates["annual_rate_lower"]),
        },
        attrs={"years": time, "measure": fragility.attrs.get("measure", "")},
    )
    for name, bound in (("survival", ""), ("survival_lower", ", at least"), ("survival_upper", ", at most")):
        result[name].attrs = {"units": "1", "long_name": f"probability that the rock has not been overturned{bound}"}
    return result if several else result.isel(branch=0)


def _branches(hazard: Any) -> tuple[list[Any], bool]:
    """The hazard curve of each branch, and True if the argument is a list of branches."""
    if isinstance(hazard, (list, tuple)) and hazard and all(isinstance(path, str | PathLike) for path in hazard):
        return [*hazard], True
    if not isinstance(hazard, (list, tuple, np.ndarray)):
        return [hazard], False
    intensity, rates = hazard_arrays(hazard)
    checked = float_array("hazard rate", rates, unit="1/year")
    if checked.ndim != 2:
        return [hazard], False
    return [(intensity, branch) for branch in checked], True


def unexceeded(
    body: AbstractBlock,
    motions: Sequence[Record],
    *,
    probability: Scalar = 0.95,
    resolution: Scalar = RESOLUTION,
    stop: StopFlag | None = None,
) -> xr.Dataset:
    """Pairs of PGA and PGV that a standing rock has, with a stated probability, never been exposed to.

    Every record is scaled to factors from that of uplift to ten times it, and the rock is solved under each: above the
    lowest factor that overturns it, it may well survive. To all outcomes a probability of overturning is fitted that
    depends on PGA and PGV/PGA (Purvance et al. 2008), of which scaling does not change the latter:

        P = Phi((ln PGA - a - b ln(PGV/PGA))/s),

    Phi the normal distribution. A record from elsewhere, scaled to the PGA of exp(a + b ln(PGV/PGA) + m) of its own
    ratio, overturns the rock with the stated probability at least. The margin m is at least that of the prediction of
    one more of few observations, `SKEWNESS` s t sqrt(n/(n - 2)) sqrt(1 + 1/n + (1 + 1/n)/(n - 3)), t the quantile of
    Student's distribution with n - 2 degrees of freedom and n the number of records that overturn the rock. Where the
    records are so many that they show it, the margin is as large as makes P (m + 1) of the m records overturn.

    Parameters
    ----------
    body : Block
        The rock.
    motions : sequence of Record
        At least four records that overturn it, of different PGV/PGA.
    probability : float
        P that a motion of the pair overturns the rock [-], (0, 1).
    resolution : float
        Largest relative distance of the factors that are tried [-], [1e-4, 0.1].
    stop : StopFlag, optional
        Cancels the work.

    Returns
    -------
    xarray.Dataset
        Over `record`: `overturning_acceleration` [m/s2] and `overturning_velocity` [m/s] at the lowest factor that
        overturns the rock, nan where none was found; `unexceeded_acceleration` and `unexceeded_velocity`, the pair at
        the PGV/PGA of the record, nan where it is beyond the factors that were tried. `intercept`, `slope`,
        `dispersion` and `margin` [-] are a, b, s and m, for PGA in m/s2 and PGV/PGA in s: with them the pair at another
        ratio. The attribute `warnings`, where there is one, names records whose offset is part of their PGA.

    Raises
    ------
    InvalidArgumentError
        If an argument is not as described, or too few records overturn the rock.

    Notes
    -----
    The probability is that over suites and records together, of records that resemble those of the suite. One suite of
    few records can be wrong by more: `python -m benchmarks.accuracy.unexceeded` counts it.

    References
    ----------
    Purvance M. D., Anooshehpoor A., Brune J. N. (2008), Freestanding block overturning fragilities: numerical
    simulation and experimental validation, Earthquake Engineering & Structural Dynamics 37(5), 791-808.
    """
    share = number("probability", probability, 0.0, 1.0, closed="neither")
    pga = np.array([motion.peak_acceleration for motion in motions])
    pgv = np.array([motion.peak_velocity for motion in motions])
    lowest = np.array([overturning_scale(motion, body, resolution=resolution, stop=stop) for motion in motions])
    ratio = np.log(pgv / pga)
    overturning = np.isfinite(lowest)
    if overturning.sum() < FEWEST or np.ptp(ratio[overturning]) == 0.0:
        allowed = "four records or more that overturn the rock, of different PGV/PGA"
        raise InvalidArgumentError("motions", f"{overturning.sum()} records that overturn it", allowed)
    outcomes = _outcomes(body, motions, checked_resolution(resolution), stop)
    line = _line(ratio, outcomes, share)
    level = line.intercept + line.slope * ratio + line.margin
    unexceeded_pga = np.where(level <= outcomes.highest, np.exp(level), np.nan)
    unexceeded_pgv = unexceeded_pga * pgv / pga
    at_lowest, with_probability = (
        "of the record at the lowest factor that overturns",
        "that overturns with the probability",
    )
    result = xr.Dataset(
        {
            "overturning_acceleration": variable("record", lowest * pga, "m s-2", f"PGA {at_lowest}"),
            "overturning_velocity": variable("record", lowest * pgv, "m s-1", f"PGV {at_lowest}"),
            "unexceeded_acceleration": variable("record", unexceeded_pga, "m s-2", f"PGA {with_probability}"),
            "unexceeded_velocity": variable("record", unexceeded_pgv, "m s-1", f"PGV {with_probability}"),
            **line._asdict(),
        },
        {"record": [motion.name for motion in motions]},
        {"probability": share, "resolution": checked_resolution(resolution)},
    )
    doubts = offset_doubts(motions)
    if doubts:
        result.attrs["warnings"] = "; ".join(doubts)
    return result


class _Outcomes(NamedTuple):
    """Outcomes of records at factors one `step` of ln PGA apart, nan-padded: level and overturned (records, factors).

    `highest` (records,): ln PGA of the last factor of each record.
    """

    level: Array
    overturned: Flags
    step: float
    highest: Array

    def at(self, level: Array) -> Flags:
        """Outcome of each record at ln PGA (records,), or at the next higher one that was tried."""
        column = np.ceil((level - self.level[:, 0]) / self.step - 1e-9).astype(np.intp)
        rows = np.arange(level.size)
        return np.asarray(self.overturned[rows, np.clip(column, 0, self.overturned.shape[1] - 1)])


def _outcomes(body: AbstractBlock, motions: Sequence[Record], resolution: float, stop: StopFlag | None) -> _Outcomes:
    """Solve the rock under each record at each factor."""
    step = math.log1p(resolution)
    eta = restitution_of(body, "momentum")
    levels, outcomes = [], []
    for motion in motions:
        uplift, top, _ = search_range(motion, body, None)
        factor = uplift * np.exp(step * np.arange(max(math.floor(math.log(top / uplift) / step), 0) + 1.0))
        lines = block_lines(motion, body, eta, stop=stop)
        outcomes.append(lines.overturned(np.zeros(factor.size, dtype=np.intp), factor))
        levels.append(np.log(factor * motion.peak_acceleration))
    longest = max(level.size for level in levels)
    level = np.full((len(levels), longest), np.nan)
    overturned = np.zeros(level.shape, dtype=np.bool_)
    for k, (row, outcome) in enumerate(zip(levels, outcomes, strict=True)):
        level[k, : row.size], overturned[k, : row.size] = row, outcome
    return _Outcomes(level, overturned, step, np.array([row[-1] for row in levels]))


class _Line(NamedTuple):
    """ln PGA = intercept + slope ln(PGV/PGA) + margin, and the dispersion of the outcomes about it [-]."""

    intercept: float
    slope: float
    dispersion: float
    margin: float


def _line(ratio: Array, outcomes: _Outcomes, share: float) -> _Line:
    """The line above which records overturn with the probability `share`; `ratio`: ln(PGV/PGA) (records,)."""
    tried = np.isfinite(outcomes.level)
    middle, scale = float(ratio.mean()), float(ratio.std())
    x = ((ratio - middle) / scale)[np.nonzero(tried)[0]]
    y = outcomes.level[tried]
    sign = np.where(outcomes.overturned[tried], 1.0, -1.0)

    def misfit(unknowns: Array) -> tuple[float, Array]:
        """Minus the logarithm of the likelihood, and its derivatives."""
        at_middle, slope, spread = unknowns
        z = sign * (y - at_middle - slope * x) * math.exp(-spread)
        logarithm = log_ndtr(z)
        hazard = np.exp(-0.5 * z * z - logarithm) / math.sqrt(2.0 * math.pi)
        by_level = hazard * sign * math.exp(-spread)
        return -float(logarithm.sum()), np.array([by_level.sum(), (by_level * x).sum(), (hazard * z).sum()])

    survived = (tried & ~outcomes.overturned).sum(axis=1)
    start = outcomes.level[:, 0] + outcomes.step * survived
    bounds = [(None, None), (None, None), (math.log(outcomes.step), math.log(LARGEST_DISPERSION))]
    first = [float(start.mean()), 0.0, math.log(max(float(start.std()), outcomes.step))]
    at_middle, slope, spread = minimize(misfit, first, jac=True, method="L-BFGS-B", bounds=bounds).x.tolist()
    slope /= scale
    intercept = at_middle - slope * middle
    n = int(outcomes.overturned.any(axis=1).sum())
    prediction = math.sqrt(n / (n - 2.0) * (1.0 + 1.0 / n + (1.0 + 1.0 / n) / (n - 3.0)))
    dispersion = math.exp(spread)
    margin = dispersion * float(stdtrit(n - 2, share)) * prediction
    margin = max(margin, SKEWNESS * margin)
    margin = _confirmed_margin(outcomes, intercept + slope * ratio, margin, share)
    return _Line(intercept, slope, dispersion, margin)


def _confirmed_margin(outcomes: _Outcomes, line: Array, margin: float, share: float) -> float:
    """The smallest margin, from this one on, at which P (m + 1) of the m records overturn, P the share.

    Records that were not tried so high do not count. Where those that count are too few, the margin is returned.
    """
    while True:
        level = line + margin
        counted = level <= outcomes.highest
        needed = share * (counted.sum() + 1)
        if needed > counted.sum() or np.sum(outcomes.at(level) & counted) >= needed:
            return margin
        margin += outcomes.step
