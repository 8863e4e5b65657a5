"""One layer of a cube, all blocks of one restitution and one slenderness angle, and how well it interpolates.

Where a safe block's peak is reached in free rocking it goes like 1 - sqrt(E) with a smooth E = (1 - peak)^2, which
vanishes on the boundary of overturning: there E is interpolated, elsewhere the peak itself.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rocking._numba.compilation import contiguous_array
from rocking.interpolation.selection import interpolate_cells
from rocking.interpolation.stencils import NO_STENCIL, OVERTURNS, SQUARED, Mesh, first_valid_stencils
from rocking.model.response import Outcome, Response

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
Cells = tuple[NDArray[np.intp], ...]

CELL_CENTRE = (0.5, 0.5)

DIRECT = -int(Outcome.OVERTURNED_DIRECTLY)
"""Kind of a cell in which all overturn without an impact: they do so for every restitution."""

FEW_IMPACTS = 1
"""Impacts up to which the ways of overturning fill regions with boundaries that are traced one by one."""


@dataclass(frozen=True)
class GridLayer:
    """Nodes (n, m) and cells (n - 1, m - 1) of one restitution and one angle; fields as in `cube`."""

    mesh: Mesh
    peak_rotation: Array
    outcome: NDArray[np.int8]
    impacts: NDArray[np.int32]
    exceeded_alpha: Flags
    peak_mode: NDArray[np.int32]
    stencil: NDArray[np.int8]

    @classmethod
    def of(cls, mesh: Mesh, nodes: Response, k: int, barred: Flags | None) -> GridLayer:
        """The k-th restitution of solved nodes (n, m, restitutions); `barred` cells (n - 1, m - 1) are not used."""
        outcome, impacts, mode = nodes.outcome[..., k], nodes.impacts[..., k], nodes.peak_mode[..., k]
        safe = outcome == Outcome.SAFE
        squared = first_valid_stencils(safe & (mode % 2 == 1))
        codes = np.where(squared >= 0, squared + SQUARED, first_valid_stencils(safe))
        codes = np.where(_same_overturning(outcome_codes(outcome, impacts), impacts), OVERTURNS, codes)
        if barred is not None:
            codes[barred] = NO_STENCIL
        peak = np.ascontiguousarray(nodes.peak_rotation[..., k])
        return cls(mesh, peak, outcome, impacts, nodes.exceeded_alpha[..., k], mode, codes.astype(np.int8))

    @property
    def smooth(self) -> Flags:
        """Cells that are interpolated."""
        return (self.stencil >= 0) & (self.stencil < OVERTURNS)

    def at(self, cells: Cells, place: tuple[float, float]) -> Array:
        """What is interpolated, E or the peak, at one place within each of some smooth cells."""
        values = np.empty(cells[0].size)
        interpolate_cells(
            self.peak_rotation,
            *map(contiguous_array, cells),
            self.stencil[cells],
            *self.mesh.within(cells, place),
            self.mesh,
            values,
        )
        return values

    def peak_at(self, cells: Cells, place: tuple[float, float]) -> Array:
        """The interpolated peak at one place within each of some smooth cells."""
        return peak_of(self.at(cells, place), self.stencil[cells] >= SQUARED)

    def kinds(self) -> NDArray[np.int64]:
        """What is known of each cell: 0 nothing, 1 a peak, below 0 the way in which it overturns."""
        ways = outcome_codes(self.outcome, self.impacts)[:-1, :-1]
        return np.where(self.stencil == OVERTURNS, ways, self.smooth.astype(np.int64))


def outcome_codes(outcome: NDArray[np.int8], impacts: NDArray[np.int32]) -> NDArray[np.int64]:
    """1 where the block stands, else a number below 0 for the way in which it overturns."""
    return np.where(outcome >= Outcome.OVERTURNED_DIRECTLY, -(4 * impacts.astype(np.int64) + outcome), 1)


def peak_of(value: Array, squared: Flags) -> Array:
    """The peak from what is interpolated."""
    return np.where(squared, 1.0 - np.sqrt(np.maximum(value, 0.0)), value)


def largest_in_neighbourhood(errors: Array, share: float = 1.0) -> Array:
    """The largest of the errors (..., n, m) of a cell and a share of those of the eight around it.

    nan stays nan, and only there. A crease of the peak that only cuts a corner of a cell passes the points of its
    neighbours.
    """
    n, m = errors.shape[-2:]
    outside = [(0, 0)] * (errors.ndim - 2) + [(1, 1), (1, 1)]
    around = np.pad(share * errors, outside, constant_values=np.nan)
    largest = errors.copy()
    for i in range(3):
        for j in range(3):
            np.fmax(largest, around[..., i : i + n, j : j + m], out=largest, where=~np.isnan(errors))
    return largest


def _same_overturning(ways: NDArray[np.int64], impacts: NDArray[np.int32]) -> Flags:
    """Cells whose four corners overturn in one way, and the twelve nodes around them too if any has several impacts.

    Where the ways of many impacts meet they lie in layers, with safe bands between them that are thinner than a cell.
    """
    n, m = ways.shape
    around = np.pad(ways, 1, mode="edge")
    most = np.zeros((n - 1, m - 1), dtype=np.int32)
    alike, uniform = ways[:-1, :-1] < 0, np.ones((n - 1, m - 1), dtype=np.bool_)
    padded = np.pad(impacts, 1, mode="edge")
    for i in range(4):
        for j in range(4):
            same = around[i : i + n - 1, j : j + m - 1] == ways[:-1, :-1]
            uniform &= same
            most = np.maximum(most, padded[i : i + n - 1, j : j + m - 1])
            if i in (1, 2) and j in (1, 2):
                alike = alike & same
    return np.asarray(alike & (uniform | (most <= FEW_IMPACTS)))
