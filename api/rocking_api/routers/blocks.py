"""A block in metres under a pulse in m/s2 and seconds."""

from __future__ import annotations

import math
from typing import Annotated
from urllib.parse import urlencode

import numpy as np
from fastapi import APIRouter, Query, Request

from rocking._numba.cancellation import StopFlag, run_with_timeout
from rocking.boundary.amplitude import critical_amplitude
from rocking.groups import GroupSet, Problem, groups_of
from rocking.history.contact import ContactExtremes, contact_extremes
from rocking.history.motion import build_motion
from rocking.model.block import Block
from rocking.model.response import Outcome
from rocking_api.execution.evaluation import ask
from rocking_api.http.params_route import QuestionRoute
from rocking_api.models.block_margins import margins_of
from rocking_api.models.blocks import BlockAnswer, BlockQuestion, Margins, Threshold
from rocking_api.models.params import ResponseQuestion
from rocking_api.models.point import points_of
from rocking_api.models.responses import ResponseAnswer, finite, response_answer
from rocking_api.service import Service, ServiceDep

router = APIRouter(prefix="/v1/blocks", tags=["response"], route_class=QuestionRoute)

MARGIN = 0.05
"""Relative distance of a change of fate that is worth a warning [-]: ground motions are not known better."""

SEARCH_SHARE = 0.2
"""Of the time of a request: what the search for changes of fate along one line is granted [-]."""

NOT_FOUND = "the {} at which the fate changes were not found in time: such a block strikes the ground too often"

BELOW = 1e-9
"""Relative distance below the lowest change of outcome at which the contact is judged [-]."""

HIGHEST_AMPLITUDE = 100.0
"""Largest a = a_g/(g tan alpha) at which changes of fate are looked for [-], if ten times the asked one is not more."""


@router.get("/response", summary="A block in SI units")
async def get_block(question: Annotated[BlockQuestion, Query()], request: Request, service: ServiceDep) -> BlockAnswer:
    """Fate, rotation in degrees, displacement in metres, distance to another fate, friction, by (2.2)."""
    return await service.off_loop(question, lambda stop: _block(service, question, stop), request)


def _block(service: Service, question: BlockQuestion, stop: StopFlag) -> BlockAnswer:
    block = Block(question.half_width, question.half_height, question.gravity)
    asked = _in_groups(question, block)
    points = {name: getattr(asked, name) for name in ("slenderness", "frequency_ratio", "restitution")}
    (point,) = points_of(*ask(service.atlas, asked, **points, stop=stop))
    service.metrics.points(point.source, 1)
    found = response_answer(asked, point)
    seconds = SEARCH_SHARE * service.settings.max_seconds
    found_thresholds = run_with_timeout(lambda part: _thresholds(question, block, asked, part), seconds, stop)
    thresholds = found_thresholds or []
    margins = margins_of(question, block, asked, [t.peak_acceleration for t in thresholds], seconds, stop)
    searched = {"peak accelerations": found_thresholds, "periods and sizes": margins}
    below = _contact_below(thresholds[0].peak_acceleration, question, block, asked, stop) if thresholds else None
    safe = below is not None and below.rocking_applies
    peak = None if found.peak_rotation is None else found.peak_rotation * block.alpha
    contact = contact_extremes(build_motion(question.pulse, **points, alpha=block.alpha, stop=stop))
    return BlockAnswer(
        query=question,
        url="/v1/blocks/response?" + urlencode(question.model_dump()),
        response=found,
        overturned=found.overturned,
        rocking_model_applies=contact.rocking_applies,
        meaning=contact.sentence,
        peak_rotation_deg=None if peak is None else math.degrees(peak),
        top_displacement=None if peak is None else _top_displacement(block, peak),
        alpha_deg=math.degrees(block.alpha),
        half_diagonal=block.half_diagonal,
        frequency_parameter=block.frequency_parameter,
        restitution=asked.restitution,
        uplift_acceleration=block.uplift_acceleration,
        thresholds=found_thresholds,
        largest_safe_acceleration=thresholds[0].peak_acceleration if safe else None,
        largest_safe_friction_demand=below.largest_friction_demand if below is not None and safe else None,
        margins=margins,
        friction_at_uplift=block.half_width / block.half_height,
        friction_demand=finite(contact.largest_friction_demand),
        friction_at_impact=contact.impulse_ratio,
        smallest_normal_reaction=contact.smallest_normal_reaction,
        warnings=[
            *contact.warnings,
            *_more_warnings(block, question, contact, thresholds, margins),
            *_safety_warnings(below, thresholds),
            *(NOT_FOUND.format(name) for name, result in searched.items() if result is None),
        ],
        notes=_notes(found, margins),
        data_version=found.data_version,
    )


def _in_groups(question: BlockQuestion, block: Block) -> ResponseQuestion:
    """The same question in the groups of (5.3)."""
    frequency = 2.0 * math.pi / question.pulse_period
    problem = Problem(block.alpha, block.frequency_parameter, question.peak_acceleration, frequency, question.gravity)
    groups = groups_of(problem, GroupSet.RIGID)  # (5.3)
    return ResponseQuestion(
        pulse=question.pulse,
        method=question.method,
        tolerance=question.tolerance,
        alpha_deg=math.degrees(block.alpha),
        slenderness=float(np.asarray(groups.slenderness)),
        frequency_ratio=float(np.asarray(groups.frequency_ratio)),
        restitution=block.inelastic_restitution if question.restitution == "housner" else question.restitution,
    )


def _thresholds(question: BlockQuestion, block: Block, asked: ResponseQuestion, stop: StopFlag) -> list[Threshold]:
    changes = critical_amplitude(
        question.pulse,
        frequency_ratio=asked.frequency_ratio,
        restitution=asked.restitution,
        alpha=block.alpha,
        highest_amplitude=min(max(HIGHEST_AMPLITUDE, 10.0 / asked.slenderness), 1e6),
        stop=stop,
    )
    return [
        Threshold(peak_acceleration=float(a) * block.uplift_acceleration, overturns_above=bool(above))
        for a, above in zip(changes.amplitude, changes.overturns_above, strict=True)
    ]


def _more_warnings(
    block: Block,
    question: BlockQuestion,
    contact: ContactExtremes,
    thresholds: list[Threshold],
    margins: Margins | None,
) -> list[str]:
    """Doubts about the question itself."""
    said = []
    if question.restitution == "housner" and block.housner_restitution < 0.0 and contact.outcome != Outcome.NO_UPLIFT:
        said.append(
            f"the restitution (2.4) of this shape is negative ({block.housner_restitution:.3g}): the block stops at "
            "an impact, eta = 0; give a number for another restitution"
        )
    if block.half_width > block.half_height:
        said.append("the block is wider than high: it would rather slide or bounce than rock")
    here = question.peak_acceleration
    near = [t.peak_acceleration for t in thresholds if abs(t.peak_acceleration / here - 1.0) < MARGIN]
    if near:
        said.append(
            f"the fate changes within {100 * MARGIN:g} % of this peak acceleration: at "
            + ", ".join(f"{a:.4g}" for a in near)
            + " m/s2"
        )
    if margins is not None and margins.period_factor is not None and abs(margins.period_factor - 1.0) < MARGIN:
        said.append(f"the fate changes within {100 * MARGIN:g} % of this period: at {margins.nearest_period:.4g} s")
    return said


def _notes(found: ResponseAnswer, margins: Margins | None) -> list[str]:
    said = []
    if found.source == "solver":
        said.append("no data set covers this block within the tolerance; the solver answered, to its own error bound")
    if margins and margins.smallest_surviving_half_diagonal != margins.surviving_from_half_diagonal is not None:
        said.append(
            "size does not help steadily: above the smallest block that survives there are larger ones that fall"
        )
    return said


def _contact_below(
    acceleration: float, question: BlockQuestion, block: Block, asked: ResponseQuestion, stop: StopFlag
) -> ContactExtremes:
    """Contact of the motion just below a change of outcome."""
    motion = build_motion(
        question.pulse,
        slenderness=block.uplift_acceleration / acceleration * (1.0 + BELOW),
        frequency_ratio=asked.frequency_ratio,
        restitution=asked.restitution,
        alpha=block.alpha,
        stop=stop,
    )
    return contact_extremes(motion)


def _safety_warnings(below: ContactExtremes | None, thresholds: list[Threshold]) -> list[str]:
    if below is None or below.rocking_applies:
        return []
    needs = f"it needs a coefficient of friction of {below.largest_friction_demand:.3g}"
    why = "the block lifts off" if below.lifts_off else needs
    lowest = f"{thresholds[0].peak_acceleration:.4g} m/s2, the lowest acceleration at which it overturns"
    return [f"no largest safe acceleration is given: just below {lowest} by the rocking model, {why}"]


def _top_displacement(block: Block, rotation: float) -> float:
    """Horizontal way of the top corner above the pivot, at height 2h over it, [m]."""
    return 2.0 * block.half_height * math.sin(rotation)
