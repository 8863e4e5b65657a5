"""A block in metres under a record: outcome, rotation, and how far it is from another outcome."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

from rocking._base.units import Scalar
from rocking._dimensional.assessment import SEARCH_SECONDS
from rocking._dimensional.record_assessment import RecordAssessment, assess_record
from rocking._dimensional.record_problem import RecordProblem
from rocking._dimensional.record_scales import ScaleThresholds
from rocking._dimensional.scalar_response import (
    BLOCK_FIELDS,
    DISPLACEMENT,
    RESTITUTION,
    ROTATION,
    SLENDERNESS,
    ScalarResponse,
    count_of_impacts,
)
from rocking._excitation.records.record import Record
from rocking._model.block import AbstractBlock
from rocking._model.fields import EXCEEDED_ALPHA, IMPACTS, OUTCOME, OVERTURNED, PEAK_ROTATION, ResponseField
from rocking._model.response import Response
from rocking._numba.cancellation import StopFlag

FIELDS = (
    ROTATION,
    DISPLACEMENT,
    OVERTURNED,
    OUTCOME,
    IMPACTS,
    EXCEEDED_ALPHA,
    PEAK_ROTATION,
    *BLOCK_FIELDS,
    ResponseField("scale", "f8", "1", "2.2", "factor of the record"),
    ResponseField("peak_acceleration", "f8", "m s-2", "2.2", "peak ground acceleration of the scaled record"),
    SLENDERNESS,
    RESTITUTION,
)
"""Fields of the response to a record in SI units, in order."""


@dataclass(frozen=True, eq=False, repr=False)
class BlockRecordResponse(ScalarResponse):
    """What happens to a block under a record.

    Margins, contact forces and warnings are found when they are first asked for, in some tenths of a second.

    Attributes
    ----------
    block : Block
        The block.
    dimensionless : Response
        The response in groups, arrays of shape ().
    problem : RecordProblem
        The block and the record.
    searches_thresholds : bool
        Whether the scales at which the outcome changes are searched.
    """

    FIELDS = FIELDS

    dimensionless: Response
    problem: RecordProblem
    searches_thresholds: bool

    @property
    def motion(self) -> Mapping[str, str]:
        """The record by its name."""
        return {"record": self.record.name}

    @property
    def record(self) -> Record:
        """Ground motion, without the factor."""
        return self.problem.record

    @property
    def scale(self) -> float:
        """Factor of the record [-]."""
        return self.problem.scale

    @property
    def restitution(self) -> float:
        """eta [-]."""
        return self.problem.groups["restitution"]

    @property
    def peak_acceleration(self) -> float:
        """Peak ground acceleration of the scaled record [m/s2]."""
        return self.scale * self.record.peak_acceleration

    @property
    def slenderness(self) -> float:
        """g tan(alpha)/PGA of the scaled record [-]."""
        return self.problem.groups["slenderness"]

    @cached_property
    def assessment(self) -> RecordAssessment:
        """Margins, contact forces, conditioning and warnings."""
        return self.assess()

    def assess(self, *, seconds: float = SEARCH_SECONDS, stop: StopFlag | None = None) -> RecordAssessment:
        """The assessment, with a time limit [s] of the search and a flag that cancels the work."""
        return assess_record(
            self.problem, self.dimensionless, thresholds=self.searches_thresholds, seconds=seconds, stop=stop
        )

    @property
    def sentence(self) -> str:
        """The outcome and the margin in words, without a subject; first whether the rocking model does not apply."""
        return "; ".join(part for part in (self.assessment.sentence, self.margin) if part)

    @property
    def margin(self) -> str | None:
        """From which factor of the record the block overturns, in words; None if that was not searched."""
        return self.assessment.margin

    @property
    def rocking_model_applies(self) -> bool:
        """False if pure rocking needs a coefficient of friction beyond 1, or the block lifts off."""
        return self.assessment.rocking_model_applies

    @property
    def resampled(self) -> Response | None:
        """The response to the record interpolated band-limited at an eighth of its step; None if it is not computed."""
        return self.assessment.resampled

    @property
    def thresholds(self) -> ScaleThresholds | None:
        """Scales of the record at which the outcome changes; None if not searched, or not found in time."""
        return self.assessment.thresholds

    @property
    def warnings(self) -> list[str]:
        """Where the response is in doubt."""
        return self.assessment.warnings

    def _describe_motion(self) -> str:
        return f"{self.record.name or 'a record'} scaled to {self.peak_acceleration:.4g} m/s2"

    def _describe_impacts(self) -> str:
        return count_of_impacts(self.impacts)

    def _describe_outcome(self) -> str:
        return self.assessment.sentence

    def _describe_peak(self) -> str:
        found = self.assessment
        doubt = "" if found.peak_is_determined else f" (not determined: amplification {found.amplification:.1e})"
        return super()._describe_peak() + doubt

    def _describe_margin(self) -> str:
        margin = self.margin
        return f"; {margin}" if margin else ""


def respond_to_record(
    block: AbstractBlock,
    record: Record,
    *,
    scale: Scalar = 1.0,
    restitution: Scalar = "momentum",
    thresholds: bool = True,
    stop: StopFlag | None = None,
) -> BlockRecordResponse:
    """Response of a block to a record, by (2.2).

    Parameters
    ----------
    block : Block
        The block.
    record : Record
        Ground motion.
    scale : float
        Factor of the record [-], (0, 1e6].
    restitution : "momentum" or float
        (2.4), 0 where that is negative; or eta [-], [0, 1].
    thresholds : bool
        Whether the assessment searches the scales at which the outcome changes, which takes most of its time.
    stop : StopFlag, optional
        Cancels the work, which then raises `StoppedError`; `BlockRecordResponse.assess` has its own.

    Raises
    ------
    InvalidArgumentError
        For an argument out of range.
    """
    problem = RecordProblem(block, record, scale, restitution)
    return BlockRecordResponse(block, problem.solve(stop=stop), problem, thresholds)
