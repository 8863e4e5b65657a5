"""Lists of the cells that wait for a flight, by their places in the block, and the vectors of their first flights."""

import math
from typing import Any

from rocking._numba.compilation import FloatArray, Record, kernel
from rocking._numba.simd import LANES, gather, lane_bits, select, splat, store
from rocking._solver.stages import columns as column
from rocking._solver.stages.cuts import first_uplift_pieces, uplift_piece
from rocking._solver.stages.state import BLOCK_SIZE, BUCKETS
from rocking._solver.state import set_empty_response

FIRST_LISTS, LONG_LISTS, SHORT_LISTS, GENERAL_LIST = 0, 2, 4, 6
"""Lists of cells: two for each kind of flight, with negative and positive rotation, and one for the event loop.
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
    # every lane writes its place at the end; the end moves on only for those that are chosen
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


@kernel
def start_cells(slenderness: FloatArray, omega: FloatArray, pulse: Record, cells: Record, responses: Record) -> bool:
    """Put the cells of a block into the lists of first flights; True if some share a flight.

    Consecutive cells that differ in eta only share the first flight: the first of them stands for all.
    """
    members = cells.members
    f_start, shared, place, count = pulse.end_shape[0], False, 0, len(slenderness)
    while place < count:
        s, w = slenderness[place], omega[place]
        following = place + 1
        while following < count and slenderness[following] == s and omega[following] == w:
            following += 1
        sign = -math.copysign(1.0, f_start)
        if abs(f_start) <= s:  # no uplift by a jump at the start of the pulse
            _, sign = uplift_piece(pulse, s, pulse.end_phase[0])
        if s >= 1.0 or sign == 0.0:
            for one in range(place, following):
                set_empty_response(responses[one])
        else:
            members[place] = following - place
            shared = shared or following - place > 1
            append(cells, FIRST_LISTS + (1 if sign > 0.0 else 0), place)
        place = following
    for which in range(FIRST_LISTS, FIRST_LISTS + 2):
        sort_by_slenderness(which, slenderness, cells)
    return shared


@kernel
def sort_by_slenderness(which: int, slenderness: FloatArray, cells: Record) -> None:
    """Order a list by slenderness: the numbers of flights and of iterations mainly depend on it.

    Vectors of cells in random order wait for the slowest of their cells. A list remains as it is if most of its vectors
    hold cells of about the same slenderness.
    """
    places, ends, ordered, count = cells.lists[which], cells.ends, cells.ordered, cells.counts[which]
    # vectors whose cells differ by more than a class
    varied = 0
    for first in range(0, count - LANES + 1, LANES):
        change = slenderness[places[first + LANES - 1]] - slenderness[places[first]]
        varied += abs(change) * BUCKETS > 1.0
    if 2 * varied * LANES <= count:
        return
    # counting sort by classes of slenderness: the cells of a class, where each class starts, and the places in order
    ends[:] = 0
    for i in range(count):
        ends[int(slenderness[places[i]] * BUCKETS)] += 1
    total = 0
    for bucket in range(BUCKETS):
        size = ends[bucket]
        ends[bucket] = total
        total += size
    for i in range(count):
        bucket = int(slenderness[places[i]] * BUCKETS)
        ordered[ends[bucket]] = places[i]
        ends[bucket] += 1
    for i in range(count):
        places[i] = ordered[i]


@kernel
def take_resting_cells(
    which: int, slenderness: FloatArray, omega: FloatArray, eta: FloatArray, pulse: Record, group: Record, cells: Record
) -> None:
    """Take the last cells from a list of first flights into the group; unused lanes get one of them."""
    columns = group.columns
    take_places(which, group, cells)
    for k in range(LANES):
        store(columns, k, splat(0.0))
    s = gather(slenderness, group.source)
    piece = first_uplift_pieces(pulse, s)
    store(columns, column.SLENDERNESS, s)
    store(columns, column.OMEGA, gather(omega, group.source))
    store(columns, column.ETA, gather(eta, group.source))
    store(columns, column.PIECE, piece)
    store(columns, column.AT_UPLIFT, select(piece >= 0.0, splat(1.0), splat(0.0)))
    store(columns, column.PHASE, splat(pulse.end_phase[0]))
    store(columns, column.MODE, splat(-1.0))
    store(columns, column.UPLIFTS, splat(1.0))
    store(columns, column.FIRST_TIME, splat(math.nan))
    store(columns, column.FIRST_VELOCITY, splat(math.nan))
