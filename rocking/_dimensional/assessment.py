"""Assessment of a block: margins, contact with the ground, conditioning, and where the answer is in doubt."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from rocking._base.equality import EqualByValue
from rocking._dimensional.margins import Margins, margins_of
from rocking._dimensional.problem import BlockProblem
from rocking._dimensional.threshold import warnings_of_changes
from rocking._dimensional.thresholds import WORDS, BodyThresholds, block_thresholds
from rocking._excitation.records.record import TIME_STEP, Record
from rocking._excitation.records.vertical import highest_vertical_scale
from rocking._history.contact import ContactExtremes, contact_extremes
from rocking._model.outcome import Outcome
from rocking._model.parameters import FREQUENCY_RATIO
from rocking._model.response import Response
from rocking._numba.cancellation import StopFlag, run_with_timeout
from rocking._solver.bounded_response import BoundedResponse
from rocking._solver.records.amplification import CHANGE, record_amplification

SEARCH_SECONDS = 12.0
"""Time limit of the search along one line [s]."""

RELATIVE_OFFSET = 1e-9
"""Relative distance below the lowest change of outcome at which the contact is judged [-]."""

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


@dataclass(frozen=True, eq=False, repr=False)
class Assessment(EqualByValue):
    """What is known about a block under a ground motion beside its response.

    Attributes
    ----------
    problem : BlockProblem
        The block and the motion.
    response : Response, BoundedResponse or None
        The response in groups, arrays of shape (); None if it was not needed, under a pulse.
    contact : ContactExtremes
        Extremes of the contact forces during the motion.
    searched : bool
        Whether the strengths at which the outcome changes were searched.
    thresholds : BodyThresholds or None
        Peak accelerations of the pulse at this period [m/s2], or factors of the record, at which the outcome changes;
        None if they were not searched, or not found in time.
    margins : Margins or None
        Distances to another outcome under a pulse; None for a record, or if not found in time.
    contact_below : ContactExtremes or None
        As `contact` just below the lowest of `thresholds`, under a pulse; None if there is none.
    resampled : Response or None
        The response to the record interpolated band-limited at an eighth of its step; None for a pulse, and for a
        record that would be too long, or its step too small, or its vertical acceleration reach -g.
    amplification : float
        Relative change of the peak rotation per relative change of the horizontal amplitude of a record [-]; infinite
        if the outcome changes within 1e-9 of the amplitude, nan if the block overturns or does not uplift.
    """

    problem: BlockProblem
    response: Response | BoundedResponse | None
    contact: ContactExtremes
    searched: bool
    thresholds: BodyThresholds | None
    margins: Margins | None = None
    contact_below: ContactExtremes | None = None
    resampled: Response | None = None
    amplification: float = math.nan

    def __repr__(self) -> str:
        """Outcome and margin in words."""
        parts = self.sentence, self.margin, f"{len(self.warnings)} warnings" if self.warnings else ""
        return f"<rocking.Assessment: {'; '.join(part for part in parts if part)}>"

    @property
    def sentence(self) -> str:
        """The outcome in words, without a subject; first whether the rocking model does not apply."""
        return self.contact.sentence

    @property
    def rocking_model_applies(self) -> bool:
        """False if pure rocking needs a coefficient of friction beyond 1, or the block lifts off."""
        return self.contact.rocking_applies

    @property
    def largest_safe_acceleration(self) -> float | None:
        """Peak acceleration [m/s2] below which this block does not overturn under this pulse at this period.

        None if no change of outcome was found, or if the rocking model does not apply just below the lowest.
        """
        return self.thresholds[0].value if self.thresholds and self._is_safe_below else None

    @property
    def overturning_scale(self) -> float | None:
        """Lowest factor of the record found at which the block overturns [-]; None if none was found."""
        return self.thresholds[0].value if self.thresholds and self._of_record else None

    @property
    def margin(self) -> str | None:
        """Below which strength of the motion the block does not overturn, in words; None if that was not searched.

        Under a pulse as `largest_safe_acceleration`.
        """
        if self.thresholds is None:
            name = WORDS["scale" if self._of_record else "peak_acceleration"][0]
            return f"from which {name} it overturns was not found in time" if self.searched else None
        if self._of_record:
            return self.thresholds.sentence
        if not self.thresholds:
            return "no peak acceleration was found that overturns it at this period"
        if not self._is_safe_below:
            return "below which peak acceleration it is safe is not known: the rocking model does not apply"
        return f"it does not overturn below {self.thresholds[0].text()} m/s2 at this period"

    @property
    def largest_safe_friction_demand(self) -> float | None:
        """Coefficient of friction that it needs just below that acceleration [-]; None likewise, or if not known."""
        below = self.contact_below
        if below is None or not self._is_safe_below or not self.problem.block.contact_is_known:
            return None
        return below.largest_friction_demand

    @property
    def peak_is_determined(self) -> bool:
        """False if the amplification exceeds `LARGEST_AMPLIFICATION`."""
        return not self.amplification > LARGEST_AMPLIFICATION

    @property
    def warnings(self) -> list[str]:
        """Where the answer, one about pure rocking, is in doubt: contact, block, motion, conditioning, margins."""
        problem, found = self.problem, self.thresholds
        margins = self.margins
        periods = [one for one in margins.periods if one.value == margins.nearest_period] if margins else []
        if self._of_record:
            given, name, unit = problem.scale, "scale", ""
        else:
            given, name, unit = problem.peak_acceleration, "peak acceleration", " m/s2"
        return [
            *self.contact.warnings,
            *problem.warnings,
            *_of_block(problem, self.contact.outcome),
            *self._of_drift(),
            *self._of_sampling(),
            *self._of_conditioning(),
            *warnings_of_changes(given, found or (), name, unit),
            *warnings_of_changes(problem.period, periods, "period", " s"),
            *self._of_safety(),
            *self._of_search(),
        ]

    @property
    def notes(self) -> list[str]:
        """What else is worth knowing."""
        found = self.margins
        if found and found.smallest_surviving_half_diagonal != found.surviving_from_half_diagonal is not None:
            return ["larger is not always safer: above the smallest block that survives, some larger ones overturn"]
        return []

    @property
    def _of_record(self) -> bool:
        return isinstance(self.problem.motion, Record)

    @property
    def _is_safe_below(self) -> bool:
        return self.contact_below is not None and self.contact_below.rocking_applies

    def _of_drift(self) -> list[str]:
        record = self.problem.motion
        if not isinstance(record, Record) or not abs(record.final_velocity) > DRIFT * record.peak_velocity:
            return []
        share = abs(record.final_velocity) / record.peak_velocity
        return [
            f"the velocity of the record ends at {100.0 * share:.0f} % of its largest: its baseline is not corrected"
        ]

    def _of_sampling(self) -> list[str]:
        found, refined = self.response, self.resampled
        if found is None or refined is None:
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

    def _of_safety(self) -> list[str]:
        below = self.contact_below
        if below is None or below.rocking_applies or not self.thresholds:
            return []
        needs = f"it needs a coefficient of friction of {below.largest_friction_demand:.3g}"
        why = "the block lifts off" if below.lifts_off else needs
        lowest = f"{self.thresholds[0].text()} m/s2, the lowest acceleration at which it overturns"
        return [f"no largest safe acceleration is given: just below {lowest} by the rocking model, {why}"]

    def _of_search(self) -> list[str]:
        found = self.thresholds
        if self._of_record and found is not None and not found.overturns_above.all():
            return [
                "the outcome is not monotone in the scale: above the first overturning there are scales it survives"
            ]
        if self._of_record:
            missing = ["factors of the record"] if self.searched and found is None else []
        else:
            searches = {"peak accelerations": found, "periods and sizes": self.margins}
            missing = [name for name, result in searches.items() if result is None and self.searched]
        found_not = "at which the outcome changes were not found in time: such a block has too many impacts"
        return [f"the {name} {found_not}" for name in missing]


def assess(
    problem: BlockProblem,
    response: Response | BoundedResponse | None = None,
    *,
    thresholds: bool = True,
    seconds: float = SEARCH_SECONDS,
    stop: StopFlag | None = None,
    served: tuple[float, float] = (FREQUENCY_RATIO.lower, FREQUENCY_RATIO.upper),
) -> Assessment:
    """Find margins, contact forces and conditioning.

    Parameters
    ----------
    problem : BlockProblem
        The block and the motion.
    response : Response or BoundedResponse, optional
        The response of the problem, if it is known.
    thresholds : bool
        Whether to search the strengths at which the outcome changes, and the margins of a pulse.
    seconds : float
        Time limit of each of these searches [s].
    stop : StopFlag, optional
        Cancels the work, which then raises `StoppedError`.
    served : (float, float)
        Frequency ratios beyond which periods are not searched [-].
    """
    flag = StopFlag() if stop is None else stop
    motion, about = problem.motion, dict[str, Any]()
    found = None
    if isinstance(motion, Record):
        response = problem.solve(flag) if response is None else response
        about["resampled"] = _resampled(problem, motion, flag)
        about["amplification"] = float(record_amplification(motion, **problem.groups, stop=flag))
    if thresholds:
        found = run_with_timeout(lambda part: block_thresholds(problem, stop=part), seconds, flag)
    if thresholds and not isinstance(motion, Record):
        about["margins"] = run_with_timeout(lambda part: margins_of(problem, found or (), part, served), seconds, flag)
        if found:
            lowest = problem.block.uplift_acceleration / found[0].value
            about["contact_below"] = _contact(problem, flag, slenderness=lowest * (1.0 + RELATIVE_OFFSET))
    return Assessment(problem, response, _contact(problem, flag), thresholds, found, **about)


def _contact(problem: BlockProblem, stop: StopFlag, **changed: float) -> ContactExtremes:
    """Contact with the ground during the motion, with other groups where some are given."""
    found = contact_extremes(problem.block_motion(stop, **changed))
    return found if problem.block.contact_is_known else found.without_forces()


def _resampled(problem: BlockProblem, record: Record, stop: StopFlag) -> Response | BoundedResponse | None:
    step, block = record.time_step / REFINEMENT, problem.block
    if record.samples * REFINEMENT > MAX_RESAMPLED or step < TIME_STEP[0]:
        return None
    finer = record.resampled(step)
    if not problem.scale < highest_vertical_scale(finer, block.gravity):
        return None
    eta = problem.groups["restitution"]
    return BlockProblem(block, finer, restitution=eta, scale=problem.scale).solve(stop)


def _of_block(problem: BlockProblem, outcome: Outcome) -> list[str]:
    """Where restitution or shape of a block make its rocking doubtful."""
    texts, block = [], problem.block
    if problem.restitution is None and block.momentum_restitution < 0.0 and outcome != Outcome.NO_UPLIFT:
        texts.append(
            f"the restitution (2.4) of this shape is negative ({block.momentum_restitution:.3g}): the block stops "
            "at an impact, eta = 0; give a number for another restitution"
        )
    if not block.contact_is_known:
        texts.append("the contact forces of this structure are not known: sliding is not assessed")
    elif block.half_width > block.half_height:
        texts.append("the block is wider than high: it would rather slide or bounce than rock")
    return texts
