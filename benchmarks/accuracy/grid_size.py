"""Interpolation error against the size of the grid: `python -m benchmarks.accuracy.grid_size`.

Cubes of one pulse and restitution, for slender blocks and blocks of 20 degrees, are filled as in the workflow, on the
grid of paper.yaml and on coarser and finer ones, in a temporary folder. Random points, uniform in 1/a and log omega,
are evaluated with the solver (the reference), with the interpolation of the package, and with linear interpolation
between the four surrounding nodes, which applies where all four survive or all four overturn. Errors are compared
where both interpolations give a peak.
"""

from __future__ import annotations

import argparse
import math
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
import yaml
from numpy.typing import NDArray

from benchmarks.figures.grid_size import draw
from benchmarks.measure import progress, publish, versions
from rocking._boundary.cells import crossed_cells
from rocking._datasets.cube import read_dataset, write_dataset
from rocking._lookup.cube import Points, open_cube
from rocking._solver.peak_response import peak_response
from rocking._spectra.cubes import spectra
from workflow.scripts import overturning
from workflow.scripts.axes import stepped

Vector = NDArray[np.float64]

CONFIG = Path(__file__).parents[2] / "workflow/config/paper.yaml"
PULSE, RESTITUTION, ANGLES = "sine", 0.85, (0.0, 20.0)
SCALES = (0.125, 0.25, 0.5, 1.0, 2.0)
"""Nodes along each axis relative to those of paper.yaml."""

LIMITS = (1e-4, 1e-6)
"""Error bounds for which the share of points that the cube can answer is reported."""


def axes(config: dict[str, Any], scale: float) -> tuple[Vector, Vector]:
    """Return slenderness and frequency_ratio of the configuration with `scale` times its nodes, distributed alike."""
    columns = config["grid"]["frequency_ratio"]
    rows = stepped(**config["grid"]["slenderness"])
    logs = np.linspace(math.log(columns["low"]), math.log(columns["high"]), columns["points"])

    def scaled(axis: Vector) -> Vector:
        places = np.linspace(0, axis.size - 1, round(scale * (axis.size - 1)) + 1)
        return np.asarray(np.interp(places, np.arange(axis.size), axis))

    return scaled(rows), np.exp(scaled(logs))


def build_cubes(folder: Path, config: dict[str, Any], scales: tuple[float, ...]) -> Iterator[tuple[Path, float]]:
    """Yield the cube of each grid and the time it took [s]."""
    curves = folder / "boundaries.nc"
    progress("grid size: boundaries")
    settings = config["boundary"] | {"alpha_deg": ANGLES, "restitution": RESTITUTION}
    overturning.main(pulse=PULSE, samples=[], **settings, boundaries=curves, provenance={}, threads=1)
    boundary, angles = read_dataset(curves), [math.radians(angle) for angle in ANGLES]
    for scale in scales:
        plane = axes(config, scale)
        start = time.perf_counter()
        barred = np.array([[crossed_cells(boundary, alpha, *plane) for alpha in angles]])
        grid = {"slenderness": plane[0], "frequency_ratio": plane[1], "alpha": angles}
        (cube,) = spectra(PULSE, restitution=[RESTITUTION], barred=barred, **grid)
        path = folder / f"{scale:g}.nc"
        write_dataset(cube, path)
        progress(f"grid size: {plane[0].size} x {plane[1].size} nodes")
        yield path, time.perf_counter() - start


def random_points(config: dict[str, Any], count: int, alpha: float, seed: int) -> Points:
    """Return random points over the window of the cubes, all at one angle [rad]."""
    random = np.random.default_rng(seed)
    breaks, w = config["grid"]["slenderness"]["breaks"], config["grid"]["frequency_ratio"]
    omega = np.exp(random.uniform(math.log(w["low"]), math.log(w["high"]), count))
    slenderness = random.uniform(breaks[0], breaks[-1], count)
    return Points(slenderness, omega, np.full(count, RESTITUTION), np.full(count, alpha))


def linear(layer: xr.Dataset, points: Points) -> tuple[NDArray[np.bool_], NDArray[np.float64]]:
    """Return where the four surrounding nodes share an outcome, and the interpolated peak, nan where overturned."""
    peak = layer["peak_rotation"].values
    (i, x), (j, y) = (
        between(layer["slenderness"].values, points.slenderness),
        between(np.log(layer["frequency_ratio"].values), np.log(points.frequency_ratio)),
    )
    corners = np.stack([peak[i, j], peak[i, j + 1], peak[i + 1, j], peak[i + 1, j + 1]])
    weights = np.stack([(1.0 - x) * (1.0 - y), (1.0 - x) * y, x * (1.0 - y), x * y])
    overturned = np.isnan(corners)
    return overturned.all(axis=0) | ~overturned.any(axis=0), (weights * corners).sum(axis=0)


def between(axis: Vector, value: Vector) -> tuple[NDArray[np.intp], Vector]:
    """Return the cell along an axis that contains each value, and the position in it [0, 1]."""
    cell = np.clip(np.searchsorted(axis, value, side="right") - 1, 0, axis.size - 2)
    return cell, (value - axis[cell]) / (axis[cell + 1] - axis[cell])


def quantiles(error: NDArray[np.float64]) -> dict[str, float]:
    """Return quantiles of absolute errors of the peak."""
    return {f"{share:g}": float(np.quantile(error, share)) for share in (0.5, 0.9, 0.99, 1.0)}


def compare_interpolations(path: Path, points: Points, exact: NDArray[np.float64]) -> dict[str, Any]:
    """Compare both interpolations on one cube with the solver."""
    cube = open_cube(path)
    known, answer = cube.interpolate(points, math.inf)
    package = np.full(exact.size, np.nan)
    answer = answer[known]
    package[known] = answer.peak_rotation
    bound = np.where(np.isnan(answer.peak_rotation), 0.0, answer.error_bound)
    with xr.open_dataset(path) as data:
        agreed, simple = linear(data.sel(alpha=points.alpha[0]), points)
    both = known & agreed & ~np.isnan(package) & ~np.isnan(simple) & ~np.isnan(exact)
    return {
        "package": {
            "answered": float(known.mean()),
            "wrong_outcomes": int((known & (np.isnan(package) != np.isnan(exact))).sum()),
            "error": quantiles(np.abs(package - exact)[both]),
            "within": {f"{limit:.0e}": float((bound <= limit).sum() / exact.size) for limit in LIMITS},
        },
        "linear": {
            "answered": float(agreed.mean()),
            "wrong_outcomes": int((agreed & (np.isnan(simple) != np.isnan(exact))).sum()),
            "error": quantiles(np.abs(simple - exact)[both]),
        },
    }


def measure(count: int, scales: tuple[float, ...], seed: int) -> dict[str, Any]:
    """Measure all grids; return one record."""
    config = yaml.safe_load(CONFIG.read_text())
    points_by_angle = {angle: random_points(config, count, math.radians(angle), seed) for angle in ANGLES}
    exact = {angle: peak_response(PULSE, **vars(points)).peak_rotation for angle, points in points_by_angle.items()}
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for scale, (path, seconds) in zip(scales, build_cubes(Path(folder), config, scales), strict=True):
            with xr.open_dataset(path) as data:
                nodes = [data.sizes["slenderness"], data.sizes["frequency_ratio"]]
            layers = {
                f"{angle:g}": compare_interpolations(path, points_by_angle[angle], exact[angle]) for angle in ANGLES
            }
            size = path.stat().st_size / len(ANGLES)
            rows.append({"scale": scale, "nodes": nodes, "bytes": size, "seconds": seconds, "alpha_deg": layers})
    return {
        "pulse": PULSE,
        "restitution": RESTITUTION,
        "points": count,
        "grids": rows,
        "versions": versions("numpy", "numba", "xarray"),
    }


def table(record: dict[str, Any]) -> str:
    """Format the record as text."""
    titles = ("cube 50 %", "90 %", "99 %", "outcomes", "bound 1e-4", "1e-6", "linear 50 %", "90 %", "99 %", "outcomes")
    lines = [f"{'alpha':>6}{'nodes':>12}{'kB':>8}" + "".join(f"{title:>12}" for title in titles)]
    for row in record["grids"]:
        for angle, found in row["alpha_deg"].items():
            lines.append(
                f"{angle:>6}{'{} x {}'.format(*row['nodes']):>12}{row['bytes'] / 1e3:8.0f}"
                + "".join(f"{found['package']['error'][share]:12.1e}" for share in ("0.5", "0.9", "0.99"))
                + f"{found['package']['wrong_outcomes']:12d}"
                + "".join(f"{found['package']['within'][f'{limit:.0e}']:12.3f}" for limit in LIMITS)
                + "".join(f"{found['linear']['error'][share]:12.1e}" for share in ("0.5", "0.9", "0.99"))
                + f"{found['linear']['wrong_outcomes']:12d}"
            )
    return "\n".join(lines)


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=200_000, help="random points at each angle")
    parser.add_argument(
        "--scales", type=float, nargs="+", default=SCALES, help="nodes along each axis relative to paper.yaml"
    )
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", type=Path, default=Path("results/benchmarks/grid-size.json"))
    options = parser.parse_args()
    record = measure(options.count, tuple(options.scales), options.seed)
    publish(record, options.out, draw, table)


if __name__ == "__main__":
    main()
