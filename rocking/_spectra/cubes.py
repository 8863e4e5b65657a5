"""Fills spectrum cubes: solves all nodes, then measures the errors of interpolation between them against the solver.

Several coefficients of restitution are solved together, as the motion before the first impact does not depend on them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from rocking._base.arrays import Array
from rocking._base.errors import one_of
from rocking._base.quantities import FREQUENCY_RATIO, RESTITUTION, SLENDERNESS
from rocking._datasets.cube import (
    DIMENSIONS,
    IMPACTS_BEFORE_REST,
    OPTIONAL_VARIABLES,
    build_errors_dataset,
    build_spectrum_dataset,
)
from rocking._excitation.sampled import SampledPulse
from rocking._interpolation.slices import windows_of
from rocking._interpolation.stencils import NO_STENCIL, OVERTURNS, Mesh
from rocking._model.checks import check_alpha
from rocking._model.fields import CUBE_FIELDS
from rocking._model.outcome import SURVIVES, outcome_codes
from rocking._model.response import Response
from rocking._numba.cancellation import StopFlag
from rocking._solver.peak_response import peak_response
from rocking._solver.rules import IMPACT_LIMIT
from rocking._spectra.layer import CELL_CENTRE, DIRECT, UNKNOWN, Cells, GridLayer, largest_in_neighbourhood
from rocking._spectra.level_interval import LevelInterval

PROBES = (CELL_CENTRE, (0.15, 0.35), (0.35, 0.85), (0.85, 0.65), (0.65, 0.15))
"""Where in a cell interpolation is compared with the solver, as fractions along rows and columns [-]. No two share a
row or a column: no crease along one passes between them, and errors of rows and columns cannot cancel at all of them.
"""

FIRST_PROBES = 2
"""Probe points used in every cell: the error of a smooth function has one shape along rows and one along columns."""

REFINE_TOL = 1e-6
"""Above this error at the first probes of a cell, or of one next to it, the other probes are used as well [-]."""

MAX_ERROR = 5e-5  # largest measured error of a cell that is interpolated [-]

PROBE_TOLERANCE = 1e-8
"""Relative error of the solver at the probes [-]: small compared with errors that matter."""

MIDDLE, BESIDE = 0.5, (0.25, 0.75)
"""Where between two slices interpolation is compared with the solver, as shares of the interval [-].

All cells are probed in the middle. The error of a crease at one eighth of the interval vanishes there, so cells in
which the peak has a crease are probed beside the middle too.
"""

MAX_SPACING = {"restitution": 0.1, "alpha": np.radians(25.0)}
"""Largest interval between slices that is interpolated [-, rad]: the probes do not suffice for more."""

BATCH_SIZE = 12
"""Restitutions solved together: most of the saving of a shared first flight, for four times the memory of one."""


def spectrum(pulse: str | SampledPulse, *, restitution: float, **grid: Any) -> xr.Dataset:
    """The spectrum cube of one pulse and one coefficient of restitution; other arguments as for `spectra`."""
    return next(spectra(pulse, restitution=[restitution], **grid))


def spectra(
    pulse: str | SampledPulse,
    *,
    restitution: ArrayLike,
    threads: int | None = None,
    stop: StopFlag | None = None,
    **grid: Any,
) -> Iterator[xr.Dataset]:
    """The spectrum cubes of one pulse (`rocking._datasets.cube`), one for each coefficient of restitution in turn.

    Arguments and errors are those of `solve_cubes`.
    """
    cubes = [*solve_cubes(pulse, restitution=restitution, threads=threads, stop=stop, **grid)]
    return with_restitution_errors(pulse, cubes, threads=threads, stop=stop)


def solve_cubes(
    pulse: str | SampledPulse,
    *,
    restitution: ArrayLike,
    slenderness: ArrayLike,
    frequency_ratio: ArrayLike,
    alpha: ArrayLike = (0.0,),
    barred: NDArray[np.bool_] | None = None,
    derived: Sequence[str] = (),
    threads: int | None = None,
    stop: StopFlag | None = None,
) -> Iterator[xr.Dataset]:
    """The cubes without the errors of interpolation between restitutions (`errors_between_cubes`).

    `pulse`: name of the pulse, or a pulse given by samples. `restitution` (l,): eta [-], [0, 1], ascending.
    `slenderness` (n,): 1/a [-], > 0, ascending. `frequency_ratio` (m,): omega [-], > 0, ascending. `alpha` (k,):
    slenderness angles [rad], ascending; 0 for the slender limit. `barred` (l, k, n - 1, m - 1): cells that are not
    interpolated because overturning boundaries cross them (`rocking._boundary.curves`). `derived`: names of
    `rocking._model.fields.DERIVED_FIELDS` that the cubes store too. `threads`: threads of the solver; by default all
    cores. `stop`: the computation ends with `StoppedError` soon after another thread sets it. Raises
    `InvalidArgumentError` if a value is out of range.
    """
    rows = SLENDERNESS.convert(slenderness)
    columns = FREQUENCY_RATIO.convert(frequency_ratio)
    angles = check_alpha(alpha)
    etas = RESTITUTION.convert(restitution)
    for name in derived:
        one_of("derived", name, OPTIONAL_VARIABLES)
    grid = _Grid(pulse, Mesh.of(rows, columns), columns, threads, stop)
    axes = {"alpha": angles, "slenderness": rows, "frequency_ratio": columns}
    for first in range(0, etas.size, BATCH_SIZE):
        batch = slice(first, first + BATCH_SIZE)
        layers, errors, fewest = _layers(grid, etas[batch], angles, None if barred is None else barred[batch], derived)
        for k, eta in enumerate(etas[batch]):
            cube = _cube(pulse, float(eta), axes, layers[k], {name: error[k] for name, error in errors.items()})
            layers[k].clear()  # the caller may keep the cube
            yield cube.assign_attrs({IMPACTS_BEFORE_REST: int(fewest[k])})


def with_restitution_errors(
    pulse: str | SampledPulse,
    cubes: Sequence[xr.Dataset],
    *,
    threads: int | None = None,
    stop: StopFlag | None = None,
) -> Iterator[xr.Dataset]:
    """The cubes of `solve_cubes` in turn, with the errors of interpolation up to the next one.

    `pulse`, `threads`, `stop`: as for `solve_cubes`. `cubes`: of ascending restitutions.
    """
    errors = errors_between_cubes(pulse, cubes, threads=threads, stop=stop)
    etas = [float(cube["restitution"]) for cube in cubes]
    for k, cube in enumerate(cubes):
        variables = {str(name): part.values for name, part in cube.data_vars.items()}
        variables["restitution_error"] = errors[k]
        axes = {name: cube[name].values for name in DIMENSIONS}
        whole = build_spectrum_dataset(variables, pulse=pulse, restitution=etas[k], axes=axes)
        window = slice(*windows_of(len(etas), k, k + 1))
        yield whole.assign_attrs(
            {"restitution_slices": np.array(etas[window]), IMPACTS_BEFORE_REST: cube.attrs[IMPACTS_BEFORE_REST]}
        )


def restitution_errors(
    pulse: str | SampledPulse,
    cubes: Sequence[xr.Dataset],
    *,
    threads: int | None = None,
    stop: StopFlag | None = None,
) -> xr.Dataset:
    """The errors of interpolation between the cubes of a pulse as a data set of its own.

    Arguments as for `errors_between_cubes`; all cubes have a digest of their values, by which
    `rocking._lookup.cube_slice` recognises the cubes that were measured.
    """
    etas = [float(cube["restitution"]) for cube in cubes]
    errors = errors_between_cubes(pulse, cubes, threads=threads, stop=stop)
    axes = {name: cubes[0][name].values for name in DIMENSIONS}
    digests = [cube.attrs["content_sha256"] for cube in cubes]
    return build_errors_dataset(errors, pulse=pulse, restitution=etas, axes=axes, digests=digests)


def errors_between_cubes(
    pulse: str | SampledPulse,
    cubes: Sequence[xr.Dataset],
    *,
    threads: int | None = None,
    stop: StopFlag | None = None,
) -> NDArray[np.float32]:
    """The errors of interpolation between each cube and the next one, at the lower nodes of the cells.

    `pulse`, `threads`, `stop`: as for `solve_cubes`. `cubes`: cubes of ascending restitutions, which may be open files:
    one angle at a time is read. Returns array (restitution, alpha, slenderness, frequency_ratio) [-], nan where no
    bound is known, as above the last cube.
    """
    etas = np.array([float(cube["restitution"]) for cube in cubes])
    rows, columns, angles = (cubes[0][name].values for name in ("slenderness", "frequency_ratio", "alpha"))
    grid = _Grid(pulse, Mesh.of(rows, columns), columns, threads, stop)
    bounds = np.full((etas.size, angles.size, rows.size, columns.size), np.nan, np.float32)
    lower = _interval_starts(etas, MAX_SPACING["restitution"])
    for a, angle in enumerate(angles if lower else ()):
        layers = [GridLayer.stored(grid.mesh, cube.isel(alpha=a)) for cube in cubes]
        kinds = [layer.kinds() for layer in layers]
        intervals = [LevelInterval.of(layers, kinds, etas, 1, k) for k in lower]
        for k, error in zip(lower, grid.errors_between_restitutions(intervals, float(angle)), strict=True):
            bounds[k, a] = _bounds(error[None])[0]
    return bounds


def _layers(
    grid: _Grid, etas: Array, angles: Array, barred: NDArray[np.bool_] | None, derived: Sequence[str]
) -> tuple[list[list[GridLayer]], dict[str, Array], NDArray[np.int32]]:
    """The layers by restitution and angle, the errors (l, k, n - 1, m - 1) of interpolation in their cells.

    And of each restitution the fewest impacts of a node before impacts accumulate to rest while the pulse acts;
    `IMPACT_LIMIT` if they do so nowhere.
    """
    layers: list[list[GridLayer]] = [[] for _ in etas]
    fewest = np.full(etas.size, IMPACT_LIMIT, np.int32)
    inside, by_angle = grid.no_errors(etas, angles), grid.no_errors(etas, angles)
    for a, angle in enumerate(angles):
        nodes = grid.nodes(etas, angle)
        further = {name: getattr(nodes, name) for name in derived}
        before_rest = np.where(nodes.chatter, nodes.impacts, IMPACT_LIMIT)
        fewest = np.minimum(fewest, before_rest.min(axis=(0, 1)))
        for k, row in enumerate(layers):
            row.append(GridLayer.of(grid.mesh, nodes, k, None if barred is None else barred[k, a], further))
        inside[:, a] = grid.errors_in_cells([row[a] for row in layers], etas, angle)
    kinds = [[layer.kinds() for layer in row] for row in layers]
    for a in _interval_starts(angles, MAX_SPACING["alpha"]):
        # the equation of motion depends on alpha through its square only
        intervals = [LevelInterval.of(*row, angles, 2, a) for row in zip(layers, kinds, strict=True)]
        by_angle[:, a] = grid.errors_between_angles(intervals, etas)
    return layers, {"interpolation_error": inside, "alpha_error": by_angle}, fewest


def _interval_starts(slices: Array, spacing: float) -> list[int]:
    """The slices whose distance from the next one is at most `spacing`."""
    return [int(k) for k in np.flatnonzero(np.diff(slices) <= spacing * (1.0 + 1e-9))]


@dataclass(frozen=True, eq=False)
class _Grid:
    """The pulse, and the plane of slenderness and frequency ratio on which it is solved."""

    pulse: str | SampledPulse
    mesh: Mesh
    columns: Array
    threads: int | None
    stop: StopFlag | None

    def no_errors(self, etas: Array, angles: Array) -> Array:
        """An array (etas, angles, n - 1, m - 1) of nan, for errors of the cells."""
        return np.full((etas.size, angles.size, self.mesh.rows.size - 1, self.columns.size - 1), np.nan)

    def nodes(self, etas: Array, angle: float) -> Response:
        """All nodes, for each restitution: shape (n, m, restitutions)."""
        return self._solve(self.mesh.rows[:, None], self.columns, etas, angle)

    def errors_in_cells(self, layers: Sequence[GridLayer], etas: Array, angle: float) -> Array:
        """Largest error [-] at the probes of each cell: shape (restitutions, n - 1, m - 1).

        0 where all blocks overturn in the same way, infinite where one overturns at a probe, nan where there is no
        stencil. Cells with more than `MAX_ERROR` lose their stencil.
        """
        errors = np.array([np.where(layer.stencil == OVERTURNS, 0.0, np.nan) for layer in layers])
        smooth = np.array([layer.smooth for layer in layers])
        cells = np.nonzero(smooth.any(axis=0))
        peaks = self._probe(PROBES[:FIRST_PROBES], cells, etas, angle)
        for k, layer in enumerate(layers):
            mine = smooth[k][cells]
            own = cells[0][mine], cells[1][mine]
            errors[k][own] = _largest_error(layer, own, PROBES[:FIRST_PROBES], peaks[:, mine, k])
        # cells with an error that matters, or beside one: the other probes too, since a crease cuts corners
        refined = smooth & ~(largest_in_neighbourhood(errors) <= REFINE_TOL) & (errors <= MAX_ERROR)
        for k, layer in enumerate(layers):
            # one restitution at a time: hardly two layers have such blocks, which impact often, in the same cells
            rough = np.nonzero(refined[k])
            more = self._probe(PROBES[FIRST_PROBES:], rough, etas[k : k + 1], angle)[..., 0]
            errors[k][rough] = np.maximum(errors[k][rough], _largest_error(layer, rough, PROBES[FIRST_PROBES:], more))
            layer.stencil[smooth[k] & (errors[k] > MAX_ERROR)] = NO_STENCIL
        return errors

    def errors_between_restitutions(self, intervals: Sequence[LevelInterval], angle: float) -> list[Array]:
        """Errors in intervals between restitutions, see `_errors_between`."""
        return self._largest_between(
            intervals, lambda share: (np.array([interval.level(share) for interval in intervals]), angle), DIRECT
        )

    def errors_between_angles(self, intervals: Sequence[LevelInterval], etas: Array) -> list[Array]:
        """Errors in one interval between angles, at each restitution, see `_errors_between`."""
        return self._largest_between(intervals, lambda share: (etas, intervals[0].level(share)))

    def _largest_between(
        self,
        intervals: Sequence[LevelInterval],
        levels: Callable[[float], tuple[Array, float]],
        known: int | None = None,
    ) -> list[Array]:
        """The largest of the errors at the probes of each interval; nan where one of them is nan."""
        wanted = [interval.kind != UNKNOWN for interval in intervals]
        largest = self._errors_between(intervals, MIDDLE, wanted, *levels(MIDDLE), known)
        for share in BESIDE:
            beside = [
                interval.creased & np.isfinite(error) & (interval.kind != known)
                for interval, error in zip(intervals, largest, strict=True)
            ]
            more = self._errors_between(intervals, share, beside, *levels(share), known)
            largest = [
                np.where(mine, np.maximum(error, other), error)
                for mine, error, other in zip(beside, largest, more, strict=True)
            ]
        return largest

    def _errors_between(
        self,
        intervals: Sequence[LevelInterval],
        share: float,
        wanted: Sequence[NDArray[np.bool_]],
        etas: Array,
        angle: float,
        known: int | None,
    ) -> list[Array]:
        """Error [-] at a share of each interval, at the centre of each cell.

        `intervals`: intervals over the same plane; `share`: where in them [-]; `wanted` (n - 1, m - 1): cells of each
        interval that are probed; `etas`: restitution [-] there; `angle`: slenderness angle [rad] there; `known`: kind
        of cells in which all blocks between overturn in the same way, without asking the solver. Returns list of float
        arrays (n - 1, m - 1): 0 where all blocks overturn in the same way, nan where the layers or the block between
        differ in kind.
        """
        asked = [cells & (interval.kind != known) for interval, cells in zip(intervals, wanted, strict=True)]
        errors = [np.where(interval.kind == known, 0.0, np.nan) for interval in intervals]
        cells = np.nonzero(np.any(asked, axis=0)) if intervals else ()
        if not intervals or not cells[0].size:
            return errors
        x, y = self.mesh.within(cells, CELL_CENTRE)
        found = self._solve(x, np.exp(y), etas, angle, PROBE_TOLERANCE)
        codes = outcome_codes(found.outcome, found.impacts)
        for k, interval in enumerate(intervals):
            # the block between the slices must be of the kind of the cell, or the cell has no bound
            same = asked[k][cells] & (interval.kind[cells] == codes[:, k])
            errors[k][cells[0][same], cells[1][same]] = 0.0
            survive = same & (codes[:, k] == SURVIVES)
            own = cells[0][survive], cells[1][survive]
            errors[k][own] = interval.errors(share, own, CELL_CENTRE, found.peak_rotation[survive, k])
        return errors

    def _probe(self, places: Sequence[tuple[float, float]], cells: Cells, etas: Array, angle: float) -> Array:
        """Peaks of the solver [-] at points of cells, for each restitution: shape (places, cells, restitutions)."""
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
            relative_tolerance=tolerance,
            threads=self.threads,
            stop=self.stop,
        )


def _largest_error(layer: GridLayer, cells: Cells, places: Sequence[tuple[float, float]], peaks: Array) -> Array:
    """Largest error [-] of interpolation at points of cells against peaks (places, cells); infinite if one is nan."""
    errors = np.abs([layer.peak_at(cells, place) - peak for place, peak in zip(places, peaks, strict=True)])
    return np.asarray(np.nan_to_num(errors.max(axis=0), nan=np.inf))


def _cube(
    pulse: str | SampledPulse,
    eta: float,
    axes: Mapping[str, Array],
    layers: Sequence[GridLayer],
    errors: Mapping[str, Array],
) -> xr.Dataset:
    """Assemble the layers of one restitution; the values of a cell are stored at its lower node."""
    variables = {field.name: np.stack([getattr(layer, field.name) for layer in layers]) for field in CUBE_FIELDS}
    variables |= {name: np.stack([layer.derived[name] for layer in layers]) for name in layers[0].derived}

    variables["stencil"] = _at_corner(np.stack([layer.stencil for layer in layers]), NO_STENCIL)
    variables |= {name: _bounds(error) for name, error in errors.items()}
    return build_spectrum_dataset(variables, pulse=pulse, restitution=eta, axes=axes)


def _at_corner(cells: ArrayLike, empty: float) -> NDArray[Any]:
    """Values of cells (k, n - 1, m - 1) at their lower nodes (k, n, m)."""
    return np.pad(cells, ((0, 0), (0, 1), (0, 1)), constant_values=empty)


def _bounds(error: Array) -> NDArray[np.float32]:
    """Errors (k, n - 1, m - 1) of cells as they are stored: largest of a neighbourhood, nan above `MAX_ERROR`."""
    largest = largest_in_neighbourhood(error)
    largest[~((error <= MAX_ERROR) & np.isfinite(largest))] = np.nan
    single = largest.astype(np.float32)
    # rounded up to single precision: what is stored is still a bound
    above = np.where(single < largest, np.nextafter(single, np.float32(np.inf)), single)
    return np.asarray(_at_corner(above, np.nan))
