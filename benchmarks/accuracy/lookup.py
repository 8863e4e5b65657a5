"""Check the error bounds of interpolated responses: `python -m benchmarks.accuracy.lookup` after `make reproduce`.

Random points over the whole range of the cubes of a pulse are evaluated by interpolation and by the solver; `--spectra`
holds a folder for each pulse, `--count` is the number of points of each kind and tolerance. Reported are the share that
the cubes answer, that of the points that survive ("survive"), and of the answers that with a number of impacts, wrong
outcomes and numbers, errors above the bound of the response, and the time per point.
"""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.measure import arguments, columns, finish, progress
from rocking._lookup.cube import Cube, Points, open_cube
from rocking._solver.peak_response import peak_response

KINDS = {
    "on slices": (False, False),
    "between restitutions": (True, False),
    "between angles": (False, True),
    "between both": (True, True),
}
"""Whether restitution and slenderness angle of the points lie between those of the cubes."""

CHUNK = 100_000
"""Points solved in one call."""


def random_points(cube: Cube, count: int, between: tuple[bool, bool], random: np.random.Generator) -> Points:
    """Return random points, uniform in 1/a, log omega, eta and alpha, or at stored values of the latter two."""
    first = cube.slice_at(0)
    assert first is not None
    low, high = np.log(first.axes["frequency_ratio"][[0, -1]])
    levels = (cube.restitutions, first.axes["alpha"])
    eta, alpha = (
        random.uniform(values[0], values[-1], count) if free else random.choice(values, count)
        for values, free in zip(levels, between, strict=True)
    )
    slenderness = random.uniform(first.axes["slenderness"][0], first.axes["slenderness"][-1], count)
    return Points(slenderness, np.exp(random.uniform(low, high, count)), eta, alpha)


def compare_with_solver(cube: Cube, points: Points, tolerance: float) -> dict[str, float]:
    """Compare the responses of the cubes with the solver."""
    start = time.perf_counter()
    known, found = cube.interpolate(points, tolerance, threads=1)
    seconds = time.perf_counter() - start
    every = peak_response(cube.pulse, **vars(points))
    found = found[known]
    surviving = ~found.overturned
    error = np.abs(found.peak_rotation - every.peak_rotation[known])[surviving]
    return {
        "answered": float(known.sum()),
        "surviving": float((~every.overturned).sum()),
        "surviving_answered": float((known & ~every.overturned).sum()),
        "wrong_outcomes": float((found.outcome != every.outcome[known]).sum()),
        "counted": float((found.impacts >= 0).sum()),
        "wrong_impacts": float(((found.impacts >= 0) & (found.impacts != every.impacts[known])).sum()),
        "wrong_exceeded_alpha": float((found.exceeded_alpha != every.exceeded_alpha[known]).sum()),
        "bounds_broken": float((error > found.error_bound[surviving]).sum()),
        "largest_share_of_bound": float((error / found.error_bound[surviving]).max(initial=0.0)),
        "seconds": seconds,
    }


def measure(folder: Path, count: int, tolerance: float, seed: int) -> dict[str, dict[str, float]]:
    """Evaluate all kinds of points on the cubes of one pulse."""
    cube = open_cube(folder)
    record = {}
    for kind, between in KINDS.items():
        random = np.random.default_rng(seed)
        parts = [
            compare_with_solver(cube, random_points(cube, CHUNK, between, random), tolerance)
            for _ in range(max(1, count // CHUNK))
        ]
        total = {name: sum(part[name] for part in parts) for name in parts[0]}
        total_points = CHUNK * len(parts)
        record[kind] = total | {
            "points": total_points,
            "share": total["answered"] / total_points,
            "share_of_surviving": total["surviving_answered"] / max(total["surviving"], 1.0),
            "share_with_impacts": total["counted"] / max(total["answered"], 1.0),
            "largest_share_of_bound": max(part["largest_share_of_bound"] for part in parts),
            "microseconds": 1e6 * total["seconds"] / total_points,
        }
    return record


def table(record: dict[str, Any]) -> str:
    """Format all rows: errors in outcome, impacts, exceeded_alpha and bounds; largest share of a bound."""
    errors = {"wrong_outcomes": "outc.", "wrong_impacts": "impacts", "wrong_exceeded_alpha": "alpha"}
    bounds = {"bounds_broken": "bounds", "largest_share_of_bound": "used", "microseconds": "us"}
    shares = {"share": "share", "share_of_surviving": "survive", "share_with_impacts": "counted"}
    return columns(record["rows"], pulse="", tolerance="", kind="", **shares, **errors, **bounds)


if __name__ == "__main__":
    out = Path("results/benchmarks/lookup.json")
    options = arguments(__doc__, spectra=Path("results/spectra"), count=1_000_000, seed=1, out=out)
    rows = []
    for folder in sorted(path for path in options.spectra.iterdir() if path.is_dir()):
        for tolerance in (1e-4, 1e-6):
            for kind, found in measure(folder, options.count, tolerance, options.seed).items():
                rows.append({"pulse": folder.name, "tolerance": tolerance, "kind": kind} | found)
                progress(f"{folder.name}, {tolerance:.0e}, {kind}")
    finish({"rows": rows}, options.out, table)
