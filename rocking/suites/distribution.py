"""Distribution of peak rotations over an ensemble of motions or restitutions, with its confidence bands.

One history promises little where a body strikes many times: a small change of the motion or of the restitution changes
the outcome. What can be compared between a computation and tests, or two computations, is the distribution over an
ensemble, F(x) = share of its members whose peak |theta|/alpha is at most x; one that overturns exceeds every x.

References
----------
Massart P. (1990), The tight constant in the Dvoretzky-Kiefer-Wolfowitz inequality, Annals of Probability 18(3),
1269-1283.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from rocking._base.errors import InvalidArgumentError, in_range, number
from rocking._base.units import Scalar
from rocking._dimensional.response import BodyResponse
from rocking._model.labelled import variable
from rocking.suites.fits import binomial_interval

ROTATIONS = 201  # rotations at which a distribution is given without others [-]


def distribution(
    ensemble: xr.Dataset | BodyResponse,
    *,
    over: str = "record",
    rotation: ArrayLike | None = None,
    confidence: Scalar = 0.95,
) -> xr.Dataset:
    """Distribution of the peak rotation over the members of an ensemble, and the share that overturns.

    The members count as independent draws from one population, such as ground motions of a site, or one motion with
    restitutions that are drawn from their distribution.

    Parameters
    ----------
    ensemble : xarray.Dataset or BodyResponse
        Result of `rocking.fragility`, or a response of arrays, also labelled ones: `peak_rotation` and `overturned`. A
        record and its mirror image, "NAME, mirrored", count as one member with half the weight each.
    over : str
        The dimension of the members; of a response the argument that is an array, such as "restitution".
    rotation : array_like, (rotations,), optional
        x, |theta|/alpha [-], >= 0, ascending; by default 201 values up to the largest peak, at least 1.
    confidence : float
        Of intervals and bands [-], (0, 1).

    Returns
    -------
    xarray.Dataset
        Over the other dimensions of the ensemble and `rotation`: `probability` F(x); its Clopper-Pearson interval
        `probability_lower`, `probability_upper`, for one x; and the band that contains the whole of F with the
        confidence at least, `band_lower`, `band_upper`: F(x) +- sqrt(ln(2/(1 - confidence))/(2 n)) of n members
        (Massart 1990). Without `rotation`: `overturned`, the share that overturns, `overturned_lower` and
        `overturned_upper`.

    Raises
    ------
    InvalidArgumentError
        If the ensemble has no such dimension, or an argument is not as described.
    """
    level = number("confidence", confidence, 0.0, 1.0, closed="neither")
    data: Any = ensemble.to_xarray() if isinstance(ensemble, BodyResponse) else ensemble
    if not isinstance(data, xr.Dataset) or not {"peak_rotation", "overturned"} <= {*data}:
        raise InvalidArgumentError("ensemble", ensemble, "a result of rocking.fragility, or a response of arrays")
    if over not in data["peak_rotation"].dims or not data.sizes[over]:
        raise InvalidArgumentError("over", over, f"one of {', '.join(map(str, data['peak_rotation'].dims)) or 'none'}")
    overturned = data["overturned"].astype(bool)
    peak = data["peak_rotation"].where(~overturned, np.inf)
    if rotation is None:
        largest = float(peak.where(np.isfinite(peak), 0.0).max())
        thresholds = np.linspace(0.0, max(largest, 1.0), ROTATIONS)
    else:
        thresholds = np.atleast_1d(in_range("rotation", rotation, 0.0, math.inf, closed="left"))
        if thresholds.ndim != 1 or np.any(np.diff(thresholds) <= 0.0):
            raise InvalidArgumentError("rotation", rotation, "one dimension of ascending values")
    members = data.sizes[over]
    if over in data.coords and any(str(name).endswith(", mirrored") for name in data[over].values):
        members //= 2
    rotations = variable("rotation", thresholds, "1", "peak rotation over alpha")
    not_exceeded = (peak <= xr.DataArray(thresholds, dims="rotation")).mean(over)
    meaning = "share of the members whose peak rotation is at most the rotation"
    shares = _with_interval("probability", not_exceeded, meaning, members, level)
    half_band = math.sqrt(math.log(2.0 / (1.0 - level)) / (2.0 * members))
    for end, deviation in (("lower", -half_band), ("upper", half_band)):
        band = np.clip(not_exceeded.values + deviation, 0.0, 1.0)
        text = f"{end} end of the band that contains the whole distribution"
        shares[f"band_{end}"] = variable(not_exceeded.dims, band, "1", text)
    shares |= _with_interval("overturned", overturned.mean(over), "share of the members that overturn", members, level)
    dims = {*peak.dims} - {over}
    coordinates = {name: value for name, value in data.coords.items() if dims.issuperset(value.dims)}
    coordinates["rotation"] = rotations
    return xr.Dataset(shares, coordinates, {"members": members, "confidence": level})


def _with_interval(name: str, share: Any, meaning: str, members: int, confidence: float) -> dict[str, Any]:
    """Return a share of the members and its Clopper-Pearson interval as variables."""
    variables = {name: variable(share.dims, share.values, "1", meaning)}
    ends = binomial_interval(members * share.values, members, confidence)
    for end, values in zip(("lower", "upper"), ends, strict=True):
        text = f"{end} end of the Clopper-Pearson interval of the {name}"
        variables[f"{name}_{end}"] = variable(share.dims, values, "1", text)
    return variables
