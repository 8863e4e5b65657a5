"""A block in metres under a record: outcome, rotation, and how far it is from another outcome."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from rocking._numba.cancellation import StopFlag
from rocking.dimensional.problem import restitution_of
from rocking.dimensional.record_scales import HIGHEST_SCALE, ScaleThresholds, checked_scale, scale_thresholds
from rocking.dimensional.scalar_response import (
    BLOCK_FIELDS,
    DISPLACEMENT,
    RESTITUTION,
    ROTATION,
    SLENDERNESS,
    ScalarResponse,
    count_of_impacts,
)
from rocking.excitation.records.record import TIME_STEP, Record
from rocking.model.block import Block
from rocking.model.fields import EXCEEDED_ALPHA, IMPACTS, OUTCOME, OVERTURNED, PEAK_ROTATION, ResponseField
from rocking.model.outcome import Outcome
from rocking.model.response import Response
from rocking.solver.records.record_response import record_response

MARGIN = 0.05
"""Relative distance of a change of outcome below which a warning is given [-]: ground motions are not known better."""

REFINEMENT = 8
"""Samples into which one is divided by band-limited interpolation, for the comparison of samplings."""

SAMPLING_DIFFERENCE = 0.05
"""Relative difference of the peaks of both samplings above which a warning is given [-]."""

DRIFT = 0.1
"""Velocity at the end of a record over its largest above which a warning is given [-]."""

MAX_RESAMPLED = 400_000
"""Most samples of the refined record; a longer one is not compared, nor one whose step would be too small."""


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


@dataclass(frozen=True, repr=False)
class BlockRecordResponse(ScalarResponse):
    """What happens to a block under a record.

    Attributes
    ----------
    block : Block
        The block.
    dimensionless : Response
        The response in groups, arrays of shape ().
    record : Record
        Ground motion, without the factor.
    scale : float
        Factor of the record [-].
    restitution : float
        eta [-].
    resampled : Response or None
        The response to the record interpolated band-limited at an eighth of its step; None for a record that would be
        too long, or its step too small.
    thresholds : ScaleThresholds or None
        Scales of the record at which the outcome changes; None if they were not asked for.
    warnings : tuple of str
        Where the response is in doubt.
    """

    FIELDS = FIELDS

    record: Record
    scale: float
    restitution: float
    resampled: Response | None
    thresholds: ScaleThresholds | None
    warnings: tuple[str, ...]

    @property
    def motion(self) -> Mapping[str, str]:
        """The record by its name."""
        return {"record": self.record.name}

    @property
    def peak_acceleration(self) -> float:
        """Peak ground acceleration of the scaled record [m/s2]."""
        return self.scale * self.record.peak_acceleration

    @property
    def slenderness(self) -> float:
        """g tan(alpha)/PGA of the scaled record [-]."""
        return self.block.uplift_acceleration / self.peak_acceleration

    def _describe_motion(self) -> str:
        return f"{self.record.name or 'a record'} scaled to {self.peak_acceleration:.4g} m/s2"

    def _describe_impacts(self) -> str:
        return count_of_impacts(self.impacts)


def respond_to_record(
    block: Block,
    record: Record,
    *,
    scale: float = 1.0,
    restitution: str | float = "housner",
    thresholds: bool = False,
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
    restitution : "housner" or float
        (2.4), 0 where that is negative; or eta [-], [0, 1].
    thresholds : bool
        Whether to search the scales at which the outcome changes, up to ten times the scale of uplift or twice `scale`.
    stop : StopFlag, optional
        Cancels the work, which then raises `StoppedError`.

    Raises
    ------
    InvalidArgumentError
        For an argument out of range.
    """
    factor = checked_scale(scale)
    eta = restitution_of(block, restitution)
    uplift = block.uplift_acceleration / record.peak_acceleration

    def solve(motion: Record) -> Response:
        return record_response(
            motion,
            frequency_parameter=block.frequency_parameter,
            slenderness=block.uplift_acceleration / (factor * motion.peak_acceleration),
            restitution=eta,
            alpha=block.equation_alpha,
            stop=stop,
        )

    found = solve(record)
    refined, step = None, record.time_step / REFINEMENT
    if record.samples * REFINEMENT <= MAX_RESAMPLED and step >= TIME_STEP[0]:
        refined = solve(record.resampled(step))
    searched = None
    if thresholds:
        highest = min(max(10.0 * uplift, 2.0 * factor), HIGHEST_SCALE)
        searched = scale_thresholds(record, block, restitution=eta, highest=highest, stop=stop)
    return BlockRecordResponse(
        block=block,
        record=record,
        scale=factor,
        restitution=eta,
        dimensionless=found,
        resampled=refined,
        thresholds=searched,
        warnings=(
            *_of_record(record),
            *_of_sampling(found, refined),
            *_of_thresholds(factor, searched),
        ),
    )


def _of_record(record: Record) -> list[str]:
    share = abs(record.final_velocity) / record.peak_velocity if record.peak_velocity > 0.0 else 0.0
    if share <= DRIFT:
        return []
    return [f"the velocity of the record ends at {100.0 * share:.0f} % of its largest: its baseline is not corrected"]


def _of_sampling(found: Response, refined: Response | None) -> list[str]:
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


def _of_thresholds(scale: float, searched: ScaleThresholds | None) -> list[str]:
    if searched is None:
        return []
    near = [float(value) for value in searched.scale if abs(value / scale - 1.0) < MARGIN]
    texts = []
    if near:
        places = ", ".join(f"{value:.4g}" for value in near)
        texts.append(f"the outcome changes within {100.0 * MARGIN:g} % of this scale: at {places}")
    if not searched.overturns_above.all():
        texts.append(
            "the outcome is not monotone in the scale: above the first overturning there are scales it survives"
        )
    return texts
