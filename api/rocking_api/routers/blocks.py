"""A block in metres under a pulse in m/s2 and seconds."""

from __future__ import annotations

import math
from typing import Annotated, Any
from urllib.parse import urlencode

from fastapi import APIRouter, Query, Request

from rocking._numba.cancellation import StopFlag
from rocking.dimensional.assessment import Assessment, assess
from rocking.dimensional.margins import Margins as FoundMargins
from rocking.dimensional.problem import BlockProblem
from rocking.model.block import Block
from rocking_api.execution.evaluation import evaluate, point_results
from rocking_api.http.params_route import ParamsRoute
from rocking_api.models.blocks import BlockParams, BlockResponse, Margins, PeriodThreshold, SizeThreshold, Threshold
from rocking_api.models.params import FREQUENCY_RATIO, ResponseParams
from rocking_api.models.responses import PointResponse, finite, point_response
from rocking_api.service import Service, ServiceDep

router = APIRouter(prefix="/v1/blocks", tags=["response"], route_class=ParamsRoute)

SEARCH_SHARE = 0.2
"""Share of the time limit for the search along one line [-]."""

BY_SOLVER = "no data set covers this block within the tolerance; the solver was used, with its own error bound"


@router.get("/response", summary="A block in SI units")
async def get_block(params: Annotated[BlockParams, Query()], request: Request, service: ServiceDep) -> BlockResponse:
    """Outcome, rotation in degrees, displacement in metres, distance to another outcome, friction, by (2.2)."""
    return await service.run_heavy(params, lambda stop: _block(service, params, stop), request)


def _block(service: Service, params: BlockParams, stop: StopFlag) -> BlockResponse:
    block = Block(params.half_width, params.half_height, params.gravity)
    problem = BlockProblem(block, params.pulse, params.peak_acceleration, params.pulse_period, params.restitution)
    found = _point(service, params, problem, stop)
    seconds = SEARCH_SHARE * service.settings.max_seconds
    assessment = assess(problem, seconds=seconds, stop=stop, served=(FREQUENCY_RATIO.lower, FREQUENCY_RATIO.upper))
    peak = None if found.peak_rotation is None else found.peak_rotation * block.alpha
    return BlockResponse(
        query=params,
        url="/v1/blocks/response?" + urlencode(params.model_dump()),
        response=found,
        overturned=found.overturned,
        peak_rotation_deg=None if peak is None else math.degrees(peak),
        top_displacement=None if peak is None else block.top_displacement(peak),
        alpha_deg=math.degrees(block.alpha),
        half_diagonal=block.half_diagonal,
        frequency_parameter=block.frequency_parameter,
        restitution=found.query.restitution,
        uplift_acceleration=block.uplift_acceleration,
        friction_at_uplift=block.half_width / block.half_height,
        notes=[*([BY_SOLVER] if found.source == "solver" else []), *assessment.notes],
        data_version=found.data_version,
        **_assessed(assessment),
    )


def _point(service: Service, params: BlockParams, problem: BlockProblem, stop: StopFlag) -> PointResponse:
    """The response in groups, by a data set or by the solver."""
    groups = problem.groups
    dimensionless = ResponseParams(
        pulse=params.pulse,
        method=params.method,
        tolerance=params.tolerance,
        alpha_deg=math.degrees(groups["alpha"]),
        slenderness=groups["slenderness"],
        frequency_ratio=groups["frequency_ratio"],
        restitution=groups["restitution"],
    )
    points = {name: getattr(dimensionless, name) for name in ("slenderness", "frequency_ratio", "restitution")}
    (point,) = point_results(*evaluate(service.cubes, dimensionless, **points, stop=stop))
    service.metrics.points(point.source, 1)
    return point_response(dimensionless, point)


def _assessed(found: Assessment) -> dict[str, Any]:
    """The fields of a response that come from the assessment."""
    thresholds = found.thresholds
    return {
        "rocking_model_applies": found.rocking_model_applies,
        "meaning": found.sentence,
        "thresholds": None
        if thresholds is None
        else [Threshold(peak_acceleration=one.value, overturns_above=one.overturns_above) for one in thresholds],
        "largest_safe_acceleration": found.largest_safe_acceleration,
        "largest_safe_friction_demand": found.largest_safe_friction_demand,
        "margins": None if found.margins is None else _margins(found.margins),
        "friction_demand": finite(found.contact.largest_friction_demand),
        "friction_at_impact": found.contact.impulse_ratio,
        "smallest_normal_reaction": found.contact.smallest_normal_reaction,
        "warnings": found.warnings,
    }


def _margins(found: FoundMargins) -> Margins:
    periods = [PeriodThreshold(pulse_period=one.value, overturns_above=one.overturns_above) for one in found.periods]
    sizes = [SizeThreshold(half_diagonal=one.value, overturns_above=one.overturns_above) for one in found.sizes]
    return Margins.model_validate(vars(found) | {"periods": periods, "sizes": sizes})
