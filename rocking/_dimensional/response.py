"""The response of a block in SI units: rotation, displacement, outcome in words, margins and warnings."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

from rocking._dimensional.assessment import Assessment, assess
from rocking._dimensional.margins import Margins
from rocking._dimensional.problem import BlockProblem
from rocking._dimensional.scalar_response import (
    BLOCK_FIELDS,
    DISPLACEMENT,
    RESTITUTION,
    ROTATION,
    SLENDERNESS,
    ScalarResponse,
    count_of_impacts,
)
from rocking._dimensional.threshold import Threshold
from rocking._excitation.pulses import as_pulse
from rocking._model.fields import (
    ERROR_BOUND,
    EXCEEDED_ALPHA,
    IMPACTS,
    OUTCOME,
    OVERTURNED,
    PEAK_ROTATION,
    ResponseField,
)
from rocking._solver.bounded_response import BoundedResponse, solve_with_bound

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


@dataclass(frozen=True, eq=False, repr=False)
class BlockResponse(ScalarResponse):
    """What happens to a block under a pulse.

    Margins, contact forces and warnings are found when they are first asked for, in some hundredths of a second.

    Attributes
    ----------
    block : Block
        The block.
    dimensionless : BoundedResponse
        The response in groups, arrays of shape ().
    problem : BlockProblem
        The block and the pulse.
    """

    FIELDS = FIELDS

    dimensionless: BoundedResponse
    problem: BlockProblem

    @property
    def motion(self) -> Mapping[str, str]:
        """The pulse by its name."""
        return {"pulse": as_pulse(self.problem.pulse).name}

    @property
    def peak_acceleration(self) -> float:
        """Peak ground acceleration a_g [m/s2]."""
        return self.problem.peak_acceleration

    @property
    def period(self) -> float:
        """Period T_p of the pulse [s]."""
        return self.problem.period

    @property
    def slenderness(self) -> float:
        """g tan(alpha)/a_g [-]."""
        return self.problem.groups["slenderness"]

    @property
    def frequency_ratio(self) -> float:
        """omega_g/p [-]."""
        return self.problem.groups["frequency_ratio"]

    @property
    def restitution(self) -> float:
        """eta [-]."""
        return self.problem.groups["restitution"]

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
    def margin(self) -> str:
        """Below which peak acceleration the block does not overturn at this period, in words."""
        return self.assessment.margin

    @property
    def warnings(self) -> list[str]:
        """Where the response is in doubt."""
        return self.assessment.warnings

    def _describe_motion(self) -> str:
        return f"{self.motion['pulse']} of {self.peak_acceleration:.4g} m/s2 and {self.period:.4g} s"

    def _describe_impacts(self) -> str:
        return f"{count_of_impacts(self.impacts)} during the pulse"


def respond(problem: BlockProblem) -> BlockResponse:
    """The response of a block, by the solver."""
    return BlockResponse(problem.block, solve_with_bound(problem.pulse, **problem.groups), problem)
