"""Where the response of one body is in doubt, in words: contact, body, motion, conditioning, margins."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np

from rocking._base.quantities import SCALE
from rocking._dimensional.problem import Problem
from rocking._dimensional.thresholds import warnings_of_changes
from rocking._excitation.motion import AbstractMotion
from rocking._excitation.records.vertical import highest_vertical_scale
from rocking._model.outcome import Outcome
from rocking._solver.bodies import CHANGE

BodyResponse = Any  # that of `rocking._dimensional.response`, which imports this module
SAMPLING_DIFFERENCE = 0.05  # relative difference of the peaks of both samplings above which a warning is given [-]
DRIFT = 0.1  # velocity at the end of a record over its largest above which a warning is given [-]

LARGEST_AMPLIFICATION = 1e4
"""Amplification above which a record does not determine the peak [-]: of samples with six digits it leaves two."""


def warnings_of(found: BodyResponse) -> list[str]:
    """Warnings about the response of one body."""
    problem = found.problem
    changes, margins = (found.thresholds if found.searches_thresholds else None), found.margins
    periods = [one for one in margins.periods if one.value == margins.nearest_period] if margins else []
    strength = problem.motion.strength
    name, unit = strength.name.replace("_", " "), "" if strength.unit == "-" else f" {strength.unit}"
    return [
        *found.contact.warnings,
        *problem.warnings,
        *_of_body(problem, found.outcome),
        *_of_drift(problem.motion),
        *_of_sampling(found),
        *_of_conditioning(found),
        *warnings_of_changes(getattr(found, strength.name), changes or (), name, unit),
        *warnings_of_changes(float(problem.period), periods, "period", " s"),
        *_of_safety(found),
        *_of_search(found),
    ]


def notes_of(found: BodyResponse) -> list[str]:
    """Notes on the response of one body."""
    margins = found.margins
    if margins and margins.smallest_surviving_half_diagonal != margins.surviving_from_half_diagonal is not None:
        return ["larger is not always safer: above the smallest block that survives, some larger ones overturn"]
    return []


def resampled_problem(problem: Problem) -> Problem | None:
    """The bodies under the record interpolated band-limited at an eighth of its step, see `BodyResponse.resampled`."""
    finer: Any = problem.motion.refined()
    if finer is None or not np.all(
        problem.strength < highest_vertical_scale(finer, float(np.min(problem.body.gravity)))
    ):
        return None
    return replace(problem, motion=finer)


def _of_body(problem: Problem, outcome: Outcome) -> list[str]:
    """Warnings about the restitution and the shape of a body."""
    texts, body = [], problem.body
    strikes = problem.restitution is None and outcome != Outcome.NO_UPLIFT
    edges = {"the right edge": body.right, "the left edge": body.left}
    if body.left is body.right:
        edges = {"an edge": body.right}
    for name, edge in edges.items():
        if strikes and edge.restitution < 0.0:
            texts.append(
                f"the restitution (2.4) of impacts that leave {name} is negative ({float(edge.restitution):.3g}): "
                "the body stops at them, eta = 0; give a number for another restitution"
            )
    if not body.contact_is_known:
        texts.append("the contact forces of this body are not known: sliding is not assessed")
    elif min(body.right.alpha, body.left.alpha) > 0.25 * math.pi:
        texts.append("the body is wider than high: it would rather slide or bounce than rock")
    return texts


def _of_drift(motion: AbstractMotion) -> list[str]:
    if not motion.drift > DRIFT:
        return []
    share = f"{100.0 * motion.drift:.0f} %"
    return [f"the velocity of the {motion.kind} ends at {share} of its largest: its baseline is not corrected"]


def _of_sampling(found: BodyResponse) -> list[str]:
    refined = found.resampled
    if refined is None:
        return []
    if found.overturned != bool(refined.overturned):
        other = Outcome(int(refined.outcome)).sentence
        return [f"the record is sampled too coarsely for this answer: interpolated band-limited, the body {other}"]
    peak, other_peak = float(found.peak_rotation), float(refined.peak_rotation)
    if abs(other_peak - peak) <= SAMPLING_DIFFERENCE * peak or math.isnan(peak):
        return []
    peaks = f"{other_peak:.3g} alpha instead of {peak:.3g} alpha"
    return [f"the record is sampled coarsely: interpolated band-limited, the peak rotation is {peaks}"]


def _of_conditioning(found: BodyResponse) -> list[str]:
    if found.peak_is_determined:
        return []
    if math.isinf(found.amplification):
        return [f"the outcome is not determined by this record: it changes within {CHANGE:g} of the amplitude"]
    change = f"its relative change is {found.amplification:.1e} times that of the amplitude"
    return [f"the peak is not determined by this record: {change}"]


def _of_safety(found: BodyResponse) -> list[str]:
    below = found.contact_below
    if below is None or below.rocking_applies or not found.thresholds:
        return []
    needs = f"it needs a coefficient of friction of {below.largest_friction_demand:.3g}"
    why = "the block lifts off" if below.lifts_off else needs
    lowest = f"{found.thresholds[0].text()} m/s2, the lowest acceleration at which it overturns"
    return [f"no largest surviving acceleration is given: just below {lowest} by the rocking model, {why}"]


def _of_search(found: BodyResponse) -> list[str]:
    if not found.searches_thresholds:
        return []
    changes = found.thresholds
    strength = found.problem.motion.strength
    if strength is SCALE and changes is not None and not changes.overturns_above.all():
        return ["the outcome is not monotone in the scale: above the first overturning there are scales it survives"]
    missing = []
    if changes is None:
        missing.append("factors of the record" if strength is SCALE else "peak accelerations")
    if found.has_margins and found.margins is None:
        missing.append("periods and sizes")
    found_not = "at which the outcome changes were not found in time: such a body has too many impacts"
    return [f"the {name} {found_not}" for name in missing]
