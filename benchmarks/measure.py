"""Shared by all benchmarks: options, times in alternating rounds, errors against the reference, JSON records."""

from __future__ import annotations

import argparse
import json
import math
import platform
import sys
import time
from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike, NDArray

Name = TypeVar("Name", bound=Hashable)

MIN_MEASURED_TIME = 0.02
"""Minimum processor time of one measurement [s]."""


class Task(NamedTuple):
    """A call that solves `cells` cells; it is measured in every `every`-th round, the first included."""

    call: Callable[[], Any]
    cells: int
    every: int = 1


def microseconds(task: Task) -> float:
    """Return the processor time per cell [us], averaged over as many calls as one measurement needs."""
    start, calls = time.process_time(), 0
    while calls == 0 or time.process_time() - start < MIN_MEASURED_TIME:
        task.call()
        calls += 1
    return 1e6 * (time.process_time() - start) / (calls * task.cells)


def in_rounds(tasks: Mapping[Name, Task], rounds: int, title: str) -> dict[Name, list[float]]:
    """Return processor times per cell [us] (rounds,) of each task, nan in rounds without it.

    The tasks alternate within a round, so that other load on the machine affects all of them alike.
    """
    times: dict[Name, list[float]] = {name: [] for name in tasks}
    for k in range(rounds):
        for name, task in tasks.items():
            times[name].append(microseconds(task) if k % task.every == 0 else math.nan)
        progress(f"{title}: round {k + 1} of {rounds}")
    return times


def shortest(call: Callable[[], Any], rounds: int) -> float:
    """Return the least processor time of a call in some rounds [s]."""
    times = []
    for _ in range(rounds):
        start = time.process_time()
        call()
        times.append(time.process_time() - start)
    return min(times)


def progress(text: str) -> None:
    """Print a progress message to stderr."""
    print(text, file=sys.stderr, flush=True)


def spread(values: ArrayLike) -> dict[str, float]:
    """Return the median, smallest and largest value, ignoring nan."""
    return {
        "median": float(np.nanmedian(values)),
        "smallest": float(np.nanmin(values)),
        "largest": float(np.nanmax(values)),
    }


def relative_error(found: NDArray[np.float64], exact: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return |found - exact|/exact of peak rotations, nan where either block overturns."""
    return np.abs(found / exact - 1.0)


def accuracy(found: NDArray[np.float64], exact: NDArray[np.float64]) -> dict[str, float | int]:
    """Return the number of wrong outcomes, and quantiles of the relative error of the peak where both survive."""
    error = relative_error(found, exact)
    return {
        "wrong_outcomes": int(np.sum(np.isnan(found) != np.isnan(exact))),
        "median_error": float(np.nanmedian(error)),
        "error_99": float(np.nanquantile(error, 0.99)),
        "largest_error": float(np.nanmax(error)),
    }


def versions(*packages: str) -> dict[str, str]:
    """Return the versions of Python and of those of the packages that are installed."""
    found = {"python": platform.python_version()}
    for package in packages:
        try:
            found[package] = version(package)
        except PackageNotFoundError:
            continue
    return found


def columns(rows: pd.DataFrame | Iterable[Mapping[str, Any]], **titles: str) -> str:
    """Format the columns of rows that have a title."""
    found = pd.DataFrame(rows)[[*titles]]
    return found.to_string(index=False, header=[*titles.values()], float_format="{:.4g}".format)


def save(record: dict[str, Any], path: Path) -> None:
    """Write a record as JSON."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(record, indent=1) + "\n", encoding="utf-8")


def arguments(about: str | None, given: Sequence[str] | None = None, **options: Any) -> argparse.Namespace:
    """Read a command line, that of the process unless it is given; its help is `about`, the docstring of a module.

    Each option has its default, and the type of it; a list takes several values of the type of its first one. A type in
    place of a default: an argument that must be given, by its place.
    """
    parser = argparse.ArgumentParser(description=about, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name, default in options.items():
        if isinstance(default, type):
            parser.add_argument(name, type=default)
            continue
        several = {"type": type(default[0]), "nargs": "+"} if isinstance(default, list) else {"type": type(default)}
        option = f"--{name.replace('_', '-')}"
        parser.add_argument(option, default=default, help="default: %(default)s", metavar="VALUE", **several)
    return parser.parse_args(given)


def finish(record: dict[str, Any], path: Path, table: Callable[[dict[str, Any]], str]) -> None:
    """Write a record and print it as a table, which is written beside it."""
    save(record, path)
    text = table(record)
    path.with_suffix(".txt").write_text(f"{path.stem}\n{text}\n\n", encoding="utf-8")
    print(f"{text}\n\nwritten to {path}")
