"""Check the error bounds where slices are interpolated in two forms: `python -m benchmarks.accuracy.mixed_cells`.

In such a cell the peak is interpolated on some slices of restitution and angle, and (1 - peak)^2 on others
(`docs/lookup.md`). All of these cells are tried, each with `--points` random points of the cell and of the intervals
between its slices: few points of the whole range of the cubes lie in them. Reported for each pulse of `--spectra`: the
cells, the points, those that the cubes answer at a tolerance of `--tolerance`, the errors above the bound, the cells
with such an error, and the largest share of a bound that an error takes.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.accuracy.lookup import KINDS
from benchmarks.measure import arguments, columns, finish, progress
from rocking._interpolation.slices import slice_window
from rocking._interpolation.stencils import PEAK, SQUARED
from rocking._lookup.cube import Cube, Points, open_cube
from rocking._solver.peak_response import peak_response

CHUNK = 200_000
"""Points solved in one call."""


def stencils_of(cube: Cube) -> NDArray[np.int8]:
    """Return the stencils of all cells, (restitutions, angles, n, m)."""
    slices = [cube.slice_at(k) for k in range(cube.restitutions.size)]
    return np.array([one.layers.at(range(len(one.axes["alpha"])))["stencil"] for one in slices if one is not None])


def intervals(levels: NDArray[np.float64], between: bool) -> list[tuple[slice, tuple[float, float]]]:
    """Return the slices from which points are interpolated, and the ends of the interval in which these points lie."""
    if not between:
        return [(slice(k, k + 1), (level, level)) for k, level in enumerate(levels.tolist())]
    parts = []
    for k in range(levels.size - 1):
        first, size = slice_window(levels.size, k)
        parts.append((slice(first, first + size), (float(levels[k]), float(levels[k + 1]))))
    return parts


def mixed_points(
    cube: Cube, between: tuple[bool, bool], count: int, random: np.random.Generator
) -> Iterator[tuple[int, Points]]:
    """Yield the number of mixed cells between the same slices, and `count` random points of each of them."""
    first = cube.slice_at(0)
    assert first is not None
    rows, logs = first.axes["slenderness"], np.log(first.axes["frequency_ratio"])
    stencils = stencils_of(cube)
    for etas, eta_ends in intervals(cube.restitutions, between[0]):
        for angles, angle_ends in intervals(first.axes["alpha"], between[1]):
            around = stencils[etas, angles]
            squared, plain = around == SQUARED, around == PEAK
            mixed = (squared | plain).all(axis=(0, 1)) & squared.any(axis=(0, 1)) & plain.any(axis=(0, 1))
            i, j = np.nonzero(mixed)
            if not i.size:
                continue
            up, along, eta, angle = random.random((4, i.size, count))
            slenderness = rows[i, None] + up * (rows[i + 1] - rows[i])[:, None]
            frequency_ratio = np.exp(logs[j, None] + along * (logs[j + 1] - logs[j])[:, None])
            eta = eta_ends[0] + eta * (eta_ends[1] - eta_ends[0])
            angle = angle_ends[0] + angle * (angle_ends[1] - angle_ends[0])
            yield i.size, Points(*(values.ravel() for values in (slenderness, frequency_ratio, eta, angle)))


def errors_over_bounds(cube: Cube, points: Points, tolerance: float) -> NDArray[np.float64]:
    """Return the error of each answer over its bound, nan where the cubes do not answer; infinite if it overturns."""
    shares = np.full(points.slenderness.size, np.nan)
    for start in range(0, shares.size, CHUNK):
        part = points[start : start + CHUNK]
        known, found = cube.interpolate(part, tolerance)
        if known.any():
            exact = peak_response(cube.pulse, **vars(part[known]))
            error = np.abs(found.peak_rotation[known] - exact.peak_rotation) / found.error_bound[known]
            shares[start : start + CHUNK][known] = np.where(exact.overturned, np.inf, error)
    return shares


def measure(cube: Cube, between: tuple[bool, bool], count: int, tolerance: float, seed: int) -> dict[str, float]:
    """Try all mixed cells of one pulse between slices of one kind."""
    total = {"cells": 0, "points": 0, "answered": 0, "bounds_broken": 0, "cells_broken": 0}
    largest = 0.0
    for cells, points in mixed_points(cube, between, count, np.random.default_rng(seed)):
        shares = errors_over_bounds(cube, points, tolerance)
        broken = (shares > 1.0).reshape(cells, count)
        total["cells"] += cells
        total["points"] += shares.size
        total["answered"] += int((~np.isnan(shares)).sum())
        total["bounds_broken"] += int(broken.sum())
        total["cells_broken"] += int(broken.any(axis=1).sum())
        largest = max(largest, float(np.nan_to_num(shares, posinf=np.inf).max()))
    return total | {"largest_share_of_bound": largest}


def table(record: dict[str, Any]) -> str:
    """Format all rows."""
    names = {"cells": "cells", "points": "points", "answered": "answered"}
    errors = {"bounds_broken": "bounds", "cells_broken": "in cells", "largest_share_of_bound": "used"}
    return columns(record["rows"], pulse="", kind="", **names, **errors)


if __name__ == "__main__":
    out = Path("results/benchmarks/mixed_cells.json")
    options = arguments(__doc__, spectra=Path("results/spectra"), points=50, tolerance=1e-4, seed=1, out=out)
    rows = []
    for folder in sorted(path for path in options.spectra.iterdir() if path.is_dir()):
        cube = open_cube(folder)
        for kind, between in KINDS.items():
            if any(between):
                found = measure(cube, between, options.points, options.tolerance, options.seed)
                rows.append({"pulse": folder.name, "kind": kind} | found)
                progress(f"{folder.name}, {kind}")
    finish({"rows": rows}, options.out, table)
