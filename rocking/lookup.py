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
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rocking.bounded_response import SOLVER_ERROR, BoundedResponse, solve_with_bound
from rocking.errors import InvalidArgumentError, OutsideCubeError, in_range, one_of
from rocking.interpolation import cell_of, level_weights
from rocking.lookup_kernel import interpolate_many
from rocking.lookup_level import FIELDS, Level

Method = Literal["auto", "cube", "solver"]
METHODS: tuple[str, ...] = get_args(Method)

SAFETY = 8.0
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


@dataclass(frozen=True)
class Points:
    """Questions, all arrays (points,); alpha in rad, 0 the slender limit."""

    slenderness: Array
    frequency_ratio: Array
    restitution: Array
    alpha: Array

    @classmethod
    def of(
        cls, slenderness: ArrayLike, frequency_ratio: ArrayLike, restitution: ArrayLike, alpha: ArrayLike | None
    ) -> tuple[Points, tuple[int, ...]]:
        """Checked, broadcast and flattened; and the broadcast shape.

        Raises
        ------
        InvalidArgumentError
            If a value is out of range, or the shapes do not broadcast.
        """
        groups = (
            in_range("slenderness", slenderness, 0.0, np.inf, closed="neither"),
            in_range("frequency_ratio", frequency_ratio, 0.0, np.inf, closed="neither"),
            in_range("restitution", restitution, 0.0, 1.0),
            in_range("alpha", 0.0 if alpha is None else alpha, 0.0, np.pi / 2, closed="left", unit="rad"),
        )
        try:
            full = np.broadcast_arrays(*groups)
        except ValueError:
            shapes = tuple(group.shape for group in groups)
            names = "slenderness, frequency_ratio, restitution, alpha"
            raise InvalidArgumentError(names, shapes, "shapes that broadcast against each other") from None
        return cls(*(np.ascontiguousarray(group).ravel() for group in full)), full[0].shape

    def __getitem__(self, index: Any) -> Points:
        return Points(*(getattr(self, name)[index] for name in self.__dataclass_fields__))


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
        _, first, weights = level_weights(self.restitutions, restitution)
        points, offset = np.nonzero(weights)
        return [int(k) for k in np.flatnonzero(np.bincount(first[points] + offset))]

    def promised(self, points: Points, limit: float) -> tuple[Flags, BoundedResponse]:
        """Where the cubes keep to the limit (points,), and what they answer there."""
        found = np.zeros(points.slenderness.size, FOUND)
        for index, levels, gap, weights in self._groups(points.restitution):
            _interpolate(levels, points[index], gap, weights, found, index)
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

    def _groups(self, restitution: Array) -> Iterator[tuple[NDArray[np.intp], list[Level], NDArray[np.intp], Array]]:
        """Points that the same four cubes serve: which, the cubes, the gap among them, their weights."""
        etas = self.restitutions
        inside = (
            np.flatnonzero((restitution >= etas[0]) & (restitution <= etas[-1])) if etas.size else np.array([], int)
        )
        gap, first, weights = level_weights(etas, restitution[inside])
        between = gap >= 0
        group = 2 * first + between
        for start, several in (divmod(int(one), 2) for one in np.unique(group)):
            mine = group == 2 * start + several
            opened = [self.level(start + k) for k in range(min(4, etas.size - start) if several else 1)]
            levels = [one for one in opened if one is not None]
            whole = len(levels) == len(opened) and all(one.fits(levels[0]) for one in levels)
            # the errors between restitutions were measured with these neighbours
            if whole and all(one.next_restitution == etas[start + k + 1] for k, one in enumerate(levels[:-1])):
                local = np.where(gap[mine] >= 0, gap[mine] - start, -1)
                yield inside[mine], levels + levels[-1:] * (4 - len(levels)), local, weights[mine]

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
        raise OutsideCubeError("method", "cube", f"auto or solver {where}, where fates or modes of response meet")


def _interpolate(
    levels: list[Level],
    points: Points,
    gap: NDArray[np.intp],
    weights: Array,
    found: NDArray[np.void],
    index: NDArray[np.intp],
) -> None:
    """Fill `found[index]` from four cubes."""
    first = levels[0]
    squares = first.alpha**2  # the equation of motion knows the sign of alpha only in its square
    inside = (points.alpha >= first.alpha[0]) & (points.alpha <= first.alpha[-1])
    angle_gap, angle_first, angle_weights = level_weights(squares, np.where(inside, points.alpha, first.alpha[0]) ** 2)
    part = np.zeros(index.size, FOUND)
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
        part,
    )
    found[index] = part


def _solve(pulse: str, points: Points) -> BoundedResponse:
    return solve_with_bound(
        pulse,
        slenderness=points.slenderness,
        frequency_ratio=points.frequency_ratio,
        restitution=points.restitution,
        alpha=points.alpha,
    )
