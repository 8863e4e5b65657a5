"""Data sets as zarr stores, made in memory from the netCDF files on request.

The spectrum cubes of a pulse are also one store, `spectra/PULSE`, over the further dimension `restitution`. It has the
cubes whose axes and variables are those of most cubes of the pulse; its attribute `left_out` names the others, and
those that are damaged. A chunk is one angle of one cube, as in the files, and is read from the file when it is asked
for.
"""

from __future__ import annotations

import json
import math
import threading
from collections import Counter
from collections.abc import Hashable, Iterator
from contextlib import contextmanager, suppress
from functools import lru_cache
from typing import Any, NamedTuple

import xarray as xr

from rocking._base.errors import DatasetError
from rocking._datasets.catalogue import Catalogue, UnknownDatasetError
from rocking._datasets.cube import DIMENSIONS
from rocking._datasets.netcdf import find_damage, open_netcdf, sha256_of

MAX_KEPT = 4  # stores in memory, and variables of cubes; an older one is made again on request
SPECTRA = "spectra"  # folder of the spectrum cubes, which has a folder for each pulse

Contents = dict[str, bytes]


class CubeVersion(NamedTuple):
    """A file of a cube, as it was when it was read."""

    name: str
    sha256: str


class CubeHead(NamedTuple):
    """What a cube is joined by: what it must share with others, its axes, and one angle of its variables."""

    layout: Hashable
    axes: xr.Dataset
    angle: xr.Dataset


class PulseStore(NamedTuple):
    """The cubes of a pulse in the order of their restitutions, their variables, and one store of metadata and axes."""

    cubes: list[CubeVersion]
    variables: list[str]
    contents: Contents


class ZarrStores:
    """Zarr stores of data sets, and of the spectrum cubes of a pulse."""

    def __init__(self, catalogue: Catalogue) -> None:
        self._catalogue = catalogue
        self._lock = threading.Lock()  # each is made once
        self._dataset_store = lru_cache(MAX_KEPT)(self._make_dataset_store)
        self._pulse_store = lru_cache(MAX_KEPT)(self._make_pulse_store)
        self._chunks = lru_cache(MAX_KEPT)(self._make_chunks)

    def value(self, name: str, key: str) -> tuple[str, bytes | None]:
        """The sha256 of what the value of a key is made from, and the value; None if the store has no such key."""
        folder, _, pulse = name.partition("/")
        if folder == SPECTRA and pulse and "/" not in pulse:
            return self._value_of_cubes(name, key)
        version = self._catalogue.product(name).sha256
        with self._lock:
            version, contents = self._dataset_store(name, version)
        return version, contents.get(key)

    def _value_of_cubes(self, name: str, key: str) -> tuple[str, bytes | None]:
        versions = self._versions(name)
        variable, _, chunk = key.rpartition("/")
        index, _, rest = chunk.partition(".")
        with self._lock:
            store = self._pulse_store(name, versions)
            for k, cube in enumerate(store.cubes if variable in store.variables else ()):
                if index == str(k):
                    return cube.sha256, self._chunks(cube, variable).get(f"0.{rest}")
        return sha256_of(repr(versions).encode()), store.contents.get(key)

    def _versions(self, name: str) -> tuple[CubeVersion, ...]:
        """The files in the folder of a pulse that can be read."""
        found = []
        for cube in self._catalogue.names():
            if cube.startswith(f"{name}/"):
                with suppress(UnknownDatasetError, DatasetError):  # removed meanwhile, or see /health
                    found.append(CubeVersion(cube, self._catalogue.product(cube).sha256))
        if not found:
            raise UnknownDatasetError(name)
        return tuple(found)

    def _make_dataset_store(self, name: str, _version: str) -> tuple[str, Contents]:
        product, dataset = self._catalogue.dataset(name)  # which may be newer
        return product.sha256, _contents(dataset)

    def _make_pulse_store(self, name: str, versions: tuple[CubeVersion, ...]) -> PulseStore:
        heads: dict[CubeVersion, CubeHead] = {}
        for cube in versions:
            with suppress(UnknownDatasetError, DatasetError), self._open(cube) as dataset:
                heads[cube] = _head(dataset)
        if not heads:
            raise DatasetError(f"{name}: no cube can be read")
        common = Counter(head.layout for head in heads.values()).most_common(1)[0][0]
        cubes = [cube for cube in heads if heads[cube].layout == common]
        cubes.sort(key=lambda cube: float(heads[cube].axes["restitution"]))
        joined = xr.concat(
            [heads[cube].axes for cube in cubes], "restitution",
            data_vars="minimal", coords="minimal", compat="override", join="override", combine_attrs="drop_conflicts",
        )  # fmt: skip
        about = {"id": name, "title": f"Rocking spectra of the rigid block, {name}, over the restitution"}
        about["left_out"] = " ".join(cube.name for cube in versions if cube not in cubes)
        angle = heads[cubes[0]].angle
        return PulseStore(cubes, [*map(str, angle.data_vars)], _joined_contents(joined.assign_attrs(about), angle))

    def _make_chunks(self, cube: CubeVersion, variable: str) -> Contents:
        """The chunks of a variable of a cube, as those of the first restitution, by the last part of their keys."""
        with self._open(cube) as dataset:
            contents = _contents_by_angle(dataset[[variable]])
        return {key.rpartition("/")[2]: value for key, value in contents.items() if key.startswith(f"{variable}/")}

    @contextmanager
    def _open(self, cube: CubeVersion) -> Iterator[xr.Dataset]:
        """One version of a cube, without reading its variables."""
        with self._catalogue.open(cube.name) as file:
            content = file.content()
        damage = find_damage(content) if sha256_of(content) == cube.sha256 else "replaced while it is read; ask again"
        if damage is not None:
            raise DatasetError(f"{cube.name}: {damage}")
        with open_netcdf(content) as dataset:
            yield dataset


def _head(dataset: xr.Dataset) -> CubeHead:
    solved = [str(name) for name, variable in dataset.data_vars.items() if variable.dims == DIMENSIONS]
    if not solved or "restitution" not in dataset.coords:
        raise DatasetError("not a spectrum cube")
    axes = dataset.drop_vars(solved).load()
    del axes.attrs["content_sha256"]  # of all variables
    types = tuple(sorted((name, str(dataset[name].dtype)) for name in solved))
    layout = types, str(axes.drop_vars("restitution").drop_attrs().to_dict())
    return CubeHead(layout, axes, dataset[solved].isel(alpha=[0]).load())


def _joined_contents(axes: xr.Dataset, angle: xr.Dataset) -> Contents:
    """The store of several cubes without their chunks; `angle` is one angle of the variables of one of them."""
    contents = _contents(axes)
    shape = [axes.sizes[dimension] for dimension in ("restitution", *DIMENSIONS)]
    for key, value in _contents_by_angle(angle).items():
        variable, _, part = key.rpartition("/")
        if variable in angle.data_vars and part == ".zattrs":
            contents[key] = value
        elif variable in angle.data_vars and part == ".zarray":
            contents[key] = json.dumps(json.loads(value) | {"shape": shape}).encode()
    consolidated = json.loads(contents.pop(".zmetadata"))
    consolidated["metadata"] = {key: json.loads(value) for key, value in contents.items() if is_metadata(key)}
    return contents | {".zmetadata": json.dumps(consolidated).encode()}


def _contents_by_angle(solved: xr.Dataset) -> Contents:
    """The store of variables of one cube over a restitution too, a chunk for each angle."""
    sizes = 1, 1, *(solved.sizes[dimension] for dimension in DIMENSIONS[1:])
    return _contents(solved.expand_dims("restitution"), {str(name): {"chunks": sizes} for name in solved.data_vars})


def _contents(dataset: xr.Dataset, encoding: dict[str, Any] | None = None) -> Contents:
    from zarr.storage import MemoryStore  # noqa: PLC0415  # 0.2 s of the start of the service, for one route

    known = {name: value for name, value in dataset.attrs.items() if not _is_nan(value)}  # JSON has no nan
    content: dict[str, Any] = {}  # buffers of zarr
    # the compression of netCDF differs; format 2: every client reads it with consolidated metadata, which format 3
    # does not define yet
    dataset.drop_attrs(deep=False).assign_attrs(known).drop_encoding().to_zarr(
        MemoryStore(content), zarr_format=2, consolidated=True, encoding=encoding
    )
    return {key: value.to_bytes() for key, value in content.items()}


def is_metadata(key: str) -> bool:
    """True if the value of a key of a store is JSON, not a chunk."""
    return key.rpartition("/")[2].startswith(".z")


def _is_nan(value: Any) -> bool:
    return isinstance(value, float) and math.isnan(value)
