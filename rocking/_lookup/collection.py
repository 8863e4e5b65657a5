"""All spectrum cubes of a results folder; each is read when first needed.

A missing, damaged or unreadable cube never gives a wrong result: the solver computes it instead, and
`CubeCollection.problems` reports the file. Files that change are read again.
"""

from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from rocking._base.errors import DatasetError, number, one_of
from rocking._datasets.catalogue import Catalogue, DataFile, FileVersion, UnknownDatasetError, VersionCache, version_of
from rocking._datasets.cube import decode_dataset
from rocking._excitation.pulses import AbstractPulse, as_pulse
from rocking._lookup.cube import METHODS, Cube, Points, UnreadError
from rocking._lookup.cube_slice import (
    ERRORS_NAME,
    CubeSlice,
    RestitutionErrors,
    check_slice,
    decode_errors,
    decode_slice,
)
from rocking._numba.cancellation import StopFlag
from rocking._solver.bounded_response import BoundedResponse

MAX_BYTES = 230_000_000
"""Memory of the cubes that a collection keeps [bytes]: all of one pulse of `paper.yaml`. Those that were not used for
longest are read again when needed."""

NO_CUBES = "no spectrum cubes; `make reproduce` builds them"
"""What `CubeCollection.problems` reports where nothing is damaged, but there are no cubes."""


class CubeCollection:
    """The spectrum cubes below a results folder, which the workflow fills; `catalogue` has all its files."""

    def __init__(self, results: Path | str) -> None:
        self.catalogue = Catalogue(results)
        self._slices = VersionCache[tuple[str, float, FileVersion | None], CubeSlice | DatasetError]()
        self._errors = VersionCache[str, RestitutionErrors | DatasetError]()
        self._restitutions = VersionCache[str, list[float]]()
        self._problems = VersionCache[str, str | None]()

    def restitutions(self, pulse: str) -> list[float]:
        """Restitutions for which the folder has a cube of the pulse, ascending."""
        key = pulse.removeprefix("-")
        known = self._restitutions.current(key)
        if known is not None:
            return known
        folder = self.catalogue.results / "spectra" / key
        version = version_of(folder)
        if version is None:
            return []
        found = sorted(_restitution_of(path.stem) for path in folder.glob("eta-?.??.nc"))
        if version.is_settled:
            self._restitutions.store(key, folder, version, found)
        return found

    def slice_at(self, pulse: str, restitution: float, may_read: bool = True) -> CubeSlice | None:
        """The cube of a pulse and a restitution, None if there is none; without `may_read` it is not read.

        A mirrored pulse has the same peaks and outcomes, hence the same cube. Raises `DatasetError` if the file is
        damaged, cannot be read, or does not contain the cube that its name states; `UnreadError` if it has to be read.
        """
        name = pulse.removeprefix("-")
        errors = self._errors_of(name, may_read)
        key = name, restitution, None if errors is None else errors.version
        known = self._slices.current(key)
        if known is None:
            if not may_read:
                raise UnreadError
            try:
                # under the lock: another thread may read the same file, which is then read once
                with self.catalogue.open(_cube_name(name, restitution)) as file, self.catalogue.lock:
                    known = self._slices.value(key, file, lambda file: self._open(file, name, restitution, errors))
                    self._limit_memory(key)
            except UnknownDatasetError:
                return None
        if isinstance(known, DatasetError):
            raise known
        return known

    def _errors_of(self, pulse: str, may_read: bool) -> RestitutionErrors | None:
        """The errors between the cubes of a pulse; None if their file is missing or damaged."""
        known = self._errors.current(pulse)
        name = f"spectra/{pulse}/{ERRORS_NAME}"
        if known is None:
            if version_of(self.catalogue.results / f"{name}.nc") is None:
                return None
            if not may_read:
                raise UnreadError
            try:
                with self.catalogue.open(name) as file, self.catalogue.lock:
                    known = self._errors.value(pulse, file, _decoded_errors)
            except DatasetError:  # deleted in the meantime, or not readable; `problems` says so
                return None
        return None if isinstance(known, DatasetError) else known

    def cube(self, pulse: str | AbstractPulse, method: str = "auto", may_read: bool = True) -> Cube:
        """The cubes of a pulse; each is read when first needed.

        A damaged cube then raises `DatasetError` with `method="cube"`; otherwise it is treated as missing and reported
        by `problems`. Without `may_read` a response raises `UnreadError` where a file would have to be read.
        """
        if not isinstance(pulse, str):
            return Cube(pulse, np.empty(0), lambda _: None)
        restitutions = np.array(self.restitutions(pulse))

        @cache  # one response uses one version of each file
        def slice_at(k: int) -> CubeSlice | None:
            try:
                return self.slice_at(pulse, float(restitutions[k]), may_read)
            except DatasetError:
                if method == "cube":
                    raise
                return None

        return Cube(pulse, restitutions, slice_at, may_read)

    def problems(self) -> dict[str, str]:
        """Read and check every data set once per version of its file; descriptions of the problems by name.

        The name "spectra" is used if there are no cubes at all. Folders that cannot be read are listed by their names.
        """
        names, found = self.catalogue.scan()
        if not any(name.startswith("spectra/") for name in names):
            found.setdefault("spectra", NO_CUBES)
        for name in names:
            try:
                problem = self.problem(name)
            except UnknownDatasetError:  # deleted in the meantime
                continue
            if problem is not None:
                found[name] = problem
        return found

    def response(
        self,
        pulse: str | AbstractPulse,
        *,
        slenderness: ArrayLike,
        frequency_ratio: ArrayLike,
        restitution: ArrayLike,
        alpha: ArrayLike | None = None,
        absolute_tolerance: float = 1e-4,
        method: str = "auto",
        threads: int | None = None,
        stop: StopFlag | None = None,
    ) -> tuple[BoundedResponse, tuple[str, ...]]:
        """Responses as `Cube.response`, from all cubes of a pulse, and the sha256 of each cube that was used.

        Parameters
        ----------
        pulse : str or AbstractPulse
            The pulse, by its name if cubes are to be used.
        slenderness, frequency_ratio, restitution, alpha, absolute_tolerance, method, threads, stop
            As for `Cube.response`; the method "auto" also uses the solver where a cube is missing or damaged.

        Raises
        ------
        InvalidArgumentError, OutsideCubeError
            As for `Cube.response`.
        DatasetError
            With `method="cube"`, for a damaged cube.
        """
        as_pulse(pulse)
        one_of("method", method, METHODS)
        limit = number("absolute_tolerance", absolute_tolerance, 0.0, np.inf, closed="left")
        points, shape = Points.of(slenderness, frequency_ratio, restitution, alpha)
        result, used = self.cube(pulse, method).evaluate(points, limit, method, threads, stop)
        return result.reshape(shape), tuple(one.sha256 for one in used)

    def problem(self, name: str) -> str | None:
        """Description of the problem of a data set; None if it is intact."""
        try:
            with self.catalogue.open(name) as file:
                return self.problem_of(file)
        except DatasetError as error:
            return str(error)

    def problem_of(self, file: DataFile) -> str | None:
        """The same for an open data set, which is read and checked once per version of its file."""
        with self.catalogue.lock:
            return self._problems.value(file.name, file, lambda file: _problem_of(file.name, file.content()))

    def _limit_memory(self, newest: tuple[str, float, FileVersion | None]) -> None:
        """Forget the cubes that were not used for longest."""
        sizes = {key: 0 if isinstance(one, DatasetError) else one.layers.nbytes for key, one in self._slices.items()}
        excess = sum(sizes.values()) - MAX_BYTES
        for key, size in sizes.items():
            if excess > 0 and size and key != newest:
                self._slices.forget(key)
                excess -= size

    def _open(
        self, file: DataFile, pulse: str, restitution: float, errors: RestitutionErrors | None
    ) -> CubeSlice | DatasetError:
        try:
            cube = decode_slice(file.content(), file.name, file.path, file.version, errors)
            sampled = None if isinstance(cube.pulse, str) else cube.pulse
            found = str(cube.pulse) if sampled is None else sampled.name
            _check_content(file.name, (found, cube.restitution), (pulse, restitution))
            if sampled is not None and sampled != as_pulse(pulse):
                raise DatasetError(f"{file.name}: holds other samples than the pulse {pulse}; build it again")
        except DatasetError as error:
            return error
        return cube


def _decoded_errors(file: DataFile) -> RestitutionErrors | DatasetError:
    try:
        return decode_errors(file.content(), file.name, file.path, file.version)
    except DatasetError as error:
        return error


def _cube_name(pulse: str, restitution: float) -> str:
    return f"spectra/{pulse.removeprefix('-')}/eta-{restitution:.2f}"


def _restitution_of(stem: str) -> float:
    """Restitution in the name of a file; nan if the name has none."""
    try:
        return float(stem.removeprefix("eta-"))
    except ValueError:
        return np.nan


def _check_content(name: str, found: tuple[str, float], expected: tuple[str, float]) -> None:
    """Raise `DatasetError` if a data set has another pulse or restitution than expected."""
    if found != expected:
        raise DatasetError(f"{name}: holds {found[0]} with restitution {found[1]:g}; build it again")


def _problem_of(name: str, content: bytes) -> str | None:
    """Description of the problem of a data set with these bytes, None if it is intact."""
    kind, *rest = name.split("/")
    try:
        if kind == "spectra" and len(rest) == 2 and rest[1] == ERRORS_NAME:
            decode_errors(content, name, Path(name), None)
        elif kind == "spectra" and len(rest) == 2:
            _check_content(name, check_slice(content, name), (rest[0], _restitution_of(rest[1])))
        else:
            decode_dataset(content, name)
    except DatasetError as error:
        return str(error)
    return None
