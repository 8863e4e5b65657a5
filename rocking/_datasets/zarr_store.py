"""The spectrum cubes of a pulse as one zarr store, for lazy access over HTTP or from object storage.

The store has the further dimension `restitution`. It is written in zarr format 2 with consolidated metadata, which
every client reads; format 3 does not define consolidated metadata yet. A chunk holds one angle of one cube. The store
contains no time, and its compression has one thread, so equal cubes give equal bytes.
"""

from __future__ import annotations

import math
import shutil
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import xarray as xr

from rocking._base.errors import DatasetError, InvalidArgumentError
from rocking._datasets.cube import DIMENSIONS, read_spectrum
from rocking._datasets.netcdf import open_netcdf

STORE_DIMENSIONS = ("restitution", *DIMENSIONS)  # dimensions of the variables of a store, in order

COMPRESSION_LEVEL = 5  # of Zstandard


def write_pulse_store(cubes: Sequence[Path | str], store: Path | str) -> None:
    """Write the spectrum cubes of a pulse as one zarr store; equal cubes give equal bytes.

    One cube is in memory at a time. The store is written beside its place and renamed, an existing one is replaced,
    and parent folders are created.

    Parameters
    ----------
    cubes : sequence of Path or str
        The files of the cubes, one for each restitution, in any order; at least one.
    store : Path or str
        The folder to write, such as `results/zarr/sine.zarr`.

    Raises
    ------
    InvalidArgumentError
        If there is no cube.
    DatasetError
        If a cube is damaged, or differs from the others in its pulse, its axes or its variables.
    """
    if not cubes:
        raise InvalidArgumentError("cubes", "none", "at least one spectrum cube")
    store = Path(store)
    temporary = store.with_name(f".{store.name}.partial")
    store.parent.mkdir(parents=True, exist_ok=True)
    shutil.rmtree(temporary, ignore_errors=True)
    try:
        _write([Path(path) for path in cubes], temporary)
        shutil.rmtree(store, ignore_errors=True)
        temporary.rename(store)
    finally:
        shutil.rmtree(temporary, ignore_errors=True)


def _write(paths: list[Path], folder: Path) -> None:
    import zarr  # noqa: PLC0415  # takes 0.2 s, and only who writes a store has it

    heads = {path: _head(path) for path in paths}
    paths = sorted(paths, key=lambda path: float(heads[path]["restitution"]))
    attributes = _common_attributes([heads[path] for path in paths])
    for path in paths:
        if not heads[path].drop_vars("restitution").equals(heads[paths[0]].drop_vars("restitution")):
            raise DatasetError(
                f"{path}: its pulse, axes or variables differ from those of {paths[0]}; build both again"
            )
        cube = read_spectrum(path).drop_encoding().expand_dims("restitution")
        cube.attrs = attributes
        if path == paths[0]:
            cube.to_zarr(folder, mode="w-", zarr_format=2, consolidated=False, encoding=_encoding(cube))
        else:
            cube.to_zarr(folder, append_dim="restitution", zarr_format=2, consolidated=False)
    zarr.consolidate_metadata(str(folder), zarr_format=2)


def _head(path: Path) -> xr.Dataset:
    """Read the axes of a cube, its attributes, and the type of each variable, without values."""
    with open_netcdf(path) as cube:
        axes = cube.coords.to_dataset().load()
        types = {f"type of {name}": str(variable.dtype) for name, variable in cube.data_vars.items()}
        return axes.assign(types).assign_attrs(cube.attrs)


def _common_attributes(heads: list[xr.Dataset]) -> dict[str, Any]:
    """Return the global attributes in which all cubes agree, with a title of the store."""
    first = heads[0].attrs
    common = dict(first)
    for head in heads:
        common = {name: value for name, value in common.items() if _agree(value, head.attrs.get(name))}
    pulse = str(heads[0]["pulse"].attrs["pulse_name"])
    title = f"Rocking spectra of the rigid block under the {pulse} pulse, over the restitution"
    return common | {"id": f"zarr/{pulse}", "title": title}


def _agree(value: Any, other: Any) -> bool:
    """True for equal attributes that JSON can hold, which has no nan."""
    is_nan = isinstance(value, float) and math.isnan(value)
    return not is_nan and bool(value == other)


def _encoding(cube: xr.Dataset) -> dict[str, dict[str, Any]]:
    """Return the encoding with a chunk for each angle of each restitution."""
    import numcodecs  # noqa: PLC0415  # as zarr, above

    sizes = (1, 1, cube.sizes[DIMENSIONS[1]], cube.sizes[DIMENSIONS[2]])
    compressor = numcodecs.Zstd(level=COMPRESSION_LEVEL)
    names = [str(name) for name, variable in cube.data_vars.items() if variable.dims == STORE_DIMENSIONS]
    return {name: {"chunks": sizes, "compressors": compressor} for name in names}
