"""Factors of changed objects, shares of sampled ones, and the sizes that a site does not overturn."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from rocking.extension import Array, Flags, Index, StopFlag
from rocking_assessment._objects.objects import Bodies, Object
from rocking_assessment._objects.search import (
    HIGHEST_FACTOR,
    Progress,
    factors_of,
    least,
    lowest_factor,
    overturned_by,
)
from rocking_assessment._objects.site import Motion, static_acceleration

ETA_CHANGE = 0.05  # change of the coefficient of restitution [-]

LARGEST, COARSE, HALVINGS = 8.0, 32, 3
"""Largest size that is tried over that which does not uplift [-]; parts of its logarithm, 6.7 % wide, and how often one
is halved, to 0.8 %, if a factor at one of its ends is within `NEAR` times its width of overturning.
"""

NEAR = 2.0

PROBES = np.append(np.geomspace(0.5, 0.9, 5), 1.0)
"""Factors that are tried before a search [-]: where one overturns, none is needed."""

SIZES = np.geomspace(1.0, LARGEST, COARSE * 2**HALVINGS + 1)  # sizes that may be tried [-]

ABOVE = 1.05
"""Highest factor that is searched where only factors up to 1 count [-]: what lies just above guides the search."""

SIZE_ERROR = 1e-3  # relative width of the bracket of the first change of outcome [-]

CHANGED_RESOLUTION = 4.0
"""Multiple of the resolution for changed objects and samples, and for sizes before the last is confirmed [-]."""

SHARES = 1.0 + np.array([1e-5, 1e-3, 1e-2, 3e-2])
"""Multiples of the factor of a body that are tried for its variants before a search [-]."""

MAX_SAMPLES = 100_000  # most samples of an object in one direction [-]


def changed_objects(
    objects: Sequence[Object],
    bodies: Bodies,
    factors: Array,
    motions: Sequence[Motion],
    resolution: float,
    stop: StopFlag | None,
    progress: Progress,
) -> dict[str, Array]:
    """Columns of changed objects, `objects` of each row: factors, and sizes that the motions do not overturn."""
    wider, higher = _tolerances(objects, bodies)
    changed = {
        "factor_less_restitution": bodies.scaled(change=-ETA_CHANGE),
        "factor_more_restitution": bodies.scaled(change=ETA_CHANGE),
        "factor_slenderer": bodies.scaled(1.0 - wider, 1.0 + higher),
        "factor_stockier": bodies.scaled(1.0 + wider, 1.0 - higher),
    }
    columns: dict[str, Array] = {}
    coarser = CHANGED_RESOLUTION * resolution
    for name, body in changed.items():
        progress(float(len(columns)))
        columns[name] = least(factors_of(body, motions, stop, resolution=coarser))
    progress(float(len(columns)))
    return columns | _limiting_sizes(bodies, factors, motions, resolution, stop)


def sampled_share(
    objects: Sequence[Object],
    bodies: Bodies,
    factors: Array,
    motions: Sequence[Motion],
    samples: int,
    seed: int,
    resolution: float,
    stop: StopFlag | None,
) -> Array:
    """Share of quasi-random variants of each body that one of the motions or more overturns [-].

    Base and height are uniform within the tolerance, independently, and the restitution within `ETA_CHANGE`; `factors`
    are those of the bodies (bodies, motions).
    """
    from scipy.stats import qmc  # noqa: PLC0415  (takes longer to load than the package)

    b, h, eta = 2.0 * qmc.Halton(3, rng=np.random.default_rng(seed)).random(samples).T - 1.0
    share = np.empty(bodies.base.size)
    wider, higher = _tolerances(objects, bodies)
    coarser = CHANGED_RESOLUTION * resolution
    for k in range(share.size):
        overturned = np.zeros(samples, dtype=np.bool_)
        for m in np.argsort(np.nan_to_num(factors[k], nan=np.inf), kind="stable").tolist():
            left = np.flatnonzero(~overturned)
            if left.size:
                copies = bodies.take(np.full(left.size, k))
                changed = 1.0 + wider[k] * b[left], 1.0 + higher[k] * h[left], ETA_CHANGE * eta[left]
                overturned[left] = _overturns_like(copies, changed, motions[m], float(factors[k, m]), coarser, stop)
        share[k] = overturned.mean()
    return share


def _overturns_like(
    bodies: Bodies,
    changed: tuple[Array, Array, Array],
    motion: Motion,
    factor: float,
    resolution: float,
    stop: StopFlag | None,
) -> Flags:
    """True where a motion overturns a changed body at its strength or below; `factor` is that of the unchanged body.

    The strength, and some just above that factor, are tried before the search, which then is for few.
    """
    overturned = np.zeros(bodies.base.size, dtype=np.bool_)
    for share in (1.0, *(factor * SHARES)):
        left = np.flatnonzero(~overturned)
        if left.size and share <= 1.0:
            body = bodies.take(left).scaled(*(change[left] for change in changed))
            overturned[left] = overturned_by(body, motion, stop, share * motion.peak_acceleration)
    left = np.flatnonzero(~overturned)
    if left.size:
        body = bodies.take(left).scaled(*(change[left] for change in changed))
        overturned[left] = lowest_factor(body, motion, stop, resolution, 1.0) <= 1.0
    return overturned


def _tolerances(objects: Sequence[Object], bodies: Bodies) -> tuple[Array, Array]:
    """Tolerances of base and height of each body, relative [-]."""
    tolerance = np.array([obj.tolerance for obj in objects], dtype=np.float64)
    return tolerance / bodies.base, tolerance / bodies.height


def _limiting_sizes(
    bodies: Bodies, factors: Array, motions: Sequence[Motion], resolution: float, stop: StopFlag | None
) -> dict[str, Array]:
    """Smallest base and largest height at which no motion overturns a body at a factor up to 1 [m].

    They are searched from where it does not uplift towards slenderer ones, up to the first of `SIZES` that overturns.
    """
    strongest = max(static_acceleration(motion) for motion in motions)
    still = strongest / np.asarray(bodies.scaled().uplift_acceleration)  # on a base larger by this it does not uplift
    worst = np.argsort(np.nan_to_num(factors, nan=2.0 * HIGHEST_FACTOR).mean(axis=0), kind="stable")
    by_severity = [motions[k] for k in worst.tolist()]

    def lowest(
        base: Array, height: Array, rows: Index, motion: Motion, highest: float, coarseness: float = 1.0
    ) -> Array:
        """Lowest factor that overturns each scaled body; any factor up to 1 suffices."""
        over = overturned_by(
            bodies.take(rows).scaled(base, height).column, motion, stop, PROBES * motion.peak_acceleration
        )
        factor: Array = PROBES[over.argmax(axis=1)]
        survives = np.flatnonzero(~over.any(axis=1))
        if survives.size:
            body = bodies.take(rows[survives]).scaled(base[survives], height[survives])
            factor[survives] = lowest_factor(body, motion, stop, coarseness * resolution, highest)
        return factor

    def narrower(rows: Index, size: Array, *search: Any) -> Array:
        return lowest(still[rows] / size, np.ones(rows.size), rows, *search)

    def higher(rows: Index, size: Array, *search: Any) -> Array:
        return lowest(np.ones(rows.size), size / still[rows], rows, *search)

    return {
        "smallest_width": bodies.base * still / _outermost(narrower, still.size, by_severity),
        "largest_height": bodies.height * _outermost(higher, still.size, by_severity) / still,
    }


def _outermost(lowest: Callable[..., Array], count: int, motions: Sequence[Motion]) -> Array:
    """The largest size of each body (count,) up to which none that was tried is overturned at a factor up to 1.

    `lowest` finds factors: rows, their sizes, motion, highest factor, and the multiple of the resolution.
    """
    first, by = np.full(count, SIZES.size), np.zeros(count, dtype=np.intp)  # the first that overturns, and its motion
    for k, motion in enumerate(motions):
        factor = np.full((count, SIZES.size), np.nan)  # nan: not tried
        step = 2**HALVINGS
        row, index = (part.ravel() for part in np.indices((count, COARSE + 1)))
        index = step * index
        while True:
            smaller = index < first[row]
            row, index = row[smaller], index[smaller]
            near = 1.0 + NEAR * step * math.log(SIZES[1])
            if row.size:
                factor[row, index] = lowest(row, SIZES[index], motion, near, CHANGED_RESOLUTION)
            overturned = factor <= 1.0
            smallest = np.where(overturned.any(axis=1), overturned.argmax(axis=1), SIZES.size)
            by, first = np.where(smallest < first, k, by), np.minimum(smallest, first)
            if step == 1:
                break
            row, index = np.nonzero(np.fmin(factor[:, :-1:step], factor[:, step::step]) <= near)
            index, step = step * index + step // 2, step // 2
    size: Array = SIZES[first - 1]
    high = SIZES[np.minimum(first, SIZES.size - 1)]
    left = np.flatnonzero(first < SIZES.size)
    while left.size:
        while (wide := left[high[left] / size[left] - 1.0 > SIZE_ERROR]).size:
            middle = np.sqrt(size[wide] * high[wide])
            for k in np.unique(by[wide]).tolist():
                is_governed = by[wide] == k
                rows, tried = wide[is_governed], middle[is_governed]
                over = lowest(rows, tried, motions[k], ABOVE, CHANGED_RESOLUTION) <= 1.0
                high[rows] = np.where(over, tried, high[rows])
                size[rows] = np.where(over, size[rows], tried)
        confirmed = np.ones(left.size, dtype=np.bool_)
        for k, motion in enumerate(motions):
            over = lowest(left, size[left], motion, ABOVE) <= 1.0
            by[left[over & confirmed]] = k
            confirmed &= ~over
        left = left[~confirmed]  # those that another motion overturns there: the next wider ones
        high[left] = size[left]
        size[left] = SIZES[np.maximum(np.searchsorted(SIZES, size[left]) - 1, 0)]
    return size
