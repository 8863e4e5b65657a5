"""A block in metres under a pulse in m/s2 and seconds."""

from __future__ import annotations

import math
from typing import Annotated, Any, Literal

import numpy as np
from fastapi import APIRouter, Query
from pydantic import BaseModel, Field

from api.answers import ResponseAnswer, finite, response_answer
from api.questions import Method, PulseName, Question, ResponseQuestion, Tolerance
from api.routes.response import ask
from api.service import Service, ServiceDep
from rocking.block import STANDARD_GRAVITY, Block
from rocking.boundary import critical_amplitude
from rocking.errors import InvalidArgumentError, in_range
from rocking.groups import GroupSet, Problem, groups_of
from rocking.history_contact import extremes_of
from rocking.history_motion import motion_of

router = APIRouter(prefix="/v1/blocks", tags=["response"])

BORDER = {
    "half_width": (1e-4, 1e4, "m"),
    "half_height": (1e-4, 1e4, "m"),
    "peak_acceleration": (1e-6, 1e6, "m/s2"),
    "pulse_period": (1e-4, 1e4, "s"),
    "gravity": (1e-3, 1e3, "m/s2"),
}
"""What the service takes, far outside of all practice, so that no number leaves the range of doubles."""

MARGIN = 0.05
"""Relative distance of a change of fate that is worth a warning [-]: ground motions are not known better."""


def _quantity(name: str, text: str, **more: Any) -> Any:
    low, high, unit = BORDER[name]
    return Field(description=f"{text} [{unit}]", json_schema_extra={"minimum": low, "maximum": high}, **more)


class BlockQuestion(Question):
    """A block and a pulse in SI units."""

    pulse: PulseName
    half_width: float = _quantity("half_width", "b; the base is 2b wide", examples=[0.2])
    half_height: float = _quantity("half_height", "h", examples=[0.8])
    peak_acceleration: float = _quantity("peak_acceleration", "a_g", examples=[4.0])
    pulse_period: float = _quantity("pulse_period", "T_p = 2 pi/omega_g", examples=[0.5])
    restitution: Literal["housner"] | float = Field("housner", description="eta [-], or housner: (2.4)")
    gravity: float = _quantity("gravity", "g", default=STANDARD_GRAVITY)
    method: Method = "auto"
    tolerance: Tolerance = 1e-4


class Threshold(BaseModel):
    """An amplitude at which the fate changes."""

    peak_acceleration: float = Field(description="a_g [m/s2]")
    overturns_above: bool = Field(description="true: falls just above and stands just below; false: the other way")


class BlockAnswer(BaseModel):
    """What happens to the block."""

    query: BlockQuestion
    response: ResponseAnswer = Field(description="the same question and answer in dimensionless groups")
    overturned: bool
    meaning: str
    peak_rotation_deg: float | None = Field(description="max |theta| [deg]; null if overturned")
    top_displacement: float | None = Field(description="largest horizontal displacement of the top corner [m]")
    alpha_deg: float = Field(description="slenderness angle [deg]")
    half_diagonal: float = Field(description="R [m]")
    frequency_parameter: float = Field(description="p [rad/s]")
    restitution: float = Field(description="eta [-]")
    uplift_acceleration: float = Field(description="smallest ground acceleration that starts rocking [m/s2]")
    thresholds: list[Threshold] = Field(description="all amplitudes at which the fate changes, this period, ascending")
    largest_safe_acceleration: float | None = Field(
        description="amplitude below which no block of this shape falls at this period [m/s2]; null: none found"
    )
    friction_at_uplift: float = Field(
        description="coefficient of friction below which it slides instead of rocking [-]"
    )
    friction_demand: float | None = Field(
        description="the same through the whole motion, impacts excluded; if it overturns, until it passes alpha for "
        "good [-]; null: it lifts off"
    )
    friction_at_impact: float = Field(
        description="ratio of the horizontal to the vertical impulse at its impacts, 0 without impacts [-]"
    )
    smallest_normal_reaction: float = Field(description="over its weight, for as long [-]; 0 and below: it lifts off")
    warnings: list[str] = Field(description="where the answer, one about pure rocking, is in doubt")


@router.get("/response", summary="A block in SI units")
async def get_block(question: Annotated[BlockQuestion, Query()], service: ServiceDep) -> BlockAnswer:
    """Fate, rotation in degrees, displacement in metres, amplitudes at which the fate changes, friction, by (2.2)."""
    return await service.off_loop(lambda: _block(service, question))


def _block(service: Service, question: BlockQuestion) -> BlockAnswer:
    for name, (low, high, unit) in BORDER.items():
        in_range(name, getattr(question, name), low, high, unit=unit)
    block = Block(question.half_width, question.half_height, question.gravity)
    eta = _restitution(block, question.restitution)
    frequency = 2.0 * math.pi / question.pulse_period
    problem = Problem(block.alpha, block.frequency_parameter, question.peak_acceleration, frequency, question.gravity)
    groups = groups_of(problem, GroupSet.RIGID)  # (5.3)
    asked = ResponseQuestion(
        pulse=question.pulse,
        method=question.method,
        tolerance=question.tolerance,
        alpha_deg=math.degrees(block.alpha),
        slenderness=float(np.asarray(groups.slenderness)),
        frequency_ratio=float(np.asarray(groups.frequency_ratio)),
        restitution=eta,
    )
    points = {name: getattr(asked, name) for name in ("slenderness", "frequency_ratio", "restitution")}
    found = response_answer(asked, *ask(service.atlas, asked, **points))
    changes = critical_amplitude(
        question.pulse, frequency_ratio=asked.frequency_ratio, restitution=eta, alpha=block.alpha
    )
    thresholds = [
        Threshold(peak_acceleration=float(a) * block.uplift_acceleration, overturns_above=bool(above))
        for a, above in zip(changes.amplitude, changes.overturns_above, strict=True)
    ]
    peak = None if found.peak_rotation is None else found.peak_rotation * block.alpha
    contact = extremes_of(motion_of(question.pulse, **points, alpha=block.alpha))
    return BlockAnswer(
        query=question,
        response=found,
        overturned=found.overturned,
        meaning=found.meaning,
        peak_rotation_deg=None if peak is None else math.degrees(peak),
        top_displacement=None if peak is None else _top_displacement(block, peak),
        alpha_deg=math.degrees(block.alpha),
        half_diagonal=block.half_diagonal,
        frequency_parameter=block.frequency_parameter,
        restitution=eta,
        uplift_acceleration=block.uplift_acceleration,
        thresholds=thresholds,
        largest_safe_acceleration=thresholds[0].peak_acceleration if thresholds else None,
        friction_at_uplift=block.half_width / block.half_height,
        friction_demand=finite(contact.largest_friction_demand),
        friction_at_impact=contact.impulse_ratio,
        smallest_normal_reaction=contact.smallest_normal_reaction,
        warnings=[*contact.warnings, *_more_warnings(block, question.peak_acceleration, thresholds)],
    )


def _more_warnings(block: Block, peak_acceleration: float, thresholds: list[Threshold]) -> list[str]:
    """Doubts about the question itself."""
    said = []
    if block.half_width > block.half_height:
        said.append("the block is wider than high: it would rather slide or bounce than rock")
    near = [t.peak_acceleration for t in thresholds if abs(t.peak_acceleration / peak_acceleration - 1.0) < MARGIN]
    if near:
        said.append(
            f"the fate changes within {100 * MARGIN:g} % of this peak acceleration: at "
            + ", ".join(f"{a:.4g}" for a in near)
            + " m/s2"
        )
    return said


def _restitution(block: Block, asked: str | float) -> float:
    if isinstance(asked, float):
        return asked
    if block.housner_restitution < 0.0:
        raise InvalidArgumentError("restitution", "housner", "a number: (2.4) is negative for so stocky a block")
    return block.housner_restitution


def _top_displacement(block: Block, rotation: float) -> float:
    """Horizontal way of the top corner above the pivot, at height 2h over it, [m]."""
    return 2.0 * block.half_height * math.sin(rotation)
