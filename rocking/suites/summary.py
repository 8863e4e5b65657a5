"""What the outcomes of a suite say of each block: the margin of each record, and quantiles of the peak rotation."""

from __future__ import annotations

import numpy as np
import xarray as xr

from rocking.suites.intensity import MEASURES

QUANTILES = (0.16, 0.5, 0.84)
"""Shares of the records, those of a normal distribution at one standard deviation below, at and above its mean [-]."""


def record_margins(outcomes: xr.Dataset) -> xr.Dataset:
    """The mildest level at which each record overturns each block, and the levels above it that the block survives.

    Parameters
    ----------
    outcomes : xarray.Dataset
        Result of `rocking.suites.outcomes.suite_outcomes`, or the file `outcomes.nc` of the workflow.

    Returns
    -------
    xarray.Dataset
        Over (block, record): `overturning_intensity`, in the unit of the measure, nan where the block survives every
        level; `overturning_scale` [-], the factor of the record there; `levels_survived_above` [-], the number of
        stronger levels at which the block survives all the same. Thresholds lie between a level and the one before it.
    """
    overturned = outcomes["overturned"].transpose("block", "intensity", "record").values.astype(bool)
    scale = outcomes["scale"].transpose("block", "intensity", "record").values
    levels = outcomes["intensity"].values
    if not MEASURES[outcomes.attrs["measure"]].scales_amplitude:  # from the mildest level on, which is the last one
        overturned, scale, levels = overturned[:, ::-1], scale[:, ::-1], levels[::-1]
    first = overturned.argmax(axis=1)
    any_overturns = overturned.any(axis=1)
    later = np.maximum.accumulate(overturned, axis=1)
    at_first = np.take_along_axis(scale, first[:, None], axis=1)[:, 0]
    dims = ("block", "record")
    unit = outcomes["intensity"].attrs.get("units", "1")
    return xr.Dataset(
        {
            "overturning_intensity": (dims, np.where(any_overturns, levels[first], np.nan), {"units": unit}),
            "overturning_scale": (dims, np.where(any_overturns, at_first, np.nan), {"units": "1"}),
            "levels_survived_above": (dims, (later & ~overturned).sum(axis=1), {"units": "1"}),
        },
        {"record": outcomes["record"].values},
    )


def rotation_quantiles(outcomes: xr.Dataset) -> xr.DataArray:
    """The peak rotation |theta|/alpha that a share of the records does not exceed, at each level.

    A record that overturns the block exceeds every rotation. A quantile is the smallest peak of the sample that at
    least this share of the records does not exceed: nothing is interpolated.

    Parameters
    ----------
    outcomes : xarray.Dataset
        As for `record_margins`.

    Returns
    -------
    xarray.DataArray
        (quantile, block, intensity) [-]; nan where too many records overturn the block.
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
