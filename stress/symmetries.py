"""Transformations that must not change the response: mirror, neighbours, size of the block, units.

The SI problems are built with `rocking.Block` and `rocking.paper`. A factor of 4 in lengths halves p exactly, and a
factor of 1,024 between units divides out exactly: the groups, and hence the responses, must be equal to the last bit.
Other factors leave groups that differ by rounding, and responses that differ accordingly.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

import rocking
from benchmarks.tables import Table
from rocking._model.block import STANDARD_GRAVITY
from rocking.paper import GroupSet, groups_of, problem_of_block
from stress.solver import EPS, solve

SLENDER_ANGLE = 0.01
"""Slenderness angle [rad] of the blocks that represent the slender limit, in the groups (4.10)."""

FIELDS = (
    *("peak_rotation", "peak_mode", "outcome", "impacts", "chatter", "exceeded_alpha"),
    *("uplift_time", "first_impact_time", "end_rotation", "end_velocity"),
)


def symmetries(table: Table, found: rocking.Response) -> dict[str, Any]:
    """Count the cells that keep their response to the last bit, and measure the change of the others."""
    order = np.random.default_rng(1).permutation(len(table))
    one = in_units(table, length=1.0, time=1.0, size=1.0)
    same = solve(one)
    return {
        "mirror": identical(found, solve(_mirrored(table)), sign=-1.0),
        "neighbours": identical(solve(table.select(order)), found, order=order),
        "size_4": identical(same, solve(in_units(table, length=1.0, time=1.0, size=4.0))),
        "units_1024": identical(same, solve(in_units(table, length=1024.0, time=1.0, size=1.0))),
        "size_3.7": difference(table, same, solve(in_units(table, length=1.0, time=1.0, size=3.7))),
        "units_mm_ms": difference(table, same, solve(in_units(table, length=1e3, time=1e3, size=1.0))),
    }


def _mirrored(table: Table) -> Table:
    names = [name[1:] if name.startswith("-") else f"-{name}" for name in table.pulse]
    return Table(table.name, np.array(names), table.columns)


def in_units(table: Table, *, length: float, time: float, size: float) -> Table:
    """Return the same groups computed from a block of half-diagonal `size` [m], in units of 1/length m and 1/time s."""
    rigid = table["alpha"] > 0.0
    columns = {name: values.copy() for name, values in table.columns.items()}
    gravity = STANDARD_GRAVITY * length / time**2
    for k, angle in enumerate(np.where(rigid, table["alpha"], SLENDER_ANGLE)):
        metres = rocking.Block.from_slenderness_angle(float(angle), 1.0)
        block = rocking.Block(
            2 * (metres.half_width * size * length), 2 * (metres.half_height * size * length), gravity
        )
        group_set = GroupSet.RIGID_SMALL_ROTATION if rigid[k] else GroupSet.SLENDER_BY_BLOCK
        wanted = rocking.paper.Groups(table["frequency_ratio"][k], table["slenderness"][k])
        problem = problem_of_block(
            wanted, group_set, alpha=block.alpha, frequency_parameter=block.frequency_parameter, gravity=gravity
        )
        groups = groups_of(problem, group_set)
        columns["slenderness"][k], columns["frequency_ratio"][k] = groups.slenderness, groups.frequency_ratio
        columns["alpha"][k] = block.alpha if rigid[k] else 0.0
    return Table(table.name, table.pulse, columns)


def identical(
    one: rocking.Response, other: rocking.Response, *, sign: float = 1.0, order: NDArray[Any] | None = None
) -> dict[str, int]:
    """Count the cells whose responses are equal in all bits; `other` is put in `order` first."""
    where = slice(None) if order is None else order
    same = np.ones(one.shape, np.bool_)
    for name in FIELDS:
        a, b = getattr(one, name), getattr(other, name)[where]
        same &= (a == b) | (np.isnan(a) & np.isnan(b))
    a, b = one.first_impact_velocity, sign * other.first_impact_velocity[where]
    same &= (a == b) | (np.isnan(a) & np.isnan(b))
    return {"cells": same.size, "identical": int(same.sum())}


def difference(table: Table, one: rocking.Response, other: rocking.Response) -> dict[str, float]:
    """Return the number of outcomes that differ, and the change of the peak in units of the conditioning."""
    with np.errstate(invalid="ignore", divide="ignore"):
        change = np.abs(other.peak_rotation - one.peak_rotation) / np.abs(one.peak_rotation)
    ulps = change / (EPS + table["peak_rotation_per_ulp"])
    return {
        "cells": len(table),
        "other_outcomes": int(np.sum(one.outcome != other.outcome)),
        "median_in_ulps": float(np.nanmedian(ulps)),
        "largest_in_ulps": float(np.nanmax(ulps)),
    }
