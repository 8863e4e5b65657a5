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
from numpy.typing import NDArray

from benchmarks.baselines.methods import OPTIONAL, Method, methods
from benchmarks.measure import Task, accuracy, arguments, finish, in_rounds, progress, spread, versions
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
    """Return the accuracy of a method at a setting with its compilation time, and the task to be timed."""
    start = time.perf_counter()
    method.peaks(setting, cells.select(np.arange(min(2, len(cells)))))
    first = time.perf_counter() - start
    row = {"setting": setting, "cells": len(cells), "first_call_s": first}
    copies = cells if method.name != "rocking" else cells.select(np.tile(np.arange(len(cells)), COPIES))
    start = time.perf_counter()
    row |= accuracy(method.peaks(setting, cells), cells["peak_rotation"])
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
        "time_ratios": {
            measure: {name: time_ratios(rows_of, name, measure) for name in rows_of if name != "rocking"}
            for measure in MEASURES
        },
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


def time_ratios(
    rows_of: dict[str, list[dict[str, Any]]], name: str, measure: str
) -> dict[str, dict[str, float] | None]:
    """Return the time of a baseline over that of the package at equal errors; None where one does not reach it."""
    found: dict[str, dict[str, float] | None] = {}
    for error in TARGETS:
        ratio = least_times(rows_of[name], error, measure) / least_times(rows_of["rocking"], error, measure)
        found[f"{error:.0e}"] = None if np.isnan(ratio).all() else spread(ratio)
    return found


def fastest_baselines(
    record: dict[str, Any], measure: str, prefix: str = ""
) -> dict[str, tuple[str, dict[str, float]] | None]:
    """Return the fastest baseline at each error and its time over that of the package; None where none reaches it.

    Only baselines whose name starts with `prefix` are considered.
    """
    baselines = {name: one for name, one in record["time_ratios"][measure].items() if name.startswith(prefix)}
    found: dict[str, tuple[str, dict[str, float]] | None] = {}
    for error in (f"{error:.0e}" for error in TARGETS):
        reached = [(name, baseline[error]) for name, baseline in baselines.items() if baseline[error]]
        found[error] = min(reached, key=lambda pair: pair[1]["median"], default=None)
    return found


def table(record: dict[str, Any]) -> str:
    """Format the record as text."""
    columns = ("median", "smallest", "largest", "error", "99 %", "largest", "outcomes")
    lines = [f"{'one core, us a cell':24}{'setting':>9}" + "".join(f"{column:>10}" for column in columns)]
    for name, rows in record["methods"].items():
        for row in rows:
            setting = "tightest" if row["setting"] is None else f"{row['setting']:g}"
            lines.append(
                f"{name:24}{setting:>9}"
                + "".join(f"{value:10.2f}" for value in spread(row["us"]).values())
                + "".join(f"{row[key]:10.1e}" for key in ("median_error", "error_99", "largest_error"))
                + f"{row['wrong_outcomes']:10d}"
            )
    for measure, baselines in record["time_ratios"].items():
        title = f"times rocking, {measure.replace('_', ' ')}"
        lines.append("\n" + f"{title:33}" + "".join(f"{error:>10.0e}" for error in TARGETS))
        for name, found in baselines.items():
            lines.append(
                f"{name:33}" + "".join("         -" if r is None else f"{r['median']:10.1f}" for r in found.values())
            )
    lines.extend(f"\n{baseline} cannot be imported and is omitted" for baseline in record["missing_baselines"])
    return "\n".join(lines)


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
