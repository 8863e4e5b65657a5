"""Two horizontal components of one station: motions along directions between them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from rocking._base.errors import InvalidArgumentError
from rocking._excitation.records.record import Record

PAIR_ANGLES = 12
"""Directions in which the components of a pair are combined, over 180 degrees [-]; even."""


def checked_pair(records: Any) -> tuple[Record, ...]:
    """Return a record, or two with the same step, as a tuple."""
    pair, size = (records,), 1
    if isinstance(records, Sequence):
        pair, size = tuple(records), 2
    if len(pair) != size or not all(isinstance(record, Record) for record in pair):
        raise InvalidArgumentError("records", records, "records, or pairs of two records")
    first, second = pair[0], pair[-1]
    if first.time_step != second.time_step:
        allowed = f"the time step of its first component, {first.time_step:g} s"
        raise InvalidArgumentError("records", f"a pair whose second component has {second.time_step:g} s", allowed)
    return pair


def rotated(first: Record, second: Record) -> list[tuple[str, Record]]:
    """Return the components of a pair along directions every 15 degrees below 180, with the name of the angle."""
    size = max(first.samples, second.samples)
    x = np.pad(first.acceleration, (0, size - first.samples))
    y = np.pad(second.acceleration, (0, size - second.samples))
    vertical = second.vertical if first.vertical is None else first.vertical
    up = None if vertical is None else np.pad(vertical, (0, size - vertical.size))
    remarks = tuple(dict.fromkeys((*first.remarks, *second.remarks)))
    components = []
    for k in range(PAIR_ANGLES):
        angle = math.pi * k / PAIR_ANGLES
        along = math.cos(angle) * x + math.sin(angle) * y
        record = Record(along, first.time_step, "m/s2", first.name, first.source, remarks, up)
        components.append((f", {180 * k // PAIR_ANGLES} deg", record))
    return components
