"""One layer of a cube, all blocks of one restitution and one slenderness angle, and how well it interpolates.

Where a safe block's peak is reached in free rocking it goes like 1 - sqrt(E) with a smooth E = (1 - peak)^2, which
vanishes on the boundary of overturning: there E is interpolated, elsewhere the peak itself.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rocking.cube import NO_STENCIL, OVERTURNS, SQUARED
from rocking.interpolation import interpolate, level_weights, stencils
from rocking.response import Outcome, Response

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

CENTRE = (0.5, 0.5)

PROBES = (CENTRE, (0.2, 0.2), (0.2, 0.8), (0.8, 0.2), (0.8, 0.8))
"""Rows and columns within a cell where interpolation is compared with the solver; the middle is the worst place of a
smooth function, the others catch what happens near the corners [-]."""


FEW_IMPACTS = 1
"""Impacts up to which the ways of overturning fill regions with boundaries that are traced one by one."""


@dataclass(frozen=True)
class Layer:
    """Nodes (n, m) and cells (n - 1, m - 1) of one restitution and one angle; fields as in `cube`."""

    peak_rotation: Array
    outcome: NDArray[np.int8]
    impacts: NDArray[np.int32]
    exceeded_alpha: Flags
    peak_mode: NDArray[np.int32]
    stencil: NDArray[np.int8]

    @classmethod
    def of(cls, nodes: Response, k: int, barred: Flags | None) -> Layer:
        """The k-th restitution of solved nodes (n, m, restitutions); `barred` cells (n - 1, m - 1) are not used."""
        outcome, impacts, mode = nodes.outcome[..., k], nodes.impacts[..., k], nodes.peak_mode[..., k]
        safe = outcome == Outcome.SAFE
        squared = stencils(safe & (mode % 2 == 1))
        codes = np.where(squared >= 0, squared + SQUARED, stencils(safe))
        codes = np.where(_overturn_alike(fate_codes(outcome, impacts), impacts), OVERTURNS, codes)
        if barred is not None:
            codes[barred] = NO_STENCIL
        return cls(
            nodes.peak_rotation[..., k], outcome, impacts, nodes.exceeded_alpha[..., k], mode, codes.astype(np.int8)
        )

    @property
    def smooth(self) -> Flags:
        """Cells that are interpolated."""
        return (self.stencil >= 0) & (self.stencil < OVERTURNS)

    def at(self, cells: tuple[NDArray[np.intp], ...], place: tuple[float, float]) -> Array:
        """What is interpolated, E or the peak, at one place within each of some smooth cells."""
        codes = self.stencil[cells]
        values, squared = np.empty(codes.size), codes >= SQUARED
        for form, tabled in ((squared, (1.0 - self.peak_rotation) ** 2), (~squared, self.peak_rotation)):
            chosen = cells[0][form], cells[1][form]
            values[form] = interpolate(tabled, chosen, codes[form] % SQUARED, place)
        return values

    def kinds(self) -> NDArray[np.int64]:
        """What is known of each cell: 0 nothing, 1 a peak, 2 a peak by E, below 0 the way in which it overturns."""
        forms = np.where(self.smooth, 1 + (self.stencil >= SQUARED), 0)
        ways = fate_codes(self.outcome, self.impacts)[:-1, :-1]
        return np.where(self.stencil == OVERTURNS, ways, forms)


def fate_codes(outcome: NDArray[np.int8], impacts: NDArray[np.int32]) -> NDArray[np.int64]:
    """1 where the block stands, else a number below 0 for the way in which it overturns."""
    return np.where(outcome >= Outcome.OVERTURNED_DIRECTLY, -(4 * impacts.astype(np.int64) + outcome), 1)


def peak_of(value: Array, squared: Flags) -> Array:
    """The peak from what is interpolated."""
    return np.where(squared, 1.0 - np.sqrt(np.maximum(value, 0.0)), value)


def cell_error(layer: Layer, cells: tuple[NDArray[np.intp], ...], place: tuple[float, float], truth: Array) -> Array:
    """|interpolated - true| at one place of each of some smooth cells; nan where the block overturns there."""
    return np.abs(peak_of(layer.at(cells, place), layer.stencil[cells] >= SQUARED) - truth)


def gap_error(layers: Sequence[Layer], levels: Array, level: float, peak: Array, fate: NDArray[np.int64]) -> Array:
    """Error at the centres of all cells of interpolating between levels of restitution or alpha.

    Parameters
    ----------
    layers : sequence of Layer
        One for each level.
    levels : float array
        Ascending.
    level : float
        Where to interpolate.
    peak, fate : arrays (n - 1, m - 1)
        The solver's peak there, and its fate as `fate_codes`.

    Returns
    -------
    float array (n - 1, m - 1)
        nan where it cannot be interpolated: not everywhere the same form, or overturning in the same way.
    """
    _, first, weights = level_weights(levels, level)
    used = [layers[int(first) + k] for k in range(weights.size) if weights[k] != 0.0]
    kinds = [layer.kinds() for layer in used]
    kind = np.where(np.all([other == kinds[0] for other in kinds], axis=0), kinds[0], 0)
    error = np.where((kind < 0) & (fate == kind), 0.0, np.nan)
    cells = np.nonzero((kind > 0) & (fate == 1))
    value = sum(weight * layer.at(cells, CENTRE) for weight, layer in zip(weights, used, strict=False))
    error[cells] = np.abs(peak_of(np.asarray(value), kind[cells] == 2) - peak[cells])
    return error


def _overturn_alike(ways: NDArray[np.int64], impacts: NDArray[np.int32]) -> Flags:
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
