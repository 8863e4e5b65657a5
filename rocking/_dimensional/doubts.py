"""Where the response of one body is in doubt, in words: contact, body, motion, conditioning, margins."""

from __future__ import annotations

import math
from typing import Any

from rocking._dimensional.problem import Problem
from rocking._dimensional.thresholds import warnings_of_changes
from rocking._excitation.pulses import AbstractPulse
from rocking._excitation.records.record import TIME_STEP, Record
from rocking._excitation.records.vertical import highest_vertical_scale
from rocking._model.outcome import Outcome
from rocking._model.response import Response
from rocking._numba.cancellation import StopFlag
from rocking._solver.bounded_response import BoundedResponse
from rocking._solver.records.amplification import CHANGE

BodyResponse = Any  # that of `rocking._dimensional.response`, which imports this module
REFINEMENT = 8  # samples into which one is divided by band-limited interpolation, for the comparison of samplings
SAMPLING_DIFFERENCE = 0.05  # relative difference of the peaks of both samplings above which a warning is given [-]
DRIFT = 0.1  # velocity at the end of a record over its largest above which a warning is given [-]
MAX_RESAMPLED = 400_000  # most samples of the refined record; a longer one is not compared

LARGEST_AMPLIFICATION = 1e4
"""Amplification above which a record does not determine the peak [-]: of samples with six digits it leaves two."""


def warnings_of(found: BodyResponse) -> list[str]:
    """Warnings about the response of one body."""
    problem = found.problem
    changes, margins = (found.thresholds if found.searches_thresholds else None), found.margins
    periods = [one for one in margins.periods if one.value == margins.nearest_period] if margins else []
    by_record = isinstance(problem.motion, Record)
    given, name, unit = found.peak_acceleration, "peak acceleration", " m/s2"
    if by_record:
        given, name, unit = found.scale, "scale", ""
    return [
        *found.contact.warnings,
        *problem.warnings,
        *_of_body(problem, found.outcome),
        *_of_drift(problem.motion),
        *_of_sampling(found),
        *_of_conditioning(found),
        *warnings_of_changes(given, changes or (), name, unit),
        *warnings_of_changes(float(problem.period), periods, "period", " s"),
        *_of_safety(found),
        *(_of_search(found) if problem.is_block else []),
    ]


def notes_of(found: BodyResponse) -> list[str]:
    """Notes on the response of one body."""
    margins = found.margins
    if margins and margins.smallest_surviving_half_diagonal != margins.surviving_from_half_diagonal is not None:
        return ["larger is not always safer: above the smallest block that survives, some larger ones overturn"]
    return []


def resampled_response(problem: Problem, stop: StopFlag | None = None) -> Response | BoundedResponse | None:
    """The response of a block to the record interpolated band-limited at an eighth of its step, as `BodyResponse`."""
    record, block = problem.motion, problem.body
    if not isinstance(record, Record):
        return None
    step = record.time_step / REFINEMENT
    if record.samples * REFINEMENT > MAX_RESAMPLED or step < TIME_STEP[0]:
        return None
    finer = record.resampled(step)
    if not problem.scale < highest_vertical_scale(finer, float(block.gravity)):
        return None
    return Problem.of(block, finer, restitution=problem.groups["restitution"], scale=problem.scale).solve(stop=stop)[0]


def _of_body(problem: Problem, outcome: Outcome) -> list[str]:
    """Warnings about the restitution and the shape of a body."""
    texts, body = [], problem.body
    strikes = problem.restitution is None and outcome != Outcome.NO_UPLIFT
    if problem.is_block:
        block = problem.block
        if strikes and block.momentum_restitution < 0.0:
            texts.append(
                f"the restitution (2.4) of this shape is negative ({block.momentum_restitution:.3g}): the block stops "
                "at an impact, eta = 0; give a number for another restitution"
            )
        if not block.contact_is_known:
            texts.append("the contact forces of this structure are not known: sliding is not assessed")
        elif block.half_width > block.half_height:
            texts.append("the block is wider than high: it would rather slide or bounce than rock")
        return texts
    texts = [
        f"the restitution of impacts that leave the {name} edge is negative ({float(edge.restitution):.3g}): "
        "the body stops at them, eta = 0; give a number for another restitution"
        for name, edge in (("right", body.right), ("left", body.left))
        if strikes and edge.restitution < 0.0
    ]
    if not body.contact_is_known:
        texts.append("the contact forces of this body are not known: sliding is not assessed")
    return texts


def _of_drift(record: AbstractPulse | Record) -> list[str]:
    if not isinstance(record, Record) or not abs(record.final_velocity) > DRIFT * record.peak_velocity:
        return []
    share = abs(record.final_velocity) / record.peak_velocity
    return [f"the velocity of the record ends at {100.0 * share:.0f} % of its largest: its baseline is not corrected"]


def _of_sampling(found: BodyResponse) -> list[str]:
    refined = found.resampled
    if refined is None:
        return []
    if found.overturned != bool(refined.overturned):
        other = Outcome(int(refined.outcome)).sentence
        return [f"the record is sampled too coarsely for this answer: interpolated band-limited, the block {other}"]
    peak, other_peak = found.peak_rotation, float(refined.peak_rotation)
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
    below = found.contact_below if found.problem.is_block else None
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
    if isinstance(found.problem.motion, Record):
        if changes is not None and not changes.overturns_above.all():
            return [
                "the outcome is not monotone in the scale: above the first overturning there are scales it survives"
            ]
        missing = ["factors of the record"] if changes is None else []
    else:
        searches = {"peak accelerations": changes, "periods and sizes": found.margins}
        missing = [name for name, result in searches.items() if result is None]
    found_not = "at which the outcome changes were not found in time: such a block has too many impacts"
    return [f"the {name} {found_not}" for name in missing]
