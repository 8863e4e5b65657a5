"""Scales of a record at which the outcome for a block changes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rocking._base.equality import EqualByValue
from rocking._base.errors import number
from rocking._base.units import Scalar
from rocking._boundary.scan import lowest_overturning, outcome_changes, scanned
from rocking._dimensional.problem import restitution_of
from rocking._dimensional.record_groups import HIGHEST_SCALE, record_groups, search_range
from rocking._dimensional.threshold import Threshold, threshold_text
from rocking._excitation.records.record import Record
from rocking._model.block import AbstractBlock
from rocking._numba.cancellation import StopFlag
from rocking._solver.records.record_response import record_response

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class ScaleThresholds(EqualByValue):
    """Scales at which the outcome changes, ascending; arrays (thresholds,).

    Attributes
    ----------
    scale : float array [-]
        Factor of the record; the block overturns at it, and survives within a relative 1e-6 of it.
    overturns_above : bool array
        True where the block overturns just above and survives just below.
    searched : (float, float)
        Lowest and highest scale searched [-].
    ends_in_flight : bool
        Whether the search ended at the scale at which the vertical acceleration reaches -g.
    """

    scale: Array
    overturns_above: NDArray[np.bool_]
    searched: tuple[float, float]
    ends_in_flight: bool = False

    @property
    def changes(self) -> tuple[Threshold, ...]:
        """The same, one for each."""
        return tuple(map(Threshold, self.scale.tolist(), self.overturns_above.tolist()))

    @property
    def sentence(self) -> str:
        """From which factor of the record the block overturns, and how often the outcome changes above it, in words."""
        top = threshold_text(self.searched[1])
        end = f"; from {top} times on its vertical acceleration reaches -g" if self.ends_in_flight else ""
        if not self.scale.size:
            return f"no factor of the record up to {top} was found to overturn it{end}"
        first, *others = self.changes
        more = f"; above that the outcome changes {len(others)} more times up to {top} times" if others else ""
        return f"it overturns from {first.text()} times the record{more}{end}"


def scale_thresholds(
    record: Record,
    block: AbstractBlock,
    *,
    restitution: Scalar = "momentum",
    highest: Scalar | None = None,
    stop: StopFlag | None = None,
) -> ScaleThresholds:
    """Every scale of a record at which the outcome for a block changes, by (2.2).

    Scales that differ by 0.2 % are solved from that of uplift on, and each pair between which the outcome changes is
    bisected. A range of one outcome that is narrower can be missed. Both components of the record are scaled; the
    search ends below the scale at which the vertical acceleration reaches -g.

    Parameters
    ----------
    record : Record
        Ground motion.
    block : Block
        Block.
    restitution : "momentum" or float
        (2.4), or eta [-], [0, 1].
    highest : float, optional
        Highest scale searched [-], (0, 1e6]; by default ten times that of uplift.
    stop : StopFlag, optional
        Cancels the work, which then raises `StoppedError`.

    Raises
    ------
    InvalidArgumentError
        For an argument out of range.
    """
    uplift, top, flies = search_range(record, block, _checked_highest(highest))
    if top <= uplift:
        return ScaleThresholds(np.empty(0), np.empty(0, dtype=np.bool_), (uplift, uplift), flies)
    overturns = _solver(record, block, restitution_of(block, restitution), stop)
    return ScaleThresholds(*outcome_changes(overturns, scanned(uplift, top)), (uplift, top), flies)


def overturning_scale(
    record: Record,
    block: AbstractBlock,
    *,
    restitution: Scalar = "momentum",
    highest: Scalar | None = None,
    stop: StopFlag | None = None,
) -> float:
    """Lowest scale of a record at which it overturns a block [-]; nan if there is none.

    The first of `scale_thresholds`, which has the same arguments, in less time.
    """
    uplift, top, _ = search_range(record, block, _checked_highest(highest))
    return lowest_overturning(_solver(record, block, restitution_of(block, restitution), stop), scanned(uplift, top))


def _checked_highest(highest: Scalar | None) -> float | None:
    return None if highest is None else number("highest", highest, 0.0, HIGHEST_SCALE, closed="right")


def _solver(
    record: Record, block: AbstractBlock, eta: float, stop: StopFlag | None
) -> Callable[[Array], NDArray[np.bool_]]:
    """Whether the block overturns, as a function of the scales."""

    def overturns(scales: Array) -> NDArray[np.bool_]:
        return record_response(record, **record_groups(record, block, scales, eta), stop=stop).overturned

    return overturns
