"""One spectrum cube in memory, for interpolation; read from a file or an address."""

from __future__ import annotations

import tempfile
import urllib.request
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from weakref import ref

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from rocking._base.errors import DatasetError, InvalidArgumentError
from rocking._datasets.checksum import sha256_of
from rocking._datasets.cube import AXES, decode_spectrum, read_content, stored_pulse
from rocking._excitation.sampled import SampledPulse
from rocking._interpolation.cells import pack_cells
from rocking._interpolation.slices import STENCIL_SIZE
from rocking._interpolation.stencils import Mesh, slice_products
from rocking._interpolation.strips import strips_of
from rocking._interpolation.windows import SLICE_WINDOW, AngleAxis

Array = NDArray[np.float64]

CELL_VARIABLES = ("stencil", "outcome", "impacts", "interpolation_error", "restitution_error", "alpha_error")
"""Variables of a cube from which `pack_cells` makes its records, in order."""


@dataclass(frozen=True, eq=False)
class CubeSlice:
    """The cube of one restitution.

    Attributes
    ----------
    pulse : str or SampledPulse
        Name of the pulse, or the pulse made again from the samples in the file.
    restitution : float
        eta of this cube [-].
    restitutions : float array
        eta of the cubes from which the interval above this one is interpolated [-], ascending.
    alpha, slenderness, frequency_ratio : float arrays
        The axes [rad], [-], [-].
    mesh : Mesh
        The mesh of slenderness and frequency_ratio.
    angles : AngleAxis
        The angles.
    sha256 : str
        Digest of the file, the version of the data.
    peaks : float array (angles, strips, n, STRIP_SIZE)
        The variable `peak_rotation` in strips of columns (`rocking._interpolation.strips`); may be read-only.
    cells : array (n - 1, m - 1, angles) of `CELL_RECORD`
        What is known of each cell; contiguous, may be read-only.
    """

    pulse: str | SampledPulse
    restitution: float
    restitutions: Array
    alpha: Array
    slenderness: Array
    frequency_ratio: Array
    mesh: Mesh
    angles: AngleAxis
    sha256: str
    peaks: Array
    cells: NDArray[np.void]
    _windows: dict[tuple[ref[CubeSlice], ...], np.void] = field(default_factory=dict, init=False, repr=False)

    @classmethod
    def of(cls, axes: Mapping[str, Any], **fields: Any) -> CubeSlice:
        """A slice from its axes by name and the other fields.

        Raises
        ------
        InvalidArgumentError
            If an axis has fewer than four nodes.
        """
        mesh = Mesh.of(axes["slenderness"], axes["frequency_ratio"])
        return cls(**axes, **fields, mesh=mesh, angles=AngleAxis.of(axes["alpha"]))

    def __getstate__(self) -> dict[str, Any]:
        """Without the windows, which hold addresses of this process."""
        return vars(self) | {"_windows": {}}

    @property
    def private_bytes(self) -> int:
        """Memory of the tables that this process does not share with others [bytes]."""
        return sum(array.nbytes for array in (self.peaks, self.cells) if array.flags.writeable)

    def fits(self, other: CubeSlice) -> bool:
        """True if the axes of both are equal."""
        return all(np.array_equal(getattr(self, name), getattr(other, name)) for name in AXES)

    def window(self, *others: CubeSlice) -> np.void:
        """The window of points on this slice, or between it and the next one of up to three others.

        It holds addresses in the slices, which the caller keeps while it uses the window.
        """
        key = tuple(map(ref, others))  # a slice does not keep the others, which files may have replaced
        found = self._windows.get(key)
        if found is None:
            slices = sorted([self, *others], key=lambda one: one.restitution)
            padded = slices + [self] * (STENCIL_SIZE - len(slices))
            restitutions = np.array([one.restitution for one in padded])
            products = slice_products(restitutions[: len(slices)])[0]
            cells, peaks = ([getattr(one, name).ctypes.data for one in padded] for name in ("cells", "peaks"))
            fields = restitutions, products, slices.index(self), len(slices), cells, peaks
            window: np.void = np.array([fields], SLICE_WINDOW)[0]
            for old in [old for old in self._windows if any(one() is None for one in old)]:
                self._windows.pop(old, None)
            found = self._windows[key] = window
        return found


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


def check_slice(content: bytes, path: Path | str) -> tuple[str, float]:
    """Pulse and restitution of the bytes of a file from which `decode_slice` makes a cube.

    Raises
    ------
    DatasetError
        As `decode_slice`.
    """
    cube = decode_spectrum(content, path)
    try:
        Mesh.of(cube["slenderness"].values, cube["frequency_ratio"].values)
        stored_pulse(cube)
    except InvalidArgumentError as error:
        raise DatasetError(f"{path}: {error}; build it again") from error
    return str(cube["pulse"].attrs["pulse_name"]), restitution_of(cube)


def slice_of(cube: xr.Dataset, sha256: str = "") -> CubeSlice:
    """A spectrum cube in memory; `sha256` is the digest of its file, if it has one.

    Raises
    ------
    InvalidArgumentError
        If an axis has fewer than four nodes, or the samples of the pulse are none.
    """
    return CubeSlice.of(
        {name: cube[name].values for name in AXES},
        pulse=stored_pulse(cube),
        restitution=restitution_of(cube),
        restitutions=restitutions_of(cube),
        sha256=sha256,
        peaks=strips_of(cube["peak_rotation"].values),
        cells=pack_cells(*(cube[name].values for name in CELL_VARIABLES)),
    )


def restitution_of(cube: xr.Dataset) -> float:
    """eta of a spectrum cube [-]."""
    return float(cube["restitution"])


def restitutions_of(cube: xr.Dataset) -> Array:
    """eta of the cubes from which the interval above a spectrum cube is interpolated, its own among them [-]."""
    return np.atleast_1d(cube.attrs.get("restitution_slices", restitution_of(cube)))


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
