"""Answers from cubes, each with an error bound; the solver answers where interpolation cannot keep the promise.

A point is interpolated in slenderness, frequency ratio, restitution and slenderness angle where all cells that serve
are of one kind: safe blocks, not crossed by a boundary of overturning, with errors measured against the solver when the
cubes were made, in the cells, between the restitutions and between the angles. `SAFETY` times their sum must not exceed
the tolerance. Where all cells overturn in the same way, it answers the fate.
"""

from __future__ import annotations

from collections import namedtuple
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rocking._numba.cancellation import StopFlag
from rocking.errors import InvalidArgumentError, OutsideCubeError, in_range, one_of
from rocking.interpolation.stencils import cell_index, slice_index
from rocking.lookup.cube_slice import FIELDS, CubeSlice
from rocking.lookup.kernel import LOWER_PLACE, SLICE_COUNT, interpolate_many
from rocking.lookup.points import Points
from rocking.solver.bounded_response import SOLVER_ERROR, BoundedResponse, solve_with_bound

Method = Literal["auto", "cube", "solver"]
METHODS: tuple[str, ...] = get_args(Method)

SAFETY = 6.0
"""Factor from the measured errors to the error bound [-]: the probes are five points of a cell, not all."""

FOUND_RECORD = np.dtype(
    [
        ("known", np.bool_),
        ("overturned", np.bool_),
        ("outcome", np.int8),
        ("impacts", np.int32),
        ("peak", np.float64),
        ("error", np.float64),
    ],
    align=True,
)
"""What is found at a point; `error` is the sum of the measured errors."""

_Fields = namedtuple("_Fields", list(FIELDS))  # type: ignore[misc]  # numba takes it for a record of tuples

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
Index = slice | NDArray[np.intp]


@dataclass(frozen=True)
class Cube:
    """Spectrum cubes of one pulse, one or several restitutions, as one source of answers.

    Attributes
    ----------
    pulse : str
        Name of the pulse.
    restitutions : float array
        Those of the cubes, ascending [-].
    level : callable
        From the index of a restitution to its cube, opened when first asked; None if it cannot be used.
    """

    pulse: str
    restitutions: Array
    level: Callable[[int], CubeSlice | None]

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
        """Peak rotation and fate with an error bound not above `tolerance`; the arguments broadcast.

        Parameters
        ----------
        slenderness, frequency_ratio : array_like
            1/a > 0 and omega > 0 [-]; from 1/a = 1 on there is no uplift, whatever the cubes hold.
        restitution : array_like, optional
            eta [-], [0, 1]; may be left out if there is one cube only.
        alpha : array_like, optional
            Slenderness angle [rad]; None or 0 for the slender limit.
        tolerance : float
            Largest error of an interpolated peak_rotation [-], >= 0.
        method : {"auto", "cube", "solver"}
            "auto" asks the solver where the cubes cannot keep the tolerance, "cube" raises there.
        stop : StopFlag, optional
            Once another thread sets it, this ends soon with `StoppedError`.

        Raises
        ------
        InvalidArgumentError
            If a value is out of range.
        OutsideCubeError
            With `method="cube"`: outside the axes, where kinds of response meet, or too coarse for the tolerance.
        """
        one_of("method", method, METHODS)
        limit = float(in_range("tolerance", tolerance, 0.0, np.inf, closed="left"))
        if restitution is None:
            if self.restitutions.size != 1:
                raise InvalidArgumentError("restitution", None, "a number: there are several cubes")
            restitution = self.restitutions[0]
        points, shape = Points.of(slenderness, frequency_ratio, restitution, alpha)
        answer = BoundedResponse.empty(points.slenderness.shape)
        if method == "cube":
            answer.source[...] = "cube"
        rocks = points.slenderness < 1.0
        left = np.flatnonzero(rocks)
        if method != "solver":
            known, part = self.promised(points[left], limit)
            answer.put(left[known], part)
            left = left[~known]
        if left.size:
            if method == "cube":
                self._refuse(points[left[:1]], limit)
            answer.put(left, _solve(self.pulse, points[left], stop))
        return answer.reshape(shape)

    def used(self, restitution: Array) -> list[int]:
        """Indices of the cubes that may serve some of the restitutions: first those at or below one, then others."""
        lower, on_level = slice_index(self.restitutions, restitution)
        below = lower >= 0
        serve = dict.fromkeys(np.flatnonzero(np.bincount(lower[below])).tolist())
        for k in np.flatnonzero(np.bincount(lower[below & ~on_level])).tolist():
            serve |= dict.fromkeys(
                range(max(0, k - LOWER_PLACE), min(self.restitutions.size, k - LOWER_PLACE + SLICE_COUNT))
            )
        return list(serve)

    def promised(self, points: Points, limit: float) -> tuple[Flags, BoundedResponse]:
        """Where the cubes keep to the limit (points,), and what they answer there."""
        found = np.zeros(points.slenderness.size, FOUND_RECORD)
        lower, on_level = slice_index(self.restitutions, points.restitution)
        for label, index in _parts(np.where(lower < 0, -1, 2 * lower + on_level)):
            serving = self._around(*divmod(label, 2)) if label >= 0 else None
            if serving is not None:
                part = found[index]
                _interpolate(*serving, points[index], part)
                found[index] = part
        bound = np.where(found["overturned"], 0.0, SAFETY * found["error"] + SOLVER_ERROR)
        # a safe block passes alpha exactly if its peak does; a peak within its bound of alpha leaves that open
        open_ = ~found["overturned"] & (np.abs(found["peak"] - 1.0) <= bound)
        known = found["known"] & (bound <= limit) & ~open_
        kept, bound = found[known], bound[known]
        standing = ~kept["overturned"]
        return known, BoundedResponse(
            np.where(standing, np.maximum(kept["peak"], 0.0), np.nan),
            kept["outcome"],
            kept["impacts"],
            ~standing | (kept["peak"] > 1.0),
            np.where(standing, bound, np.nan),
            np.full(kept.size, "cube"),
        )

    def _around(self, k: int, on_level: int) -> tuple[list[CubeSlice], Flags] | None:
        """`SLICE_COUNT` cubes, the k-th in place `LOWER_PLACE`, and which of them exist; the others repeat the k-th.

        A gap needs those next to it that were made together: the errors between restitutions were measured with them.
        """
        own = self.level(k)
        if own is None:
            return None
        levels, usable = [own] * SLICE_COUNT, np.zeros(SLICE_COUNT, dtype=np.bool_)
        usable[LOWER_PLACE] = True
        if not on_level:
            for places, step in ((range(LOWER_PLACE + 1, SLICE_COUNT), 1), (range(LOWER_PLACE - 1, -1, -1), -1)):
                for place in places:
                    index, last = k + place - LOWER_PLACE, levels[place - step]
                    one = self.level(index) if 0 <= index < self.restitutions.size else None
                    if one is None or not one.fits(own):
                        break
                    below, above = (last, one) if step > 0 else (one, last)
                    if below.next_restitution != above.restitution:
                        break
                    levels[place], usable[place] = one, True
        return levels, usable

    def _refuse(self, point: Points, limit: float) -> None:
        """Say why the cubes cannot answer a point."""
        s, w, eta, alpha = (float(getattr(point, name)[0]) for name in point.__dataclass_fields__)
        etas = self.restitutions
        if not etas.size or not etas[0] <= eta <= etas[-1]:
            allowed = f"[{etas[0]:.2f}, {etas[-1]:.2f}]" if etas.size else "one with a cube"
            raise OutsideCubeError("restitution", eta, f"{allowed}, or method auto")
        level = self.level(int(np.argmin(np.abs(etas - eta))))
        if level is None:
            raise OutsideCubeError("restitution", eta, "one with a cube that can be read, or method auto")
        axes = (("slenderness", s, "-"), ("frequency_ratio", w, "-"), ("alpha", alpha, "rad"))
        for name, value, unit in axes:
            axis = getattr(level, name)
            if not axis[0] <= value <= axis[-1]:
                allowed = f"[{axis[0]:g}, {axis[-1]:g}] [{unit}]" if axis.size > 1 else f"{axis[0]:g} [{unit}]"
                raise OutsideCubeError(name, value, f"{allowed} in this cube, or method auto")
        where = f"at slenderness {s:g}, frequency_ratio {w:g}"
        known, part = self.promised(point, np.inf)
        if known[0] and part.error_bound[0] > limit:
            bound = float(part.error_bound[0])
            raise OutsideCubeError("tolerance", limit, f"at least {bound:.3g} {where} in this cube, or method auto")
        why = "where fates or modes of response meet, or the levels of restitution or alpha are too far apart"
        raise OutsideCubeError("method", "cube", f"auto or solver {where}, {why}")


def _parts(labels: NDArray[np.intp]) -> Iterator[tuple[int, Index]]:
    """Each label and where it stands: everywhere, as a rule."""
    if labels.size and (labels == labels[0]).all():
        yield int(labels[0]), slice(None)
    else:
        for label in np.unique(labels):
            yield int(label), np.flatnonzero(labels == label)


def _interpolate(levels: list[CubeSlice], usable: Flags, points: Points, found: NDArray[np.void]) -> None:
    """Fill `found` (points,) from `SLICE_COUNT` cubes, for restitutions that lie in one gap, or are one level."""
    own = levels[LOWER_PLACE]
    angle_level, on_angle = slice_index(own.alpha, points.alpha)
    interpolate_many(
        cell_index(own.slenderness, points.slenderness),
        cell_index(own.frequency_ratio, points.frequency_ratio),
        points.slenderness,
        np.log(points.frequency_ratio),
        own.mesh,
        points.restitution,
        bool(points.restitution[0] == own.restitution),
        np.array([level.restitution for level in levels]),
        usable,
        angle_level,
        on_angle,
        points.alpha**2,  # the equation of motion knows the sign of alpha only in its square
        own.alpha**2,
        _Fields(*(tuple(getattr(level, name) for level in levels) for name in FIELDS)),
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
