"""Slender blocks by exact arcs: all flights of a block of cells in stages over compacted lists.

A cell waits in the list of its next flight: first, long or short, with negative or positive rotation. `LANES` cells
of a list are followed at a time, and each is put into the list of the flight after that. The arithmetic of a cell
depends neither on its lane nor on the other cells. What no stage decides, a search that rounding keeps from its end and
very many impacts, is left to the caller, for Taylor steps: most calls leave no block.
"""

from rocking._numba.cancellation import is_stopped
from rocking._numba.compilation import FloatArray, Record, kernel, light_entry
from rocking._numba.simd import LANES, any_lane, gather_rows, lane_bits, load, scatter_rows, select, splat, store
from rocking._solver.stages import columns as column
from rocking._solver.stages.cuts import init_nodes, start_uplifts, uplift_piece
from rocking._solver.stages.events import end_flights, write_responses
from rocking._solver.stages.flight import follow_flights
from rocking._solver.stages.lists import (
    GENERAL_LIST,
    LONG_LISTS,
    SHORT_LISTS,
    append_where,
    start_cells,
    take_places,
    take_resting_cells,
)
from rocking._solver.stages.short_flights import follow_short_flights
from rocking._solver.stages.state import BLOCK_SIZE, FINISHED, LONG, REPEATED, REST, SHORT, UNDECIDED

LEFT = -1  # outcome of a cell that no stage decides: it is left to the caller


@kernel
def leave_rest(which: int, pulse: Record, group: Record) -> None:
    """Decide whether blocks at rest uplift again."""
    columns = group.columns
    for lane in range(LANES):
        if group.next[lane] != float(REST):
            continue
        # a block at rest waits for |f| = 1/a, on this piece of the pulse or on a later one
        piece, sign = uplift_piece(pulse, columns[column.SLENDERNESS, lane], columns[column.PHASE, lane])
        if sign == 0.0:
            group.next[lane] = float(FINISHED)
            continue
        columns[column.W0, lane], columns[column.AT_UPLIFT, lane], columns[column.PIECE, lane] = 0.0, 1.0, piece
        columns[column.UPLIFTS, lane] += 1.0
        columns[column.IMPACTS_BEFORE, lane] = columns[column.IMPACTS, lane]
        # a list holds one sign of rotation: the cell joins the same list again, or the list of the other sign
        group.next[lane] = float(REPEATED if (sign > 0.0) == (which % 2 == 1) else LONG)


@kernel
def distribute(which: int, pulse: Record, group: Record, cells: Record, responses: Record) -> None:
    """Write the responses of finished cells and put the others into the lists of their next flights."""
    same, other, used = which % 2, 1 - which % 2, group.used
    if any_lane(load(group.next, 0) == float(REST)):
        leave_rest(which, pulse, group)
    following = load(group.next, 0)
    if which >= SHORT_LISTS:
        # not a flight of the short list, but a long one after all
        long_after_all = (following == float(UNDECIDED)) & (load(group.ended, 0) < 0.0)
        following = select(long_after_all, splat(float(REPEATED)), following)
    done = lane_bits(following == float(FINISHED)) & used
    if done:
        write_responses(group, done, responses)
    if done == used:
        return
    append_where(following == float(LONG), LONG_LISTS + other, group, cells)
    append_where(following == float(SHORT), SHORT_LISTS + other, group, cells)
    append_where(following == float(REPEATED), LONG_LISTS + same, group, cells)
    append_where(following == float(UNDECIDED), GENERAL_LIST, group, cells)
    scatter_rows(group.columns, group.place, cells.rows)


@kernel
def share_flights(which: int, eta: FloatArray, pulse: Record, group: Record, cells: Record, responses: Record) -> None:
    """End the flights for the other cells that share them; `shared` and `leader` hold the group as it was before."""
    # the flight is the same for all eta; only its end, at the impact, differs
    members, most = cells.members, 1
    for lane in range(LANES):
        most = max(most, members[group.leader[lane]])
    for member in range(1, most):
        for k in range(LANES):
            store(group.columns, k, load(group.shared, k))
        group.used = 0
        for lane in range(LANES):
            leader = group.leader[lane]
            group.place[lane] = BLOCK_SIZE
            if member < members[leader]:
                group.place[lane] = leader + member
                group.used |= 1 << lane
                group.columns[column.ETA, lane] = eta[leader + member]
        end_flights(pulse, group, 1.0 if which % 2 == 1 else -1.0)
        distribute(which, pulse, group, cells, responses)


@kernel
def follow_group(
    which: int,
    shared: bool,
    slenderness: FloatArray,
    omega: FloatArray,
    eta: FloatArray,
    pulse: Record,
    group: Record,
    cells: Record,
    responses: Record,
) -> None:
    """Follow the next flights of the last cells of a list."""
    sign = 1.0 if which % 2 == 1 else -1.0
    if which < LONG_LISTS:
        take_resting_cells(which, slenderness, omega, eta, pulse, group, cells)
    else:
        take_places(which, group, cells)
        gather_rows(cells.rows, group.place, group.columns)
    if which < SHORT_LISTS:
        start_uplifts(pulse, group, sign)
        follow_flights(pulse, group, sign)
    else:
        follow_short_flights(pulse, group, sign)
    if shared and which < LONG_LISTS:
        for k in range(LANES):
            store(group.shared, k, load(group.columns, k))
            group.leader[k] = group.place[k]
    end_flights(pulse, group, sign)
    distribute(which, pulse, group, cells, responses)
    if shared and which < LONG_LISTS:
        share_flights(which, eta, pulse, group, cells, responses)


@light_entry
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
    """Follow slender blocks from rest to their final outcome; returns the number of cells that no stage decides.

    `slenderness`, `omega`, `eta` (cells,): 1/a > 0, frequency ratio > 0, restitution in [0, 1] [-]. `pulse`, `group`,
    `cells`: solver state, a record of `pulse_state`, and `stage_state`. `stop` (1,): once another thread sets it to 1,
    the function returns within a flight; responses are missing. `responses` (cells,), `RESPONSE_RECORD`, are filled: of
    a cell that no stage decides only the outcome, `LEFT`, the impacts that were followed, and if there are any the
    times of uplift and of the first impact with its velocity.
    """
    init_nodes(pulse, group)
    rows, lists, counts = cells.rows, cells.lists, cells.counts
    unused = rows[BLOCK_SIZE]
    unused[column.SLENDERNESS], unused[column.OMEGA], unused[column.PIECE] = 0.5, 1.0, -1.0
    cells.members[BLOCK_SIZE] = 1
    left = 0
    for first in range(0, len(slenderness), BLOCK_SIZE):
        last = min(first + BLOCK_SIZE, len(slenderness))
        block_s, block_w, block_eta = slenderness[first:last], omega[first:last], eta[first:last]
        block = responses[first:last]
        counts[:] = 0
        shared = start_cells(block_s, block_w, pulse, cells, block)
        # the fullest list first: vectors are full as long as possible
        while not is_stopped(stop):
            fullest = 0
            for which in range(1, GENERAL_LIST):
                if counts[which] > counts[fullest]:
                    fullest = which
            if counts[fullest] == 0:
                break
            follow_group(fullest, shared, block_s, block_w, block_eta, pulse, group, cells, block)
        for i in range(counts[GENERAL_LIST]):
            place = lists[GENERAL_LIST, i]
            row, response = rows[place], block[place]
            response.outcome, response.impacts = LEFT, int(row[column.IMPACTS])
            response.uplift_time, response.first_impact_time = row[column.UPLIFT_TIME], row[column.FIRST_TIME]
            response.first_impact_velocity = row[column.FIRST_VELOCITY]
        left += counts[GENERAL_LIST]
    return left
