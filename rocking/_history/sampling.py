"""Time histories from the flights of the solver: samples of each flight, then of free rocking, impact by impact."""

from __future__ import annotations

import math

from rocking._numba.cancellation import is_stopped
from rocking._numba.compilation import FloatArray, Record, entry, kernel
from rocking._solver.arcs.flight import set_angles, state_at
from rocking._solver.kernels.event_loop import advance, advance_by_arc, init_state
from rocking._solver.rules import set_body, set_sign
from rocking._solver.taylor.events import evaluate_series
from rocking._solver.taylor.flight import impact_in_step, start_steps
from rocking._solver.taylor.step import set_edge_lane, take_step

REST_VELOCITY = 1e-7
"""Velocity after an impact [-] below which free rocking is set to rest: a rotation of 5e-15 alpha."""


@kernel
def sample_step(
    steps: Record,
    sign: float,
    start: float,
    end: float,
    tau: FloatArray,
    filled: int,
    rotation: FloatArray,
    velocity: FloatArray,
) -> int:
    """Evaluate the Taylor step that starts at time `start` at the samples before `end`; returns the samples passed."""
    order = steps.order
    while filled < len(tau) and tau[filled] < end:
        h = max(tau[filled] - start, 0.0)  # sums of steps are rounded differently
        rotation[filled] = sign * evaluate_series(steps.z, 0, order, h)
        velocity[filled] = sign * evaluate_series(steps.rate, 0, order - 1, h)
        filled += 1
    return filled


@kernel
def sample_steps(
    flight: Record,
    steps: Record,
    start: float,
    end: float,
    max_rotation: float,
    tau: FloatArray,
    filled: int,
    rotation: FloatArray,
    velocity: FloatArray,
) -> tuple[int, float, float]:
    """Repeat the last flight of `advance`, at most to z = `max_rotation`; returns the samples passed, last z, w."""
    steps.omega[0] = flight.omega
    start_steps(flight, steps, 0)
    elapsed, z, w = 0.0, 0.0, flight.w0
    while elapsed < flight.length and z < max_rotation:
        steps.limit[0] = flight.length - elapsed
        take_step(steps)
        h = steps.h[0]
        last = elapsed + h >= flight.length
        filled = sample_step(
            steps,
            flight.sign,
            start + elapsed,
            end if last else start + (elapsed + h),
            tau,
            filled,
            rotation,
            velocity,
        )
        elapsed += h
        z, w = steps.z1[0], steps.w1[0]
        steps.z0[0], steps.w0[0], steps.starts_at_uplift[0] = z, w, 0.0
        steps.phase[0] += flight.omega * h
    return filled, z, w


@kernel
def sample_arc(
    flight: Record, start: float, end: float, tau: FloatArray, filled: int, rotation: FloatArray, velocity: FloatArray
) -> tuple[int, float, float]:
    """Evaluate the arc of the last flight of `advance`; returns the samples passed, last z, w."""
    while filled < len(tau) and tau[filled] < end:
        h = max(tau[filled] - start, 0.0)
        set_angles(flight, flight.phase + flight.omega * h, flight.cosine1, flight.sine1)
        z, w = state_at(flight, h, flight.cosine1, flight.sine1)
        rotation[filled], velocity[filled] = flight.sign * z, flight.sign * w
        filled += 1
    set_angles(flight, flight.phase + flight.omega * flight.length, flight.cosine1, flight.sine1)
    z, w = state_at(flight, flight.length, flight.cosine1, flight.sine1)
    return filled, z, w


@kernel
def sample_pulse(
    cell: Record,
    flight: Record,
    steps: Record | None,
    max_rotation: float,
    tau: FloatArray,
    rotation: FloatArray,
    velocity: FloatArray,
    impact_times: FloatArray,
    stop: FloatArray,
) -> int:
    """`solve_and_sample`, or `sample_arcs` where `steps` is None: then it is compiled without Taylor steps.

    The event loop of the solver follows one flight after the other; each is then repeated from its start and evaluated
    at the times inside it. So a history has the events of the response, and samples do not change them.
    """
    set_body(flight, cell, False)
    omega = cell.rate
    init_state(flight, omega)
    pulse_end = (flight.end_phase[flight.pieces] - flight.end_phase[0]) / omega
    filled, written = 0, 0  # times that lie before the end of the flight, impacts
    going = flight.interval_count > 0  # whether the last flight ended in an impact
    while going and not is_stopped(stop):
        flight.length = math.nan
        going = advance_by_arc(flight) if steps is None else advance(flight, steps)
        if math.isnan(flight.length):
            break  # at rest until the end
        start = (flight.phase - flight.end_phase[0]) / omega
        end = start + flight.length
        if going:
            end = (flight.next_phase - flight.end_phase[0]) / omega  # as the start of the next flight
            if written < len(impact_times):
                impact_times[written] = end
                written += 1
        elif end < pulse_end:  # overturning is certain before the pulse ends: the last flight continues
            flight.length, end = pulse_end - start, pulse_end
        while filled < len(tau) and tau[filled] < start:
            filled += 1  # at rest
        # `advance` has set the angles of the next flight: restore those of this one
        set_angles(flight, flight.phase, flight.cosine0, flight.sine0)
        if steps is None or flight.by_arcs == 1:
            filled, z, w = sample_arc(flight, start, end, tau, filled, rotation, velocity)
        else:
            limit = math.inf if going else max_rotation
            filled, z, w = sample_steps(flight, steps, start, end, limit, tau, filled, rotation, velocity)
        if going:
            set_angles(flight, flight.next_phase, flight.cosine0, flight.sine0)
        else:
            flight.end_rotation, flight.end_velocity = z, w
    return written


@entry
def solve_and_sample(
    cell: Record,
    flight: Record,
    steps: Record,
    max_rotation: float,
    tau: FloatArray,
    rotation: FloatArray,
    velocity: FloatArray,
    impact_times: FloatArray,
    stop: FloatArray,
) -> int:
    """One block from rest to its final outcome, sampled at the times `tau` during the pulse.

    Fills `rotation` theta/alpha and `velocity` theta'/(p alpha).

    Parameters
    ----------
    cell
        A record `BODY_CELL`.
    flight, steps
        Solver state, records of `pulse_state` and `step_state`; `flight` holds the response on return.
    max_rotation : float
        |theta|/alpha at which the history of a block that overturns may stop [-].
    tau : float array (samples,)
        Times from the pulse's start [-], ascending; `rotation` and `velocity` (samples,) are zero on entry.
    impact_times : float array
        Filled with the times of the impacts, as many as fit.
    stop : uint8 array (1,)
        Once another thread sets it to 1, the function returns within a flight; samples are missing.

    Returns
    -------
    int
        Number of impacts written.
    """
    return sample_pulse(cell, flight, steps, max_rotation, tau, rotation, velocity, impact_times, stop)


@entry
def sample_arcs(
    cell: Record,
    flight: Record,
    max_rotation: float,
    tau: FloatArray,
    rotation: FloatArray,
    velocity: FloatArray,
    impact_times: FloatArray,
    stop: FloatArray,
) -> int:
    """`solve_and_sample` for a slender block under sinusoids, compiled without Taylor steps."""
    return sample_pulse(cell, flight, None, max_rotation, tau, rotation, velocity, impact_times, stop)


@entry
def sample_free_rocking(
    z: float,
    w: float,
    sign: float,
    body: Record,
    steps: Record,
    start: float,
    horizon: float,
    max_rotation: float,
    tau: FloatArray,
    rotation: FloatArray,
    velocity: FloatArray,
    impact_times: FloatArray,
    stop: FloatArray,
) -> int:
    """Continue from the state that the solver left at the end of the pulse.

    Without ground motion z has one maximum in a flight, after which it falls to the next impact: each Taylor step holds
    at most one impact, which `impact_in_step` finds. The restitution ends the motion at `REST_VELOCITY`.

    Parameters
    ----------
    z, w, sign : float
        |theta|/alpha, its rate, and sgn(theta) there: the fields `end_rotation`, `end_velocity` and `end_sign`.
    body
        Record `BLOCK_STATE` with the fields `BODY_FIELDS`.
    steps
        Solver state of `step_state`.
    start, horizon : float
        Times from the pulse's start at which free rocking begins and at which to stop [-].
    max_rotation : float
        |theta|/alpha at which to stop [-].
    tau, rotation, velocity : float arrays (samples,)
        Filled for times from `start` on.
    impact_times : float array
        Filled with the times of the impacts, as many as fit.
    stop : uint8 array (1,)
        Once another thread sets it to 1, the function returns within a flight; samples are missing.

    Returns
    -------
    int
        Number of impacts written.
    """
    set_sign(body, sign)
    set_edge_lane(steps, 0, body, body.side)
    steps.omega[0] = 1.0
    steps.strength[0], steps.starts_at_uplift[0], steps.phase[0] = 0.0, 0.0, 0.0
    filled, written = 0, 0
    while filled < len(tau) and tau[filled] < start:
        filled += 1
    time = start
    steps.z0[0], steps.w0[0] = z, w
    starts_at_ground = False
    while sign != 0.0 and time < horizon and steps.z0[0] < max_rotation and not is_stopped(stop):
        steps.limit[0] = horizon - time
        take_step(steps)
        impact = impact_in_step(steps, 0, False, starts_at_ground)
        h = steps.h[0] if impact < 0.0 else impact
        filled = sample_step(steps, sign, time, time + h, tau, filled, rotation, velocity)
        time += h
        starts_at_ground = impact >= 0.0
        if not starts_at_ground:
            steps.z0[0], steps.w0[0] = steps.z1[0], steps.w1[0]
            continue
        if written < len(impact_times):
            impact_times[written] = time
            written += 1
        steps.z0[0] = 0.0
        steps.w0[0] = -body.eta[body.side] * evaluate_series(steps.rate, 0, steps.order - 1, h)  # (2.3)
        sign = -sign
        set_sign(body, sign)
        set_edge_lane(steps, 0, body, body.side)
        if steps.w0[0] <= REST_VELOCITY or written == len(impact_times):
            break
    return written
