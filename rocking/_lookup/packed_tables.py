"""The tables of a spectrum cube in a file that processes map into memory read-only, and so share.

The kernel of interpolation needs peaks in float64 and one record for each cell, which take four to five times the size
of a cube in its netCDF file. A file of tables is an array of numpy (`.npy`) of one record with the fields of `_layout`,
followed by the sha256 of all bytes before. It is checked when it is opened, without memory of its own; later only the
pages that are touched are resident, and the system may drop them.
"""

from __future__ import annotations

import hashlib
import os
from pathlib import Path
from typing import IO

import numpy as np
import xarray as xr

from rocking._base.errors import DatasetError, InvalidArgumentError
from rocking._datasets.catalogue import Catalogue, DataFile
from rocking._datasets.checksum import sha256_of
from rocking._datasets.cube import AXES, SAMPLES, decode_spectrum, stored_pulse
from rocking._datasets.shared_cache import SharedCache
from rocking._interpolation.cells import CELL_RECORD, pack_cells
from rocking._interpolation.strips import STRIP_SIZE, strip_count, strips_of
from rocking._lookup.cube_slice import CELL_VARIABLES, CubeSlice, restitution_of, restitutions_of, slice_of

LAYOUT = 2
"""Version of the content of a file of tables; to be increased when `_layout`, `pack_cells` or `CELL_RECORD` change."""

DIGEST_BYTES = hashlib.sha256().digest_size
READ_BYTES = 1_000_000

ROWS = 16
"""Rows of cells of which the records are made together."""


class PackedTables:
    """Files of tables in the cache of a results folder.

    Parameters
    ----------
    cache : SharedCache
        Where they are kept.
    catalogue : Catalogue
        The data sets.
    """

    def __init__(self, cache: SharedCache, catalogue: Catalogue) -> None:
        self._cache = cache
        self._catalogue = catalogue

    def slice_of(self, file: DataFile) -> CubeSlice:
        """A cube over its file of tables, which is made if it is missing or damaged.

        In memory if that fails, and where the pulse is given by samples.

        Raises
        ------
        DatasetError
            If the data set is damaged, cannot be read, or is not a spectrum cube.
        """
        found = self._open(file, self._catalogue.product_of(file).sha256)
        if found is None:
            with self._cache.alone(file.name):
                found = self._open(file, self._catalogue.product_of(file).sha256) or self._make(file)
        return found

    def _path(self, file: DataFile, sha256: str) -> Path:
        return self._cache.folder_of(file.name) / f"{sha256}-{LAYOUT}.npy"

    def _open(self, file: DataFile, sha256: str) -> CubeSlice | None:
        return open_tables(self._path(file, sha256), sha256)

    def _make(self, file: DataFile) -> CubeSlice:
        content = file.content()
        sha256 = sha256_of(content)
        cube = decode_spectrum(content, file.name)
        del content
        try:
            if cube.variables.keys() >= SAMPLES.keys():  # tables have no room for samples
                return slice_of(cube, sha256)
            path = self._path(file, sha256)
            try:
                with self._cache.replacing(path, _layout(cube).itemsize) as output:
                    write_tables(output, cube, sha256)
                self._cache.remove_others(path)
                found = open_tables(path, sha256)
            except OSError:
                found = None
            return slice_of(cube, sha256) if found is None else found
        except InvalidArgumentError as error:
            raise DatasetError(f"{file.name}: {error}; build it again") from error


def write_tables(file: IO[bytes], cube: xr.Dataset, sha256: str) -> None:
    """Write the tables of a spectrum cube, one part at a time.

    Parameters
    ----------
    file : binary file
        Empty, open for writing and reading.
    cube : xarray.Dataset
        A spectrum cube with the schema of `rocking._datasets.cube`.
    sha256 : str
        Digest of its file.
    """
    layout = _layout(cube)
    header = {"descr": np.lib.format.dtype_to_descr(layout), "fortran_order": False, "shape": ()}
    np.lib.format.write_array_header_1_0(file, header)
    for k in range(cube.sizes["alpha"]):
        file.write(strips_of(cube["peak_rotation"].values[k : k + 1]).data)
    for i in range(0, cube.sizes["slenderness"] - 1, ROWS):
        file.write(pack_cells(*(cube[name].values[:, i : i + ROWS + 1] for name in CELL_VARIABLES)).data)
    for name in AXES:
        file.write(np.ascontiguousarray(cube[name].values).data)
    few = {"restitutions": restitutions_of(cube), "restitution": restitution_of(cube)}
    text = {"pulse": stored_pulse(cube), "sha256": sha256}
    for name, value in {**few, **text}.items():
        file.write(np.array(value, layout[name].base).tobytes())
    file.write(_digest(file, file.tell()))


def open_tables(path: Path, sha256: str) -> CubeSlice | None:
    """The cube of a file of tables, mapped into memory; None if it is missing, damaged or of another cube."""
    try:
        with path.open("rb") as file:
            length = os.fstat(file.fileno()).st_size - DIGEST_BYTES
            if _digest(file, length) != file.read():
                return None
            file.seek(0)
            np.lib.format.read_magic(file)
            _, _, layout = np.lib.format.read_array_header_1_0(file)
            tables = np.memmap(file, layout, mode="r", offset=file.tell(), shape=()).view(np.ndarray)
    except (OSError, ValueError):
        return None
    if tables["sha256"] != sha256.encode():
        return None
    return CubeSlice.of(
        {name: np.array(tables[name]) for name in AXES},
        pulse=str(tables["pulse"]),
        restitution=float(tables["restitution"]),
        restitutions=np.array(tables["restitutions"]),
        sha256=sha256,
        peaks=tables["peaks"],
        cells=tables["cells"],
    )


def _layout(cube: xr.Dataset) -> np.dtype[np.void]:
    """Fields of a file of tables; the largest are first, so that they are aligned to the header's 64 bytes."""
    angles, rows, columns = cube["peak_rotation"].shape
    return np.dtype(
        [
            ("peaks", np.float64, (angles, strip_count(columns), rows, STRIP_SIZE)),
            ("cells", CELL_RECORD, (rows - 1, columns - 1, angles)),
            *((name, np.float64, cube[name].shape) for name in AXES),
            ("restitutions", np.float64, restitutions_of(cube).shape),
            ("restitution", np.float64),
            ("pulse", np.str_, 64),
            ("sha256", np.bytes_, 64),
        ]
    )


def _digest(file: IO[bytes], length: int) -> bytes:
    """sha256 of the first bytes of a file; it is then at their end."""
    file.seek(0)
    digest = hashlib.sha256()
    while length > 0 and (part := file.read(min(length, READ_BYTES))):
        digest.update(part)
        length -= len(part)
    return digest.digest()
