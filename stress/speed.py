"""Time of each cell on one core, without the overhead of a call."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

import rocking
from benchmarks.measure import shortest
from benchmarks.tables import Table

FEW, MANY = 8, 256
"""Copies of a cell in one call; few if a cell takes long."""

LONG_CELL = 20.0
"""Time above which few copies are used [us]."""

SLOW = 400.0
"""Time over the median ordinary cell above which a cell is slow and must have many impacts."""

MAX_PER_IMPACT = 1.0
"""Most single ordinary cells that an impact of a slow cell may take; slow cells are solved one by one, too."""

SINGLE_CELLS, SINGLE_ROUNDS = 24, 100
"""Ordinary cells, slender and rigid each, that are also solved in a call of their own, and how often."""


def microseconds(table: Table, rounds: int = 5) -> NDArray[np.float64]:
    """Return the processor time (cells,) [us], the smallest of some rounds."""
    found = np.empty(len(table))
    for k in range(len(table)):
        found[k] = _time_of_copies(table, k, FEW, 2)
        if found[k] < LONG_CELL:
            found[k] = _time_of_copies(table, k, MANY, rounds)
    return found


def single_times(ordinary: Table) -> dict[bool, float]:
    """Return the median time of ordinary cells solved one in a call, slender (False) and rigid (True) [us].

    The time of a call for a block that does not uplift is subtracted.
    """
    found: dict[bool, float] = {}
    for kind in (False, True):
        cells = np.flatnonzero((ordinary["alpha"] > 0.0) == kind)
        chosen = cells[np.linspace(0, cells.size - 1, SINGLE_CELLS).astype(int)]
        found[kind] = float(np.median([_time_of_copies(ordinary, k, 1, SINGLE_ROUNDS) for k in chosen]))
    return found


def relative_times(parts: Mapping[str, Mapping[str, NDArray[Any]]]) -> dict[str, NDArray[np.float64]]:
    """Return times (cells,) over the median of the ordinary cells, slender and rigid each over their own [-]."""
    ordinary = parts["ordinary"]
    usual = {kind: float(np.median(ordinary["time"][ordinary["rigid"] == kind])) for kind in (False, True)}
    return {name: part["time"] / np.where(part["rigid"], usual[True], usual[False]) for name, part in parts.items()}


def time_summary(
    times: NDArray[np.float64], part: Mapping[str, NDArray[Any]], single: Mapping[bool, float]
) -> dict[str, Any]:
    """Summarise times over the ordinary (cells,) [-], of which slow ones have many impacts.

    The time of an impact is given in single ordinary cells [-]; 0 if no cell is slow.
    """
    per_impact = part["time"] / np.where(part["rigid"], single[True], single[False]) / (1.0 + part["impacts"])
    return {
        "median": float(np.median(times)),
        "largest": float(np.max(times)),
        "slow_per_impact": float(np.max(per_impact[times > SLOW], initial=0.0)),
    }


def _time_of_copies(table: Table, k: int, copies: int, rounds: int) -> float:
    """Return the time of row `k` [us], from copies separated by blocks that never uplift.

    Equal neighbours would share their first flight.
    """
    cell, slenderness = table.inputs(k), np.full(2 * copies, 2.0)
    times = []
    for first in (2.0, cell["slenderness"]):
        slenderness[::2] = first
        groups = cell | {"slenderness": slenderness}
        times.append(shortest(partial(rocking.peak_response, str(table.pulse[k]), **groups, threads=1), rounds))
    return 1e6 * max(times[1] - times[0], 0.0) / copies
