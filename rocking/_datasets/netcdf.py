"""netCDF-4 files, opened by one thread at a time.

The HDF5 library is not safe for threads, and the package netCDF4 releases the interpreter lock while it runs: two
threads that read files at the same time can end the process. The locks of xarray cover neither attributes nor data sets
in memory. This package therefore opens netCDF-4 files with the functions of this module only.

A file ends with a sha256 digest, so that damage is found before a library fails or hangs on it. netCDF readers ignore
bytes beyond the end of file that the format itself states.
"""

import hashlib
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
    """A data set, open inside of the `with` block; other threads that call this function wait until it is closed.

    `source` is a path or the content of a file. `cache`: whether xarray keeps the values that are read. Raises whatever
    the libraries raise for a damaged file.
    """
    with _LOCK:
        opened: Any = (  # closed here and not by the garbage collector, which runs in any thread
            netCDF4.Dataset("in memory", memory=source) if isinstance(source, bytes) else netCDF4.Dataset(source)
        )
        with closing(opened):
            store = NetCDF4DataStore(opened)  # type: ignore[no-untyped-call]
            yield xr.open_dataset(store, decode_times=False, cache=cache)


def write_netcdf(dataset: xr.Dataset, path: Path, encoding: Mapping[str, Mapping[str, Any]]) -> None:
    """Write a file, with xarray's encoding of its variables."""
    with _LOCK:
        dataset.to_netcdf(path, engine="netcdf4", format="NETCDF4", encoding=encoding)


def sha256_of(content: bytes) -> str:
    """sha256 (hex) of bytes, the version of a data set whose file holds them."""
    return hashlib.sha256(content).hexdigest()


def sha256_of_file(path: Path) -> str:
    """The same for a file, which may be larger than the memory."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


_MARK = b"\nsha256 "
_LENGTH = len(_MARK) + 64 + 1


def append_checksum(path: Path) -> None:
    """Append the sha256 digest of the content of a file."""
    with path.open("ab") as file:
        file.write(_MARK + sha256_of_file(path).encode() + b"\n")


def find_damage(content: bytes) -> str | None:
    """Description of the damage of a file with a digest at its end, a missing or wrong digest; None if it is intact."""
    body, end = content[:-_LENGTH], content[-_LENGTH:]
    if not end.startswith(_MARK):
        return "damaged, or not written by this package: no digest at its end"
    if end != _MARK + sha256_of(body).encode() + b"\n":
        return "damaged, its bytes do not match its own digest"
    return None
