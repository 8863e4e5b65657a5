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

from rocking.bounded_response import SOLVER_ERROR, BoundedResponse, solve_with_bound
from rocking.errors import InvalidArgumentError, OutsideCubeError, in_range, one_of
from rocking.interpolation import cell_of
from rocking.lookup_kernel import interpolate_many
from rocking.lookup_level import FIELDS, Level
from rocking.lookup_points import Points
from rocking.lookup_weights import weights_on

Method = Literal["auto", "cube", "solver"]
METHODS: tuple[str, ...] = get_args(Method)

SAFETY = 6.0
"""Factor from the measured errors to the error bound [-]: the probes are five points of a cell, not all."""

FOUND = np.dtype(
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
    level: Callable[[int], Level | None]

    def response(
        self,
        *,
        slenderness: ArrayLike,
        frequency_ratio: ArrayLike,
        restitution: ArrayLike | None = None,
        alpha: ArrayLike | None = None,
        tolerance: float = 1e-4,
        method: str = "auto",
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
            answer.put(left, _solve(self.pulse, points[left]))
        return answer.reshape(shape)

    def used(self, restitution: Array) -> list[int]:
        """Indices of the cubes that serve some of the restitutions."""
        _, first, weights = weights_on(self.restitutions, restitution)
        points, offset = np.nonzero(weights)
        return [int(k) for k in np.flatnonzero(np.bincount(first[points] + offset))]

    def promised(self, points: Points, limit: float) -> tuple[Flags, BoundedResponse]:
        """Where the cubes keep to the limit (points,), and what they answer there."""
        found = np.zeros(points.slenderness.size, FOUND)
        for index, levels, gap, weights in self._groups(points.restitution):
            part = found[index]
            _interpolate(levels, points[index], gap, weights, part)
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

    def _groups(self, restitution: Array) -> Iterator[tuple[Index, list[Level], NDArray[np.intp], Array]]:
        """Points that the same four cubes serve: which, the cubes, the gap among them, their weights."""
        etas = self.restitutions
        if not etas.size:
            return
        inside = (restitution >= etas[0]) & (restitution <= etas[-1])
        gap, first, weights = weights_on(etas, np.where(inside, restitution, etas[0]))
        for label, index in _parts(np.where(inside, 2 * first + (gap >= 0), -1)):
            start, several = divmod(label, 2)
            levels = self._serving(start, min(4, etas.size - start) if several else 1) if label >= 0 else []
            if levels:
                yield index, levels, gap[index] - start, weights[index]  # on a level the gap stays negative

    def _serving(self, start: int, count: int) -> list[Level]:
        """The cubes from `start` on, the last one repeated to make four; none if they do not belong together."""
        opened = [self.level(start + k) for k in range(count)]
        levels = [one for one in opened if one is not None]
        whole = len(levels) == count and all(one.fits(levels[0]) for one in levels[1:])
        # the errors between restitutions were measured with these neighbours
        etas = self.restitutions[start + 1 :]
        if whole and all(one.next_restitution == eta for one, eta in zip(levels[:-1], etas, strict=False)):
            return levels + levels[-1:] * (4 - count)
        return []

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


def _interpolate(
    levels: list[Level], points: Points, gap: NDArray[np.intp], weights: Array, found: NDArray[np.void]
) -> None:
    """Fill `found` (points,) from four cubes."""
    first = levels[0]
    squares = first.alpha**2  # the equation of motion knows the sign of alpha only in its square
    inside = (points.alpha >= first.alpha[0]) & (points.alpha <= first.alpha[-1])
    angle_gap, angle_first, angle_weights = weights_on(squares, np.where(inside, points.alpha, first.alpha[0]) ** 2)
    interpolate_many(
        cell_of(first.slenderness, points.slenderness),
        cell_of(first.frequency_ratio, points.frequency_ratio),
        points.slenderness,
        np.log(points.frequency_ratio),
        first.mesh,
        gap,
        weights,
        angle_gap,
        np.where(inside, angle_first, -1),
        angle_weights,
        _Fields(*(tuple(getattr(level, name) for level in levels) for name in FIELDS)),
        found,
    )


def _solve(pulse: str, points: Points) -> BoundedResponse:
    return solve_with_bound(
        pulse,
        slenderness=points.slenderness,
        frequency_ratio=points.frequency_ratio,
        restitution=points.restitution,
        alpha=points.alpha,
    )
