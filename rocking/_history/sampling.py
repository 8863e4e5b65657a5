"""Time histories from the flights of the solver: samples of each flight, then of free rocking, impact by impact.

Given: the flights that the event loop has followed, and times. Each flight is repeated from its start, by the same
pieces or Taylor steps, and evaluated at the times inside it. No event is decided here: a history has those of the
response, and its samples do not change them. Under a pulse the kernel of the responses has written the flights, so that
a history does not compile its event loop again.

In all functions `history` is a float array (3, times): the rows `TAU`, ascending times from the start of the ground
motion [-], `ROTATION` theta/alpha and `VELOCITY` theta'/(p alpha), the last two zero on entry. `filled` is the number
of times that are passed. `impact_times` is filled with the times of the impacts, as many as fit; `max_rotation` is the
|theta|/alpha at which the history of a body that overturns may stop [-]. Once another thread sets `stop`, a uint8 array
(1,), to 1, a function returns within a flight; samples are missing.
"""

import math

from rocking._base.errors import SearchError
from rocking._numba.cancellation import is_stopped
from rocking._numba.compilation import FloatArray, Record, entry, kernel, light_entry
from rocking._numba.records import copy_fields
from rocking._solver.records import taylor_flight as pieces
from rocking._solver.records.arc_flight import flight_by_arcs
from rocking._solver.records.batch import end_flight
from rocking._solver.records.event_loop import init_body_state, restoring_at, start_flight
from rocking._solver.records.piece import piece_state
from rocking._solver.records.samples import SHAPE, TIME, interval_length
from rocking._solver.records.taylor_step import take_step as take_piece_step
from rocking._solver.rules import set_sign
from rocking._solver.state import IMPACT, IN_FLIGHT, PULSE_END
from rocking._solver.taylor.events import evaluate_series
from rocking._solver.taylor.flight import MAX_STEPS, impact_in_step
from rocking._solver.taylor.step import set_edge_lane, take_step

TAU, ROTATION, VELOCITY = range(3)  # rows of a history
REST_VELOCITY = 1e-7  # velocity after an impact [-] below which free rocking is set to rest: a rotation of 5e-15 alpha


@light_entry
def sample_flights(
    followed: Record, flight: Record, steps: Record, max_rotation: float, history: FloatArray, stop: FloatArray
) -> None:
    """Repeat the flights of a body under a pulse by the Taylor steps of `rocking._solver.kernels.batch.solve_batch`.

    A body that overturns is followed to the end of the pulse.

    `followed`: the flights, in their order. `flight`, `steps`: solver state, records of `pulse_state` as it was after
    them, and of `step_state`; `flight` holds z and w at the end of the pulse on return.
    """
    first, omega = flight.end_phase[0], flight.omega
    pulse_end = (flight.end_phase[flight.pieces] - first) / omega
    filled = 0
    for k in range(len(followed)):
        if is_stopped(stop):
            return
        copy_fields(followed[k], flight)
        set_sign(flight, flight.sign)
        start = (flight.phase - first) / omega
        going = k + 1 < len(followed) or flight.end_sign == 0.0  # whether the flight ended in an impact
        end = (flight.next_phase - first) / omega if going else start + flight.length
        # overturning was certain before the end of the pulse, where the solver stopped: the flight goes on to there
        if not going and end < pulse_end:
            flight.length, end = pulse_end - start, pulse_end
        filled = pass_times(history, filled, start)  # at rest
        limit = math.inf if going else max_rotation
        filled, z, w = sample_steps(flight, steps, start, end, limit, history, filled)
        if not going:
            flight.end_rotation, flight.end_velocity = z, w


@entry
def sample_record(
    samples: FloatArray,
    cell: Record,
    block: Record,
    start: Record,
    steps: Record,
    max_rotation: float,
    history: FloatArray,
    impact_times: FloatArray,
    stop: FloatArray,
) -> int:
    """One body under samples from rest to its final outcome, sampled during the motion; returns the impacts written.

    `samples`: as for `rocking._solver.records.batch.solve_by_steps`. `cell`: a record `BODY_CELL`. `block`, `start`,
    `steps`: solver state: two records `BLOCK_STATE`, and `step_state`; `block` holds the response on return, with z, w
    and sgn(theta) at the last sample of the motion, 0 at rest.
    """
    init_body_state(block, cell, False)
    by_pieces = cell.alpha == 0.0 and cell.vertical == 0.0 and block.restrained == 0
    last = cell.rate * samples[TIME, len(samples[SHAPE]) - 1]
    filled, written = 0, 0
    while start_flight(block, samples) and not is_stopped(stop):
        copy_start(block, start)
        begin = cell.rate * samples[TIME, block.interval] + block.s
        filled = pass_times(history, filled, begin)  # at rest
        if by_pieces:
            ended, k, s, z, w = flight_by_arcs(block, samples)
        else:
            ended, k, s, z, w = flight_by_taylor_steps(block, samples, steps)
        going = end_flight(block, samples, ended, k, s, z, w)
        # once the end of the flight is known it is repeated, and sampled up to there
        end = cell.rate * samples[TIME, k] + s if ended == IMPACT else last
        if ended == IMPACT and written < len(impact_times):
            impact_times[written] = end
            written += 1
        limit = max_rotation if ended != IMPACT else math.inf
        if by_pieces:
            filled, z, w = sample_pieces(start, samples, end, limit, history, filled)
        else:
            filled, z, w = sample_piece_steps(start, samples, steps, end, limit, history, filled)
        if not going:
            block.end_rotation, block.end_velocity = z, w
            break
    return written


@kernel
def pass_times(history: FloatArray, filled: int, start: float) -> int:
    """Pass the times before `start`; returns the number of times passed."""
    while filled < history.shape[1] and history[TAU, filled] < start:
        filled += 1
    return filled


@kernel
def sample_step(steps: Record, sign: float, start: float, end: float, history: FloatArray, filled: int) -> int:
    """Evaluate the Taylor step that starts at time `start` at the times before `end`; returns the times passed."""
    order = steps.order
    while filled < history.shape[1] and history[TAU, filled] < end:
        h = max(history[TAU, filled] - start, 0.0)  # sums of steps are rounded differently
        history[ROTATION, filled] = sign * evaluate_series(steps.z, 0, order, h)
        history[VELOCITY, filled] = sign * evaluate_series(steps.rate, 0, order - 1, h)
        filled += 1
    return filled


@kernel
def sample_steps(
    flight: Record, steps: Record, start: float, end: float, max_rotation: float, history: FloatArray, filled: int
) -> tuple[int, float, float]:
    """Repeat a flight, at most to z = `max_rotation`; returns the times passed, last z, w."""
    set_edge_lane(steps, 0, flight, flight.side)
    steps.omega[0], steps.strength[0], steps.phase[0] = flight.omega, flight.strength, flight.phase
    steps.z0[0], steps.w0[0], steps.starts_at_uplift[0] = 0.0, flight.w0, flight.starts_at_uplift
    elapsed, z, w = 0.0, 0.0, flight.w0
    # no segments: the events are known, so that steps may pass the places where q changes its sign
    while elapsed < flight.length and z < max_rotation:
        steps.limit[0] = flight.length - elapsed
        take_step(steps)
        h = steps.h[0]
        # by rounding the phase can reach the end of the pulse before the time does: then no step is left
        ends = elapsed + h >= flight.length or elapsed + h == elapsed
        until = end if ends else start + (elapsed + h)
        filled = sample_step(steps, flight.sign, start + elapsed, until, history, filled)
        elapsed += h
        z, w = steps.z1[0], steps.w1[0]
        if ends:
            break
        steps.z0[0], steps.w0[0], steps.starts_at_uplift[0] = z, w, 0.0
        steps.phase[0] += flight.omega * h
    return filled, z, w


@kernel
def flight_by_taylor_steps(block: Record, samples: FloatArray, steps: Record) -> tuple[int, int, float, float, float]:
    """Follow one flight in the first lane; returns the same as `flight_by_arcs`."""
    pieces.start_steps(block, samples, steps, 0)
    for _ in range(MAX_STEPS + 8 * len(samples[SHAPE])):
        take_piece_step(steps)
        ended, s, z, w = pieces.process_step(block, samples, steps, 0)
        if ended != IN_FLIGHT:
            return ended, block.interval, s, z, w
    raise SearchError("a flight does not end")


@kernel
def sample_pieces(
    start: Record, samples: FloatArray, end: float, max_rotation: float, history: FloatArray, filled: int
) -> tuple[int, float, float]:
    """Repeat a flight of the slender block, piece by piece, from the state at its start.

    Returns the times passed, z and w at `end` or at the last sample of the motion.
    """
    k, s = start.interval, start.s
    z, w = 0.0, start.w0
    count = len(samples[SHAPE]) - 1
    while k < count and z < max_rotation:
        left, h = start.h * samples[TIME, k], interval_length(start, samples, k)
        q0, q1 = restoring_at(start, samples, k), restoring_at(start, samples, k + 1)
        r = (q1 - q0) / h
        # q is 0 at an uplift without rounding, as when the flight was followed
        at = 0.0 if start.starts_at_uplift == 1 and k == start.interval else q0 + r * s
        right = min(end, start.h * samples[TIME, k + 1])
        while filled < history.shape[1] and history[TAU, filled] < right:
            at_sample, rate = piece_state(z, w, at, r, max(history[TAU, filled] - (left + s), 0.0))
            history[ROTATION, filled], history[VELOCITY, filled] = start.sign * at_sample, start.sign * rate
            filled += 1
        z, w = piece_state(z, w, at, r, max(right - (left + s), 0.0))
        if right == end:
            break
        k, s = k + 1, 0.0
    return filled, z, w


@kernel
def sample_piece_steps(
    start: Record, samples: FloatArray, steps: Record, end: float, max_rotation: float, history: FloatArray, filled: int
) -> tuple[int, float, float]:
    """`sample_pieces` for any body by Taylor steps; `start` is changed."""
    pieces.start_steps(start, samples, steps, 0)
    sign, ended = start.sign, IN_FLIGHT
    z, w = 0.0, start.w0
    for _ in range(MAX_STEPS + 8 * len(samples[SHAPE])):
        left = start.h * samples[TIME, start.interval] + start.s
        take_piece_step(steps)
        right = min(end, left + steps.h[0])
        filled = sample_step(steps, sign, left, right, history, filled)
        z, w = steps.z1[0], steps.w1[0]
        ended, _, _, _ = pieces.process_step(start, samples, steps, 0)
        if right == end or z >= max_rotation or ended == PULSE_END:
            break
        if ended != IN_FLIGHT:  # overturning is certain, the flight continues
            pieces.start_piece(start, samples, steps, 0, False)
    return filled, z, w


@kernel
def copy_start(block: Record, start: Record) -> None:
    """Copy what describes the start of a flight."""
    for side in range(2):
        start.a[side], start.ratio[side] = block.a[side], block.ratio[side]
        start.stiffness[side] = block.stiffness[side]
    start.alpha, start.h, start.vertical, start.each_side = block.alpha, block.h, block.vertical, 0
    start.restrained, start.spring, start.level = block.restrained, block.spring, block.level
    start.damping, start.may_turn = block.damping, block.may_turn
    start.interval, start.s, start.w0 = block.interval, block.s, block.w0
    set_sign(start, block.sign)
    start.starts_at_uplift, start.at_rest = block.starts_at_uplift, 0
    start.peak_rotation, start.largest_z = 1e300, 0.0  # no peak exceeds it: none is searched for


@light_entry
def sample_free_rocking(
    z: float,
    w: float,
    sign: float,
    body: Record,
    steps: Record,
    start: float,
    horizon: float,
    max_rotation: float,
    history: FloatArray,
    impact_times: FloatArray,
    stop: FloatArray,
) -> int:
    """Continue from the state that the solver left at the end of the ground motion; returns the impacts written.

    Given: z, w and sgn(theta) when the ground stops. Decided: the impacts that follow. None is missed: without ground
    motion q = 1, so that z has one maximum in a flight and then falls, and each Taylor step holds at most one impact,
    which `impact_in_step` finds. The motion ends where it overturns, at the horizon, or at `REST_VELOCITY`.

    `z`, `w`, `sign`: |theta|/alpha, its rate, and sgn(theta) there: the fields `end_rotation`, `end_velocity` and
    `end_sign`; `body`: record `BLOCK_STATE` with the fields `BODY_FIELDS`; `steps`: solver state of `step_state`;
    `start`, `horizon`: times from the start of the ground motion at which free rocking begins and at which to stop [-].
    """
    set_sign(body, sign)
    set_edge_lane(steps, 0, body, body.side)
    steps.omega[0] = 1.0
    steps.strength[0], steps.starts_at_uplift[0], steps.phase[0] = 0.0, 0.0, 0.0
    filled, written = pass_times(history, 0, start), 0
    time = start
    steps.z0[0], steps.w0[0] = z, w
    starts_at_ground = False
    while sign != 0.0 and time < horizon and steps.z0[0] < max_rotation and not is_stopped(stop):
        steps.limit[0] = horizon - time
        take_step(steps)
        impact = impact_in_step(steps, 0, False, starts_at_ground)
        h = steps.h[0] if impact < 0.0 else impact
        filled = sample_step(steps, sign, time, time + h, history, filled)
        time += h
        starts_at_ground = impact >= 0.0
        if not starts_at_ground:  # the flight goes on
            steps.z0[0], steps.w0[0] = steps.z1[0], steps.w1[0]
            continue
        if written < len(impact_times):
            impact_times[written] = time
            written += 1
        steps.z0[0] = 0.0
        steps.w0[0] = -body.eta[body.side] * evaluate_series(steps.rate, 0, steps.order - 1, h)  # (2.3)
        sign *= body.turn
        set_sign(body, sign)
        set_edge_lane(steps, 0, body, body.side)
        if steps.w0[0] <= REST_VELOCITY or written == len(impact_times):
            break
    return written
