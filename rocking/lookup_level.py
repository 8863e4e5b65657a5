"""One spectrum cube in memory, ready to be interpolated; from a file or from the address of one."""

from __future__ import annotations

import hashlib
import tempfile
import urllib.request
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rocking.cube import AXES, read_spectrum
from rocking.errors import DatasetError

ERRORS = ("interpolation_error", "restitution_error", "alpha_error")
"""Measured errors of interpolation."""

FIELDS = ("peak_rotation", "outcome", "impacts", "stencil", *ERRORS)
"""Variables of a cube that interpolation needs."""

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Level:
    """The cube of one restitution; the fields (angles, n, m) as in `cube`.

    Attributes
    ----------
    pulse : str
        Name of the pulse.
    restitution, next_restitution : float
        eta [-] of this cube and of the next one made with it; nan if there is none.
    alpha, slenderness, frequency_ratio : float arrays
        The axes [rad], [-], [-].
    sha256 : str
        Of the file: the version of the data.
    """

    pulse: str
    restitution: float
    next_restitution: float
    alpha: Array
    slenderness: Array
    frequency_ratio: Array
    sha256: str
    peak_rotation: Array
    outcome: NDArray[np.int8]
    impacts: NDArray[np.int32]
    stencil: NDArray[np.int8]
    interpolation_error: NDArray[np.float32]
    restitution_error: NDArray[np.float32]
    alpha_error: NDArray[np.float32]

    def fits(self, other: Level) -> bool:
        """Whether the two stand on the same axes."""
        return all(np.array_equal(getattr(self, name), getattr(other, name)) for name in AXES)


def open_level(path: Path | str) -> Level:
    """Read a spectrum cube into memory.

    Raises
    ------
    DatasetError
        If the file is missing, damaged, or not a spectrum cube.
    """
    cube = read_spectrum(path)
    rows, columns = cube["slenderness"].values, cube["frequency_ratio"].values
    for name, steps in (("slenderness", np.diff(rows)), ("frequency_ratio", np.diff(np.log(columns)))):
        if steps.size < 3 or not np.allclose(steps, steps.mean(), rtol=1e-6, atol=0.0):
            raise DatasetError(f"{path}: axis `{name}` is not evenly spaced over 4 nodes or more; build it again")
    axes: dict[str, Any] = {name: cube[name].values for name in AXES}
    fields: dict[str, Any] = {name: np.ascontiguousarray(cube[name].values) for name in FIELDS}
    for name in ERRORS:
        fields[name] = largest_around(fields[name])
    return Level(
        pulse=str(cube["pulse"].attrs["pulse_name"]),
        restitution=float(cube["restitution"]),
        next_restitution=float(cube.attrs.get("next_restitution", np.nan)),
        sha256=hashlib.sha256(Path(path).read_bytes()).hexdigest(),
        **axes,
        **fields,
    )


def largest_around(errors: NDArray[np.float32]) -> NDArray[np.float32]:
    """The largest of the errors of a cell and the eight around it; nan stays nan, and only there.

    A crease of the peak that only cuts a corner of a cell passes the probes of its neighbours.
    """
    n, m = errors.shape[1:]
    around = np.pad(errors, ((0, 0), (1, 1), (1, 1)), constant_values=np.nan)
    largest = errors.copy()
    for i in range(3):
        for j in range(3):
            np.fmax(largest, around[:, i : i + n, j : j + m], out=largest, where=~np.isnan(errors))
    return largest


def fetch_level(address: str) -> Level:
    """The same from an http or https address.

    Raises
    ------
    DatasetError
        As `open_level`; also if the address does not answer.
    """
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "cube.nc"
        try:
            urllib.request.urlretrieve(address, path)
        except OSError as error:
            raise DatasetError(f"{address}: cannot be fetched, {error}") from error
        return open_level(path)
