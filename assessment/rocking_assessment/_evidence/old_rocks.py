"""What rocks that still stand say about the hazard: probabilities of survival, and motions that they have not seen."""

from __future__ import annotations

from collections.abc import Sequence
from os import PathLike
from typing import Any

import numpy as np
import xarray as xr
from scipy.special import ndtri

from rocking.extension import (
    RESOLUTION,
    AbstractBlock,
    InvalidArgumentError,
    Record,
    Scalar,
    StopFlag,
    checked_resolution,
    float_array,
    number,
    offset_doubts,
    overturning_scale,
    variable,
)
from rocking_assessment._hazard.curve_files import hazard_arrays
from rocking_assessment._hazard.rates import Hazard, annual_rate

MAX_YEARS = 1e9  # longest age of a rock [year]


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
    found = xr.concat([annual_rate(fragility, one) for one in branches], "branch")
    result = xr.Dataset(
        {
            "annual_rate": found["annual_rate"],
            "survival": np.exp(-time * found["annual_rate"]),
            "survival_lower": np.exp(-time * found["annual_rate_upper"]),
            "survival_upper": np.exp(-time * found["annual_rate_lower"]),
        },
        attrs={"years": time, "measure": fragility.attrs.get("measure", "")},
    )
    for name, bound in (("survival", ""), ("survival_lower", ", at least"), ("survival_upper", ", at most")):
        result[name].attrs = {"units": "1", "long_name": f"probability that the rock has not been overturned{bound}"}
    return result if several else result.isel(branch=0)


def _branches(hazard: Any) -> tuple[list[Any], bool]:
    """The hazard curve of each branch, and whether there are several."""
    if isinstance(hazard, (list, tuple)) and hazard and all(isinstance(one, str | PathLike) for one in hazard):
        return [*hazard], True
    if not isinstance(hazard, (list, tuple, np.ndarray)):
        return [hazard], False
    intensity, rates = hazard_arrays(hazard)
    checked = float_array("hazard rate", rates, unit="1/year")
    return ([(intensity, branch) for branch in checked], True) if checked.ndim == 2 else ([hazard], False)


def unexceeded(
    body: AbstractBlock,
    motions: Sequence[Record],
    *,
    probability: Scalar = 0.95,
    resolution: Scalar = RESOLUTION,
    stop: StopFlag | None = None,
) -> xr.Dataset:
    """Pairs of PGA and PGV that a standing rock has, with a stated probability, never been exposed to.

    Every record is scaled to the lowest factor at which it overturns the rock. The logarithm of its PGA there is fitted
    by a line over that of PGV/PGA, which scaling does not change, ln PGA = a + b ln(PGV/PGA), with a standard deviation
    s (Purvance et al. 2008). At the ratio of each record the pair that overturns with the probability P is that of
    a + b ln(PGV/PGA) + s z(P), z the quantile of the normal distribution.

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
        Over `record`: `overturning_acceleration` [m/s2] and `overturning_velocity` [m/s] of the scaled records, nan for
        one that does not overturn the rock up to ten times the scale of uplift; `unexceeded_acceleration` and
        `unexceeded_velocity` of the line; and `intercept`, `slope` and `dispersion` [-], a (for PGA in m/s2, PGV/PGA in
        s), b and s. The attribute `warnings`, where there is one, names records whose offset is part of their PGA.

    Raises
    ------
    InvalidArgumentError
        If an argument is not as described, or too few records overturn the rock.

    References
    ----------
    Purvance M. D., Anooshehpoor A., Brune J. N. (2008), Freestanding block overturning fragilities: numerical
    simulation and experimental validation, Earthquake Engineering & Structural Dynamics 37(5), 791-808.
    """
    share = number("probability", probability, 0.0, 1.0, closed="neither")
    pga, pgv = (np.array([getattr(one, name) for one in motions]) for name in ("peak_acceleration", "peak_velocity"))
    lowest = np.array([overturning_scale(one, body, resolution=resolution, stop=stop) for one in motions])
    over = np.isfinite(lowest)
    x, y = np.log(pgv / pga), np.log(lowest * pga)
    if over.sum() < 4 or np.ptp(x[over]) == 0.0:
        allowed = "four records or more that overturn the rock, of different PGV/PGA"
        raise InvalidArgumentError("motions", f"{over.sum()} records that overturn it", allowed)
    slope, intercept = np.polyfit(x[over], y[over], 1)
    line = intercept + slope * x
    dispersion = float(np.sqrt(((y - line)[over] ** 2).sum() / (over.sum() - 2)))
    level = np.exp(line + dispersion * ndtri(share))
    names = {
        "overturning_acceleration": ("m s-2", lowest * pga, "PGA of the record at the lowest factor that overturns"),
        "overturning_velocity": ("m s-1", lowest * pgv, "PGV of the record at the lowest factor that overturns"),
        "unexceeded_acceleration": ("m s-2", level, "PGA that overturns with the probability"),
        "unexceeded_velocity": ("m s-1", level * pgv / pga, "PGV that overturns with the probability"),
    }
    doubts = offset_doubts(motions)
    return xr.Dataset(
        {name: variable("record", values, unit, text) for name, (unit, values, text) in names.items()}
        | {"intercept": ((), intercept), "slope": ((), slope), "dispersion": ((), dispersion)},
        {"record": ("record", [one.name for one in motions])},
        {"probability": share, "resolution": checked_resolution(resolution)}
        | ({"warnings": "; ".join(doubts)} if doubts else {}),
    )
