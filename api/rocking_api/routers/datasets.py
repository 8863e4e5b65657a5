"""Data sets: catalogue, description, netCDF and zarr files, a part of a cube."""

from __future__ import annotations

import math
from contextlib import suppress
from typing import Annotated, Any

import numpy as np
import xarray as xr
from fastapi import APIRouter, Depends, HTTPException, Path, Query, Request, Response
from numpy.typing import NDArray

from rocking._base.errors import DatasetError, InvalidArgumentError
from rocking._datasets.catalogue import UnknownDatasetError
from rocking._datasets.cube import DIMENSIONS
from rocking_api.dataset_summaries import summarized
from rocking_api.http import encoding
from rocking_api.http.errors import TooLargeError
from rocking_api.models.answer import Url
from rocking_api.models.params import ListParams, Params
from rocking_api.models.quantity import FileFormat, said
from rocking_api.models.responses import (
    DatasetCatalogue,
    DatasetDescription,
    DatasetSummary,
    PulseStore,
    VariableDescription,
)
from rocking_api.service import Service, ServiceDep

router = APIRouter(prefix="/v1/datasets", tags=["datasets"])

STORES = "zarr"  # folder of the zarr stores below the results folder

DatasetName = Annotated[
    str, Path(description="name of a data set, see /v1/datasets", examples=["spectra/sine/eta-0.85"])
]
StoreName = Annotated[str, Path(description="name of a pulse, see /v1/datasets", examples=["sine"])]
ZarrKey = Annotated[str, Path(description="key of the zarr store", examples=[".zmetadata"])]


VARIABLES = "peak_rotation,outcome,impacts,exceeded_alpha"  # variables that are sent unless others are named

FOUND: dict[int | str, dict[str, Any]] = {
    200: {
        "content": {encoding.MEDIA_TYPES["nc"]: {}, encoding.MEDIA_TYPES["csv"]: {}},
        "description": "the part of the cube",
    }
}


AXES = {
    "alpha": ("alpha_deg", 180.0 / math.pi, " deg"),
    "slenderness": ("slenderness", 1.0, ""),
    "frequency_ratio": ("frequency_ratio", 1.0, ""),
}
"""Of each axis the name of its parameters without `_min` and `_max`, their value per that of the axis, their unit."""


class SubsetParams(Params):
    """Ranges of the axes, both ends included; an absent end is that of the cube."""

    alpha_deg_min: float | None = said("smallest slenderness angle; 0: the slender limit", None, unit="deg")
    alpha_deg_max: float | None = said("largest slenderness angle", None, unit="deg")
    slenderness_min: float | None = said("smallest g tan(alpha)/a_g", None, examples=[0.5], unit="-")
    slenderness_max: float | None = said("largest g tan(alpha)/a_g", None, examples=[0.6], unit="-")
    frequency_ratio_min: float | None = said("smallest omega_g/p", None, examples=[2.0], unit="-")
    frequency_ratio_max: float | None = said("largest omega_g/p", None, examples=[3.0], unit="-")
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
    name: DatasetName, params: Annotated[SubsetParams, Query()], service: ServiceDep, url: Url
) -> Response:
    """Nodes of a cube within ranges of its axes: a netCDF-3 file, or one row of CSV for each node."""
    ranges = params.ranges()
    return await service.read(lambda _: _subset(service, name, params, ranges, url))


def _subset(
    service: Service, name: str, params: SubsetParams, ranges: dict[str, tuple[float, float]], url: str
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
    if params.format != "csv":
        part = part.assign_attrs(source_sha256=product.sha256)
        return encoding.netcdf_response(part, "subset", str(part.attrs["title"]), url)
    return encoding.csv_stream(encoding.columns_as_they_are(_columns(part, wanted)), points, "subset")


def _columns(part: xr.Dataset, wanted: list[str]) -> dict[str, NDArray[Any]]:
    """One value for each node, the last axis fastest."""
    axes = np.meshgrid(*(part[axis].values for axis in DIMENSIONS), indexing="ij")
    columns = dict(zip(DIMENSIONS, axes, strict=True))
    columns |= {variable: part[variable].transpose(*DIMENSIONS).values for variable in wanted}
    return {name: values.ravel() for name, values in columns.items()}


@router.get("", summary="Catalogue")
async def get_datasets(params: Annotated[ListParams, Query()], service: ServiceDep, url: Url) -> DatasetCatalogue:
    """The data sets in the results folder that can be read, and the zarr stores of their cubes."""
    names, cursor = params.part(await service.read(lambda _: service.cubes.catalogue.names()))
    datasets = await service.read(lambda _: _summaries(service, names))
    stores = await service.read(lambda _: sorted((service.settings.results / STORES).glob("*.zarr")))
    pulses = [PulseStore(name=store.stem, zarr=f"/v1/datasets/spectra/{store.name}") for store in stores]
    return DatasetCatalogue(query=params, url=url, datasets=datasets, pulses=pulses, next_cursor=cursor)


def _summaries(service: Service, names: list[str]) -> list[DatasetSummary]:
    summaries = []
    for name in names:
        with suppress(UnknownDatasetError, DatasetError):  # removed meanwhile, or damaged: see /health
            summaries.append(service.summaries.summary(name))
    return summaries


async def only_byte_ranges(request: Request) -> None:
    """Ignore a Range of another unit than bytes (RFC 9110, 14.2), which Starlette would refuse."""
    headers = request.scope["headers"]
    request.scope["headers"] = [
        (name, value) for name, value in headers if name != b"range" or value.lstrip().lower().startswith(b"bytes")
    ]


@router.get(
    "/{name:path}.nc",
    summary="netCDF file",
    response_class=Response,
    responses={200: {"content": {"application/x-netcdf": {}}}, 206: {"description": "the requested ranges"}},
    dependencies=[Depends(only_byte_ranges)],
)
async def get_netcdf(name: DatasetName, request: Request, service: ServiceDep) -> Response:
    """The file as written by the workflow; with ETag and ranges. Its sha256 is in the catalogue.

    `xarray.open_dataset(URL + "#mode=bytes", engine="netcdf4")` reads only what it needs.
    """
    await service.read(lambda _: service.cubes.catalogue.open(name).close())  # names what cannot be read
    return await service.files.get_response(f"{name}.nc", request.scope)


@router.get(
    "/spectra/{pulse}.zarr/{key:path}",
    summary="zarr store",
    response_class=Response,
    dependencies=[Depends(only_byte_ranges)],
)
async def get_zarr(pulse: StoreName, key: ZarrKey, request: Request, service: ServiceDep) -> Response:
    """The files of the zarr store (format 2, consolidated) with the cubes of a pulse over the restitution.

    `xarray.open_zarr(".../spectra/{pulse}.zarr")` reads it.
    """
    if ".." in key.split("/"):  # other files of the results folder
        raise HTTPException(404)
    return await service.files.get_response(f"{STORES}/{pulse}.zarr/{key}", request.scope)


@router.get("/{name:path}", summary="Description")
async def get_dataset(name: DatasetName, service: ServiceDep, url: Url) -> DatasetDescription:
    """Dimensions, variables and attributes of a data set, its size and its sha256."""
    return await service.read(lambda _: _description(service, name, url))


def _description(service: Service, name: str, url: str) -> DatasetDescription:
    product, dataset = service.cubes.catalogue.dataset(name)
    return DatasetDescription(
        url=url,
        **dict(summarized(product.name, product.size, product.sha256, dataset)),
        dimensions={str(dimension): size for dimension, size in dataset.sizes.items()},
        coordinates={str(key): _variable(dataset[key]) for key in dataset.coords},
        variables={str(key): _variable(dataset[key]) for key in dataset.data_vars},
        attributes=_attributes(dataset.attrs),
    )


def _variable(variable: xr.DataArray) -> VariableDescription:
    return VariableDescription(
        dimensions=[str(dimension) for dimension in variable.dims],
        shape=list(variable.shape),
        dtype=str(variable.dtype),
        attributes=_attributes(variable.attrs),
    )


def _attributes(attributes: dict[Any, Any]) -> dict[str, Any]:
    return {str(k): v.tolist() if isinstance(v, (np.generic, np.ndarray)) else v for k, v in attributes.items()}
