"""Annual rate of reaching a limit state, from a fragility curve and a hazard curve.

The rate is the integral of P(x) over the annual rate H(x) at which the intensity x is exceeded, -int P(x) dH(x)
(Cornell 1968; McGuire 2004). Between the given points H is a power of x, as on paper with logarithmic axes. Intensities
above the highest point have the rate H there; their share is between that of P at the highest point and that of P = 1.

References
----------
Cornell C. A. (1968), Engineering seismic risk analysis, Bulletin of the Seismological Society of America 58(5),
1583-1606. McGuire R. K. (2004), Seismic hazard and risk analysis, Earthquake Engineering Research Institute.
"""

import math
from os import PathLike
from typing import TypeAlias

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from rocking.extension import Array, FitStatus, InvalidArgumentError, curve_probability
from rocking_assessment._hazard.checks import check_hazard_curve
from rocking_assessment._hazard.curve_files import hazard_arrays

STEP = 0.02  # largest part of ln x that is integrated at once [-], by `NODES` Gauss points

NODES = 4

NARROW, PARTS = 0.1, np.linspace(-8.0, 8.0, 65)
"""Dispersion below which the parts are divided around the median [-], and where, in dispersions from it."""

NEGLIGIBLE = 0.01  # share of the rate that intensities below the hazard curve may add without a word [-]


Hazard: TypeAlias = "str | PathLike[str] | xr.DataArray | tuple[ArrayLike, ArrayLike]"
"""A hazard curve: a file, a result of `read_hazard`, or intensities and annual rates."""


def annual_rate(fragility: xr.Dataset, hazard: Hazard) -> xr.Dataset:
    """Annual rate at which a limit state is reached.

    Parameters
    ----------
    fragility : xarray.Dataset
        Result of `rocking.fragility`; its fitted curves are used.
    hazard : path, xarray.DataArray, or pair of arrays
        A file that `rocking_assessment.read_hazard` reads; annual rate of exceedance [1/year], > 0 and not
        increasing, over its coordinate `intensity`; or the intensities and the rates. At least two intensities, > 0,
        ascending, in the measure and unit of the fragility.

    Returns
    -------
    xarray.Dataset
        `annual_rate` [1/year] with the dimensions of the medians, nan where there is no curve, and its bounds.
        `annual_rate_lower`: above the hazard curve the probability is that at its end, below it nothing is added.
        `annual_rate_upper`: every intensity above the highest one reaches the limit state; infinite if the probability
        at the lowest one is so large that weaker ones, whose rate is not known, could add 1 %. Without a curve they
        hold for a limit state that no record reaches up to the highest level, or that all reach from the lowest one on.

    Raises
    ------
    InvalidArgumentError
        If the hazard curve is not as described or of another measure, or the data set holds no fitted curves.
    """
    if not {"median_intensity", "dispersion", "model"} <= {*fragility.variables}:
        raise InvalidArgumentError("fragility", sorted(map(str, fragility.variables)), "a result of rocking.fragility")
    x, rates = check_hazard_curve(hazard_arrays(hazard, fragility.attrs.get("measure")))
    shape = fragility["median_intensity"]
    lower, upper = xr.full_like(shape, np.nan), xr.full_like(shape, np.nan)
    levels = np.full(2, np.nan)
    if "intensity" in fragility.coords:
        levels = fragility["intensity"].values[[0, -1]]
    for model in fragility["model"].values.tolist():
        curves = fragility.sel(model=model)
        bounds = [*curve_rates(model, x, rates, curves["median_intensity"].values, curves["dispersion"].values)]
        if "fit_status" in curves:
            status = curves["fit_status"].values
            none_reaches, all_reach = outcome_rates(x, rates, levels)
            for k in range(2):
                bounds[k] = np.where(status == FitStatus.ALL_REACH, all_reach[k], bounds[k])
                bounds[k] = np.where(status == FitStatus.NONE_REACHES, none_reaches[k], bounds[k])
        lower.loc[{"model": model}], upper.loc[{"model": model}] = bounds
    estimate = lower.where(np.isfinite(shape))
    attributes = {"units": "year-1", "comment": f"hazard curve from {x[0]:g} to {x[-1]:g}"}
    meaning = "annual rate of reaching the limit state"
    return xr.Dataset(
        {
            "annual_rate": estimate.assign_attrs(
                attributes, long_name=f"{meaning}, above the hazard curve as at its end"
            ),
            "annual_rate_lower": lower.assign_attrs(attributes, long_name=f"{meaning}, at least"),
            "annual_rate_upper": upper.assign_attrs(attributes, long_name=f"{meaning}, at most; infinite: not bounded"),
        },
        attrs={"measure": fragility.attrs.get("measure", "")},
    )


def curve_rates(model: str, x: Array, rates: Array, median: Array, dispersion: Array) -> tuple[Array, Array]:
    """Lower and upper bounds of the annual rate at which curves reach limit states, nan without a curve [1/year].

    `x`, `rates`: the hazard curve; `median`, `dispersion` (...): of the curves of kind `model`. See `annual_rate`.
    """
    weights, nodes = hazard_quadrature(x, rates)
    integral = np.asarray(curve_probability(model, nodes, median[..., None], dispersion[..., None]) @ weights)
    for k in map(tuple, np.argwhere(np.abs(dispersion) < NARROW)):
        inner = np.unique(median[k] * np.exp(np.abs(dispersion[k]) * PARTS))
        parts = np.union1d(x, inner[(inner > x[0]) & (inner < x[-1])])
        weights, nodes = hazard_quadrature(parts, exceedance_rates(x, rates, parts))
        integral[k] = curve_probability(model, nodes, median[k], dispersion[k]) @ weights
    at_start = curve_probability(model, x[0], median, dispersion)
    at_end = curve_probability(model, x[-1], median, dispersion)
    lower = integral + at_end * rates[-1]
    unbounded = at_start * rates[0] > NEGLIGIBLE * lower
    return lower, np.where(unbounded, np.inf, integral + rates[-1])


def outcome_rates(x: Array, rates: Array, levels: Array) -> tuple[tuple[float, float], tuple[float, float]]:
    """Bounds of the annual rate if no record reaches a limit state up to the last level, or all from the first on."""
    first, last = levels[0], levels[-1]
    upper = np.inf if last < x[0] else float(exceedance_rates(x, rates, last))
    lower = 0.0 if first > x[-1] else float(exceedance_rates(x, rates, first))
    return (0.0, upper), (lower, np.inf)


def exceedance_rates(x: Array, rates: Array, intensity: Array) -> Array:
    """Annual rates at which intensities are exceeded [1/year]; beyond the hazard curve those of its ends."""
    return np.asarray(np.exp(np.interp(np.log(intensity), np.log(x), np.log(rates))))


def hazard_quadrature(x: Array, rates: Array) -> tuple[Array, Array]:
    """Weights and nodes for the integral of a function of x over -dH(x), H a power of x between the points."""
    nodes, gauss = np.polynomial.legendre.leggauss(NODES)
    weights, points = [], []
    for k in range(x.size - 1):
        width = math.log(x[k + 1] / x[k])
        exponent = math.log(rates[k] / rates[k + 1]) / width
        parts = math.ceil(width / STEP)
        half = 0.5 * width / parts
        log_x = ((2.0 * np.arange(parts) + 1.0)[:, None] * half + half * nodes).ravel()
        # -dH = exponent H d(ln x)
        weights.append(exponent * rates[k] * np.exp(-exponent * log_x) * half * np.tile(gauss, parts))
        points.append(x[k] * np.exp(log_x))
    return np.concatenate(weights), np.concatenate(points)
