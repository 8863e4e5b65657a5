"""One spectrum cube in memory, for interpolation; read from a file or an address."""

from __future__ import annotations

import tempfile
import urllib.request
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from rocking._base.errors import DatasetError, InvalidArgumentError
from rocking._datasets.checksum import sha256_of
from rocking._datasets.cube import AXES, IMPACTS_BEFORE_REST, decode_spectrum, read_content, stored_pulse
from rocking._excitation.sampled import SampledPulse
from rocking._interpolation.kernel import NODE, Nodes
from rocking._interpolation.stencils import AngleAxis, Mesh

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class CubeSlice:
    """The cube of one restitution."""

    pulse: str | SampledPulse  # name of the pulse, or the pulse made again from the samples in the file
    restitution: float  # eta of this cube [-]
    restitutions: Array  # eta of the cubes from which the interval above this one is interpolated [-], ascending
    axes: Mapping[str, Array]  # alpha [rad], slenderness [-] and frequency_ratio [-]
    # mesh, angles: the same for the kernel
    mesh: Mesh
    angles: AngleAxis
    nodes: Nodes  # (angles, n, m) the variables
    sha256: str  # digest of the file, the version of the data

    def fits(self, other: CubeSlice) -> bool:
        """True if the axes of both are equal."""
        return self._axes_bytes == other._axes_bytes

    @cached_property
    def _axes_bytes(self) -> tuple[bytes, ...]:
        """The axes as they are compared in a microsecond."""
        return tuple(axis.tobytes() for axis in self.axes.values())


def open_slice(path: Path | str) -> CubeSlice:
    """Read a spectrum cube into memory. Raises `DatasetError` if it is missing, damaged, or not a spectrum cube."""
    return decode_slice(read_content(path), path)


def decode_slice(content: bytes, path: Path | str) -> CubeSlice:
    """`open_slice` from the bytes of a file; messages name `path`."""
    cube = decode_spectrum(content, path)
    try:
        return slice_of(cube, sha256_of(content))
    except InvalidArgumentError as error:
        raise DatasetError(f"{path}: {error}; build it again") from error


def check_slice(content: bytes, path: Path | str) -> tuple[str, float]:
    """Pulse and restitution of the bytes of a file from which `decode_slice` makes a cube; raises as it."""
    cube = decode_spectrum(content, path)
    try:
        Mesh.of(cube["slenderness"].values, cube["frequency_ratio"].values)
        stored_pulse(cube)
    except InvalidArgumentError as error:
        raise DatasetError(f"{path}: {error}; build it again") from error
    return str(cube["pulse"].attrs["pulse_name"]), restitution_of(cube)


def slice_of(cube: xr.Dataset, sha256: str = "") -> CubeSlice:
    """A spectrum cube in memory, of at least four nodes along each axis; `sha256` is the digest of its file, if it has
    one.
    """
    restitution = restitution_of(cube)
    axes = {name: cube[name].values for name in AXES}
    nodes = np.empty(cube["peak_rotation"].shape, NODE)
    for name in [name for name in NODE.names or () if name in cube]:
        nodes[name] = cube[name].values
    nodes["counted"] = counted_cells(cube)
    return CubeSlice(
        pulse=stored_pulse(cube),
        restitution=restitution,
        restitutions=np.atleast_1d(cube.attrs.get("restitution_slices", restitution)),
        axes=axes,
        mesh=Mesh.of(axes["slenderness"], axes["frequency_ratio"]),
        angles=AngleAxis.of(axes["alpha"]),
        nodes=nodes,
        sha256=sha256,
    )


def counted_cells(cube: xr.Dataset) -> NDArray[np.bool_]:
    """Cells, by their lower nodes, in which the number of impacts is certain to be that of the node.

    All 4 x 8 nodes around the cell have this number: four are not enough, as bands of another number, which lie along
    the columns, may end in the cell. And it is certain that the impacts of none of them accumulate to rest while the
    pulse acts. Where they do, the number of those before depends on details, and changes from one block to the next and
    back in bands that are narrower than a cell. They do not

    - without an impact;
    - if the peak is reached on the last arc, as its mode says: each impact is before it, and none follows a rest;
    - after at most half as many as nodes of the cube have before they come to rest.
    """
    from scipy.ndimage import maximum_filter1d, minimum_filter1d  # noqa: PLC0415  (not needed to import the package)

    impacts, mode = cube["impacts"].values, cube["peak_mode"].values
    most = int(cube.attrs.get(IMPACTS_BEFORE_REST, 0)) // 2
    numbers = np.where((impacts <= most) | (mode >> 1 == impacts), impacts, -1)
    least = largest = numbers
    for axis, size in ((1, 4), (2, 8)):  # one node more above than below
        least = minimum_filter1d(least, size, axis, mode="nearest", origin=-1)
        largest = maximum_filter1d(largest, size, axis, mode="nearest", origin=-1)
    return np.asarray((least == largest) & (least >= 0))


def restitution_of(cube: xr.Dataset) -> float:
    """eta of a spectrum cube [-]."""
    return float(cube["restitution"])


def fetch_slice(address: str) -> CubeSlice:
    """`open_slice` from an http or https address."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "cube.nc"
        try:
            urllib.request.urlretrieve(address, path)
        except OSError as error:
            raise DatasetError(f"{address}: cannot be fetched, {error}") from error
        return open_slice(path)
