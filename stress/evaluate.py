"""Evaluation of one family: outcomes, errors, error bounds, symmetries, times."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

import rocking
from rocking._solver.bounded_response import solve_with_bound
from stress.families import BY_NAME
from stress.solver import EPS, errors, solve, ulps_that_explain, wrong_events, wrong_outcomes
from stress.speed import microseconds
from stress.symmetries import symmetries
from stress.tables import INPUTS, Table

Array = NDArray[np.float64]


def evaluate_family(table: Table) -> tuple[dict[str, Any], dict[str, NDArray[Any]]]:
    """Return the record of a family, and the errors, kinds, times and impacts (cells,) [-, -, us, -] behind it."""
    found = solve(table)
    error = errors(table, found)
    rigid = table["alpha"] > 0.0
    times = microseconds(table)
    record = {
        "reason": BY_NAME[table.family].reason,
        "cells": len(table),
        "rigid": int(rigid.sum()),
        "survive": int(np.isfinite(table["peak_rotation"]).sum()),
        "max_impacts": int(table["impacts"].max()),
        "wrong": wrong_cells(table, found),
        "peak": summary(error.peak),
        "largest_conditioning": float(np.max(table["peak_rotation_per_ulp"]) / EPS),
        **{name: summary(values) for name, values in error._asdict().items() if name != "peak"},
        "worst_cell": table.cell(int(np.argmax(np.nan_to_num(error.peak_in_ulps)))),
        "beyond_error_bound": count_beyond_error_bound(table),
        "symmetries": symmetries(table, found),
    }
    return record, {"error": error.peak_in_ulps, "rigid": rigid, "time": times, "impacts": found.impacts}


def wrong_cells(table: Table, found: rocking.Response) -> list[dict[str, Any]]:
    """Return every cell with a wrong outcome or wrong events, with the ulps of the input that explain it."""
    outcomes, events = wrong_outcomes(table, found), wrong_events(table, found)
    return [
        table.cell(k)
        | {"wrong": "outcome" if outcomes[k] else "events", "explained_by_ulps": ulps_that_explain(table, k, found)}
        for k in map(int, np.flatnonzero(outcomes | events))
    ]


def count_beyond_error_bound(table: Table) -> int:
    """Return the number of cells whose error exceeds the bound of `solve_with_bound`, which the service uses."""
    beyond = 0
    for pulse in np.unique(table.pulse):
        rows = table.pulse == pulse
        exact = table["peak_rotation"][rows]
        response = solve_with_bound(str(pulse), **{name: table[name][rows] for name in INPUTS})
        with np.errstate(invalid="ignore"):
            beyond += int(np.sum(np.abs(response.peak_rotation - exact) > response.error_bound))
    return beyond


def summary(values: Array) -> dict[str, float]:
    """Return the median and the largest of the finite values."""
    finite = values[np.isfinite(values)]
    if len(finite) == 0:
        return {"median": 0.0, "largest": 0.0}
    return {"median": float(np.median(finite)), "largest": float(np.max(finite))}
