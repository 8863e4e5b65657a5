"""What all benchmarks share: times in alternating rounds, errors against the truth, the versions that they speak of."""

from __future__ import annotations

import json
import math
import platform
import sys
import time
from collections.abc import Callable, Hashable, Mapping
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

Name = TypeVar("Name", bound=Hashable)

SHORTEST = 0.02
"""Processor time that is measured at least [s]."""


class Task(NamedTuple):
    """A call that answers so many cells; `every` says in which rounds it takes part, the first one included."""

    call: Callable[[], Any]
    cells: int
    every: int = 1


def microseconds(task: Task) -> float:
    """Processor time per cell [us], of as many calls as it takes to see them on the clock."""
    start, calls = time.process_time(), 0
    while calls == 0 or time.process_time() - start < SHORTEST:
        task.call()
        calls += 1
    return 1e6 * (time.process_time() - start) / (calls * task.cells)


def in_rounds(tasks: Mapping[Name, Task], rounds: int, title: str) -> dict[Name, list[float]]:
    """Processor times per cell [us] (rounds,) of tasks, nan where one paused: a busy machine hurts all alike."""
    times: dict[Name, list[float]] = {name: [] for name in tasks}
    for k in range(rounds):
        for name, task in tasks.items():
            times[name].append(microseconds(task) if k % task.every == 0 else math.nan)
        progress(f"{title}: round {k + 1} of {rounds}")
    return times


def progress(text: str) -> None:
    """Tell who waits."""
    print(text, file=sys.stderr, flush=True)


def spread(values: ArrayLike) -> dict[str, float]:
    """Median, smallest and largest of those that are known."""
    return {
        "median": float(np.nanmedian(values)),
        "smallest": float(np.nanmin(values)),
        "largest": float(np.nanmax(values)),
    }


def relative_error(found: NDArray[np.float64], exact: NDArray[np.float64]) -> NDArray[np.float64]:
    """|found - exact|/exact of peaks, nan where one of them overturns."""
    return np.abs(found / exact - 1.0)


def accuracy(found: NDArray[np.float64], exact: NDArray[np.float64]) -> dict[str, float | int]:
    """Wrong fates; relative error of the peak where both stand."""
    error = relative_error(found, exact)
    return {
        "wrong_fates": int(np.sum(np.isnan(found) != np.isnan(exact))),
        "median_error": float(np.nanmedian(error)),
        "error_99": float(np.nanquantile(error, 0.99)),
        "largest_error": float(np.nanmax(error)),
    }


def versions(*packages: str) -> dict[str, str]:
    """Of Python and of those of the packages that are installed."""
    found = {"python": platform.python_version()}
    for package in packages:
        try:
            found[package] = version(package)
        except PackageNotFoundError:
            continue
    return found


def save(record: dict[str, Any], path: Path) -> None:
    """As JSON."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(record, indent=1) + "\n")
