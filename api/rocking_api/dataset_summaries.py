"""Title, pulse, restitution and extent of data sets, for the catalogue, read once per version of a file."""

from __future__ import annotations

import threading
from pathlib import Path

import xarray as xr

from rocking._datasets.catalogue import Catalogue, VersionCache
from rocking._datasets.cube import DIMENSIONS
from rocking._datasets.netcdf import open_netcdf
from rocking_api.models.responses import DatasetSummary, Extent, Link


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
                sha256 = self._catalogue.known_digest(file)
                summary = _read(name, file.version.size, sha256, file.path)
                return summary if sha256 is None else self._kept.store(name, file.path, file.version, summary)


def _read(name: str, size: int, sha256: str | None, path: Path) -> DatasetSummary:
    """The summary from the head and the axes of a file: reading all variables of fifty files takes half a minute."""
    try:
        with open_netcdf(path) as dataset:
            return summarized(name, size, sha256, dataset)
    except (OSError, ValueError, RuntimeError, KeyError):  # whatever the libraries meet in a damaged file
        return summarized(name, size, sha256, xr.Dataset())


def summarized(name: str, size: int, sha256: str | None, dataset: xr.Dataset) -> DatasetSummary:
    """What the catalogue tells of one data set; of a damaged file, an empty one, only its version and its name."""
    scalars = {str(name): value for name, value in dataset.coords.items() if value.ndim == 0}
    extent = {}
    for axis in DIMENSIONS:
        if axis in dataset.variables and dataset[axis].dtype.kind == "f" and dataset[axis].notnull().any():
            extent[axis] = float(dataset[axis].min()), float(dataset[axis].max())
    path = f"/v1/datasets/{name}"
    hrefs = {"self": path, "data": f"{path}.nc"}
    if name.startswith("spectra/"):
        hrefs["subset"] = f"{path}/subset"
    links = [
        Link(rel=relation, href=href, type="application/json" if relation == "self" else "application/x-netcdf")
        for relation, href in hrefs.items()
    ]
    return DatasetSummary(
        name=name,
        size=size,
        sha256=sha256,
        title=str(dataset.attrs.get("title", name)),
        pulse=scalars["pulse"].attrs.get("pulse_name") if "pulse" in scalars else None,
        restitution=float(scalars["restitution"]) if "restitution" in scalars else None,
        extent=Extent(**extent),
        metadata=path,
        netcdf=hrefs["data"],
        links=links,
    )
