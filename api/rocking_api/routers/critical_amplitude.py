"""The inverse question: the amplitudes at which the fate of a block changes."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Query, Request
from pydantic import BaseModel, Field

from rocking._numba.cancellation import StopFlag
from rocking.boundary.amplitude import Thresholds, critical_amplitude
from rocking.model.response import Outcome
from rocking_api.http.params_route import QuestionRoute
from rocking_api.models.params import AlphaDeg, FrequencyRatio, PulseName, Question, Restitution, alpha_of
from rocking_api.models.responses import VERSION
from rocking_api.service import ServiceDep

router = APIRouter(prefix="/v1", tags=["response"], route_class=QuestionRoute)


class AmplitudeQuestion(Question):
    """A block and a pulse, but for its amplitude."""

    pulse: PulseName
    frequency_ratio: FrequencyRatio
    restitution: Restitution
    alpha_deg: AlphaDeg = None
    highest_amplitude: float = Field(
        100.0,
        description="largest a = a_g/(g tan alpha) looked at [-]",
        json_schema_extra={"exclusiveMinimum": 1, "maximum": 1e6},
    )


class AmplitudeThreshold(BaseModel):
    """An amplitude at which the fate changes."""

    amplitude: float = Field(description="a = a_g/(g tan alpha) [-]")
    slenderness: float = Field(description="1/a [-]")
    overturns_above: bool = Field(description="true: falls just above and stands just below it; false: the other way")
    outcome: str = Field(description="fate on the side where it overturns")
    meaning: str = Field(description="that fate in words")
    impacts: int = Field(description="impacts before it overturns there")


class AmplitudeAnswer(BaseModel):
    """All amplitudes at which the fate changes."""

    query: AmplitudeQuestion
    thresholds: list[AmplitudeThreshold] = Field(description="ascending in amplitude")
    largest_safe_amplitude: float | None = Field(
        description="amplitude below which the block never falls [-]; null: it falls at none that was looked at"
    )
    source: str = "solver"
    version: str = VERSION


@router.get("/critical_amplitude", summary="Amplitudes at which the fate of a block changes")
async def get_critical_amplitude(
    question: Annotated[AmplitudeQuestion, Query()], request: Request, service: ServiceDep
) -> AmplitudeAnswer:
    """Every threshold between standing and falling; the solver always answers, each good to 1e-12 in 1/a."""
    return await service.off_loop(question, lambda stop: _answer(question, stop), request)


def _answer(question: AmplitudeQuestion, stop: StopFlag) -> AmplitudeAnswer:
    found = critical_amplitude(
        question.pulse,
        frequency_ratio=question.frequency_ratio,
        restitution=question.restitution,
        alpha=alpha_of(question.alpha_deg),
        highest_amplitude=question.highest_amplitude,
        stop=stop,
    )
    thresholds = _thresholds(found)
    lowest = thresholds[0].amplitude if thresholds else None
    return AmplitudeAnswer(query=question, thresholds=thresholds, largest_safe_amplitude=lowest)


def _thresholds(found: Thresholds) -> list[AmplitudeThreshold]:
    columns = (found.amplitude, found.overturns_above, found.outcome, found.impacts)
    return [
        AmplitudeThreshold(
            amplitude=amplitude,
            slenderness=1.0 / amplitude,
            overturns_above=above,
            outcome=Outcome(code).name,
            meaning=Outcome(code).sentence,
            impacts=impacts,
        )
        for amplitude, above, code, impacts in zip(*(column.tolist() for column in columns), strict=True)
    ]
