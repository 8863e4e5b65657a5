"""Time and memory of 10^3 to 10^8 cells, on one and two threads: `python -m benchmarks.cost.growth`.

The cells form square grids under one sine, restitution 0.85: omega 0.5 to 12 log-spaced by 1/a 0.02 to 0.85, slender
blocks and blocks of 20 degrees. Each size runs in its own process, so that its peak memory is known; grids of more than
10^6 cells are solved in groups of rows, which bounds the memory. The number of overturned blocks is recorded: it must
not depend on the number of threads.
"""

from __future__ import annotations

import argparse
import json
import math
import resource
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.figures.growth import draw
from benchmarks.measure import progress, publish, spread, versions
from rocking._solver.peak_response import peak_response

PULSE, RESTITUTION = "sine", 0.85
FREQUENCY_RATIO, SLENDERNESS = (0.5, 12.0), (0.02, 0.85)
SIDES = {"slender": (32, 100, 316, 1000, 3162, 10_000), "rigid": (32, 100, 316, 1000, 3162)}
"""Nodes along each axis of the grids."""

ALPHA = {"slender": 0.0, "rigid": math.radians(20.0)}
CHUNK = 1_000_000
"""Maximum number of cells in one call."""

MIN_TIME, MAX_REPEATS = 1.0, 25
"""A size is repeated until this time [s] or this number of repeats is reached."""


def overturned(kind: str, side: int, threads: int) -> int:
    """Return the number of blocks of a grid that overturn."""
    slenderness, frequency_ratio = np.linspace(*SLENDERNESS, side), np.geomspace(*FREQUENCY_RATIO, side)
    rows = max(1, CHUNK // side)
    return sum(
        int(
            np.isnan(
                peak_response(
                    PULSE,
                    slenderness=slenderness,
                    frequency_ratio=frequency_ratio[start : start + rows, None],
                    restitution=RESTITUTION,
                    alpha=ALPHA[kind],
                    threads=threads,
                ).peak_rotation
            ).sum()
        )
        for start in range(0, side, rows)
    )


def measure_grid(kind: str, side: int, threads: int) -> dict[str, Any]:
    """Return the times of a grid [s], repeated while time allows, and the memory of this process [bytes]."""
    overturned(kind, 4, threads)  # load the kernels
    before = memory()
    wall: list[float] = []
    count = 0
    while not wall or (sum(wall) < MIN_TIME and len(wall) < MAX_REPEATS):
        start = time.perf_counter()
        count = overturned(kind, side, threads)
        wall.append(time.perf_counter() - start)
    return {
        "kind": kind,
        "cells": side * side,
        "threads": threads,
        "overturned": count,
        "seconds": wall,
        "peak_bytes": memory(),
        "idle_bytes": before,
    }


def memory() -> int:
    """Return the largest resident memory of this process so far [bytes]."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1 if sys.platform == "darwin" else 1024)


def in_new_process(kind: str, side: int, threads: int) -> dict[str, Any]:
    """Call `measure_grid` in a new process."""
    command = [sys.executable, "-m", "benchmarks.cost.growth", "--one", kind, str(side), str(threads)]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    found: dict[str, Any] = json.loads(done.stdout)
    return found


def measure(largest: int, threads: tuple[int, ...]) -> dict[str, Any]:
    """Measure all grids with at most `largest` cells; return one record."""
    sizes = []
    for kind, sides in SIDES.items():
        for side in (side for side in sides if side * side <= largest):
            for count in threads:
                progress(f"growth: {side * side} {kind} cells, {count} thread{'s' if count > 1 else ''}")
                sizes.append(in_new_process(kind, side, count))
    return {"sizes": sizes, "versions": versions("numpy", "numba")}


def table(record: dict[str, Any]) -> str:
    """Format the record as text."""
    titles = ("cells", "threads", "s", "us a cell", "smallest", "largest", "MB", "overturned")
    lines = [f"{'':9}" + "".join(f"{title:>11}" for title in titles)]
    for one in record["sizes"]:
        cell = {key: 1e6 * value / one["cells"] for key, value in spread(one["seconds"]).items()}
        lines.append(
            f"{one['kind']:9}{one['cells']:11d}{one['threads']:11d}{np.median(one['seconds']):11.4f}"
            + "".join(f"{cell[key]:11.3f}" for key in ("median", "smallest", "largest"))
            + f"{one['peak_bytes'] / 1e6:11.0f}{one['overturned']:11d}"
        )
    return "\n".join(lines)


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--one", nargs=3, metavar=("KIND", "SIDE", "THREADS"), help="one size, printed as JSON")
    parser.add_argument("--largest", type=int, default=10**8, help="cells of the largest grid")
    parser.add_argument("--threads", type=int, nargs="+", default=[1, 2])
    parser.add_argument("--out", type=Path, default=Path("results/benchmarks/growth.json"))
    options = parser.parse_args()
    if options.one:
        kind, side, threads = options.one
        print(json.dumps(measure_grid(kind, int(side), int(threads))))
        return
    record = measure(options.largest, tuple(options.threads))
    publish(record, options.out, draw, table)


if __name__ == "__main__":
    main()
