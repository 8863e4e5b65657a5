"""Assessment of a block under a record: margins, contact, conditioning, sampling, and where the answer is in doubt."""

from __future__ import annotations

import math
from dataclasses import dataclass

from rocking._dimensional.assessment import SEARCH_SECONDS
from rocking._dimensional.block_warnings import NOT_FOUND, warnings_of_block, warnings_of_changes
from rocking._dimensional.record_groups import HIGHEST_SCALE, uplift_scale
from rocking._dimensional.record_problem import RecordProblem
from rocking._dimensional.record_scales import ScaleThresholds, scale_thresholds
from rocking._excitation.records.record import TIME_STEP, Record
from rocking._excitation.records.vertical import highest_vertical_scale
from rocking._history.contact import ContactExtremes, contact_extremes
from rocking._history.motion import build_record_motion
from rocking._model.outcome import Outcome
from rocking._model.response import Response
from rocking._numba.cancellation import StopFlag, run_with_timeout
from rocking._solver.records.amplification import CHANGE, record_amplification

REFINEMENT = 8
"""Samples into which one is divided by band-limited interpolation, for the comparison of samplings."""

SAMPLING_DIFFERENCE = 0.05
"""Relative difference of the peaks of both samplings above which a warning is given [-]."""

DRIFT = 0.1
"""Velocity at the end of a record over its largest above which a warning is given [-]."""

MAX_RESAMPLED = 400_000
"""Most samples of the refined record; a longer one is not compared."""

LARGEST_AMPLIFICATION = 1e4
"""Amplification above which a record does not determine the peak [-]: of samples with six digits it leaves two."""


@dataclass(frozen=True)
class RecordAssessment:
    """What is known about a block under a record beside its response.

    Attributes
    ----------
    problem : RecordProblem
        The block and the record.
    response : Response
        The response in groups, arrays of shape ().
    resampled : Response or None
        The response to the record interpolated band-limited at an eighth of its step; None for a record that would be
        too long, or its step too small, or its vertical acceleration reach -g.
    amplification : float
        Relative change of the peak rotation per relative change of the horizontal amplitude [-]; infinite if the
        outcome changes within 1e-9 of the amplitude, nan if the block overturns or does not uplift.
    contact : ContactExtremes
        Extremes of the contact forces during the motion.
    searched : bool
        Whether the factors at which the outcome changes were searched.
    thresholds : ScaleThresholds or None
        These factors; None if they were not searched, or not found in time.
    """

    problem: RecordProblem
    response: Response
    resampled: Response | None
    amplification: float
    contact: ContactExtremes
    searched: bool
    thresholds: ScaleThresholds | None

    @property
    def sentence(self) -> str:
        """The outcome in words, without a subject; first whether the rocking model does not apply."""
        return self.contact.sentence

    @property
    def rocking_model_applies(self) -> bool:
        """False if pure rocking needs a coefficient of friction beyond 1, or the block lifts off."""
        return self.contact.rocking_applies

    @property
    def margin(self) -> str | None:
        """From which factor of the record the block overturns, in words; None if that was not searched."""
        if self.thresholds is None:
            return "from which factor of the record it overturns was not found in time" if self.searched else None
        return self.thresholds.sentence

    @property
    def overturning_scale(self) -> float | None:
        """Lowest factor of the record found at which the block overturns [-]; None if none was found."""
        found = self.thresholds
        return float(found.scale[0]) if found is not None and found.scale.size else None

    @property
    def peak_is_determined(self) -> bool:
        """False if the amplification exceeds `LARGEST_AMPLIFICATION`."""
        return not self.amplification > LARGEST_AMPLIFICATION

    @property
    def warnings(self) -> list[str]:
        """Where the answer is in doubt: contact, block, record, sampling, conditioning, margins."""
        problem = self.problem
        return [
            *self.contact.warnings,
            *warnings_of_block(problem.block, problem.restitution, self.contact.outcome),
            *problem.record.remarks,
            *_of_record(problem.record),
            *self._of_sampling(),
            *self._of_conditioning(),
            *self._of_thresholds(),
        ]

    def _of_sampling(self) -> list[str]:
        found, refined = self.response, self.resampled
        if refined is None:
            return []
        if bool(found.overturned) != bool(refined.overturned):
            other = Outcome(int(refined.outcome)).sentence
            return [f"the record is sampled too coarsely for this answer: interpolated band-limited, the block {other}"]
        peak, other_peak = float(found.peak_rotation), float(refined.peak_rotation)
        if abs(other_peak - peak) <= SAMPLING_DIFFERENCE * peak or math.isnan(peak):
            return []
        peaks = f"{other_peak:.3g} alpha instead of {peak:.3g} alpha"
        return [f"the record is sampled coarsely: interpolated band-limited, the peak rotation is {peaks}"]

    def _of_conditioning(self) -> list[str]:
        if self.peak_is_determined:
            return []
        if math.isinf(self.amplification):
            return [f"the outcome is not determined by this record: it changes within {CHANGE:g} of the amplitude"]
        change = f"its relative change is {self.amplification:.1e} times that of the amplitude"
        return [f"the peak is not determined by this record: {change}"]

    def _of_thresholds(self) -> list[str]:
        found = self.thresholds
        if found is None:
            return [NOT_FOUND.format("factors of the record")] if self.searched else []
        texts = warnings_of_changes(self.problem.scale, found.changes, "scale")
        if not found.overturns_above.all():
            texts.append(
                "the outcome is not monotone in the scale: above the first overturning there are scales it survives"
            )
        return texts


def assess_record(
    problem: RecordProblem,
    response: Response,
    *,
    thresholds: bool = True,
    seconds: float = SEARCH_SECONDS,
    stop: StopFlag | None = None,
) -> RecordAssessment:
    """Find margins, contact forces and conditioning.

    Parameters
    ----------
    problem : RecordProblem
        The block and the record.
    response : Response
        The response of the problem.
    thresholds : bool
        Whether to search the scales at which the outcome changes, up to ten times the scale of uplift or twice that of
        the problem.
    seconds : float
        Time limit of this search [s].
    stop : StopFlag, optional
        Cancels the work.

    Raises
    ------
    StoppedError
        If `stop` was set.
    """
    flag = StopFlag() if stop is None else stop
    record, block, groups = problem.record, problem.block, problem.groups
    refined = None
    step = record.time_step / REFINEMENT
    if record.samples * REFINEMENT <= MAX_RESAMPLED and step >= TIME_STEP[0]:
        finer = record.resampled(step)
        if problem.scale < highest_vertical_scale(finer, block.gravity):
            refined = problem.solve(finer, stop=flag)
    contact = contact_extremes(build_record_motion(record, **groups, stop=flag))
    searched = None
    if thresholds:
        highest = min(max(10.0 * uplift_scale(record, block), 2.0 * problem.scale), HIGHEST_SCALE)

        def search(part: StopFlag) -> ScaleThresholds:
            return scale_thresholds(record, block, restitution=groups["restitution"], highest=highest, stop=part)

        searched = run_with_timeout(search, seconds, flag)
    return RecordAssessment(
        problem=problem,
        response=response,
        resampled=refined,
        amplification=float(record_amplification(record, **groups, stop=flag)),
        contact=contact if block.contact_is_known else contact.without_forces(),
        searched=thresholds,
        thresholds=searched,
    )


def _of_record(record: Record) -> list[str]:
    share = abs(record.final_velocity) / record.peak_velocity if record.peak_velocity > 0.0 else 0.0
    if share <= DRIFT:
        return []
    return [f"the velocity of the record ends at {100.0 * share:.0f} % of its largest: its baseline is not corrected"]
