"""Run time of a cell on one core against its error, one diagram: `python -m benchmarks.cost.work_precision NAME`.

Diagrams are slender-sine, slender-ricker, rigid-sine (20 degrees) and rigid-ricker: restitution 0.85, 32 frequency
ratios, log-spaced from 0.5 to 10, by 32 slendernesses, 0.05 to 0.95. Every method runs at several settings; SciPy is
given every fourth row and column. Rounds of all of them alternate, so that a busy machine hurts all alike; times are
processor time, compilation apart. Errors are against the 192-bit integration kept in benchmarks/data.
"""

from __future__ import annotations

import argparse
import math
import time
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.baselines.methods import OPTIONAL, Method, methods
from benchmarks.cells import DIAGRAMS, Cells, read
from benchmarks.cost.equal_error import time_for
from benchmarks.measure import Task, accuracy, in_rounds, progress, save, spread, versions

TARGETS = (1e-3, 1e-6, 1e-9, 1e-12)
"""Errors at which the methods are compared."""

MEASURES = ("median_error", "error_99")
"""What is called the error of a method at a setting: that which half of the cells keep, or 99 of 100."""

COPIES = 16
"""Of the cells, in one call to the package: what a call costs by itself is no matter of the cells."""

PATIENCE, SLOW_ROUNDS = 1.0, 2
"""A call that takes longer [s] takes part in each second round only."""


def sample(cells: Cells) -> Cells:
    """Every fourth row and column of the grid of one diagram."""
    side = math.isqrt(len(cells))
    return cells.chosen(np.arange(len(cells)).reshape(side, side)[2::4, 2::4].ravel())


def tried(method: Method, setting: float | None, cells: Cells) -> tuple[dict[str, Any], Task]:
    """Accuracy of a method at a setting, with its compilation apart, and the task to be timed."""
    start = time.perf_counter()
    method.peaks(setting, cells.chosen(np.arange(min(2, len(cells)))))
    first = time.perf_counter() - start
    row = {"setting": setting, "cells": len(cells), "first_call_s": first}
    given = cells if method.name != "rocking" else cells.chosen(np.tile(np.arange(len(cells)), COPIES))
    start = time.perf_counter()
    row |= accuracy(method.peaks(setting, cells), cells.peak_rotation)
    every = SLOW_ROUNDS if time.perf_counter() - start > PATIENCE else 1
    return row, Task(lambda: method.peaks(setting, given), len(given), every)


def measure(diagram: str, rounds: int, cells: Cells) -> dict[str, Any]:
    """All of it, as one record."""
    few = sample(cells)
    table: dict[str, list[dict[str, Any]]] = {}
    tasks = {}
    for method in methods(DIAGRAMS[diagram][0]):
        progress(f"{diagram}: accuracy of {method.name}")
        table[method.name] = []
        for setting in method.settings:
            row, tasks[method.name, setting] = tried(method, setting, few if method.slow else cells)
            table[method.name].append(row)
    times = in_rounds(tasks, rounds, diagram)
    for name, rows in table.items():
        for row in rows:
            row["us"] = times[name, row["setting"]]
    return {
        "diagram": diagram,
        "cells": {"all": len(cells), "overturned": int(np.isnan(cells.peak_rotation).sum()), "sample": len(few)},
        "rounds": rounds,
        "methods": table,
        "time_over_ours": {
            measure: {name: ratios(table, name, measure) for name in table if name != "rocking"} for measure in MEASURES
        },
        "missing_peers": [peer for peer in OPTIONAL if not find_spec(peer)],
        "versions": versions("numpy", "scipy", "numba", *OPTIONAL),
    }


def least_times(rows: list[dict[str, Any]], error: float, measure: str) -> NDArray[np.float64]:
    """Least time of a method (rounds,) for an error; a setting with a wrong fate reaches none."""
    right = [row for row in rows if row["wrong_fates"] == 0]
    errors = [row[measure] for row in right]
    rounds = range(len(rows[0]["us"]))
    return np.array([time_for(error, [row["us"][k] for row in right], errors) for k in rounds])


def ratios(table: dict[str, list[dict[str, Any]]], name: str, measure: str) -> dict[str, dict[str, float] | None]:
    """Time of a peer over ours at equal errors, round by round; None where one of them does not reach it."""
    found: dict[str, dict[str, float] | None] = {}
    for error in TARGETS:
        ratio = least_times(table[name], error, measure) / least_times(table["rocking"], error, measure)
        found[f"{error:.0e}"] = None if np.isnan(ratio).all() else spread(ratio)
    return found


def best_peers(
    record: dict[str, Any], measure: str, beginning: str = ""
) -> dict[str, tuple[str, dict[str, float]] | None]:
    """The fastest peer at each error, with its time over ours; None where no peer gets there.

    Only those whose name begins like that are looked at.
    """
    peers = {name: one for name, one in record["time_over_ours"][measure].items() if name.startswith(beginning)}
    found: dict[str, tuple[str, dict[str, float]] | None] = {}
    for error in (f"{error:.0e}" for error in TARGETS):
        there = [(name, peer[error]) for name, peer in peers.items() if peer[error]]
        found[error] = min(there, key=lambda pair: pair[1]["median"], default=None)
    return found


def table_of(record: dict[str, Any]) -> str:
    """The record in lines."""
    columns = ("median", "smallest", "largest", "error", "99 %", "largest", "fates")
    lines = [f"{'one core, us a cell':24}{'setting':>9}" + "".join(f"{column:>10}" for column in columns)]
    for name, rows in record["methods"].items():
        for row in rows:
            setting = "tightest" if row["setting"] is None else f"{row['setting']:g}"
            lines.append(
                f"{name:24}{setting:>9}"
                + "".join(f"{value:10.2f}" for value in spread(row["us"]).values())
                + "".join(f"{row[key]:10.1e}" for key in ("median_error", "error_99", "largest_error"))
                + f"{row['wrong_fates']:10d}"
            )
    for measure, peers in record["time_over_ours"].items():
        title = f"times ours, {measure.replace('_', ' ')}"
        lines.append("\n" + f"{title:33}" + "".join(f"{error:>10.0e}" for error in TARGETS))
        for name, found in peers.items():
            lines.append(
                f"{name:33}" + "".join("         -" if r is None else f"{r['median']:10.1f}" for r in found.values())
            )
    lines.extend(f"\n{peer} cannot be imported here: left out" for peer in record["missing_peers"])
    return "\n".join(lines)


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("diagram", choices=DIAGRAMS)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--coarse", type=int, default=1, help="only every such row and column of the grid")
    parser.add_argument("--out", type=Path, help="by default results/benchmarks/work-precision-DIAGRAM.json")
    options = parser.parse_args()
    cells = read(options.diagram)
    side = math.isqrt(len(cells))
    kept = np.arange(len(cells)).reshape(side, side)[:: options.coarse, :: options.coarse]
    record = measure(options.diagram, options.rounds, cells.chosen(kept.ravel()))
    out = options.out or Path(f"results/benchmarks/work-precision-{options.diagram}.json")
    save(record, out)
    print(table_of(record))
    print(f"\nwritten to {out}")


if __name__ == "__main__":
    main()
