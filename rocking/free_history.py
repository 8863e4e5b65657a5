"""Free rocking after the pulse, followed impact by impact for a time history; fates do not need it."""

from __future__ import annotations

from rocking.compilation import Record, Vector, kernel
from rocking.scratch import ORDER
from rocking.taylor_flight import impact_in_step, sample
from rocking.taylor_step import evaluate, expand_motion, step_size

INVISIBLE = 1e-7
"""Velocity after an impact [-] below which free rocking is shown as rest: a rotation of 5e-15 alpha."""


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
    """Continue from the state that `rock` left at the end of the pulse.

    Parameters
    ----------
    flight
        As `rock` left it.
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
    filled, impacts = 0, 0
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
        filled = sample(flight, time, h, tau, filled, rotation, velocity)
        time += h
        z, w = evaluate(flight.z, ORDER, h), evaluate(flight.rate_of_z, ORDER - 1, h)
        grounded = impact >= 0.0
        if grounded:
            if impacts < len(landings):
                landings[impacts] = time
                impacts += 1
            z, w = 0.0, -eta * w  # (2.3)
            flight.sign = -flight.sign
            if w <= INVISIBLE or impacts == len(landings):
                break
    return impacts
