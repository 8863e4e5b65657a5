"""Responses interpolated from spectrum cubes, with error bounds; the solver is used where these exceed the tolerance.

A point is interpolated in slenderness, frequency ratio, restitution and slenderness angle if all cells used are of the
same kind. For cells of blocks that survive, without an overturning boundary, the errors within the cells, between the
restitutions and between the angles were measured against the solver when the cubes were computed; the bound is
`SAFETY` times the sum of these errors. Where all cells overturn in the same way, the outcome is known.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar, Literal, get_args

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
from rocking._interpolation.kernel import (
    BLOCK,
    INTERPOLATED,
    NO_UPLIFT,
    POINT,
    UNKNOWN,
    WORK,
    Found,
    interpolate_many,
)
from rocking._interpolation.slices import slice_index, slice_window
from rocking._interpolation.windows import SLICE_WINDOW, group_points
from rocking._lookup.cube_slice import CubeSlice, fetch_slice, open_slice
from rocking._model.checks import check_groups
from rocking._model.fields import DERIVED_FIELDS
from rocking._model.outcome import Outcome
from rocking._numba.cancellation import StopFlag
from rocking._numba.compilation import contiguous_array
from rocking._solver.bounded_response import SOLVER_ERROR, BoundedResponse, solve_checked
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
        """The checked, broadcast and flattened arguments, in the order of the fields, and the broadcast shape.

        Raises
        ------
        InvalidArgumentError
            If a value is out of range, or the shapes do not broadcast.
        """
        given = dict(zip(cls.__dataclass_fields__, groups, strict=True))
        full = broadcast(given, [*check_groups(**given).values()])
        return cls(*(contiguous_array(group).ravel() for group in full)), full[0].shape

    def __getitem__(self, index: Any) -> Points:
        return Points(*(getattr(self, name)[index] for name in self.__dataclass_fields__))


Method = Literal["auto", "cube", "solver"]
METHODS: tuple[str, ...] = get_args(Method)

SAFETY = 6.0
"""Ratio of the error bound to the measured errors [-], which are known at a few points of each cell only."""

MIN_CHUNK, MAX_CHUNK = 32_768, 262_144
"""Fewest and most points that a thread interpolates at a time."""

_OUTCOME_WITHOUT_UPLIFT = int(Outcome.NO_UPLIFT)

Flags = NDArray[np.bool_]


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
    """

    pulse: str | AbstractPulse
    restitutions: Array
    slice_at: Callable[[int], CubeSlice | None]

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
        return self.evaluate(
            slenderness, frequency_ratio, restitution, alpha, absolute_tolerance, method, threads, stop
        )[0]

    def evaluate(
        self,
        slenderness: ArrayLike,
        frequency_ratio: ArrayLike,
        restitution: ArrayLike | None,
        alpha: ArrayLike | None,
        absolute_tolerance: float,
        method: str,
        threads: int | None,
        stop: StopFlag | None,
    ) -> tuple[BoundedResponse, list[CubeSlice]]:
        """`response`, and the cubes from which points were interpolated, in the order of `used`."""
        one_of("method", method, METHODS)
        limit = number("absolute_tolerance", absolute_tolerance, 0.0, np.inf, closed="left")
        if threads is not None:
            threads = integer("threads", threads, 1, np.inf)
        if restitution is None:
            if self.restitutions.size != 1:
                raise InvalidArgumentError("restitution", None, "a number: there are several cubes")
            restitution = self.restitutions[0]
        points, shape = Points.of(slenderness, frequency_ratio, restitution, alpha)
        used: list[CubeSlice] = []
        if method == "solver":
            found = _empty(points)
        else:
            found, used = self._interpolated(points, limit, threads, stop)
        result = _response(found)
        left = np.flatnonzero(found.state == UNKNOWN)
        if left.size and method == "cube":
            self._refuse(points[left[:1]], limit)
        if method == "cube":
            result.from_cube[...] = True
        if left.size:
            result.put(left, _solve(self.pulse, points[left], threads, stop))
        return result.reshape(shape), used

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
        found, _ = self._interpolated(points, limit, threads, None)
        return found.state == INTERPOLATED, _response(found)

    def _interpolated(
        self, points: Points, limit: float, threads: int | None, stop: StopFlag | None
    ) -> tuple[Found, list[CubeSlice]]:
        """Responses of the points, and the slices used."""
        found = _empty(points)
        groups, present = np.empty(found.state.size, np.int32), np.zeros(2 * self.restitutions.size + 1, np.bool_)
        group_points(points.restitution, self.restitutions, groups, present, np.empty(BLOCK))
        wanted = {
            k: slices
            for k, some in enumerate(present[:-1].tolist())
            if some and (slices := self._slices(*divmod(k, 2)))
        }
        counts = np.zeros(present.size, np.int64)
        left = wanted
        while left:
            own = next(iter(left.values()))[0]
            alike = {k: slices for k, slices in left.items() if slices[0] is own or slices[0].fits(own)}
            left = {k: slices for k, slices in left.items() if k not in alike}
            windows = np.zeros(present.size, SLICE_WINDOW)
            for k, slices in alike.items():
                windows[k] = slices[0].window(*slices[1:])
            for given in _interpolate(points, groups, own, windows, limit, found, threads, stop):
                counts += given
        used = [slices for k, slices in wanted.items() if counts[k]]
        lower, others = [one for one, *_ in used], [one for _, *rest in used for one in rest]
        # the slices are compared by identity
        return found, list(dict.fromkeys([*lower, *others]))

    def _slices(self, k: int, between: int) -> list[CubeSlice]:
        """Slice k, and for points between it and the next one the others of their window; empty if one is missing.

        Between slices these are the slices with which the errors were measured, whatever other files there are.
        """
        own = self.slice_at(k)
        if own is None or not between:
            return [] if own is None else [own]
        lower = int(np.searchsorted(own.restitutions, own.restitution))
        if lower + 1 >= own.restitutions.size:
            return []
        first, count = slice_window(own.restitutions.size, lower)
        slices = [own]
        for restitution in own.restitutions[first : first + count]:
            if restitution == own.restitution:
                continue
            index = np.flatnonzero(self.restitutions == restitution)
            one = self.slice_at(int(index[0])) if index.size else None
            if one is None or not one.fits(own):
                return []
            slices.append(one)
        return slices

    def _refuse(self, point: Points, limit: float) -> None:
        """Raise `OutsideCubeError` with the reason why the cubes do not give the response at a point."""
        s, w, eta, alpha = (float(getattr(point, name)[0]) for name in point.__dataclass_fields__)
        etas = self.restitutions
        if not etas.size or not etas[0] <= eta <= etas[-1]:
            allowed = f"[{etas[0]:.2f}, {etas[-1]:.2f}]" if etas.size else "one with a cube"
            raise OutsideCubeError("restitution", eta, f"{allowed}, or method auto")
        nearest = self.slice_at(int(np.argmin(np.abs(etas - eta))))
        if nearest is None:
            raise OutsideCubeError("restitution", eta, "one with a cube that can be read, or method auto")
        axes = (("slenderness", s, "-"), ("frequency_ratio", w, "-"), ("alpha", alpha, "rad"))
        for name, value, unit in axes:
            axis = getattr(nearest, name)
            if not axis[0] <= value <= axis[-1]:
                allowed = f"[{axis[0]:g}, {axis[-1]:g}] [{unit}]" if axis.size > 1 else f"{axis[0]:g} [{unit}]"
                raise OutsideCubeError(name, value, f"{allowed} in this cube, or method auto")
        where = f"at slenderness {s:g}, frequency_ratio {w:g}"
        known, part = self.interpolate(point, np.inf)
        if known[0] and part.error_bound[0] > limit:
            bound = float(part.error_bound[0])
            raise OutsideCubeError(
                "absolute_tolerance", limit, f"at least {bound:.3g} {where} in this cube, or method auto"
            )
        why = "where outcomes or modes of response meet, or the slices of restitution or alpha are too far apart"
        raise OutsideCubeError("method", "cube", f"auto or solver {where}, {why}")


def _interpolate(
    points: Points,
    groups: NDArray[np.int32],
    own: CubeSlice,
    windows: NDArray[np.void],
    limit: float,
    found: Found,
    threads: int | None,
    stop: StopFlag | None,
) -> list[NDArray[np.int64]]:
    """Fill `found` from the slices of the windows, with the axes of `own`; numbers of points given, of each group."""
    size, cores = groups.size, threads or AVAILABLE_CORES
    counts: list[NDArray[np.int64]] = []

    def fill(part: slice, _: NDArray[np.uint8]) -> None:
        given = np.zeros(windows.size, np.int64)
        interpolate_many(
            points.slenderness[part],
            points.frequency_ratio[part],
            points.restitution[part],
            points.alpha[part],
            own.mesh,
            own.angles,
            groups[part],
            windows,
            limit,
            SAFETY,
            SOLVER_ERROR,
            np.empty(WORK, POINT),
            np.empty((2, BLOCK), np.int64),
            np.empty(BLOCK),
            np.empty(BLOCK),
            given,
            Found(*[field[part] for field in found]),  # type: ignore[arg-type]  # in order
        )
        counts.append(given)

    fill_chunks(fill, size, min(max(math.ceil(size / cores), MIN_CHUNK), MAX_CHUNK), cores, stop)
    return counts


def _empty(points: Points) -> Found:
    """Responses of points that are not interpolated: those without uplift are final."""
    size = points.slenderness.size
    state = np.zeros(size, np.int8)  # UNKNOWN
    state[points.slenderness >= 1.0] = NO_UPLIFT
    return Found(
        state,
        np.zeros(size),
        np.full(size, _OUTCOME_WITHOUT_UPLIFT, np.int8),
        np.zeros(size, np.int32),
        np.zeros(size, np.bool_),
        np.zeros(size),
    )


def _response(found: Found) -> BoundedResponse:
    """The responses as their users see them."""
    return BoundedResponse(
        peak_rotation=found.peak_rotation,
        outcome=found.outcome,
        impacts=found.impacts,
        exceeded_alpha=found.exceeded_alpha,
        error_bound=found.error_bound,
        from_cube=found.state == INTERPOLATED,
        derived={field.name: np.where(found.state == INTERPOLATED, np.nan, field.at_rest) for field in DERIVED_FIELDS},
    )


def _solve(pulse: str | AbstractPulse, points: Points, threads: int | None, stop: StopFlag | None) -> BoundedResponse:
    groups = points.slenderness, points.frequency_ratio, points.restitution, points.alpha
    return solve_checked(as_pulse(pulse), *groups, None, threads, stop)


def open_cube(source: Path | str) -> Cube:
    """Read spectrum cubes into memory.

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
        slices = [open_slice(path) for path in sorted(Path(source).glob("eta-?.??.nc"))]
        if not slices:
            raise DatasetError(f"{source}: holds no spectrum cubes; `make reproduce` builds them")
    else:
        slices = [open_slice(source)]
    for one in slices:
        if one.pulse != slices[0].pulse or not one.fits(slices[0]):
            raise DatasetError(f"{source}: cubes of different pulses or grids; build them again")
    return Cube(slices[0].pulse, np.array([one.restitution for one in slices]), slices.__getitem__)
