"""`assess`: objects that the motions of a site overturn, the lowest factors that do so, and rotations of the others."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rocking.extension import (
    RESOLUTION,
    STANDARD_GRAVITY,
    Array,
    Flags,
    Index,
    InvalidArgumentError,
    Scalar,
    StopFlag,
    binomial_interval,
    check_stop,
    checked_resolution,
    integer,
)
from rocking_assessment._objects.columns import (
    CLOSE,
    DEPTH_MISSING,
    OUTPUTS,
    RESTS_AT_FULL_STRENGTH,
    digits_apart,
)
from rocking_assessment._objects.motions import first_exceedances, frictions
from rocking_assessment._objects.objects import Bodies, BodyArray, MeshObject, Object
from rocking_assessment._objects.result import Assessment
from rocking_assessment._objects.search import (
    HIGHEST_FACTOR,
    Progress,
    estimated_outcomes,
    factors_of,
    least,
    responses_of,
    searched_factor,
    strongest_factor,
)
from rocking_assessment._objects.sensitivity import ETA_CHANGE, MAX_SAMPLES, changed_objects, sampled_share
from rocking_assessment._objects.site import Motion, Site, record_doubts
from rocking_assessment._objects.sliding import sliding_displacement
from rocking_assessment._objects.standards import checked_clauses, demand_over_capacity

WIDE = 0.1  # relative distance of the bounds of an annual rate above which a warning is given [-]

CONFIDENCE = 0.95

RATE_SHARE = 0.04
"""Distance of the peak ground accelerations over a hazard curve that are tried over the resolution [-]: 0.02 %.

Of four blocks under a record of the workflow, which overturn in 40 ranges and more, the rates differ by at most 0.3 %
from those with a tenth of it; with 0.2 % by up to 2 %.
"""

RATE_BISECTIONS = 6
"""Steps to the ends of the ranges between these accelerations: the bounds of the rate differ by a 64th of what they
would without."""

AT_ONCE = 16  # bodies whose outcomes over a hazard curve are computed together


def assess(
    objects: Iterable[Object] | Object,
    site: Site,
    *,
    sensitivity: bool = True,
    samples: Scalar = 0,
    seed: Scalar = 0,
    resolution: Scalar = RESOLUTION,
    standards: str | Iterable[str] = (),
    stop: StopFlag | None = None,
    progress: Progress | None = None,
) -> Assessment:
    """Find the objects that the motions of a site overturn, the lowest factors, and how far the other objects rock.

    Parameters
    ----------
    objects : Object or iterable of Object
        One or more.
    site : Site
        The ground motions. Horizontal ones act from both sides.
    sensitivity : bool
        True to compute the smallest width, the largest height and the factors of changed objects, and when an object
        with a coefficient of friction needs more friction while it rocks. This takes most of the time.
    samples : int
        Number of quasi-random variants of each object, 0 to 100,000: dimensions within its tolerance, restitution
        within 0.05. `sampled_share` is the share of them that overturns.
    seed : int
        Seed of these variants, 0 to 2^53.
    resolution : float
        Largest relative distance of the factors on a record that are tried [-], [1e-4, 0.1]; on a pulse two fifths of
        it.
    standards : str or iterable of str
        Checks by standards to state beside the exact outcome, as demand over capacity: "static", "ishiyama", "asce43",
        "circolare_linear", "circolare_nonlinear", "circolare2019_nonlinear", separated by commas in one text, or "all".
    stop : StopFlag, optional
        Cancels the work, which then raises `StoppedError`.
    progress : callable, optional
        Called with the share of the work that is done [-].

    Returns
    -------
    Assessment
        One row for each object and direction, the worst first; `to_xarray` has the meaning and unit of each column.

    Raises
    ------
    InvalidArgumentError
        If there is no object, or one cannot rock under a motion of the site.

    Notes
    -----
    One criterion holds for verdict, share, sizes and samples: a motion overturns an object if it does so at full
    strength, a factor of 1, or at a lower factor. An object can come to rest at full strength although a lower factor
    overturns it; `overturned_at_full_strength` and `share_at_full_strength` have the outcome at factor 1 alone.
    `factor` is the lowest one found up to `HIGHEST_FACTOR`. A range of overturning narrower than the distance
    between the factors tried can be missed. Under records, and pulses on a floor, this distance is at most
    `resolution`, down to a 4096th of it where the object may overturn (`rocking._boundary.scan.lowest_overturning`).
    Under pulses it is at most two fifths of `resolution`, 0.2 % by default, down to a 16th of that where the object may
    overturn. For changed objects and samples it is four times as large. The sizes tried are 6.7 % apart, 0.8 % where
    the factor is close to 1; the smallest width and the largest height are then refined to 0.1 %. No motion is searched
    from the factor on at which its vertical acceleration reaches -g: a warning names it, and `highest_factor` is lower.

    The annual rate is the sum over the ranges of peak ground accelerations in which an object is overturned, found with
    those a 25th of `resolution` apart. Its bounds are without and with the ground motions that are stronger than those
    of the hazard curve or not computed, and the rate is given where they differ by at most 10 %.
    """
    assessed = (objects,) if isinstance(objects, Object) else tuple(objects)
    if not assessed or not all(isinstance(obj, Object) for obj in assessed):
        raise InvalidArgumentError("objects", objects, "one or more objects of rocking_assessment.Object")
    variants = integer("samples", samples, 0, MAX_SAMPLES)
    chosen_seed = integer("seed", seed, 0, 2**53)
    share_apart = checked_resolution(resolution)
    clauses = checked_clauses(standards)
    parts = 1 + (5 if sensitivity else 0)

    def advance(share: float) -> None:
        if progress is not None:
            progress(share / parts)

    motions, bodies = site.find_motions(stop), Bodies.of(assessed)
    body = bodies.scaled()
    object_of_row: list[Object] = []
    directions: list[str] = []
    for obj in assessed:
        object_of_row += [obj] * len(obj.planes)
        directions += obj.planes
    factors = factors_of(body, motions, stop, advance, resolution=share_apart)
    at_full_strength, rotation, displacement = responses_of(body, motions, stop)
    factors = np.fmin(factors, np.where(at_full_strength, 1.0, np.nan))  # of an object beyond the range of the search
    overturned = at_full_strength | (factors <= 1.0)
    rotation[overturned] = displacement[overturned] = np.nan
    uplift = np.asarray(body.uplift_acceleration)
    events, full_events = _by_event(overturned, motions), _by_event(at_full_strength, motions)
    share = events.mean(axis=1)
    uplifts = (np.nan_to_num(rotation) > 0.0).any(axis=1) | (share > 0.0)
    no_depth = np.array([obj.depth_is_missing for obj in object_of_row])
    factor = least(factors)
    unknown = np.full(factor.size, np.nan)
    low = high = unknown
    if site.records:
        low, high = binomial_interval(events.sum(axis=1), events.shape[1], CONFIDENCE)
    names = np.array([motion.name for motion in motions])
    governing = names[np.nan_to_num(factors, nan=np.inf).argmin(axis=1)]
    columns: dict[str, Any] = {
        "object": [obj.name for obj in object_of_row],
        "direction": directions,
        "verdict": _verdicts(share, uplifts, no_depth),
        "uplifts": uplifts,
        "uplift_acceleration": uplift,
        "factor": factor,
        "governing": np.where(np.isfinite(factor), governing, ""),
        "overturned_by": ["; ".join(names[hits]) for hits in overturned],
        "overturned_at_full_strength": ["; ".join(names[hits]) for hits in at_full_strength],
        "share": share,
        "share_at_full_strength": full_events.mean(axis=1),
        "share_lower": low,
        "share_upper": high,
        "rotation": -least(-rotation),
        "displacement": -least(-displacement),
        **_annual_rate(bodies, factors, site, motions, share_apart, stop),
        "friction_needed": uplift / STANDARD_GRAVITY,
    }
    columns |= _sliding(object_of_row, body, motions, sensitivity, stop)
    for name, ratio in demand_over_capacity(body, motions, clauses, stop).items():
        columns[f"{name}_ratio"] = -least(-ratio)
    contact = [obj.contact_height if isinstance(obj, MeshObject) else math.nan for obj in object_of_row]
    columns["contact_tolerance"] = np.array(contact)
    if sensitivity:
        columns |= changed_objects(
            object_of_row, bodies, factors, motions, share_apart, stop, lambda share: advance(1.0 + share)
        )
    if variants:
        columns["sampled_share"] = sampled_share(
            object_of_row, bodies, factors, motions, variants, chosen_seed, share_apart, stop
        )
    columns = {quantity.name: columns.get(quantity.name, unknown) for quantity in OUTPUTS}
    columns["warnings"] = _warnings(object_of_row, bodies, columns, motions, record_doubts(site))
    order = np.lexsort((-np.nan_to_num(columns["rotation"]), np.nan_to_num(factor, nan=np.inf), ~no_depth, -share))
    return Assessment(
        {name: np.asarray(values)[order] for name, values in columns.items()},
        tuple(names.tolist()),
        searched_factor(motions),
        tuple(object_of_row[k] for k in order),
        factors[order],
        rotation[order],
        site,
        share_apart if any(motion.motion.is_scanned for motion in motions) else 0.0,
    )


def _verdicts(share: Array, uplifts: Flags, no_depth: Flags) -> NDArray[np.str_]:
    """Verdict of each row, one of `VERDICTS`, from the share of the motions that overturn it."""
    survives = np.where(no_depth, DEPTH_MISSING, np.where(uplifts, "rocks", "stays"))
    overturns = np.where(share > 0.5, "overturns in most", "overturns in some motions")
    return np.where(share > 0.0, overturns, survives)


def _by_event(overturned: Flags, motions: Sequence[Motion]) -> Flags:
    """True where a motion of a group overturns: arrays (..., motions) become (..., groups)."""
    groups = np.array([motion.group for motion in motions])
    return np.stack([overturned[..., groups == group].any(axis=-1) for group in range(groups.max() + 1)], axis=-1)


def _annual_rate(
    bodies: Bodies, factors: Array, site: Site, motions: Sequence[Motion], resolution: float, stop: StopFlag | None
) -> dict[str, Array]:
    """Annual rate of overturning and its bounds: the mean over the events of the site, each equally likely.

    `factors`: lowest ones that overturn each body (bodies, motions), below which none does. See `_event_rates`. Empty
    without a hazard curve.
    """
    if site.hazard is None:
        return {}
    groups = np.array([motion.group for motion in motions])
    bounds = []
    for group in range(int(groups.max()) + 1):
        columns = np.flatnonzero(groups == group)
        event = [motions[k] for k in columns.tolist()]
        lowest = np.nan_to_num(least(factors[:, columns]), nan=HIGHEST_FACTOR)
        parts = np.array_split(np.arange(lowest.size), math.ceil(lowest.size / AT_ONCE))
        rates = [_event_rates(bodies.take(rows), event, lowest[rows], site, resolution, stop) for rows in parts]
        bounds.append(np.concatenate(rates, axis=1))
    rate, lower, upper = np.mean(bounds, axis=0)
    reaches = upper <= lower * (1.0 + WIDE)
    return {
        "annual_rate": np.where(reaches, rate, np.nan),
        "annual_rate_lower": lower,
        "annual_rate_upper": np.where(np.isinf(upper), np.nan, upper),
    }


def _event_rates(
    bodies: Bodies, event: Sequence[Motion], lowest: Array, site: Site, resolution: float, stop: StopFlag | None
) -> Array:
    """Annual rate at which an event overturns bodies, its lower and its upper bound; array (3, bodies).

    It is the sum over the ranges of peak ground accelerations in which one of its records overturns the body of the
    difference of the rates at which their ends are exceeded. An end lies between two accelerations that are computed.
    Lower bound: the range begins and ends inside of them, and ground motions beyond the ends of the hazard curve do not
    overturn the body. Upper: it begins and ends outside of them, and all ground motions stronger than the curve
    overturn the body, as do those that are not computed because a vertical component reaches -g; there is no bound
    where a weaker one than the curve overturns it. `lowest`: factors below which none does (bodies,).
    """
    from rocking_assessment._hazard.rates import exceedance_rates  # noqa: PLC0415  (xarray takes longer to load)

    hazard: Any = site.hazard  # checked arrays, see `Site`
    intensity, rates = hazard
    begin = lowest * event[0].ground
    end = min(intensity[-1], event[0].ground * min(strongest_factor(motion) for motion in event))
    if end <= intensity[0]:
        zeros = np.zeros(lowest.size)
        return np.stack([zeros, zeros, np.full(lowest.size, np.inf)])
    count = math.ceil(math.log(end / intensity[0]) / math.log1p(RATE_SHARE * resolution))
    levels: Array = np.geomspace(intensity[0], end, count + 1)
    exceeded = exceedance_rates(intensity, rates, levels)
    body = bodies.scaled()

    def outcomes(row: Index, ground: Array) -> Flags:
        computed = ground >= begin[row]
        overturned = np.zeros(row.size, dtype=np.bool_)
        overturned[computed] = estimated_outcomes(body, event, row[computed], ground[computed], stop)
        return overturned

    row, level = (part.ravel() for part in np.indices((lowest.size, levels.size)))
    overturned = outcomes(row, levels[level]).reshape(lowest.size, levels.size)
    certain = (overturned[:, :-1] & overturned[:, 1:]) @ -np.diff(exceeded)
    # the ends of the ranges, between a level below and one above
    row, level = np.nonzero(overturned[:, :-1] != overturned[:, 1:])
    begins = overturned[row, level + 1]
    below, above = levels[level], levels[level + 1]
    for _ in range(RATE_BISECTIONS):
        middle = np.sqrt(below * above)
        is_beyond = outcomes(row, middle) == begins
        below, above = np.where(is_beyond, below, middle), np.where(is_beyond, middle, above)
    within = exceedance_rates(intensity, rates, np.stack([below, above]))
    beside = np.where(begins, within[1] - exceeded[level + 1], exceeded[level] - within[0])
    lower = certain + np.bincount(row, beside, lowest.size)
    uncertain = np.bincount(row, within[0] - within[1], lowest.size)
    upper = np.where(begin >= intensity[0], lower + uncertain + exceeded[-1], np.inf)
    return np.stack([lower + 0.5 * uncertain, lower, upper])


def _sliding(
    objects: Sequence[Object], body: BodyArray, motions: Sequence[Motion], rocking: bool, stop: StopFlag | None
) -> dict[str, Any]:
    """Columns on sliding before rocking (None: not known): the motions that do so, the earliest time, the distance."""
    friction = np.where(body.side == 0.0, frictions(objects), math.nan)
    is_known = ~np.isnan(friction)
    slides = friction < np.asarray(body.uplift_acceleration) / STANDARD_GRAVITY
    times = first_exceedances(body, friction, motions, stop, rocking=rocking)

    @cache
    def slip(mu: float) -> float:
        check_stop(stop)
        return max(sliding_displacement(motion, mu) for motion in motions)

    slides_first = slides.astype(object)
    slides_first[~is_known] = None
    slides_under, sliding = [""] * len(objects), np.full(len(objects), math.nan)
    for row in np.flatnonzero(slides | (is_known & rocking)).tolist():
        pairs = zip(motions, times[row].tolist(), strict=True)
        listed = [f"{motion.name} from {time:.3g} s" for motion, time in pairs if not math.isnan(time)]
        slides_under[row] = "; ".join(listed) or "none"
        if slides[row]:
            sliding[row] = slip(float(friction[row]))
    return {
        "slides_first": slides_first,
        "slides_under": slides_under,
        "slides_at": least(times),
        "sliding": sliding,
    }


def _warnings(
    objects: Sequence[Object],
    bodies: Bodies,
    columns: dict[str, Any],
    motions: Sequence[Motion],
    doubts: Sequence[str],
) -> list[str]:
    """Warnings of each row, in words; `doubts` are the warnings of the motions."""
    weakest, searched = min(motions, key=strongest_factor), searched_factor(motions)
    warnings = []
    for k, obj in enumerate(objects):
        factor, texts = columns["factor"][k], []
        if abs(factor - 1.0) < CLOSE:
            side = "unsafe side: overturned from" if factor <= 1.0 else "safe side: not overturned below"
            texts.append(f"within {100 * CLOSE:g} %, on the {side} factor {factor:.{digits_apart(factor)}g}")
        if columns["share_at_full_strength"][k] < columns["share"][k]:
            texts.append(f"{RESTS_AT_FULL_STRENGTH}: it overturns from factor {factor:.{digits_apart(factor)}g}")
        if searched < HIGHEST_FACTOR and not factor <= searched:
            lifts = f"from there on the vertical acceleration of {weakest.name} reaches -g"
            texts.append(f"not all motions are searched above factor {searched:g}: {lifts}")
        if math.isfinite(columns["slides_at"][k]):
            when = f"its friction of {obj.friction:.3g} does not suffice from {columns['slides_at'][k]:.3g} s on"
            how = "slides before it rocks" if columns["slides_first"][k] else "may slide while it rocks"
            texts.append(f"{how}: {when}")
        if bodies.side[k]:
            texts.append("against a wall, whose forces are not part of the model: sliding is not assessed")
        elif columns["slides_first"][k] is None:
            texts.append("no coefficient of friction is given: sliding is not assessed")
        if obj.depth_is_missing:
            texts.append("no depth is given: only rocking along the width is assessed, measure the depth")
        if obj.diameter is not None:
            texts.append("round base: the plane model leaves out wobbling and rolling")
        if (columns["factor_slenderer"][k] <= 1.0) != (columns["factor_stockier"][k] <= 1.0):
            texts.append("the answer changes within the tolerance of the dimensions")
        lower, upper = columns["annual_rate_lower"][k], columns["annual_rate_upper"][k]
        if not math.isnan(lower) and not upper <= lower * (1.0 + WIDE):
            bound = "without an upper bound" if math.isnan(upper) else f"at most {upper:.3g}"
            text = "the hazard curve does not reach far enough: the annual rate of overturning is at least"
            texts.append(f"{text} {lower:.3g}, {bound}")
        if (columns["factor_less_restitution"][k] <= 1.0) != (columns["factor_more_restitution"][k] <= 1.0):
            texts.append(f"the answer changes within {ETA_CHANGE:g} of the coefficient of restitution")
        warnings.append("; ".join([*texts, *doubts]))
    return warnings
