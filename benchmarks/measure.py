"""What all benchmarks share: times in alternating rounds, errors against the truth, the versions that they speak of."""

from __future__ import annotations

import json
import platform
import sys
import time
from collections.abc import Callable, Hashable, Mapping
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

Name = TypeVar("Name", bound=Hashable)


def microseconds(task: Callable[[], Any], cells: int) -> tuple[float, float]:
    """Processor and wall-clock time per cell [us]."""
    processor, wall = time.process_time(), time.perf_counter()
    task()
    return 1e6 * (time.process_time() - processor) / cells, 1e6 * (time.perf_counter() - wall) / cells


def in_rounds(tasks: Mapping[Name, tuple[Callable[[], Any], int]], rounds: int) -> dict[Name, dict[str, list[float]]]:
    """Times per cell [us] of tasks, each with its number of cells, in rounds: a busy machine hurts all alike."""
    times: dict[Name, dict[str, list[float]]] = {name: {"processor": [], "wall": []} for name in tasks}
    for k in range(rounds):
        for name, (task, cells) in tasks.items():
            processor, wall = microseconds(task, cells)
            times[name]["processor"].append(processor)
            times[name]["wall"].append(wall)
        progress(f"round {k + 1} of {rounds}")
    return times


def progress(text: str) -> None:
    """Tell who waits."""
    print(text, file=sys.stderr, flush=True)


def spread(values: list[float]) -> dict[str, float]:
    """Median, smallest and largest."""
    return {"median": float(np.median(values)), "smallest": min(values), "largest": max(values)}


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
