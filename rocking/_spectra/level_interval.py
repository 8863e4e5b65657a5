"""Interpolation in the interval between two adjacent slices of restitution or of slenderness angle.

Every cell of an interval is interpolated from the same slices (`slice_window`). Cells in which these slices differ in
kind, because an overturning boundary moves through them, are not interpolated.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rocking._base.arrays import Array
from rocking._interpolation.slices import slice_window
from rocking._interpolation.stencils import SQUARED, lagrange_weight
from rocking._spectra.layer import UNKNOWN, Cells, GridLayer, peak_of


@dataclass(frozen=True, eq=False)
class LevelInterval:
    """An interval between two slices, and the layers from which it is interpolated."""

    layers: Sequence[GridLayer]  # the layers of the slice window
    levels: Array  # their restitutions [-] or angles [rad]
    power: int  # power of the restitution or angle that is the variable of interpolation
    lower: int  # index of the lower slice of the interval, among all slices
    bounds: tuple[float, float]  # ends of the interval [-] or [rad]
    kind: NDArray[np.int64]  # (n - 1, m - 1) `GridLayer.kinds` of the cells, `UNKNOWN` where the layers differ in it
    # (n - 1, m - 1) whether the mode of the peak changes between the two slices, at a corner of the cell: the peak has
    # a crease
    creased: NDArray[np.bool_]

    @classmethod
    def of(
        cls, layers: Sequence[GridLayer], kinds: Sequence[NDArray[np.int64]], levels: Array, power: int, lower: int
    ) -> LevelInterval:
        """The interval above slice `lower` of all layers; `kinds`, `levels`: of each layer."""
        first, size = slice_window(len(layers), lower)
        window = slice(first, first + size)
        kind = np.where(np.all([one == kinds[lower] for one in kinds[window]], axis=0), kinds[lower], UNKNOWN)
        bounds = float(levels[lower]), float(levels[lower + 1])
        change = layers[lower].peak_mode != layers[lower + 1].peak_mode
        creased = change[:-1, :-1] | change[1:, :-1] | change[:-1, 1:] | change[1:, 1:]
        return cls(layers[window], levels[window], power, lower, bounds, kind, creased)

    def level(self, share: float) -> float:
        """The restitution [-] or angle [rad] at a share of the interval [-]."""
        low, high = self.bounds
        return low + share * (high - low)

    def errors(self, share: float, cells: Cells, place: tuple[float, float], peak: Array) -> Array:
        """Absolute errors [-] at a share of the interval, in cells in which all blocks survive.

        `cells`: rows and columns; `place`: the point in each cell, as fractions of it; `peak` (cells,): peaks of the
        solver there, nan where a block overturns.
        """
        x, levels = self.level(share) ** self.power, self.levels**self.power
        weights = [lagrange_weight(levels, 0, levels.size, k, x) for k in range(levels.size)]
        found = [(layer.at(cells, place), layer.stencil[cells] == SQUARED) for layer in self.layers]
        squared = np.all([form for _, form in found], axis=0)
        # (1 - peak)^2 is interpolated where all layers have it, else the peak
        of_form = np.sum([w * value for w, (value, _) in zip(weights, found, strict=True)], axis=0)
        of_peak = np.sum([w * peak_of(*one) for w, one in zip(weights, found, strict=True)], axis=0)
        return np.asarray(np.abs(np.where(squared, peak_of(of_form, squared), of_peak) - peak))
