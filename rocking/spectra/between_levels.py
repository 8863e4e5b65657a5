"""The gap between two levels of restitution or of alpha: which levels serve each cell of it, and how well.

Boundaries of overturning and creases of the peak move with both. Four levels around a gap need not lie on one side of
them; four others, or three or two, may. As with the stencils within a level, the solver's word decides.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rocking.interpolation.stencils import NO_STENCIL, SLICE_STENCILS, SQUARED, STENCIL_SIZE, lagrange_weight
from rocking.spectra.layer import Cells, GridLayer, peak_of

Array = NDArray[np.float64]
ProbePoint = tuple[tuple[float, float], float]
Probe = tuple[ProbePoint, Array]
"""Where in the cells and how far into the gap, and the solver's peak there for each of some cells."""


@dataclass(frozen=True)
class LevelInterval:
    """A gap and the layers around it.

    Attributes
    ----------
    layers : sequence of Layer
        All of them, at ascending levels.
    levels : float array
        Restitutions [-] or angles [rad].
    power : int
        Of the levels, in which they are interpolated.
    lower : int
        The layer below the gap.
    kind : int array (n - 1, m - 1)
        What is known of each cell on both sides of the gap, as `GridLayer.kinds`; 0 also where these differ.
    serves : bool array (choices, n - 1, m - 1)
        For each of `interpolation.SLICE_STENCILS`: whether these layers exist and are all of that kind.
    choice : int8 array (n - 1, m - 1)
        The index of the levels that serve, -1 where none do.
    """

    layers: Sequence[GridLayer]
    levels: Array
    power: int
    lower: int
    kind: NDArray[np.int64]
    serves: NDArray[np.bool_]
    choice: NDArray[np.int8]

    @classmethod
    def of(
        cls, layers: Sequence[GridLayer], kinds: Sequence[NDArray[np.int64]], levels: Array, power: int, lower: int
    ) -> LevelInterval:
        """Of all layers, whose kinds are known."""
        kind = np.where(kinds[lower] == kinds[lower + 1], kinds[lower], 0)
        serves = np.zeros((len(SLICE_STENCILS), *kind.shape), dtype=np.bool_)
        for code, (count, below) in enumerate(SLICE_STENCILS):
            first = lower - below
            if first >= 0 and first + count <= len(layers):
                serves[code] = (kind != 0) & np.all([one == kind for one in kinds[first : first + count]], axis=0)
            if count < min(STENCIL_SIZE, len(layers)):
                serves[code] &= kind > 0  # no fate is told from fewer
        choice = np.where(serves.any(axis=0), serves.argmax(axis=0), NO_STENCIL).astype(np.int8)
        return cls(layers, levels, power, lower, np.where(choice >= 0, kind, 0), serves, choice)

    def at(self, share: float) -> float:
        """The restitution [-] or the angle [rad] at a share of the gap."""
        low, high = self.levels[self.lower : self.lower + 2]
        return float(low + share * (high - low))

    def errors(self, cells: Cells, probe: Probe) -> Array:
        """Errors of what is chosen for some cells in which all blocks stand."""
        errors = np.empty(cells[0].size)
        for code in np.unique(self.choice[cells]):
            mine = self.choice[cells] == code
            errors[mine] = self._errors(int(code), (cells[0][mine], cells[1][mine]), probe[0], probe[1][mine])
        return errors

    def choose(self, cells: Cells, probes: Sequence[Probe]) -> Array:
        """Give such cells the levels whose largest error at some probes is least; that error, inf if none serve."""
        least = np.full(cells[0].size, np.inf)
        for code in range(len(SLICE_STENCILS)):
            mine = np.flatnonzero(self.serves[code][cells])
            if not mine.size:
                continue  # there may be no such layers
            own = cells[0][mine], cells[1][mine]
            found = [self._errors(code, own, place, peak[mine]) for place, peak in probes]
            largest = np.nan_to_num(np.max(found, axis=0), nan=np.inf)
            better = mine[largest < least[mine]]
            least[better] = largest[largest < least[mine]]
            self.choice[cells[0][better], cells[1][better]] = code
        return least

    def _errors(self, code: int, cells: Cells, place: ProbePoint, peak: Array) -> Array:
        (count, below), (within, share) = SLICE_STENCILS[code], place
        first, x, levels = self.lower - below, self.at(share) ** self.power, self.levels**self.power
        weights = [lagrange_weight(levels, first, count, k, x) for k in range(count)]
        found = [
            (layer.at(cells, within), layer.stencil[cells] >= SQUARED) for layer in self.layers[first : first + count]
        ]
        squared = np.all([form for _, form in found], axis=0)
        # E where all of them interpolate it, else the peaks
        of_form = np.sum([w * value for w, (value, _) in zip(weights, found, strict=True)], axis=0)
        of_peak = np.sum([w * peak_of(*one) for w, one in zip(weights, found, strict=True)], axis=0)
        return np.asarray(np.abs(np.where(squared, peak_of(of_form, squared), of_peak) - peak))
