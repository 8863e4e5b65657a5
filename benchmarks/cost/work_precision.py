"""Run time of a cell on one core against its error, one diagram: `python -m benchmarks.cost.work_precision NAME`.

Diagrams are slender-sine, slender-ricker, rigid-sine (20 degrees) and rigid-ricker: restitution 0.85, 32 frequency
ratios log-spaced from 0.5 to 10 by 32 slendernesses from 0.05 to 0.95. Every method runs at several settings; SciPy
gets every fourth row and column. The rounds of all methods alternate, so that other load on the machine affects all of
them alike. Times are processor times without compilation. Errors are relative to the 192-bit tables in benchmarks/data.
"""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from benchmarks.baselines.methods import OPTIONAL, Method, methods
from benchmarks.measure import Task, accuracy, arguments, columns, finish, in_rounds, progress, spread, versions
from benchmarks.tables import Table, read_table

TARGETS = (1e-3, 1e-6, 1e-9, 1e-12)
"""Errors at which the methods are compared."""

MEASURES = ("median_error", "error_99")
"""Definitions of the error of a method at a setting: the median over the cells, or their 99 % quantile."""

COPIES = 16
"""Copies of the cells in one call to the package, so that the overhead of the call is negligible."""

MIN_ERROR = 1e-17
"""Smaller errors are replaced by this one: doubles do not resolve them."""

SLOW_CALL, SLOW_ROUNDS = 1.0, 2
"""A call that takes longer than this [s] is measured only in every so many rounds."""


def sample(cells: Table) -> Table:
    """Return every fourth row and column of the grid of one diagram."""
    side = math.isqrt(len(cells))
    return cells.select(np.arange(len(cells)).reshape(side, side)[2::4, 2::4].ravel())


def measure_accuracy(method: Method, setting: float | None, cells: Table) -> tuple[dict[str, Any], Task]:
    """Return the accuracy of a method at a setting, and the task to be timed."""
    method.peaks(setting, cells.select(np.arange(min(2, len(cells)))))  # compiles
    copies = cells if method.name != "rocking" else cells.select(np.tile(np.arange(len(cells)), COPIES))
    start = time.perf_counter()
    row = {"setting": setting, "cells": len(cells)} | accuracy(method.peaks(setting, cells), cells["peak_rotation"])
    every = SLOW_ROUNDS if time.perf_counter() - start > SLOW_CALL else 1
    return row, Task(lambda: method.peaks(setting, copies), len(copies), every)


def measure(diagram: str, rounds: int, cells: Table) -> dict[str, Any]:
    """Measure all methods; return one record."""
    sampled = sample(cells)
    rows_of: dict[str, list[dict[str, Any]]] = {}
    tasks = {}
    for method in methods(str(cells.pulse[0])):
        progress(f"{diagram}: accuracy of {method.name}")
        rows_of[method.name] = []
        for setting in method.settings:
            row, tasks[method.name, setting] = measure_accuracy(method, setting, sampled if method.slow else cells)
            rows_of[method.name].append(row)
    times = in_rounds(tasks, rounds, diagram)
    for name, rows in rows_of.items():
        for row in rows:
            row["us"] = times[name, row["setting"]]
    return {
        "diagram": diagram,
        "cells": {"all": len(cells), "overturned": int(np.isnan(cells["peak_rotation"]).sum()), "sample": len(sampled)},
        "rounds": rounds,
        "methods": rows_of,
        "missing_baselines": [baseline for baseline in OPTIONAL if not find_spec(baseline)],
        "versions": versions("numpy", "scipy", "numba", *OPTIONAL),
    }


def time_for(error: float, times: Sequence[float], errors: Sequence[float]) -> float:
    """Return the least time in which a method reaches an error; nan if none of its settings does.

    Between two settings log(time) is linear in log(error). A setting counts only if none with a smaller error is
    faster. The result does not increase with the error, and it is constant above the largest measured error.
    """
    if not len(errors):
        return math.nan
    order = np.argsort(errors)
    reached = np.maximum(np.asarray(errors, dtype=np.float64)[order], MIN_ERROR)
    if not error >= reached[0]:
        return math.nan
    least = np.minimum.accumulate(np.asarray(times, dtype=np.float64)[order])
    return float(np.exp(np.interp(math.log(error), np.log(reached), np.log(least))))


def least_times(rows: list[dict[str, Any]], error: float, measure: str) -> NDArray[np.float64]:
    """Return the least time of a method (rounds,) for an error; a setting with a wrong outcome reaches no error."""
    correct = [row for row in rows if row["wrong_outcomes"] == 0]
    errors = [row[measure] for row in correct]
    rounds = range(len(rows[0]["us"]))
    return np.array([time_for(error, [row["us"][k] for row in correct], errors) for k in rounds])


def fastest_baselines(rows_of: dict[str, list[dict[str, Any]]], measure: str, prefix: str = "") -> dict[str, str]:
    """Return the fastest baseline at each error, and its time over that of the package: median and range of the rounds.

    Only baselines whose name starts with `prefix` are considered; "-" where none reaches the error.
    """
    found = {}
    for error in TARGETS:
        ours, ratios = least_times(rows_of["rocking"], error, measure), {}
        for name in rows_of.keys() - {"rocking"}:
            ratio = least_times(rows_of[name], error, measure) / ours
            if name.startswith(prefix) and not np.isnan(ratio).all():
                ratios[name] = spread(ratio)
        best = min(ratios, key=lambda name: ratios[name]["median"], default=None)
        text = "{median:,.1f} ({smallest:,.1f} to {largest:,.1f})"
        found[f"{error:.0e}"] = "-" if best is None else f"{best} {text.format(**ratios[best])}"
    return found


def table(record: dict[str, Any]) -> str:
    """Format the record as text."""
    rows = [
        {**row, **spread(row["us"]), "method": name, "setting": row["setting"] or "tightest"}
        for name, rows in record["methods"].items()
        for row in rows
    ]
    errors = {"median_error": "error", "error_99": "99 %", "largest_error": "largest", "wrong_outcomes": "outcomes"}
    times = {"median": "us a cell", "smallest": "smallest", "largest": "largest"}
    best = {
        f"fastest {prefix or 'baseline'} over rocking, {measure}": fastest_baselines(record["methods"], measure, prefix)
        for measure in MEASURES
        for prefix in ("", "scipy")
    }
    missing = [f"{baseline} cannot be imported and is omitted" for baseline in record["missing_baselines"]]
    tables = columns(rows, method="", setting="", **times, **errors), pd.DataFrame(best).T.to_string()
    return "\n\n".join([*tables, *missing])


def main() -> None:
    """Command line; `--coarse 4` uses only every fourth row and column of the grid."""
    options = arguments(__doc__, diagram=str, rounds=5, coarse=1, out=Path("results/benchmarks"))
    cells = read_table(options.diagram)
    side = math.isqrt(len(cells))
    indices = np.arange(len(cells)).reshape(side, side)[:: options.coarse, :: options.coarse]
    record = measure(options.diagram, options.rounds, cells.select(indices.ravel()))
    finish(record, options.out / f"work-precision-{options.diagram}.json", table)


if __name__ == "__main__":
    main()
