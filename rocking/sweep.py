"""Fills spectrum cubes: the grid through the solver, then the error of interpolating it, measured between nodes.

Several coefficients of restitution are solved together, as the first flight of a block does not depend on them.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from rocking.cube import VARIABLES, build_spectrum_dataset
from rocking.errors import in_range
from rocking.interpolation import STENCIL, lagrange_weights, smooth_cells, stencil_start
from rocking.solve import peak_response

Array = NDArray[np.float64]

PROBES = np.array([1 / 6, 1 / 2, 5 / 6])
"""Where in a cell, in either direction, interpolation is compared with the solver; the middle is the worst place of a
smooth function, the other two catch what happens near the edges [-]."""

TOGETHER = 4
"""Restitutions solved together: most of what sharing the first flight saves, at four times the memory of one."""


def spectrum(pulse: str, *, restitution: float, **grid: Any) -> xr.Dataset:
    """The spectrum cube of one pulse and one coefficient of restitution; the other arguments as for `spectra`."""
    return next(spectra(pulse, restitution=[restitution], **grid))


def spectra(
    pulse: str,
    *,
    restitution: Sequence[float],
    slenderness: ArrayLike,
    frequency_ratio: ArrayLike,
    alpha: ArrayLike = (0.0,),
    threads: int | None = None,
) -> Iterator[xr.Dataset]:
    """The spectrum cubes of one pulse, one for each coefficient of restitution in turn (schema in `rocking.cube`).

    Parameters
    ----------
    pulse : str
        Name of the pulse.
    restitution : sequence of float
        eta [-], [0, 1].
    slenderness : array_like, shape (n,), n >= 4
        1/a [-], > 0, ascending and uniformly spaced.
    frequency_ratio : array_like, shape (m,), m >= 4
        omega [-], > 0, ascending and uniformly spaced in its logarithm.
    alpha : array_like, shape (k,)
        Slenderness angles [rad]; 0 for the slender limit.
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
    axes = {"alpha": angles, "slenderness": rows, "frequency_ratio": columns}
    for first in range(0, len(restitution), TOGETHER):
        etas = np.asarray(restitution[first : first + TOGETHER], dtype=np.float64)
        slices = [
            _slice(rows, columns, pulse=pulse, restitution=etas, alpha=float(angle) or None, threads=threads)
            for angle in angles
        ]
        for k, eta in enumerate(etas):
            variables = {name: np.stack([part[name][..., k] for part in slices]) for name in VARIABLES}
            yield build_spectrum_dataset(variables, pulse=pulse, restitution=float(eta), axes=axes)


def _slice(rows: Array, columns: Array, **block: Any) -> dict[str, NDArray[Any]]:
    """All variables of the cubes for one angle, each of shape (slenderness, frequency_ratio, restitution)."""
    nodes = peak_response(slenderness=rows[:, None, None], frequency_ratio=columns[:, None], **block)
    etas = range(nodes.shape[-1])
    smooth = [smooth_cells(nodes.outcome[..., k], nodes.impacts[..., k], nodes.peak_mode[..., k]) for k in etas]
    error = np.full(nodes.shape, np.nan)
    error[:-1, :-1] = _interpolation_error(nodes.peak_rotation, np.stack(smooth, axis=-1), rows, columns, **block)
    found: dict[str, NDArray[Any]] = {name: getattr(nodes, name) for name in VARIABLES if name != "interpolation_error"}
    return found | {"interpolation_error": error}


def _interpolation_error(peaks: Array, smooth: NDArray[np.bool_], rows: Array, columns: Array, **block: Any) -> Array:
    """Largest |interpolated - solved| at the probes of each smooth cell; nan elsewhere, and where a probe overturns."""
    k = PROBES.size
    row_at = (np.arange(rows.size - 1)[:, None] + PROBES).ravel()
    column_at = (np.arange(columns.size - 1)[:, None] + PROBES).ravel()
    interpolated = _along(_along(peaks, row_at, 0), column_at, 1)
    wanted = np.repeat(np.repeat(smooth.any(axis=-1), k, axis=0), k, axis=1)
    i, j = np.nonzero(wanted)
    solved = peak_response(
        slenderness=np.interp(row_at, np.arange(rows.size), rows)[i, None],
        frequency_ratio=np.exp(np.interp(column_at, np.arange(columns.size), np.log(columns)))[j, None],
        **block,
    )
    error = np.full(interpolated.shape, np.nan)
    error[i, j] = np.abs(interpolated[i, j] - solved.peak_rotation)
    # the largest of the probes; a nan among them (an overturned block inside the cell) makes the cell mixed
    largest = error.reshape(rows.size - 1, k, columns.size - 1, k, -1).max(axis=(1, 3))
    return np.where(smooth, largest, np.nan)


def _along(values: Array, position: Array, axis: int) -> Array:
    """Four-point Lagrange interpolation along an axis at fractional indices."""
    first = stencil_start(position.astype(np.intp), values.shape[axis])
    weights = lagrange_weights(position - first)
    shape = [1] * values.ndim
    shape[axis] = position.size
    terms = [weights[:, node].reshape(shape) * values.take(first + node, axis) for node in range(STENCIL)]
    return np.asarray(sum(terms))
