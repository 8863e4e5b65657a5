"""Slender blocks by exact arcs: all flights of a block of cells in stages over compacted lists.

A cell waits in the list of its next flight: long or short, with negative or positive rotation. `LANES` cells of a list
are followed at a time, and each is put into the list of the flight after that. The arithmetic of a cell depends neither
on its lane nor on the other cells. What no stage decides, possible hidden peaks and very many impacts, is left to the
caller: for `rocking.solver.stages.remainder`, under wavelets for Taylor steps.
"""

from __future__ import annotations

import math

from rocking._numba.cancellation import is_stopped
from rocking._numba.compilation import FloatArray, Record, entry, kernel
from rocking._numba.simd import LANES, any_lane, gather_rows, load, scatter_rows, select, splat, store
from rocking.solver.kernels.event_loop import NO_UPLIFT
from rocking.solver.stages.cuts import cut_phases, init_cuts, init_nodes
from rocking.solver.stages.events import end_flights
from rocking.solver.stages.flight import follow_flights
from rocking.solver.stages.short_flights import follow_short_flights
from rocking.solver.stages.state import (
    AT_UPLIFT,
    BLOCK_SIZE,
    BUCKETS,
    CHATTER,
    ETA,
    FIRST_IMPACT_TIME,
    FIRST_IMPACT_VELOCITY,
    IMPACTS,
    IMPACTS_BEFORE,
    LONG,
    MODE,
    OMEGA,
    PEAK,
    PHASE,
    PIECE,
    REPEATED,
    REST,
    SHORT,
    SLENDERNESS,
    UNDECIDED,
    UPLIFT_TIME,
    UPLIFTS,
    W0,
)

LEFT = -1
"""Outcome of a cell that no stage decides: it is left to the caller."""

LONG_LISTS, SHORT_LISTS, GENERAL_LIST = 0, 2, 4
"""Lists of cells: two for each kind of flight, with negative and positive rotation, and one for the general solver."""


@kernel
def uplift_piece(pulse: Record, slenderness: float, phase: float) -> tuple[int, float]:
    """Piece of the pulse with the first uplift of a block at rest at `phase`, and its sgn(theta), 0 if there is none.

    |f| < 1/a at `phase`, so that |f| reaches 1/a on the first piece with |f| > 1/a at its right end.
    """
    for piece in range(pulse.pieces):
        f = pulse.end_shape[piece + 1]
        if pulse.end_phase[piece + 1] > phase and abs(f) > slenderness:
            return piece, -math.copysign(1.0, f)
    return -1, 0.0


@kernel
def start_uplifts(pulse: Record, group: Record, sign: float) -> None:
    """Set the phase and the time of the uplifts that are given by their piece."""
    pieces = load(group.columns, PIECE)
    if not any_lane(pieces >= 0.0):
        return
    init_cuts(pulse, group)
    phase = load(group.columns, PHASE)
    for piece in range(pulse.pieces):
        here = pieces == float(piece)
        if any_lane(here):
            phase = select(here, cut_phases(pulse, group, piece, sign), phase)
    store(group.columns, PHASE, phase)
    first = (pieces >= 0.0) & (load(group.columns, UPLIFTS) == 1.0)
    time = (phase - pulse.end_phase[0]) / load(group.columns, OMEGA)
    store(group.columns, UPLIFT_TIME, select(first, time, load(group.columns, UPLIFT_TIME)))
    store(group.columns, PIECE, splat(-1.0))


@kernel
def write_empty_response(response: Record) -> None:
    """Write the response of a block without uplift."""
    response.outcome, response.chatter, response.impacts, response.peak_mode = NO_UPLIFT, 0, 0, -1
    response.exceeded_alpha = 0
    response.peak_rotation, response.uplift_time = 0.0, math.nan
    response.first_impact_time, response.first_impact_velocity = math.nan, math.nan
    response.end_rotation, response.end_velocity = 0.0, 0.0


@kernel
def write_lane(group: Record, lane: int, response: Record) -> None:
    """Write the response of the cell of a lane."""
    columns = group.columns
    response.outcome, response.chatter = int(group.outcome[lane]), int(columns[CHATTER, lane])
    response.impacts, response.peak_mode = int(columns[IMPACTS, lane]), int(columns[MODE, lane])
    response.exceeded_alpha = not (columns[PEAK, lane] <= 1.0)  # also where it is nan
    response.peak_rotation, response.uplift_time = columns[PEAK, lane], columns[UPLIFT_TIME, lane]
    response.first_impact_time = columns[FIRST_IMPACT_TIME, lane]
    response.first_impact_velocity = columns[FIRST_IMPACT_VELOCITY, lane]
    response.end_rotation, response.end_velocity = group.free_z[lane], group.free_w[lane]


@kernel
def append(cells: Record, which: int, place: int) -> None:
    """Append a place to a list."""
    cells.lists[which, cells.counts[which]] = place
    cells.counts[which] += 1


@kernel
def start_cells(
    first: int,
    last: int,
    slenderness: FloatArray,
    omega: FloatArray,
    eta: FloatArray,
    pulse: Record,
    cells: Record,
    responses: Record,
) -> bool:
    """Prepare the rows of the cells `first` to `last` - 1 for their first flights; True if some share a flight.

    Consecutive cells that differ in eta only share the first flight, which stands in the row of the first of them.
    """
    rows, members = cells.rows, cells.members
    f_start, shared, cell = pulse.end_shape[0], False, first
    bucket, changes = -1, 0
    empty = rows[BLOCK_SIZE]
    for column in range(LANES):
        empty[column] = 0.0
    empty[SLENDERNESS], empty[OMEGA], empty[PHASE] = 0.5, 1.0, pulse.end_phase[0]
    empty[MODE], empty[UPLIFTS], empty[PIECE] = -1.0, 1.0, -1.0
    empty[FIRST_IMPACT_TIME], empty[FIRST_IMPACT_VELOCITY] = math.nan, math.nan
    new_row = load(rows, BLOCK_SIZE)
    while cell < last:
        s, w = slenderness[cell], omega[cell]
        following = cell + 1
        while following < last and slenderness[following] == s and omega[following] == w:
            following += 1
        piece, sign, at_uplift = -1, -math.copysign(1.0, f_start), 0.0
        if abs(f_start) <= s:
            piece, sign = uplift_piece(pulse, s, pulse.end_phase[0])
            at_uplift = 1.0
        if s >= 1.0 or sign == 0.0:
            for one in range(cell, following):
                write_empty_response(responses[one])
        else:
            place = cell - first
            store(rows, place, new_row)
            row = rows[place]
            row[SLENDERNESS], row[OMEGA], row[ETA], row[AT_UPLIFT], row[PIECE] = s, w, eta[cell], at_uplift, piece
            members[place] = following - cell
            shared = shared or following - cell > 1
            append(cells, LONG_LISTS + (1 if sign > 0.0 else 0), place)
            changes += int(s * BUCKETS) != bucket
            bucket = int(s * BUCKETS)
        cell = following
    if changes * LANES > last - first:
        sort_by_slenderness(LONG_LISTS, cells)
        sort_by_slenderness(LONG_LISTS + 1, cells)
    return shared


@kernel
def sort_by_slenderness(which: int, cells: Record) -> None:
    """Order a list by slenderness, on which the number of flights and of iterations mainly depends.

    Vectors of cells in random order wait for the slowest of their cells.
    """
    rows, places, heads, links, count = cells.rows, cells.lists[which], cells.heads, cells.links, cells.counts[which]
    heads[:] = -1
    for i in range(count):
        place = places[i]
        bucket = int(rows[place, SLENDERNESS] * BUCKETS)
        links[place], heads[bucket] = heads[bucket], place
    i = 0
    for bucket in range(BUCKETS):
        place = heads[bucket]
        while place >= 0:
            places[i] = place
            place = links[place]
            i += 1


@kernel
def distribute(
    which: int,
    pulse: Record,
    group: Record,
    cells: Record,
    responses: Record,
) -> None:
    """Write the responses of finished cells and put the others into the lists of their next flights."""
    waits = False
    same, other = which % 2, 1 - which % 2
    for lane in range(LANES):
        place, following = group.place[lane], int(group.next[lane])
        if place == BLOCK_SIZE:  # an unused lane
            continue
        target = -1
        if following == REST:
            piece, sign = uplift_piece(pulse, group.columns[SLENDERNESS, lane], group.columns[PHASE, lane])
            if sign != 0.0:
                group.columns[W0, lane], group.columns[AT_UPLIFT, lane] = 0.0, 1.0
                group.columns[PIECE, lane] = piece
                group.columns[UPLIFTS, lane] += 1.0
                group.columns[IMPACTS_BEFORE, lane] = group.columns[IMPACTS, lane]
                target = LONG_LISTS + (1 if sign > 0.0 else 0)
        elif following == LONG:
            target = LONG_LISTS + other
        elif following == REPEATED:
            target = LONG_LISTS + same
        elif following == SHORT:
            target = SHORT_LISTS + other
        elif following == UNDECIDED:
            # a flight of the short list that is long after all, or a cell for the general solver
            target = LONG_LISTS + same if which >= SHORT_LISTS and group.ended[lane] < 0.0 else GENERAL_LIST
        if target < 0:
            write_lane(group, lane, responses[place])
        else:
            append(cells, target, place)
            waits = True
    if waits:
        scatter_rows(group.columns, group.place, cells.rows)


@kernel
def take_group(which: int, group: Record, cells: Record) -> None:
    """Take the last cells from a list into the group; unused lanes get an empty row."""
    counts = cells.counts
    count = counts[which]
    start = max(count - LANES, 0)
    counts[which] = start
    places = cells.lists[which][start : start + LANES]
    for lane in range(LANES):
        group.place[lane] = places[lane]
    for lane in range(count - start, LANES):
        group.place[lane] = BLOCK_SIZE
    gather_rows(cells.rows, group.place, group.columns)


@kernel
def share_flights(
    which: int,
    eta: FloatArray,
    pulse: Record,
    group: Record,
    cells: Record,
    responses: Record,
) -> None:
    """End the flights for the other cells that share them; `shared` and `leader` hold the group as it was before."""
    members, most = cells.members, 1
    for lane in range(LANES):
        most = max(most, members[group.leader[lane]])
    for member in range(1, most):
        for k in range(LANES):
            store(group.columns, k, load(group.shared, k))
        for lane in range(LANES):
            leader = group.leader[lane]
            group.place[lane] = BLOCK_SIZE
            if member < members[leader]:
                group.place[lane] = leader + member
                members[leader + member] = 1
                group.columns[ETA, lane] = eta[leader + member]
        end_flights(pulse, group, 1.0 if which % 2 == 1 else -1.0)
        distribute(which, pulse, group, cells, responses)
    for lane in range(LANES):
        members[group.leader[lane]] = 1


@kernel
def follow_group(
    which: int,
    shared: bool,
    eta: FloatArray,
    pulse: Record,
    group: Record,
    cells: Record,
    responses: Record,
) -> None:
    """Follow the next flights of the last cells of a list."""
    sign = 1.0 if which % 2 == 1 else -1.0
    take_group(which, group, cells)
    if which < SHORT_LISTS:
        start_uplifts(pulse, group, sign)
        follow_flights(pulse, group, sign)
    else:
        follow_short_flights(pulse, group, sign)
    if shared:
        for k in range(LANES):
            store(group.shared, k, load(group.columns, k))
            group.leader[k] = group.place[k]
    end_flights(pulse, group, sign)
    distribute(which, pulse, group, cells, responses)
    if shared:
        share_flights(which, eta, pulse, group, cells, responses)


@entry
def solve_by_arcs(
    slenderness: FloatArray,
    omega: FloatArray,
    eta: FloatArray,
    pulse: Record,
    group: Record,
    cells: Record,
    stop: FloatArray,
    responses: Record,
) -> int:
    """Follow slender blocks from rest to their final outcome, under sinusoids or a wavelet.

    Parameters
    ----------
    slenderness, omega, eta : float arrays (cells,)
        1/a > 0, frequency ratio > 0, restitution in [0, 1] [-].
    pulse, group, cells
        Solver state: a record of `pulse_state`, and `stage_state`.
    stop : uint8 array (1,)
        Once another thread sets it to 1, the function returns within a flight; responses are missing.
    responses : array (cells,) of `rocking.solver.state.RESPONSE_RECORD`
        Filled; of cells that no stage decides only the outcome, with `LEFT`, the impacts that were followed, and if
        there are any the times of uplift and of the first impact with its velocity.

    Returns
    -------
    int
        Number of cells that no stage decides.
    """
    init_nodes(pulse, group)
    rows, lists, counts, members = cells.rows, cells.lists, cells.counts, cells.members
    left = 0
    for first in range(0, len(slenderness), BLOCK_SIZE):
        last = min(first + BLOCK_SIZE, len(slenderness))
        block = responses[first:last]
        counts[:] = 0
        members[BLOCK_SIZE] = 1
        shared = start_cells(first, last, slenderness, omega, eta, pulse, cells, responses)
        while not is_stopped(stop):
            fullest = 0
            for which in range(1, GENERAL_LIST):
                if counts[which] > counts[fullest]:
                    fullest = which
            if counts[fullest] == 0:
                break
            follow_group(fullest, shared, eta[first:last], pulse, group, cells, block)
        for i in range(counts[GENERAL_LIST]):
            place = lists[GENERAL_LIST, i]
            row, response = rows[place], block[place]
            response.outcome, response.impacts = LEFT, int(row[IMPACTS])
            response.uplift_time, response.first_impact_time = row[UPLIFT_TIME], row[FIRST_IMPACT_TIME]
            response.first_impact_velocity = row[FIRST_IMPACT_VELOCITY]
        left += counts[GENERAL_LIST]
    return left
