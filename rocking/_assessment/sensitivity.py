"""How an assessment changes with dimensions and restitution, and the sizes that a site does not overturn."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from rocking._assessment.objects import Bodies, Object
from rocking._assessment.search import Progress, factors_of, least, overturned_by
from rocking._assessment.site import Motion, static_acceleration
from rocking._numba.cancellation import StopFlag

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]
Index = NDArray[np.intp]

ETA_CHANGE = 0.05
"""Change of the coefficient of restitution [-]."""

SIZES = np.geomspace(1.0, 8.0, 33)
"""Sizes that are tried over that which does not uplift [-]; the first change of outcome is bisected."""

HALVINGS = 24
"""Halvings of a bracket between two of them: to a relative width of 4e-9 [-]."""

MAX_SAMPLES = 100_000
"""Most samples of an object in one direction [-]."""


def changed_objects(
    objects: Sequence[Object],
    bodies: Bodies,
    motions: Sequence[Motion],
    stop: StopFlag | None,
    progress: Progress,
) -> dict[str, Array]:
    """Columns of changed objects: factors, and sizes that the motions do not overturn."""
    wider, higher = _tolerances(objects, bodies)
    changed = {
        "factor_less_restitution": bodies.scaled(change=-ETA_CHANGE),
        "factor_more_restitution": bodies.scaled(change=ETA_CHANGE),
        "factor_slenderer": bodies.scaled(1.0 - wider, 1.0 + higher),
        "factor_stockier": bodies.scaled(1.0 + wider, 1.0 - higher),
    }
    found = {}
    for done, (name, body) in enumerate(changed.items()):
        progress(float(done))
        found[name] = least(factors_of(body, motions, stop))
    return found | _limiting_sizes(bodies, motions, stop)


def sampled_share(
    objects: Sequence[Object],
    bodies: Bodies,
    motions: Sequence[Motion],
    samples: int,
    seed: int,
    stop: StopFlag | None,
) -> Array:
    """Share of quasi-random variants of each body that one of the motions or more overturns [-].

    Base and height are uniform within the tolerance, independently, and the restitution within `ETA_CHANGE`.
    """
    from scipy.stats import qmc  # noqa: PLC0415  (takes longer to load than the package)

    b, h, eta = 2.0 * qmc.Halton(3, rng=np.random.default_rng(seed)).random(samples).T - 1.0
    share = np.empty(bodies.base.size)
    wider, higher = _tolerances(objects, bodies)
    for k in range(share.size):
        same = bodies.take(np.full(samples, k))
        share[k] = np.mean(
            _any_overturns(same, 1.0 + wider[k] * b, 1.0 + higher[k] * h, ETA_CHANGE * eta, motions, stop)
        )
    return share


def _tolerances(objects: Sequence[Object], bodies: Bodies) -> tuple[Array, Array]:
    """Of base and height of each body, relative."""
    tolerance = np.array([one.tolerance for one in objects for _ in one.planes], dtype=np.float64)
    return tolerance / bodies.base, tolerance / bodies.height


def _any_overturns(
    bodies: Bodies,
    base: Array,
    height: Array,
    change: Array,
    motions: Sequence[Motion],
    stop: StopFlag | None,
) -> Bools:
    """Whether a motion overturns each changed body; those that one has overturned are not tried again."""
    found = np.zeros(base.size, dtype=np.bool_)
    for motion in motions:
        left = np.flatnonzero(~found)
        if left.size:
            body = bodies.take(left).scaled(base[left], height[left], change[left])
            found[left] = overturned_by(body, motion, stop)
    return found


def _limiting_sizes(bodies: Bodies, motions: Sequence[Motion], stop: StopFlag | None) -> dict[str, Array]:
    """Smallest base from which on, and largest height up to which, no motion overturns a body [m].

    They are searched from where it does not uplift towards slenderer ones, up to the first of `SIZES` that overturns.
    """
    strongest = max(static_acceleration(motion) for motion in motions)
    still = strongest / np.asarray(bodies.scaled().uplift_acceleration)  # on a base larger by this it does not uplift
    rows = np.arange(still.size)
    every, sizes = np.repeat(rows, SIZES.size), np.tile(SIZES, still.size)
    found = {}
    for name, narrower in (("smallest_width", True), ("largest_height", False)):

        def reached(rows: Index, size: Array, narrower: bool = narrower) -> Bools:
            one = np.ones(rows.size)
            base, height = (still[rows] / size, one) if narrower else (one, size / still[rows])
            return _any_overturns(bodies.take(rows), base, height, np.zeros(rows.size), motions, stop)

        tried = reached(every, sizes).reshape(-1, SIZES.size)
        first, known = tried.argmax(axis=1), np.asarray(tried.any(axis=1))
        low, high = SIZES[np.maximum(first - 1, 0)], SIZES[first]
        size = _bisected(lambda size: reached(rows, size), low, high, known)
        found[name] = bodies.base * still / size if narrower else bodies.height * size / still
    return found


def _bisected(overturns: Callable[[Array], Bools], low: Array, high: Array, known: Bools) -> Array:
    """The surviving end of brackets whose upper end overturns; the largest size where none does."""
    for _ in range(HALVINGS if known.any() else 0):
        middle = 0.5 * (low + high)
        hit = overturns(middle)
        low, high = np.where(hit, low, middle), np.where(hit, middle, high)
    return np.where(known, low, SIZES[-1])
