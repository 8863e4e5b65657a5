"""Title, pulse, restitution and extent of data sets, for the catalogue, read once per version of a file."""

from __future__ import annotations

import threading
from dataclasses import dataclass
from pathlib import Path

import xarray as xr

from rocking._datasets.catalogue import Catalogue, DatasetFile, VersionCache
from rocking._datasets.cube import DIMENSIONS
from rocking._datasets.netcdf import open_netcdf


@dataclass(frozen=True)
class Summary:
    """What the catalogue tells of one data set; of a damaged file only its product and its name."""

    product: DatasetFile
    title: str
    pulse: str | None
    restitution: float | None
    extent: dict[str, tuple[float, float]]


class DatasetSummaries:
    """Summaries of the data sets of a catalogue."""

    def __init__(self, catalogue: Catalogue) -> None:
        self._catalogue = catalogue
        self._lock = threading.Lock()
        self._kept = VersionCache[str, Summary]()

    def summary(self, name: str) -> Summary:
        """The summary of a data set."""
        with self._lock:
            known = self._kept.current(name)
            if known is not None:
                return known
            with self._catalogue.open(name) as file:
                product = self._catalogue.product_of(file)
                with self._catalogue.lock:
                    return self._kept.store(name, file.path, file.version, _read(product, file.path))


def _read(product: DatasetFile, path: Path) -> Summary:
    """The summary from the head and the axes of a file: reading all variables of fifty files takes half a minute."""
    try:
        with open_netcdf(path) as dataset:
            return _summary(product, dataset)
    except (OSError, ValueError, RuntimeError, KeyError):  # whatever the libraries meet in a damaged file
        return Summary(product, product.name, None, None, {})


def _summary(product: DatasetFile, dataset: xr.Dataset) -> Summary:
    scalars = {str(name): value for name, value in dataset.coords.items() if value.ndim == 0}
    extent = {}
    for axis in DIMENSIONS:
        if axis in dataset.variables and dataset[axis].dtype.kind == "f" and dataset[axis].notnull().any():
            extent[axis] = float(dataset[axis].min()), float(dataset[axis].max())
    return Summary(
        product,
        title=str(dataset.attrs.get("title", product.name)),
        pulse=scalars["pulse"].attrs.get("pulse_name") if "pulse" in scalars else None,
        restitution=float(scalars["restitution"]) if "restitution" in scalars else None,
        extent=extent,
    )
