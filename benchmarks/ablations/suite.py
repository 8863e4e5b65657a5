"""Work that is not done, beside the same work done: `python -m benchmarks.ablations.suite`.

Counts are exact. Times are processor times, the rounds of both ways alternating; the switch lies here and never in the
package, which has no way to do what it skips.
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
"""Blocks along an axis of the plane; those of the grid on which boundaries are sought, as in the reproduction where
blocks are not slender."""


def of_motion(rounds: int) -> Iterator[Ablation]:
    """In one block and in many."""
    yield from motion.motions(SIDE, rounds)
    yield motion.no_uplift(SIDE, rounds)
    yield from motion.first_flights(SIDE, rounds)
    yield grids.precision(SIDE, rounds)


def of_grids(rounds: int) -> Iterator[Ablation]:
    """Of boundaries and of cubes."""
    yield from grids.tracing(NODES, rounds)
    yield from grids.shared_tracing(NODES, rounds)
    yield from grids.probes(rounds)


def of_startup(results: Path, rounds: int) -> Iterator[Ablation]:
    """Of the commands and the service."""
    yield from startup.imports(rounds)
    found = startup.cubes(results, rounds)
    if found is not None:
        yield found


def table(record: dict[str, Any]) -> str:
    """The skips in lines."""
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
    parser.add_argument("--results", type=Path, default=Path("results"), help="of the reproduction, for its cubes")
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
