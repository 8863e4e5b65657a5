"""Time of one slender cell on one core, its error, and the same of scipy: `python -m benchmarks.slender_cell`.

The grid: one sine, restitution 0.85; 800 frequency ratios, log-spaced from 0.5 to 12; 800 slendernesses, 0.02 to 0.85.
Rounds of ours and of scipy's DOP853 (rtol 1e-9, on a random sample of the same cells) alternate, so that a busy machine
hurts both; times are processor time of the one thread, wall-clock time beside it. Errors are against the
multi-precision integration of tests/tools.
"""

from __future__ import annotations

import argparse
import math
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import rocking
from benchmarks.measure import accuracy, in_rounds, save, spread, versions
from benchmarks.scipy_peer import peak_rotation
from tests.tools.exact_response import working_precision
from tests.tools.multiprecision import integrate

RESTITUTION = 0.85
FREQUENCY_RATIO, SLENDERNESS = (0.5, 12.0), (0.02, 0.85)
FIRST_CALL = """
import time
begin = time.perf_counter()
import rocking
imported = time.perf_counter()
rocking.peak_response("sine", slenderness=0.4, frequency_ratio=5.0, restitution=0.85)
first = time.perf_counter()
rocking.peak_response("sine", slenderness=0.4, frequency_ratio=5.0, restitution=0.85)
print(imported - begin, first - imported, time.perf_counter() - first)
"""


def grid(count: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Slenderness and frequency ratio [-], both (count, count)."""
    slenderness, frequency_ratio = np.meshgrid(np.linspace(*SLENDERNESS, count), np.geomspace(*FREQUENCY_RATIO, count))
    return slenderness, frequency_ratio


def ours(slenderness: NDArray[np.float64], frequency_ratio: NDArray[np.float64]) -> NDArray[np.float64]:
    """Peak rotation by the package on one core, nan where overturned."""
    response = rocking.peak_response(
        "sine", slenderness=slenderness, frequency_ratio=frequency_ratio, restitution=RESTITUTION, threads=1
    )
    return response.peak_rotation


def peer(slenderness: NDArray[np.float64], frequency_ratio: NDArray[np.float64]) -> NDArray[np.float64]:
    """Peak rotation by scipy, nan where overturned."""
    cells = zip(slenderness, frequency_ratio, strict=True)
    return np.array([peak_rotation(s, w, RESTITUTION) for s, w in cells])


def truth(slenderness: NDArray[np.float64], frequency_ratio: NDArray[np.float64]) -> NDArray[np.float64]:
    """Peak rotation in multi-precision arithmetic, rounded to doubles, nan where overturned."""
    peaks = []
    with working_precision(192):
        for s, w in zip(slenderness, frequency_ratio, strict=True):
            exact = integrate("sine", slenderness=s, frequency_ratio=w, restitution=RESTITUTION).peak_rotation
            peaks.append(math.nan if exact is None else float(exact))
    return np.array(peaks)


def first_calls() -> dict[str, dict[str, float]]:
    """Seconds to import, to the first and second answer, in a new process: fresh copy of the package, then cached."""
    with tempfile.TemporaryDirectory() as folder:
        source = Path(rocking.__file__).parent
        shutil.copytree(source, Path(folder) / "rocking", ignore=shutil.ignore_patterns("__pycache__"))
        answers = {}
        for state in ("compiled", "cached"):
            done = subprocess.run(
                [sys.executable, "-c", FIRST_CALL], cwd=folder, capture_output=True, text=True, check=True
            )
            names = ("import", "first_call", "second_call")
            answers[state] = dict(zip(names, map(float, done.stdout.split()), strict=True))
    return answers


def measure(count: int, sample: int, rounds: int, seed: int, *, fresh: bool) -> dict[str, Any]:
    """All of it, as one record; `fresh` includes what a new process waits for."""
    slenderness, frequency_ratio = grid(count)
    random = np.random.default_rng(seed)
    chosen = random.choice(slenderness.size, sample, replace=False)
    some_slenderness, some_frequency_ratio = slenderness.ravel()[chosen], frequency_ratio.ravel()[chosen]
    copies = max(1, 100_000 // sample)
    many_slenderness, many_frequency_ratio = np.tile(some_slenderness, copies), np.tile(some_frequency_ratio, copies)
    ours(some_slenderness, some_frequency_ratio)  # the first calls compile
    peer(some_slenderness[:1], some_frequency_ratio[:1])
    tasks: dict[str, tuple[Callable[[], Any], int]] = {
        "ours_grid": (lambda: ours(slenderness, frequency_ratio), slenderness.size),
        "ours_sample": (lambda: ours(many_slenderness, many_frequency_ratio), many_slenderness.size),
        "scipy_sample": (lambda: peer(some_slenderness, some_frequency_ratio), sample),
    }
    times = in_rounds(tasks, rounds)
    pairs = zip(times["scipy_sample"]["processor"], times["ours_sample"]["processor"], strict=True)
    exact = truth(some_slenderness, some_frequency_ratio)
    found, theirs = ours(some_slenderness, some_frequency_ratio), peer(some_slenderness, some_frequency_ratio)
    return {
        "cells": {"grid": slenderness.size, "sample": sample, "sample_overturned": int(np.isnan(exact).sum())},
        "rounds": rounds,
        "microseconds_per_cell": {name: spread(clocks["processor"]) for name, clocks in times.items()},
        "wall_microseconds_per_cell": {name: spread(clocks["wall"]) for name, clocks in times.items()},
        "scipy_over_ours": spread([theirs / ours for theirs, ours in pairs]),
        "accuracy": {
            "ours": accuracy(found, exact),
            "scipy": accuracy(theirs, exact),
            "ours_against_scipy": accuracy(found, theirs),
        },
        "seconds_to_answer": first_calls() if fresh else {},
        "versions": versions("numpy", "scipy", "numba"),
    }


def table(record: dict[str, Any]) -> str:
    """The record in a few lines."""
    lines = [f"{'one core':24}{'median':>10}{'smallest':>10}{'largest':>10}   us a cell (processor time)"]
    for name, times in record["microseconds_per_cell"].items():
        lines.append(f"{name:24}" + "".join(f"{times[key]:10.3f}" for key in ("median", "smallest", "largest")))
    lines.append(
        f"{'scipy over ours':24}"
        + "".join(f"{record['scipy_over_ours'][key]:10.0f}" for key in ("median", "smallest", "largest"))
    )
    lines.append(f"\n{'against truth':24}{'median':>10}{'largest':>10}{'fates':>10}   relative error, wrong fates")
    for name, error in record["accuracy"].items():
        lines.append(f"{name:24}{error['median_error']:10.1e}{error['largest_error']:10.1e}{error['wrong_fates']:10d}")
    if record["seconds_to_answer"]:
        lines.append(f"\n{'new process':24}{'import':>10}{'first':>10}{'second':>10}   s to answer one cell")
    for name, seconds in record["seconds_to_answer"].items():
        lines.append(f"{name:24}" + "".join(f"{value:10.4f}" for value in seconds.values()))
    return "\n".join(lines)


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=800, help="nodes along each axis of the grid")
    parser.add_argument("--sample", type=int, default=200, help="cells given to scipy")
    parser.add_argument("--rounds", type=int, default=9)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", type=Path, default=Path("results/benchmarks/slender-cell.json"))
    parser.add_argument(
        "--fresh", action=argparse.BooleanOptionalAction, default=True, help="compile anew, and time it"
    )
    options = parser.parse_args()
    record = measure(options.count, options.sample, options.rounds, options.seed, fresh=options.fresh)
    save(record, options.out)
    print(table(record))
    print(f"\nwritten to {options.out}")


if __name__ == "__main__":
    main()
