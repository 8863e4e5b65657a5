"""Distance of a block in metres from another outcome: in amplitude, period and size."""

from __future__ import annotations

import math

from rocking._numba.cancellation import StopFlag, run_with_timeout
from rocking.boundary.frequency import FrequencyThresholds, critical_frequency_ratio
from rocking.model.block import Block
from rocking_api.models.blocks import BlockParams, Margins, PeriodThreshold, SizeThreshold
from rocking_api.models.params import FREQUENCY_RATIO, ResponseParams

SEARCH_FACTOR = 10.0
"""Ratio of the largest period searched to that of the pulse, and its inverse [-]; sizes go with its square."""


def margins_of(
    params: BlockParams,
    block: Block,
    dimensionless: ResponseParams,
    accelerations: list[float],
    seconds: float,
    stop: StopFlag,
) -> Margins | None:
    """Nearest changes of outcome; `accelerations` are the amplitudes at which it changes [m/s2].

    None if the search over periods exceeds the time `seconds` [s].
    """
    omega = dimensionless.frequency_ratio
    low, high = (
        max(omega / SEARCH_FACTOR, FREQUENCY_RATIO.lower),
        min(omega * SEARCH_FACTOR, FREQUENCY_RATIO.upper),
    )
    groups = {"slenderness": dimensionless.slenderness, "restitution": dimensionless.restitution, "alpha": block.alpha}

    def search(part: StopFlag) -> FrequencyThresholds:
        return critical_frequency_ratio(params.pulse, **groups, window=(low, high), stop=part)

    found = run_with_timeout(search, seconds, stop)
    if found is None:
        return None
    changes = list(zip(found.frequency_ratio.tolist(), found.overturns_above.tolist(), strict=True))

    def period(ratio: float) -> float:
        return params.pulse_period * omega / ratio  # omega_g = 2 pi/T_p: longer is lower

    def size(ratio: float) -> float:
        return block.half_diagonal * (ratio / omega) ** 2  # p = sqrt(3 g/(4 R)): larger is higher (2.2)

    periods = [PeriodThreshold(pulse_period=period(w), overturns_above=not above) for w, above in reversed(changes)]
    sizes = [SizeThreshold(half_diagonal=size(w), overturns_above=above) for w, above in changes]
    smallest, largest = size(low), size(high)
    overturns_small, overturns_large = found.overturns_at_ends
    nearest_acceleration = _nearest(params.peak_acceleration, accelerations)
    nearest_period = _nearest(params.pulse_period, [p.pulse_period for p in periods])
    return Margins(
        nearest_acceleration=nearest_acceleration,
        acceleration_factor=_factor(nearest_acceleration, params.peak_acceleration),
        nearest_period=nearest_period,
        period_factor=_factor(nearest_period, params.pulse_period),
        periods=periods,
        periods_searched=(period(high), period(low)),
        smallest_surviving_half_diagonal=(
            smallest if not overturns_small else next((s.half_diagonal for s in sizes if not s.overturns_above), None)
        ),
        surviving_from_half_diagonal=None if overturns_large else sizes[-1].half_diagonal if sizes else smallest,
        sizes=sizes,
        sizes_searched=(smallest, largest),
    )


def _nearest(value: float, candidates: list[float]) -> float | None:
    return min(candidates, key=lambda candidate: abs(math.log(candidate / value)), default=None)


def _factor(value: float | None, of: float) -> float | None:
    return None if value is None else value / of
