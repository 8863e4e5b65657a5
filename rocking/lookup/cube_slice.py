"""One spectrum cube in memory, for interpolation; read from a file or an address."""

from __future__ import annotations

import tempfile
import urllib.request
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from rocking._numba.compilation import contiguous_array
from rocking.datasets.checksum import sha256_of
from rocking.datasets.cube import AXES, decode_spectrum, read_content
from rocking.errors import DatasetError, InvalidArgumentError
from rocking.interpolation.kernel import SliceArrays
from rocking.interpolation.stencils import Mesh

Array = NDArray[np.float64]


@dataclass(frozen=True)
class CubeSlice:
    """The cube of one restitution; fields (angles, n, m) as in `rocking.datasets.cube`.

    Attributes
    ----------
    pulse : str
        Name of the pulse.
    restitution : float
        eta of this cube [-].
    restitutions : float array
        eta of all cubes computed with this one [-], ascending.
    alpha, slenderness, frequency_ratio : float arrays
        The axes [rad], [-], [-].
    mesh : Mesh
        The mesh of slenderness and frequency_ratio.
    sha256 : str
        Digest of the file, the version of the data.
    """

    pulse: str
    restitution: float
    restitutions: Array
    alpha: Array
    slenderness: Array
    frequency_ratio: Array
    mesh: Mesh
    sha256: str
    peak_rotation: Array
    outcome: NDArray[np.int8]
    impacts: NDArray[np.int32]
    stencil: NDArray[np.int8]
    interpolation_error: NDArray[np.float32]
    restitution_error: NDArray[np.float32]
    alpha_error: NDArray[np.float32]

    def fits(self, other: CubeSlice) -> bool:
        """True if the axes of both are equal."""
        return all(np.array_equal(getattr(self, name), getattr(other, name)) for name in AXES)


def open_slice(path: Path | str) -> CubeSlice:
    """Read a spectrum cube into memory.

    Raises
    ------
    DatasetError
        If the file is missing, damaged, or not a spectrum cube.
    """
    return decode_slice(read_content(path), path)


def decode_slice(content: bytes, path: Path | str) -> CubeSlice:
    """The same from the bytes of a file; messages name `path`.

    Raises
    ------
    DatasetError
        If the bytes are damaged or not those of a spectrum cube.
    """
    cube = decode_spectrum(content, path)
    try:
        return slice_of(cube, sha256_of(content))
    except InvalidArgumentError as error:
        raise DatasetError(f"{path}: {error}; build it again") from error


def slice_of(cube: xr.Dataset, sha256: str = "") -> CubeSlice:
    """A spectrum cube in memory; `sha256` is the digest of its file, if it has one.

    Raises
    ------
    InvalidArgumentError
        If an axis has fewer than four nodes.
    """
    axes: dict[str, Any] = {name: cube[name].values for name in AXES}
    fields: dict[str, Any] = {name: contiguous_array(cube[name].values) for name in SliceArrays._fields}
    return CubeSlice(
        pulse=str(cube["pulse"].attrs["pulse_name"]),
        restitution=float(cube["restitution"]),
        restitutions=np.atleast_1d(cube.attrs.get("restitution_slices", float(cube["restitution"]))),
        mesh=Mesh.of(axes["slenderness"], axes["frequency_ratio"]),
        sha256=sha256,
        **axes,
        **fields,
    )


def fetch_slice(address: str) -> CubeSlice:
    """The same from an http or https address.

    Raises
    ------
    DatasetError
        As `open_slice`; also if the address cannot be fetched.
    """
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "cube.nc"
        try:
            urllib.request.urlretrieve(address, path)
        except OSError as error:
            raise DatasetError(f"{address}: cannot be fetched, {error}") from error
        return open_slice(path)
