"""Title, pulse, restitution and extent of data sets, for the catalogue, read once per version of a file."""

from __future__ import annotations

import threading
from pathlib import Path

import xarray as xr

from rocking._datasets.catalogue import Catalogue, DatasetFile, VersionCache
from rocking._datasets.cube import DIMENSIONS
from rocking._datasets.netcdf import open_netcdf
from rocking_api.models.responses import DatasetSummary, Link
from rocking_api.zarr_store import SPECTRA


class DatasetSummaries:
    """Summaries of the data sets of a catalogue."""

    def __init__(self, catalogue: Catalogue) -> None:
        self._catalogue = catalogue
        self._lock = threading.Lock()
        self._kept = VersionCache[str, DatasetSummary]()

    def summary(self, name: str) -> DatasetSummary:
        """The summary of a data set."""
        with self._lock:
            known = self._kept.current(name)
            if known is not None:
                return known
            with self._catalogue.open(name) as file:
                product = self._catalogue.product_of(file)
                with self._catalogue.lock:
                    return self._kept.store(name, file.path, file.version, _read(product, file.path))


def _read(product: DatasetFile, path: Path) -> DatasetSummary:
    """The summary from the head and the axes of a file: reading all variables of fifty files takes half a minute."""
    try:
        with open_netcdf(path) as dataset:
            return summarized(product, dataset)
    except (OSError, ValueError, RuntimeError, KeyError):  # whatever the libraries meet in a damaged file
        return summarized(product, xr.Dataset())


def summarized(product: DatasetFile, dataset: xr.Dataset) -> DatasetSummary:
    """What the catalogue tells of one data set; of a damaged file, an empty one, only its version and its name."""
    scalars = {str(name): value for name, value in dataset.coords.items() if value.ndim == 0}
    extent = {}
    for axis in DIMENSIONS:
        if axis in dataset.variables and dataset[axis].dtype.kind == "f" and dataset[axis].notnull().any():
            extent[axis] = float(dataset[axis].min()), float(dataset[axis].max())
    path = f"/v1/datasets/{product.name}"
    hrefs = {
        "self": path,
        "data": f"{path}.nc",
        "version": f"{path}.nc?sha256={product.sha256}",
        "zarr": f"{path}.zarr",
    }
    if product.name.startswith(f"{SPECTRA}/"):
        hrefs["subset"] = f"{path}/subset"
    types = {"self": "application/json", "zarr": "application/vnd+zarr"}
    return DatasetSummary(
        **vars(product),
        title=str(dataset.attrs.get("title", product.name)),
        pulse=scalars["pulse"].attrs.get("pulse_name") if "pulse" in scalars else None,
        restitution=float(scalars["restitution"]) if "restitution" in scalars else None,
        extent=extent,
        metadata=path,
        netcdf=hrefs["data"],
        version_url=hrefs["version"],
        zarr=hrefs["zarr"],
        links=[Link(rel=k, href=href, type=types.get(k, "application/x-netcdf")) for k, href in hrefs.items()],
    )
