"""Time histories from the solver's own flights: each is sampled where it lies, then free rocking impact by impact."""

from __future__ import annotations

import math

from rocking._numba.cancellation import is_stopped
from rocking._numba.compilation import FloatArray, Record, entry, kernel
from rocking.solver.arcs.flight import set_angles, state_at
from rocking.solver.kernels.event_loop import advance, advance_by_arc, init_state
from rocking.solver.taylor.events import evaluate_series
from rocking.solver.taylor.flight import impact_in_step, start_steps
from rocking.solver.taylor.step import init_block, take_step

REST_VELOCITY = 1e-7
"""Velocity after an impact [-] below which free rocking is shown as rest: a rotation of 5e-15 alpha."""


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
    """Evaluate the Taylor step that began at time `start` at the samples before `end`; the samples passed."""
    order = steps.order
    while filled < len(tau) and tau[filled] < end:
        h = max(tau[filled] - start, 0.0)  # sums of steps round differently
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
    farthest: float,
    tau: FloatArray,
    filled: int,
    rotation: FloatArray,
    velocity: FloatArray,
) -> tuple[int, float, float]:
    """Step through the last flight of `advance` once more, at most to z = `farthest`; the samples passed, last z, w."""
    init_block(steps, 0, flight.alpha, flight.omega)
    start_steps(flight, steps, 0)
    elapsed, z, w = 0.0, 0.0, flight.w0
    while elapsed < flight.length and z < farthest:
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
    """Evaluate the arc of the last flight of `advance`; the samples passed, last z, w."""
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
    slenderness: float,
    omega: float,
    eta: float,
    alpha: float,
    flight: Record,
    steps: Record | None,
    farthest: float,
    tau: FloatArray,
    rotation: FloatArray,
    velocity: FloatArray,
    landings: FloatArray,
    stop: FloatArray,
) -> int:
    """`solve_and_sample`, or `sample_arcs` where `steps` is None: then it is compiled without Taylor steps."""
    init_state(slenderness, omega, alpha, flight)
    pulse_end = (flight.end_phase[flight.pieces] - flight.end_phase[0]) / omega
    filled, written, going = 0, 0, flight.interval_count > 0
    while going and not is_stopped(stop):
        flight.length = math.nan
        going = advance_by_arc(flight, eta) if steps is None else advance(flight, steps, eta)
        if math.isnan(flight.length):
            break  # at rest for good
        start = (flight.phase - flight.end_phase[0]) / omega
        end = start + flight.length
        if going:
            end = (flight.next_phase - flight.end_phase[0]) / omega  # where the next flight says that it starts
            if written < len(landings):
                landings[written] = end
                written += 1
        elif end < pulse_end:  # known to overturn before the pulse ends: its last flight goes on
            flight.length, end = pulse_end - start, pulse_end
        while filled < len(tau) and tau[filled] < start:
            filled += 1  # at rest
        # `advance` has prepared the next flight: its angles must not stand in for this one's
        set_angles(flight, flight.phase, flight.cosine0, flight.sine0)
        if steps is None or flight.by_arcs == 1:
            filled, z, w = sample_arc(flight, start, end, tau, filled, rotation, velocity)
        else:
            reach = math.inf if going else farthest
            filled, z, w = sample_steps(flight, steps, start, end, reach, tau, filled, rotation, velocity)
        if going:
            set_angles(flight, flight.next_phase, flight.cosine0, flight.sine0)
        else:
            flight.end_rotation, flight.end_velocity = z, w
    return written


@entry
def solve_and_sample(
    slenderness: float,
    omega: float,
    eta: float,
    alpha: float,
    flight: Record,
    steps: Record,
    farthest: float,
    tau: FloatArray,
    rotation: FloatArray,
    velocity: FloatArray,
    landings: FloatArray,
    stop: FloatArray,
) -> int:
    """One block from rest to its final fate, sampled at the times `tau` during the pulse.

    Fills `rotation` theta/alpha and `velocity` theta'/(p alpha).

    Parameters
    ----------
    slenderness, omega, eta, alpha : float
        1/a > 0, frequency ratio > 0, restitution in [0, 1] [-]; slenderness angle in [0, pi/2) [rad], 0: slender.
    flight, steps
        The pulse, scratch and answer, as `state.pulse_state` and `state.step_state`.
    farthest : float
        |theta|/alpha at which the history of a block that is known to overturn may stop [-].
    tau : float array (samples,)
        Times from the pulse's start [-], ascending; `rotation` and `velocity` (samples,) are zero on entry.
    landings : float array
        Filled with the times of the impacts as far as it reaches.
    stop : uint8 array (1,)
        Once another thread sets it to 1, this returns within a flight, with samples missing.

    Returns
    -------
    int
        Impacts written down.
    """
    return sample_pulse(
        slenderness, omega, eta, alpha, flight, steps, farthest, tau, rotation, velocity, landings, stop
    )


@entry
def sample_arcs(
    slenderness: float,
    omega: float,
    eta: float,
    alpha: float,
    flight: Record,
    farthest: float,
    tau: FloatArray,
    rotation: FloatArray,
    velocity: FloatArray,
    landings: FloatArray,
    stop: FloatArray,
) -> int:
    """`solve_and_sample` for a slender block under one sinusoid: `flight` is a record `SINGLE_SINUSOID_STATE`.

    Compiled as `solve_by_arcs`, it has the same bits.
    """
    return sample_pulse(slenderness, omega, eta, alpha, flight, None, farthest, tau, rotation, velocity, landings, stop)


@entry
def sample_free_rocking(
    z: float,
    w: float,
    sign: float,
    alpha: float,
    steps: Record,
    eta: float,
    start: float,
    horizon: float,
    farthest: float,
    tau: FloatArray,
    rotation: FloatArray,
    velocity: FloatArray,
    landings: FloatArray,
    stop: FloatArray,
) -> int:
    """Continue from the state that the solver left at the end of the pulse.

    Parameters
    ----------
    z, w, sign : float
        |theta|/alpha, its rate, and sgn(theta) there: the fields `end_rotation`, `end_velocity` and `end_sign`.
    alpha : float
        Slenderness angle [rad], 0: slender.
    steps
        Scratch, as `state.step_state`.
    eta : float
        Restitution [-].
    start, horizon : float
        Times from the pulse's start at which free rocking begins and at which to stop [-].
    farthest : float
        |theta|/alpha at which to stop [-].
    tau, rotation, velocity : float arrays (samples,)
        Filled for times from `start` on.
    landings : float array
        Filled with the times of the impacts as far as it reaches.
    stop : uint8 array (1,)
        Once another thread sets it to 1, this returns within a flight, with samples missing.

    Returns
    -------
    int
        Impacts written down.
    """
    init_block(steps, 0, alpha, 1.0)
    steps.strength[0], steps.starts_at_uplift[0], steps.phase[0] = 0.0, 0.0, 0.0
    filled, written = 0, 0
    while filled < len(tau) and tau[filled] < start:
        filled += 1
    time = start
    steps.z0[0], steps.w0[0] = z, w
    grounded = False
    while sign != 0.0 and time < horizon and steps.z0[0] < farthest and not is_stopped(stop):
        steps.limit[0] = horizon - time
        take_step(steps)
        impact = impact_in_step(steps, 0, False, grounded)
        h = steps.h[0] if impact < 0.0 else impact
        filled = sample_step(steps, sign, time, time + h, tau, filled, rotation, velocity)
        time += h
        grounded = impact >= 0.0
        if not grounded:
            steps.z0[0], steps.w0[0] = steps.z1[0], steps.w1[0]
            continue
        if written < len(landings):
            landings[written] = time
            written += 1
        steps.z0[0] = 0.0
        steps.w0[0] = -eta * evaluate_series(steps.rate, 0, steps.order - 1, h)  # (2.3)
        sign = -sign
        if steps.w0[0] <= REST_VELOCITY or written == len(landings):
            break
    return written
