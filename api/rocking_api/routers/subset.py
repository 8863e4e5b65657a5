"""A part of a spectrum cube, chosen by its axes, as netCDF-3, CSV or JSON."""

from __future__ import annotations

import math
from functools import partial
from typing import Annotated, Any

import numpy as np
import xarray as xr
from fastapi import APIRouter, Query, Request, Response
from numpy.typing import NDArray

from rocking._base.errors import InvalidArgumentError
from rocking._datasets.cube import DIMENSIONS
from rocking_api.http.encoding import MEDIA_TYPES, columns_as_they_are, csv_stream, negotiated_form, netcdf_response
from rocking_api.http.errors import TooLargeError
from rocking_api.http.parameters import ParamsRoute
from rocking_api.models.params import Params
from rocking_api.models.quantity import FileFormat, said
from rocking_api.routers.datasets import DatasetName
from rocking_api.service import Service, ServiceDep

router = APIRouter(prefix="/v1/datasets", tags=["datasets"], route_class=ParamsRoute)

VARIABLES = "peak_rotation,outcome,impacts,exceeded_alpha"  # variables that are sent unless others are named

FOUND: dict[int | str, dict[str, Any]] = {
    200: {"content": {MEDIA_TYPES["nc"]: {}, MEDIA_TYPES["csv"]: {}}, "description": "the part of the cube"}
}


AXES = {
    "alpha": ("alpha_deg", 180.0 / math.pi, " deg"),
    "slenderness": ("slenderness", 1.0, ""),
    "frequency_ratio": ("frequency_ratio", 1.0, ""),
}
"""Of each axis the name of its parameters without `_min` and `_max`, their value per that of the axis, their unit."""


class SubsetParams(Params):
    """Ranges of the axes, both ends included; an absent end is that of the cube."""

    alpha_deg_min: float | None = said("smallest slenderness angle [deg]; 0: the slender limit", None)
    alpha_deg_max: float | None = said("largest slenderness angle [deg]", None)
    slenderness_min: float | None = said("smallest g tan(alpha)/a_g [-]", None, examples=[0.5])
    slenderness_max: float | None = said("largest g tan(alpha)/a_g [-]", None, examples=[0.6])
    frequency_ratio_min: float | None = said("smallest omega_g/p [-]", None, examples=[2.0])
    frequency_ratio_max: float | None = said("largest omega_g/p [-]", None, examples=[3.0])
    variables: str = said("names of variables, separated by commas; see the description", VARIABLES)
    format: FileFormat = None

    def ranges(self) -> dict[str, tuple[float, float]]:
        """Smallest and largest value of each axis in the unit of the parameters."""
        found = {}
        for axis, (name, *_) in AXES.items():
            ends = {f"{name}_min": -math.inf, f"{name}_max": math.inf}
            ends |= {end: given for end in ends if (given := getattr(self, end)) is not None}
            for end, value in ends.items():
                if math.isnan(value):
                    raise InvalidArgumentError(end, value, "a number")
            low, high = ends.values()
            if low > high:
                raise InvalidArgumentError(f"{name}_max", high, f"at least {name}_min, {low:g}")
            found[axis] = low, high
        return found


@router.get("/{name:path}/subset", summary="A part of a cube", response_class=Response, responses=FOUND)
async def get_subset(
    name: DatasetName, params: Annotated[SubsetParams, Query()], request: Request, service: ServiceDep
) -> Response:
    """Nodes of a cube within ranges of its axes: a netCDF-3 file, or one row of CSV for each node."""
    ranges = params.ranges()
    form = negotiated_form(request, params.format, ("nc", "csv"))
    return await service.run_io(partial(_subset, service, name, params, ranges, form))


def _subset(
    service: Service, name: str, params: SubsetParams, ranges: dict[str, tuple[float, float]], form: str
) -> Response:
    product, cube = service.cubes.catalogue.dataset(name)
    if any(axis not in cube.dims for axis in DIMENSIONS):
        raise InvalidArgumentError("name", name, f"a cube, with axes {', '.join(DIMENSIONS)}")
    wanted = [variable.strip() for variable in params.variables.split(",")]
    for variable in wanted:
        if variable not in cube.data_vars:
            raise InvalidArgumentError("variables", variable, f"one of {', '.join(map(str, cube.data_vars))}")
    part = cube[wanted]
    for axis, (low, high) in ranges.items():
        name, factor, unit = AXES[axis]
        nodes = cube[axis].values * factor
        # nodes in degrees are rounded
        inside = (nodes >= low - 1e-12 * abs(low)) & (nodes <= high + 1e-12 * abs(high))
        if not inside.any():
            end, value = ("max", high) if high < nodes[0] else ("min", low)
            between = f" up to {name}_max, {high:g}{unit}" if nodes[0] <= high < nodes[-1] else ""
            allowed = f"a range with nodes{between}; they span {nodes[0]:g} to {nodes[-1]:g}{unit}"
            raise InvalidArgumentError(f"{name}_{end}", value, allowed)
        part = part.isel({axis: np.flatnonzero(inside)})
    points = math.prod(part.sizes.values())
    if points > service.settings.max_points:
        raise TooLargeError("points", points, f"at most {service.settings.max_points}")
    if form == "nc":
        part = part.drop_vars("pulse").drop_encoding()
        part.attrs = {**part.attrs, "source_sha256": product.sha256}
        return netcdf_response(part, "subset")
    return csv_stream(columns_as_they_are(_columns(part, wanted)), points, "subset")


def _columns(part: xr.Dataset, wanted: list[str]) -> dict[str, NDArray[Any]]:
    """One value for each node, the last axis fastest."""
    axes = np.meshgrid(*(part[axis].values for axis in DIMENSIONS), indexing="ij")
    columns = dict(zip(DIMENSIONS, axes, strict=True))
    columns |= {variable: part[variable].transpose(*DIMENSIONS).values for variable in wanted}
    return {name: values.ravel() for name, values in columns.items()}
