"""The mildest intensity at which each record of a suite overturns each block, found between the levels."""

import numpy as np
import xarray as xr

from rocking._base.arrays import Flags
from rocking._base.quantities import HIGHEST_SCALE
from rocking._boundary.scan import RESOLUTION, lowest_overturning
from rocking._dimensional.problem import uplift_scale
from rocking._dimensional.thresholds import block_lines
from rocking._excitation.records.record import Record
from rocking._excitation.records.vertical import highest_vertical_scale
from rocking._numba.cancellation import StopFlag
from rocking.suites.outcomes import Suite


def with_margins(
    outcomes: xr.Dataset, suite: Suite, *, threads: int | None = None, stop: StopFlag | None = None
) -> xr.Dataset:
    """Add `overturning_intensity` (block, record) to `suite_outcomes`, nan where the block survives all levels.

    The mildest intensity at which each record overturns each block, in the unit of the measure. From uplift on, or from
    the mildest level if the measure is a size of the block, intensities are searched up to the first level at which the
    block overturns, or to the last one, by `rocking._boundary.scan.lowest_overturning`. A range narrower than its
    resolution can be missed unless a level lies in it.
    """
    overturned = outcomes["overturned"].transpose("block", "intensity", "record").values.astype(bool)
    mildest = np.empty((len(suite.blocks), len(suite.records)))
    for k, n in np.ndindex(mildest.shape):
        mildest[k, n] = _mildest(suite, k, suite.records[n], overturned[k, :, n], threads, stop)
    attributes = {
        "units": suite.measure.unit,
        "long_name": "mildest intensity at which the record overturns the block",
        "comment": f"of intensities at most {100.0 * RESOLUTION:g} % apart",
    }
    return outcomes.assign(overturning_intensity=(("block", "record"), mildest, attributes))


def _mildest(
    suite: Suite, number: int, record: Record, overturned: Flags, threads: int | None, stop: StopFlag | None
) -> float:
    """Search the mildest intensity at which a record overturns the block of that number, as at `overturned` levels.

    Severity is the factor of the record, or that of the frequency parameter p of the block.
    """
    block, scales = suite.blocks[number], suite.measure.scales_amplitude
    intensity = suite.measure.of(record, block)
    eta = float(suite.restitution[number])
    lines = block_lines(record, block, eta, scales_size=not scales, threads=threads, stop=stop)
    if scales:
        severities = suite.levels / intensity
        lowest = uplift_scale(record, block)
        limit = min(highest_vertical_scale(record, block.gravity), HIGHEST_SCALE)
    else:
        severities, overturned = (intensity / suite.levels)[::-1], overturned[::-1]
        lowest = float(severities[0])
    last = float(severities[overturned.argmax() if overturned.any() else -1])
    if not scales:
        limit = last
    severity = float(lowest_overturning(lines, np.array([lowest]), last, limit)[0])
    if overturned.any() and np.isnan(severity):  # the level lies within a rounding of a change of outcome
        severity = last
    return intensity * severity if scales else intensity / severity
