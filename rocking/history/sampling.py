"""Time histories from the solver's own flights: each is sampled where it lies, then free rocking impact by impact."""

from __future__ import annotations

import math

from rocking._numba.cancellation import stopped
from rocking._numba.compilation import Record, Vector, entry, kernel
from rocking.solver.arcs.flight import state, turn
from rocking.solver.kernels.event_loop import advance, advance_by_arc, begin
from rocking.solver.taylor.events import evaluate
from rocking.solver.taylor.flight import impact_in_step, start_steps
from rocking.solver.taylor.step import set_block, take_step

INVISIBLE = 1e-7
"""Velocity after an impact [-] below which free rocking is shown as rest: a rotation of 5e-15 alpha."""


@kernel
def sample_step(
    steps: Record,
    sign: float,
    start: float,
    end: float,
    tau: Vector,
    filled: int,
    rotation: Vector,
    velocity: Vector,
) -> int:
    """Evaluate the Taylor step that began at time `start` at the samples before `end`; the samples passed."""
    order = steps.order
    while filled < len(tau) and tau[filled] < end:
        h = max(tau[filled] - start, 0.0)  # sums of steps round differently
        rotation[filled] = sign * evaluate(steps.z, 0, order, h)
        velocity[filled] = sign * evaluate(steps.rate, 0, order - 1, h)
        filled += 1
    return filled


@kernel
def sample_steps(
    flight: Record,
    steps: Record,
    start: float,
    end: float,
    farthest: float,
    tau: Vector,
    filled: int,
    rotation: Vector,
    velocity: Vector,
) -> tuple[int, float, float]:
    """Step through the last flight of `advance` once more, at most to z = `farthest`; the samples passed, last z, w."""
    set_block(steps, 0, flight.alpha, flight.omega)
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
        steps.z0[0], steps.w0[0], steps.lifted[0] = z, w, 0.0
        steps.phase[0] += flight.omega * h
    return filled, z, w


@kernel
def sample_arc(
    flight: Record, start: float, end: float, tau: Vector, filled: int, rotation: Vector, velocity: Vector
) -> tuple[int, float, float]:
    """Evaluate the arc of the last flight of `advance`; the samples passed, last z, w."""
    while filled < len(tau) and tau[filled] < end:
        h = max(tau[filled] - start, 0.0)
        turn(flight, flight.phase + flight.omega * h, flight.cosine1, flight.sine1)
        z, w = state(flight, h, flight.cosine1, flight.sine1)
        rotation[filled], velocity[filled] = flight.sign * z, flight.sign * w
        filled += 1
    turn(flight, flight.phase + flight.omega * flight.length, flight.cosine1, flight.sine1)
    z, w = state(flight, flight.length, flight.cosine1, flight.sine1)
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
    tau: Vector,
    rotation: Vector,
    velocity: Vector,
    landings: Vector,
    stop: Vector,
) -> int:
    """`rock_and_sample`, or `sample_arcs` where `steps` is None: then it is compiled without Taylor steps."""
    begin(slenderness, omega, alpha, flight)
    pulse_end = (flight.end_phase[flight.pieces] - flight.end_phase[0]) / omega
    filled, written, going = 0, 0, flight.count > 0
    while going and not stopped(stop):
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
        turn(flight, flight.phase, flight.cosine0, flight.sine0)
        if steps is None or flight.by_arcs == 1:
            filled, z, w = sample_arc(flight, start, end, tau, filled, rotation, velocity)
        else:
            reach = math.inf if going else farthest
            filled, z, w = sample_steps(flight, steps, start, end, reach, tau, filled, rotation, velocity)
        if going:
            turn(flight, flight.next_phase, flight.cosine0, flight.sine0)
        else:
            flight.end_z, flight.end_w = z, w
    return written


@entry
def rock_and_sample(
    slenderness: float,
    omega: float,
    eta: float,
    alpha: float,
    flight: Record,
    steps: Record,
    farthest: float,
    tau: Vector,
    rotation: Vector,
    velocity: Vector,
    landings: Vector,
    stop: Vector,
) -> int:
    """One block from rest to its final fate, sampled at the times `tau` during the pulse.

    Fills `rotation` theta/alpha and `velocity` theta'/(p alpha).

    Parameters
    ----------
    slenderness, omega, eta, alpha : float
        1/a > 0, frequency ratio > 0, restitution in [0, 1] [-]; slenderness angle in [0, pi/2) [rad], 0: slender.
    flight, steps
        The pulse, scratch and answer, as `scratch.prepared` and `scratch.prepared_steps`.
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
    tau: Vector,
    rotation: Vector,
    velocity: Vector,
    landings: Vector,
    stop: Vector,
) -> int:
    """`rock_and_sample` for a slender block under one sinusoid: `flight` is a record `SINGLE`.

    Compiled as `rock_arcs`, it has the same bits.
    """
    return sample_pulse(slenderness, omega, eta, alpha, flight, None, farthest, tau, rotation, velocity, landings, stop)


@entry
def rock_freely(
    z: float,
    w: float,
    sign: float,
    alpha: float,
    steps: Record,
    eta: float,
    start: float,
    horizon: float,
    farthest: float,
    tau: Vector,
    rotation: Vector,
    velocity: Vector,
    landings: Vector,
    stop: Vector,
) -> int:
    """Continue from the state that the solver left at the end of the pulse.

    Parameters
    ----------
    z, w, sign : float
        |theta|/alpha, its rate, and sgn(theta) there: the fields `end_z`, `end_w` and `end_sign` of a record.
    alpha : float
        Slenderness angle [rad], 0: slender.
    steps
        Scratch, as `scratch.prepared_steps`.
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
    set_block(steps, 0, alpha, 1.0)
    steps.strength[0], steps.lifted[0], steps.phase[0] = 0.0, 0.0, 0.0
    filled, written = 0, 0
    while filled < len(tau) and tau[filled] < start:
        filled += 1
    time = start
    steps.z0[0], steps.w0[0] = z, w
    grounded = False
    while sign != 0.0 and time < horizon and steps.z0[0] < farthest and not stopped(stop):
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
        steps.w0[0] = -eta * evaluate(steps.rate, 0, steps.order - 1, h)  # (2.3)
        sign = -sign
        if steps.w0[0] <= INVISIBLE or written == len(landings):
            break
    return written
