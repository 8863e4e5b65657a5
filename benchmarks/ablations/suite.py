"""Work that the package avoids, compared with doing it: `python -m benchmarks.ablations.suite`.

Counts are exact. Times are processor times of alternating rounds. The package has no option to do the avoided work:
the switches are in these modules.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.ablations import grids, motion, reruns, startup
from benchmarks.ablations.ablation import Ablation
from benchmarks.measure import progress, save, versions

SIDE, NODES, ROUNDS = 128, 241, 3
"""Blocks along an axis of the control plane; nodes of the grid on which boundaries are searched, as in the reproduction
for rigid blocks; rounds."""


def of_motion(rounds: int) -> Iterator[Ablation]:
    """Yield the ablations of the solver."""
    yield from motion.motions(SIDE, rounds)
    yield motion.no_uplift(SIDE, rounds)
    yield from motion.first_flights(SIDE, rounds)
    yield grids.precision(SIDE, rounds)


def of_grids(rounds: int) -> Iterator[Ablation]:
    """Yield the ablations of boundaries and cubes."""
    yield from grids.tracing(NODES, rounds)
    yield from grids.probes(rounds)


def of_startup(results: Path, rounds: int) -> Iterator[Ablation]:
    """Yield the ablations of the start of the commands and the service."""
    yield from startup.imports(rounds)
    found = startup.cubes(results, rounds)
    if found is not None:
        yield found


def table(record: dict[str, Any]) -> str:
    """Format the ablations as text."""
    lines = [f"{'':58}{'counted':>24}{'done':>12}{'without':>19}{'s':>9}{'without':>9}{'changed':>9}"]
    for one in record["ablations"]:
        times = [f"{np.median(one[key]):9.3g}" if one[key] else f"{'':9}" for key in ("seconds", "seconds_without")]
        counts = f"{one['unit']:>24}{one['done']:12,d}{one['without']:19,d}"
        lines.append(f"{one['name']:58}{counts}{''.join(times)}{one['changed']:9d}")
        if one["note"]:
            lines.append(f"    {one['note']}")
    return "\n".join(lines)


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument(
        "--results", type=Path, default=Path("results"), help="results of the reproduction, for its cubes"
    )
    parser.add_argument("--rounds", type=int, default=ROUNDS)
    parser.add_argument("--out", type=Path, default=Path("results/benchmarks/ablations.json"))
    options = parser.parse_args()
    kinds = {
        "motion": of_motion(options.rounds),
        "grids": of_grids(options.rounds),
        "jobs": reruns.reruns(reruns.CHANGES, options.rounds),
        "startup": of_startup(options.results, options.rounds),
    }
    found = []
    for kind, ablations in kinds.items():
        progress(kind)
        found += [one.record() for one in ablations]
    record = {"ablations": found, "versions": versions("numpy", "numba", "snakemake")}
    save(record, options.out)
    print(table(record))
    print(f"\nwritten to {options.out}")


if __name__ == "__main__":
    main()
