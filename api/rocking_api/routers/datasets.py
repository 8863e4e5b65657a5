"""Data sets: catalogue, description, netCDF file, zarr store."""

from __future__ import annotations

from contextlib import suppress
from functools import partial
from typing import Annotated, Any

import numpy as np
import xarray as xr
from fastapi import APIRouter, Path, Query, Request, Response
from starlette.exceptions import HTTPException
from starlette.responses import StreamingResponse

from rocking._base.errors import DatasetError
from rocking._datasets.catalogue import DataFile, DatasetFile, UnknownDatasetError, version_of
from rocking_api.dataset_archive import archive
from rocking_api.dataset_summaries import summarized
from rocking_api.http.caching import IMMUTABLE, REVALIDATE, not_modified, validators
from rocking_api.http.encoding import json_response
from rocking_api.http.files import file_response
from rocking_api.http.parameters import ParamsRoute
from rocking_api.models.params import ListParams, Params
from rocking_api.models.quantity import said
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
    return json_response(catalogue, request, {"Cache-Control": REVALIDATE})


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
    return json_response(description, request, {"Cache-Control": REVALIDATE})


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
