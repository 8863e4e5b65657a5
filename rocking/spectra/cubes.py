"""Fills spectrum cubes: the grid through the solver, then the errors of interpolating it, measured between nodes.

Several coefficients of restitution are solved together, as the first flight of a block does not depend on them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from rocking._numba.cancellation import StopFlag
from rocking._numba.compilation import contiguous_array
from rocking.datasets.cube import build_spectrum_dataset
from rocking.errors import in_range
from rocking.interpolation.selection import choose_stencils
from rocking.interpolation.stencils import NO_STENCIL, OVERTURNS, Mesh
from rocking.model.response import Response
from rocking.solver.peak_response import peak_response
from rocking.spectra.between_levels import LevelInterval, ProbePoint
from rocking.spectra.layer import CELL_CENTRE, DIRECT, Cells, GridLayer, largest_in_neighbourhood, outcome_codes

Array = NDArray[np.float64]

PROBES = (CELL_CENTRE, (0.15, 0.35), (0.35, 0.85), (0.85, 0.65), (0.65, 0.15))
"""Rows and columns within a cell where interpolation is compared with the solver [-]. No two share a row or a column,
so that no crease along one passes between them, and errors of rows and of columns cannot cancel at all of them."""

HALFWAY = (CELL_CENTRE, 0.5)
"""Place in every cell, and share of the gap between two levels, where interpolation between them is compared."""

EXTRA_PROBES = (((0.65, 0.15), 0.25), ((0.35, 0.85), 0.75))
"""The same where it is not tame."""

FIRST_PROBES = 2
"""Probes in every cell: the error of a smooth function has one shape along rows and one along columns."""

REFINE_TOL = 1e-6
"""Error at the first probes above which the others and other stencils or levels are tried, there and next to it [-]."""

LEVEL_TOL = 1e-5
"""The same between levels, where errors are larger and other levels help most beside creases [-]."""

MAX_ERROR = 5e-5
"""Error at the first probes up to which a cell is interpolated at all [-]: what is coarser is for the solver."""

SELECTION_FACTOR = 2.0
"""Factor on the errors of levels that were chosen by them [-]: the best of six at three points flatters itself."""

NEIGHBOUR_WEIGHT = {"interpolation_error": 0.3, "restitution_error": 1.0, "alpha_error": 1.0}
"""How much the errors of the cells around count [-]: a crease in one of them that reaches into a cell parts one of its
corners, which are nodes of its stencil, from the others, and shows at its own probes; between levels it may not."""

PROBE_TOLERANCE = 1e-8
"""Relative error left in the peaks with which interpolation is compared: far below the errors that matter [-]."""

MAX_SPACING = {"restitution": 0.1, "alpha": np.radians(25.0)}
"""Levels farther apart are not interpolated between: one look in the middle would not tell enough [-, rad]."""

BATCH_SIZE = 12
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
    stop: StopFlag | None = None,
) -> Iterator[xr.Dataset]:
    """The spectrum cubes of one pulse, one for each coefficient of restitution in turn (`rocking.datasets.cube`).

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
    stop : StopFlag, optional
        Once another thread sets it, this ends soon with `StoppedError`.

    Raises
    ------
    InvalidArgumentError
        If a value is out of range.
    """
    rows = in_range("slenderness", slenderness, 0.0, np.inf, closed="neither")
    columns = in_range("frequency_ratio", frequency_ratio, 0.0, np.inf, closed="neither")
    angles = in_range("alpha", alpha, 0.0, np.pi / 2, closed="left", unit="rad")
    etas = in_range("restitution", restitution, 0.0, 1.0)
    grid = _Grid(pulse, Mesh.of(rows, columns), columns, threads, stop)
    layers: list[list[GridLayer]] = [[] for _ in etas]
    shape = (etas.size, angles.size, rows.size - 1, columns.size - 1)
    errors = {name: np.full(shape, np.nan) for name in ("interpolation_error", "restitution_error", "alpha_error")}
    levels = {name: np.full(shape, NO_STENCIL, np.int8) for name in ("restitution_levels", "alpha_levels")}
    for a, angle in enumerate(angles):
        for first in range(0, etas.size, BATCH_SIZE):
            some = etas[first : first + BATCH_SIZE]
            nodes = grid.nodes(some, angle)
            for k in range(some.size):
                bars = None if barred is None else barred[first + k, a]
                layers[first + k].append(GridLayer.of(grid.mesh, nodes, k, bars))
            made = [layers[first + k][a] for k in range(some.size)]
            errors["interpolation_error"][first : first + some.size, a] = grid.errors_in_cells(made, some, angle)
    kinds = [[layer.kinds() for layer in row] for row in layers]
    for a, angle in enumerate(angles):
        along = [row[a] for row in layers], [row[a] for row in kinds]
        gaps = [LevelInterval.of(*along, etas, 1, int(k)) for k in _interval_starts(etas, MAX_SPACING["restitution"])]
        found = grid.errors_between(gaps, _between_restitutions(gaps, angle), known=DIRECT)
        for gap, error in zip(gaps, found, strict=True):
            errors["restitution_error"][gap.lower, a], levels["restitution_levels"][gap.lower, a] = error, gap.choice
    for a in _interval_starts(angles, MAX_SPACING["alpha"]):
        # the equation of motion knows the sign of alpha only in its square
        gaps = [LevelInterval.of(*row, angles, 2, int(a)) for row in zip(layers, kinds, strict=True)]
        found = grid.errors_between(gaps, _between_angles(gaps, etas))
        for k, (gap, error) in enumerate(zip(gaps, found, strict=True)):
            errors["alpha_error"][k, a], levels["alpha_levels"][k, a] = error, gap.choice
    axes = {"alpha": angles, "slenderness": rows, "frequency_ratio": columns}
    for k, eta in enumerate(etas):
        measured = {name: error[k] for name, error in errors.items()}
        chosen = {name: choice[k] for name, choice in levels.items()}
        above = etas[k + 1] if k + 1 < etas.size else np.nan
        cube = _cube(pulse, float(eta), axes, layers[k], measured, chosen)
        yield cube.assign_attrs(next_restitution=float(above))


def _interval_starts(levels: Array, apart: float) -> list[int]:
    """The levels with the next one not farther than `apart` above."""
    return [int(k) for k in np.flatnonzero(np.diff(levels) <= apart * (1.0 + 1e-9))]


GroupsAt = Callable[[float], tuple[Array, float]]
"""From a share of some gaps to the restitution there of each [-], and the angle [rad]."""


def _between_restitutions(gaps: Sequence[LevelInterval], angle: float) -> GroupsAt:
    return lambda share: (np.array([gap.at(share) for gap in gaps]), angle)


def _between_angles(gaps: Sequence[LevelInterval], etas: Array) -> GroupsAt:
    return lambda share: (etas, gaps[0].at(share))


@dataclass(frozen=True)
class _Grid:
    """The pulse and the plane of control on which it is solved."""

    pulse: str
    mesh: Mesh
    columns: Array
    threads: int | None
    stop: StopFlag | None

    def nodes(self, etas: Array, angle: float) -> Response:
        """All nodes, for each restitution: shape (n, m, restitutions)."""
        return self._solve(self.mesh.rows[:, None], self.columns, etas, angle)

    def errors_between(self, gaps: Sequence[LevelInterval], asked: GroupsAt, known: int | None = None) -> list[Array]:
        """Largest errors at the probes of each cell, for each of some gaps.

        nan where the layers of a gap differ; 0 without asking the solver where their kind is `known` to hold between.
        Where the error is large the gaps are given the levels that have the least.
        """
        wanted = [(gap.kind != 0) & (gap.kind != known) for gap in gaps]
        errors = [np.where(gap.kind == known, 0.0, np.nan) for gap in gaps]
        cells = np.nonzero(np.any(wanted, axis=0)) if gaps else ()
        if not gaps or not cells[0].size:
            return errors
        within, share = HALFWAY
        x, y = self.mesh.within(cells, within)
        found = self._solve(x, np.exp(y), *asked(share), PROBE_TOLERANCE)
        fates = outcome_codes(found.outcome, found.impacts)
        for k, gap in enumerate(gaps):
            mine = wanted[k][cells]
            own = cells[0][mine], cells[1][mine]
            alike = np.where(gap.kind[own] > 0, 1, gap.kind[own]) == fates[mine, k]
            gap.choice[own[0][~alike], own[1][~alike]] = NO_STENCIL
            errors[k][own[0][alike], own[1][alike]] = 0.0
            stand = alike & (gap.kind[own] > 0)
            own = own[0][stand], own[1][stand]
            halfway = HALFWAY, found.peak_rotation[mine, k][stand]
            errors[k][own] = gap.errors(own, halfway)
            wild = ~(largest_in_neighbourhood(errors[k])[own] <= LEVEL_TOL)
            own, halfway = (own[0][wild], own[1][wild]), (HALFWAY, halfway[1][wild])
            errors[k][own] = gap.choose(own, [halfway])
            promising = errors[k][own] <= MAX_ERROR
            gap.choice[own[0][~promising], own[1][~promising]] = NO_STENCIL
            own, halfway = (own[0][promising], own[1][promising]), (HALFWAY, halfway[1][promising])
            more = [(place, self._peaks_at(place, own, k, asked)) for place in EXTRA_PROBES]
            errors[k][own] = SELECTION_FACTOR * gap.choose(own, [halfway, *more])
        return errors

    def _peaks_at(self, place: ProbePoint, cells: Cells, k: int, asked: GroupsAt) -> Array:
        """The solver's peaks at a place of some cells of the k-th gap."""
        within, share = place
        x, y = self.mesh.within(cells, within)
        etas, angle = asked(share)
        return self._solve(x, np.exp(y), etas[k : k + 1], angle, PROBE_TOLERANCE).peak_rotation[:, 0]

    def errors_in_cells(self, layers: Sequence[GridLayer], etas: Array, angle: float) -> Array:
        """Largest error at the probes of each cell, for each restitution; 0 where it overturns alike, or nan.

        Where it is large the layers are given the stencil that has the least.
        """
        errors = np.array([np.where(layer.stencil == OVERTURNS, 0.0, np.nan) for layer in layers])
        smooth = np.array([layer.smooth for layer in layers])
        cells = np.nonzero(smooth.any(axis=0))
        peaks = self._probe(PROBES[:FIRST_PROBES], cells, etas, angle)
        for k, layer in enumerate(layers):
            mine = smooth[k][cells]
            own = cells[0][mine], cells[1][mine]
            found = [layer.peak_at(own, place) - peaks[p, mine, k] for p, place in enumerate(PROBES[:FIRST_PROBES])]
            errors[k][own] = np.abs(found).max(axis=0)
        errors[smooth & np.isnan(errors)] = np.inf  # a block overturns inside the cell
        wild = smooth & ~(largest_in_neighbourhood(errors) <= REFINE_TOL)
        for k, layer in enumerate(layers):
            mine = wild[k][cells]
            own = cells[0][mine], cells[1][mine]
            self._choose(layer, own, peaks[:, mine, k], errors[k])
            promising = errors[k][own] <= MAX_ERROR
            layer.stencil[own[0][~promising], own[1][~promising]] = NO_STENCIL
            good = own[0][promising], own[1][promising]
            # one restitution at a time: these blocks strike often, and hardly two layers have them in the same cells
            more = self._probe(PROBES[FIRST_PROBES:], good, etas[k : k + 1], angle)[..., 0]
            self._choose(layer, good, np.concatenate([peaks[:, mine, k][:, promising], more]), errors[k])
        return errors

    def _choose(self, layer: GridLayer, cells: Cells, peaks: Array, errors: Array) -> None:
        """Give some cells the stencil that comes closest to the peaks (probes, cells) at the first probes."""
        places = PROBES[: len(peaks)]
        x, y = (np.array(axis) for axis in zip(*(self.mesh.within(cells, place) for place in places), strict=True))
        codes, least = layer.stencil[cells], np.empty(cells[0].size)
        choose_stencils(
            layer.peak_rotation,
            *map(contiguous_array, cells),
            x,
            y,
            np.ascontiguousarray(peaks),
            self.mesh,
            codes,
            least,
        )
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
            stop=self.stop,
        )


def _cube(
    pulse: str,
    eta: float,
    axes: Mapping[str, Array],
    layers: Sequence[GridLayer],
    errors: Mapping[str, Array],
    levels: Mapping[str, NDArray[np.int8]],
) -> xr.Dataset:
    """Assemble the layers of one restitution; cells stand at their lower corner."""
    names = ("peak_rotation", "outcome", "impacts", "exceeded_alpha", "peak_mode")
    variables = {name: np.stack([getattr(layer, name) for layer in layers]) for name in names}

    def at_corner(cells: ArrayLike, empty: float) -> NDArray[Any]:
        return np.pad(cells, ((0, 0), (0, 1), (0, 1)), constant_values=empty)

    codes = {"stencil": np.stack([layer.stencil for layer in layers]), **levels}
    for (name, code), (measured, error) in zip(codes.items(), errors.items(), strict=True):
        variables[name] = at_corner(code, NO_STENCIL)
        largest = largest_in_neighbourhood(error, NEIGHBOUR_WEIGHT[measured])
        largest[(code == NO_STENCIL) | np.isinf(largest)] = np.nan
        single = largest.astype(np.float32)
        # up to the next single: what is stored is still a bound
        above = np.where(single < largest, np.nextafter(single, np.float32(np.inf)), single)
        variables[measured] = at_corner(above, np.nan)
    return build_spectrum_dataset(variables, pulse=pulse, restitution=eta, axes=axes)
