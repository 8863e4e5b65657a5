"""Error of the peak rotation against the requested tolerance: `python -m benchmarks.accuracy.tolerance`.

A thousand random cells of benchmarks/data, all pulses: rigid blocks of 0.01 to 1.2 rad, slender blocks under wavelets;
omega 0.1 to 15, 1/a 0.02 to 0.98, eta 0.3 to 1. The error is |peak - exact|/exact where both survive. The condition
number of a cell is the relative change of its peak over that of an input, the largest over all inputs. An error within
tolerance times condition number is as small as the effect of a relative change of the inputs by the tolerance.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import rocking
from benchmarks.measure import accuracy, arguments, columns, finish, progress, relative_error, versions
from benchmarks.tables import Table, read_table

TOLERANCES = tuple(10.0**-k for k in range(4, 14))
EPS = float(np.finfo(float).eps)


def peaks(cells: Table, tolerance: float | None) -> NDArray[np.float64]:
    """Return peak rotations (cells,) by the package, nan where overturned; a tolerance of None is the smallest."""
    found = np.empty(len(cells))
    for pulse in np.unique(cells.pulse):
        here = cells.pulse == pulse
        found[here] = rocking.peak_response(
            str(pulse), **cells.inputs(here), relative_tolerance=tolerance
        ).peak_rotation
    return found


def summary(cells: Table, found: NDArray[np.float64], tolerance: float | None) -> dict[str, Any]:
    """Return counts and quantiles at one tolerance; the smallest is compared with the resolution of doubles."""
    error = relative_error(found, cells["peak_rotation"])
    allowed = EPS if tolerance is None else tolerance
    explained = allowed * np.maximum(cells["peak_rotation_per_ulp"] / EPS, 1.0)
    return accuracy(found, cells["peak_rotation"]) | {
        "tolerance": tolerance,
        "above": int(np.sum(error > allowed)),
        "above_tenfold": int(np.sum(error > 10.0 * allowed)),
        "above_and_unexplained": int(np.sum(error > explained)),
        "largest_over_explained": float(np.nanmax(error / explained)),
    }


def table(record: dict[str, Any]) -> str:
    """Format the record as text."""
    above = {"above": "above", "above_tenfold": "10 x", "above_and_unexplained": "unexpl."}
    errors = {"wrong_outcomes": "outcomes", "median_error": "error", "error_99": "99 %", "largest_error": "largest"}
    rows = [row | {"tolerance": row["tolerance"] or "tightest"} for row in record["tolerances"]]
    text = columns(rows, tolerance="", **above, **errors, largest_over_explained="/ expl.")
    survive = f"{record['cells']} cells, {record['surviving']} of them survive"
    return f"{text}\n\n{survive}; tightest compared with {EPS:.1e}"


if __name__ == "__main__":
    options = arguments(__doc__, out=Path("results/benchmarks/tolerance.json"))
    cells = read_table("random")
    rows = []
    for tolerance in (*TOLERANCES, None):
        progress("tightest" if tolerance is None else f"tolerance {tolerance:.0e}")
        rows.append(summary(cells, peaks(cells, tolerance), tolerance))
    record = {
        "cells": len(cells),
        "surviving": int(np.sum(~np.isnan(cells["peak_rotation"]))),
        "tolerances": rows,
        "versions": versions("numpy", "numba"),
    }
    finish(record, options.out, table)
