"""One spectrum cube for interpolation, from a file or an address."""

from __future__ import annotations

import tempfile
import urllib.request
from collections.abc import Callable, Collection, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property, partial
from pathlib import Path
from threading import Lock

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from rocking._base.errors import DatasetError, InvalidArgumentError
from rocking._datasets.catalogue import FileVersion, version_of
from rocking._datasets.checksum import sha256_of
from rocking._datasets.cube import (
    AXES,
    IMPACTS_BEFORE_REST,
    check_spectrum,
    decode_spectrum,
    open_checked,
    read_content,
    stored_pulse,
)
from rocking._datasets.netcdf import open_netcdf
from rocking._excitation.sampled import SampledPulse
from rocking._interpolation.kernel import NODE, Nodes
from rocking._interpolation.slices import windows_of
from rocking._interpolation.stencils import AngleAxis, Mesh

Array = NDArray[np.float64]

ERRORS_NAME = "restitution-errors"  # of the file with the errors between cubes, in their folder

MAX_LAYER_BYTES = 57_500_000
"""Memory of the nodes of a cube that are kept at a time [bytes]: four angles of the atlas, as one response needs."""


class Layers:
    """The nodes of a cube, read angle by angle when they are first needed.

    Of the ten angles of an atlas, 12 MB each, a response needs one or up to four: memory of the others is not touched.
    `read` gives the nodes (n, m) of an angle by its index, from the version of the file that was checked.
    """

    def __init__(self, shape: tuple[int, ...], read: Callable[[int], Nodes]) -> None:
        self._kept = np.empty(shape, NODE), set(range(shape[0]))  # the nodes, and the angles that are not read
        self._read = read
        self._lock = Lock()

    def __reduce__(self) -> tuple[type[Layers], tuple[tuple[int, ...], Callable[[int], Nodes]]]:
        return Layers, (self._kept[0].shape, self._read)  # a copy reads the nodes anew

    @property
    def nbytes(self) -> int:
        """Memory of all nodes that may be kept [bytes]."""
        return min(self._kept[0].nbytes, MAX_LAYER_BYTES)

    @property
    def complete(self) -> bool:
        """Whether all angles are read."""
        return not self._kept[1]

    def lacks(self, angles: Collection[int]) -> bool:
        """Whether some angles are not read."""
        return not self._kept[1].isdisjoint(angles)

    def at(self, angles: Collection[int]) -> Nodes:
        """The nodes (angles, n, m), read for some angles; nodes of other angles may be undefined.

        Raises `DatasetError` if the file was replaced or removed.
        """
        nodes, missing = self._kept
        if missing.isdisjoint(angles):
            return nodes
        with self._lock:
            nodes, missing = self._kept
            # beyond the limit start anew, with the angles that are wanted now
            many = len(nodes) - len(missing.difference(angles))
            if many * nodes[0].nbytes > MAX_LAYER_BYTES and many > len(angles):  # others keep the former array
                nodes, missing = self._kept = np.empty(nodes.shape, NODE), set(range(len(nodes)))
            for angle in missing.intersection(angles):
                nodes[angle] = self._read(angle)
            missing.difference_update(angles)
            return nodes


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
    layers: Layers  # the variables
    sha256: str  # digest of the file, the version of the data
    content: str = ""  # digest of the values, where the cube has one
    measured: tuple[str, ...] = ()  # the same of the cubes of `restitutions`, where the errors between them are a file

    def fits(self, other: CubeSlice) -> bool:
        """True if the axes of both are equal."""
        return self._axes_bytes == other._axes_bytes

    def was_measured_with(self, other: CubeSlice) -> bool:
        """True if the errors above this restitution were measured with the values of another cube."""
        if not self.measured:
            return True
        place = int(np.searchsorted(self.restitutions, other.restitution))
        return bool(other.content == self.measured[place])

    @cached_property
    def _axes_bytes(self) -> tuple[bytes, ...]:
        """The axes as they are compared in a microsecond."""
        return tuple(axis.tobytes() for axis in self.axes.values())


@dataclass(frozen=True, eq=False)
class RestitutionErrors:
    """The errors of interpolation between the cubes of a pulse, in a file beside them (`ERRORS_NAME`)."""

    restitutions: Array  # eta of the cubes [-], ascending
    digests: tuple[str, ...]  # of the values of the cubes
    axes_bytes: tuple[bytes, ...]  # as `CubeSlice._axes_bytes`
    path: Path
    version: FileVersion | None  # of the file, from which the errors are read

    def window(self, restitution: float, content: str) -> slice:
        """The cubes from which the interval above a cube is interpolated; empty if that cube was not measured."""
        place = int(np.searchsorted(self.restitutions, restitution))
        if not (self.restitutions[place : place + 1] == restitution and self.digests[place] == content):
            return slice(0)
        return slice(*windows_of(self.restitutions.size, place, place + 1))

    def layer(self, restitution: float, angle: int) -> NDArray[np.float32]:
        """The errors (n, m) above a restitution at an angle, read from the file; raises as `Layers.at`."""
        with _reading(self.path.name, self.path, self.version) as dataset:
            errors = dataset["restitution_error"].sel(restitution=restitution).isel(alpha=angle)
            return np.asarray(errors.values)


def open_slice(path: Path | str, errors: RestitutionErrors | None = None) -> CubeSlice:
    """A spectrum cube of a file, which is checked; its variables are read when they are first needed.

    `errors`: between the cubes of the pulse. Raises `DatasetError` if the file is missing, damaged, or not a spectrum
    cube.
    """
    version = version_of(Path(path))
    return decode_slice(read_content(path), path, Path(path), version, errors)


def open_errors(path: Path) -> RestitutionErrors | None:
    """The errors between cubes of a file; None if there is no file. Raises `DatasetError` if it is damaged."""
    version = version_of(path)
    return None if version is None else decode_errors(read_content(path), path, path, version)


def decode_errors(content: bytes, name: Path | str, path: Path, version: FileVersion | None) -> RestitutionErrors:
    """`open_errors` from the bytes of a version of a file; messages have its `name`."""
    with open_checked(content, name) as dataset:
        try:
            axes = tuple(dataset[axis].values.tobytes() for axis in AXES)
            digests = tuple(str(dataset.attrs["cubes_content_sha256"]).split())
            return RestitutionErrors(dataset["restitution"].values, digests, axes, path, version)
        except KeyError as error:
            raise DatasetError(f"{name}: holds no errors between cubes ({error}); build it again") from error


def decode_slice(
    content: bytes, name: Path | str, path: Path, version: FileVersion | None, errors: RestitutionErrors | None = None
) -> CubeSlice:
    """`open_slice` from the bytes of a version of a file; messages have its `name`.

    The digest at the end of the file covers all bytes: the digest of the values is not compared as well.
    """
    with open_checked(content, name) as cube:
        check_spectrum(cube, name)
        try:
            return slice_of(cube, sha256_of(content), partial(_layer_of_file, name, path, version, errors), errors)
        except InvalidArgumentError as error:
            raise DatasetError(f"{name}: {error}; build it again") from error


def _layer_of_file(
    name: Path | str, path: Path, version: FileVersion | None, errors: RestitutionErrors | None, angle: int
) -> Nodes:
    """The nodes (n, m) of an angle, from a version of a file, with the errors between cubes; messages have `name`."""
    with _reading(name, path, version) as cube:
        nodes = _layer(cube, angle)
        restitution = restitution_of(cube)
        measured = errors is not None and errors.window(restitution, cube.attrs["content_sha256"]).stop > 0
    if measured and errors is not None:
        nodes["restitution_error"] = errors.layer(restitution, angle)
    return nodes


@contextmanager
def _reading(name: Path | str, path: Path, version: FileVersion | None) -> Iterator[xr.Dataset]:
    """The data set of a version of a file, open inside of the `with` block."""
    try:
        with open_netcdf(path) as dataset:
            yield dataset
    except (OSError, RuntimeError, ValueError, KeyError) as error:
        raise DatasetError(f"{name}: cannot be read: {_reason(error)}") from error
    if version is None or version_of(path) != version:
        raise DatasetError(f"{name}: was replaced after it was opened; open it again")


def _reason(error: Exception) -> str:
    """What a library says of a file, without its path."""
    return str(error.strerror or "") if isinstance(error, OSError) else str(error)


def check_slice(content: bytes, path: Path | str) -> tuple[str, float]:
    """Pulse and restitution of the bytes of a file from which `decode_slice` makes a cube; raises as it."""
    cube = decode_spectrum(content, path)
    try:
        Mesh.of(cube["slenderness"].values, cube["frequency_ratio"].values)
        stored_pulse(cube)
    except InvalidArgumentError as error:
        raise DatasetError(f"{path}: {error}; build it again") from error
    return str(cube["pulse"].attrs["pulse_name"]), restitution_of(cube)


def slice_of(
    cube: xr.Dataset,
    sha256: str = "",
    read: Callable[[int], Nodes] | None = None,
    errors: RestitutionErrors | None = None,
) -> CubeSlice:
    """A spectrum cube of at least four nodes along each axis; of a file its `sha256`, and `read` as of `Layers`.

    The errors up to the next restitution are in the cube, or `errors` has them.
    """
    restitution = restitution_of(cube)
    content = str(cube.attrs.get("content_sha256", ""))
    restitutions = np.atleast_1d(cube.attrs.get("restitution_slices", restitution))
    measured: tuple[str, ...] = ()
    if errors is not None and errors.axes_bytes == tuple(cube[name].values.tobytes() for name in AXES):
        window = errors.window(restitution, content)
        if window.stop:
            restitutions = errors.restitutions[window]
            measured = tuple(errors.digests[window])
    axes = {name: cube[name].values for name in AXES}
    layers = Layers(cube["peak_rotation"].shape, read or partial(_layer, cube))
    if read is None:
        layers.at(range(cube.sizes["alpha"]))
    return CubeSlice(
        pulse=stored_pulse(cube),
        restitution=restitution,
        restitutions=restitutions,
        axes=axes,
        mesh=Mesh.of(axes["slenderness"], axes["frequency_ratio"]),
        angles=AngleAxis.of(axes["alpha"]),
        layers=layers,
        sha256=sha256,
        content=content,
        measured=measured,
    )


def _layer(cube: xr.Dataset, angle: int) -> Nodes:
    """The nodes (n, m) of an angle of a cube."""
    cube = cube.isel(alpha=[angle])
    nodes = np.empty(cube["peak_rotation"].shape, NODE)
    nodes["restitution_error"] = np.nan  # of a cube alone
    for name in [name for name in NODE.names or () if name in cube]:
        nodes[name] = cube[name].values
    nodes["counted"] = counted_cells(cube)
    found: Nodes = nodes[0]
    return found


def counted_cells(cube: xr.Dataset) -> NDArray[np.bool_]:
    """Cells, by their lower nodes, in which every block has certainly as many impacts as the node.

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
    numbers = np.where((impacts <= most) | (mode >> 1 == impacts), impacts, -1)  # -1: not certain
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
        found = open_slice(path)
        found.layers.at(range(found.angles.angles.size))
        return found
