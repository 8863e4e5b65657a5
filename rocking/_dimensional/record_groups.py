"""The groups of blocks under a record times a factor: both components have the same factor."""

from __future__ import annotations

from typing import Generic, TypedDict, TypeVar

import numpy as np
from numpy.typing import NDArray

from rocking._base.constants import STANDARD_GRAVITY
from rocking._base.errors import number
from rocking._base.units import Scalar
from rocking._excitation.records.record import Record
from rocking._excitation.records.vertical import highest_vertical_scale, reject_flight
from rocking._model.block import AbstractBlock

HIGHEST_SCALE = 1e6
"""Largest factor of a record [-]."""

Factor = TypeVar("Factor", float, NDArray[np.float64])


class RecordGroups(TypedDict, Generic[Factor]):
    """Keyword arguments of `record_response`."""

    frequency_parameter: float
    slenderness: Factor
    restitution: float
    alpha: float
    vertical_scale: Factor | None


def record_groups(record: Record, block: AbstractBlock, scale: Factor, restitution: float) -> RecordGroups[Factor]:
    """The groups of a block with the restitution eta under a record times `scale`, > 0."""
    return {
        "frequency_parameter": block.frequency_parameter,
        "slenderness": block.uplift_acceleration / (scale * record.peak_acceleration),
        "restitution": restitution,
        "alpha": block.equation_alpha,
        # w is over the standard gravity there
        "vertical_scale": None if record.vertical is None else STANDARD_GRAVITY / block.gravity * scale,
    }


def checked_scale(scale: Scalar, record: Record, block: AbstractBlock) -> float:
    """The factor of a record [-].

    Raises
    ------
    InvalidArgumentError
        If it is not one number in (0, 1e6], or so large that the vertical acceleration reaches -g.
    """
    factor = number("scale", scale, 0.0, HIGHEST_SCALE, closed="right")
    reject_flight("scale", record, factor, block.gravity)
    return factor


def uplift_scale(record: Record, block: AbstractBlock) -> float:
    """Smallest factor of a record at which a block uplifts [-]; 1e6 where the vertical component prevents it longer.

    Uplift is where |a|/(g tan alpha) reaches 1 + w/g: at a sample, since both are linear between samples.
    """
    if record.vertical is None:
        return block.uplift_acceleration / record.peak_acceleration
    excess = np.abs(record.acceleration) / block.uplift_acceleration - record.vertical / block.gravity
    largest = float(excess.max())
    return 1.0 / max(largest, 1.0 / HIGHEST_SCALE)


def search_range(record: Record, block: AbstractBlock, highest: float | None) -> tuple[float, float, bool]:
    """Factors of a record among which its outcomes are searched.

    Returns
    -------
    (float, float, bool)
        That of uplift; the highest, by default ten times that of uplift; and whether the latter is that at which the
        vertical acceleration reaches -g.
    """
    lowest = uplift_scale(record, block)
    top = min(10.0 * lowest, HIGHEST_SCALE) if highest is None else highest
    limit = highest_vertical_scale(record, block.gravity)
    return lowest, min(top, limit), limit < top
