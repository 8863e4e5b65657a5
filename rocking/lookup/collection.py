"""All cubes of a results folder as one source of answers; each is opened when first asked.

A missing, damaged or unreadable cube never gives a wrong result: the solver computes it instead, and
`CubeCollection.problems` reports the file. Files that change are read again.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from rocking._numba.cancellation import StopFlag
from rocking.datasets.catalogue import Catalogue, DataFile, FileVersion, UnknownDatasetError, version_of
from rocking.datasets.cube import decode_dataset
from rocking.errors import DatasetError
from rocking.excitation.pulses import get_pulse
from rocking.lookup.cube import Cube
from rocking.lookup.cube_slice import CubeSlice, decode_slice
from rocking.model.response import Outcome
from rocking.solver.bounded_response import BoundedResponse

LoadedCube = tuple[Path, FileVersion, CubeSlice | DatasetError]
"""The file of a cube, the version of it that was read, and the cube or what is wrong with it."""


class CubeCollection:
    """The spectrum cubes below a results folder.

    Parameters
    ----------
    results : path
        Folder that the workflow fills; it need not exist yet.

    Attributes
    ----------
    catalogue : Catalogue
        All files of the folder.
    """

    def __init__(self, results: Path | str) -> None:
        self.catalogue = Catalogue(results)
        self._cubes: dict[tuple[str, float], LoadedCube] = {}
        self._levels: dict[str, tuple[Path, FileVersion, list[float]]] = {}
        self._checked: dict[str, tuple[FileVersion, str | None]] = {}

    def levels(self, pulse: str) -> list[float]:
        """Restitutions for which a cube of the pulse lies there, ascending."""
        key = pulse.removeprefix("-")
        known = self._levels.get(key)
        folder = known[0] if known else self.catalogue.results / "spectra" / key
        version = version_of(folder)
        if version is None:
            return []
        if known is not None and known[1] == version:
            return known[2]
        found = sorted(_restitution_of(path.stem) for path in folder.glob("eta-?.??.nc"))
        if version.is_settled:
            self._levels[key] = folder, version, found
        return found

    def level(self, pulse: str, restitution: float) -> CubeSlice | None:
        """The cube of a pulse and a restitution, None if there is none.

        A mirrored pulse has the same peaks and fates, and is answered by the same cube.

        Raises
        ------
        DatasetError
            If the file is damaged, cannot be read, or holds something else than its name says.
        """
        key = pulse.removeprefix("-"), restitution
        known = self._current(key)
        if known is None:
            try:
                known = self._read(key)
            except UnknownDatasetError:
                return None
        if isinstance(known[2], DatasetError):
            raise known[2]
        return known[2]

    def _current(self, key: tuple[str, float]) -> LoadedCube | None:
        """The cube of a pulse and a restitution, if it is open and its file is the same still."""
        known = self._cubes.get(key)
        return known if known is not None and known[1] == version_of(known[0]) else None

    def _read(self, key: tuple[str, float]) -> LoadedCube:
        """The cube of a pulse and a restitution, from its file unless another thread has just read it."""
        with self.catalogue.open(_cube_name(*key)) as file, self.catalogue.lock:
            known = self._cubes.get(key)
            if known is None or known[1] != file.version:
                cube = _open(file, *key)
                known = self._cubes[key] = file.path, file.version, cube
            return known

    def cube(self, pulse: str, method: str = "auto") -> Cube:
        """The cubes of a pulse as one; each is opened when first asked.

        A damaged one raises `DatasetError` then with `method="cube"`, else it counts as missing; `problems` tells.
        """
        restitutions = np.array(self.levels(pulse))

        @cache  # one answer comes from one version of each file
        def level(k: int) -> CubeSlice | None:
            try:
                return self.level(pulse, float(restitutions[k]))
            except DatasetError:
                if method == "cube":
                    raise
                return None

        return Cube(pulse, restitutions, level)

    def is_open(self, pulse: str, restitution: float) -> bool:
        """Whether a question needs no file to be read first."""
        levels = self.levels(pulse)
        if not levels or not levels[0] <= restitution <= levels[-1]:
            return True
        used = Cube(pulse, np.array(levels), lambda _: None).used(np.array([restitution]))
        return all(self._current((pulse.removeprefix("-"), levels[k])) for k in used)

    def problems(self) -> dict[str, str]:
        """Read and check every data set, once per version of the file; what is wrong with it, by name.

        The name "spectra" stands for the case that there are no cubes at all; folders that cannot be read have theirs.
        """
        names, found = self.catalogue.scan()
        if not any(name.startswith("spectra/") for name in names):
            found.setdefault("spectra", "no spectrum cubes; `make reproduce` builds them")
        for name in names:
            try:
                problem = self.problem(name)
            except UnknownDatasetError:  # it went away meanwhile
                continue
            if problem is not None:
                found[name] = problem
        return found

    def response(
        self,
        pulse: str,
        *,
        slenderness: ArrayLike,
        frequency_ratio: ArrayLike,
        restitution: ArrayLike,
        alpha: ArrayLike | None = None,
        tolerance: float = 1e-4,
        method: str = "auto",
        stop: StopFlag | None = None,
    ) -> tuple[BoundedResponse, tuple[str, ...]]:
        """Answers as `Cube.response`, over all cubes of a pulse, and the sha256 of each cube that gave some of them.

        Parameters
        ----------
        pulse : str
            Name of the pulse.
        slenderness, frequency_ratio, restitution : array_like, broadcasting
            1/a > 0 [-], omega > 0 [-], eta in [0, 1] [-].
        alpha : array_like, optional
            Slenderness angle [rad]; None or 0 for the slender limit.
        tolerance : float
            Largest error of an interpolated peak_rotation [-], >= 0.
        method : {"auto", "cube", "solver"}
            As `Cube.response`; "auto" also asks the solver where a cube is missing or damaged.
        stop : StopFlag, optional
            Once another thread sets it, this ends soon with `StoppedError`.

        Raises
        ------
        InvalidArgumentError
            If a value is out of range.
        OutsideCubeError
            With `method="cube"`, for a point that no cube answers.
        DatasetError
            With `method="cube"`, for a damaged cube.
        """
        get_pulse(pulse)
        cube = self.cube(pulse, method)
        answer = cube.response(
            slenderness=slenderness,
            frequency_ratio=frequency_ratio,
            restitution=restitution,
            alpha=alpha,
            tolerance=tolerance,
            method=method,
            stop=stop,
        )
        eta = np.asarray(restitution, dtype=np.float64)
        rocked = (answer.source == "cube") & (answer.outcome != Outcome.NO_UPLIFT)
        served = np.broadcast_to(eta, rocked.shape)[rocked] if eta.ndim else eta.reshape(1)
        used = [cube.level(k) for k in cube.used(served)] if rocked.any() else []
        return answer, tuple(level.sha256 for level in used if level is not None)

    def problem(self, name: str) -> str | None:
        """What is wrong with a data set; None if nothing is.

        Raises
        ------
        UnknownDatasetError
            If there is no data set of that name.
        """
        try:
            with self.catalogue.open(name) as file:
                return self.problem_of(file)
        except DatasetError as error:
            return str(error)

    def problem_of(self, file: DataFile) -> str | None:
        """The same for an open data set, read and checked once per version of its file."""
        with self.catalogue.lock:
            known = self._checked.get(file.name)
            if known is None or known[0] != file.version:
                problem = _check(file)
                known = self._checked[file.name] = file.version, problem
            return known[1]


def _cube_name(pulse: str, restitution: float) -> str:
    return f"spectra/{pulse.removeprefix('-')}/eta-{restitution:.2f}"


def _restitution_of(stem: str) -> float:
    """Restitution in the name of a file; nan, which equals no restitution, if it is none."""
    try:
        return float(stem.removeprefix("eta-"))
    except ValueError:
        return np.nan


def _open(file: DataFile, pulse: str, restitution: float) -> CubeSlice | DatasetError:
    try:
        cube = decode_slice(file.content(), file.name)
    except DatasetError as error:
        return error
    if (cube.pulse, cube.restitution) != (pulse, restitution):
        return DatasetError(f"{file.name}: holds {cube.pulse} with restitution {cube.restitution:g}; build it again")
    return cube


def _check(file: DataFile) -> str | None:
    """Read a data set; what is wrong with it, None if nothing is."""
    kind, *rest = file.name.split("/")
    if kind == "spectra" and len(rest) == 2:
        found = _open(file, rest[0], _restitution_of(rest[1]))
        return str(found) if isinstance(found, DatasetError) else None
    try:
        decode_dataset(file.content(), file.name)
    except DatasetError as error:
        return str(error)
    return None
