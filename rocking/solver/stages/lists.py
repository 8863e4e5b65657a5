"""Lists of the cells that wait for a flight, by their places in the block."""

from __future__ import annotations

from rocking._numba.compilation import Record, kernel
from rocking._numba.simd import LANES
from rocking.solver.stages.state import BLOCK_SIZE

FIRST_LISTS, LONG_LISTS, SHORT_LISTS, GENERAL_LIST = 0, 2, 4, 6
"""Lists of cells: two for each kind of flight, with negative and positive rotation, and one for the general solver.
Cells in the first two are at rest at the start of the pulse, and have no row yet."""


@kernel
def append(cells: Record, which: int, place: int) -> None:
    """Append a place to a list."""
    cells.lists[which, cells.counts[which]] = place
    cells.counts[which] += 1


@kernel
def take_places(which: int, group: Record, cells: Record) -> None:
    """Take the last places of a list into the group; an unused lane has the place BLOCK_SIZE, and the first source."""
    counts = cells.counts
    count = counts[which]
    start = max(count - LANES, 0)
    counts[which] = start
    places = cells.lists[which][start : start + LANES]
    for lane in range(LANES):
        group.place[lane] = places[lane]
        group.source[lane] = places[lane]
    for lane in range(count - start, LANES):
        group.place[lane] = BLOCK_SIZE
        group.source[lane] = places[0]
