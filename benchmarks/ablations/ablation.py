"""One row of `benchmarks.ablations.suite`: work done with and without one optimisation, and the times of both."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import asdict, dataclass, field
from typing import Any

from benchmarks.measure import progress


@dataclass(frozen=True)
class Ablation:
    """One thing that is not done.

    Attributes
    ----------
    name : str
        What is skipped, and where.
    unit : str
        What is counted.
    done, without : int
        How many of them with the skip and without it, exactly.
    seconds, seconds_without : list of float
        Time of each round [s], the rounds of both alternating; none where it follows from the counts.
    changed : int
        Answers that the skip changes, by as much as a bit.
    note : str
        What else was seen.
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
        """For JSON."""
        return asdict(self)


def alternately(
    title: str,
    once: Callable[[], Any],
    without: Callable[[], Any],
    rounds: int,
    clock: Callable[[], float] = time.process_time,
) -> tuple[list[float], list[float]]:
    """Seconds of each round of two ways to the same answer."""
    times: tuple[list[float], list[float]] = ([], [])
    for k in range(rounds):
        for taken, call in zip(times, (once, without), strict=True):
            start = clock()
            call()
            taken.append(clock() - start)
        progress(f"{title}: round {k + 1} of {rounds}")
    return times
