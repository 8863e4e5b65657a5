"""Responses interpolated from spectrum cubes, with error bounds; the solver is used where these exceed the tolerance.

A point is interpolated in slenderness, frequency ratio, restitution and slenderness angle if all cells used are of the
same kind. For cells of blocks that survive, without an overturning boundary, the errors within the cells, between the
restitutions and between the angles were measured against the solver when the cubes were computed; the bound is
`SAFETY` times the sum of these errors. Where all cells overturn in the same way, the outcome is known.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, ClassVar, Literal, NamedTuple, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rocking._base.errors import (
    DatasetError,
    InvalidArgumentError,
    OutsideCubeError,
    broadcast,
    integer,
    number,
    one_of,
)
from rocking._excitation.pulses import AbstractPulse, as_pulse
from rocking._interpolation.kernel import Found, interpolate_many, prepare
from rocking._interpolation.slices import STENCIL_SIZE, slice_index, slice_window
from rocking._lookup.cube_slice import ERRORS_NAME, CubeSlice, fetch_slice, open_errors, open_slice
from rocking._model.checks import check_groups
from rocking._model.fields import DERIVED_FIELDS
from rocking._numba.cancellation import StopFlag
from rocking._numba.compilation import contiguous_array
from rocking._solver.bodies import SOLVER_ERROR
from rocking._solver.bounded_response import BoundedResponse, solve_checked
from rocking._solver.chunks import AVAILABLE_CORES, fill_chunks

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Points:
    """Arguments of a response, all float arrays (points,); alpha in rad, 0 for the slender limit."""

    slenderness: Array
    frequency_ratio: Array
    restitution: Array
    alpha: Array

    @classmethod
    def of(cls, *groups: ArrayLike | None) -> tuple[Points, tuple[int, ...]]:
        """The checked, broadcast and flattened arguments, in the order of the fields, and the broadcast shape."""
        given = dict(zip(cls.__dataclass_fields__, groups, strict=True))
        s, w, eta, alpha = check_groups(**given).values()
        if not (s.ndim or w.ndim or eta.ndim or alpha.ndim):  # one block, in a fraction of the time
            return cls(s.reshape(1), w.reshape(1), eta.reshape(1), alpha.reshape(1)), ()
        full = broadcast(given, [s, w, eta, alpha])
        return cls(*(contiguous_array(group).ravel() for group in full)), full[0].shape

    def __getitem__(self, index: Any) -> Points:
        return Points(*(getattr(self, name)[index] for name in self.__dataclass_fields__))


Method = Literal["auto", "cube", "solver"]
METHODS: tuple[str, ...] = get_args(Method)

SAFETY = 6.0  # ratio of the error bound to the measured errors [-], which are known at a few points of each cell only
MIN_CHUNK, MAX_CHUNK = 32_768, 262_144  # fewest and most points that a thread interpolates at a time

Flags = NDArray[np.bool_]


class UnreadError(RuntimeError):
    """A file has to be read first, and the caller does not wait for files."""


class Window(NamedTuple):
    """The slices from which points are interpolated."""

    slices: list[CubeSlice]  # ascending
    lower: int  # the one at or below the points
    levels: Array  # their restitutions [-]

    def arguments(self, alpha: Array, may_read: bool) -> tuple[Any, ...]:
        """What the kernel needs for points at some angles [rad]: it reads the nodes of these angles if necessary."""
        own, nodes = self.slices[self.lower], []
        angles = () if all(one.layers.complete for one in self.slices) else own.angles.needed(alpha)
        for one in self.slices:
            if not may_read and one.layers.lacks(angles):
                raise UnreadError
            nodes.append(one.layers.at(angles))
        padded = *nodes, *[nodes[0]] * (STENCIL_SIZE - len(nodes))
        return own.mesh, own.angles, padded, self.levels, self.lower


@dataclass(frozen=True, eq=False)
class Cube:
    """Spectrum cubes of one pulse and one or several restitutions.

    Attributes
    ----------
    pulse : str or AbstractPulse
        Name of the pulse; the pulse itself if it is given by samples.
    restitutions : float array
        Restitutions of the cubes, ascending [-].
    slice_at : callable
        Returns the cube of a restitution by its index, read when first needed; None if it cannot be used.
    may_read : bool
        False: `UnreadError` where an angle of a cube is not read.
    """

    pulse: str | AbstractPulse
    restitutions: Array
    slice_at: Callable[[int], CubeSlice | None]
    may_read: bool = True
    _windows: dict[int, Window | None] = field(default_factory=dict, init=False, repr=False)

    __hash__: ClassVar[None]  # type: ignore[assignment]

    def __eq__(self, other: object) -> bool:
        """Whether the files of the cubes have the same content."""
        if not isinstance(other, Cube):
            return NotImplemented
        alike = self.pulse == other.pulse and np.array_equal(self.restitutions, other.restitutions)
        return self is other or (alike and self._digests == other._digests)

    @property
    def _digests(self) -> list[str | None]:
        slices = map(self.slice_at, range(self.restitutions.size))
        return [None if one is None else one.sha256 for one in slices]

    def response(
        self,
        *,
        slenderness: ArrayLike,
        frequency_ratio: ArrayLike,
        restitution: ArrayLike | None = None,
        alpha: ArrayLike | None = None,
        absolute_tolerance: float = 1e-4,
        method: str = "auto",
        threads: int | None = None,
        stop: StopFlag | None = None,
    ) -> BoundedResponse:
        """Outcome and peak rotation with an error bound not above `absolute_tolerance`; the arguments broadcast.

        Parameters
        ----------
        slenderness : array_like
            g tan(alpha)/a_g = 1/a [-], > 0: depends on the motion, unlike h/b; no uplift from 1 on, also outside of the
            cubes.
        frequency_ratio : array_like
            omega = omega_g/p [-], > 0.
        restitution : array_like, optional
            eta [-], [0, 1]; optional if there is one cube only.
        alpha : array_like, optional
            Slenderness angle [rad]; None or 0 for the slender limit.
        absolute_tolerance : float
            Largest error of an interpolated peak_rotation [-], >= 0.
        method : {"auto", "cube", "solver"}
            "auto" uses the solver where the cubes do not meet the tolerance, "cube" raises an error there.
        threads : int, optional
            Number of threads for large arrays, >= 1; by default all cores.
        stop : StopFlag, optional
            The computation ends with `StoppedError` soon after another thread sets it.

        Raises
        ------
        InvalidArgumentError
            If a value is out of range.
        OutsideCubeError
            With `method="cube"`: outside the axes, where kinds of response meet, or if the bound exceeds the tolerance.
        """
        one_of("method", method, METHODS)
        limit = number("absolute_tolerance", absolute_tolerance, 0.0, np.inf, closed="left")
        if threads is not None:
            threads = integer("threads", threads, 1, np.inf)
        if restitution is None:
            if self.restitutions.size != 1:
                raise InvalidArgumentError("restitution", None, "a number: there are several cubes")
            restitution = self.restitutions[0]
        points, shape = Points.of(slenderness, frequency_ratio, restitution, alpha)
        return self.evaluate(points, limit, method, threads, stop)[0].reshape(shape)

    def evaluate(
        self, points: Points, limit: float, method: str, threads: int | None = None, stop: StopFlag | None = None
    ) -> tuple[BoundedResponse, list[CubeSlice]]:
        """`response` of checked points (points,), and the cubes from which some were interpolated."""
        if method == "solver":
            groups = points.slenderness, points.frequency_ratio, points.restitution, points.alpha
            return solve_checked(as_pulse(self.pulse), *groups, None, threads, stop), []
        found, used, unknown = self._interpolated(points, limit, threads, stop, method)
        result = _response(found)
        if unknown:  # the solver takes what the cubes leave open
            left = np.flatnonzero(~found.known)
            if method == "cube":
                self._refuse(points[left[:1]], limit)
            one = points if unknown == 1 == left.size == found.known.size else points[left]
            groups = one.slenderness, one.frequency_ratio, one.restitution, one.alpha
            solved = solve_checked(as_pulse(self.pulse), *groups, None, threads, stop)
            if one is points:
                return solved, used
            result.put(left, solved)
        if method == "cube":
            result.from_cube[...] = True
        return result, used

    def used(self, restitution: Array) -> list[int]:
        """Indices of the cubes needed for some restitutions: first those at or below one of them, then the others."""
        lower, on_slice = slice_index(self.restitutions, restitution)
        below = lower >= 0
        needed = dict.fromkeys(np.unique(lower[below]).tolist())
        for k in np.unique(lower[below & ~on_slice]).tolist():
            first, count = slice_window(self.restitutions.size, k)
            needed |= dict.fromkeys(range(first, first + count))
        return list(needed)

    def interpolate(self, points: Points, limit: float, threads: int | None = None) -> tuple[Flags, BoundedResponse]:
        """Where the cubes give a response with an error bound of at most `limit` (points,), and the responses.

        Responses elsewhere are undefined. `threads` as in `response`.
        """
        found = self._interpolated(points, limit, threads, None, "cube")[0]
        return found.from_cube, _response(found)

    def _interpolated(
        self, points: Points, limit: float, threads: int | None, stop: StopFlag | None, method: str
    ) -> tuple[Found, list[CubeSlice], int]:
        """Responses of the points, the slices used, and the number of points that are not known.

        With the method "auto" a file that was replaced since it was opened leaves its points to the solver.
        """
        size, cores = points.slenderness.size, threads or AVAILABLE_CORES
        groups, present = np.empty(size, np.int64), np.zeros(2 * self.restitutions.size + 1, np.bool_)
        arrays = points.slenderness, points.frequency_ratio, points.restitution, points.alpha, groups
        found = Found.zeros(size)
        # points on one slice, or between the same two, are one group: each is interpolated from one window of slices
        no_uplift = prepare(points.slenderness, points.restitution, self.restitutions, groups, present, found)
        windows: list[tuple[int, Window, tuple[Any, ...]]] = []
        for group in np.flatnonzero(present[:-1]).tolist():
            window = self._window(group)
            if window is None:
                continue
            try:
                windows.append((group, window, window.arguments(points.alpha, self.may_read)))
            except DatasetError:
                if method == "cube":
                    raise
        given: list[tuple[int, int]] = []

        def fill(part: slice, _: NDArray[np.uint8] | None = None) -> None:
            here: list[Any] = list(arrays)
            into: list[Any] = list(found)
            if size > MIN_CHUNK:
                here, into = [one[part] for one in arrays], [field[part] for field in found]
            for group, _window, arguments in windows:
                count = interpolate_many(*here, group, *arguments, limit, SAFETY, SOLVER_ERROR, Found(*into))
                given.append((group, count))

        if size > MIN_CHUNK:
            fill_chunks(fill, size, min(max(math.ceil(size / cores), MIN_CHUNK), MAX_CHUNK), cores, stop)
        else:
            fill(slice(size))
        met, counted = set(), 0
        for group, count in given:
            counted += count
            if count:
                met.add(group)
        used = [window for group, window, _ in windows if group in met]
        # the slices at or below points first; they are compared by identity
        slices = dict.fromkeys(
            [one.slices[one.lower] for one in used] + [one for window in used for one in window.slices]
        )
        return found, [*slices], size - no_uplift - counted

    def _window(self, group: int) -> Window | None:
        """The window of a group of points (`rocking._interpolation.kernel.prepare`), kept for the next ones."""
        if group not in self._windows:
            self._windows[group] = self._make_window(*divmod(group, 2))
        return self._windows[group]

    def _make_window(self, k: int, between: int) -> Window | None:
        """Slice k, or for points between it and the next one the slices of their window; None if one is missing.

        Between slices these are the slices with which the errors were measured, whatever other files there are.
        """
        own = self.slice_at(k)
        if own is None or not between:
            return None if own is None else Window([own], 0, self.restitutions[k : k + 1])
        etas = own.restitutions.tolist()
        if own.restitution not in etas[:-1]:
            return None
        lower = etas.index(own.restitution)
        first, count = slice_window(len(etas), lower)
        places = {eta: place for place, eta in enumerate(self.restitutions.tolist())}
        slices = []
        for eta in etas[first : first + count]:
            one = self.slice_at(places[eta]) if eta in places else None
            if one is None or not one.fits(own) or not own.was_measured_with(one):
                return None
            slices.append(one)
        return Window(slices, lower - first, np.array([one.restitution for one in slices]))

    def _refuse(self, point: Points, limit: float) -> None:
        """Raise `OutsideCubeError` with the reason why the cubes do not give the response at a point."""
        s, w, eta, alpha = (float(getattr(point, name)[0]) for name in point.__dataclass_fields__)
        etas = self.restitutions
        if not etas.size:
            named = self.pulse if isinstance(self.pulse, str) else self.pulse.name
            raise OutsideCubeError("pulse", named, "one with a cube, or method auto")
        if not etas[0] <= eta <= etas[-1]:
            raise OutsideCubeError("restitution", eta, f"[{etas[0]:.2f}, {etas[-1]:.2f}], or method auto")
        nearest = self.slice_at(int(np.argmin(np.abs(etas - eta))))
        if nearest is None:
            raise OutsideCubeError("restitution", eta, "one with a cube that can be read, or method auto")
        axes = (("slenderness", s, "-"), ("frequency_ratio", w, "-"), ("alpha", alpha, "rad"))
        for name, value, unit in axes:
            axis = nearest.axes[name]
            if not axis[0] <= value <= axis[-1]:
                allowed = f"[{axis[0]:g}, {axis[-1]:g}] [{unit}]" if axis.size > 1 else f"{axis[0]:g} [{unit}]"
                degrees = f" (up to {np.degrees(axis[-1]):g} degrees)" if name == "alpha" else ""
                raise OutsideCubeError(name, value, f"{allowed}{degrees} in this cube, or method auto")
        where = f"at slenderness {s:g}, frequency_ratio {w:g}"
        known, part = self.interpolate(point, np.inf)
        if known[0] and part.error_bound[0] > limit:
            bound = float(part.error_bound[0])
            raise OutsideCubeError(
                "absolute_tolerance", limit, f"at least {bound:.3g} {where} in this cube, or method auto"
            )
        why = "where outcomes or modes of response meet, or the slices of restitution or alpha are too far apart"
        raise OutsideCubeError("method", "cube", f"auto or solver {where}, {why}")


def _response(found: Found) -> BoundedResponse:
    """The responses, over the same memory."""
    derived = {field.name: np.where(found.from_cube, np.nan, field.at_rest) for field in DERIVED_FIELDS}
    kept = found.peak_rotation, found.outcome, found.impacts, found.exceeded_alpha, found.error_bound, found.from_cube
    return BoundedResponse(*kept, derived)


def open_cube(source: Path | str) -> Cube:
    """Open spectrum cubes, from which responses are interpolated with error bounds.

    Parameters
    ----------
    source : path or str
        A file such as `results/spectra/sine/eta-0.85.nc`, its http or https address, or a folder such as
        `results/spectra/sine`; the files of a folder are interpolated in restitution as well.

    Raises
    ------
    DatasetError
        If a file is missing, damaged, or not a spectrum cube, or if the files of a folder differ in pulse or axes.
    """
    if str(source).startswith(("http://", "https://")):
        slices = [fetch_slice(str(source))]
    elif Path(source).is_dir():
        errors = open_errors(Path(source) / f"{ERRORS_NAME}.nc")
        slices = [open_slice(path, errors) for path in sorted(Path(source).glob("eta-?.??.nc"))]
        if not slices:
            raise DatasetError(f"{source}: holds no spectrum cubes; `make reproduce` builds them")
    else:
        slices = [open_slice(source)]
    for one in slices:
        if one.pulse != slices[0].pulse or not one.fits(slices[0]):
            raise DatasetError(f"{source}: cubes of different pulses or grids; build them again")
    return Cube(slices[0].pulse, np.array([one.restitution for one in slices]), slices.__getitem__)
