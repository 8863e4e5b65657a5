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


def checked_pair(given: Any) -> tuple[Record, ...]:
    """One record, or two with one step."""
    pair, size = (given,), 1
    if isinstance(given, Sequence):
        pair, size = tuple(given), 2
    if len(pair) != size or not all(isinstance(record, Record) for record in pair):
        raise InvalidArgumentError("records", given, "records, or pairs of two records")
    first, second = pair[0], pair[-1]
    if first.time_step != second.time_step:
        allowed = f"the time step of its first component, {first.time_step:g} s"
        raise InvalidArgumentError("records", f"a pair whose second component has {second.time_step:g} s", allowed)
    return pair


def rotated(first: Record, second: Record) -> list[tuple[str, Record]]:
    """Components of a pair along directions every 15 degrees below 180, with the name of the angle."""
    size = max(first.samples, second.samples)
    x, y = (np.pad(one.acceleration, (0, size - one.samples)) for one in (first, second))
    vertical = next((one.vertical for one in (first, second) if one.vertical is not None), None)
    up = None if vertical is None else np.pad(vertical, (0, size - vertical.size))
    remarks = tuple(dict.fromkeys((*first.remarks, *second.remarks)))
    found = []
    for k in range(PAIR_ANGLES):
        angle = math.pi * k / PAIR_ANGLES
        along = math.cos(angle) * x + math.sin(angle) * y
        record = Record(along, first.time_step, "m/s2", first.name, first.source, remarks, up)
        found.append((f", {180 * k // PAIR_ANGLES} deg", record))
    return found
