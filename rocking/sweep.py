"""Fills spectrum cubes: the grid through the solver, then the errors of interpolating it, measured between nodes.

Several coefficients of restitution are solved together, as the first flight of a block does not depend on them.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from rocking.cube import NO_STENCIL, OVERTURNS, build_spectrum_dataset
from rocking.errors import in_range
from rocking.interpolation import Mesh
from rocking.response import Response
from rocking.solve import peak_response
from rocking.stencil_choice import choose_stencils
from rocking.sweep_layer import CENTRE, DIRECT, Cells, Gap, Layer, fate_codes, largest_around

Array = NDArray[np.float64]

PROBES = (CENTRE, (0.15, 0.35), (0.35, 0.85), (0.85, 0.65), (0.65, 0.15))
"""Rows and columns within a cell where interpolation is compared with the solver [-]. No two share a row or a column,
so that no crease along one passes between them, and errors of rows and of columns cannot cancel at all of them."""

FIRST = 2
"""Probes in every cell: the error of a smooth function has one shape along rows and one along columns."""

TAME = 1e-6
"""Error at the first probes above which the others and the other stencils are tried, there and next to it [-]."""

WORTH = 2e-4
"""Error at the first probes up to which a cell is interpolated at all [-]: what is coarser is for the solver."""

PROBE_TOLERANCE = 1e-9
"""Relative error left in the peaks with which interpolation is compared: far below the errors that matter [-]."""

APART = {"restitution": 0.1, "alpha": np.radians(25.0)}
"""Levels farther apart are not interpolated between: one look in the middle would not tell enough [-, rad]."""

TOGETHER = 11
"""Restitutions solved together: most of what sharing the first flight saves, at four times the memory of one."""


def spectrum(pulse: str, *, restitution: float, **grid: Any) -> xr.Dataset:
    """The spectrum cube of one pulse and one coefficient of restitution; the other arguments as for `spectra`."""
    return next(spectra(pulse, restitution=[restitution], **grid))


def spectra(
    pulse: str,
    *,
    restitution: ArrayLike,
    slenderness: ArrayLike,
    frequency_ratio: ArrayLike,
    alpha: ArrayLike = (0.0,),
    barred: NDArray[np.bool_] | None = None,
    threads: int | None = None,
) -> Iterator[xr.Dataset]:
    """The spectrum cubes of one pulse, one for each coefficient of restitution in turn (schema in `rocking.cube`).

    Parameters
    ----------
    pulse : str
        Name of the pulse.
    restitution : array_like, shape (l,)
        eta [-], [0, 1], ascending.
    slenderness : array_like, shape (n,), n >= 4
        1/a [-], > 0, ascending.
    frequency_ratio : array_like, shape (m,), m >= 4
        omega [-], > 0, ascending.
    alpha : array_like, shape (k,)
        Slenderness angles [rad], ascending; 0 for the slender limit.
    barred : bool array, shape (l, k, n - 1, m - 1), optional
        Cells that are not to be interpolated, as boundaries of overturning cross them (`boundary_cells`).
    threads : int, optional
        Threads of the solver; by default all cores.

    Raises
    ------
    InvalidArgumentError
        If a value is out of range.
    """
    rows = in_range("slenderness", slenderness, 0.0, np.inf, closed="neither")
    columns = in_range("frequency_ratio", frequency_ratio, 0.0, np.inf, closed="neither")
    angles = in_range("alpha", alpha, 0.0, np.pi / 2, closed="left", unit="rad")
    etas = in_range("restitution", restitution, 0.0, 1.0)
    grid = _Grid(pulse, Mesh.of(rows, columns), columns, threads)
    layers: list[list[Layer]] = [[] for _ in etas]
    errors = np.full((3, etas.size, angles.size, rows.size - 1, columns.size - 1), np.nan)
    for a, angle in enumerate(angles):
        for first in range(0, etas.size, TOGETHER):
            some = etas[first : first + TOGETHER]
            nodes = grid.nodes(some, angle)
            for k in range(some.size):
                bars = None if barred is None else barred[first + k, a]
                layers[first + k].append(Layer.of(grid.mesh, nodes, k, bars))
            made = [layers[first + k][a] for k in range(some.size)]
            errors[0, first : first + some.size, a] = grid.errors_in_cells(made, some, angle)
    lower, middles = _close(etas, APART["restitution"])
    for a, angle in enumerate(angles):
        gaps = [Gap.of([row[a] for row in layers], etas, eta) for eta in middles]
        errors[1, lower, a] = grid.errors_between(gaps, middles, angle, known=DIRECT)
    for a, angle in zip(*_close(angles, APART["alpha"]), strict=True):
        # the equation of motion knows the sign of alpha only in its square
        gaps = [Gap.of(row, angles**2, angle**2) for row in layers]
        errors[2, :, a] = grid.errors_between(gaps, etas, angle)
    axes = {"alpha": angles, "slenderness": rows, "frequency_ratio": columns}
    for k, eta in enumerate(etas):
        above = etas[k + 1] if k + 1 < etas.size else np.nan
        yield _cube(pulse, float(eta), axes, layers[k], errors[:, k]).assign_attrs(next_restitution=float(above))


def _close(levels: Array, apart: float) -> tuple[NDArray[np.intp], Array]:
    """The levels with the next one not farther than `apart` above, and the middles between these two."""
    lower = np.flatnonzero(np.diff(levels) <= apart * (1.0 + 1e-9))
    return lower, 0.5 * (levels[lower] + levels[lower + 1])


@dataclass(frozen=True)
class _Grid:
    """The pulse and the plane of control on which it is solved."""

    pulse: str
    mesh: Mesh
    columns: Array
    threads: int | None

    def nodes(self, etas: Array, angle: float) -> Response:
        """All nodes, for each restitution: shape (n, m, restitutions)."""
        return self._solve(self.mesh.rows[:, None], self.columns, etas, angle)

    def errors_between(self, gaps: Sequence[Gap], etas: Array, angle: float, known: int | None = None) -> Array:
        """Errors at the centres of cells, for each of some gaps, at whose middles the restitutions and the angle lie.

        nan where the layers of a gap differ; 0 without asking the solver where their kind is `known` to hold between.
        """
        shape = self.mesh.rows.size - 1, self.mesh.columns.size - 1
        kinds = np.array([gap.kind for gap in gaps]).reshape(len(gaps), *shape)
        errors = np.where(kinds == known, 0.0, np.nan)
        wanted = (kinds != 0) & (kinds != known)
        cells = np.nonzero(wanted.any(axis=0))
        x, y = self.mesh.within(cells, CENTRE)
        found = self._solve(x, np.exp(y), etas, angle, PROBE_TOLERANCE)
        fates = fate_codes(found.outcome, found.impacts)
        for k, gap in enumerate(gaps):
            mine = wanted[k][cells]
            own = cells[0][mine], cells[1][mine]
            errors[k][own] = gap.error(own, found.peak_rotation[mine, k], fates[mine, k])
        return errors

    def errors_in_cells(self, layers: Sequence[Layer], etas: Array, angle: float) -> Array:
        """Largest error at the probes of each cell, for each restitution; 0 where it overturns alike, or nan.

        Where it is large the layers are given the stencil that has the least.
        """
        errors = np.array([np.where(layer.stencil == OVERTURNS, 0.0, np.nan) for layer in layers])
        smooth = np.array([layer.smooth for layer in layers])
        cells = np.nonzero(smooth.any(axis=0))
        peaks = self._probe(PROBES[:FIRST], cells, etas, angle)
        for k, layer in enumerate(layers):
            mine = smooth[k][cells]
            own = cells[0][mine], cells[1][mine]
            found = [layer.peak_at(own, place) - peaks[p, mine, k] for p, place in enumerate(PROBES[:FIRST])]
            errors[k][own] = np.abs(found).max(axis=0)
        errors[smooth & np.isnan(errors)] = np.inf  # a block overturns inside the cell
        wild = smooth & ~(largest_around(errors) <= TAME)
        for k, layer in enumerate(layers):
            mine = wild[k][cells]
            own = cells[0][mine], cells[1][mine]
            self._choose(layer, own, peaks[:, mine, k], errors[k])
            promising = errors[k][own] <= WORTH
            layer.stencil[own[0][~promising], own[1][~promising]] = NO_STENCIL
            good = own[0][promising], own[1][promising]
            # one restitution at a time: these blocks strike often, and hardly two layers have them in the same cells
            more = self._probe(PROBES[FIRST:], good, etas[k : k + 1], angle)[..., 0]
            self._choose(layer, good, np.concatenate([peaks[:, mine, k][:, promising], more]), errors[k])
        return errors

    def _choose(self, layer: Layer, cells: Cells, peaks: Array, errors: Array) -> None:
        """Give some cells the stencil that comes closest to the peaks (probes, cells) at the first probes."""
        places = PROBES[: len(peaks)]
        x, y = (np.array(axis) for axis in zip(*(self.mesh.within(cells, place) for place in places), strict=True))
        codes, least = layer.stencil[cells], np.empty(cells[0].size)
        choose_stencils(layer.peak_rotation, *cells, x, y, np.ascontiguousarray(peaks), self.mesh, codes, least)
        layer.stencil[cells], errors[cells] = codes, least

    def _probe(self, places: Sequence[tuple[float, float]], cells: Cells, etas: Array, angle: float) -> Array:
        """The solver's peaks at places within cells, for each restitution: shape (places, cells, restitutions)."""
        peaks = np.empty((len(places), cells[0].size, etas.size))
        for k, place in enumerate(places):
            x, y = self.mesh.within(cells, place)
            peaks[k] = self._solve(x, np.exp(y), etas, angle, PROBE_TOLERANCE).peak_rotation
        return peaks

    def _solve(
        self, slenderness: Array, frequency_ratio: Array, etas: Array, angle: float, tolerance: float | None = None
    ) -> Response:
        return peak_response(
            self.pulse,
            slenderness=slenderness[..., None],
            frequency_ratio=frequency_ratio[..., None],
            restitution=etas,
            alpha=float(angle) or None,
            tolerance=tolerance,
            threads=self.threads,
        )


def _cube(pulse: str, eta: float, axes: Mapping[str, Array], layers: Sequence[Layer], errors: Array) -> xr.Dataset:
    """Assemble the layers of one restitution; cells stand at their lower corner."""
    names = ("peak_rotation", "outcome", "impacts", "exceeded_alpha", "peak_mode")
    variables = {name: np.stack([getattr(layer, name) for layer in layers]) for name in names}

    def at_corner(cells: ArrayLike, empty: float) -> NDArray[Any]:
        return np.pad(cells, ((0, 0), (0, 1), (0, 1)), constant_values=empty)

    variables["stencil"] = at_corner(np.stack([layer.stencil for layer in layers]), NO_STENCIL)
    served = np.stack([layer.stencil for layer in layers]) != NO_STENCIL
    for name, error in zip(("interpolation_error", "restitution_error", "alpha_error"), errors, strict=True):
        largest = largest_around(error)
        largest[~served | np.isinf(largest)] = np.nan
        single = largest.astype(np.float32)
        # up to the next single: what is stored is still a bound
        above = np.where(single < largest, np.nextafter(single, np.float32(np.inf)), single)
        variables[name] = at_corner(above, np.nan)
    return build_spectrum_dataset(variables, pulse=pulse, restitution=eta, axes=axes)
