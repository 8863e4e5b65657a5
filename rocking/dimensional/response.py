"""The response of a block in SI units: rotation, displacement, outcome in words, margins and warnings."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from html import escape
from typing import Any

import pandas as pd
import xarray as xr

from rocking.dimensional.assessment import Assessment, assess
from rocking.dimensional.margins import Margins, Threshold
from rocking.dimensional.problem import BlockProblem
from rocking.excitation.pulses import as_pulse
from rocking.model.block import Block
from rocking.model.fields import ERROR_BOUND, EXCEEDED_ALPHA, IMPACTS, OUTCOME, OVERTURNED, PEAK_ROTATION, ResponseField
from rocking.model.outcome import Outcome
from rocking.solver.bounded_response import BoundedResponse, solve_with_bound

ROTATION = ResponseField("rotation", "f8", "rad", "3.2", "peak rotation max |theta|", "the block overturns")
DISPLACEMENT = ResponseField(
    "displacement", "f8", "m", "3.2", "largest horizontal displacement of a top corner", "the block overturns"
)

BLOCK_FIELDS = (
    ResponseField("half_width", "f8", "m", "2.1", "half width b of the block"),
    ResponseField("half_height", "f8", "m", "2.1", "half height h of the block"),
    ResponseField("half_diagonal", "f8", "m", "2.2", "half-diagonal R of the block"),
    ResponseField("alpha", "f8", "rad", "2.1", "slenderness angle"),
    ResponseField("frequency_parameter", "f8", "rad s-1", "2.2", "frequency parameter p"),
    ResponseField("uplift_acceleration", "f8", "m s-2", "2.1", "smallest ground acceleration that starts rocking"),
)
"""Fields of a block."""

SLENDERNESS = ResponseField("slenderness", "f8", "1", "5.3", "dimensionless slenderness g tan(alpha)/a_g")
RESTITUTION = ResponseField("restitution", "f8", "1", "2.4", "coefficient of restitution eta")

FIELDS = (
    ROTATION,
    DISPLACEMENT,
    OVERTURNED,
    OUTCOME,
    IMPACTS,
    EXCEEDED_ALPHA,
    PEAK_ROTATION,
    ERROR_BOUND,
    *BLOCK_FIELDS,
    ResponseField("peak_acceleration", "f8", "m s-2", "3.2", "peak ground acceleration a_g"),
    ResponseField("period", "f8", "s", "3.2", "period T_p of the pulse"),
    SLENDERNESS,
    ResponseField("frequency_ratio", "f8", "1", "5.3", "frequency ratio omega_g/p"),
    RESTITUTION,
)
"""Fields of a response in SI units, in order; units as CF writes them."""


@dataclass(frozen=True, repr=False)
class BlockResponse:
    """What happens to a block under a pulse.

    Margins, contact forces and warnings are found when they are first asked for, in some hundredths of a second.

    Attributes
    ----------
    problem : BlockProblem
        The block and the pulse.
    dimensionless : BoundedResponse
        The response in groups, arrays of shape ().
    """

    problem: BlockProblem
    dimensionless: BoundedResponse

    @property
    def block(self) -> Block:
        """The block."""
        return self.problem.block

    @property
    def outcome(self) -> Outcome:
        """Final outcome by the rocking model."""
        return Outcome(int(self.dimensionless.outcome))

    @property
    def overturned(self) -> bool:
        """Whether the block overturns in the end."""
        return bool(self.dimensionless.overturned)

    @property
    def impacts(self) -> int:
        """Number of impacts during the pulse, and the one after it that is followed by overturning."""
        return int(self.dimensionless.impacts)

    @property
    def exceeded_alpha(self) -> bool:
        """Whether |theta| passed alpha at some time."""
        return bool(self.dimensionless.exceeded_alpha)

    @property
    def peak_rotation(self) -> float:
        """Peak rotation max |theta|/alpha [-]; nan where the block overturns, 0 without uplift."""
        return float(self.dimensionless.peak_rotation)

    @property
    def rotation(self) -> float:
        """Peak rotation [rad]; nan where the block overturns, 0 without uplift."""
        return self.peak_rotation * self.block.alpha

    @property
    def displacement(self) -> float:
        """Largest horizontal displacement of a top corner [m]; nan where the block overturns."""
        return self.block.top_displacement(self.rotation)

    @cached_property
    def assessment(self) -> Assessment:
        """Margins, contact forces and warnings."""
        return assess(self.problem)

    @property
    def sentence(self) -> str:
        """The outcome in words, without a subject; first whether the rocking model does not apply."""
        return self.assessment.sentence

    @property
    def rocking_model_applies(self) -> bool:
        """False if pure rocking needs a coefficient of friction beyond 1, or the block lifts off."""
        return self.assessment.rocking_model_applies

    @property
    def thresholds(self) -> tuple[Threshold, ...] | None:
        """Peak accelerations [m/s2] at which the outcome changes at this period; None if not found in time."""
        return self.assessment.thresholds

    @property
    def margins(self) -> Margins | None:
        """Distances to another outcome; None if not found in time."""
        return self.assessment.margins

    @property
    def warnings(self) -> list[str]:
        """Where the response is in doubt."""
        return self.assessment.warnings

    def to_dict(self) -> dict[str, Any]:
        """The fields of `FIELDS` with numbers, and the outcome by its name."""
        problem = self.problem
        sources: list[Any] = [self, self.dimensionless, problem, problem.block]
        values: dict[str, Any] = {}
        for field in FIELDS:
            if field.name in problem.groups:
                value = problem.groups[field.name]  # type: ignore[literal-required]
            else:
                value = next(getattr(source, field.name) for source in sources if hasattr(source, field.name))
            values[field.name] = value.name if field is OUTCOME else float(value) if field.dtype == "f8" else value
        return values

    def to_xarray(self) -> xr.Dataset:
        """The fields as a data set of scalars, with units, meanings and equation numbers."""
        values = self.to_dict() | {OUTCOME.name: int(self.outcome)}
        return scalar_dataset(FIELDS, values, pulse=as_pulse(self.problem.pulse).name)

    def to_pandas(self) -> pd.Series:
        """The fields as a series; units are those of `to_xarray`."""
        return pd.Series({"pulse": as_pulse(self.problem.pulse).name} | self.to_dict())

    def __repr__(self) -> str:
        """What happened, in words and SI units."""
        return f"<rocking.BlockResponse: {self._summary()}>"

    def _repr_html_(self) -> str:
        return html_table(self._summary(), FIELDS, self.to_dict())

    def _summary(self) -> str:
        problem = self.problem
        pulse = f"{as_pulse(problem.pulse).name} of {problem.peak_acceleration:.4g} m/s2 and {problem.period:.4g} s"
        count = f"{self.impacts} impact{'' if self.impacts == 1 else 's'} during the pulse"
        happened = summary(self.outcome, count, self.rotation, self.displacement)
        return f"{happened}; block of {describe_size(self.block)} under {pulse}"


def summary(outcome: Outcome, impacts: str, rotation: float, displacement: float) -> str:
    """The outcome in words; if it survives also its rotation [rad], displacement [m] and impacts."""
    if outcome != Outcome.SAFE:
        return outcome.sentence
    peak = f"peak rotation {math.degrees(rotation):.4g} deg, top displacement {displacement:.4g} m"
    return f"{outcome.sentence}: {peak}, {impacts}"


def describe_size(block: Block) -> str:
    """Width and height of a block in words."""
    return f"{2 * block.half_width:.4g} m x {2 * block.half_height:.4g} m"


def scalar_dataset(fields: tuple[ResponseField, ...], values: Mapping[str, Any], **attributes: str) -> xr.Dataset:
    """A data set of scalars with units, meanings and equation numbers."""
    variables = {one.name: ((), values[one.name], {"units": one.unit} | one.attributes) for one in fields}
    return xr.Dataset(variables, attrs=attributes)


def html_table(caption: str, fields: tuple[ResponseField, ...], values: Mapping[str, Any]) -> str:
    """A paragraph and a table of meanings, values and units."""
    rows = "".join(
        f"<tr><td>{escape(one.meaning)}</td><td>{escape(_text(values[one.name]))}</td>"
        f"<td>{'' if one.unit == '1' else escape(one.unit)}</td></tr>"
        for one in fields
    )
    return f"<p>{escape(caption)}</p><table>{rows}</table>"


def _text(value: Any) -> str:
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def respond(problem: BlockProblem) -> BlockResponse:
    """The response of a block, by the solver."""
    return BlockResponse(problem, solve_with_bound(problem.pulse, **problem.groups))
