"""Results of a suite for each block: the margin of each record, and quantiles of the peak rotation."""

import numpy as np
import xarray as xr

from rocking.suites.intensity import MEASURES

QUANTILES = (0.16, 0.5, 0.84)
"""Shares of the records, those of a normal distribution at one standard deviation below, at and above its mean [-]."""


def record_margins(outcomes: xr.Dataset) -> xr.Dataset:
    """Return the mildest intensity at which each record overturns each block, and the levels above it that it survives.

    From a result of `with_margins`, over (block, record): `overturning_intensity`, in the unit of the measure, nan
    where the block survives all; `overturning_scale` [-], the factor of the record there; `levels_survived_above` [-],
    the number of stronger levels at which the block survives all the same.
    """
    order = ("block", "record", "intensity")
    survived = ~outcomes["overturned"].transpose(*order).values.astype(bool)
    levels = outcomes["intensity"].values
    mildest = outcomes["overturning_intensity"].transpose("block", "record")
    if MEASURES[outcomes.attrs["measure"]].scales_amplitude:
        scale = mildest.values * outcomes["scale"].transpose(*order).values[..., 0] / levels[0]
        stronger = levels > mildest.values[..., None]
    else:
        scale = np.where(np.isnan(mildest), np.nan, 1.0)
        stronger = levels < mildest.values[..., None]
    dims = ("block", "record")
    return xr.Dataset(
        {
            "overturning_intensity": (dims, mildest.values, {"units": outcomes["intensity"].attrs.get("units", "1")}),
            "overturning_scale": (dims, scale, {"units": "1"}),
            "levels_survived_above": (dims, (survived & stronger).sum(axis=2), {"units": "1"}),
        },
        {"record": outcomes["record"].values},
    )


def rotation_quantiles(outcomes: xr.Dataset) -> xr.DataArray:
    """Return the peak rotation |theta|/alpha that a share of the records does not exceed, (quantile, block, intensity).

    A record that overturns the block exceeds every rotation: nan where too many do. A quantile is the smallest peak of
    the sample that at least this share of the records does not exceed: nothing is interpolated.
    """
    dims = ("block", "intensity", "record")
    overturned = outcomes["overturned"].transpose(*dims).values.astype(bool)
    peak = np.where(overturned, np.inf, outcomes["peak_rotation"].transpose(*dims).values)
    values = np.quantile(peak, QUANTILES, axis=2, method="inverted_cdf")
    return xr.DataArray(
        np.where(np.isfinite(values), values, np.nan),
        {"quantile": list(QUANTILES), "intensity": outcomes["intensity"].values},
        ("quantile", "block", "intensity"),
        attrs={"units": "1", "long_name": "peak of |theta|/alpha that a share of the records does not exceed"},
    )
