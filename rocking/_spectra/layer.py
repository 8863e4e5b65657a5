"""One layer of a cube: all blocks of one restitution and one slenderness angle, and how its cells are interpolated.

Where the peak of a block that survives is reached in free rocking, it behaves like 1 - sqrt(E) with a smooth
E = (1 - peak)^2 that vanishes on the overturning boundary. E is interpolated there, the peak itself elsewhere.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from rocking._base.arrays import Array, Flags
from rocking._interpolation.stencils import (
    NO_STENCIL,
    OVERTURNS,
    PEAK,
    SQUARED,
    Mesh,
    interpolate_cells,
    interpolated_cells,
)
from rocking._model.fields import CUBE_FIELDS, IMPACTS, OUTCOME, PEAK_MODE
from rocking._model.outcome import SURVIVES, outcome_codes
from rocking._model.response import Outcome, Response
from rocking._numba.compilation import contiguous_array

Cells = tuple[NDArray[np.intp], ...]

CELL_CENTRE = (0.5, 0.5)

UNKNOWN = -1  # kind of a cell that is not interpolated

DIRECT = int(Outcome.OVERTURNED_DIRECTLY)
"""Kind of a cell in which all blocks overturn without impact: they do so for every restitution."""

FEW_IMPACTS = 1
"""Regions of overturning after at most so many impacts have boundaries that are traced one by one."""


@dataclass(frozen=True, eq=False)
class GridLayer:
    """Nodes (n, m) and cells (n - 1, m - 1) of one restitution and one angle; fields as in `rocking._datasets.cube`.

    `derived` holds the derived fields that are stored too.
    """

    mesh: Mesh
    peak_rotation: Array
    outcome: NDArray[np.int8]
    impacts: NDArray[np.int32]
    exceeded_alpha: Flags
    peak_mode: NDArray[np.int32]
    stencil: NDArray[np.int8]
    derived: Mapping[str, Array] = field(default_factory=dict)

    @classmethod
    def of(
        cls, mesh: Mesh, nodes: Response, k: int, barred: Flags | None, derived: Mapping[str, Array] | None = None
    ) -> GridLayer:
        """The k-th restitution of solved nodes (n, m, restitutions); cells `barred` (n - 1, m - 1) have no stencil.

        `derived` are fields of the nodes that are stored too. The fields are copied: views would keep all fields of all
        restitutions in memory.
        """
        stored: dict[str, NDArray[Any]] = {
            one.name: np.ascontiguousarray(getattr(nodes, one.name)[..., k]) for one in CUBE_FIELDS
        }
        outcome, impacts, mode = (stored[one.name] for one in (OUTCOME, IMPACTS, PEAK_MODE))
        # each form where all 16 nodes of a cell allow it: the peak if they survive; (1 - peak)^2 if all peaks are of
        # free rocking; the outcome where all nodes overturn alike
        survives = outcome == Outcome.RECOVERS
        codes = np.where(interpolated_cells(survives), PEAK, NO_STENCIL)
        codes = np.where(interpolated_cells(survives & (mode % 2 == 1)), SQUARED, codes)
        codes = np.where(_same_overturning(outcome_codes(outcome, impacts), impacts), OVERTURNS, codes)
        if barred is not None:
            codes[barred] = NO_STENCIL
        further = {name: np.ascontiguousarray(values[..., k]) for name, values in (derived or {}).items()}
        return cls(mesh=mesh, **stored, stencil=codes.astype(np.int8), derived=further)

    @classmethod
    def stored(cls, mesh: Mesh, cube: xr.Dataset) -> GridLayer:
        """The layer that a spectrum cube stores at one angle."""
        stored: dict[str, Any] = {one.name: contiguous_array(cube[one.name].values) for one in CUBE_FIELDS}
        return cls(mesh=mesh, **stored, stencil=contiguous_array(cube["stencil"].values[:-1, :-1]))

    @property
    def smooth(self) -> Flags:
        """Cells in which the peak is interpolated."""
        return np.asarray((self.stencil == PEAK) | (self.stencil == SQUARED))

    def at(self, cells: Cells, place: tuple[float, float]) -> Array:
        """The interpolated variable, E or the peak [-], at one point of each of some smooth cells."""
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
        """The interpolated peak [-] at one point of each of some smooth cells."""
        return peak_of(self.at(cells, place), self.stencil[cells] == SQUARED)

    def kinds(self) -> NDArray[np.int64]:
        """Kind of each cell: the code of its outcome (`rocking._model.outcome`), or `UNKNOWN`."""
        codes = outcome_codes(self.outcome, self.impacts)[:-1, :-1]
        return np.where(self.stencil == OVERTURNS, codes, np.where(self.smooth, SURVIVES, UNKNOWN))


def peak_of(value: Array, squared: Flags) -> Array:
    """The peak [-] from the interpolated variable."""
    return np.where(squared, 1.0 - np.sqrt(np.maximum(value, 0.0)), value)


def largest_in_neighbourhood(errors: Array) -> Array:
    """The largest of the errors (..., n, m) of each cell and the eight cells around it; nan stays nan, and only there.

    A crease of the peak that only cuts a corner of a cell shows at the probe points of its neighbours.
    """
    n, m = errors.shape[-2:]
    outside = [(0, 0)] * (errors.ndim - 2) + [(1, 1), (1, 1)]
    around = np.pad(errors, outside, constant_values=np.nan)
    largest = errors.copy()
    for i in range(3):
        for j in range(3):
            np.fmax(largest, around[..., i : i + n, j : j + m], out=largest, where=~np.isnan(errors))
    return largest


def _same_overturning(ways: NDArray[np.int64], impacts: NDArray[np.int32]) -> Flags:
    """Cells whose four corners overturn in the same way; after several impacts, the twelve nodes around them as well.

    Where regions of overturning after many impacts meet, they form layers with surviving bands between them that are
    narrower than a cell.
    """
    n, m = ways.shape
    around = np.pad(ways, 1, mode="edge")
    most = np.zeros((n - 1, m - 1), dtype=np.int32)
    alike, uniform = ways[:-1, :-1] != SURVIVES, np.ones((n - 1, m - 1), dtype=np.bool_)
    padded = np.pad(impacts, 1, mode="edge")
    for i in range(4):
        for j in range(4):
            same = around[i : i + n - 1, j : j + m - 1] == ways[:-1, :-1]
            uniform &= same
            most = np.maximum(most, padded[i : i + n - 1, j : j + m - 1])
            if i in (1, 2) and j in (1, 2):
                alike = alike & same
    return np.asarray(alike & (uniform | (most <= FEW_IMPACTS)))
