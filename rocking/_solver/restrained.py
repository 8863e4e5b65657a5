"""Responses of bodies with a tendon and a damper, and how far they are from another outcome.

A slender block with a tendon and no damper, kappa < 1, is a free block in other units: (1 + sigma)/(1 - kappa) of
rotation, 1/sqrt(1 - kappa) of time. It takes the ways of free blocks, exact arcs among them. All others are followed by
Taylor steps (`rocking._solver.restrained_rocking` has their equation).
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from rocking._base.arrays import Array
from rocking._numba.compilation import FloatArray, Record, entry
from rocking._solver.records.state import BLOCK_STATE
from rocking._solver.restrained_rocking import free_flight
from rocking._solver.rules import set_body

RESTRAINTS = ("spring", "prestress", "damping")


def restrain(cells: NDArray[np.void], groups: Mapping[str, Array]) -> None:
    """Set tendon and damper of cells `BODY_CELL` (size,) from the groups of `rocking.peak_response` that are there."""
    for name, group in zip(RESTRAINTS, ("stiffness", "prestress", "damping"), strict=True):
        if group in groups:
            cells[name] = groups[group]


def is_restrained(cells: NDArray[np.void]) -> NDArray[np.bool_]:
    """Return the cells `BODY_CELL` that have a tendon or a damper."""
    mask = cells["damping"] != 0.0
    mask |= cells["spring"] != 0.0
    mask |= cells["prestress"] != 0.0
    return np.asarray(mask)


def equivalent_free(cells: NDArray[np.void], by_samples: bool) -> tuple[NDArray[np.bool_], NDArray[np.void]]:
    """Return which cells `BODY_CELL` (size,) a free block stands for, and the cells with these free blocks.

    y = (1 + sigma)/(1 - kappa) z' and tau = tau'/sqrt(1 - kappa) turn y'' = (1 - kappa) y - s (1 + sigma) - a f into
    (3.1) of z' with the amplitude a/(1 + sigma); the restitution stays. A free block stands for itself.

    `by_samples`: whether the rate of a cell is a length of time, not a frequency.
    """
    mask = (cells["alpha"] == 0.0) & (cells["vertical"] == 0.0) & (cells["damping"] == 0.0) & (cells["spring"] < 1.0)
    free = cells[mask]
    root = np.sqrt(1.0 - free["spring"])
    free["rate"] *= root if by_samples else 1.0 / root
    free["slenderness"] *= (1.0 + free["prestress"])[:, None]
    for name in RESTRAINTS:
        free[name] = 0.0
    replaced = cells.copy()
    replaced[mask] = free
    return mask, replaced


def in_own_units(records: NDArray[np.void], cells: NDArray[np.void]) -> NDArray[np.void]:
    """Return the responses of `cells` (size,) from those of the free blocks that stand for them, which are changed."""
    root = np.sqrt(1.0 - cells["spring"])
    factor = (1.0 + cells["prestress"]) / (1.0 - cells["spring"])
    for name in ("peak_rotation", "end_rotation"):
        records[name] *= factor
    for name in ("end_velocity", "first_impact_velocity"):
        records[name] *= factor * root
    for name in ("uplift_time", "first_impact_time"):
        records[name] /= root
    records["exceeded_alpha"] = ~(records["peak_rotation"] <= 1.0)
    return records


@entry
def fill_margins(records: Record, cells: Record, state: Record, margins: FloatArray) -> None:
    """Fill `margins` (size,) of restrained bodies, from z and w at the end of the motion in `RESPONSE_RECORD`s.

    Positive where the body overturns, zero at the transition: that of the present flight, or of the one after the next
    impact, `rocking._solver.restrained_rocking.free_flight`. `state`: a record `BLOCK_STATE`.
    """
    for k in range(len(cells)):
        set_body(state, cells[k], False)
        escapes, _, speed, margin = free_flight(state, records[k].end_rotation, records[k].end_velocity, True)
        if not escapes:
            _, _, _, later = free_flight(state, 0.0, state.eta[0] * speed, False)
            margin = max(margin, later)
        margins[k] = margin


def restrained_margin(records: NDArray[np.void], cells: NDArray[np.void]) -> Array:
    """Margins (size,) of restrained bodies `BODY_CELL` (size,), as `rocking._solver.bodies.outcome_margin_of`."""
    margins = np.empty(cells.size)
    fill_margins(records, cells, np.zeros(1, BLOCK_STATE)[0], margins)
    return margins
