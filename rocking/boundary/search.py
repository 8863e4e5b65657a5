"""Points where the fate changes: between two points, and all of them along a line.

A point is 1/a, log omega and the restitution.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize.elementwise import find_root

from rocking._numba.cancellation import StopFlag
from rocking.excitation.pulses import AbstractPulse
from rocking.model.outcome_margin import outcome_margin
from rocking.model.response import Response
from rocking.solver.peak_response import FREQUENCY_RATIO_RANGE, peak_response

RESOLUTION = 1e-12
"""Width of the final bracket, in 1/a and in log omega; the curves are good to it."""

ROUNDS = 32
"""Times that brackets on a line are shrunk: each may uncover a further fate between the two at its ends."""

Floats = NDArray[np.float64]
Codes = NDArray[np.int64]
Classify = Callable[[Floats, Floats, Floats], tuple[Codes, Floats]]
"""From 1/a, log omega and eta, which broadcast, to the way in which a block ends, and its margin to another."""


def fate_code(response: Response) -> Codes:
    """One integer for the way a block ends: 0 if it stands, else impacts before overturning x 4 + outcome."""
    code = response.impacts.astype(np.int64) * 4 + response.outcome
    return np.where(response.overturned, code, 0)


def shrink(inside: Floats, outside: Floats, code: Codes, classify: Classify) -> tuple[Floats, Floats]:
    """Shrink brackets between points (points, 3) to `RESOLUTION`; `code` holds at `inside` only.

    Chandrupatla's method: the fate alone decides on which side a point lies; the margin in energy, which is continuous
    through the change of fate as a rule, makes it a third of the work of bisection.
    """
    widest = float(np.max(np.abs(outside - inside), initial=0.0))
    if widest == 0.0:
        return inside, outside

    def side(t: Floats, *ends: Any) -> Floats:
        s, log_omega, eta, ds, dw, own = ends
        met, margin = classify(s + t * ds, log_omega + t * dw, eta)
        distance = np.abs(margin) / (1.0 + np.abs(margin)) + 1e-300
        return np.where(met == own, distance, -distance)

    found = find_root(
        side,
        (np.zeros(len(code)), np.ones(len(code))),
        args=(*inside.T, *(outside - inside).T[:2], code),
        tolerances={"xatol": RESOLUTION / widest, "xrtol": 0.0, "fatol": 0.0, "frtol": 0.0},
    )
    first, last = (inside + t[:, None] * (outside - inside) for t in found.bracket)
    return first, last


def classifier(pulse: AbstractPulse, alpha: float | None, stop: StopFlag | None = None) -> Classify:
    """The solver as a `Classify`, which raises `StoppedError` once `stop` is set."""

    def classify(slenderness: Floats, log_omega: Floats, eta: Floats) -> tuple[Codes, Floats]:
        omega = np.clip(np.exp(log_omega), *FREQUENCY_RATIO_RANGE)  # rounding must not lead out of the range
        found = peak_response(
            pulse, slenderness=slenderness, frequency_ratio=omega, restitution=eta, alpha=alpha, stop=stop
        )
        return fate_code(found), outcome_margin(found.end_rotation, found.end_velocity, eta, np.asarray(alpha or 0.0))

    return classify


def fates_along(
    axis: int, point: tuple[float, float, float], nodes: Floats, classify: Classify
) -> tuple[Floats, Codes]:
    """Ways in which blocks end along a line of the control space, and where they change.

    Parameters
    ----------
    axis : int
        0 for a line of 1/a, 1 for one of log omega.
    point : (float, float, float)
        Of the line; its coordinate along the axis does not count.
    nodes : float array
        Ascending; where fates are looked for first.
    classify : Classify
        The solver.

    Returns
    -------
    grid, codes : arrays (points,)
        The nodes and both ends of every bracket in which the fate changes, ascending, with the fate at each.
    """

    def points(x: Floats) -> Floats:
        places = np.tile(point, (x.size, 1))
        places[:, axis] = x
        return places

    grid = nodes
    codes, _ = classify(*points(grid).T)
    for _ in range(ROUNDS):
        edge = np.flatnonzero((np.diff(codes) != 0) & (np.diff(grid) > 2 * RESOLUTION))
        if edge.size == 0:
            break
        # where the fate at the left end stops; a third fate met there becomes a node, and a new edge
        inside, outside = shrink(points(grid[edge]), points(grid[edge + 1]), codes[edge], classify)
        met, _ = classify(*outside.T)
        grid = np.concatenate([grid, inside[:, axis], outside[:, axis]])
        codes = np.concatenate([codes, codes[edge], met])
        grid, kept = np.unique(grid, return_index=True)
        codes = codes[kept]
    return grid, codes
