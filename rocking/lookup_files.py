"""The files of a results folder: data sets by name, with size and sha256, noticed when the workflow replaces them."""

from __future__ import annotations

import hashlib
import re
import threading
from dataclasses import dataclass
from pathlib import Path

import xarray as xr

from rocking.cube import read_dataset

Stamp = tuple[int, int]
"""Modification time [ns] and size [bytes] of a file: what tells that it was replaced."""

_PART = re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]*")  # of a name: no "..", nothing hidden


class UnknownDatasetError(KeyError):
    """There is no data set of this name."""


@dataclass(frozen=True)
class Product:
    """One data set file: its name (path below the folder, without suffix), size [bytes] and sha256."""

    name: str
    path: Path
    size: int
    sha256: str


class Catalogue:
    """The data sets below a results folder.

    Parameters
    ----------
    results : path
        Folder that the workflow fills; it need not exist yet.
    """

    def __init__(self, results: Path | str) -> None:
        self.results = Path(results)
        self.lock = threading.RLock()
        """To be held while a file is read: the netCDF library is not safe for threads."""
        self._products: dict[str, tuple[Stamp, Product]] = {}

    def names(self) -> list[str]:
        """Names of all data sets, such as `spectra/sine/eta-0.85`, sorted."""
        paths = (path.relative_to(self.results).with_suffix("") for path in self.results.glob("*/**/*.nc"))
        return sorted(path.as_posix() for path in paths if all(_PART.fullmatch(part) for part in path.parts))

    def path(self, name: str) -> Path:
        """The file of a data set.

        Raises
        ------
        UnknownDatasetError
            If there is no data set of that name.
        """
        path = self.results / f"{name}.nc"
        parts = name.split("/")
        if len(parts) < 2 or not all(_PART.fullmatch(part) for part in parts) or not path.is_file():
            raise UnknownDatasetError(name)
        return path

    def product(self, name: str) -> Product:
        """Where a data set lies, how large it is and its sha256, computed once per version of the file.

        Raises
        ------
        UnknownDatasetError
            If there is no data set of that name.
        """
        path = self.path(name)
        with self.lock:
            stamp = stamp_of(path)
            known = self._products.get(name)
            if known is None or known[0] != stamp:
                digest = hashlib.sha256(path.read_bytes()).hexdigest()
                known = self._products[name] = (stamp, Product(name, path, stamp[1], digest))
        return known[1]

    def dataset(self, name: str) -> xr.Dataset:
        """A data set, read into memory and checked.

        Raises
        ------
        UnknownDatasetError
            If there is no data set of that name.
        DatasetError
            If it is damaged.
        """
        with self.lock:
            return read_dataset(self.path(name))


def stamp_of(path: Path) -> Stamp:
    """The stamp of a file."""
    status = path.stat()
    return status.st_mtime_ns, status.st_size
