"""The solver's answers to a table, and how far they are from the truth in units of the conditioning."""

from __future__ import annotations

from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

import rocking
from reference.exact_response import ExactResponse
from rocking.model.fields import RESPONSE_FIELDS
from stress.cells import Cell, look
from stress.truth import INPUTS, Table

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
EPS = float(np.finfo(float).eps)

ULPS = (1, 2, 4, 8, 16, 32, 64, 128, 256)
"""By how many units in the last place inputs are moved in search of the fate that was found."""

LONG, ENDLESS = 2_000, 20_000
"""Impacts from which on that search is made for one unit alone, and from which on it is not made."""


def solve(table: Table) -> rocking.Response:
    """All rows, pulse by pulse."""
    fields: dict[str, NDArray[np.generic]] = {}
    for pulse in np.unique(table.pulse):
        rows = table.pulse == pulse
        response = rocking.peak_response(str(pulse), **{name: table[name][rows] for name in INPUTS})
        for field in RESPONSE_FIELDS:
            name, values = field.name, getattr(response, field.name)
            fields.setdefault(name, np.empty(len(rows), values.dtype))[rows] = values
    return rocking.Response(**fields)  # type: ignore[arg-type]  # the fields by name, each of its own dtype


class Errors(NamedTuple):
    """Arrays (cells,) [-]; nan where there is nothing to compare."""

    peak: Array
    """|found - exact|/exact of the peak."""
    peak_in_ulps: Array
    """The same over what one unit in the last place of an input, or of the peak itself, changes."""
    uplift_time_in_ulps: Array
    """Likewise of the first uplift, with the last place of the pulse's duration instead of its own."""
    impact_time_in_ulps: Array
    """Likewise of the first impact."""


def errors(table: Table, found: rocking.Response) -> Errors:
    """Distances of the solver's numbers from the truth."""
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
    pulse = rocking.get_pulse(name)
    return float(pulse.end - pulse.start)


def wrong_fates(table: Table, found: rocking.Response) -> Flags:
    """Where the outcome is another one."""
    return np.asarray(found.outcome != table["outcome"])


def wrong_events(table: Table, found: rocking.Response) -> Flags:
    """Where the fate is right, but not whether alpha was passed, or the number of impacts where none is summed up."""
    counted = ~found.chatter & (table["chatter"] == 0)
    wrong = (found.exceeded_alpha != (table["exceeded_alpha"] == 1)) | (counted & (found.impacts != table["impacts"]))
    return np.asarray(wrong & ~wrong_fates(table, found))


def ulps_that_explain(table: Table, k: int, found: rocking.Response) -> int | None:
    """The number of units in the last place of the inputs within which the truth is what the solver found for row `k`.

    Inputs are moved alone and together, up and down; None if no such change is found among `ULPS`.
    """
    if table["impacts"][k] > ENDLESS:
        return None
    cell = table.cell(k)
    names = [name for name in INPUTS if name in cell]
    for ulps in ULPS[:1] if table["impacts"][k] > LONG else ULPS:
        for steps in product((-ulps, 0, ulps), repeat=len(names)):
            moved: Cell = {name: _moved(cell[name], step) for name, step in zip(names, steps, strict=True)}
            if any(steps) and moved["restitution"] <= 1.0 and _agree(look(cell, **moved), k, found):
                return ulps
    return None


def _moved(value: float, ulps: int) -> float:
    return value if value == 0.0 else value + ulps * float(np.spacing(value))


def _agree(truth: ExactResponse, k: int, found: rocking.Response) -> bool:
    counted = not truth.chatter and not found.chatter[k]
    return (
        truth.outcome == found.outcome[k]
        and truth.exceeded_alpha == found.exceeded_alpha[k]
        and (not counted or truth.impacts == found.impacts[k])
    )
