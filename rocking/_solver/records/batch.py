"""Many bodies under samples: slender blocks by exact arcs one after another, others by Taylor steps, `LANES` at a time.

A SIMD lane takes the next block as soon as its block is finished.
"""

from rocking._base.errors import SearchError
from rocking._numba.cancellation import is_stopped
from rocking._numba.compilation import FloatArray, Record, entry, kernel
from rocking._numba.simd import LANES
from rocking._solver.records.arc_flight import flight_by_arcs
from rocking._solver.records.event_loop import init_body_state, on_impact, start_flight
from rocking._solver.records.taylor_flight import process_step, start_steps
from rocking._solver.records.taylor_step import take_step
from rocking._solver.rules import final_outcome, update_peak, write_edges, write_response
from rocking._solver.state import IMPACT, IN_FLIGHT, OVERTURNS
from rocking._solver.taylor.flight import MAX_STEPS


@kernel
def end_flight(block: Record, samples: FloatArray, ended: int, k: int, s: float, z: float, w: float) -> bool:
    """End a flight in the interval `k` at time `s` with z and w; False if it was the last."""
    update_peak(block, block.side, block.largest_z, block.impacts, 0)
    if ended != IMPACT:
        final_outcome(block, z, w, ended == OVERTURNS)
        return False
    on_impact(block, samples, k, s, w)
    return True


@entry
def solve_slender(samples: FloatArray, cells: Record, block: Record, stop: FloatArray, responses: Record) -> int:
    """Solve slender blocks without vertical motion; returns the number of sample intervals followed.

    `samples` are `sample_rows`, `cells` (cells,) blocks with equal edges and alpha = 0, `block` is a record
    `BLOCK_STATE`. Once another thread sets `stop` (1,) to 1, the function returns within a flight, and responses are
    missing.
    """
    stepped = 0
    for cell in range(len(cells)):
        if is_stopped(stop):
            break
        init_body_state(block, cells[cell], False)
        while start_flight(block, samples) and not is_stopped(stop):
            ended, k, s, z, w = flight_by_arcs(block, samples)
            if not end_flight(block, samples, ended, k, s, z, w):
                break
        write_response(block, responses[cell])
        stepped += block.stepped
    return stepped


@kernel
def next_cell(
    block: Record,
    samples: FloatArray,
    steps: Record,
    lane: int,
    following: int,
    cells: Record,
    responses: Record,
    edges: FloatArray,
) -> int:
    """Put the next body that uplifts into a lane; returns the cell after it."""
    while following < len(cells):
        cell = following
        following += 1
        init_body_state(block, cells[cell], len(edges) > 0)
        if start_flight(block, samples):
            block.cell = cell
            start_steps(block, samples, steps, lane)
            return following
        write_response(block, responses[cell])
        write_edges(block, edges, cell)
    block.cell = -1
    # no cell is left: the lane goes on with a block at rest, which makes no infinities
    steps.z0[lane], steps.w0[lane], steps.force[lane], steps.force_rate[lane] = 0.0, 0.0, -1.0, 0.0
    steps.vertical[lane], steps.vertical_rate[lane], steps.limit[lane] = 1.0, 0.0, 1.0
    return following


@entry
def solve_by_steps(
    samples: FloatArray,
    cells: Record,
    blocks: Record,
    steps: Record,
    stop: FloatArray,
    responses: Record,
    edges: FloatArray,
) -> int:
    """Solve bodies by Taylor steps, under any motion; returns the number of sample intervals followed.

    As `solve_slender`, with solver state for each lane: `blocks` (LANES,), and `steps` of `step_state`. `edges` (cells,
    EDGE_COLUMNS) is filled, see `rocking._solver.state.EDGE_COLUMNS`; without rows where it is not wanted, for equal
    edges.
    """
    following, busy, stepped = 0, 0, 0
    taken = steps.taken
    for lane in range(LANES):
        taken[lane] = 0
    for lane in range(LANES):
        following = next_cell(blocks[lane], samples, steps, lane, following, cells, responses, edges)
        if blocks[lane].cell >= 0:
            busy += 1
    while busy > 0 and not is_stopped(stop):
        take_step(steps)
        for lane in range(LANES):
            block = blocks[lane]
            if block.cell < 0:
                continue
            ended, s, z, w = process_step(block, samples, steps, lane)
            taken[lane] += 1
            if ended == IN_FLIGHT:
                if taken[lane] >= MAX_STEPS + 8 * len(samples[0]):  # a record has many intervals, of a few steps each
                    raise SearchError("a flight does not end")
                continue
            taken[lane] = 0
            if end_flight(block, samples, ended, block.interval, s, z, w) and start_flight(block, samples):
                start_steps(block, samples, steps, lane)
                continue
            write_response(block, responses[block.cell])
            write_edges(block, edges, block.cell)
            stepped += block.stepped
            following = next_cell(block, samples, steps, lane, following, cells, responses, edges)
            if block.cell < 0:
                busy -= 1
    return stepped
