"""Lists of the cells that wait for a flight, by their places in the block."""

from __future__ import annotations

from typing import Any

from rocking._numba.compilation import Record, kernel
from rocking._numba.simd import LANES, lane_bits
from rocking._solver.stages.state import BLOCK_SIZE

FIRST_LISTS, LONG_LISTS, SHORT_LISTS, GENERAL_LIST = 0, 2, 4, 6
"""Lists of cells: two for each kind of flight, with negative and positive rotation, and one for the general solver.
Cells in the first two are at rest at the start of the pulse, and have no row yet."""


@kernel
def append(cells: Record, which: int, place: int) -> None:
    """Append a place to a list."""
    cells.lists[which, cells.counts[which]] = place
    cells.counts[which] += 1


@kernel
def append_where(mask: Any, which: int, group: Record, cells: Record) -> None:
    """Append the places of the lanes of a mask that hold a cell, without a jump that depends on the lanes."""
    chosen = lane_bits(mask) & group.used
    if not chosen:
        return
    places, end = cells.lists[which], cells.counts[which]
    for lane in range(LANES):
        places[end] = group.place[lane]
        end += (chosen >> lane) & 1
    cells.counts[which] = end


@kernel
def take_places(which: int, group: Record, cells: Record) -> None:
    """Take the last places of a list into the group; an unused lane has the place BLOCK_SIZE, and the first source."""
    counts = cells.counts
    count = counts[which]
    start = max(count - LANES, 0)
    counts[which] = start
    group.used = (1 << (count - start)) - 1
    places = cells.lists[which][start : start + LANES]
    for lane in range(LANES):
        group.place[lane] = places[lane]
        group.source[lane] = places[lane]
    for lane in range(count - start, LANES):
        group.place[lane] = BLOCK_SIZE
        group.source[lane] = places[0]
