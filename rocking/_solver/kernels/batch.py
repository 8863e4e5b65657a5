"""Many blocks by Taylor steps, `LANES` at a time.

A SIMD lane takes the next cell as soon as its cell is finished, so that no lane waits for the longest motion. Cells in
succession that differ in eta only share the first flight. Slender blocks that have exact arcs are solved in
`rocking._solver.stages` instead.
"""

from rocking._base.errors import SearchError
from rocking._numba.cancellation import is_stopped
from rocking._numba.compilation import FloatArray, Record, kernel, light_entry
from rocking._numba.records import copy_fields
from rocking._numba.simd import LANES
from rocking._solver.kernels.event_loop import end_flight, init_state, repeat_first_flight, start_flight
from rocking._solver.rules import set_body, write_edges, write_response
from rocking._solver.state import IN_FLIGHT
from rocking._solver.taylor.flight import MAX_STEPS, process_step, start_steps
from rocking._solver.taylor.lane_events import locate_events
from rocking._solver.taylor.step import take_step


@kernel
def differ_in_eta_only(one: Record, other: Record) -> bool:
    """Whether two cells have the same first flight."""
    return bool(
        one.rate == other.rate
        and one.alpha == other.alpha
        and one.slenderness[0] == other.slenderness[0]
        and one.slenderness[1] == other.slenderness[1]
        and one.ratio == other.ratio
        and one.stiffness == other.stiffness
        and one.spring == other.spring
        and one.prestress == other.prestress
        and one.damping == other.damping
    )


@kernel
def continue_with_next_eta(flight: Record, cells: Record, responses: Record, edges: FloatArray) -> bool:
    """Write the response of a finished cell and start the next flight of the next eta; False if there is none."""
    while True:
        write_response(flight, responses[flight.cell])
        write_edges(flight, edges, flight.cell)
        if flight.cell == flight.last_cell:
            return False
        # the next cell has the same first flight, and differs from its impact on
        flight.cell += 1
        eta = cells[flight.cell].eta
        flight.eta[0], flight.eta[1] = eta[0], eta[1]
        if flight.first_flight_known == 0:  # no uplift, whatever eta
            continue
        if repeat_first_flight(flight) and start_flight(flight):
            return True


@kernel
def next_cell(
    flight: Record,
    steps: Record,
    lane: int,
    following: int,
    cells: Record,
    stop: FloatArray,
    responses: Record,
    edges: FloatArray,
) -> int:
    """Put the next cell with an uplift into a lane; returns the first cell after it that differs in more than eta."""
    while following < len(cells) and not is_stopped(stop):
        flight.cell = following
        following += 1
        while following < len(cells) and differ_in_eta_only(cells[flight.cell], cells[following]):
            following += 1
        flight.last_cell = following - 1
        set_body(flight, cells[flight.cell], len(edges) > 0)
        init_state(flight, cells[flight.cell].rate)
        # a block that does not uplift takes no lane: its response is written at once, and the next cell is tried
        if start_flight(flight):
            steps.omega[lane] = flight.omega
            start_steps(flight, steps, lane)
            return following
        continue_with_next_eta(flight, cells, responses, edges)
    flight.cell = -1
    return following


@light_entry
def solve_batch(
    cells: Record,
    flights: Record,
    steps: Record,
    stop: FloatArray,
    responses: Record,
    edges: FloatArray,
    followed: Record,
) -> int:
    """Follow bodies from rest to their final outcome, by Taylor steps; returns the number of flights written.

    `cells` (cells,): the bodies, `BODY_CELL`. `flights` (LANES,), `steps`: solver state, records of `pulse_state`, and
    `step_state`. `stop` (1,): once another thread sets it to 1, the function returns within a flight or a Taylor step;
    responses are missing. Filled: `responses` (cells,), `RESPONSE_RECORD`; `edges` (cells, EDGE_COLUMNS), without rows
    for equal edges where it is not wanted; `followed`, `FOLLOWED_FLIGHT`: the flights in the order of their ends, as
    many as fit, of one cell for its history. The names are of `rocking._solver.state`.
    """
    following, busy, taken, written = 0, 0, steps.taken, 0
    for lane in range(LANES):
        taken[lane], steps.in_use[lane] = 0, 0.0
    for lane in range(LANES):
        following = next_cell(flights[lane], steps, lane, following, cells, stop, responses, edges)
        if flights[lane].cell >= 0:
            busy += 1
    while busy > 0 and not is_stopped(stop):
        take_step(steps)
        locate_events(steps)
        for lane in range(LANES):
            flight = flights[lane]
            if flight.cell < 0:
                continue
            ended, w, z = process_step(flight, steps, lane)
            taken[lane] += 1
            if ended == IN_FLIGHT:
                if taken[lane] >= MAX_STEPS:
                    raise SearchError("a flight does not end")
                continue
            # the flight has ended: with an impact, with the pulse, or where overturning is certain
            taken[lane] = 0
            flight.length = flight.elapsed
            going = end_flight(flight, ended, w, z, flight.largest_z)
            if written < len(followed):
                copy_fields(flight, followed[written])
                written += 1
            # the lane goes on with the next flight of its cell, with the next eta, or with another cell, in this order
            if (going and start_flight(flight)) or continue_with_next_eta(flight, cells, responses, edges):
                start_steps(flight, steps, lane)
                continue
            following = next_cell(flight, steps, lane, following, cells, stop, responses, edges)
            if flight.cell < 0:  # no cell is left: the lane idles until the others are done
                steps.in_use[lane] = 0.0
                busy -= 1
    return written
