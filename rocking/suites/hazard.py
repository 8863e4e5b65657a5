"""Annual rate of reaching a limit state, from a fragility curve and a hazard curve.

The rate is the integral of P(x) over the annual rate H(x) at which the intensity x is exceeded, -int P(x) dH(x)
(Cornell 1968; McGuire 2004). Between the given points H is a power of x, as on paper with logarithmic axes. Intensities
above the highest point have the rate H there; their share is between that of P at the highest point and that of P = 1.

References
----------
Cornell C. A. (1968), Engineering seismic risk analysis, Bulletin of the Seismological Society of America 58(5),
1583-1606. McGuire R. K. (2004), Seismic hazard and risk analysis, Earthquake Engineering Research Institute.
"""

from __future__ import annotations

import math
from os import PathLike
from typing import TypeAlias

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from rocking._base.errors import InvalidArgumentError
from rocking.suites.curve import curve_probability
from rocking.suites.hazard_curve import check_hazard_curve
from rocking.suites.hazard_files import hazard_arrays

Array = NDArray[np.float64]

STEP = 0.02
"""Largest part of ln x that is integrated at once [-], by `NODES` Gauss points."""

NODES = 4


Hazard: TypeAlias = "str | PathLike[str] | xr.DataArray | tuple[ArrayLike, ArrayLike]"
"""A hazard curve: a file, a result of `read_hazard`, or intensities and annual rates."""


def annual_rate(fragility: xr.Dataset, hazard: Hazard) -> xr.Dataset:
    """Annual rate at which a limit state is reached.

    Parameters
    ----------
    fragility : xarray.Dataset
        Result of `rocking.fragility`; its fitted curves are used.
    hazard : path, xarray.DataArray, or pair of arrays
        A file that `rocking.suites.read_hazard` reads; annual rate of exceedance [1/year], > 0 and not increasing, over
        its coordinate `intensity`; or the intensities and the rates. At least two intensities, > 0, ascending, in the
        measure and unit of the fragility.

    Returns
    -------
    xarray.Dataset
        `annual_rate` [1/year] with the dimensions of the medians, nan where there is no curve;
        `annual_rate_upper`, in which every intensity above the highest one reaches the limit state.

    Raises
    ------
    InvalidArgumentError
        If the hazard curve is not as described or of another measure, or the data set holds no fitted curves.
    """
    if not {"median_intensity", "dispersion", "model"} <= {*fragility.variables}:
        raise InvalidArgumentError("fragility", sorted(map(str, fragility.variables)), "a result of rocking.fragility")
    x, rates = check_hazard_curve(hazard_arrays(hazard, fragility.attrs.get("measure")))
    weights, nodes = hazard_quadrature(x, rates)
    found = xr.full_like(fragility["median_intensity"], np.nan)
    at_end = xr.full_like(fragility["median_intensity"], np.nan)
    for name in fragility["model"].values.tolist():
        own = {"model": name}
        median, dispersion = (fragility[part].sel(own).values[..., None] for part in ("median_intensity", "dispersion"))
        found.loc[own] = curve_probability(name, nodes, median, dispersion) @ weights
        at_end.loc[own] = curve_probability(name, x[-1], median, dispersion)[..., 0]
    lower = found + at_end * rates[-1]
    about = {"units": "year-1", "comment": f"hazard curve from {x[0]:g} to {x[-1]:g}, nothing is added below"}
    return xr.Dataset(
        {
            "annual_rate": lower.assign_attrs(
                about, long_name="annual rate of reaching the limit state, above the hazard curve as at its end"
            ),
            "annual_rate_upper": (found + rates[-1]).assign_attrs(
                about, long_name="annual rate of reaching the limit state, reached by all above the hazard curve"
            ),
        },
        attrs={"measure": fragility.attrs.get("measure", "")},
    )


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
