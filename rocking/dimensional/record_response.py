"""A block in metres under a record: outcome, rotation, and how far it is from another outcome."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import pandas as pd
import xarray as xr

from rocking._numba.cancellation import StopFlag
from rocking.dimensional.problem import restitution_of
from rocking.dimensional.record_scales import HIGHEST_SCALE, ScaleThresholds, scale_thresholds
from rocking.dimensional.response import (
    BLOCK_FIELDS,
    DISPLACEMENT,
    RESTITUTION,
    ROTATION,
    SLENDERNESS,
    describe_size,
    html_table,
    scalar_dataset,
    summary,
)
from rocking.errors import InvalidArgumentError, in_range
from rocking.excitation.records.record import Record
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
"""Most samples of the refined record; a longer one is not compared."""


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
class BlockRecordResponse:
    """What happens to a block under a record.

    Attributes
    ----------
    block : Block
        The block.
    record : Record
        Ground motion, without the factor.
    scale : float
        Factor of the record [-].
    restitution : float
        eta [-].
    response : Response
        In groups, arrays of shape ().
    resampled : Response or None
        The response to the record interpolated band-limited at an eighth of its step; None for a record that would be
        too long.
    thresholds : ScaleThresholds or None
        Scales of the record at which the outcome changes; None if they were not asked for.
    warnings : tuple of str
        Where the response is in doubt.
    """

    block: Block
    record: Record
    scale: float
    restitution: float
    response: Response
    resampled: Response | None
    thresholds: ScaleThresholds | None
    warnings: tuple[str, ...]

    @property
    def peak_acceleration(self) -> float:
        """Peak ground acceleration of the scaled record [m/s2]."""
        return self.scale * self.record.peak_acceleration

    @property
    def slenderness(self) -> float:
        """g tan(alpha)/PGA of the scaled record [-]."""
        return self.block.uplift_acceleration / self.peak_acceleration

    @property
    def outcome(self) -> Outcome:
        """The final outcome."""
        return Outcome(int(self.response.outcome))

    @property
    def overturned(self) -> bool:
        """Whether the block overturns in the end."""
        return bool(self.response.overturned)

    @property
    def impacts(self) -> int:
        """Number of impacts until the outcome is certain."""
        return int(self.response.impacts)

    @property
    def exceeded_alpha(self) -> bool:
        """Whether |theta| passed alpha at some time."""
        return bool(self.response.exceeded_alpha)

    @property
    def peak_rotation(self) -> float:
        """Peak rotation max |theta|/alpha [-]; nan where the block overturns, 0 without uplift."""
        return float(self.response.peak_rotation)

    @property
    def rotation(self) -> float:
        """Peak rotation [rad]; nan where the block overturns, 0 without uplift."""
        return self.peak_rotation * self.block.alpha

    @property
    def displacement(self) -> float:
        """Largest horizontal displacement of a top corner [m]; nan where the block overturns."""
        return self.block.top_displacement(self.rotation)

    def to_dict(self) -> dict[str, Any]:
        """The fields of `FIELDS` with numbers, and the outcome by its name."""
        values: dict[str, Any] = {}
        for field in FIELDS:
            value = getattr(self if hasattr(self, field.name) else self.block, field.name)
            values[field.name] = value.name if field is OUTCOME else float(value) if field.dtype == "f8" else value
        return values

    def to_xarray(self) -> xr.Dataset:
        """The fields as a data set of scalars, with units, meanings and equation numbers."""
        return scalar_dataset(FIELDS, self.to_dict() | {OUTCOME.name: int(self.outcome)}, record=self.record.name)

    def to_pandas(self) -> pd.Series:
        """The fields as a series; units are those of `to_xarray`."""
        return pd.Series({"record": self.record.name} | self.to_dict())

    def __repr__(self) -> str:
        """What happened, in words and SI units."""
        return f"<rocking.BlockRecordResponse: {self._summary()}>"

    def _repr_html_(self) -> str:
        return html_table(self._summary(), FIELDS, self.to_dict())

    def _summary(self) -> str:
        motion = f"{self.record.name} scaled to {self.peak_acceleration:.4g} m/s2"
        count = f"{self.impacts} impact{'' if self.impacts == 1 else 's'}"
        happened = summary(self.outcome, count, self.rotation, self.displacement)
        return f"{happened}; block of {describe_size(self.block)} under {motion}"


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
    factor = in_range("scale", scale, 0.0, HIGHEST_SCALE, closed="right")
    if factor.ndim:
        raise InvalidArgumentError("scale", scale, "one number")
    eta = restitution_of(block, restitution)
    uplift = block.uplift_acceleration / record.peak_acceleration

    def solve(motion: Record) -> Response:
        return record_response(
            motion,
            frequency_parameter=block.frequency_parameter,
            slenderness=block.uplift_acceleration / (float(factor) * motion.peak_acceleration),
            restitution=eta,
            alpha=block.alpha,
            stop=stop,
        )

    found = solve(record)
    refined = None
    if record.samples * REFINEMENT <= MAX_RESAMPLED:
        refined = solve(record.resampled(record.time_step / REFINEMENT))
    searched = None
    if thresholds:
        highest = min(max(10.0 * uplift, 2.0 * float(factor)), HIGHEST_SCALE)
        searched = scale_thresholds(record, block, restitution=eta, highest=highest, stop=stop)
    return BlockRecordResponse(
        block=block,
        record=record,
        scale=float(factor),
        restitution=eta,
        response=found,
        resampled=refined,
        thresholds=searched,
        warnings=(
            *_of_record(record),
            *_of_sampling(found, refined),
            *_of_thresholds(float(factor), searched),
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
