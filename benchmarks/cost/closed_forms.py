"""Closed forms against tracing with the solver: `python -m benchmarks.cost.closed_forms`.

The overturning curves of the slender block under the sine at one restitution, 1/a 0.02 to 1, omega 0.2 to 15: by
(3.10), (3.18), (3.20) and (3.21) at as many frequency ratios as the traced curves of these modes have points, and
traced from a grid of 301 x 301 blocks. Processor time of one thread, in alternating rounds.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.measure import Task, arguments, finish, in_rounds, spread, versions
from rocking._boundary.tracing import overturning_boundary
from rocking.paper.overturning import overturning_amplitudes

WINDOW: dict[str, Any] = {"slenderness": (0.02, 1.0), "frequency_ratio": (0.2, 15.0), "nodes": 301}
RESTITUTION = 0.85


def measure(rounds: int) -> dict[str, Any]:
    """Return the number of points, and times of both ways [ms]."""

    def traced() -> Any:
        return overturning_boundary("sine", restitution=RESTITUTION, threads=1, **WINDOW)

    curves = traced()
    known = np.isin(curves.impacts.values, (0, 1))  # the modes that the closed forms know
    points = int(curves.row_size.values[known].sum())
    low, high = WINDOW["frequency_ratio"]
    omega = np.geomspace(low, high, points)
    tasks = {
        "closed forms": Task(lambda: overturning_amplitudes(omega, RESTITUTION), 1),
        "tracing": Task(traced, 1),
    }
    times = in_rounds(tasks, rounds, "closed forms")
    return {"points": points, **{name: spread(np.array(found) / 1000) for name, found in times.items()}}


def table(record: dict[str, Any]) -> str:
    """Format the times as text."""
    closed, traced = record["closed forms"]["median"], record["tracing"]["median"]
    return f"{record['points']} points: {closed:.0f} ms against {traced:.0f} ms, {traced / closed:.1f} times as fast"


if __name__ == "__main__":
    options = arguments(__doc__, rounds=7, out=Path("results/benchmarks/closed-forms.json"))
    finish(measure(options.rounds) | {"versions": versions("numpy", "numba")}, options.out, table)
