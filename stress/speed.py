"""Time of each cell on one core, without the cost of a call."""

from __future__ import annotations

import time
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

import rocking
from stress.truth import INPUTS, Table

FEW, MANY = 8, 256
"""Copies of a cell in one call; few if a cell takes long."""

LONG = 20.0
"""Microseconds from which on a cell takes long."""

SLOW = 100.0
"""Time over the median ordinary cell from which on a cell counts as slow, and has to have many impacts."""


def microseconds(table: Table, rounds: int = 5) -> NDArray[np.float64]:
    """Processor time (cells,) [us], the smallest of some rounds; each cell in the company of its like."""
    found = np.empty(len(table))
    for k, pulse in enumerate(table.pulse):
        cell = {name: float(table[name][k]) for name in INPUTS}
        found[k] = _in_company(str(pulse), cell, FEW, 2)
        if found[k] < LONG:
            found[k] = _in_company(str(pulse), cell, MANY, rounds)
    return found


def over_ordinary(parts: Mapping[str, Mapping[str, NDArray[Any]]]) -> dict[str, NDArray[np.float64]]:
    """Times (cells,) over the median of the ordinary cells, slender and rigid each over their own [-]."""
    ordinary = parts["ordinary"]
    usual = {kind: float(np.median(ordinary["time"][ordinary["rigid"] == kind])) for kind in (False, True)}
    return {name: part["time"] / np.where(part["rigid"], usual[True], usual[False]) for name, part in parts.items()}


def times_in_short(times: NDArray[np.float64], impacts: NDArray[np.int64], table: Table) -> dict[str, Any]:
    """Of times over the ordinary (cells,) [-] with the impacts that were followed; 0 to an impact if none is slow."""
    per_impact = times / (1.0 + impacts)
    return {
        "median": float(np.median(times)),
        "largest": float(np.max(times)),
        "slowest_cell": table.cell(int(np.argmax(times))),
        "slow_per_impact": float(np.max(per_impact[times > SLOW], initial=0.0)),
    }


def _in_company(pulse: str, cell: dict[str, float], copies: int, rounds: int) -> float:
    """Blocks that never uplift stand between the copies: neighbours that are equal would share their first flight."""
    slenderness = np.full(2 * copies, 2.0)
    idle = min(_seconds(pulse, cell | {"slenderness": slenderness}) for _ in range(rounds))
    slenderness[::2] = cell["slenderness"]
    busy = min(_seconds(pulse, cell | {"slenderness": slenderness}) for _ in range(rounds))
    return 1e6 * max(busy - idle, 0.0) / copies


def _seconds(pulse: str, question: dict[str, object]) -> float:
    began = time.process_time()
    rocking.peak_response(pulse, threads=1, **question)  # type: ignore[arg-type]  # the groups by name
    return time.process_time() - began
