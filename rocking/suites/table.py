"""Fragility as columns, for CSV, JSON and text."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from rocking.suites.body_arrays import OWN_DIMENSIONS
from rocking.suites.distribution import distribution
from rocking.suites.fits import FitStatus

LEVEL_COLUMNS = ("exceedances", "fraction", "fraction_lower", "fraction_upper", "first_exceedances")
"""Variables over (demand, block, intensity) that the table of levels holds."""

CURVE_COLUMNS = (
    *("median_intensity", "median_intensity_lower", "median_intensity_upper"),
    *("dispersion", "dispersion_lower", "dispersion_upper", "largest_deviation", "first_median_intensity"),
)
"""Variables over (demand, block, model) that the table of curves holds."""


def fragility_table(fragility: xr.Dataset) -> dict[str, list[Any]]:
    """One row for each limit state, block and level of a result of `rocking.fragility`.

    Columns demand, width [m], height [m], intensity (unit of the measure), the counts and fractions with their
    interval, and the fitted probability of each model, such as `lognormal`.
    """
    found = _with_dimensions(fragility)
    order = ("demand", "block", "intensity")
    columns = {name: found[name].transpose(*order).values for name in LEVEL_COLUMNS}
    for model in found["model"].values.tolist():
        columns[model] = found["fitted"].sel(model=model).transpose(*order).values
    return _rows(found, {"intensity": found["intensity"].values, **columns})


def curve_table(fragility: xr.Dataset, more: Sequence[str] = ()) -> dict[str, list[Any]]:
    """One row for each limit state, block and model: the fitted curve, its intervals, and the records named.

    Columns demand, width [m], height [m], model, fit_status (name of `FitStatus`), `CURVE_COLUMNS`, further variables
    over demand, block and model that `more` names, and records_surviving_above_first, separated by semicolons.
    """
    found = _with_dimensions(fragility)
    order = ("demand", "block", "model")
    status = np.vectorize(lambda code: FitStatus(code).name, otypes=[str])(found["fit_status"].transpose(*order).values)
    columns = {name: found[name].transpose(*order).values for name in (*CURVE_COLUMNS, *more)}
    named = found["records_surviving_above_first"].transpose("demand", "block").values[:, :, None]
    models = {"model": found["model"].values, "fit_status": status}
    return _rows(found, {**models, **columns, "records_surviving_above_first": named})


SENSITIVITY_COLUMNS = (
    *("exceedances", "fraction", "fraction_lower", "fraction_upper"),
    *("fraction_low_restitution", "changed_low_restitution", "fraction_high_restitution", "changed_high_restitution"),
    *("fraction_resampled", "changed_resampled", "records_changed_by_sampling"),
    *("friction_demand_median", "friction_demand_largest"),
)
"""Variables over (block, intensity) that the table of sensitivities holds."""


def sensitivity_table(sensitivity: xr.Dataset) -> dict[str, list[Any]]:
    """One row for each block and level of a result of `rocking.suites.suite_sensitivity`.

    Columns width [m], height [m], intensity (unit of the measure), restitution and its smaller and larger value
    `restitution_low` and `restitution_high` [-], and `SENSITIVITY_COLUMNS`.
    """
    found = with_block(sensitivity)
    columns = {name: found[name].transpose("block", "intensity").values for name in SENSITIVITY_COLUMNS}
    restitution = {name: _by_block(found, name) for name in ("restitution", "restitution_low", "restitution_high")}
    return _rows(found, {"intensity": found["intensity"].values, **restitution, **columns})


def distribution_table(fragility: xr.Dataset) -> dict[str, list[Any]]:
    """One row for each block, level and rotation up to alpha in steps of 0.05: the columns of `distribution`."""
    found = distribution(with_block(fragility), rotation=np.linspace(0.0, 1.0, 21))
    found = found.broadcast_like(found["probability"]).transpose("block", "intensity", "rotation", ...)
    rows = {str(name): value.values for name, value in found.data_vars.items()}
    sizes = {name: found[name].values[:, None, None] for name in ("width", "height")}
    axes = {"intensity": found["intensity"].values[:, None], "rotation": found["rotation"].values}
    everything = sizes | axes | rows
    shape = np.broadcast_shapes(*(np.shape(values) for values in everything.values()))
    return {name: np.broadcast_to(values, shape).ravel().tolist() for name, values in everything.items()}


def finite_columns(columns: Mapping[str, list[Any]]) -> dict[str, list[Any]]:
    """Columns with None for numbers that are not finite, which JSON does not have."""
    return {
        name: [None if isinstance(value, float) and not math.isfinite(value) else value for value in values]
        for name, values in columns.items()
    }


def _with_dimensions(fragility: xr.Dataset) -> xr.Dataset:
    """The result with the dimensions demand and block, also where it was made for one of them."""
    found = with_block(fragility)
    return found if "demand" in found.dims else found.expand_dims("demand")


def with_block(found: xr.Dataset) -> xr.Dataset:
    """The result with the dimension block, also where it was made for one, or for an array of bodies (C order)."""
    if "block" in found.dims:
        return found
    if array := [name for name in found["overturned"].dims if name not in OWN_DIMENSIONS]:
        return found.stack(block=array, create_index=False)
    own = [name for name, value in found.coords.items() if value.ndim == 0 and name not in ("demand",)]
    return found.reset_coords(own).expand_dims("block").set_coords(own)


def _rows(found: xr.Dataset, columns: dict[str, Any]) -> dict[str, list[Any]]:
    """Columns that broadcast to (demand, block, last), one row each, after the limit state, if any, and the block."""
    demand = {"demand": found["demand"].values.astype(str)[:, None, None]} if "demand" in found.coords else {}
    sizes = {name: _by_block(found, name) for name in ("width", "height")}
    everything = {**demand, **sizes, **columns}
    shape = np.broadcast_shapes(*(np.shape(values) for values in everything.values()))
    return {name: np.broadcast_to(values, shape).ravel().tolist() for name, values in everything.items()}


def _by_block(found: xr.Dataset, name: str) -> Any:
    values = found[name]
    return (values if values.ndim == 1 else values.isel(demand=0)).values[:, None]
