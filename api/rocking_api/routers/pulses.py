"""The excitations that the service knows: definition, parameters, duration, and samples for a drawing."""

from __future__ import annotations

import inspect
import math
from typing import Annotated

import numpy as np
from fastapi import APIRouter, Query
from pydantic import BaseModel

from rocking._base.errors import InvalidArgumentError
from rocking._excitation import pulses
from rocking._excitation.impulse import impulse_of
from rocking_api.models.answer import ListAnswer, Url
from rocking_api.models.params import ListParams
from rocking_api.models.quantity import between, said

router = APIRouter(prefix="/v1", tags=["response"])

MAX_DRAWN = 2000  # most samples of a pulse for a drawing [-]


DIGITS = 4  # decimals of the samples [-]: enough for a drawing, at a fifth of the length


class PulsesParams(ListParams):
    """How finely the pulses are sampled, and a part of their list."""

    samples: int = between(2, MAX_DRAWN, "samples of each pulse", default=65, unit="-")


class PulseParameter(BaseModel):
    """A parameter of a pulse, which follows its name: name(parameter=value, ...)."""

    name: str = said("name of the parameter")
    symbol: str = said("as in the definition")
    unit: str = said("unit of the default and the range; a text states its unit")
    range: str = said("values that are allowed")
    default: float = said("value unless another is stated; with a unit, that of `unit`", unit="-")
    description: str = said("meaning")


class PulseDescription(BaseModel):
    """An excitation u_g(t) = a_g f(omega_g t + phase_start), omega_g = 2 pi/T_p."""

    name: str = said("name; with a leading minus it is mirrored")
    definition: str = said("f(phi) and its window of the phase phi, with its source")
    parameters: list[PulseParameter] = said("parameters, if it has any")
    phase_start: float = said("phase at the first instant", unit="rad")
    phase_end: float = said("phase at the last instant", unit="rad")
    duration: float = said("duration over the period T_p", unit="-")
    peak_velocity: float = said("largest velocity of the ground, which starts at rest, over a_g T_p", unit="-")
    ends_at_rest: bool = said("whether the ground has no velocity after it")
    time: list[float] = said("times from the first instant over T_p, to four decimals, for a drawing", unit="-")
    acceleration: list[float] = said(
        "f at these times, to four decimals; the largest absolute value of f is 1", unit="-"
    )


class PulsesResponse(ListAnswer[PulsesParams]):
    """Excitations."""

    pulses: list[PulseDescription] = said("those of the package, then those registered in this process")


@router.get("/pulses", summary="The excitations")
async def get_pulses(params: Annotated[PulsesParams, Query()], url: Url) -> PulsesResponse:
    """Name, definition, parameters and duration of each pulse; `period` of the other routes is T_p."""
    names = pulses.pulse_names()
    if params.cursor not in (None, *names):
        raise InvalidArgumentError("cursor", params.cursor, f"one of {', '.join(names)}")
    place = {name: f"{k:04d}" for k, name in enumerate(names)}  # in their own order
    asked = params.model_copy(update={"cursor": place.get(params.cursor or "")})
    part, cursor = asked.part(list(place.values()))
    described = [_described(names[int(k)], params.samples) for k in part]
    following = None if cursor is None else names[int(cursor)]
    return PulsesResponse.model_construct(query=params, url=url, pulses=described, next_cursor=following)


def _described(name: str, samples: int) -> PulseDescription:
    pulse = pulses.pulse(name)
    phase = np.linspace(pulse.start, pulse.end, samples)
    impulse = impulse_of(pulse)
    return PulseDescription(
        name=name,
        definition=_definition(name),
        parameters=_parameters(name),
        phase_start=pulse.start,
        phase_end=pulse.end,
        duration=(pulse.end - pulse.start) / (2.0 * math.pi),
        peak_velocity=impulse.largest / (2.0 * math.pi),
        ends_at_rest=impulse.ends_at_rest,
        time=((phase - pulse.start) / (2.0 * math.pi)).round(DIGITS).tolist(),
        acceleration=pulse.shape(phase).round(DIGITS).tolist(),
    )


def _definition(name: str) -> str:
    """The first line of the documentation of a pulse of the package."""
    if name not in pulses.PULSE_NAMES:
        return "registered in this process"
    return (inspect.getdoc(getattr(pulses, name)) or "").partition("\n")[0]


def _parameters(name: str) -> list[PulseParameter]:
    return [
        PulseParameter(
            name=key, symbol=one.symbol, unit=one.unit, range=one.interval, default=one.default, description=one.meaning
        )
        for key, one in pulses.pulse_parameters(name).items()
    ]
