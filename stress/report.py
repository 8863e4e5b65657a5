"""Records of the families: outcomes, errors, error bounds, symmetries, times; their tables; violated requirements."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

import rocking
from benchmarks.tables import Table
from rocking._solver.bounded_response import solve_with_bound
from stress.families import BY_NAME
from stress.solver import EPS, errors, solve, ulps_that_explain, wrong_events, wrong_outcomes
from stress.speed import MAX_PER_IMPACT, microseconds
from stress.symmetries import symmetries

MAX_ERROR_IN_ULPS = 1000.0
"""Maximum error of the peak over the effect of one ulp of the input: three of sixteen digits lost by rounding."""

EXACT_SYMMETRIES = ("mirror", "neighbours", "size_4", "units_1024")


def evaluate_family(table: Table) -> tuple[dict[str, Any], dict[str, NDArray[Any]]]:
    """Return the record of a family, and the errors, kinds, times and impacts (cells,) [-, -, us, -] behind it."""
    found = solve(table)
    error = errors(table, found)
    rigid = table["alpha"] > 0.0
    times = microseconds(table)
    record = {
        "reason": BY_NAME[table.name].reason,
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
        response = solve_with_bound(str(pulse), **table.inputs(rows))
        with np.errstate(invalid="ignore"):
            beyond += int(np.sum(np.abs(response.peak_rotation - exact) > response.error_bound))
    return beyond


def summary(values: NDArray[np.float64]) -> dict[str, float]:
    """Return the median and the largest of the finite values."""
    finite = values[np.isfinite(values)]
    if len(finite) == 0:
        return {"median": 0.0, "largest": 0.0}
    return {"median": float(np.median(finite)), "largest": float(np.max(finite))}


TABLES = {
    "family | cells | rigid | survive | impacts up to | wrong outcomes | events | unexplained"
    " | time median | largest | per impact": (
        "{name} | {cells} | {rigid} | {survive} | {max_impacts} | {outcome} | {events} | {unexplained}"
        " | {time[median]:.2g} | {time[largest]:.2g} | {time[slow_per_impact]:.2g}"
    ),
    "family | error median | largest | conditioning up to | over explained median | largest"
    " | uplift | impact | bound": (
        "{name} | {peak[median]:.1e} | {peak[largest]:.1e} | {largest_conditioning:.1e}"
        " | {peak_in_ulps[median]:.2g} | {peak_in_ulps[largest]:.2g}"
        " | {uplift_time_in_ulps[largest]:.2g} | {impact_time_in_ulps[largest]:.2g} | {beyond_error_bound}"
    ),
    "family | mirror | neighbours | size x 4 | units x 1024"
    " | size x 3.7 outcomes | largest | units mm and ms outcomes | largest": (
        "{name} | {same[mirror][identical]} | {same[neighbours][identical]} | {same[size_4][identical]}"
        " | {same[units_1024][identical]} | {same[size_3.7][other_outcomes]} | {same[size_3.7][largest_in_ulps]:.2g}"
        " | {same[units_mm_ms][other_outcomes]} | {same[units_mm_ms][largest_in_ulps]:.2g}"
    ),
}
"""Heads of the tables, and a row: outcomes and times; errors; cells that keep their bits, and changes of the others."""


def markdown(records: Mapping[str, Mapping[str, Any]]) -> str:
    """Return the tables."""
    rows = []
    for name, record in records.items():
        wrong = {kind: sum(cell["wrong"] == kind for cell in record["wrong"]) for kind in ("outcome", "events")}
        counts = {"name": name, "unexplained": len(unexplained(record)), **wrong}
        rows.append({**record, **counts, "same": record["symmetries"]})
    texts = []
    for head, row in TABLES.items():
        lines = [head, " | ".join(["---"] * len(head.split("|"))), *(row.format_map(one) for one in rows)]
        texts.append("".join(f"| {line} |\n" for line in lines))
    return "\n".join(texts)


def unexplained(record: Mapping[str, Any]) -> list[Any]:
    """Return the wrong cells that one unit in the last place of the input does not explain."""
    return [cell for cell in record["wrong"] if cell["explained_by_ulps"] != 1]


def violations(records: Mapping[str, Mapping[str, Any]]) -> list[str]:
    """Return the violated requirements as text; each family states its own, symmetries are required of all."""
    found = []
    for name, record in records.items():
        largest_error, slow = record["peak_in_ulps"]["largest"], record["time"]["slow_per_impact"]
        checked = {
            "outcomes": (
                len(unexplained(record)),
                "wrong outcomes or events that one ulp of the input does not explain",
            ),
            "bounds": (record["beyond_error_bound"], "peaks beyond their error bound"),
            "digits": (
                largest_error if largest_error > MAX_ERROR_IN_ULPS else 0,
                "times the effect of one ulp is the largest error",
            ),
            "times": (
                slow if slow > MAX_PER_IMPACT else 0,
                "single ordinary cells per impact is the time of a slow cell",
            ),
        }
        checked = {requirement: checked[requirement] for requirement in BY_NAME[name].requirements}
        for symmetry in EXACT_SYMMETRIES:
            same = record["symmetries"][symmetry]
            checked[symmetry] = (same["cells"] - same["identical"], f"cells differ in their bits: {symmetry}")
        found += [f"{name}: {value:.2g} {text}" for value, text in checked.values() if value > 0]
    return found
