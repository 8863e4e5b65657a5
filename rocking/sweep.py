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
from rocking.response import Response
from rocking.solve import peak_response
from rocking.sweep_layer import CENTRE, PROBES, Layer, cell_error, fate_codes, gap_error

Array = NDArray[np.float64]

PROBE_TOLERANCE = 1e-9
"""Relative error left in the peaks with which interpolation is compared: far below the errors that matter [-]."""

TOGETHER = 4
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
        1/a [-], > 0, ascending and uniformly spaced.
    frequency_ratio : array_like, shape (m,), m >= 4
        omega [-], > 0, ascending and uniformly spaced in its logarithm.
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
    grid = _Grid(pulse, rows, columns, threads)
    layers: list[list[Layer]] = [[] for _ in etas]
    errors = np.full((3, etas.size, angles.size, rows.size - 1, columns.size - 1), np.nan, dtype=np.float32)
    for a, angle in enumerate(angles):
        for first in range(0, etas.size, TOGETHER):
            some = etas[first : first + TOGETHER]
            nodes = grid.nodes(some, angle)
            for k in range(some.size):
                layers[first + k].append(Layer.of(nodes, k, None if barred is None else barred[first + k, a]))
            made = [layers[first + k][a] for k in range(some.size)]
            errors[0, first : first + some.size, a] = grid.errors_in_cells(made, some, angle)
    for a, angle in enumerate(angles):
        between = 0.5 * (etas[1:] + etas[:-1])
        found = grid.centres(between, angle)
        for gap, eta in enumerate(between):
            errors[1, gap, a] = gap_error([row[a] for row in layers], etas, eta, *found[gap])
    for gap, angle in enumerate(0.5 * (angles[1:] + angles[:-1])):
        # the equation of motion knows the sign of alpha only in its square
        for k, (peak, fate) in enumerate(grid.centres(etas, angle)):
            errors[2, k, gap] = gap_error(layers[k], angles**2, angle**2, peak, fate)
    axes = {"alpha": angles, "slenderness": rows, "frequency_ratio": columns}
    for k, eta in enumerate(etas):
        above = etas[k + 1] if k + 1 < etas.size else np.nan
        yield _cube(pulse, float(eta), axes, layers[k], errors[:, k]).assign_attrs(next_restitution=float(above))


@dataclass(frozen=True)
class _Grid:
    """The pulse and the plane of control on which it is solved."""

    pulse: str
    rows: Array
    columns: Array
    threads: int | None

    def nodes(self, etas: Array, angle: float) -> Response:
        """All nodes, for each restitution: shape (n, m, restitutions)."""
        return self._solve(self.rows[:, None], self.columns, etas, angle)

    def centres(self, etas: Array, angle: float) -> list[tuple[Array, NDArray[np.int64]]]:
        """Peak and fate at the centres of all cells, for each restitution."""
        cells = np.indices((self.rows.size - 1, self.columns.size - 1))
        found = self._solve(*self._places(CENTRE, *cells), etas, angle, PROBE_TOLERANCE)
        fates = fate_codes(found.outcome, found.impacts)
        return [(found.peak_rotation[..., k], fates[..., k]) for k in range(len(etas))]

    def errors_in_cells(self, layers: Sequence[Layer], etas: Array, angle: float) -> Array:
        """Largest error at the probes of each cell, for each restitution; 0 where it overturns alike, or nan."""
        errors = np.array([np.where(layer.stencil == OVERTURNS, 0.0, np.nan) for layer in layers])
        smooth = np.array([layer.smooth for layer in layers])
        errors[smooth] = 0.0
        wanted = np.nonzero(smooth.any(axis=0))
        for place in PROBES:
            found = self._solve(*self._places(place, *wanted), etas, angle, PROBE_TOLERANCE)
            for k, layer in enumerate(layers):
                mine = smooth[k][wanted]
                cells = wanted[0][mine], wanted[1][mine]
                # a nan among them, an overturned block inside the cell, stays
                errors[k][cells] = np.maximum(
                    errors[k][cells], cell_error(layer, cells, place, found.peak_rotation[mine, k])
                )
        return errors

    def _places(self, place: tuple[float, float], i: NDArray[np.intp], j: NDArray[np.intp]) -> tuple[Array, Array]:
        rows = self.rows[i] + place[0] * (self.rows[i + 1] - self.rows[i])
        logs = np.log(self.columns)
        return rows, np.exp(logs[j] + place[1] * (logs[j + 1] - logs[j]))

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


def _cube(
    pulse: str, eta: float, axes: Mapping[str, Array], layers: Sequence[Layer], errors: NDArray[np.float32]
) -> xr.Dataset:
    """Assemble the layers of one restitution; cells stand at their lower corner."""
    names = ("peak_rotation", "outcome", "impacts", "exceeded_alpha", "peak_mode")
    variables = {name: np.stack([getattr(layer, name) for layer in layers]) for name in names}

    def at_corner(cells: ArrayLike, empty: float) -> NDArray[Any]:
        return np.pad(cells, ((0, 0), (0, 1), (0, 1)), constant_values=empty)

    variables["stencil"] = at_corner(np.stack([layer.stencil for layer in layers]), NO_STENCIL)
    for name, error in zip(("interpolation_error", "restitution_error", "alpha_error"), errors, strict=True):
        # up to the next single: what is stored is still a bound
        above = np.where(error > 0.0, np.nextafter(error, np.float32(np.inf)), error)
        variables[name] = at_corner(above, np.nan)
    return build_spectrum_dataset(variables, pulse=pulse, restitution=eta, axes=axes)
