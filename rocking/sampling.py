"""Time histories from the solver's own flights: each is sampled where it lies, then free rocking impact by impact."""

from __future__ import annotations

import math

from rocking.compilation import Record, Vector, kernel
from rocking.rock import advance, begin
from rocking.scratch import ORDER
from rocking.slender_flight import state, turn
from rocking.taylor_flight import impact_in_step
from rocking.taylor_step import evaluate, expand_motion, expand_pulse, step_size

INVISIBLE = 1e-7
"""Velocity after an impact [-] below which free rocking is shown as rest: a rotation of 5e-15 alpha."""


@kernel
def sample_step(
    flight: Record, start: float, stop: float, tau: Vector, filled: int, rotation: Vector, velocity: Vector
) -> int:
    """Evaluate the Taylor step that began at time `start` at the samples before `stop`; the samples passed."""
    while filled < len(tau) and tau[filled] < stop:
        h = max(tau[filled] - start, 0.0)  # sums of steps round differently
        rotation[filled] = flight.sign * evaluate(flight.z, ORDER, h)
        velocity[filled] = flight.sign * evaluate(flight.rate_of_z, ORDER - 1, h)
        filled += 1
    return filled


@kernel
def sample_steps(
    flight: Record,
    start: float,
    stop: float,
    farthest: float,
    tau: Vector,
    filled: int,
    rotation: Vector,
    velocity: Vector,
) -> tuple[int, float, float]:
    """Step through the last flight of `advance` once more, at most to z = `farthest`; the samples passed, last z, w."""
    phase, z, w, elapsed = flight.phase, 0.0, flight.w0, 0.0
    while elapsed < flight.length and z < farthest:
        expand_pulse(flight, phase)
        expand_motion(flight, z, w)
        h = min(step_size(flight), flight.length - elapsed)
        last = elapsed + h >= flight.length
        filled = sample_step(
            flight, start + elapsed, stop if last else start + (elapsed + h), tau, filled, rotation, velocity
        )
        z, w = evaluate(flight.z, ORDER, h), evaluate(flight.rate_of_z, ORDER - 1, h)
        elapsed += h
        phase += flight.omega * h
    return filled, z, w


@kernel
def sample_arc(
    flight: Record, start: float, stop: float, tau: Vector, filled: int, rotation: Vector, velocity: Vector
) -> tuple[int, float, float]:
    """Evaluate the arc of the last flight of `advance`; the samples passed, last z, w."""
    while filled < len(tau) and tau[filled] < stop:
        h = max(tau[filled] - start, 0.0)
        turn(flight, flight.phase + flight.omega * h, flight.cosine1, flight.sine1)
        z, w = state(flight, h, flight.cosine1, flight.sine1)
        rotation[filled], velocity[filled] = flight.sign * z, flight.sign * w
        filled += 1
    turn(flight, flight.phase + flight.omega * flight.length, flight.cosine1, flight.sine1)
    z, w = state(flight, flight.length, flight.cosine1, flight.sine1)
    return filled, z, w


@kernel
def rock_and_sample(
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
) -> int:
    """`rock.rock`, filling `rotation` theta/alpha and `velocity` theta'/(p alpha) at the times `tau` during the pulse.

    Parameters
    ----------
    slenderness, omega, eta, alpha, flight
        As for `rock.rock`.
    farthest : float
        |theta|/alpha at which the history of a block that is known to overturn may stop [-].
    tau : float array (samples,)
        Times from the pulse's start [-], ascending; `rotation` and `velocity` (samples,) are zero on entry.
    landings : float array
        Filled with the times of the impacts as far as it reaches.

    Returns
    -------
    int
        Impacts written down.
    """
    begin(slenderness, omega, alpha, flight)
    pulse_end = (flight.end_phase[flight.pieces] - flight.end_phase[0]) / omega
    filled, written, going = 0, 0, flight.count > 0
    while going:
        flight.length = math.nan
        going = advance(flight, eta)
        if math.isnan(flight.length):
            break  # at rest for good
        start = (flight.phase - flight.end_phase[0]) / omega
        stop = start + flight.length
        if going:
            stop = (flight.next_phase - flight.end_phase[0]) / omega  # where the next flight says that it starts
            if written < len(landings):
                landings[written] = stop
                written += 1
        elif stop < pulse_end:  # known to overturn before the pulse ends: its last flight goes on
            flight.length, stop = pulse_end - start, pulse_end
        while filled < len(tau) and tau[filled] < start:
            filled += 1  # at rest
        # `advance` has prepared the next flight: its angles must not stand in for this one's
        turn(flight, flight.phase, flight.cosine0, flight.sine0)
        if alpha == 0.0 and flight.spread == 0.0:
            filled, z, w = sample_arc(flight, start, stop, tau, filled, rotation, velocity)
        else:
            reach = math.inf if going else farthest
            filled, z, w = sample_steps(flight, start, stop, reach, tau, filled, rotation, velocity)
        if going:
            turn(flight, flight.next_phase, flight.cosine0, flight.sine0)
        else:
            flight.end_z, flight.end_w = z, w
    return written


@kernel
def rock_freely(
    flight: Record,
    eta: float,
    start: float,
    horizon: float,
    farthest: float,
    tau: Vector,
    rotation: Vector,
    velocity: Vector,
    landings: Vector,
) -> int:
    """Continue from the state that the solver left at the end of the pulse.

    Parameters
    ----------
    flight
        As `rock_and_sample` left it.
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

    Returns
    -------
    int
        Impacts written down.
    """
    for n in range(ORDER + 1):
        flight.f[n] = 0.0
    filled, written = 0, 0
    while filled < len(tau) and tau[filled] < start:
        filled += 1
    z, w, time = flight.end_z, flight.end_w, start
    flight.sign = flight.end_sign
    grounded = False
    while flight.sign != 0.0 and time < horizon and z < farthest:
        expand_motion(flight, z, w)
        h = min(step_size(flight), horizon - time)
        impact = impact_in_step(flight, h, False, grounded)
        if impact >= 0.0:
            h = impact
        filled = sample_step(flight, time, time + h, tau, filled, rotation, velocity)
        time += h
        z, w = evaluate(flight.z, ORDER, h), evaluate(flight.rate_of_z, ORDER - 1, h)
        grounded = impact >= 0.0
        if grounded:
            if written < len(landings):
                landings[written] = time
                written += 1
            z, w = 0.0, -eta * w  # (2.3)
            flight.sign = -flight.sign
            if w <= INVISIBLE or written == len(landings):
                break
    return written
