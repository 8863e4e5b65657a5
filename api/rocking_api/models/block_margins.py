"""How far a block in metres is from another fate: in amplitude, in period, in size."""

from __future__ import annotations

import math

from rocking._numba.cancellation import StopFlag, run_with_timeout
from rocking.boundary.frequency import FrequencyThresholds, critical_frequency_ratio
from rocking.model.block import Block
from rocking_api.models.blocks import BlockQuestion, Margins, PeriodThreshold, SizeThreshold
from rocking_api.models.params import FREQUENCY_RATIOS, ResponseQuestion

REACH = 10.0
"""Periods from a tenth to ten times that of the pulse, sizes from a hundredth to a hundred times that of the block."""


def margins_of(
    question: BlockQuestion,
    block: Block,
    asked: ResponseQuestion,
    accelerations: list[float],
    seconds: float,
    stop: StopFlag,
) -> Margins | None:
    """Nearest changes of fate; `accelerations` are the amplitudes at which it changes [m/s2].

    None if the periods at which it does were not found in that time [s].
    """
    omega = asked.frequency_ratio
    low, high = max(omega / REACH, FREQUENCY_RATIOS[0]), min(omega * REACH, FREQUENCY_RATIOS[1])
    groups = {"slenderness": asked.slenderness, "restitution": asked.restitution, "alpha": block.alpha}

    def search(part: StopFlag) -> FrequencyThresholds:
        return critical_frequency_ratio(question.pulse, **groups, window=(low, high), stop=part)

    found = run_with_timeout(search, seconds, stop)
    if found is None:
        return None
    changes = list(zip(found.frequency_ratio.tolist(), found.overturns_above.tolist(), strict=True))

    def period(ratio: float) -> float:
        return question.pulse_period * omega / ratio  # omega_g = 2 pi/T_p: longer is lower

    def size(ratio: float) -> float:
        return block.half_diagonal * (ratio / omega) ** 2  # p = sqrt(3 g/(4 R)): larger is higher (2.2)

    periods = [PeriodThreshold(pulse_period=period(w), overturns_above=not above) for w, above in reversed(changes)]
    sizes = [SizeThreshold(half_diagonal=size(w), overturns_above=above) for w, above in changes]
    smallest, largest = size(low), size(high)
    falls_small, falls_large = found.overturns_at_ends
    nearest_acceleration = _nearest(question.peak_acceleration, accelerations)
    nearest_period = _nearest(question.pulse_period, [p.pulse_period for p in periods])
    return Margins(
        nearest_acceleration=nearest_acceleration,
        acceleration_factor=_factor(nearest_acceleration, question.peak_acceleration),
        nearest_period=nearest_period,
        period_factor=_factor(nearest_period, question.pulse_period),
        periods=periods,
        periods_searched=(period(high), period(low)),
        smallest_surviving_half_diagonal=(
            smallest if not falls_small else next((s.half_diagonal for s in sizes if not s.overturns_above), None)
        ),
        surviving_from_half_diagonal=None if falls_large else sizes[-1].half_diagonal if sizes else smallest,
        sizes=sizes,
        sizes_searched=(smallest, largest),
    )


def _nearest(value: float, candidates: list[float]) -> float | None:
    return min(candidates, key=lambda candidate: abs(math.log(candidate / value)), default=None)


def _factor(value: float | None, of: float) -> float | None:
    return None if value is None else value / of
