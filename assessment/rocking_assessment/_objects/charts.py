"""Charts of a report: coordinates of lines and ticks, which its template draws as SVG."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from rocking.extension import Array

WIDTH, HEIGHT = 220.0, 95.0  # of the area between the axes [pixels]
MOST_POINTS = 320  # points of a line beyond which it is thinned, largest and smallest values kept [-]
STYLES = tuple(
    (colour, dash)
    for dash in ("", "7 3", "2 2")
    for colour in ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#000000", "#e69f00", "#56b4e9")
)
"""Colours that colour-blind people tell apart (Okabe and Ito 2008), with dashes of SVG."""


@dataclass(frozen=True)
class Axis:
    """One axis with its ends, low < high, and its length [pixels]."""

    label: str
    low: float
    high: float
    size: float
    logarithmic: bool = False

    def at(self, values: ArrayLike) -> Array:
        """Distance of values from the lower end [pixels]."""
        x, low, high = np.asarray(values, dtype=np.float64), self.low, self.high
        if self.logarithmic:
            return np.asarray(self.size * np.log(x / low) / math.log(high / low))
        return np.asarray(self.size * (x - low) / (high - low))

    @property
    def ticks(self) -> list[tuple[str, str]]:
        """Positions [pixels] and labels."""
        if self.logarithmic:
            decades = range(math.floor(math.log10(self.low)), math.ceil(math.log10(self.high)) + 1)
            values = [m * 10.0**n for n in decades for m in (1, 2, 5)]
        else:
            rough = (self.high - self.low) / 5.0
            unit = 10.0 ** math.floor(math.log10(rough))
            step = unit * min((m for m in (1, 2, 5, 10) if m * unit >= rough), default=10)
            values = [k * step for k in range(math.ceil(self.low / step), math.floor(self.high / step) + 1)]
        slack = 1e-9 * (self.high - self.low)
        return [(f"{self.at(v):.4g}", f"{v + 0.0:.4g}") for v in values if self.low - slack <= v <= self.high + slack]


@dataclass(frozen=True)
class Line:
    """A line of a chart: its name, its points "x,y x,y" of each unbroken part, colour and dash."""

    name: str
    parts: list[str]
    colour: str
    dash: str


@dataclass(frozen=True)
class Chart:
    """Lines over two axes, and marks (x, y, colour) of the site."""

    title: str
    x: Axis
    y: Axis
    lines: list[Line]
    marks: list[tuple[float, float, str]]


def line_of(name: str, axes: tuple[Axis, Axis], x: Array, y: Array, style: int = 0) -> Line:
    """The line through points; nan and values beyond the axes interrupt it."""
    across, up = axes
    inside = np.isfinite(y) & (y >= up.low) & (y <= up.high) & (x >= across.low) & (x <= across.high)
    breaks = np.flatnonzero(np.diff(inside.astype(int))) + 1
    runs = [run for run in np.split(np.arange(x.size), breaks) if run.size and inside[run[0]]]
    drawn = [np.stack([across.at(x[run]), -up.at(y[run])], axis=1) for run in runs]
    parts = [" ".join(f"{a:.1f},{b:.1f}" for a, b in points.tolist()) for points in drawn]
    return Line(name, parts, *STYLES[style % len(STYLES)])


def thinned(x: Array, y: Array) -> tuple[Array, Array]:
    """At most about `MOST_POINTS` points, the largest and the smallest of each group."""
    if x.size <= MOST_POINTS:
        return x, y
    groups: Sequence[Array] = np.array_split(np.arange(x.size), MOST_POINTS // 2)
    lowest = [group[y[group].argmin()] for group in groups]
    highest = [group[y[group].argmax()] for group in groups]
    extremes = np.unique([*lowest, *highest])
    return x[extremes], y[extremes]
