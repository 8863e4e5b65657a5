"""A block under a record in SI units, and its groups."""

from __future__ import annotations

from dataclasses import dataclass

from rocking._base.units import Scalar
from rocking._dimensional.problem import is_momentum, restitution_of
from rocking._dimensional.record_groups import RecordGroups, checked_scale, record_groups
from rocking._excitation.records.record import Record
from rocking._model.block import AbstractBlock
from rocking._model.response import Response
from rocking._numba.cancellation import StopFlag
from rocking._solver.records.record_response import record_response


@dataclass(frozen=True, init=False)
class RecordProblem:
    """A block under a record times a factor, which multiplies both components.

    Parameters
    ----------
    block : AbstractBlock
        The block.
    record : Record
        Ground motion, without the factor.
    scale : float
        Factor of the record [-], (0, 1e6].
    restitution : float or "momentum"
        eta [-], [0, 1]; or that of (2.4), 0 where it is negative.

    Raises
    ------
    InvalidArgumentError
        If a value is out of range, or the vertical acceleration times the factor reaches -g.
    """

    block: AbstractBlock
    record: Record
    scale: float
    restitution: float | str

    def __init__(
        self, block: AbstractBlock, record: Record, scale: Scalar = 1.0, restitution: Scalar = "momentum"
    ) -> None:
        eta = restitution_of(block, restitution)
        checked = {
            "block": block,
            "record": record,
            "scale": checked_scale(scale, record, block),
            "restitution": "momentum" if is_momentum(restitution) else eta,
        }
        for name, value in checked.items():
            object.__setattr__(self, name, value)  # a frozen dataclass

    @property
    def groups(self) -> RecordGroups[float]:
        """The groups under the scaled record."""
        return self._groups_under(self.record)

    def solve(self, motion: Record | None = None, *, stop: StopFlag | None = None) -> Response:
        """The response to the scaled record, or to another motion times the same factor."""
        chosen = self.record if motion is None else motion
        return record_response(chosen, **self._groups_under(chosen), stop=stop)

    def _groups_under(self, motion: Record) -> RecordGroups[float]:
        return record_groups(motion, self.block, self.scale, restitution_of(self.block, self.restitution))
