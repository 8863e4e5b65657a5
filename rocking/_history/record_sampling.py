"""Time histories under samples of the ground motion: the flights of the solver, until the motion ends."""

from __future__ import annotations

from rocking._base.errors import SearchError
from rocking._numba.cancellation import is_stopped
from rocking._numba.compilation import FloatArray, Record, entry, kernel
from rocking._solver.records.arc_flight import flight_by_arcs
from rocking._solver.records.batch import end_flight
from rocking._solver.records.event_loop import init_body_state, restoring_at, start_flight
from rocking._solver.records.piece import piece_state
from rocking._solver.records.samples import SHAPE, TIME, interval_length
from rocking._solver.records.taylor_flight import process_step, start_piece, start_steps
from rocking._solver.records.taylor_step import take_step
from rocking._solver.rules import set_sign
from rocking._solver.state import IMPACT, IN_FLIGHT, PULSE_END
from rocking._solver.taylor.events import evaluate_series
from rocking._solver.taylor.flight import MAX_STEPS


@kernel
def flight_by_taylor_steps(block: Record, samples: FloatArray, steps: Record) -> tuple[int, int, float, float, float]:
    """Follow one flight in the first lane; returns the same as `flight_by_arcs`."""
    start_steps(block, samples, steps, 0)
    for _ in range(MAX_STEPS + 8 * len(samples[SHAPE])):
        take_step(steps)
        ended, s, z, w = process_step(block, samples, steps, 0)
        if ended != IN_FLIGHT:
            return ended, block.interval, s, z, w
    raise SearchError("a flight does not end")


@kernel
def sample_arc_flight(
    start: Record,
    samples: FloatArray,
    end: float,
    max_rotation: float,
    tau: FloatArray,
    filled: int,
    rotation: FloatArray,
    velocity: FloatArray,
) -> tuple[int, float, float]:
    """Evaluate a flight of the slender block, given the record at its start, at the samples before `end`.

    Returns the number of samples passed, z and w at `end` or at the last sample of the motion.
    """
    k, s = start.interval, start.s
    z, w = 0.0, start.w0
    count = len(samples[SHAPE]) - 1
    while k < count and z < max_rotation:
        left, h = start.h * samples[TIME, k], interval_length(start, samples, k)
        q0, q1 = restoring_at(start, samples, k), restoring_at(start, samples, k + 1)
        r = (q1 - q0) / h
        at = 0.0 if start.starts_at_uplift == 1 and k == start.interval else q0 + r * s
        right = min(end, start.h * samples[TIME, k + 1])
        while filled < len(tau) and tau[filled] < right:
            at_sample, rate = piece_state(z, w, at, r, max(tau[filled] - (left + s), 0.0))
            rotation[filled], velocity[filled] = start.sign * at_sample, start.sign * rate
            filled += 1
        z, w = piece_state(z, w, at, r, max(right - (left + s), 0.0))
        if right == end:
            break
        k, s = k + 1, 0.0
    return filled, z, w


@kernel
def sample_taylor_flight(
    start: Record,
    samples: FloatArray,
    steps: Record,
    end: float,
    max_rotation: float,
    tau: FloatArray,
    filled: int,
    rotation: FloatArray,
    velocity: FloatArray,
) -> tuple[int, float, float]:
    """The same for any block by Taylor steps; `start` is changed."""
    start_steps(start, samples, steps, 0)
    sign, ended = start.sign, IN_FLIGHT
    z, w = 0.0, start.w0
    for _ in range(MAX_STEPS + 8 * len(samples[SHAPE])):
        left = start.h * samples[TIME, start.interval] + start.s
        take_step(steps)
        length = steps.h[0]
        right = min(end, left + length)
        while filled < len(tau) and tau[filled] < right:
            at = max(tau[filled] - left, 0.0)
            rotation[filled] = sign * evaluate_series(steps.z, 0, steps.order, at)
            velocity[filled] = sign * evaluate_series(steps.rate, 0, steps.order - 1, at)
            filled += 1
        z, w = steps.z1[0], steps.w1[0]
        ended, _, _, _ = process_step(start, samples, steps, 0)
        if right == end or z >= max_rotation or ended == PULSE_END:
            break
        if ended != IN_FLIGHT:  # overturning is certain, the flight continues
            start_piece(start, samples, steps, 0, False)
    return filled, z, w


@entry
def sample_record(
    samples: FloatArray,
    cell: Record,
    block: Record,
    start: Record,
    steps: Record,
    max_rotation: float,
    tau: FloatArray,
    rotation: FloatArray,
    velocity: FloatArray,
    impact_times: FloatArray,
    stop: FloatArray,
) -> int:
    """One body from rest to its final outcome, sampled at the times `tau` during the motion.

    Each flight of the event loop is repeated from a copy of the state at its start and evaluated at the times inside
    it, by the same pieces or steps.

    Parameters
    ----------
    samples
        As for `rocking._solver.records.batch.solve_by_steps`.
    cell
        A record `BODY_CELL`.
    block, start, steps
        Solver state: two records `BLOCK_STATE`, and `step_state`; `block` holds the response on return, with z, w and
        sgn(theta) at the last sample of the motion, 0 at rest.
    max_rotation : float
        |theta|/alpha at which the history of a block that overturns may stop [-].
    tau : float array (times,)
        Times from the first sample [-], ascending; `rotation` and `velocity` (times,) are zero on entry.
    impact_times : float array
        Filled with the times of the impacts, as many as fit.
    stop : uint8 array (1,)
        Once another thread sets it to 1, the function returns within a flight; samples are missing.

    Returns
    -------
    int
        Number of impacts written.
    """
    init_body_state(block, cell, False)
    by_arcs = cell.alpha == 0.0 and cell.vertical == 0.0
    last = cell.rate * samples[TIME, len(samples[SHAPE]) - 1]
    filled, written = 0, 0
    while start_flight(block, samples) and not is_stopped(stop):
        copy_start(block, start)
        begin = cell.rate * samples[TIME, block.interval] + block.s
        while filled < len(tau) and tau[filled] < begin:
            filled += 1  # at rest
        if by_arcs:
            ended, k, s, z, w = flight_by_arcs(block, samples)
        else:
            ended, k, s, z, w = flight_by_taylor_steps(block, samples, steps)
        going = end_flight(block, samples, ended, k, s, z, w)
        end = cell.rate * samples[TIME, k] + s if ended == IMPACT else last
        if ended == IMPACT and written < len(impact_times):
            impact_times[written] = end
            written += 1
        limit = max_rotation if ended != IMPACT else 1e300
        if by_arcs:
            filled, z, w = sample_arc_flight(start, samples, end, limit, tau, filled, rotation, velocity)
        else:
            filled, z, w = sample_taylor_flight(start, samples, steps, end, limit, tau, filled, rotation, velocity)
        if not going:
            block.end_rotation, block.end_velocity = z, w
            break
    return written


@kernel
def copy_start(block: Record, start: Record) -> None:
    """Copy what describes the start of a flight."""
    for side in range(2):
        start.a[side], start.ratio[side], start.stiffness[side] = (
            block.a[side],
            block.ratio[side],
            block.stiffness[side],
        )
    start.alpha, start.h, start.vertical, start.each_side = block.alpha, block.h, block.vertical, 0
    start.interval, start.s, start.w0 = block.interval, block.s, block.w0
    set_sign(start, block.sign)
    start.starts_at_uplift, start.at_rest = block.starts_at_uplift, 0
    start.peak_rotation, start.largest_z = 1e300, 0.0  # no peak exceeds it: none is searched for
