"""Data sets: catalogue, description, netCDF file, zarr store, a part of a cube."""

from __future__ import annotations

import math
from contextlib import suppress
from functools import partial
from typing import Annotated, Any

import numpy as np
import xarray as xr
from fastapi import APIRouter, Path, Query, Request, Response
from numpy.typing import NDArray
from starlette.exceptions import HTTPException
from starlette.responses import StreamingResponse

from rocking._base.errors import DatasetError, InvalidArgumentError
from rocking._datasets.catalogue import DataFile, DatasetFile, UnknownDatasetError, version_of
from rocking._datasets.cube import DIMENSIONS
from rocking_api.dataset_archive import archive
from rocking_api.dataset_summaries import summarized
from rocking_api.http import encoding
from rocking_api.http.caching import IMMUTABLE, REVALIDATE, not_modified, validators
from rocking_api.http.errors import TooLargeError
from rocking_api.http.files import file_response
from rocking_api.http.parameters import ParamsRoute
from rocking_api.models.params import ListParams, Params
from rocking_api.models.quantity import FileFormat, said
from rocking_api.models.responses import (
    DatasetCatalogue,
    DatasetDescription,
    DatasetSummary,
    PulseCubes,
    VariableDescription,
)
from rocking_api.service import Service, ServiceDep
from rocking_api.zarr_store import SPECTRA, is_metadata

router = APIRouter(prefix="/v1/datasets", tags=["datasets"], route_class=ParamsRoute)

DatasetName = Annotated[
    str, Path(description="name of a data set, see /v1/datasets", examples=["spectra/sine/eta-0.85"])
]
ZarrKey = Annotated[str, Path(description="key of the zarr store", examples=[".zmetadata"])]


class FileParams(Params):
    """Which version of a file."""

    sha256: str | None = said("only this version: 404 once the file has changed", None)


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
    form = encoding.negotiated_form(request, params.format, ("nc", "csv"))
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
        return encoding.netcdf_response(part, "subset")
    return encoding.csv_stream(encoding.columns_as_they_are(_columns(part, wanted)), points, "subset")


def _columns(part: xr.Dataset, wanted: list[str]) -> dict[str, NDArray[Any]]:
    """One value for each node, the last axis fastest."""
    axes = np.meshgrid(*(part[axis].values for axis in DIMENSIONS), indexing="ij")
    columns = dict(zip(DIMENSIONS, axes, strict=True))
    columns |= {variable: part[variable].transpose(*DIMENSIONS).values for variable in wanted}
    return {name: values.ravel() for name, values in columns.items()}


@router.get("", summary="Catalogue", response_model=DatasetCatalogue)
async def get_datasets(params: Annotated[ListParams, Query()], request: Request, service: ServiceDep) -> Response:
    """The data sets in the results folder that can be read."""

    def work() -> tuple[list[DatasetSummary], str | None]:
        found = []
        names, cursor = params.part(service.cubes.catalogue.names())
        for name in names:
            with suppress(UnknownDatasetError, DatasetError):  # removed meanwhile, or damaged: see /health
                found.append(service.summaries.summary(name))
        return found, cursor

    summaries, cursor = await service.run_io(work)
    catalogue = DatasetCatalogue(query=params, datasets=summaries, pulses=_pulses(summaries), next_cursor=cursor)
    return encoding.json_response(catalogue, request, {"Cache-Control": REVALIDATE})


@router.get(
    ".zip",
    summary="All data sets in one archive",
    response_class=Response,
    responses={200: {"content": {"application/zip": {}}}},
)
async def get_archive(request: Request, service: ServiceDep) -> Response:
    """The netCDF files of all data sets that can be read, and their SHA256SUMS."""
    catalogue = service.cubes.catalogue

    def work() -> tuple[list[str], int]:
        names = catalogue.names()
        versions = (version_of(catalogue.results / f"{name}.nc") for name in names)
        return names, max((version.size for version in versions if version is not None), default=0)

    names, largest = await service.run_io(work)
    service.reservation(request).replace(largest)
    headers = {"Content-Disposition": 'attachment; filename="rocking-data.zip"', "Cache-Control": REVALIDATE}
    return StreamingResponse(archive(catalogue, names), media_type="application/zip", headers=headers)


@router.head("/{name:path}.nc", include_in_schema=False)
@router.get(
    "/{name:path}.nc",
    summary="netCDF file",
    response_class=Response,
    responses={
        200: {"content": {"application/x-netcdf": {}}},
        206: {"description": "the requested ranges"},
        304: {"description": "not modified"},
    },
)
async def get_netcdf(
    name: DatasetName, params: Annotated[FileParams, Query()], request: Request, service: ServiceDep
) -> Response:
    """The file as written by the workflow; its ETag is its sha256, and ranges are supported.

    `xarray.open_dataset(URL + "#mode=bytes", engine="netcdf4")` reads only what it needs.
    """
    file, product = await service.run_io(partial(_sound, service, name))
    if params.sha256 is None:
        return file_response(request, file, product)
    if params.sha256 != product.sha256:
        file.close()
        raise HTTPException(404, f"`{name}` has another version now: sha256 {product.sha256}")
    return file_response(request, file, product, IMMUTABLE)


@router.head("/{name:path}.zarr/{key:path}", include_in_schema=False)
@router.get(
    "/{name:path}.zarr/{key:path}",
    summary="zarr store",
    response_class=Response,
    responses={304: {"description": "not modified"}},
)
async def get_zarr(name: DatasetName, key: ZarrKey, request: Request, service: ServiceDep) -> Response:
    """The keys of a zarr store (format 2, consolidated) with the same content.

    `xarray.open_zarr(".../{name}.zarr")` reads it. `spectra/PULSE.zarr` has the cubes of a pulse over the dimension
    `restitution`; those whose axes or variables are not those of most of them are named by its attribute `left_out`.
    """
    sha256, value = await service.run_io(partial(service.zarr_stores.value, name, key))
    if value is None:
        raise HTTPException(404, f"the zarr store of `{name}` has no key `{key}`")
    unchanged = not_modified(request, sha256)
    if unchanged is not None:
        return unchanged
    media_type = "application/json" if is_metadata(key) else "application/octet-stream"
    return Response(value, media_type=media_type, headers=validators(sha256))


@router.get("/{name:path}", summary="Description", response_model=DatasetDescription)
async def get_dataset(name: DatasetName, request: Request, service: ServiceDep) -> Response:
    """Dimensions, variables and attributes of a data set, its size and its sha256."""
    description = await service.run_io(partial(_description, service, name))
    return encoding.json_response(description, request, {"Cache-Control": REVALIDATE})


def _sound(service: Service, name: str) -> tuple[DataFile, DatasetFile]:
    """The open file of a data set."""
    file = service.cubes.catalogue.open(name)
    try:
        product = service.cubes.catalogue.product_of(file)
        problem = service.cubes.problem_of(file)
        if problem is not None:
            raise DatasetError(problem)
    except BaseException:
        file.close()
        raise
    return file, product


def _description(service: Service, name: str) -> DatasetDescription:
    product, dataset = service.cubes.catalogue.dataset(name)
    return DatasetDescription(
        **dict(summarized(product, dataset)),
        dimensions={str(dimension): size for dimension, size in dataset.sizes.items()},
        coordinates={str(key): _variable(dataset[key]) for key in dataset.coords},
        variables={str(key): _variable(dataset[key]) for key in dataset.data_vars},
        attributes=_attributes(dataset.attrs),
    )


def _pulses(summaries: list[DatasetSummary]) -> list[PulseCubes]:
    restitutions: dict[str, list[float]] = {}
    for summary in summaries:
        folder = summary.name.rpartition("/")[0]
        if folder.startswith(f"{SPECTRA}/") and summary.restitution is not None:
            restitutions.setdefault(folder, []).append(summary.restitution)
    return [
        PulseCubes(name=folder, restitution=sorted(values), zarr=f"/v1/datasets/{folder}.zarr")
        for folder, values in restitutions.items()
    ]


def _variable(variable: xr.DataArray) -> VariableDescription:
    return VariableDescription(
        dimensions=[str(dimension) for dimension in variable.dims],
        shape=list(variable.shape),
        dtype=str(variable.dtype),
        attributes=_attributes(variable.attrs),
    )


def _attributes(attributes: dict[Any, Any]) -> dict[str, Any]:
    return {str(k): v.tolist() if isinstance(v, (np.generic, np.ndarray)) else v for k, v in attributes.items()}
