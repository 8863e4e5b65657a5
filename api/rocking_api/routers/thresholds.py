"""The inverse problem: amplitudes at which the outcome of a block changes."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Query, Request
from pydantic import BaseModel

from rocking._boundary.amplitude import thresholds
from rocking._model.response import Outcome
from rocking._numba.cancellation import StopFlag
from rocking_api.http.parameters import ParamsRoute
from rocking_api.models.answer import Echoed, Solved
from rocking_api.models.params import BlockInGroups, alpha_of
from rocking_api.models.quantity import said
from rocking_api.routers.twin import pair
from rocking_api.service import ServiceDep

router = APIRouter(prefix="/v1", tags=["response"], route_class=ParamsRoute)


class AmplitudeParams(BlockInGroups):
    """A block and a pulse without amplitude."""

    highest: float = said(
        "largest a = a_g/(g tan alpha) searched [-]", 100.0, json_schema_extra={"exclusiveMinimum": 1, "maximum": 1e6}
    )


class AmplitudeThreshold(BaseModel):
    """An amplitude at which the outcome changes."""

    amplitude: float = said("a = a_g/(g tan alpha) [-]")
    slenderness: float = said("1/a [-]")
    overturns_above: bool = said("true: overturns just above and survives just below it; false: the reverse")
    outcome: str = said("outcome on the side where it overturns")
    meaning: str = said("that outcome in words")
    impacts: int = said("impacts before it overturns there [-]")


class AmplitudeResponse(Echoed[AmplitudeParams], Solved[AmplitudeParams]):
    """All amplitudes at which the outcome changes."""

    thresholds: list[AmplitudeThreshold] = said("ascending in amplitude")
    largest_surviving_amplitude: float | None = said(
        "amplitude below which the block does not overturn [-]; null: no overturning was found"
    )


@pair(router, "/thresholds", "Amplitudes at which the outcome of a block changes", response_model=AmplitudeResponse)
async def get_thresholds(
    params: Annotated[AmplitudeParams, Query()], request: Request, service: ServiceDep
) -> AmplitudeResponse:
    """Every threshold between survival and overturning, by the solver, each accurate to 1e-12 in 1/a.

    Where a block of restitution 1 overturns after more than 200 impacts, they are accurate to 1e-6.
    """
    return await service.run_heavy(params, lambda stop: _answer(params, stop), request)


def _answer(params: AmplitudeParams, stop: StopFlag) -> AmplitudeResponse:
    found = thresholds(
        params.pulse,
        frequency_ratio=params.frequency_ratio,
        restitution=params.restitution,
        alpha=alpha_of(params.alpha_deg),
        highest=params.highest,
        stop=stop,
    )
    listed = [
        AmplitudeThreshold(
            amplitude=amplitude,
            slenderness=1.0 / amplitude,
            overturns_above=above,
            outcome=Outcome(code).name,
            meaning=Outcome(code).sentence,
            impacts=impacts,
        )
        for amplitude, above, code, impacts in zip(
            *(one.tolist() for one in (found.amplitude, found.overturns_above, found.outcome, found.impacts)),
            strict=True,
        )
    ]
    lowest = listed[0].amplitude if listed else None
    return AmplitudeResponse(query=params, thresholds=listed, largest_surviving_amplitude=lowest)
