"""The factors of an object by direction as a drawing: a dial with the object seen from above in its middle."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import xarray as xr

from rocking.extension import Array

RADIUS = 100.0  # of the rim, in units of the drawing
RIM = 3.0  # factor at the rim over the lowest one, at most [-]; higher ones are drawn there
SPACE = 1.15  # factor at the rim over the highest one, at most [-]

BASE = 24.0
"""Largest distance of a corner of the base from the middle, in units of the drawing: less than `RADIUS`/`RIM`."""

SAME = 1e-9  # relative difference up to which two directions are both the worst [-]


@dataclass(frozen=True)
class Mark:
    """A direction on the dial; `inside`: its factor lies below that of the rim."""

    x: float
    y: float
    inside: bool


@dataclass(frozen=True)
class Dial:
    """Parts of the drawing, x to the right and y downwards from the middle.

    `curve` and `base` are points of polygons; `site` is the radius at which the factor is 1, nan beyond the rim, and
    `rim` the factor there [-].
    """

    marks: list[Mark]
    worst: list[Mark]
    curve: str
    base: str
    site: float
    rim: float


def worst_directions(factors: xr.Dataset) -> list[float]:
    """The directions of the lowest factor [degrees]; none if no factor is known."""
    factor = factors["factor"].values
    if np.isnan(factor).all():
        return []
    worst: list[float] = factors["direction"].values[factor <= np.nanmin(factor) * (1.0 + SAME)].tolist()
    return worst


def dial_of(factors: xr.Dataset, footprint: Array) -> Dial:
    """The drawing of factors by direction, of which one is known, and of a footprint from the centre of mass."""
    factor, angle = factors["factor"].values, np.radians(factors["direction"].values)
    rim = float(min(RIM * np.nanmin(factor), SPACE * np.nanmax(factor)))
    radius = np.where(np.isnan(factor), RADIUS, RADIUS * np.fmin(factor, rim) / rim)
    x, y = radius * np.cos(angle), -radius * np.sin(angle)
    marks = [Mark(*values) for values in zip(x.tolist(), y.tolist(), (factor < rim).tolist(), strict=True)]
    worst = worst_directions(factors)
    corners = footprint * [1.0, -1.0] * (BASE / np.hypot(*footprint.T).max())
    return Dial(
        marks,
        [mark for mark, direction in zip(marks, factors["direction"].values, strict=True) if direction in worst],
        _points([(mark.x, mark.y) for mark in marks]),
        _points(corners.tolist()),
        RADIUS / rim if rim >= 1.0 else math.nan,
        rim,
    )


def _points(points: list[tuple[float, float]]) -> str:
    return " ".join(f"{x:.2f},{y:.2f}" for x, y in points)
