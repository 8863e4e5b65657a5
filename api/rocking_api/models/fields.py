"""Fields of responses that are declared elsewhere, and the groups of them that several responses have.

`of` takes meaning and unit from the declaration of a field; the names and types stand here, and
`tests/api/test_models.py` compares them with the declarations.
"""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BaseModel

from rocking._dimensional.fields import FIELDS, SHOWN
from rocking._dimensional.margins import MARGINS
from rocking._model.fields import COLUMN_FIELDS, ResponseField
from rocking._model.outcome import Outcome
from rocking_api.models.quantity import said

OUTCOMES = [outcome.name for outcome in Outcome]

DECLARED: dict[str, ResponseField] = {field.label: field for field in (*FIELDS, *SHOWN, *MARGINS, *COLUMN_FIELDS)}
"""All declared fields of responses, by their names over HTTP."""

DETAILS = {
    "outcome": f"one of {', '.join(OUTCOMES)}",
    "exceeded_alpha": "the ground can bring a block back from there",
}


def of(name: str, default: Any = ..., missing: str = "") -> Any:
    """A field with the meaning and the unit of a declaration; `missing`: where it is null, if that differs here."""
    field = DECLARED[name]
    reason = missing or field.missing
    parts = [field.meaning, f"null where {reason}" if reason else "", field.detail, DETAILS.get(name, "")]
    is_number = field.dtype[0] in "fi" and not field.flags
    return said("; ".join(filter(None, parts)), default, unit=field.label_unit if is_number else "")


LEFT_OPEN = "a data set leaves it open; method=solver counts"
OTHER_EDGES = "the edges of the body differ from those of a block"


class Ended(BaseModel):
    """How a motion ends, by the solver."""

    overturned: bool = of("overturned")
    outcome: str = of("outcome")
    impacts: int = of("impacts")


class Peaked(Ended):
    """The same with its peak."""

    peak_rotation: float | None = of("peak_rotation")


class LookedUp(BaseModel):
    """The response of one block, by a data set or by the solver."""

    peak_rotation: float | None = of("peak_rotation")
    overturned: bool = of("overturned")
    outcome: str = of("outcome")
    impacts: int | None = of("impacts", missing=LEFT_OPEN)
    exceeded_alpha: bool = of("exceeded_alpha")
    error_bound: float | None = of("error_bound")
    source: str = of("source")
    residual_energy: float | None = of("residual_energy")


class ManyLookedUp(BaseModel):
    """The same of many blocks, a value each."""

    peak_rotation: list[float | None] = of("peak_rotation")
    overturned: list[bool] = of("overturned")
    outcome: list[str] = of("outcome")
    impacts: list[int | None] = of("impacts", missing=LEFT_OPEN)
    exceeded_alpha: list[bool] = of("exceeded_alpha")
    error_bound: list[float | None] = of("error_bound")
    source: list[str] = of("source")
    residual_energy: list[float | None] = of("residual_energy")


class ManySolved(BaseModel):
    """Responses of the solver, a value each."""

    peak_rotation: list[float | None] = of("peak_rotation")
    overturned: list[bool] = of("overturned")
    outcome: list[str] = of("outcome")
    impacts: list[int] = of("impacts")
    exceeded_alpha: list[bool] = of("exceeded_alpha")


Edge = Annotated[
    Literal["right", "left"] | None,
    said("edge of the largest |theta|/alpha, or about which it overturns; null: no uplift, or from a data set"),
]


class InUnitsOfOne(Peaked):
    """What is found of one body in SI units, whatever its edges and the motion."""

    peak_rotation_deg: float | None = of("peak_rotation_deg")
    rotation_left_deg: float | None = of("rotation_left_deg")
    rotation_right_deg: float | None = of("rotation_right_deg")
    edge: Edge
    uplift_time: float | None = of("uplift_time")
    residual_energy: float | None = of("residual_energy")
    alpha_left_deg: float = of("alpha_left_deg")
    alpha_right_deg: float = of("alpha_right_deg")
    displacement: float | None = of("displacement")
    exceeded_alpha: bool = of("exceeded_alpha")
    error_bound: float | None = of("error_bound")
    uplift_acceleration: float = of("uplift_acceleration")
    meaning: str = of("meaning")
    margin: str | None = of("margin")
    rocking_model_applies: bool = of("rocking_model_applies")
    friction_demand: float | None = of("friction_demand")
    friction_at_impact: float | None = of("friction_at_impact")
    smallest_normal_reaction: float | None = of("smallest_normal_reaction")
    lifts_off: bool = of("lifts_off")
    notes: list[str] = said("what else is worth knowing")


class Size(BaseModel):
    """Properties of a block."""

    width: float = of("width")
    height: float = of("height")
    half_diagonal: float = of("half_diagonal")
    alpha_deg: float = of("alpha_deg")
    frequency_parameter: float = of("frequency_parameter")
    uplift_acceleration: float = of("uplift_acceleration")
    restitution: float = of("restitution")


class OfBlock(Size, InUnitsOfOne):
    """What is found of a block."""

    slenderness: float = of("slenderness")
    friction_at_uplift: float = of("friction_at_uplift")


class UnderPulse(BaseModel):
    """What is found under a pulse."""

    pulse_duration: float = of("pulse_duration")


class UnderRecord(BaseModel):
    """What is found under a record."""

    overturning_scale: float | None = of("overturning_scale")
    amplification: float | None = of("amplification")
    peak_is_determined: bool = of("peak_is_determined")
    overturned_resampled: bool | None = of("overturned_resampled")
    peak_rotation_resampled: float | None = of("peak_rotation_resampled")
