"""Time of each cell on one core, without the cost of a call."""

from __future__ import annotations

import time

import numpy as np
from numpy.typing import NDArray

import rocking
from stress.truth import INPUTS, Table

FEW, MANY = 8, 256
"""Copies of a cell in one call; few if a cell takes long."""

LONG = 20.0
"""Microseconds from which on a cell takes long."""


def microseconds(table: Table, rounds: int = 5) -> NDArray[np.float64]:
    """Processor time (cells,) [us], the smallest of some rounds; each cell in the company of its like."""
    found = np.empty(len(table))
    for k, pulse in enumerate(table.pulse):
        cell = {name: float(table[name][k]) for name in INPUTS}
        found[k] = _in_company(str(pulse), cell, FEW, 2)
        if found[k] < LONG:
            found[k] = _in_company(str(pulse), cell, MANY, rounds)
    return found


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
