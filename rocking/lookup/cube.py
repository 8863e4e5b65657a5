"""Responses interpolated from spectrum cubes, with error bounds; the solver is used where these exceed the tolerance.

A point is interpolated in slenderness, frequency ratio, restitution and slenderness angle if all cells used are of the
same kind. For cells of blocks that survive, without an overturning boundary, the errors within the cells, between the
restitutions and between the angles were measured against the solver when the cubes were computed; the bound is
`SAFETY` times the sum of these errors. Where all cells overturn in the same way, the outcome is known.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rocking._numba.cancellation import StopFlag
from rocking.errors import InvalidArgumentError, OutsideCubeError, in_range, one_of
from rocking.interpolation.kernel import FOUND_RECORD, SliceArrays, interpolate_many
from rocking.interpolation.stencils import STENCIL_SIZE, cell_index, slice_index, slice_window
from rocking.lookup.cube_slice import CubeSlice
from rocking.lookup.points import Points
from rocking.solver.bounded_response import SOLVER_ERROR, BoundedResponse, solve_with_bound

Method = Literal["auto", "cube", "solver"]
METHODS: tuple[str, ...] = get_args(Method)

SAFETY = 6.0
"""Ratio of the error bound to the measured errors [-], which are known at a few points of each cell only."""

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
Index = slice | NDArray[np.intp]


@dataclass(frozen=True)
class Window:
    """The slices from which points between two restitutions, or on one, are interpolated.

    Attributes
    ----------
    slices : list of CubeSlice
        `STENCIL_SIZE` slices; those from `count` on repeat the slice `lower`.
    lower, count : int
        The slice at or below the restitutions, and the number of slices used.
    """

    slices: list[CubeSlice]
    lower: int
    count: int


@dataclass(frozen=True)
class Cube:
    """Spectrum cubes of one pulse and one or several restitutions.

    Attributes
    ----------
    pulse : str
        Name of the pulse.
    restitutions : float array
        Restitutions of the cubes, ascending [-].
    slice_at : callable
        Returns the cube of a restitution by its index, read when first needed; None if it cannot be used.
    """

    pulse: str
    restitutions: Array
    slice_at: Callable[[int], CubeSlice | None]

    def response(
        self,
        *,
        slenderness: ArrayLike,
        frequency_ratio: ArrayLike,
        restitution: ArrayLike | None = None,
        alpha: ArrayLike | None = None,
        tolerance: float = 1e-4,
        method: str = "auto",
        stop: StopFlag | None = None,
    ) -> BoundedResponse:
        """Outcome and peak rotation with an error bound not above `tolerance`; the arguments broadcast.

        Parameters
        ----------
        slenderness, frequency_ratio : array_like
            1/a > 0 and omega > 0 [-]; from 1/a = 1 on there is no uplift, also outside of the cubes.
        restitution : array_like, optional
            eta [-], [0, 1]; optional if there is one cube only.
        alpha : array_like, optional
            Slenderness angle [rad]; None or 0 for the slender limit.
        tolerance : float
            Largest error of an interpolated peak_rotation [-], >= 0.
        method : {"auto", "cube", "solver"}
            "auto" uses the solver where the cubes do not meet the tolerance, "cube" raises an error there.
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
        limit = float(in_range("tolerance", tolerance, 0.0, np.inf, closed="left"))
        if restitution is None:
            if self.restitutions.size != 1:
                raise InvalidArgumentError("restitution", None, "a number: there are several cubes")
            restitution = self.restitutions[0]
        points, shape = Points.of(slenderness, frequency_ratio, restitution, alpha)
        result = BoundedResponse.empty(points.slenderness.shape)
        if method == "cube":
            result.source[...] = "cube"
        rocks = points.slenderness < 1.0
        left = np.flatnonzero(rocks)
        if method != "solver":
            known, part = self.interpolate(points[left], limit)
            result.put(left[known], part)
            left = left[~known]
        if left.size:
            if method == "cube":
                self._refuse(points[left[:1]], limit)
            result.put(left, _solve(self.pulse, points[left], stop))
        return result.reshape(shape)

    def used(self, restitution: Array) -> list[int]:
        """Indices of the cubes needed for some restitutions: first those at or below one of them, then the others."""
        lower, on_slice = slice_index(self.restitutions, restitution)
        below = lower >= 0
        needed = dict.fromkeys(np.unique(lower[below]).tolist())
        for k in np.unique(lower[below & ~on_slice]).tolist():
            first, count = slice_window(self.restitutions.size, k)
            needed |= dict.fromkeys(range(first, first + count))
        return list(needed)

    def interpolate(self, points: Points, limit: float) -> tuple[Flags, BoundedResponse]:
        """Where the error bound is at most `limit` (points,), and the responses there."""
        found = np.zeros(points.slenderness.size, FOUND_RECORD)
        lower, on_slice = slice_index(self.restitutions, points.restitution)
        for label, index in _parts(np.where(lower < 0, -1, 2 * lower + on_slice)):
            window = self._window(*divmod(label, 2)) if label >= 0 else None
            if window is not None:
                part = found[index]
                _interpolate(window, points[index], part)
                found[index] = part
        bound = np.where(found["overturned"], 0.0, SAFETY * found["error"] + SOLVER_ERROR)
        # a block that survives passes alpha if and only if its peak does: unknown for a peak within its bound of alpha
        undecided = ~found["overturned"] & (np.abs(found["peak"] - 1.0) <= bound)
        known = found["known"] & (bound <= limit) & ~undecided
        kept, bound = found[known], bound[known]
        survives = ~kept["overturned"]
        return known, BoundedResponse(
            np.where(survives, np.maximum(kept["peak"], 0.0), np.nan),
            kept["outcome"],
            kept["impacts"],
            ~survives | (kept["peak"] > 1.0),
            np.where(survives, bound, np.nan),
            np.full(kept.size, "cube"),
        )

    def _window(self, k: int, on_slice: int) -> Window | None:
        """The window of points on slice k, or between it and the next one; None if a slice is missing.

        Between slices these are the slices with which the errors were measured, whatever other files there are.
        """
        own = self.slice_at(k)
        if own is None:
            return None
        if on_slice:
            return Window([own] * STENCIL_SIZE, 0, 1)
        lower = int(np.searchsorted(own.restitutions, own.restitution))
        if lower + 1 >= own.restitutions.size:
            return None
        first, count = slice_window(own.restitutions.size, lower)
        slices = [own] * STENCIL_SIZE
        for place, restitution in enumerate(own.restitutions[first : first + count]):
            index = np.flatnonzero(self.restitutions == restitution)
            one = self.slice_at(int(index[0])) if index.size else None
            if one is None or not one.fits(own) or not np.array_equal(one.restitutions, own.restitutions):
                return None
            slices[place] = one
        return Window(slices, lower - first, count)

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
            raise OutsideCubeError("tolerance", limit, f"at least {bound:.3g} {where} in this cube, or method auto")
        why = "where outcomes or modes of response meet, or the slices of restitution or alpha are too far apart"
        raise OutsideCubeError("method", "cube", f"auto or solver {where}, {why}")


def _parts(labels: NDArray[np.intp]) -> Iterator[tuple[int, Index]]:
    """Each label and the index of its points; usually there is one label."""
    if labels.size and (labels == labels[0]).all():
        yield int(labels[0]), slice(None)
    else:
        for label in np.unique(labels):
            yield int(label), np.flatnonzero(labels == label)


def _interpolate(window: Window, points: Points, found: NDArray[np.void]) -> None:
    """Fill `found` (points,) for restitutions that are all in the interval of the window, or all on its slice."""
    own = window.slices[window.lower]
    angle_slice, on_angle = slice_index(own.alpha, points.alpha)
    interpolate_many(
        cell_index(own.slenderness, points.slenderness),
        cell_index(own.frequency_ratio, points.frequency_ratio),
        points.slenderness,
        np.log(points.frequency_ratio),
        own.mesh,
        points.restitution,
        np.array([one.restitution for one in window.slices]),
        window.lower,
        window.count,
        angle_slice,
        on_angle,
        points.alpha**2,  # the equation of motion depends on alpha through its square only
        own.alpha**2,
        SliceArrays(*(tuple(getattr(one, name) for one in window.slices) for name in SliceArrays._fields)),
        found,
    )


def _solve(pulse: str, points: Points, stop: StopFlag | None) -> BoundedResponse:
    return solve_with_bound(
        pulse,
        slenderness=points.slenderness,
        frequency_ratio=points.frequency_ratio,
        restitution=points.restitution,
        alpha=points.alpha,
        stop=stop,
    )
