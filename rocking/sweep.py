"""Fills a spectrum cube: the grid through the solver, then the error of interpolating it, measured between nodes."""

from __future__ import annotations

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


def spectrum(
    pulse: str,
    *,
    restitution: float,
    slenderness: ArrayLike,
    frequency_ratio: ArrayLike,
    alpha: ArrayLike = (0.0,),
    threads: int | None = None,
) -> xr.Dataset:
    """The spectrum cube of one pulse and one coefficient of restitution (schema in `rocking.cube`).

    Parameters
    ----------
    pulse : str
        Name of the pulse.
    restitution : float
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
    slices = [
        _slice(rows, columns, pulse=pulse, restitution=restitution, alpha=float(angle) or None, threads=threads)
        for angle in angles
    ]
    variables = {name: np.stack([part[name] for part in slices]) for name in VARIABLES}
    axes = {"alpha": angles, "slenderness": rows, "frequency_ratio": columns}
    return build_spectrum_dataset(variables, pulse=pulse, restitution=restitution, axes=axes)


def _slice(rows: Array, columns: Array, **block: Any) -> dict[str, NDArray[Any]]:
    """All variables of the cube for one slenderness angle, each of shape (slenderness, frequency_ratio)."""
    nodes = peak_response(slenderness=rows[:, None], frequency_ratio=columns, **block)
    smooth = smooth_cells(nodes.outcome, nodes.impacts, nodes.peak_mode)
    error = np.full(nodes.shape, np.nan)
    error[:-1, :-1] = _interpolation_error(nodes.peak_rotation, smooth, rows, columns, **block)
    found: dict[str, NDArray[Any]] = {name: getattr(nodes, name) for name in VARIABLES if name != "interpolation_error"}
    return found | {"interpolation_error": error}


def _interpolation_error(peaks: Array, smooth: NDArray[np.bool_], rows: Array, columns: Array, **block: Any) -> Array:
    """Largest |interpolated - solved| at the probes of each smooth cell; nan elsewhere, and where a probe overturns."""
    k = PROBES.size
    row_at = (np.arange(rows.size - 1)[:, None] + PROBES).ravel()
    column_at = (np.arange(columns.size - 1)[:, None] + PROBES).ravel()
    interpolated = _along_last(_along_last(peaks, column_at).T, row_at).T
    i, j = np.nonzero(np.repeat(np.repeat(smooth, k, axis=0), k, axis=1))
    solved = peak_response(
        slenderness=np.interp(row_at, np.arange(rows.size), rows)[i],
        frequency_ratio=np.exp(np.interp(column_at, np.arange(columns.size), np.log(columns)))[j],
        **block,
    )
    error = np.full(interpolated.shape, np.nan)
    error[i, j] = np.abs(interpolated[i, j] - solved.peak_rotation)
    # the largest of the probes; a nan among them (an overturned block inside the cell) makes the cell mixed
    return np.asarray(error.reshape(rows.size - 1, k, columns.size - 1, k).max(axis=(1, 3)))


def _along_last(values: Array, position: Array) -> Array:
    """Four-point Lagrange interpolation along the last axis at fractional indices, shape (..., position.size)."""
    first = stencil_start(position.astype(np.intp), values.shape[-1])
    weights = lagrange_weights(position - first)
    terms = [weights[:, node] * values[..., first + node] for node in range(STENCIL)]
    return np.asarray(sum(terms))
