"""Responses of the solver to a table, and their errors relative to the conditioning."""

from __future__ import annotations

from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

import rocking
from benchmarks.tables import INPUTS, Cell, Table
from reference.conditioning import MAX_IMPACTS
from reference.exact_response import ExactResponse, working_precision
from reference.multiprecision import integrate
from rocking._model.fields import SOLVED_FIELDS

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
EPS = float(np.finfo(float).eps)

BITS = 128
"""Precision of the search for an explanation [bits]."""

ULPS = (1, 2, 4, 8, 16, 32, 64, 128, 256)
"""Units in the last place by which inputs are changed in search of the outcome that was found."""

LONG_RESPONSE, MAX_RESPONSE = 2_000, 20_000
"""Impacts above which that search uses one unit only, and above which there is no search."""


def solve(table: Table) -> rocking.Response:
    """Solve all rows, pulse by pulse."""
    fields: dict[str, NDArray[np.generic]] = {}
    for pulse in np.unique(table.pulse):
        rows = table.pulse == pulse
        response = rocking.peak_response(str(pulse), **table.inputs(rows))
        for field in SOLVED_FIELDS:
            name, values = field.name, getattr(response, field.name)
            fields.setdefault(name, np.empty(len(rows), values.dtype))[rows] = values
    return rocking.Response(**fields)  # type: ignore[arg-type]  # the fields by name, each of its own dtype


class Errors(NamedTuple):
    """Arrays (cells,) [-]; nan where there is nothing to compare."""

    peak: Array
    """|found - exact|/exact of the peak."""
    peak_in_ulps: Array
    """The same over the effect of one unit in the last place of an input, or of the peak itself."""
    uplift_time_in_ulps: Array
    """The same of the first uplift, with the last place of the duration of the pulse instead of its own."""
    impact_time_in_ulps: Array
    """The same of the first impact."""


def errors(table: Table, found: rocking.Response) -> Errors:
    """Return the errors of the solver."""
    exact = table["peak_rotation"]
    with np.errstate(invalid="ignore", divide="ignore"):
        peak = np.where(exact == 0.0, np.abs(found.peak_rotation), np.abs(found.peak_rotation / exact - 1.0))
    duration = np.array([_window(name) for name in table.pulse]) / table["frequency_ratio"]
    uplift, impact = table["uplift_time"], table["first_impact_time"]
    return Errors(
        peak,
        peak / (EPS + table["peak_rotation_per_ulp"]),
        np.abs(found.uplift_time - uplift) / (EPS * duration + uplift * table["uplift_time_per_ulp"]),
        np.abs(found.first_impact_time / impact - 1.0) / (EPS + table["first_impact_time_per_ulp"]),
    )


def _window(name: str) -> float:
    pulse = rocking.pulse(str(name))
    return float(pulse.end - pulse.start)


def wrong_outcomes(table: Table, found: rocking.Response) -> Flags:
    """Return where the outcome is wrong."""
    return np.asarray(found.outcome != table["outcome"])


def wrong_events(table: Table, found: rocking.Response) -> Flags:
    """Return where the outcome is right, but exceeded_alpha or (without chatter) the number of impacts is wrong."""
    counted = ~found.chatter & (table["chatter"] == 0)
    wrong = (found.exceeded_alpha != (table["exceeded_alpha"] == 1)) | (counted & (found.impacts != table["impacts"]))
    return np.asarray(wrong & ~wrong_outcomes(table, found))


def ulps_that_explain(table: Table, k: int, found: rocking.Response) -> int | None:
    """Return the change of the inputs, in ulps, for which the exact response is what the solver found for row `k`.

    Inputs are changed alone and together, up and down; None if no change in `ULPS` explains it.
    """
    if table["impacts"][k] > MAX_RESPONSE:
        return None
    cell = table.cell(k)
    names = [name for name in INPUTS if name in cell]
    for ulps in ULPS[:1] if table["impacts"][k] > LONG_RESPONSE else ULPS:
        for steps in product((-ulps, 0, ulps), repeat=len(names)):
            moved: Cell = {name: _changed_by(cell[name], step) for name, step in zip(names, steps, strict=True)}
            if (
                any(steps)
                and moved["restitution"] <= 1.0
                and _same_response(_reference_response(cell | moved), k, found)
            ):
                return ulps
    return None


def _reference_response(cell: Cell) -> ExactResponse:
    with working_precision(BITS):
        return integrate(**cell, max_impacts=MAX_IMPACTS)


def _changed_by(value: float, ulps: int) -> float:
    return value if value == 0.0 else value + ulps * float(np.spacing(value))


def _same_response(exact: ExactResponse, k: int, found: rocking.Response) -> bool:
    counted = not exact.chatter and not found.chatter[k]
    return (
        exact.outcome == found.outcome[k]
        and exact.exceeded_alpha == found.exceeded_alpha[k]
        and (not counted or exact.impacts == found.impacts[k])
    )
