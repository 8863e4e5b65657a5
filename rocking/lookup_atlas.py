"""All cubes of a results folder as one source of answers; each is opened when first asked.

A missing or damaged cube never gives a wrong answer: the solver answers in its place, and `Atlas.problems` says so.
Files that the workflow replaces are read again.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from rocking.bounded_response import BoundedResponse
from rocking.cube import read_dataset
from rocking.errors import DatasetError
from rocking.lookup import Cube
from rocking.lookup_files import Catalogue, Stamp, UnknownDatasetError, stamp_of
from rocking.lookup_level import Level, open_level
from rocking.pulses import get_pulse
from rocking.response import Outcome

Opened = tuple[Path, Stamp, Level | DatasetError]
"""The file of a cube, the version of it that was read, and the cube or what is wrong with it."""


class Atlas:
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
        self._cubes: dict[tuple[str, float], Opened] = {}
        self._levels: dict[str, tuple[Path, int, list[float]]] = {}
        self._checked: dict[str, tuple[Stamp, str | None]] = {}

    def levels(self, pulse: str) -> list[float]:
        """Restitutions for which a cube of the pulse lies there, ascending."""
        key = pulse.removeprefix("-")
        known = self._levels.get(key)
        folder = known[0] if known else self.catalogue.results / "spectra" / key
        try:
            changed = folder.stat().st_mtime_ns
        except OSError:
            return []
        if known is None or known[1] != changed:
            found = sorted(_level(path.stem) for path in folder.glob("eta-?.??.nc"))
            known = self._levels[key] = folder, changed, found
        return known[2]

    def level(self, pulse: str, restitution: float) -> Level | None:
        """The cube of a pulse and a restitution, None if there is none.

        A mirrored pulse has the same peaks and fates, and is answered by the same cube.

        Raises
        ------
        DatasetError
            If the file is damaged or holds something else than its name says.
        """
        key = pulse.removeprefix("-"), restitution
        known = self._cubes.get(key)
        try:
            if known is None or known[1] != stamp_of(known[0]):
                known = self._read(key)
        except (UnknownDatasetError, FileNotFoundError):
            return None
        if isinstance(known[2], DatasetError):
            raise known[2]
        return known[2]

    def _read(self, key: tuple[str, float]) -> Opened:
        """The cube of a pulse and a restitution, from its file unless another thread has just read it."""
        with self.catalogue.lock:
            path = self.catalogue.path(_cube_name(*key))
            stamp = stamp_of(path)
            known = self._cubes.get(key)
            if known is None or known[1] != stamp:
                known = self._cubes[key] = path, stamp, _open(path, *key)
            return known

    def cube(self, pulse: str, method: str = "auto") -> Cube:
        """The cubes of a pulse as one; each is opened when first asked.

        A damaged one raises `DatasetError` then with `method="cube"`, else it counts as missing; `problems` tells.
        """
        restitutions = np.array(self.levels(pulse))

        def level(k: int) -> Level | None:
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
        return all((pulse.removeprefix("-"), levels[k]) in self._cubes for k in used)

    def problems(self) -> dict[str, str]:
        """Read and check every data set, once per version of the file; what is wrong with it, by name.

        The name "spectra" stands for the case that there are no cubes at all.
        """
        found: dict[str, str] = {}
        names = self.catalogue.names()
        if not any(name.startswith("spectra/") for name in names):
            found["spectra"] = f"no spectrum cubes in {self.catalogue.results}; `make reproduce` builds them"
        for name in names:
            problem = self.problem(name)
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
        )
        eta = np.asarray(restitution, dtype=np.float64)
        rocked = (answer.source == "cube") & (answer.outcome != Outcome.NO_UPLIFT)
        served = np.broadcast_to(eta, rocked.shape)[rocked] if eta.ndim else eta.reshape(1)
        used = [cube.level(k) for k in cube.used(served)] if rocked.any() else []
        return answer, tuple(level.sha256 for level in used if level is not None)

    def problem(self, name: str) -> str | None:
        """What is wrong with a data set, read and checked once per version of its file; None if nothing is."""
        with self.catalogue.lock:
            path = self.catalogue.path(name)
            stamp = stamp_of(path)
            known = self._checked.get(name)
            if known is None or known[0] != stamp:
                known = self._checked[name] = (stamp, _check(path, name))
        return known[1]


def _cube_name(pulse: str, restitution: float) -> str:
    return f"spectra/{pulse.removeprefix('-')}/eta-{restitution:.2f}"


def _level(stem: str) -> float:
    """Restitution in the name of a file; nan, which equals no restitution, if it is none."""
    try:
        return float(stem.removeprefix("eta-"))
    except ValueError:
        return np.nan


def _open(path: Path, pulse: str, restitution: float) -> Level | DatasetError:
    try:
        cube = open_level(path)
    except DatasetError as error:
        return error
    if (cube.pulse, cube.restitution) != (pulse, restitution):
        return DatasetError(f"{path}: holds {cube.pulse} with restitution {cube.restitution:g}; build it again")
    return cube


def _check(path: Path, name: str) -> str | None:
    """Read a data set; what is wrong with it, None if nothing is."""
    kind, *rest = name.split("/")
    if kind == "spectra" and len(rest) == 2:
        found = _open(path, rest[0], _level(rest[1]))
        return str(found) if isinstance(found, DatasetError) else None
    try:
        read_dataset(path)
    except DatasetError as error:
        return str(error)
    return None
