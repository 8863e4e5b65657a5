"""The mildest intensity at which each record of a suite overturns each block, found between the levels."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from rocking._boundary.scan import SCAN_RATIO, lowest_overturning, scanned
from rocking._dimensional.problem import record_groups, uplift_scale
from rocking._excitation.records.record import Record
from rocking._numba.cancellation import StopFlag
from rocking._solver.records.record_response import record_response
from rocking.suites.outcomes import Array, Suite


def with_margins(
    outcomes: xr.Dataset, suite: Suite, *, threads: int | None = None, stop: StopFlag | None = None
) -> xr.Dataset:
    """Outcomes with the mildest intensity at which each record overturns each block.

    From uplift on, or from the mildest level if the measure is a size of the block, intensities that differ by 0.2 %
    are solved up to the first level at which the block overturns, or to the last one. A narrower range is missed unless
    a level lies in it.

    Parameters
    ----------
    outcomes : xarray.Dataset
        Result of `rocking.suites.outcomes.suite_outcomes` for this suite.
    suite : Suite
        Checked arguments.
    threads, stop
        As for `rocking.fragility`.

    Returns
    -------
    xarray.Dataset
        The outcomes, and `overturning_intensity` (block, record) in the unit of the measure, nan where it survives all.
    """
    overturned = outcomes["overturned"].transpose("block", "intensity", "record").values.astype(bool)
    found = np.array(
        [
            [_mildest(suite, k, record, overturned[k, :, n], threads, stop) for n, record in enumerate(suite.records)]
            for k in range(len(suite.blocks))
        ]
    )
    about = {
        "units": suite.measure.unit,
        "long_name": "mildest intensity at which the record overturns the block",
        "comment": f"narrower ranges of intensities than {100.0 * (SCAN_RATIO - 1.0):.1g} % can be missed",
    }
    return outcomes.assign(overturning_intensity=(("block", "record"), found, about))


def _mildest(
    suite: Suite, number: int, record: Record, overturned: NDArray[np.bool_], threads: int | None, stop: StopFlag | None
) -> float:
    """The mildest intensity at which a record overturns the block of that number, which does so at `overturned` levels.

    Severity is the factor of the record, or that of the frequency parameter p of the block.
    """
    block, scales = suite.blocks[number], suite.measure.scales_amplitude
    own = suite.measure.of(record, block)
    eta = float(suite.restitution[number])

    def overturns(severity: Array) -> NDArray[np.bool_]:
        groups: dict[str, Any] = {**record_groups(record, block, severity if scales else np.ones(1), eta)}
        if not scales:
            groups["frequency_parameter"] = block.frequency_parameter * severity
        return record_response(record, **groups, threads=threads, stop=stop).overturned

    severities = suite.levels / own if scales else (own / suite.levels)[::-1]
    in_order = overturned if scales else overturned[::-1]
    last = float(severities[in_order.argmax() if in_order.any() else -1])
    found = lowest_overturning(
        overturns, scanned(uplift_scale(record, block) if scales else float(severities[0]), last)
    )
    if in_order.any() and np.isnan(found):  # the level lies within a rounding of a change of outcome
        found = last
    return own * found if scales else own / found
