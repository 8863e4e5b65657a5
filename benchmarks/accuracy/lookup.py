"""Do the cubes keep what they promise? `python -m benchmarks.accuracy.lookup` after `make reproduce`.

Random questions over all that the cubes of a pulse span, answered by interpolation and by the solver: the share that
the cubes answer, wrong fates, errors above the bound that comes with the answer, time of a question.
"""

from __future__ import annotations

import argparse
import json
import time
from pathlib import Path
from typing import Any

import numpy as np

from rocking.lookup.cube import Cube, Points
from rocking.lookup.open import open_cube
from rocking.solver.peak_response import peak_response

KINDS = {
    "on the levels": (False, False),
    "between restitutions": (True, False),
    "between angles": (False, True),
    "between both": (True, True),
}
"""Whether the restitution and the slenderness angle of the questions lie between those of the cubes."""

PART = 100_000
"""Questions solved at a time."""


def questions(cube: Cube, count: int, between: tuple[bool, bool], random: np.random.Generator) -> Points:
    """Random questions, uniform in 1/a, log omega, eta and alpha, or on the levels of the latter two."""
    level = cube.level(0)
    assert level is not None
    low, high = np.log(level.frequency_ratio[[0, -1]])
    levels = (cube.restitutions, level.alpha)
    eta, alpha = (
        random.uniform(values[0], values[-1], count) if free else random.choice(values, count)
        for values, free in zip(levels, between, strict=True)
    )
    slenderness = random.uniform(level.slenderness[0], level.slenderness[-1], count)
    return Points(slenderness, np.exp(random.uniform(low, high, count)), eta, alpha)


def judge(cube: Cube, points: Points, tolerance: float) -> dict[str, float]:
    """What the cubes answer, held against the solver."""
    start = time.perf_counter()
    known, found = cube.promised(points, tolerance)
    seconds = time.perf_counter() - start
    asked = points[known]
    true = peak_response(cube.pulse, **vars(asked))
    standing = ~found.overturned
    error = np.abs(found.peak_rotation - true.peak_rotation)[standing]
    return {
        "answered": float(known.sum()),
        "wrong_fates": float((found.outcome != true.outcome).sum()),
        "wrong_about_alpha": float((found.exceeded_alpha != true.exceeded_alpha).sum()),
        "bounds_broken": float((error > found.error_bound[standing]).sum()),
        "largest_share_of_bound": float((error / found.error_bound[standing]).max(initial=0.0)),
        "seconds": seconds,
    }


def measure(folder: Path, count: int, tolerance: float, seed: int) -> dict[str, dict[str, float]]:
    """All kinds of questions to the cubes of one pulse."""
    cube = open_cube(folder)
    record = {}
    for kind, between in KINDS.items():
        random = np.random.default_rng(seed)
        parts = [judge(cube, questions(cube, PART, between, random), tolerance) for _ in range(max(1, count // PART))]
        total = {name: sum(part[name] for part in parts) for name in parts[0]}
        asked = PART * len(parts)
        record[kind] = total | {
            "questions": asked,
            "share": total["answered"] / asked,
            "largest_share_of_bound": max(part["largest_share_of_bound"] for part in parts),
            "microseconds": 1e6 * total["seconds"] / asked,
        }
    return record


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--spectra", type=Path, default=Path("results/spectra"), help="folder with a folder per pulse")
    parser.add_argument("--count", type=int, default=1_000_000, help="questions of each kind and tolerance")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", type=Path, default=Path("results/benchmarks/lookup.json"))
    options = parser.parse_args()
    record: dict[str, Any] = {}
    print(
        f"{'':38}{'share':>8}{'fates':>7}{'alpha':>7}{'bounds':>8}{'used':>7}{'us':>7}   wrong or broken; of the bound"
    )
    for folder in sorted(path for path in options.spectra.iterdir() if path.is_dir()):
        for tolerance in (1e-4, 1e-6):
            found = measure(folder, options.count, tolerance, options.seed)
            record.setdefault(folder.name, {})[str(tolerance)] = found
            for kind, row in found.items():
                print(
                    f"{folder.name:10}{tolerance:<8.0e}{kind:20}{row['share']:8.4f}{row['wrong_fates']:7.0f}"
                    f"{row['wrong_about_alpha']:7.0f}{row['bounds_broken']:8.0f}{row['largest_share_of_bound']:7.2f}"
                    f"{row['microseconds']:7.2f}",
                    flush=True,
                )
    options.out.parent.mkdir(parents=True, exist_ok=True)
    options.out.write_text(json.dumps(record, indent=1) + "\n")
    print(f"\nwritten to {options.out}")


if __name__ == "__main__":
    main()
