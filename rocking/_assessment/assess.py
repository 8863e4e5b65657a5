"""`assess`: which objects the motions of a site overturn, from which factor on them, and how far others rock."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rocking._assessment.columns import OUTPUTS, VERDICTS
from rocking._assessment.objects import Bodies, BodyArray, Object
from rocking._assessment.result import Assessment
from rocking._assessment.site import Motion, Site
from rocking._assessment.sliding import sliding_displacement
from rocking._base.constants import STANDARD_GRAVITY
from rocking._base.errors import InvalidArgumentError
from rocking._dimensional.body_problem import BodyProblem
from rocking._dimensional.body_response import respond_bodies
from rocking._dimensional.lowest_thresholds import lowest_thresholds
from rocking._excitation.records.record import Record
from rocking._excitation.records.vertical import highest_vertical_scale
from rocking._model.outcome import Outcome
from rocking._numba.cancellation import StopFlag
from rocking.suites.curve import curve_probability
from rocking.suites.fits import binomial_interval, fit_curve
from rocking.suites.hazard import hazard_quadrature

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]
Index = NDArray[np.intp]

HIGHEST_FACTOR = 10.0
"""Highest factor on the motions of a site that is searched [-]."""

LEVELS = np.geomspace(0.1, HIGHEST_FACTOR, 13)
"""Factors on records that are tried [-]; the change of outcome below the first that overturns is bisected."""

SIZES = np.geomspace(1.0, 8.0, 33)
"""Sizes that are tried over that which does not uplift [-]; the first change of outcome is bisected."""

HALVINGS = 30
"""Halvings of a bracket in size or factor [-]: to a relative width of 1e-9."""

CLOSE = 0.2
"""Margin below which a warning is given [-]: a ground motion is not known better."""

ETA_CHANGE = 0.05

CONFIDENCE = 0.95


def assess(
    objects: Iterable[Object] | Object, site: Site, *, sensitivity: bool = True, stop: StopFlag | None = None
) -> Assessment:
    """Whether the motions of a site overturn objects, from which factor on, and how far they rock where they do not.

    Parameters
    ----------
    objects : Object or iterable of Object
        One or more.
    site : Site
        The ground motions; horizontal ones come from both sides.
    sensitivity : bool
        Whether to compute the smallest width, the largest height and the factors of changed objects, which takes most
        of the time.
    stop : StopFlag, optional
        Cancels the work.

    Returns
    -------
    Assessment
        One row for each object and direction, the worst first; `rocking._assessment.columns.OUTPUTS` has the columns.

    Raises
    ------
    InvalidArgumentError
        If there is no object, or one cannot rock under a motion of the site.
    StoppedError
        If `stop` was set.

    Notes
    -----
    Under pulses `factor` is that of `lowest_thresholds`, up to `HIGHEST_FACTOR`: a range of strengths narrower than its
    nodes, 0.05 to 0.23 %, in which an object overturns can be missed. Under records the factors `LEVELS` are tried.
    """
    given = (objects,) if isinstance(objects, Object) else tuple(objects)
    if not given or not all(isinstance(one, Object) for one in given):
        raise InvalidArgumentError("objects", objects, "one or more objects of rocking.Object")
    motions, bodies = site.motions, Bodies.of(given)
    body = bodies.scaled()
    factors = _factors(body, motions, stop)
    overturned, rotation, displacement = _responses(body, motions, stop)
    factors = np.fmin(factors, np.where(overturned, 1.0, np.nan))  # of an object beyond the range of the search
    overturned |= factors <= 1.0
    rotation[overturned] = displacement[overturned] = np.nan
    uplift = np.asarray(body.uplift_acceleration)
    peak = np.array([motion.peak_acceleration for motion in motions])
    share = overturned.mean(axis=1)
    uplifts = (peak > uplift[:, None]).any(axis=1) | (np.nan_to_num(rotation) > 0.0).any(axis=1)
    factor = _least(factors)
    unknown = np.full(factor.size, np.nan)
    low, high = binomial_interval(overturned.sum(axis=1), len(motions), CONFIDENCE) if site.records else (unknown,) * 2
    slides, sliding = _sliding(given, body, motions)
    names = np.array([motion.name for motion in motions])
    columns: dict[str, Any] = {
        "object": [one.name for one in given for _ in one.directions],
        "direction": [direction for one in given for direction in one.directions],
        "verdict": np.array(VERDICTS)[np.where(share > 0.5, 3, np.where(share > 0.0, 2, uplifts.astype(int)))],
        "uplifts": uplifts,
        "uplift_acceleration": uplift,
        "factor": factor,
        "governing": [
            names[int(np.nanargmin(own))] if np.isfinite(least) else ""
            for own, least in zip(factors, factor, strict=True)
        ],
        "overturned_by": ["; ".join(names[own]) for own in overturned],
        "share": share,
        "share_lower": low,
        "share_upper": high,
        "rotation": -_least(-rotation),
        "displacement": -_least(-displacement),
        "yearly_rate": _yearly_rate(body, site, stop),
        "friction_needed": uplift / STANDARD_GRAVITY,
        "slides_first": slides,
        "sliding": sliding,
    }
    columns |= {one.name: unknown for one in OUTPUTS if one.name not in columns}
    if sensitivity:
        columns |= _sensitivity(given, bodies, motions, stop)
    columns["warnings"] = _warnings(given, columns)
    order = np.lexsort((-np.nan_to_num(columns["rotation"]), np.nan_to_num(factor, nan=np.inf), -share))
    kept = {one.name: np.asarray(columns[one.name])[order] for one in OUTPUTS}
    each = [one for one in given for _ in one.directions]
    ordered = tuple(each[k] for k in order)
    return Assessment(kept, tuple(names.tolist()), HIGHEST_FACTOR, ordered, factors[order])


def _least(values: Array) -> Array:
    """Smallest of each row, nan where all are."""
    return np.asarray(
        np.where(np.isnan(values).all(axis=1), np.nan, np.nanmin(np.nan_to_num(values, nan=np.inf), axis=1))
    )


def _problems(body: BodyArray, motion: Motion, acceleration: Array | float) -> list[BodyProblem]:
    """The bodies under a motion, and under its mirror image where that differs."""
    given = motion.motion, np.asarray(acceleration), np.asarray(motion.period), None
    return [BodyProblem(side, *given) for side in body.sides]


def _factors(body: BodyArray, motions: Sequence[Motion], stop: StopFlag | None) -> Array:
    """Lowest factor on each motion that overturns each body, nan up to `HIGHEST_FACTOR`; (bodies, motions)."""
    columns = []
    for motion in motions:
        peak = motion.peak_acceleration
        if isinstance(motion.motion, Record):
            found = [_record_factor(body, motion, stop)]
        else:
            found = [
                lowest_thresholds(one, HIGHEST_FACTOR * peak, stop) / peak for one in _problems(body, motion, peak)
            ]
        columns.append(_least(np.stack(found, axis=1)))
    return np.stack(columns, axis=1)


def _overturned(body: BodyArray, motion: Motion, acceleration: Array | float, stop: StopFlag | None) -> Bools:
    """Whether a motion overturns each body from either side."""
    if isinstance(motion.motion, Record) and motion.motion.vertical is not None:
        top = 0.999 * motion.motion.peak_acceleration * highest_vertical_scale(motion.motion)
        acceleration = np.minimum(acceleration, top)  # a stronger one would lift everything off the ground
    problems = _problems(body, motion, acceleration)
    codes = [problem.solve(stop=stop)[0]["outcome"].reshape(problem.shape) for problem in problems]
    return np.asarray(np.max(codes, axis=0) >= Outcome.OVERTURNED_DIRECTLY)


def overturned_by(body: BodyArray, motion: Motion, stop: StopFlag | None = None) -> Bools:
    """Whether a motion at the strength of the site overturns each body from either side."""
    return _overturned(body, motion, motion.peak_acceleration, stop)


def _record_factor(body: BodyArray, motion: Motion, stop: StopFlag | None) -> Array:
    """The lowest of `LEVELS` at which a record overturns each body, bisected from the level below."""
    peak = motion.peak_acceleration
    overturned = _overturned(body.column, motion, LEVELS * peak, stop)
    first = overturned.argmax(axis=1)
    low, high = np.where(first > 0, LEVELS[first - 1], 0.0), LEVELS[first]
    return _bisected(
        lambda level: _overturned(body, motion, level * peak, stop), low, high, np.asarray(overturned.any(axis=1))
    )


def _bisected(overturns: Callable[[Array], Bools], low: Array, high: Array, known: Bools) -> Array:
    """The overturning end of brackets whose upper end overturns; nan where none is known."""
    for _ in range(HALVINGS if known.any() else 0):
        middle = 0.5 * (low + high)
        hit = overturns(middle)
        low, high = np.where(hit, low, middle), np.where(hit, middle, high)
    return np.where(known, high, np.nan)


def _responses(body: BodyArray, motions: Sequence[Motion], stop: StopFlag | None) -> tuple[Bools, Array, Array]:
    """Whether each motion overturns each body, and the largest rotation and displacement of the top otherwise."""
    overturned, rotation, displacement = [], [], []
    for motion in motions:
        problems = _problems(body, motion, motion.peak_acceleration)
        found = [respond_bodies(problem, stop=stop) for problem in problems]
        overturned.append(np.logical_or.reduce([one.overturned for one in found]))
        rotation.append(np.fmax.reduce([one.rotation for one in found]))
        displacement.append(np.fmax.reduce([one.displacement for one in found]))
    return np.stack(overturned, 1), np.stack(rotation, 1), np.stack(displacement, 1)


def _yearly_rate(body: BodyArray, site: Site, stop: StopFlag | None) -> Array:
    """Annual rate of overturning from outcomes at 12 levels of the hazard curve, by a lognormal fragility curve."""
    rate = np.full(body.shape, np.nan)
    if site.hazard_curve is None:
        return rate
    intensity, rates = site.hazard_curve
    levels = np.geomspace(intensity[0], intensity[-1], 12)
    weights, nodes = hazard_quadrature(intensity, rates)
    reached = np.stack([_overturned(body.column, one, levels, stop) for one in site.motions], axis=2)
    for k, own in enumerate(reached):
        fit = fit_curve(own, levels)
        if math.isfinite(fit.median):
            at_end = float(curve_probability("lognormal", levels[-1], fit.median, fit.dispersion))
            rate[k] = curve_probability("lognormal", nodes, fit.median, fit.dispersion) @ weights
            rate[k] += at_end * rates[-1]
        elif not own.any():
            rate[k] = 0.0
    return rate


def _sliding(objects: Sequence[Object], body: BodyArray, motions: Sequence[Motion]) -> tuple[NDArray[Any], Array]:
    """Whether each body slides before it rocks (None: not known), and how far at most if it does."""
    needed = np.asarray(body.uplift_acceleration) / STANDARD_GRAVITY

    @cache
    def furthest(friction: float) -> float:
        return max(sliding_displacement(motion, friction) for motion in motions)

    given: list[Any] = [one.friction for one in objects for _ in one.directions]
    slides = [None if mu is None else bool(mu < need) for mu, need in zip(given, needed, strict=True)]
    found = [furthest(mu) if first else math.nan for mu, first in zip(given, slides, strict=True)]
    return np.array(slides, dtype=object), np.array(found)


def _sensitivity(
    objects: Sequence[Object], bodies: Bodies, motions: Sequence[Motion], stop: StopFlag | None
) -> dict[str, Array]:
    """Columns of changed objects."""
    tolerance = np.array([one.tolerance for one in objects for _ in one.directions], dtype=np.float64)
    wider, higher = tolerance / bodies.base, tolerance / bodies.height
    changed = {
        "factor_less_restitution": bodies.scaled(change=-ETA_CHANGE),
        "factor_more_restitution": bodies.scaled(change=ETA_CHANGE),
        "factor_slenderer": bodies.scaled(1.0 - wider, 1.0 + higher),
        "factor_stockier": bodies.scaled(1.0 + wider, 1.0 - higher),
    }
    found = {name: _least(_factors(body, motions, stop)) for name, body in changed.items()}
    if any(isinstance(motion.motion, Record) for motion in motions):
        return found
    peak = max(motion.peak_acceleration for motion in motions)
    still = peak / np.asarray(bodies.scaled().uplift_acceleration)  # on a base larger by this factor it does not uplift

    def overturns(rows: Index, base: Array, height: Array) -> Bools:
        body = bodies.take(rows).scaled(base, height)
        return np.asarray(np.any([overturned_by(body, one, stop) for one in motions], axis=0))

    rows = np.arange(still.size)
    every, sizes = np.repeat(rows, SIZES.size), np.tile(SIZES, still.size)
    for name, narrower in (("smallest_width", True), ("largest_height", False)):

        def reached(rows: Index, size: Array, narrower: bool = narrower) -> Bools:
            one = np.ones(rows.size)
            return overturns(rows, *((still[rows] / size, one) if narrower else (one, size / still[rows])))

        tried = reached(every, sizes).reshape(-1, SIZES.size)
        first, known = tried.argmax(axis=1), np.asarray(tried.any(axis=1))
        size = _bisected(lambda size: reached(rows, size), SIZES[np.maximum(first - 1, 0)], SIZES[first], known)
        size = np.where(known, size * (1.0 - 2e-8), SIZES[-1])  # the end that it survives
        found[name] = bodies.base * still / size if narrower else bodies.height * size / still
    return found


def _warnings(objects: Sequence[Object], columns: dict[str, Any]) -> list[str]:
    """What is in doubt of each row, in words."""
    given = [one for one in objects for _ in one.directions]
    found = []
    for k, one in enumerate(given):
        factor, texts = columns["factor"][k], []
        if abs(factor - 1.0) < CLOSE:
            texts.append(f"the lowest factor {factor:.3g} lies within {100 * CLOSE:g} % of the motions of the site")
        if columns["slides_first"][k]:
            texts.append(
                f"slides before it rocks: friction {one.friction:.3g}, {columns['friction_needed'][k]:.3g} needed"
            )
        if columns["slides_first"][k] is None:
            texts.append("no coefficient of friction is given: sliding is not assessed")
        if one.diameter is not None:
            texts.append("round base: planar model, which leaves out wobbling and rolling")
        if (columns["factor_slenderer"][k] <= 1.0) != (columns["factor_stockier"][k] <= 1.0):
            texts.append("the answer changes within the tolerance of the dimensions")
        less, more = columns["factor_less_restitution"][k], columns["factor_more_restitution"][k]
        if (less <= 1.0) != (more <= 1.0):
            texts.append("the answer changes within 0.05 of the coefficient of restitution")
        found.append("; ".join(texts))
    return found
