"""One family under examination: fates, errors, the promised bound, symmetries, times."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

import rocking
from rocking.solver.bounded_response import solve_with_bound
from stress.families import BY_NAME
from stress.solver import EPS, errors, solve, ulps_that_explain, wrong_events, wrong_fates
from stress.speed import microseconds
from stress.symmetries import symmetries
from stress.truth import INPUTS, Table

Array = NDArray[np.float64]


def examined(table: Table) -> tuple[dict[str, Any], dict[str, NDArray[Any]]]:
    """The record of a family, and the errors, kinds, times and impacts (cells,) [-, -, us, -] that it sums up."""
    found = solve(table)
    error = errors(table, found)
    rigid = table["alpha"] > 0.0
    times = microseconds(table)
    record = {
        "why": BY_NAME[table.family].why,
        "cells": len(table),
        "rigid": int(rigid.sum()),
        "stand": int(np.isfinite(table["peak_rotation"]).sum()),
        "most_impacts": int(table["impacts"].max()),
        "wrong": wrong_cells(table, found),
        "peak": summary(error.peak),
        "largest_conditioning": float(np.max(table["peak_rotation_per_ulp"]) / EPS),
        **{name: summary(values) for name, values in error._asdict().items() if name != "peak"},
        "worst_cell": table.cell(int(np.argmax(np.nan_to_num(error.peak_in_ulps)))),
        "beyond_promised_bound": beyond_promised_bound(table),
        "symmetries": symmetries(table, found),
    }
    return record, {"error": error.peak_in_ulps, "rigid": rigid, "time": times, "impacts": found.impacts}


def wrong_cells(table: Table, found: rocking.Response) -> list[dict[str, Any]]:
    """Every cell whose fate or events are not the exact ones, with the ulps of the input that explain it."""
    fates, events = wrong_fates(table, found), wrong_events(table, found)
    return [
        table.cell(k)
        | {"wrong": "fate" if fates[k] else "events", "explained_by_ulps": ulps_that_explain(table, k, found)}
        for k in map(int, np.flatnonzero(fates | events))
    ]


def beyond_promised_bound(table: Table) -> int:
    """Cells whose peak is further from the truth than `solve_with_bound` says, the source of the service's bounds."""
    beyond = 0
    for pulse in np.unique(table.pulse):
        rows = table.pulse == pulse
        exact = table["peak_rotation"][rows]
        answer = solve_with_bound(str(pulse), **{name: table[name][rows] for name in INPUTS})
        with np.errstate(invalid="ignore"):
            beyond += int(np.sum(np.abs(answer.peak_rotation - exact) > answer.error_bound))
    return beyond


def summary(values: Array) -> dict[str, float]:
    """Median and largest of those that are known."""
    known = values[np.isfinite(values)]
    if len(known) == 0:
        return {"median": 0.0, "largest": 0.0}
    return {"median": float(np.median(known)), "largest": float(np.max(known))}
