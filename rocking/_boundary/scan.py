"""Changes of outcome along a range of strengths of a motion: strengths tried in turn, and bisection between them."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

SCAN_RATIO = 1.002
"""Ratio of the strengths that are tried in turn [-]: ranges of one outcome that are narrower can be missed."""

RELATIVE_ERROR = 1e-6
"""Relative width to which a change of outcome is bisected [-]."""

_PARTS = 16
"""Values between the two ends of an interval that is bisected, solved by one call."""

_SCANNED = 200
"""Values of one call when only the lowest change is sought."""


def scanned(lowest: float, highest: float) -> Array:
    """The values that a search tries, from the lowest on; only the last one depends on the highest."""
    count = max(math.ceil(math.log(highest / lowest) / math.log(SCAN_RATIO)), 0)
    return np.minimum(lowest * SCAN_RATIO ** np.arange(count + 1.0), highest)


def outcome_changes(overturns: Callable[[Array], NDArray[np.bool_]], values: Array) -> tuple[Array, NDArray[np.bool_]]:
    """Every change of outcome between ascending values, bisected, and whether it overturns above; arrays (changes,)."""
    overturned = overturns(values)
    edges = np.flatnonzero(overturned[1:] != overturned[:-1])
    found = [
        _bisected(overturns, float(values[k]), float(values[k + 1]), bool(overturned[k + 1])) for k in edges.tolist()
    ]
    return np.array(found, dtype=np.float64), overturned[edges + 1]


def lowest_overturning(overturns: Callable[[Array], NDArray[np.bool_]], values: Array) -> float:
    """Lowest value at which a block overturns, of ascending ones and between them; nan if it survives all."""
    for first in range(0, values.size, _SCANNED):
        overturned = overturns(values[first : first + _SCANNED])
        if overturned.any():
            k = first + int(overturned.argmax())
            return _bisected(overturns, float(values[k - 1]), float(values[k]), True) if k else float(values[0])
    return math.nan


def _bisected(solve: Callable[[Array], NDArray[np.bool_]], low: float, high: float, above: bool) -> float:
    """The end of the interval of a change that overturns, once the interval is narrow; `above` is the upper end."""
    while high / low - 1.0 > RELATIVE_ERROR:
        edges: Array = np.geomspace(low, high, _PARTS + 2).astype(np.float64)
        changed = solve(edges[1:-1]) == above
        first = int(changed.argmax()) if changed.any() else _PARTS
        low, high = float(edges[first]), float(edges[first + 1])
    return high if above else low
