"""One row of `benchmarks.ablations.suite`: work with and without one optimisation, and the times of both."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import asdict, dataclass, field
from typing import Any

from benchmarks.measure import progress


@dataclass(frozen=True)
class Ablation:
    """Work and time with and without one optimisation.

    Attributes
    ----------
    name : str
        Which work the optimisation avoids, and where.
    unit : str
        What is counted.
    done, without : int
        Exact counts with the optimisation and without it.
    seconds, seconds_without : list of float
        Time of each round [s], the rounds of both alternating; empty where it follows from the counts.
    changed : int
        Number of results that the optimisation changes by one bit or more.
    note : str
        Remarks.
    """

    name: str
    unit: str
    done: int
    without: int
    seconds: list[float] = field(default_factory=list)
    seconds_without: list[float] = field(default_factory=list)
    changed: int = 0
    note: str = ""

    def record(self) -> dict[str, Any]:
        """Return the row for JSON."""
        return asdict(self)


def measure_both(
    title: str,
    with_optimisation: Callable[[], Any],
    without: Callable[[], Any],
    rounds: int,
    clock: Callable[[], float] = time.process_time,
) -> tuple[list[float], list[float]]:
    """Return the times of the rounds of two ways to the same result [s]."""
    times: tuple[list[float], list[float]] = ([], [])
    for k in range(rounds):
        for taken, call in zip(times, (with_optimisation, without), strict=True):
            start = clock()
            call()
            taken.append(clock() - start)
        progress(f"{title}: round {k + 1} of {rounds}")
    return times
