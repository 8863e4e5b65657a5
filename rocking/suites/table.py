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
    """Return one row for each limit state, block and level of a result of `rocking.fragility`.

    Columns demand, width [m], height [m], intensity (unit of the measure), the counts and fractions with their
    interval, and the fitted probability of each model, such as `lognormal`.
    """
    result = _with_dimensions(fragility)
    order = ("demand", "block", "intensity")
    columns = {"intensity": result["intensity"].values}
    columns |= {name: result[name].transpose(*order).values for name in LEVEL_COLUMNS}
    for model in result["model"].values.tolist():
        columns[model] = result["fitted"].sel(model=model).transpose(*order).values
    return _rows(result, columns)


def curve_table(fragility: xr.Dataset, extra: Sequence[str] = ()) -> dict[str, list[Any]]:
    """Return one row for each limit state, block and model: the fitted curve, its intervals, and the records named.

    Columns demand, width [m], height [m], model, fit_status (name of `FitStatus`), `CURVE_COLUMNS`, `extra` variables
    over demand, block and model, and records_surviving_above_first, separated by semicolons.
    """
    result = _with_dimensions(fragility)
    order = ("demand", "block", "model")
    status = result["fit_status"].transpose(*order).values
    columns = {
        "model": result["model"].values,
        "fit_status": np.vectorize(lambda code: FitStatus(code).name, otypes=[str])(status),
    }
    columns |= {name: result[name].transpose(*order).values for name in (*CURVE_COLUMNS, *extra)}
    records = result["records_surviving_above_first"].transpose("demand", "block").values
    columns["records_surviving_above_first"] = records[:, :, None]
    return _rows(result, columns)


SENSITIVITY_COLUMNS = (
    *("exceedances", "fraction", "fraction_lower", "fraction_upper"),
    *("fraction_low_restitution", "changed_low_restitution", "fraction_high_restitution", "changed_high_restitution"),
    *("fraction_resampled", "changed_resampled", "records_changed_by_sampling"),
    *("friction_demand_median", "friction_demand_largest"),
)
"""Variables over (block, intensity) that the table of sensitivities holds."""


def sensitivity_table(sensitivity: xr.Dataset) -> dict[str, list[Any]]:
    """Return one row for each block and level of a result of `rocking.suites.suite_sensitivity`.

    Columns width [m], height [m], intensity (unit of the measure), restitution and its smaller and larger value
    `restitution_low` and `restitution_high` [-], and `SENSITIVITY_COLUMNS`.
    """
    result = with_block(sensitivity)
    columns = {"intensity": result["intensity"].values}
    columns |= {name: _by_block(result, name) for name in ("restitution", "restitution_low", "restitution_high")}
    columns |= {name: result[name].transpose("block", "intensity").values for name in SENSITIVITY_COLUMNS}
    return _rows(result, columns)


def distribution_table(fragility: xr.Dataset) -> dict[str, list[Any]]:
    """Return one row for each block, level and rotation up to alpha in steps of 0.05: the columns of `distribution`."""
    result = distribution(with_block(fragility), rotation=np.linspace(0.0, 1.0, 21))
    result = result.broadcast_like(result["probability"]).transpose("block", "intensity", "rotation", ...)
    columns = {name: result[name].values[:, None, None] for name in ("width", "height")}
    columns["intensity"] = result["intensity"].values[:, None]
    columns["rotation"] = result["rotation"].values
    columns |= {str(name): value.values for name, value in result.data_vars.items()}
    return _broadcast(columns)


def finite_columns(columns: Mapping[str, list[Any]]) -> dict[str, list[Any]]:
    """Replace by None the numbers of columns that are not finite, which JSON does not have."""
    return {name: [_finite(value) for value in values] for name, values in columns.items()}


def _finite(value: Any) -> Any:
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _with_dimensions(fragility: xr.Dataset) -> xr.Dataset:
    """Add the dimensions demand and block to a result for a single one of them."""
    result = with_block(fragility)
    return result if "demand" in result.dims else result.expand_dims("demand")


def with_block(result: xr.Dataset) -> xr.Dataset:
    """Add the dimension block to a result for one body, or for an array of bodies (C order)."""
    if "block" in result.dims:
        return result
    if array := [name for name in result["overturned"].dims if name not in OWN_DIMENSIONS]:
        return result.stack(block=array, create_index=False)
    scalars = [name for name, value in result.coords.items() if value.ndim == 0 and name != "demand"]
    return result.reset_coords(scalars).expand_dims("block").set_coords(scalars)


def _rows(result: xr.Dataset, columns: dict[str, Any]) -> dict[str, list[Any]]:
    """Return columns that broadcast to (demand, block, last) in rows, after the limit state, if any, and the block."""
    leading = {name: _by_block(result, name) for name in ("width", "height")}
    if "demand" in result.coords:
        leading = {"demand": result["demand"].values.astype(str)[:, None, None], **leading}
    return _broadcast(leading | columns)


def _broadcast(columns: dict[str, Any]) -> dict[str, list[Any]]:
    """Return columns that broadcast to one shape as lists of its size, in C order."""
    shape = np.broadcast_shapes(*map(np.shape, columns.values()))
    return {name: np.broadcast_to(values, shape).ravel().tolist() for name, values in columns.items()}


def _by_block(result: xr.Dataset, name: str) -> Any:
    values = result[name]
    if values.ndim > 1:
        values = values.isel(demand=0)
    return values.values[:, None]
