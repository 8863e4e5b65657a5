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
from rocking_api.execution.block_margins import margins_of
from rocking_api.execution.evaluation import evaluate, point_results
from rocking_api.http.params_route import ParamsRoute
from rocking_api.models.blocks import BlockParams, BlockResponse, Margins, Threshold
from rocking_api.models.params import ResponseParams
from rocking_api.models.responses import PointResponse, finite, point_response
from rocking_api.service import Service, ServiceDep

router = APIRouter(prefix="/v1/blocks", tags=["response"], route_class=ParamsRoute)

MARGIN = 0.05
"""Relative distance of a change of outcome below which a warning is given [-]: ground motions are not known better."""

SEARCH_SHARE = 0.2
"""Share of the time limit for the search along one line [-]."""

NOT_FOUND = "the {} at which the outcome changes were not found in time: such a block has too many impacts"

RELATIVE_OFFSET = 1e-9
"""Relative distance below the lowest change of outcome at which the contact is judged [-]."""

HIGHEST_AMPLITUDE = 100.0
"""Largest a = a_g/(g tan alpha) searched for changes of outcome [-], or ten times that of the request if larger."""


@router.get("/response", summary="A block in SI units")
async def get_block(params: Annotated[BlockParams, Query()], request: Request, service: ServiceDep) -> BlockResponse:
    """Outcome, rotation in degrees, displacement in metres, distance to another outcome, friction, by (2.2)."""
    return await service.run_heavy(params, lambda stop: _block(service, params, stop), request)


def _block(service: Service, params: BlockParams, stop: StopFlag) -> BlockResponse:
    block = Block(params.half_width, params.half_height, params.gravity)
    dimensionless = _in_groups(params, block)
    points = {name: getattr(dimensionless, name) for name in ("slenderness", "frequency_ratio", "restitution")}
    (point,) = point_results(*evaluate(service.cubes, dimensionless, **points, stop=stop))
    service.metrics.points(point.source, 1)
    found = point_response(dimensionless, point)
    seconds = SEARCH_SHARE * service.settings.max_seconds
    found_thresholds = run_with_timeout(lambda part: _thresholds(params, block, dimensionless, part), seconds, stop)
    thresholds = found_thresholds or []
    margins = margins_of(params, block, dimensionless, [t.peak_acceleration for t in thresholds], seconds, stop)
    searched = {"peak accelerations": found_thresholds, "periods and sizes": margins}
    below = _contact_below(thresholds[0].peak_acceleration, params, block, dimensionless, stop) if thresholds else None
    safe = below is not None and below.rocking_applies
    peak = None if found.peak_rotation is None else found.peak_rotation * block.alpha
    contact = contact_extremes(build_motion(params.pulse, **points, alpha=block.alpha, stop=stop))
    return BlockResponse(
        query=params,
        url="/v1/blocks/response?" + urlencode(params.model_dump()),
        response=found,
        overturned=found.overturned,
        rocking_model_applies=contact.rocking_applies,
        meaning=contact.sentence,
        peak_rotation_deg=None if peak is None else math.degrees(peak),
        top_displacement=None if peak is None else _top_displacement(block, peak),
        alpha_deg=math.degrees(block.alpha),
        half_diagonal=block.half_diagonal,
        frequency_parameter=block.frequency_parameter,
        restitution=dimensionless.restitution,
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
            *_more_warnings(block, params, contact, thresholds, margins),
            *_safety_warnings(below, thresholds),
            *(NOT_FOUND.format(name) for name, result in searched.items() if result is None),
        ],
        notes=_notes(found, margins),
        data_version=found.data_version,
    )


def _in_groups(params: BlockParams, block: Block) -> ResponseParams:
    """The parameters in the groups of (5.3)."""
    frequency = 2.0 * math.pi / params.pulse_period
    problem = Problem(block.alpha, block.frequency_parameter, params.peak_acceleration, frequency, params.gravity)
    groups = groups_of(problem, GroupSet.RIGID)  # (5.3)
    return ResponseParams(
        pulse=params.pulse,
        method=params.method,
        tolerance=params.tolerance,
        alpha_deg=math.degrees(block.alpha),
        slenderness=float(np.asarray(groups.slenderness)),
        frequency_ratio=float(np.asarray(groups.frequency_ratio)),
        restitution=block.inelastic_restitution if params.restitution == "housner" else params.restitution,
    )


def _thresholds(params: BlockParams, block: Block, dimensionless: ResponseParams, stop: StopFlag) -> list[Threshold]:
    changes = critical_amplitude(
        params.pulse,
        frequency_ratio=dimensionless.frequency_ratio,
        restitution=dimensionless.restitution,
        alpha=block.alpha,
        highest_amplitude=min(max(HIGHEST_AMPLITUDE, 10.0 / dimensionless.slenderness), 1e6),
        stop=stop,
    )
    return [
        Threshold(peak_acceleration=float(a) * block.uplift_acceleration, overturns_above=bool(above))
        for a, above in zip(changes.amplitude, changes.overturns_above, strict=True)
    ]


def _more_warnings(
    block: Block,
    params: BlockParams,
    contact: ContactExtremes,
    thresholds: list[Threshold],
    margins: Margins | None,
) -> list[str]:
    """Warnings about the request itself."""
    texts = []
    if params.restitution == "housner" and block.housner_restitution < 0.0 and contact.outcome != Outcome.NO_UPLIFT:
        texts.append(
            f"the restitution (2.4) of this shape is negative ({block.housner_restitution:.3g}): the block stops at "
            "an impact, eta = 0; give a number for another restitution"
        )
    if block.half_width > block.half_height:
        texts.append("the block is wider than high: it would rather slide or bounce than rock")
    here = params.peak_acceleration
    near = [t.peak_acceleration for t in thresholds if abs(t.peak_acceleration / here - 1.0) < MARGIN]
    if near:
        texts.append(
            f"the outcome changes within {100 * MARGIN:g} % of this peak acceleration: at "
            + ", ".join(f"{a:.4g}" for a in near)
            + " m/s2"
        )
    if margins is not None and margins.period_factor is not None and abs(margins.period_factor - 1.0) < MARGIN:
        texts.append(f"the outcome changes within {100 * MARGIN:g} % of this period: at {margins.nearest_period:.4g} s")
    return texts


def _notes(found: PointResponse, margins: Margins | None) -> list[str]:
    texts = []
    if found.source == "solver":
        texts.append(
            "no data set covers this block within the tolerance; the solver was used, with its own error bound"
        )
    if margins and margins.smallest_surviving_half_diagonal != margins.surviving_from_half_diagonal is not None:
        texts.append("larger is not always safer: above the smallest block that survives, some larger ones overturn")
    return texts


def _contact_below(
    acceleration: float, params: BlockParams, block: Block, dimensionless: ResponseParams, stop: StopFlag
) -> ContactExtremes:
    """Contact of the motion just below a change of outcome."""
    motion = build_motion(
        params.pulse,
        slenderness=block.uplift_acceleration / acceleration * (1.0 + RELATIVE_OFFSET),
        frequency_ratio=dimensionless.frequency_ratio,
        restitution=dimensionless.restitution,
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
    """Horizontal displacement of the top corner above the pivot, at height 2h, [m]."""
    return 2.0 * block.half_height * math.sin(rotation)
