"""netCDF-4 files, opened by one thread at a time.

The HDF5 library is not safe for threads, and the package netCDF4 releases the interpreter lock while it runs: two
threads that read files at the same time can end the process. The locks of xarray cover neither attributes nor data sets
in memory. This package therefore opens netCDF-4 files with the functions of this module only.
"""

import threading
from collections.abc import Iterator, Mapping
from contextlib import closing, contextmanager
from pathlib import Path
from typing import Any

import netCDF4
import xarray as xr
from xarray.backends import NetCDF4DataStore

_LOCK = threading.RLock()


@contextmanager
def open_netcdf(source: Path | str | bytes, *, cache: bool = True) -> Iterator[xr.Dataset]:
    """Open a data set inside of the `with` block; other threads that call this function wait until it is closed.

    `source` is a path or the content of a file. `cache`: whether xarray keeps the values that are read. Raises whatever
    the libraries raise for a damaged file.
    """
    with _LOCK:
        if isinstance(source, bytes):
            opened: Any = netCDF4.Dataset("in memory", memory=source)
        else:
            opened = netCDF4.Dataset(source)
        with closing(opened):  # closed here and not by the garbage collector, which runs in any thread
            store = NetCDF4DataStore(opened)  # type: ignore[no-untyped-call]
            yield xr.open_dataset(store, decode_times=False, cache=cache)


def write_netcdf(dataset: xr.Dataset, path: Path, encoding: Mapping[str, Mapping[str, Any]]) -> None:
    """Write a file, with xarray's encoding of its variables."""
    with _LOCK:
        dataset.to_netcdf(path, engine="netcdf4", format="NETCDF4", encoding=encoding)
