"""`assess`: which objects the motions of a site overturn, at which lowest factor, and how far others rock."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from functools import cache
from typing import Any

import numpy as np

from rocking.extension import (
    RESOLUTION,
    STANDARD_GRAVITY,
    Array,
    FitStatus,
    Flags,
    InvalidArgumentError,
    Record,
    Scalar,
    StopFlag,
    binomial_interval,
    check_stop,
    checked_resolution,
    fit_curve,
    integer,
)
from rocking_assessment._objects.columns import CLOSE, OUTPUTS, VERDICTS
from rocking_assessment._objects.motions import first_exceedances
from rocking_assessment._objects.objects import Bodies, BodyArray, Object
from rocking_assessment._objects.result import Assessment
from rocking_assessment._objects.search import HIGHEST_FACTOR, Progress, factors_of, least, overturned_by, responses_of
from rocking_assessment._objects.sensitivity import ETA_CHANGE, MAX_SAMPLES, changed_objects, sampled_share
from rocking_assessment._objects.site import Motion, Site, record_doubts
from rocking_assessment._objects.sliding import sliding_displacement
from rocking_assessment._objects.standards import checked_clauses, demand_over_capacity

WIDE = 0.1  # relative distance of the bounds of an annual rate above which a warning is given [-]

CONFIDENCE = 0.95

RATE_LEVELS = 12  # levels of a hazard curve at which outcomes are computed [-]


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
    """Which objects the motions of a site overturn, at which lowest factor, and how far the others rock.

    Parameters
    ----------
    objects : Object or iterable of Object
        One or more.
    site : Site
        The ground motions. Horizontal ones act from both sides.
    sensitivity : bool
        Whether to compute the smallest width, the largest height and the factors of changed objects, and when an object
        with a coefficient of friction needs more friction while it rocks. This takes most of the time.
    samples : int
        Number of quasi-random variants of each object, 0 to 100,000: dimensions within its tolerance, restitution
        within 0.05. `sampled_share` is the share of them that overturns.
    seed : int
        Seed of these variants, 0 to 2^53.
    resolution : float
        Largest relative distance of the factors on a record that are tried [-], [1e-4, 0.1].
    standards : str or iterable of str
        Checks by standards to state beside the exact outcome, as demand over capacity: "static", "ishiyama", "asce43",
        "circolare_linear", "circolare_nonlinear", separated by commas in one text, or "all".
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
    One criterion holds for verdict, share, sizes and samples: a motion overturns an object if it does so at a factor up
    to 1. `factor` is the lowest one found up to `HIGHEST_FACTOR`. A range of overturning narrower than the distance
    between the factors tried can be missed. Under pulses this distance is 0.05 to 0.23 %. Under records, and pulses on
    a floor, it is at most `resolution`, down to a 4096th of it where the object may overturn
    (`rocking._boundary.scan.lowest_overturning`). For changed objects and samples it is four times as large. The sizes
    tried are 6.7 % apart, 0.8 % where the factor is close to 1; the smallest width and the largest height are then
    refined to 0.1 %.
    """
    given = (objects,) if isinstance(objects, Object) else tuple(objects)
    if not given or not all(isinstance(one, Object) for one in given):
        raise InvalidArgumentError("objects", objects, "one or more objects of rocking_assessment.Object")
    variants = integer("samples", samples, 0, MAX_SAMPLES)
    chosen_seed = integer("seed", seed, 0, 2**53)
    share_apart = checked_resolution(resolution)
    clauses = checked_clauses(standards)
    parts = 1 + (5 if sensitivity else 0)

    def advance(share: float) -> None:
        if progress is not None:
            progress(share / parts)

    motions, bodies = site.find_motions(stop), Bodies.of(given)
    body = bodies.scaled()
    factors = factors_of(body, motions, stop, advance, resolution=share_apart)
    overturned, rotation, displacement = responses_of(body, motions, stop)
    factors = np.fmin(factors, np.where(overturned, 1.0, np.nan))  # of an object beyond the range of the search
    overturned |= factors <= 1.0
    rotation[overturned] = displacement[overturned] = np.nan
    uplift = np.asarray(body.uplift_acceleration)
    events = _by_event(overturned, motions)
    share = events.mean(axis=1)
    uplifts = (np.nan_to_num(rotation) > 0.0).any(axis=1) | (share > 0.0)
    factor = least(factors)
    unknown = np.full(factor.size, np.nan)
    low, high = binomial_interval(events.sum(axis=1), events.shape[1], CONFIDENCE) if site.records else (unknown,) * 2
    names = np.array([motion.name for motion in motions])
    columns: dict[str, Any] = {
        "object": [one.name for one in given for _ in one.planes],
        "direction": [direction for one in given for direction in one.planes],
        "verdict": np.array(VERDICTS)[np.where(share > 0.5, 3, np.where(share > 0.0, 2, uplifts.astype(int)))],
        "uplifts": uplifts,
        "uplift_acceleration": uplift,
        "factor": factor,
        "governing": [
            names[int(np.nanargmin(own))] if np.isfinite(lowest) else ""
            for own, lowest in zip(factors, factor, strict=True)
        ],
        "overturned_by": ["; ".join(names[own]) for own in overturned],
        "share": share,
        "share_lower": low,
        "share_upper": high,
        "rotation": -least(-rotation),
        "displacement": -least(-displacement),
        **_annual_rate(body, site, stop),
        "friction_needed": uplift / STANDARD_GRAVITY,
    }
    columns |= _sliding(given, body, motions, sensitivity, stop)
    ratios = demand_over_capacity(body, motions, clauses, stop)
    columns |= {f"{name}_ratio": -least(-each) for name, each in ratios.items()}
    columns |= {one.name: unknown for one in OUTPUTS if one.name not in columns}
    if sensitivity:
        columns |= changed_objects(
            given, bodies, factors, motions, share_apart, stop, lambda share: advance(1.0 + share)
        )
    if variants:
        columns["sampled_share"] = sampled_share(
            given, bodies, factors, motions, variants, chosen_seed, share_apart, stop
        )
    columns["warnings"] = _warnings(given, columns, record_doubts(site))
    order = np.lexsort((-np.nan_to_num(columns["rotation"]), np.nan_to_num(factor, nan=np.inf), -share))
    kept = {one.name: np.asarray(columns[one.name])[order] for one in OUTPUTS}
    each = [one for one in given for _ in one.planes]
    ordered = tuple(each[k] for k in order)
    apart = share_apart if any(isinstance(motion.motion, Record) for motion in motions) else 0.0
    return Assessment(
        kept, tuple(names.tolist()), HIGHEST_FACTOR, ordered, factors[order], rotation[order], site, apart
    )


def _by_event(overturned: Flags, motions: Sequence[Motion]) -> Flags:
    """Whether a motion of each group overturns: arrays (..., motions) become (..., groups)."""
    groups = np.array([motion.group for motion in motions])
    return np.stack([overturned[..., groups == group].any(axis=-1) for group in range(groups.max() + 1)], axis=-1)


def _annual_rate(body: BodyArray, site: Site, stop: StopFlag | None) -> dict[str, Array]:
    """Annual rate of overturning and its bounds, from outcomes at levels of the hazard curve, by a lognormal curve."""
    rate, lower, upper = (np.full(body.shape, np.nan) for _ in range(3))
    hazard: Any = site.hazard  # checked arrays, see `Site`
    if hazard is not None:
        from rocking_assessment._hazard.rates import curve_rates, outcome_rates  # noqa: PLC0415  (xarray takes longer to load)

        intensity, rates = hazard
        levels = np.geomspace(intensity[0], intensity[-1], RATE_LEVELS)
        reached = [
            overturned_by(body.column, one, stop, levels * (one.peak_acceleration / one.ground)) for one in site.motions
        ]
        none, every = outcome_rates(intensity, rates, levels)
        for k, own in enumerate(_by_event(np.stack(reached, axis=2), site.motions)):
            fit = fit_curve(own, levels)
            if math.isfinite(fit.median):
                ends = curve_rates("lognormal", intensity, rates, np.array(fit.median), np.array(fit.dispersion))
                lower[k], upper[k] = ends
                rate[k] = lower[k]
            elif fit.status in (FitStatus.NONE_REACHES, FitStatus.ALL_REACH):
                lower[k], upper[k] = every if fit.status == FitStatus.ALL_REACH else none
    return {
        "annual_rate": rate,
        "annual_rate_lower": lower,
        "annual_rate_upper": np.where(np.isinf(upper), np.nan, upper),
    }


def _sliding(
    objects: Sequence[Object], body: BodyArray, motions: Sequence[Motion], rocking: bool, stop: StopFlag | None
) -> dict[str, Any]:
    """Whether each body slides before it rocks (None: not known), under which motions, from what time, and how far."""
    given: list[Any] = [None if plane.side else one.friction for one in objects for plane in one.planes.values()]
    friction = np.array([math.nan if mu is None else mu for mu in given], dtype=np.float64)
    needed = np.asarray(body.uplift_acceleration) / STANDARD_GRAVITY
    first = [None if mu is None else bool(mu < need) for mu, need in zip(given, needed, strict=True)]
    times = first_exceedances(body, friction, motions, stop, rocking=rocking)

    @cache
    def slip(mu: float) -> float:
        check_stop(stop)
        return max(sliding_displacement(motion, mu) for motion in motions)

    def under(row: Array) -> str:
        listed = (f"{one.name} from {t:.3g} s" for one, t in zip(motions, row.tolist(), strict=True) if t == t)
        return "; ".join(listed) or "none"

    known = [slides or (slides is not None and rocking) for slides in first]
    return {
        "slides_first": np.array(first, dtype=object),
        "slides_under": [under(row) if own else "" for row, own in zip(times, known, strict=True)],
        "slides_at": least(times),
        "sliding": np.array([slip(mu) if slides else math.nan for mu, slides in zip(given, first, strict=True)]),
    }


def _warnings(objects: Sequence[Object], columns: dict[str, Any], doubts: Sequence[str]) -> list[str]:
    """Warnings of each row, in words; `doubts` are the warnings of the motions."""
    given = [(one, plane) for one in objects for plane in one.planes.values()]
    found = []
    for k, (one, plane) in enumerate(given):
        factor, texts = columns["factor"][k], []
        if abs(factor - 1.0) < CLOSE:
            side = "unsafe side: overturned from" if factor <= 1.0 else "safe side: not overturned below"
            texts.append(f"within {100 * CLOSE:g} %, on the {side} factor {factor:.3g}")
        if math.isfinite(columns["slides_at"][k]):
            when = f"its friction of {one.friction:.3g} does not suffice from {columns['slides_at'][k]:.3g} s on"
            how = "slides before it rocks" if columns["slides_first"][k] else "may slide while it rocks"
            texts.append(f"{how}: {when}")
        if plane.side:
            texts.append("against a wall, whose forces are not part of the model: sliding is not assessed")
        elif columns["slides_first"][k] is None:
            texts.append("no coefficient of friction is given: sliding is not assessed")
        if one.width is not None and one.depth is None:
            texts.append("no depth is given: only rocking along the width is assessed")
        if one.diameter is not None:
            texts.append("round base: the plane model leaves out wobbling and rolling")
        if (columns["factor_slenderer"][k] <= 1.0) != (columns["factor_stockier"][k] <= 1.0):
            texts.append("the answer changes within the tolerance of the dimensions")
        least_rate, most = columns["annual_rate_lower"][k], columns["annual_rate_upper"][k]
        if not math.isnan(least_rate) and not most <= least_rate * (1.0 + WIDE):
            bound = "without an upper bound" if math.isnan(most) else f"at most {most:.3g}"
            text = "the hazard curve does not reach far enough: the annual rate of overturning is at least"
            texts.append(f"{text} {least_rate:.3g}, {bound}")
        less, more = columns["factor_less_restitution"][k], columns["factor_more_restitution"][k]
        if (less <= 1.0) != (more <= 1.0):
            texts.append(f"the answer changes within {ETA_CHANGE:g} of the coefficient of restitution")
        found.append("; ".join([*texts, *doubts]))
    return found
