"""Data sets as zarr stores, made in memory from the netCDF files on request."""

from __future__ import annotations

import math
import threading
from functools import lru_cache
from typing import Any

import xarray as xr
from zarr.storage import MemoryStore

from rocking._datasets.catalogue import Catalogue

MAX_KEPT = 4
"""Stores in memory; an older one is made again on request."""


class ZarrStores:
    """Zarr stores of data sets.

    Parameters
    ----------
    catalogue : Catalogue
        Source of the data sets.
    """

    def __init__(self, catalogue: Catalogue) -> None:
        self._catalogue = catalogue
        self._lock = threading.Lock()
        self._kept = lru_cache(MAX_KEPT)(self._made)

    def store(self, name: str) -> tuple[str, dict[str, bytes]]:
        """The sha256 of the netCDF file and the contents of its zarr store.

        Raises
        ------
        UnknownDatasetError
            If there is no data set of that name.
        DatasetError
            If it is damaged, or cannot be read.
        """
        version = self._catalogue.product(name).sha256
        with self._lock:  # each is made once
            return self._kept(name, version)

    def _made(self, name: str, _version: str) -> tuple[str, dict[str, bytes]]:
        product, dataset = self._catalogue.dataset(name)  # which may be newer
        return product.sha256, _contents(dataset)


def _contents(dataset: xr.Dataset) -> dict[str, bytes]:
    known = {name: value for name, value in dataset.attrs.items() if not _is_nan(value)}  # JSON has no nan
    content: dict[str, Any] = {}  # buffers of zarr
    # the compression of netCDF differs; format 2: every client reads it with consolidated metadata, which format 3
    # does not define yet
    dataset.drop_attrs(deep=False).assign_attrs(known).drop_encoding().to_zarr(
        MemoryStore(content), zarr_format=2, consolidated=True
    )
    return {key: value.to_bytes() for key, value in content.items()}


def _is_nan(value: Any) -> bool:
    return isinstance(value, float) and math.isnan(value)
