"""Areas of the control plane in (1/a, log omega), so that a share does not depend on where a grid has its nodes."""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]

LAW = 0.10  # error of the scale law (4.16) up to which it is said to hold [-]


def node_areas(slenderness: Floats, frequency_ratio: Floats, *, logarithmic: bool = True) -> Floats:
    """Area that belongs to each node of a grid, (slenderness, frequency_ratio): half-way to its neighbours.

    `slenderness`, `frequency_ratio`: ascending nodes of 1/a and omega [-]; `logarithmic`: whether frequencies are
    measured by their logarithm.
    """
    x = np.log(frequency_ratio) if logarithmic else frequency_ratio
    return _lengths(slenderness)[:, None] * _lengths(x)


def share_of_area(where: Flags, within: Flags, areas: Floats) -> float:
    """Share of the area of `within` on which `where` holds [-]; nan if `within` is empty."""
    total = float(areas[within].sum())
    return float(areas[where & within].sum()) / total if total > 0.0 else np.nan


def _lengths(x: Floats) -> Floats:
    middles = 0.5 * (x[1:] + x[:-1])
    return np.diff(np.concatenate([x[:1], middles, x[-1:]]))
